// The eye of a view in an object's own space, and how well it is known there: what every test for back faces starts from.
// SPDX-License-Identifier: MIT
#include "sightline/geom/facing_eye.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUnit = 0x1p-53;

/// The largest sum of a row's sizes.
double normOf(const glm::dmat3& m) {
    double largest = 0;
    for (int row = 0; row < 3; ++row)
        largest = std::max(largest, std::abs(m[0][row]) + std::abs(m[1][row]) + std::abs(m[2][row]));
    return largest;
}

double normOf(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// A matrix with an approximate inverse, and a bound on how much that one enlarges what remains of an equation.
struct Solver {
    glm::dmat3 matrix, inverse;
    double size = 0, gain = kInfinity;

    explicit Solver(const glm::dmat3& m) : matrix(m), inverse(glm::inverse(m)) {
        // If X A = 1 - E with |E| < 1, then the inverse is (1 - E)^-1 X, at most |X| / (1 - |E|).
        size = normOf(matrix);
        const double amount = normOf(inverse);
        const double off = normOf(glm::dmat3(1.0) - inverse * matrix) + 8 * kUnit * amount * size;
        if (off < 0.5) gain = amount / (1.0 - off);
    }

    /// @param known_to  error of b on each axis
    /// @returns the error of x in the equation A x = b, as a length
    double solve(const glm::dvec3& b, double known_to, glm::dvec3& x) const {
        x = inverse * b;
        const double rounding = 8 * kUnit * (size * normOf(x) + normOf(b));
        const double error = 2.0 * gain * (normOf(matrix * x - b) + rounding + known_to);
        return error < kInfinity ? error : kInfinity;  // nor what is not a number
    }
};

/// Towards the eye, or along a place's line of sight in a perspective view; in world space.
glm::dvec3 alongView(const View& view, const glm::dvec2& place) {
    // The direction of all points on the place's line is (p at one depth) - (p at another), or p - eye.
    const glm::dmat4 inverse = glm::inverse(view.projection);
    glm::dvec3 v;
    if (isOrthographic(view)) {
        v = glm::dvec3(inverse * glm::dvec4(0, 0, 1, 0));
    } else {
        const glm::dvec4 p = inverse * glm::dvec4(place, -1, 1);
        v = glm::dvec3(p) / p.w;
        v /= std::abs(v.z);  // to one depth, so that it is affine in the place
    }
    return glm::inverse(glm::dmat3(view.view)) * v;
}

/// How far places and directions that were found from the projection's inverse may be off, as a share.
constexpr double kViewError = 0x1p-44;

}  // namespace

FacingEye facingEye(const View& view, const glm::dmat4& transform, FrontFace front) {
    FacingEye eye;
    eye.front = front;
    eye.error = kInfinity;
    const Solver solver{glm::dmat3(transform)};
    if (isOrthographic(view)) {
        const glm::dvec3 ahead = alongView(view, {0, 0});
        glm::dvec3 x;
        const double error = solver.solve(-ahead, kViewError * glm::length(ahead), x);
        const double length = glm::length(x);
        eye.w = 0;
        if (!(length > 0)) return eye;
        eye.point = x / length;
        eye.error = 2.0 * error / length + 4 * kUnit;
    } else {
        const glm::dvec3 world = eyePosition(view), shift(transform[3]);
        const double known_to = 0x1p-48 * glm::length(world) + kUnit * glm::length(world - shift);
        eye.error = solver.solve(world - shift, known_to, eye.point);
    }
    if (!(eye.error < kInfinity)) eye.error = kInfinity;
    return eye;
}

CornerRays cornerRays(const View& view, const glm::dmat4& transform, const glm::dvec4& window) {
    CornerRays rays;
    const Solver solver{glm::dmat3(transform)};
    const glm::dvec2 wider = 2.0 * view.jitter / glm::dvec2(view.width, view.height);
    const double x[4] = {window[0] - wider.x, window[2] + wider.x, window[2] + wider.x, window[0] - wider.x};
    const double y[4] = {window[1] - wider.y, window[1] - wider.y, window[3] + wider.y, window[3] + wider.y};
    for (int i = 0; i < 4; ++i) {
        const glm::dvec3 ahead = alongView(view, {x[i], y[i]});
        const double error = solver.solve(ahead, kViewError * glm::length(ahead), rays.ray[i]);
        const double share = error / glm::length(rays.ray[i]);
        rays.error = share <= kInfinity ? std::max(rays.error, share) : kInfinity;
    }
    return rays;
}

}  // namespace sightline
