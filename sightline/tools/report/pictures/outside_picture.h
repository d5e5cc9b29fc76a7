// A run seen from outside: the whole scene with the camera's path in it, and what a frame drew and what it culled.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/geom/view.h"
#include "sightline/tools/report/pictures/picture.h"
#include "sightline/tools/report/pictures/png.h"

namespace sightline::tools {

/// The whole scene, with the path that an eye takes through it.
struct Overview {
    Image<Rgb> image;  ///< without pixels if there is nothing to show
    std::vector<std::optional<glm::dvec2>>
        eyes;  ///< where each is, in parts of the width and the height from the upper
               ///< left corner; none: not in the picture
};

/// The eyes are joined by a line, but where one jumps: farther than four times the median step, and than a twentieth of the scene. The
/// picture holds the scene and the eyes that are joined; what of the line is behind a surface is paler, and a dot is where it begins.
/// @param eyes   of the frames, in their order
/// @param width  of the picture, which is 16 by 9  [pixels]
Overview overviewPicture(const PictureMaker& maker, std::span<const glm::dvec3> eyes, uint32_t width);

/// A frame from behind and above its eye: what was drawn is solid, what was culled is wires in the colour of its stage, and the view's
/// frustum is lines. Where a roof is over the eye, all that lies above it is cut away.
/// @param view     of the frame; the picture has its size
/// @param reasons  per object: 0 visible, else 1 + Stage  [size: objects]
Image<Rgb> outsidePicture(const PictureMaker& maker, const View& view, std::span<const uint8_t> reasons);

}  // namespace sightline::tools
