// Where an occludee stands before an eye, and how exactly that is known.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/base/assert.h"
#include "sightline/buffer/ask/occludee_box.h"
#include "sightline/math/box.h"

namespace sightline {

/// The map from an occludee's own space to the buffer, with bounds on its rounding.
struct OccludeePlace {
    Screen screen;           ///< objectScreen() of the transform
    bool reverse = false;    ///< what is counter-clockwise in its own space comes out clockwise
    double pixel_error = 0;  ///< bound on the rounding of a projected point at w = 1  [pixels]
    double depth_error = 0;  ///< bound on the rounding of its w, or of its depth in parallel projection
    bool clips = false;      ///< and of its distance from the near plane: small against Screen::near_guard

    /// Bound on the error of a projected point.  [pixels]
    /// @param w  no point asked about has less  [> 0]
    double positionError(double w) const {
        SIGHTLINE_DEBUG_ASSERT(w > 0);
        return 0x1p-36 + pixel_error / w;
    }
    /// Of its nearness.
    double depthError(double w) const {
        SIGHTLINE_DEBUG_ASSERT(w > 0);
        return screen.perspective ? depth_error / (w * w) : depth_error;
    }
};

/// @param screen     makeScreen()
/// @param transform  own space to world, affine
/// @param bounds     of all that will be asked about, in its own space
OccludeePlace makeOccludeePlace(const Screen& screen, const glm::dmat4& transform, const Box3d& bounds);

/// A box in the occludee's own space, to be held against planes.
/// @param place  must outlive it
inline OccludeeBox boxAt(const OccludeePlace& place, const Box3d& box) {
    return OccludeeBox(place.screen, box, {0.0, place.pixel_error, place.depth_error});
}

}  // namespace sightline
