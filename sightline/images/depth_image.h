// Reference images: colour and depth of each sample, with the slope of its surface, ready to be warped into other views.
// SPDX-License-Identifier: MIT
//
// Leonard McMillan, Gary Bishop. Plenoptic Modeling: An Image-Based Rendering System. 1995.
// Voicu Popescu, Anselmo Lastra, Daniel Aliaga, Manuel de Oliveira Neto. Efficient Warping for Architectural Walkthroughs
// Using Layered Depth Images. 1998.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/geom/view.h"
#include "sightline/studies/hidden/render.h"
#include "sightline/studies/hidden/shade/shade.h"

namespace sightline::images {

/// What one sample shows: a piece of a plane. Over a plane nearness is affine in the image, so that the piece is known
/// exactly from three numbers.
struct DepthSample {
    float nearness = 0;                 ///< 1 / w at the sample's centre; 0: nothing is there, or it is infinitely far
    float per_sample = 0, per_row = 0;  ///< how it changes from sample to sample and from row to row
    glm::u8vec3 colour{0};              ///< sRGB
    uint8_t from_behind = 0;            ///< 1: the view's eye is behind the piece; others' eyes may see it
};
static_assert(sizeof(DepthSample) == 16);

/// One sample a pixel. Row 0 is the bottom row.
struct DepthImage {
    View view;                         ///< a perspective view
    std::vector<DepthSample> samples;  ///< [size: width * height]

    size_t bytes() const { return samples.size() * sizeof(DepthSample); }
};

/// How reference images are drawn. Haze and shadow maps depend on the eye, and so does what they leave in an image: an
/// image that is shown to other eyes is best taken without.
struct TakeSettings {
    studies::RenderSettings render;
    studies::ShadeSettings shade;
};

/// Draws, shades and measures what a view shows.
/// @param view  perspective
DepthImage takeImage(const studies::DrawList& list, const View& view, const TakeSettings& settings);

/// Colours alone, smooth at edges.
struct ColourImage {
    std::vector<glm::u8vec3> colours;  ///< sRGB  [size: width * height]
    bool has_sky = false;              ///< somewhere nothing is drawn
};

/// Draws and shades what a view shows; each pixel is the mean of its samples.
/// @param view    perspective
/// @param across  samples along each side of a pixel  [>= 1]
ColourImage takeColours(const studies::DrawList& list, const View& view, const TakeSettings& settings, uint32_t across);

}  // namespace sightline::images
