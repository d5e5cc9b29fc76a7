// Layered depth images: several reference images in one, so that what one of them does not see is not a hole.
// SPDX-License-Identifier: MIT
//
// Jonathan Shade, Steven Gortler, Li-wei He, Richard Szeliski. Layered Depth Images. 1998.
// Voicu Popescu, Anselmo Lastra, Daniel Aliaga, Manuel de Oliveira Neto. Efficient Warping for Architectural Walkthroughs
// Using Layered Depth Images. 1998.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sightline/images/depth_image.h"
#include "sightline/images/warp.h"

namespace sightline::images {

/// The samples of every pixel, far to near.
struct LayeredImage {
    View view;
    std::vector<uint32_t> first;       ///< where a pixel's samples begin  [size: width * height + 1]
    std::vector<DepthSample> samples;  ///<

    SampleLists lists() const { return {samples, first}; }
    size_t bytes() const { return samples.size() * sizeof(DepthSample) + first.size() * sizeof(uint32_t); }
    /// Samples of the pixel that has most.
    uint32_t mostLayers() const;
};

struct LayerSettings {
    /// Samples of a pixel are one if their nearness differs by less, relative to the nearer. The first one stays.
    double tolerance = 0.01;
    uint32_t most_layers = 8;  ///< of a pixel; the samples of later images are dropped beyond  [>= 1]
    double most_stretch = 8;   ///< WarpSettings::most_stretch
};

/// Carries the samples of all references into one view, each onto the pixels that its piece of plane covers there, and
/// merges what is the same. References that come first stay as they are; what later ones add is what the earlier did not
/// see. Before what a first reference of the view's own eye sees, no front is put; one of the view itself is taken over
/// exactly. Backs are kept: they are fronts to other eyes.
/// @param view  perspective
LayeredImage layeredImage(std::span<const DepthImage> references, const View& view, const LayerSettings& settings = {});

}  // namespace sightline::images
