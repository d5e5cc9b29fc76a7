// Views of the C interface: their defaults, and matrices for those who have none.
// SPDX-License-Identifier: MIT
#include "sightline/c/view.h"

#include <cstring>

#include "sightline/c/impl/convert.h"

using namespace sightline;

namespace {

void copyMatrix(const glm::dmat4& from, double to[16]) { std::memcpy(to, &from, sizeof from); }

}  // namespace

slView slDefaultView(void) {
    const View standard;
    slView view{};
    copyMatrix(standard.view, view.view);
    copyMatrix(perspective(1.0471975511965976, 1280.0 / 720.0, 0.1), view.projection);
    view.clip_space = SL_OPENGL;
    view.width = standard.width;
    view.height = standard.height;
    view.jitter = standard.jitter;
    view.layers = standard.layers;
    view.cookie = c::kViewCookie;
    return view;
}

void slLookAt(double view_out[16], const double eye[3], const double target[3], const double up[3]) {
    if (!view_out || !eye || !target || !up) return;
    copyMatrix(lookAt(c::vec(eye), c::vec(target), c::vec(up)), view_out);
}

void slPerspective(double projection_out[16], double fov_y, double aspect, double z_near, double z_far) {
    if (projection_out) copyMatrix(perspective(fov_y, aspect, z_near, z_far), projection_out);
}

void slOrthographic(double projection_out[16], double height, double aspect, double z_near, double z_far) {
    if (projection_out) copyMatrix(orthographic(height, aspect, z_near, z_far), projection_out);
}

const char* slViewProblem(const slView* from) {
    View view;
    if (c::toView(from, slSilence(), "slViewProblem", view) != SL_OK)
        return "the view is null, did not begin as slDefaultView(), or has a clip_space or a count beyond its limits";
    const ViewProblem problem = problemOf(view);
    return problem == ViewProblem::kNone ? nullptr : wordsOf(problem);
}
