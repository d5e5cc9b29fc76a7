// What an exact z-buffer shows of an occlusion scene: which boxes have a sample in sight, and the plain box test on it.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bench/occlusion_scenes.h"
#include "sightline/hidden/zbuffer.h"
#include "sightline/raster/tiles.h"

namespace sightline::bench {

struct BoxTruthSettings {
    uint32_t supersampling = 4;          ///< samples per pixel and axis  [>= 1]
    uint32_t jitters = 1;                ///< pictures, each shifted otherwise by up to half a sample  [>= 1]
    uint64_t seed = 1;                   ///< of the shifts
    uint64_t band_samples = 1ull << 23;  ///< drawn at once: 12 bytes each
};

/// Draws batches in double, and then the boxes into the picture that they make; a box at equal depth is in sight.
/// @param batches  by the scene's numbers
/// @param boxes    by the scene's numbers
/// @returns for boxes[i] 1 if any sample of any picture shows it
std::vector<uint8_t> boxesInSight(const OcclusionScene& scene, std::span<const uint32_t> batches,
                                  std::span<const uint32_t> boxes, const View& view, const BoxTruthSettings& settings);

/// The scalar baseline: all triangles of the batches in a z-buffer in double, a sample at each pixel's centre.
ZBufferImage drawBatches(const OcclusionScene& scene, std::span<const uint32_t> batches, const View& view);

/// The plain box test: whether the rectangle is farther than the picture at each of its pixels.
bool isBehind(const ZBufferImage& image, const PixelRect& rect);

}  // namespace sightline::bench
