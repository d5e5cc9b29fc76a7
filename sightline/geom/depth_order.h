// Whether a view's depth runs away from the eye, as the culling stages take it to.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/geom/view.h"

namespace sightline {

/// True if z / w grows with the distance from the eye, so that the far plane stands behind the near one. Reversed depth
/// stands the other way round: what its near plane cuts away would hide.
/// @param view  isUsable(view)
inline bool runsOutward(const View& view) {
    // Where z alone grows: from the eye, so that it is the eye turned about (its w is negative), or in parallel away from
    // the viewer.
    const glm::dvec4 deeper = glm::inverse(view.projection)[2];
    return isOrthographic(view) ? deeper.z < 0.0 : deeper.w < 0.0;
}

}  // namespace sightline
