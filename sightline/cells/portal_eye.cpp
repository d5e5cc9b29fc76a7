// The rows of a view, its near rectangle, and bounds on what rounding does to them.
// SPDX-License-Identifier: MIT
#include "sightline/cells/portal_eye.h"

#include "sightline/base/assert.h"
#include "sightline/math/finite.h"

#include <algorithm>
#include <cmath>

namespace sightline {
namespace {

glm::dmat3 matrixOfRows(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return glm::transpose(glm::dmat3(a, b, c));
}

}  // namespace

bool makePortalEye(const View& view, double tolerance, double reach, PortalEye& eye) {
    SIGHTLINE_DEBUG_ASSERT(isUsable(view) && tolerance >= 0 && reach >= 0);
    eye.origin = eyePosition(view);
    // Relative to the eye the view is a rotation: no large translation enters the rows.
    glm::dmat4 m = view.projection * glm::dmat4(glm::dmat3(view.view));
    const bool parallel = isOrthographic(view);
    if (parallel) {
        if (!(m[3][3] > 0)) return false;
        m /= m[3][3];
    }
    const auto row = [&](int r) { return glm::dvec3(m[0][r], m[1][r], m[2][r]); };
    eye.rows[0] = row(0);
    eye.rows[1] = row(1);
    eye.rows[2] = row(3);
    eye.shift = {m[3][0], m[3][1], m[3][3]};
    for (int i = 0; i < 3; ++i) eye.lengths[i] = glm::length(eye.rows[i]);
    eye.wide[0] = 1.0 + 2.0 * view.jitter / view.width;
    eye.wide[1] = 1.0 + 2.0 * view.jitter / view.height;

    // On the near plane z + w is 0.
    const glm::dvec3 depth_row = row(2) + row(3);
    const double depth_shift = m[3][2] + m[3][3];
    eye.center = eye.origin;
    eye.direction = glm::dvec3(0.0);
    glm::dvec3 shift(0.0);  // from the origin to where sight lines meet
    glm::dmat3 to_world;
    if (parallel) {
        to_world = glm::inverse(matrixOfRows(eye.rows[0], eye.rows[1], depth_row));
        const glm::dvec3 across = glm::cross(eye.rows[0], eye.rows[1]);
        eye.direction = across * ((glm::dot(across, row(2)) > 0 ? 1.0 : -1.0) / glm::length(across));
        if (!isFinite(eye.direction)) return false;
    } else {
        to_world = glm::inverse(matrixOfRows(eye.rows[0], eye.rows[1], eye.rows[2]));
        if (eye.shift != glm::dvec3(0.0)) shift = -(to_world * eye.shift);
        eye.center = eye.origin + shift;
        if (!isFinite(eye.center)) return false;
    }
    eye.near_w = parallel ? 1 : INFINITY;
    double near_size = 0;
    for (int i = 0; i < 4; ++i) {
        const double x = (i & 1 ? 1 : -1) * eye.wide[0], y = (i & 2 ? 1 : -1) * eye.wide[1];
        glm::dvec3 corner;
        if (parallel) {
            corner = to_world * glm::dvec3(x - eye.shift.x, y - eye.shift.y, -depth_shift);
        } else {
            const glm::dvec3 along = to_world * glm::dvec3(x, y, 1);  // w = 1
            const double w = -(glm::dot(depth_row, shift) + depth_shift) / glm::dot(depth_row, along);
            if (!(w > 0)) return false;
            eye.near_w = std::min(eye.near_w, w);
            corner = shift + w * along;
        }
        if (!isFinite(corner)) return false;
        near_size = std::max(near_size, glm::length(corner));
        eye.near_corners[i] = eye.origin + corner;
    }
    // Differences of coordinates, products with rows and sums of three of them round by 2^-53 each: eight such steps
    // are far from 2^-48 of the coordinates. The same holds for the eye itself, which is a sum of products.
    const glm::dvec3 far = glm::max(glm::abs(eye.origin), glm::abs(eye.center));
    eye.position = tolerance + 0x1p-46 * (reach + std::max({far.x, far.y, far.z}) + glm::length(shift));
    // Quotients and the cutting of windows round image coordinates by 2^-51 for each portal of a chain. What a plane
    // through the eye says of a point rounds by 2^-51 of how fast the image moves.
    const double w_length = std::max(eye.lengths[2], parallel ? 1e-300 : 0);
    for (int i = 0; i < 2; ++i) {
        const double speed = parallel ? 1 : eye.lengths[i] / w_length;
        eye.slack[i] = 0x1p-36 * eye.wide[i] + 0x1p-46 * speed;
        if (!std::isfinite(eye.slack[i])) return false;
    }
    eye.image = WindowBounds::nothing();
    for (int i = 0; i < 4; ++i) eye.image.grow((i & 1 ? 1 : -1) * eye.wide[0], (i & 2 ? 1 : -1) * eye.wide[1]);
    eye.image.widen(eye.slack[0], eye.slack[1]);
    SIGHTLINE_DEBUG_ASSERT(!eye.image.isEmpty(8) && eye.near_w > 0 && eye.position >= tolerance);
    return true;
}

}  // namespace sightline
