// The planes of a view's frustum, seen from the eye.
// SPDX-License-Identifier: MIT
#include "sightline/geom/frustum.h"

#include <cmath>

namespace sightline {

Frustum makeFrustum(const View& view) {
    Frustum frustum;
    frustum.eye = eyePosition(view);
    // Relative to the eye the view is a pure rotation: no large translation enters the planes.
    const glm::dmat4 m = view.projection * glm::dmat4(glm::dmat3(view.view));
    const auto row = [&](int r) { return glm::dvec4(m[0][r], m[1][r], m[2][r], m[3][r]); };
    const double wide_x = 1.0 + 2.0 * view.jitter / view.width;
    const double wide_y = 1.0 + 2.0 * view.jitter / view.height;
    const glm::dvec4 planes[6] = {wide_x * row(3) + row(0), wide_x * row(3) - row(0), wide_y * row(3) + row(1),
                                  wide_y * row(3) - row(1), row(3) + row(2),          row(3) - row(2)};
    for (uint8_t side = 0; side < 6; ++side) {
        const glm::dvec4& plane = planes[side];
        const double length = glm::length(glm::dvec3(plane));
        if (!(length > 1e-15 * glm::length(row(3)))) continue;
        frustum.side[frustum.count] = side;
        frustum.planes[frustum.count++] = plane / length;
    }
    return frustum;
}

}  // namespace sightline
