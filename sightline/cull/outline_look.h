// An object asked of the depth tiles by the outlines of its clusters: the second look.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/buffer/ask/occludee.h"
#include "sightline/cull/occlusion.h"

namespace sightline {

/// A cluster that could not be decided by its box.
struct ClusterLook {
    uint32_t cluster = 0;
    float nearness = 0;  ///< no triangle of it is nearer
};

/// Pixels of a tile that only seams may hide.
struct UndecidedPixels {
    uint32_t tile = 0, cluster = 0;
    uint64_t mask = 0;
    float nearness = 0;
};

/// The limit of one look, its cost, and where it ended.
struct OutlineLook {
    static constexpr uint32_t kNone = ~0u;

    uint64_t most_polygons = ~0u;  ///< the limit; a look that needs more answers kVisible
    uint32_t first = kNone;        ///< a cluster to ask before the others; any, for it changes no answer
    uint32_t polygons = 0;         ///< of the clusters that were looked at
    bool spent = false;            ///< it ran into the limit
    bool in_doubt = false;         ///< it ended where it could not be said what lies where
    /// Where the answer is not kVisible: nothing hides the object, but some of it is turned away, and nothing that would be drawn lies
    /// in the view.
    bool away = false;
    uint32_t open = kNone;  ///< the cluster that is open, where the answer is kVisible, unless the look was spent
};

/// The scratch memory of second looks.
struct LookScratch {
    Array<ClusterLook> clusters;
    Array<UndecidedPixels> undecided;

    explicit LookScratch(Memory* memory) : clusters(memory), undecided(memory) {}
};

/// Asks an object's clusters until one has an open pixel: first OutlineLook::first, then all by their boxes, then by their outlines, nearest
/// clusters first; and where only seams may hide it, pixel by pixel at the end. A single-sided triangle that is turned away is not drawn, and
/// so it shows nothing.
///
/// @param instance  makeOccluderInstance() of the object; its occluder holds every triangle that may be drawn of the object
/// @returns kOutside if no triangle that would be drawn lies in the view
Sight askOutlines(DepthTiles& tiles, const OccluderInstance& instance, LookScratch& scratch, OutlineLook& look);

}  // namespace sightline
