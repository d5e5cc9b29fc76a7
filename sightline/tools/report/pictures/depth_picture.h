// A picture of an occlusion buffer: what it claims, near to far, and where it is open.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "sightline/tools/report/pictures/png.h"

namespace sightline::tools {

/// An occlusion buffer as Query::depthImage() and readDepthImage() give it: rows from below.
struct DepthClaims {
    uint32_t width = 0, height = 0;
    bool perspective = true;           ///< nearness is 1 over the distance; else minus the distance
    std::span<const float> nearness;   ///< [size: width * height]
    std::span<const uint8_t> covered;  ///< [size: width * height]
};

/// Grey by the logarithm of the distance, from the nearest claim (light) to the farthest (dark); open pixels are blue.
/// In parallel views the distance itself is taken: it may be zero, or behind the eye.
Image<Rgb> depthPicture(const DepthClaims& claims);

/// The part of a buffer's picture that is the viewport, at another size, each pixel as the nearest one of the buffer: the
/// buffer holds the viewport widened by the jitter, in whole tiles, so that its pixels are not quite square.
/// @param viewport  [pixels]
/// @param jitter    that the buffer was drawn for  [viewport pixels]
Image<Rgb> viewportPart(const Image<Rgb>& buffer, const glm::dvec2& viewport, double jitter, uint32_t width,
                        uint32_t height);

/// What open pixels are painted with.
inline constexpr Rgb kOpenPixel{36, 84, 164};

}  // namespace sightline::tools
