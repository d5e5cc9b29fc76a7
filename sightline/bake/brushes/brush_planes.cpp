// Finds the planes of brushes by their distance from the origin, and cuts polyhedra face by face.
// SPDX-License-Identifier: MIT
#include "sightline/bake/brushes/brush_planes.h"

#include <algorithm>
#include <cmath>

namespace sightline::bake {
namespace {

constexpr double kSnapNormal = 1e-5;
constexpr double kBucket = 1;  // of distances [world units]

/// What lies behind a plane; `heights` are of the corners.
void keepBehind(const std::vector<glm::dvec3>& outline, const std::vector<double>& heights,
                std::vector<glm::dvec3>& kept) {
    kept.clear();
    for (size_t i = 0; i < outline.size(); ++i) {
        const size_t next = i + 1 < outline.size() ? i + 1 : 0;
        const double here = heights[i], there = heights[next];
        if (here <= 0) kept.push_back(outline[i]);
        if ((here < 0 && there > 0) || (here > 0 && there < 0))
            kept.push_back(outline[i] + here / (here - there) * (outline[next] - outline[i]));
    }
}

/// Whether a side that takes another plane moves by no more than a distance at all corners of its face. The change is
/// measured, not the heights of the corners: where the planes are the same there is none, whatever the corners' rounding.
bool movesLittle(const glm::dvec4& from, const glm::dvec4& to, std::span<const glm::dvec3> face, double distance) {
    const glm::dvec4 change = to - from;
    return std::abs(change.w) <= distance && std::all_of(face.begin(), face.end(), [&](const glm::dvec3& corner) {
               return std::abs(heightOf(change, corner)) <= distance;
           });
}

}  // namespace

std::optional<glm::dvec4> planeThrough(const glm::dvec3 (&points)[3]) {
    const glm::dvec3 normal = glm::cross(points[0] - points[1], points[2] - points[1]);
    const double length = glm::length(normal);
    if (!(length > 1e-12 * glm::length(points[0] - points[1]) * glm::length(points[2] - points[1])))
        return std::nullopt;
    return glm::dvec4(normal / length, -glm::dot(normal / length, points[1]));
}

uint32_t BrushPlanes::sideOf(const glm::dvec4& given, std::span<const glm::dvec3> face) {
    glm::dvec4 exact = given, plane = given;
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(std::abs(given[axis]) - 1) < kSnapNormal * kSnapNormal) {
            glm::dvec4 along(0.0);
            along[axis] = given[axis] > 0 ? 1 : -1;
            along.w = given.w;
            if (movesLittle(given, along, face, snap_)) plane = along;
        }
    const glm::dvec3 size = glm::abs(glm::dvec3(plane));
    const int largest = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
    uint32_t flipped = plane[largest] < 0;
    if (flipped) {
        plane = -plane;
        exact = -exact;
    }
    const int64_t bucket = static_cast<int64_t>(std::floor(plane.w / kBucket));
    // A normal may have two components that are largest but for rounding: then it may be listed facing the other way.
    for (const uint32_t turned : {0u, 1u})
        for (int64_t at = -1; at <= 1; ++at) {
            const auto found = by_distance_.find(turned ? -bucket - 1 + at : bucket + at);
            if (found == by_distance_.end()) continue;
            const glm::dvec4 wanted = turned ? -plane : plane, before = turned ? -exact : exact;
            for (const uint32_t i : found->second)
                if (glm::length(glm::dvec3(planes_[i] - wanted)) < kSnapNormal &&
                    movesLittle(before, planes_[i], face, snap_))
                    return i << 1 | (flipped ^ turned);
        }
    planes_.push_back(plane);
    by_distance_[bucket].push_back(static_cast<uint32_t>(planes_.size() - 1));
    return static_cast<uint32_t>(planes_.size() - 1) << 1 | flipped;
}

std::vector<glm::dvec3> faceIn(const glm::dvec4& plane, const Box3d& box, std::span<const glm::dvec4> others) {
    const glm::dvec3 n(plane);
    const glm::dvec3 size = glm::abs(n);
    glm::dvec3 helper(0.0);
    helper[size.x < size.y ? (size.x < size.z ? 0 : 2) : (size.y < size.z ? 1 : 2)] = 1;
    const glm::dvec3 u = glm::length(box.size()) * glm::normalize(glm::cross(helper, n));
    const glm::dvec3 v = glm::cross(n, u);
    const glm::dvec3 middle = box.center() - n * heightOf(plane, box.center());
    std::vector<glm::dvec3> outline = {middle - u - v, middle + u - v, middle + u + v, middle - u + v}, kept;
    std::vector<double> heights;
    for (const glm::dvec4& other : others) {
        heights.clear();
        for (const glm::dvec3& point : outline) heights.push_back(heightOf(other, point));
        keepBehind(outline, heights, kept);
        outline.swap(kept);
        if (outline.size() < 3) return {};
    }
    return outline;
}

BrushFaces facesOfBox(const Box3d& box) {
    std::vector<glm::dvec4> planes;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec4 plane(0.0);
        plane[axis] = 1;
        plane.w = -box.max[axis];
        planes.push_back(plane);
        plane[axis] = -1;
        plane.w = box.min[axis];
        planes.push_back(plane);
    }
    BrushFaces faces;
    for (size_t i = 0; i < planes.size(); ++i) {
        std::vector<glm::dvec4> others = planes;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
        faces.push_back({planes[i], faceIn(planes[i], box, others)});
    }
    return faces;
}

void cutFaces(const BrushFaces& faces, const glm::dvec4& plane, const Box3d& box, BrushFaces& behind,
              BrushFaces& in_front) {
    behind.clear();
    in_front.clear();
    std::vector<glm::dvec4> others;
    std::vector<glm::dvec3> kept;
    std::vector<double> heights;
    for (const BrushFace& face : faces) {
        others.push_back(face.plane);
        heights.clear();
        for (const glm::dvec3& point : face.outline) heights.push_back(heightOf(plane, point));
        keepBehind(face.outline, heights, kept);
        if (kept.size() >= 3) behind.push_back({face.plane, kept});
        for (double& height : heights) height = -height;
        keepBehind(face.outline, heights, kept);
        if (kept.size() >= 3) in_front.push_back({face.plane, kept});
    }
    std::vector<glm::dvec3> cap = faceIn(plane, box, others);
    if (cap.size() < 3) return;
    behind.push_back({plane, cap});
    in_front.push_back({-plane, {cap.rbegin(), cap.rend()}});
}

}  // namespace sightline::bake
