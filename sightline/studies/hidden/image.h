// What every hidden-surface method leaves behind: which surface each sample shows, and what finding out cost.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/studies/hidden/project/projector.h"

namespace sightline::studies {

/// What a method did. A field that means nothing to a method stays 0.
struct HiddenCounters {
    ProjectorCounters geometry;

    // Fragments: a polygon at a sample.
    uint64_t generated = 0;  ///< found by scan conversion
    uint64_t tested = 0;     ///< compared with what is there: a depth, or whether the sample is still free
    uint64_t passed = 0;     ///< written
    uint64_t shaded = 0;     ///< given a colour, to be kept or not

    // Ordering.
    uint64_t comparisons = 0;       ///< of pairs of polygons: overlap and plane tests (Newell, Warnock)
    uint64_t swaps = 0;             ///< polygons moved before others (Newell)
    uint64_t splits = 0;            ///< polygons cut in two
    uint64_t nodes = 0;             ///< of a tree: visited
    uint64_t skipped_subtrees = 0;  ///< left out because their part of the screen was full
    uint64_t windows = 0;           ///< looked at by area subdivision
    uint64_t rays = 0;

    // The z-buffer's machinery.
    uint64_t hierarchy_rejected_polygons = 0, hierarchy_rejected_tiles = 0;  ///< known to be hidden as a whole
    uint64_t hierarchy_accepted_tiles = 0;                                   ///< known to be in front as a whole
    uint64_t depth_bytes = 0;             ///< read and written, tile by tile, as if nothing were compressed
    uint64_t depth_bytes_compressed = 0;  ///< the same, compressed

    // Wall time.
    uint64_t prepare_nanoseconds = 0;  ///< what can be kept from frame to frame: building a tree
    uint64_t nanoseconds = 0;          ///< the rest: projecting, sorting, drawing
};

/// Row 0 is the bottom row.
struct HiddenImage {
    static constexpr uint32_t kNone = ~0u;

    uint32_t width = 0, height = 0;
    std::vector<uint32_t> surface;  ///< DrawList's number, or kNone  [size: width * height]
    /// Per sample, saturating; empty unless RenderSettings::want_counts  [size: width * height]
    std::vector<uint16_t> generated, tested, passed, shaded;
    HiddenCounters counters;

    uint32_t& at(int32_t row, int32_t sample) {
        return surface[static_cast<size_t>(row) * width + static_cast<size_t>(sample)];
    }
};

}  // namespace sightline::studies
