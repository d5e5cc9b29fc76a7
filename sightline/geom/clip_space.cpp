// How a program's matrices project: conventions of clip space by their names, and views made from matrices of any of them.
// SPDX-License-Identifier: MIT
#include "sightline/geom/clip_space.h"

namespace sightline {
namespace {

/// Turns an eye space about, so that the eye looks the other way along z.
void turnHand(glm::dmat4& view, glm::dmat4& projection) {
    for (int column = 0; column < 4; ++column) view[column].z = -view[column].z;
    projection[2] = -projection[2];
}

}  // namespace

void setMatrices(View& to, const glm::dmat4& view, const glm::dmat4& projection, const ClipSpace& space) {
    to.view = view;
    to.projection = projection;
    if (space.left_handed) turnHand(to.view, to.projection);
    for (int i = 0; i < 4; ++i) {
        glm::dvec4& column = to.projection[i];
        if (space.y_down) column.y = -column.y;
        if (space.depth == ClipDepth::kZeroToOne) {
            const double depth = space.reversed ? column.w - column.z : column.z;
            column.z = 2.0 * depth - column.w;
        } else if (space.reversed) {
            column.z = -column.z;
        }
    }
}

ClipSpace tellClipSpace(const glm::dmat4& view, const glm::dmat4& projection) {
    View seen;
    seen.view = view;
    seen.projection = projection;
    ClipSpace space;
    // In perspective w grows away from the eye; of a parallel view only a view that mirrors tells.
    const bool parallel = isOrthographic(seen);
    space.left_handed = parallel ? glm::determinant(glm::dmat3(view)) < 0.0 : projection[2][3] > 0.0;
    if (space.left_handed) turnHand(seen.view, seen.projection);
    space.y_down = projection[1][1] < 0.0;
    space.reversed = !runsOutward(seen);
    // Depth at infinity: -1 or less where -1 stands for far, unless far is less than twice as far as near. To take such
    // depths for those from 1 to -1 moves the far plane away, and leaves the near one where it is.
    if (space.reversed && !parallel && seen.projection[2][2] / seen.projection[2][3] > -1.0)
        space.depth = ClipDepth::kZeroToOne;
    return space;
}

}  // namespace sightline
