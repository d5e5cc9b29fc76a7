// What an exact z-buffer shows of an occlusion scene: which boxes have a sample in sight, and the plain box test on it.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "bench/occlusion_scenes.h"
#include "sightline/buffer/tiles.h"
#include "sightline/studies/hidden/zbuffer/zbuffer.h"

namespace sightline::bench {
using namespace studies;

struct BoxTruthSettings {
    uint32_t supersampling = 4;          ///< samples per pixel and axis  [>= 1]
    uint32_t jitters = 1;                ///< pictures, each shifted otherwise by up to half a sample; a square number
                                         ///< of them has its shifts spread evenly
    uint64_t seed = 1;                   ///< of the shifts
    uint64_t band_samples = 1ull << 23;  ///< drawn at once: 12 bytes each, per thread
    uint32_t threads = 1;                ///< [>= 1]; the answer is the same for any number
};

/// A box, and whether a sample shows it.
struct BoxSighting {
    bool seen = false;
    glm::dvec2 pixel{0.0};  ///< where [pixels from the left and the bottom]
};

/// Draws batches in double, and then the boxes into the picture that they make; a box at equal depth is in sight.
/// @param batches   by the scene's numbers
/// @param boxes     by the scene's numbers
/// @returns for boxes[i] whether any sample of any picture shows it, and where the first of them does
std::vector<BoxSighting> sightBoxes(const OcclusionScene& scene, std::span<const uint32_t> batches,
                                    std::span<const uint32_t> boxes, const View& view,
                                    const BoxTruthSettings& settings);

/// The same: for boxes[i] 1 if any sample shows it.
std::vector<uint8_t> boxesInSight(const OcclusionScene& scene, std::span<const uint32_t> batches,
                                  std::span<const uint32_t> boxes, const View& view, const BoxTruthSettings& settings);

/// The scalar baseline: all triangles of the batches in a z-buffer in double, a sample at each pixel's centre.
ZBufferImage drawBatches(const OcclusionScene& scene, std::span<const uint32_t> batches, const View& view);

/// The plain box test: whether the rectangle is farther than the picture at each of its pixels.
bool isBehind(const ZBufferImage& image, const PixelRect& rect);

}  // namespace sightline::bench
