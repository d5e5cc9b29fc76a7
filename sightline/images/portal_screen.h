// Puts the picture of a doorway where the doorway is in a viewer's image, behind what stands before it.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/images/portal_frame.h"
#include "sightline/images/portal_images.h"

namespace sightline::images {

/// The samples of a view that look through a doorway: of its outline, in front of the eye.
/// @param view  perspective
/// @returns indices of samples, row by row
std::vector<uint32_t> samplesThrough(const PortalFrame& frame, const View& view);

/// Draws a picture as a texture of its doorway: each sample is taken between the four texels around the place where
/// its line of sight meets it. Where something stands nearer than the doorway the sample stays as it is.
/// @param nearness  of what is drawn: 1 / w, 0 or less for nothing  [size: width * height, or empty for nothing at all]
/// @param colours   in/out  [size: width * height]
/// @returns how many samples were drawn
uint64_t drawOnScreen(const PortalFrame& frame, const PortalPicture& picture, const View& view,
                      std::span<const float> nearness, std::span<glm::u8vec3> colours);

}  // namespace sightline::images
