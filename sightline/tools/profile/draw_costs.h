// What a draw call, a triangle, a vertex and a pixel cost on this machine, in this scene: fitted to frames of parts of it.
// SPDX-License-Identifier: MIT
//
// Charles Lawson, Richard Hanson. Solving Least Squares Problems. 1974.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "sightline/tools/profile/frame_load.h"

namespace sightline::tools {

/// A frame that was timed, and what it had to draw.
struct CostSample {
    double objects = 0, triangles = 0, vertices = 0;
    double pixels = 0;   ///< covered: fragments, hidden or not
    double samples = 0;  ///< of the image, covered or not
    double seconds = 0;
};

/// Each of what a frame draws, as if they added up  [nanoseconds].
struct DrawCosts {
    double object = 0;    ///< a draw call
    double triangle = 0;  ///< up to the rasterizer, whatever becomes of it
    double vertex = 0;
    double pixel = 0;      ///< a fragment
    double sample = 0;     ///< clearing one of the image
    double frame = 0;      ///< what each frame costs besides
    double error = 0;      ///< median of how far frames are from what these say, as a share of them
    uint32_t samples = 0;  ///< frames that it was fitted to

    double nanosecondsOf(const CostSample& sample) const;
};

/// The costs, none below 0, with the least sum of squares of relative errors. Of what the samples cannot tell apart the sum
/// is right. O(samples).
DrawCosts fitDrawCosts(std::span<const CostSample> samples);

struct DrawCostSettings {
    uint32_t rounds = 5;                           ///< medians of so many
    uint32_t threads = 1;                          ///< that count fragments
    uint64_t seed = 1;                             ///< of what parts are taken
    std::function<void(size_t, size_t)> progress;  ///< called with (done, total) views; may be empty
};

/// Draws all items and parts of them, in two sizes; where the renderer can, also with few of their triangles, and objects
/// that are hardly more than a draw call. Takes some forty frames for each round and view.
/// @param views  with the items that are to be seen in them
struct CostView {
    View view;
    std::span<const studies::DrawItem> items;
};
DrawCosts measureDrawCosts(LoadedRenderer& renderer, std::span<const CostView> views,
                           const DrawCostSettings& settings = {});

}  // namespace sightline::tools
