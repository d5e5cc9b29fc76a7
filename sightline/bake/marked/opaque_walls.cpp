// Gathers the opaque triangles near a box, and finds the sheet of them that lies nearest to a face.
// SPDX-License-Identifier: MIT
#include "sightline/bake/marked/opaque_walls.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sightline::bake {
using namespace tools;
namespace {

bool meet(const Box3d& a, const Box3d& b) {
    for (int axis = 0; axis < 3; ++axis)
        if (a.max[axis] < b.min[axis] || b.max[axis] < a.min[axis]) return false;
    return true;
}

/// A triangle that may be part of a sheet.
struct Candidate {
    const WallTriangle* triangle;
    FlatPiece piece;  ///< on the face
    double area;
};

/// The farthest of the corners from a plane.
double farthest(const glm::dvec4& plane, const WallTriangle& triangle) {
    double most = 0;
    for (const glm::dvec3& corner : triangle.corners)
        most = std::max(most, std::abs(glm::dot(glm::dvec3(plane), corner - triangle.corners[0]) +
                                       (glm::dot(glm::dvec3(plane), triangle.corners[0]) + plane.w)));
    return most;
}

double areaOutside(const FlatPiece& piece, std::span<const FlatPiece> open) {
    double area = areaOf(piece);
    for (const FlatPiece& other : open) area -= areaOf(sharedBy(piece, other));
    return std::max(area, 0.0);
}

}  // namespace

OpaqueWalls::OpaqueWalls(const Scene& scene, std::span<const uint32_t> movable) : scene_(scene) {
    std::vector<bool> moves(scene.objects.size(), false);
    for (const uint32_t object : movable)
        if (object < moves.size()) moves[object] = true;
    for (uint32_t i = 0; i < scene.objects.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.objects[i].mesh];
        if (moves[i] || mesh.deforms) continue;
        const Box3d box = transformBox(mesh.bounds, scene.objects[i].transform);
        if (!box.finite()) continue;
        objects_.push_back(i);
        bounds_.push_back(box);
    }
}

void OpaqueWalls::gather(const Box3d& box, std::vector<WallTriangle>& triangles) const {
    for (size_t k = 0; k < objects_.size(); ++k) {
        if (!meet(bounds_[k], box)) continue;
        const SceneObject& object = scene_.objects[objects_[k]];
        const Mesh& mesh = scene_.meshes[object.mesh];
        std::vector<glm::dvec3> points, sizes;
        points.reserve(mesh.positions.size());
        sizes.reserve(mesh.positions.size());
        const glm::dmat3 linear(object.transform), size(glm::abs(linear[0]), glm::abs(linear[1]), glm::abs(linear[2]));
        for (const glm::vec3& point : mesh.positions) {
            points.emplace_back(object.transform * glm::dvec4(glm::dvec3(point), 1));
            sizes.push_back(size * glm::abs(glm::dvec3(point)));
        }
        const bool mirrored = glm::determinant(glm::dmat3(object.transform)) < 0;
        for (const Primitive& part : mesh.primitives) {
            const Material& material = scene_.materials[part.material];
            if (!material.hides()) continue;
            for (size_t t = part.first_triangle; t < size_t{part.first_triangle} + part.triangle_count; ++t) {
                WallTriangle triangle;
                triangle.object = objects_[k];
                triangle.both = material.double_sided;
                Box3d bounds;
                glm::dvec3 largest(0.0);
                for (size_t c = 0; c < 3; ++c) {
                    const uint32_t corner = mesh.indices[3 * t + c];
                    triangle.corners[c] = points[corner];
                    bounds.grow(triangle.corners[c]);
                    largest = glm::max(largest, sizes[corner]);
                }
                triangle.rounding = 0x1p-22 * std::max({largest.x, largest.y, largest.z});
                if (!meet(bounds, box)) continue;
                if (mirrored) std::swap(triangle.corners[1], triangle.corners[2]);
                triangles.push_back(triangle);
            }
        }
    }
}

FlatFrame::FlatFrame(const glm::dvec3& origin, const glm::dvec3& normal) : origin_(origin), normal_(normal) {
    const glm::dvec3 size = glm::abs(normal);
    const int least = size.x <= size.y ? (size.x <= size.z ? 0 : 2) : (size.y <= size.z ? 1 : 2);
    glm::dvec3 axis(0);
    axis[least] = 1;
    u_ = glm::normalize(glm::cross(axis, normal));
    v_ = glm::cross(normal, u_);
}

FlatPiece FlatFrame::to(std::span<const glm::dvec3> outline) const {
    FlatPiece piece;
    for (const glm::dvec3& point : outline) piece.push_back(to(point));
    return piece;
}

std::vector<glm::dvec3> FlatFrame::from(const FlatPiece& piece, double height) const {
    std::vector<glm::dvec3> outline;
    for (const glm::dvec2& point : piece) outline.push_back(from(point, height));
    return outline;
}

FlatPiece frontOf(const FlatFrame& frame, const WallTriangle& triangle) {
    FlatPiece piece = frame.to(triangle.corners);
    const double area = areaOf(piece);
    if (area < 0 && triangle.both) std::swap(piece[1], piece[2]);
    if (area == 0 || (area < 0 && !triangle.both)) piece.clear();
    return piece;
}

std::optional<glm::dvec4> sheetNear(std::span<const glm::dvec3> face, const glm::dvec4& plane, const FlatFrame& frame,
                                    std::span<const FlatPiece> open, std::span<const WallTriangle> triangles,
                                    double reach, double slit) {
    const FlatPiece whole = frame.to(face);
    const double needed = areaOutside(whole, open) / 2;
    if (!(needed > 0)) return std::nullopt;
    std::vector<Candidate> candidates;
    for (const WallTriangle& triangle : triangles) {
        if (farthest(plane, triangle) > reach) continue;
        Candidate candidate{&triangle, sharedBy(frontOf(frame, triangle), whole), 0};
        candidate.area = areaOutside(candidate.piece, open);
        if (candidate.area > 0) candidates.push_back(std::move(candidate));
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.area > b.area; });
    constexpr int kSeeds = 16;
    std::optional<glm::dvec4> best;
    double most = needed, best_off = 0;
    std::vector<bool> used(candidates.size(), false);
    int seeds = 0;
    for (size_t s = 0; s < candidates.size() && seeds < kSeeds; ++s) {
        if (used[s]) continue;
        ++seeds;
        const WallTriangle& seed = *candidates[s].triangle;
        glm::dvec3 normal = glm::cross(seed.corners[1] - seed.corners[0], seed.corners[2] - seed.corners[0]);
        if (!(glm::length(normal) > 0)) continue;
        normal = glm::normalize(normal);
        if (glm::dot(normal, glm::dvec3(plane)) < 0) normal = -normal;
        const glm::dvec4 sheet(normal, -glm::dot(normal, seed.corners[0]));
        double off = 0;
        for (const glm::dvec3& corner : face) off = std::max(off, std::abs(glm::dot(normal, corner - seed.corners[0])));
        double area = 0;
        for (size_t i = s; i < candidates.size(); ++i) {
            if (used[i] || farthest(sheet, *candidates[i].triangle) > slit / 2) continue;
            used[i] = true;
            area += candidates[i].area;
        }
        if (off > reach || area < most * (best && off >= best_off ? 1.01 : 1)) continue;
        best = sheet;
        best_off = off;
        most = area;
    }
    return best;
}

}  // namespace sightline::bake
