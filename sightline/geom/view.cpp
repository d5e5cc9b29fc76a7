// A view: where the eye is, how it projects, and what the caller declares about the frame.
// SPDX-License-Identifier: MIT
#include "sightline/geom/view.h"

#include <algorithm>
#include <cmath>

namespace sightline {

glm::dmat4 lookAt(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up) {
    const glm::dvec3 back = glm::normalize(eye - target);
    glm::dvec3 right = glm::cross(up, back);
    if (!(glm::dot(right, right) > 1e-18 * glm::dot(up, up))) {
        const glm::dvec3 other = std::abs(back.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
        right = glm::cross(other, back);
    }
    right = glm::normalize(right);
    const glm::dvec3 above = glm::cross(back, right);
    glm::dmat4 m(1.0);
    for (int column = 0; column < 3; ++column) {
        m[column][0] = right[column];
        m[column][1] = above[column];
        m[column][2] = back[column];
    }
    m[3] = glm::dvec4(-glm::dot(right, eye), -glm::dot(above, eye), -glm::dot(back, eye), 1.0);
    return m;
}

glm::dmat4 perspective(double fov_y, double aspect, double z_near, double z_far) {
    const double scale = 1.0 / std::tan(0.5 * fov_y);
    glm::dmat4 m(0.0);
    m[0][0] = scale / aspect;
    m[1][1] = scale;
    m[2][3] = -1.0;
    if (std::isinf(z_far)) {
        m[2][2] = -1.0;
        m[3][2] = -2.0 * z_near;
    } else {
        m[2][2] = -(z_far + z_near) / (z_far - z_near);
        m[3][2] = -2.0 * z_far * z_near / (z_far - z_near);
    }
    return m;
}

glm::dmat4 orthographic(double height, double aspect, double z_near, double z_far) {
    glm::dmat4 m(0.0);
    m[0][0] = 2.0 / (height * aspect);
    m[1][1] = 2.0 / height;
    m[3][3] = 1.0;
    if (std::isinf(z_far)) {
        // z = -1 at the near plane and 1 at 2^31 world units: small enough a slope for any world, and large enough for
        // the near plane to be known to a millionth of a unit.
        m[2][2] = -0x1p-30;
        m[3][2] = -1.0 - z_near * 0x1p-30;
    } else {
        m[2][2] = -2.0 / (z_far - z_near);
        m[3][2] = -(z_far + z_near) / (z_far - z_near);
    }
    return m;
}

glm::dvec3 eyePosition(const View& view) {
    // The inverse, not the transpose: a matrix that was rounded to float is not quite a rotation.
    return -(glm::inverse(glm::dmat3(view.view)) * glm::dvec3(view.view[3]));
}

View shiftedEye(const View& view, double right) {
    View shifted = view;
    shifted.view[3].x -= right;  // what stands before the eye moves the other way
    return shifted;
}

bool isOrthographic(const View& view) {
    const glm::dmat4& p = view.projection;
    return p[0][3] == 0.0 && p[1][3] == 0.0 && p[2][3] == 0.0;
}

double closedGap(const QuerySettings& settings) {
    if (!(settings.close_gaps > 0.0)) return 0.0;  // nor where it is not a number
    return std::floor(std::min(settings.close_gaps, 1.0 / 16.0) * kGapSteps) / kGapSteps;
}

namespace {

/// Whether a section may lay open what lies behind walls. The one that a mirror's view is cut by does not: sight lines begin
/// on it.
bool opensWalls(const View& view) {
    if (view.sections.count == 0) return false;
    if (view.sections.count > 1 || view.through.count == 0) return true;
    const glm::dvec4& plane = view.sections.planes[0];
    for (uint32_t i = 0; i < view.through.count; ++i) {
        const glm::dvec3& point = view.through.points[i];
        double size = std::abs(plane.w);
        for (int axis = 0; axis < 3; ++axis) size += std::abs(plane[axis] * point[axis]);
        if (!(std::abs(glm::dot(glm::dvec3(plane), point) + plane.w) <= 0x1p-30 * size)) return true;
    }
    return false;
}

}  // namespace

uint32_t stagesInUse(const View& view, const QuerySettings& settings) {
    uint32_t stages = settings.stages;
    if (!(settings.max_distance > 0.0)) stages &= ~stageBit(Stage::kDistance);  // nor where it is not a number
    if (!(settings.contribution > 0.0)) stages &= ~stageBit(Stage::kContribution);
    if (!(settings.lod_error > 0.0) && !(settings.budget > 0.0)) stages &= ~stageBit(Stage::kLod);
    if (opensWalls(view)) stages &= ~kCellStages;
    if (view.eye_radius != 0.0)
        stages &= stageBit(Stage::kPvs) | (isOrthographic(view) ? 0 : stageBit(Stage::kDistance));
    return stages;
}

namespace {

/// How far a rotation may be off: a matrix of floats that was multiplied many times.
constexpr double kRigid = 1e-3, kLastRow = 1e-6;

bool areFinite(const ViewPlanes& planes) {
    for (const glm::dvec4& plane : planes.all())
        for (int i = 0; i < 4; ++i)
            if (!std::isfinite(plane[i])) return false;
    return true;
}

bool areFinite(const ViewOutline& outline) {
    for (uint32_t i = 0; i < outline.count; ++i)
        for (int axis = 0; axis < 3; ++axis)
            if (!std::isfinite(outline.points[i][axis])) return false;
    return true;
}

}  // namespace

bool runsOutward(const View& view) {
    // Where z alone grows: from the eye, so that it is the eye turned about (its w is negative), or in parallel away from
    // the viewer.
    const glm::dvec4 deeper = glm::inverse(view.projection)[2];
    return isOrthographic(view) ? deeper.z < 0.0 : deeper.w < 0.0;
}

ViewProblem problemOf(const View& view) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(view.view[column][row]) || !std::isfinite(view.projection[column][row]))
                return ViewProblem::kNotFinite;
    if (view.width == 0 || view.height == 0 || !(view.jitter >= 0.0 && view.jitter <= 1e6) ||
        !(view.eye_radius >= 0.0 && std::isfinite(view.eye_radius)))
        return ViewProblem::kOutOfRange;
    const ViewOutline& through = view.through;
    if (view.sections.count > ViewPlanes::kMost || view.window.count > ViewPlanes::kMost ||
        through.count > ViewOutline::kMost || through.count == 1 || through.count == 2)
        return ViewProblem::kOutOfRange;
    if (!areFinite(view.sections) || !areFinite(view.window) || !areFinite(through)) return ViewProblem::kNotFinite;
    const double determinant = glm::determinant(view.projection);
    if (!std::isfinite(determinant) || determinant == 0.0) return ViewProblem::kSingular;
    const glm::dmat4& m = view.view;
    for (int column = 0; column < 4; ++column)  // an inverse that was computed is off a little
        if (!(std::abs(m[column][3] - (column == 3)) <= kLastRow)) return ViewProblem::kRowMajor;
    for (int i = 0; i < 3; ++i)
        for (int j = i; j < 3; ++j)
            if (!(std::abs(glm::dot(glm::dvec3(m[i]), glm::dvec3(m[j])) - (i == j)) <= kRigid))
                return ViewProblem::kNotRigid;
    if (glm::determinant(glm::dmat3(m)) < 0.0) return ViewProblem::kMirrors;
    return runsOutward(view) ? ViewProblem::kNone : ViewProblem::kReversed;
}

const char* wordsOf(ViewProblem problem) {
    switch (problem) {
        case ViewProblem::kNone:
            return "nothing is wrong";
        case ViewProblem::kNotFinite:
            return "a matrix, a plane or an outline is not finite";
        case ViewProblem::kOutOfRange:
            return "the viewport, the jitter, the eye's radius or a count is out of range";
        case ViewProblem::kSingular:
            return "the projection cannot be inverted";
        case ViewProblem::kRowMajor:
            return "the view matrix's last row is not 0 0 0 1 (is it row-major? transpose it)";
        case ViewProblem::kNotRigid:
            return "the view matrix scales or shears (it must rotate and move alone)";
        case ViewProblem::kMirrors:
            return "the view matrix mirrors (is it left-handed? say so to setMatrices())";
        case ViewProblem::kReversed:
            return "depth runs towards the eye (is it reversed? say so to setMatrices())";
    }
    return "";
}

bool isUsable(const View& view) {
    const ViewProblem problem = problemOf(view);
    return problem == ViewProblem::kNone || problem == ViewProblem::kReversed;
}

}  // namespace sightline
