// The eye in an object's space: never farther from the truth than it says, and faces the way that the world does.
// SPDX-License-Identifier: MIT
#include "sightline/geom/facing_eye.h"

#include <gtest/gtest.h>

#include "tests/cull/facing_oracle.h"
#include "tests/support/views.h"

namespace sightline {
namespace {

using test::Quad;
using test::QuadVector;

/// Turned, scaled, sheared, mirrored, nearly flat, and far away.
glm::dmat4 randomTransform(Random& random) {
    glm::dmat4 m(1.0);
    for (int column = 0; column < 3; ++column) {
        const glm::dvec3 v = test::randomVector(random, std::ldexp(1.0, static_cast<int>(random.below(16)) - 8));
        m[column] = glm::dvec4(v, 0.0);
    }
    if (random.below(4) == 0) m[2] = m[0] + 0.5 * m[1] + std::ldexp(1.0, -static_cast<int>(random.below(40))) * m[2];
    m[3] = glm::dvec4(test::randomVector(random, random.below(3) ? 10.0 : 1e6), 1.0);
    return m;
}

QuadVector place(const glm::dmat4& m, const glm::dvec3& p, double w) {
    QuadVector out{};
    Quad* to[3] = {&out.x, &out.y, &out.z};
    for (int row = 0; row < 3; ++row)
        *to[row] = Quad(m[0][row]) * p.x + Quad(m[1][row]) * p.y + Quad(m[2][row]) * p.z + Quad(m[3][row]) * w;
    return out;
}

Quad determinant(const glm::dmat4& m) {
    return test::dot(test::cross(test::quad(glm::dvec3(m[0])), test::quad(glm::dvec3(m[1]))),
                     test::quad(glm::dvec3(m[2])));
}

double lengthOf(const QuadVector& v) { return std::sqrt(static_cast<double>(test::dot(v, v))); }

/// How far the answer lies from the solution by Cramer's rule in 113 bits.
double distanceFromTruth(const glm::dmat4& m, const QuadVector& b, const glm::dvec3& x) {
    const QuadVector c[3] = {test::quad(glm::dvec3(m[0])), test::quad(glm::dvec3(m[1])), test::quad(glm::dvec3(m[2]))};
    const Quad whole = determinant(m);
    const QuadVector truth{test::dot(test::cross(b, c[1]), c[2]) / whole, test::dot(test::cross(c[0], b), c[2]) / whole,
                           test::dot(test::cross(c[0], c[1]), b) / whole};
    return lengthOf(truth - test::quad(x));
}

TEST(FacingEye, LiesNoFartherFromTheTruthThanItSays) {
    Random random(81);
    int known = 0, useful = 0;
    for (int i = 0; i < 20000; ++i) {
        const glm::dmat4 m = randomTransform(random);
        const View view = test::anyView(random, glm::dvec3(m[3]));
        if (isOrthographic(view)) continue;
        const FacingEye eye = facingEye(view, m);
        if (!eye.known()) continue;
        // The eye is where the view's equation in 113 bits has it.
        const QuadVector world = [&] {
            const glm::dmat4& v = view.view;
            const QuadVector c[3] = {test::quad(glm::dvec3(v[0])), test::quad(glm::dvec3(v[1])),
                                     test::quad(glm::dvec3(v[2]))};
            const QuadVector b = test::quad(-glm::dvec3(v[3]));
            const Quad whole = test::dot(test::cross(c[0], c[1]), c[2]);
            return QuadVector{test::dot(test::cross(b, c[1]), c[2]) / whole,
                              test::dot(test::cross(c[0], b), c[2]) / whole,
                              test::dot(test::cross(c[0], c[1]), b) / whole};
        }();
        ASSERT_LE(distanceFromTruth(m, world - test::quad(glm::dvec3(m[3])), eye.point), eye.error) << "case " << i;
        ++known, useful += eye.error < 1e-6 * (glm::length(eye.point) + 1e-3);
    }
    EXPECT_GT(useful, 8000);
    EXPECT_GE(known, useful);
}

TEST(FacingEye, FacesTheWayThatTheWorldDoesMirroredOrNot) {
    Random random(82);
    int judged = 0, mirrored = 0;
    for (int i = 0; i < 100000; ++i) {
        const glm::dmat4 m = randomTransform(random);
        const View view = test::anyView(random, glm::dvec3(m[3]));
        const FacingEye eye = facingEye(view, m);
        if (!eye.known()) continue;
        glm::dvec3 p[3];
        for (glm::dvec3& v : p) v = glm::dvec3(glm::vec3(test::randomVector(random, 1.0)));
        const glm::dvec3 n = glm::cross(p[1] - p[0], p[2] - p[0]);
        const double facing = glm::dot(n, eye.point - eye.w * p[0]);
        if (std::abs(facing) <= glm::length(n) * (2.0 * eye.error + 1e-12 * (1 + glm::length(eye.point)))) continue;
        // In the world: the winding turns where the transform mirrors.
        const bool parallel = eye.w == 0.0;
        const glm::dvec3 seen_from =
            parallel ? glm::dvec3(glm::transpose(glm::dmat3(view.view)) * glm::dvec3(0, 0, 1)) : eyePosition(view);
        const Quad world =
            test::trueFacing(place(m, p[0], 1), place(m, p[1], 1), place(m, p[2], 1), test::quad(seen_from), eye.w);
        const bool mirrors = determinant(m) < 0;
        ASSERT_EQ(facing > 0, (world > 0) != mirrors) << "case " << i;
        ++judged, mirrored += mirrors;
    }
    EXPECT_GT(judged, 50000);
    EXPECT_GT(mirrored, 20000);
}

TEST(FacingEye, OfAFlatOrBrokenTransformIsNotKnown) {
    View view;
    view.projection = perspective(1.0, 1.0, 0.1);
    EXPECT_TRUE(facingEye(view, glm::dmat4(1.0)).known());
    glm::dmat4 flat(1.0);
    flat[2] = flat[1];
    EXPECT_FALSE(facingEye(view, flat).known());
    EXPECT_FALSE(cornerRays(view, flat).known());
    flat[2] = glm::dvec4(0, 0, NAN, 0);
    EXPECT_FALSE(facingEye(view, flat).known());
    EXPECT_FALSE(cornerRays(view, flat).known());
    view.projection = glm::dmat4(0.0);
    EXPECT_FALSE(cornerRays(view, glm::dmat4(1.0)).known());
    EXPECT_FALSE(facingEye(view, glm::dmat4(1.0)).known());
}

TEST(CornerRays, GoThroughTheCornersOfTheWindow) {
    Random random(83);
    int judged = 0;
    for (int i = 0; i < 1000; ++i) {
        View view = test::anyView(random, {0, 0, 0});
        view.jitter = 0;
        const glm::dmat4 m = randomTransform(random);
        const CornerRays rays = cornerRays(view, m);
        const FacingEye eye = facingEye(view, m);
        if (!rays.known() || !eye.known()) continue;
        const glm::dmat4 to_clip = view.projection * view.view * m;
        ++judged;
        const glm::dvec2 corners[4] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
        for (int k = 0; k < 4; ++k) {
            const glm::dvec4 ahead = to_clip * glm::dvec4(rays.ray[k], 0.0);
            if (isOrthographic(view)) {
                const double scale = std::abs(ahead.z);
                ASSERT_GT(ahead.z, 0);
                ASSERT_NEAR(ahead.x / scale, 0, 1e-5);
                ASSERT_NEAR(ahead.y / scale, 0, 1e-5);
            } else {
                ASSERT_GT(ahead.w, 0);
                ASSERT_NEAR(ahead.x / ahead.w, corners[k].x, 1e-5);
                ASSERT_NEAR(ahead.y / ahead.w, corners[k].y, 1e-5);
            }
        }
    }
    EXPECT_GT(judged, 500);
}

}  // namespace
}  // namespace sightline
