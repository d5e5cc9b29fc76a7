// A volume's planes as a walk over a hierarchy of eight-wide nodes uses them.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "sightline/cull/bounds.h"
#include "sightline/cull/hierarchy_scratch.h"
#include "sightline/studies/frustum/coherency.h"
#include "sightline/tree/world_bvh.h"

namespace sightline::studies::detail {

/// Outside if ((n.x * most.x + n.y * most.y) + n.z * most.z) + outer < 0; surely inside if the same of the least corner,
/// with `inner`, is >= 0. Rounding is monotone, so that a box inside another is never judged worse than that one.
struct WalkPlane {
    float n[3] = {};
    float outer = 0, inner = 0;
    float margin = 0;      ///< outer and inner are so far from the plane; no sum is wrong by more than half of it
    uint8_t most[3] = {};  ///< rows of a node: 0 to 2 are min, 3 to 5 max
    uint8_t least[3] = {};
};

struct WalkPlanes {
    static constexpr uint32_t kMost = 8;
    WalkPlane planes[kMost];
    uint32_t count = 0;
    WalkPlane refining[6 + RefinedVolume::kMostCrossed];
    uint32_t refining_count = 0;
};

inline const float* rowOf(const BvhNode& node, uint32_t row) { return row < 3 ? node.min[row] : node.max[row - 3]; }

/// @param reach  no bound of the tree is farther from its origin on any axis
inline WalkPlane walkPlane(const glm::dvec4& p, const glm::dvec3& shift, double reach) {
    constexpr double kRounding = 0x1p-19;  // coordinates, coefficients and five steps, each by at most 2^-23
    WalkPlane out;
    const double way = glm::dot(glm::dvec3(p), shift);
    const double sides = std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
    const double margin = kRounding * (std::abs(p.w) + std::abs(way) + sides * reach);
    out.margin = static_cast<float>(margin);
    out.outer = static_cast<float>(p.w + way + margin);
    out.inner = static_cast<float>(p.w + way - margin);
    for (int axis = 0; axis < 3; ++axis) {
        out.n[axis] = static_cast<float>(p[axis]);
        out.most[axis] = static_cast<uint8_t>(p[axis] >= 0.0 ? 3 + axis : axis);
        out.least[axis] = static_cast<uint8_t>(p[axis] >= 0.0 ? axis : 3 + axis);
    }
    return out;
}

/// What a walk with eight at once asks, and what it counts.
struct EightWalk {
    const WalkPlanes& planes;
    const HierarchyCulling& how;
    CoherentStats& stats;
};

/// Writes the items that are kept, and returns how many.
size_t walkEight(const EightWalk& walk, const PlacedBvh& tree, Array<HierarchyScratch::Visit>& visits,
                 std::span<uint32_t> kept);

}  // namespace sightline::studies::detail
