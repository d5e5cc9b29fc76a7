// Makes simpler occluders for dense meshes: they lie inside of the solids that the mesh bounds, and so hide no more.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "sightline/prepare/occluder/occluder.h"

namespace sightline {

/// How far an occluder is made simpler.
struct InnerSettings {
    /// A level lies at most so far inside of the mesh, about, as a part of its box's diagonal; each level twice as far
    /// as the one before.  [limit: > 0]
    float first_error = 1.0f / 1024;
    uint32_t levels = 6;            ///< at most
    float least_gain = 0.7f;        ///< a level is kept if it has at most so many times the last one's triangles
    uint32_t least_triangles = 64;  ///< a solid with fewer stays as it is
};

/// Simpler occluders in the place of prepareOccluder()'s, finest first; none where nothing would be won.
///
/// Only solids (prepare/inner/solids.h) are made simpler, each by itself; other triangles stay as they are. What is smaller
/// than a level's error is left out there. Every polygon is either one of the mesh's own, or lies, exactly, inside of a
/// solid: see InnerHull for the proof. It holds for eyes outside of the solids alone: World::addOccluder() says how
/// that is kept. O(n log n) for dense meshes; deterministic.
///
/// @param hides, double_sided  as in OccluderSource
std::vector<InnerOccluder> prepareInner(const MeshView& mesh, std::span<const uint8_t> hides = {},
                                        std::span<const uint8_t> double_sided = {},
                                        const OccluderSettings& settings = {}, const InnerSettings& inner = {});

}  // namespace sightline
