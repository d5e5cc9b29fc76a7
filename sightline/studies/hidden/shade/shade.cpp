// Gives a hidden-surface image its colours: flat or smooth, under one sun, with or without its shadows.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/shade/shade.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

namespace sightline::studies {
namespace {

bool isBefore(const glm::vec3& a, const glm::vec3& b) {
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z < b.z;
}

struct Corner {
    glm::dvec3 face{0.0};  // the face's normal; 0 without area
    double angle = 0;
};

std::vector<Corner> cornersOf(const MeshView& mesh) {
    std::vector<Corner> corners(mesh.indices.size());
    for (size_t t = 0; t < mesh.triangles(); ++t) {
        glm::dvec3 p[3];
        for (size_t k = 0; k < 3; ++k) p[k] = glm::dvec3(mesh.positions[mesh.indices[3 * t + k]]);
        const glm::dvec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
        const double length = glm::length(across);
        if (!(length > 0) || !std::isfinite(length)) continue;
        for (size_t k = 0; k < 3; ++k) {
            const glm::dvec3 u = p[(k + 1) % 3] - p[k], v = p[(k + 2) % 3] - p[k];
            corners[3 * t + k] = {across / length, std::atan2(length, glm::dot(u, v))};
        }
    }
    return corners;
}

/// Smooth normals of the meshes that an image shows, each made once although many items share it.
class NormalsOfImage {
public:
    NormalsOfImage(const DrawList& list, const HiddenImage& image, const ShadeSettings& settings)
        : of_item_(list.items().size(), nullptr) {
        std::vector<uint8_t> shown(list.items().size(), 0);
        uint32_t last = HiddenImage::kNone;
        for (const uint32_t surface : image.surface) {
            if (surface == HiddenImage::kNone || surface == last) continue;
            shown[list.placeOf(surface).item] = 1;
            last = surface;
        }
        std::vector<const DrawItem*> first;  // of each mesh
        for (size_t i = 0; i < shown.size(); ++i) {
            if (!shown[i]) continue;
            const DrawItem& item = list.items()[i];
            const auto [found, added] = meshes_.try_emplace(item.mesh.indices.data());
            if (added) first.push_back(&item);
            of_item_[i] = &found->second;
        }
        shareOut(settings.share, first.size(), [&](size_t i) {
            meshes_.find(first[i]->mesh.indices.data())->second =
                smoothNormals(first[i]->mesh, settings.crease_degrees);
        });
    }

    /// The interpolated normal of a point, on the side of its face's normal.
    glm::dvec3 at(const DrawItem& item, const SurfacePoint& point) const {
        glm::dvec3 sum(0.0);
        const std::vector<glm::vec3>& normals = *of_item_[point.item];
        for (int k = 0; k < 3; ++k)
            sum += point.weights[k] * glm::dvec3(normals[size_t{3} * point.triangle + static_cast<size_t>(k)]);
        // Normals turn with the matrix of cofactors, which keeps them on their side even where it mirrors.
        const glm::dmat3 m(item.transform);
        const glm::dvec3 turned =
            glm::dmat3(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])) * sum;
        const double length = glm::length(turned);
        if (!(length > 0)) return point.normal;
        // The face's own normal came from the same cross product, turned to the eye.
        const bool mirrored = glm::determinant(m) < 0;
        return turned * ((point.from_behind != mirrored ? -1.0 : 1.0) / length);
    }

private:
    std::map<const uint32_t*, std::vector<glm::vec3>> meshes_;
    std::vector<const std::vector<glm::vec3>*> of_item_;
};

}  // namespace

std::vector<glm::vec3> smoothNormals(const MeshView& mesh, double crease_degrees) {
    const std::vector<Corner> corners = cornersOf(mesh);
    const auto positionOf = [&](uint32_t corner) { return mesh.positions[mesh.indices[corner]]; };
    std::vector<uint32_t> order(corners.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        const glm::vec3 p = positionOf(a), q = positionOf(b);
        return isBefore(p, q) || (!isBefore(q, p) && a < b);
    });
    // A hair of room: faces of one plane have normals that rounding has moved apart.
    const double least = std::cos(crease_degrees * 3.14159265358979323846 / 180) - 1e-12;
    std::vector<glm::vec3> normals(corners.size(), glm::vec3(0));
    for (size_t begin = 0; begin < order.size();) {
        size_t end = begin + 1;
        while (end < order.size() && positionOf(order[end]) == positionOf(order[begin])) ++end;
        for (size_t i = begin; i < end; ++i) {
            const glm::dvec3& own = corners[order[i]].face;
            glm::dvec3 sum(0.0);
            for (size_t k = begin; k < end; ++k) {
                const Corner& other = corners[order[k]];
                if (glm::dot(own, other.face) >= least && other.angle > 0) sum += other.angle * other.face;
            }
            const double length = glm::length(sum);
            if (own != glm::dvec3(0.0)) normals[order[i]] = glm::vec3(length > 0 ? sum / length : own);
        }
        begin = end;
    }
    return normals;
}

std::vector<glm::u8vec3> shade(const DrawList& list, const View& view, const HiddenImage& image,
                               const ShadeSettings& settings) {
    std::vector<glm::u8vec3> out(image.surface.size(), glm::u8vec3(0));
    const SurfacePoints points(list, view);
    const bool smooth = settings.shading == Shading::kSmooth, lit = settings.shading != Shading::kNone;
    std::optional<NormalsOfImage> normals;
    if (smooth) normals.emplace(list, image, settings);

    const auto colourAt = [&](uint32_t row, uint32_t sample, uint32_t surface) {
        const glm::dvec3 sky = lit ? skyColour(points.directionAt(row, sample).y) : glm::dvec3(0.0);
        if (surface == HiddenImage::kNone) return sky;
        const DrawList::Place place = list.placeOf(surface);
        const DrawItem& item = list.items()[place.item];
        const glm::dvec3 colour = settings.colour ? settings.colour(place.item, place.triangle) : hashedColour(item.id);
        if (!lit) return colour;
        const SurfacePoint point = points.at(row, sample, surface);
        const glm::dvec3 normal = smooth ? normals->at(item, point) : point.normal;
        // A smooth normal may turn to the sun where its face does not: the face is in its own shadow.
        const double own = std::clamp(8 * glm::dot(point.normal, settings.sun), 0.0, 1.0);
        double reach = smooth ? own : 1.0;
        if (settings.shadows && own > 0) reach *= settings.shadows->reach(point);
        const glm::dvec3 seen = colour * lightOn(normal, settings.sun, reach);
        if (settings.diagonal <= 0) return seen;
        const double hazy = std::max(0.0, glm::length(point.position) - settings.clear);
        return throughHaze(seen, sky, hazy / settings.diagonal);
    };
    shareOut(settings.share, image.height, [&](size_t row) {
        for (uint32_t i = 0; i < image.width; ++i) {
            const size_t at = row * image.width + i;
            out[at] = toBytes(colourAt(static_cast<uint32_t>(row), i, image.surface[at]));
        }
    });
    return out;
}

}  // namespace sightline::studies
