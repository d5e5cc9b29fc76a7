// Normals for smooth shading, derived from positions alone: faces that meet at less than a crease share theirs.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/shade/smooth_normals.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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

}  // namespace sightline::studies
