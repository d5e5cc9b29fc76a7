// Which of several polygons that share a side are joined there: those that go on most smoothly.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "sightline/prepare/occluder/patchwork.h"

namespace sightline {

/// Two sides that join the same vertices the other way round, by their places in the list given. Where a polygon has no
/// partner, `backward` or `forward` is kNone.
struct SidePair {
    static constexpr uint32_t kNone = ~uint32_t{0};
    uint32_t forward = kNone, backward = kNone;
};

/// Unit normal of a polygon's first three corners; zero if they lie on a line.
glm::dvec3 normalOf(const Patchwork& patchwork, uint32_t polygon);

/// The cosine between the normals of two polygons that share a side.
double smoothness(const Patchwork& patchwork, const PatchSide& a, const PatchSide& b);

/// Pairs sides that join the same vertices, the smoothest first: where boxes touch, the faces of a wall go on in each
/// other, and the faces between the boxes do not break the wall. Beyond eight in a direction, in their order.
///
/// @param shared  sides with the same low and high
/// @param pairs   every side once; those without a partner last
void pairSides(const Patchwork& patchwork, std::span<const PatchSide> shared, std::vector<SidePair>& pairs);

}  // namespace sightline
