// A triangle surface, ready to be measured against others: a tree and a table of its triangles.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/lod/distance_surface.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/prepare/welder.h"

namespace sightline {
namespace {

constexpr uint32_t kFreeSlot = ~uint32_t{0};

bool isBefore(const glm::dvec3& a, const glm::dvec3& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

TriangleCorners sortedCorners(TriangleCorners t) {
    std::sort(t.at, t.at + 3, isBefore);
    return t;
}

bool areSame(const TriangleCorners& a, const TriangleCorners& b) { return std::equal(a.at, a.at + 3, b.at); }

}  // namespace

DistanceSurface::DistanceSurface(const MeshView& mesh) : tree_({}) {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> number(mesh.positions.size(), kFreeSlot);
    Welder welder(positions);
    corners_.reserve(mesh.triangles());
    vertices_.reserve(mesh.triangles());
    for (size_t t = 0; t < mesh.triangles(); ++t) {
        TriangleCorners corners;
        std::array<uint32_t, 3> places;
        for (uint32_t k = 0; k < 3; ++k) {
            const uint32_t vertex = mesh.indices[3 * t + k];
            SIGHTLINE_ASSERT(vertex < mesh.positions.size());
            const glm::vec3 p = mesh.positions[vertex];
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
                finite_ = false;
                return;
            }
            if (number[vertex] == kFreeSlot) number[vertex] = welder.number(p);
            places[k] = number[vertex];
            corners.at[k] = glm::dvec3(positions[places[k]]);
            box_.grow(corners.at[k]);
        }
        corners_.push_back(corners);
        vertices_.push_back(places);
    }
    places_ = positions.size();
    slots_.assign(std::bit_ceil(2 * corners_.size() + 2), kFreeSlot);
    for (uint32_t t = 0; t < corners_.size(); ++t) {
        const TriangleCorners sorted = sortedCorners(corners_[t]);
        size_t at = slotOf(sorted);
        while (slots_[at] != kFreeSlot && !areSame(sorted, sortedCorners(corners_[slots_[at]])))
            at = (at + 1) & (slots_.size() - 1);
        slots_[at] = t;  // of equal ones the last
    }
    tree_ = TriangleTree(corners_);
}

size_t DistanceSurface::slotOf(const TriangleCorners& sorted) const {
    uint64_t hash = 0x9e3779b97f4a7c15ull;
    for (const glm::dvec3& corner : sorted.at)
        for (int axis = 0; axis < 3; ++axis) {
            hash = (hash ^ std::bit_cast<uint64_t>(corner[axis])) * 0xd6e8feb86659fd93ull;
            hash ^= hash >> 32;
        }
    return hash & (slots_.size() - 1);
}

bool DistanceSurface::holds(const TriangleCorners& corners) const {
    if (corners_.empty()) return false;
    const TriangleCorners sorted = sortedCorners(corners);
    for (size_t at = slotOf(sorted); slots_[at] != kFreeSlot; at = (at + 1) & (slots_.size() - 1))
        if (areSame(sorted, sortedCorners(corners_[slots_[at]]))) return true;
    return false;
}

}  // namespace sightline
