// From eye-relative positions to the pixels and the depth of an occlusion buffer.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "sightline/geom/view.h"

namespace sightline {

/// The rows of the map from a position q = world - eye to buffer pixels: with h = (q, 1),
///     pixel x = (x.h) / (w.h),  pixel y = (y.h) / (w.h),  nearness = (d.h) / (w.h).
/// The buffer covers the viewport widened by the jitter on every side, so that pixel (0, 0) is its lower left
/// corner. Nearness is affine over a plane's image and larger for nearer points: 1/w in perspective, minus the
/// depth in parallel projection. Drawn points have near.h >= 0.
struct Screen {
    glm::dvec3 eye{0.0};
    glm::dvec4 x{0.0}, y{0.0}, w{0.0}, d{0.0}, near{0.0};
    bool perspective = true;
    bool mirrored = false;           ///< counter-clockwise triangles come out clockwise
    uint32_t width = 1, height = 1;  ///< of the buffer [pixels]
    double near_w = 0.0;             ///< w.h of points on the near plane; 0 if it is not the same for all of them
    double near_guard = 0.0;         ///< occluders are clipped at near.h >= near_guard, where they are surely drawn
};

/// @param view       isUsable(view)
/// @param max_size  the buffer's longer side is no longer than this, rounded up to whole tiles  [pixels, 1 to 8192]
Screen makeScreen(const View& view, uint32_t max_size);

/// The rows for positions in object space: position -> transform -> minus eye -> rows.
Screen objectScreen(const Screen& screen, const glm::dmat4& transform);

}  // namespace sightline
