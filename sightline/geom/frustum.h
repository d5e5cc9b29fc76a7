// The planes of a view's frustum, seen from the eye.
// SPDX-License-Identifier: MIT
//
// Gil Gribb, Klaus Hartmann. Fast Extraction of Viewing Frustum Planes from the World-View-Projection
// Matrix. 2001.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "sightline/geom/view.h"

namespace sightline {

/// Up to six planes, normals inward and of unit length, for positions relative to the eye:
/// dot(n, p - eye) + d >= 0 inside. Order: left, right, bottom, top, near, far; a plane that a projection
/// does not have (an infinite far plane) is left out.
struct Frustum {
    glm::dvec3 eye{0.0};
    glm::dvec4 planes[6];
    uint8_t side[6] = {};  ///< per plane: which of the six it is, in that order
    uint32_t count = 0;
};

/// The frustum of a view, widened on each side by the view's jitter.
/// @param view  isUsable(view)
Frustum makeFrustum(const View& view);

}  // namespace sightline
