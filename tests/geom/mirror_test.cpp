// Mirrors: each point that is reflected into the eye lies in the mirrored view, and projects where the image says.
// SPDX-License-Identifier: MIT
#include "sightline/geom/mirror.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/geom/frustum.h"
#include "sightline/geom/view_limits.h"
#include "tests/support/random.h"

namespace sightline {
namespace {

struct Glass {
    glm::dvec3 center, u, v, normal;
    std::vector<glm::dvec3> outline;
};

Glass madeGlass(Random& random, uint32_t corners, const glm::dvec3& around) {
    Glass glass;
    glass.center = around + test::randomVector(random, 3);
    glass.normal = glm::normalize(test::randomVector(random, 1));
    glass.u = glm::normalize(glm::cross(glass.normal, test::randomVector(random, 1)));
    glass.v = glm::cross(glass.normal, glass.u);
    for (uint32_t i = 0; i < corners; ++i) {
        const double angle = 6.283185307179586 * i / corners;
        glass.outline.push_back(glass.center + std::cos(angle) * glass.u + std::sin(angle) * glass.v);
    }
    return glass;
}

TEST(Mirror, HoldsWhatIsReflectedIntoTheEye) {
    Random random(5);
    int seen = 0, beside = 0;
    for (int i = 0; i < 20000; ++i) {
        const glm::dvec3 around = (i % 5 == 0 ? 1e5 : 1.0) * test::randomVector(random, 1);
        const double scale = 1.0 + glm::length(around);
        const Glass glass = madeGlass(random, 3 + static_cast<uint32_t>(random.below(10)), around);
        const glm::dvec3 eye = glass.center + test::randomVector(random, 4);
        View view;
        // The eye looks at some point of the glass, off-centre.
        const glm::dvec3 on = glass.center + random.uniform(-0.3, 0.3) * glass.u + random.uniform(-0.3, 0.3) * glass.v;
        view.view = lookAt(eye, on + test::randomVector(random, 0.3), test::randomVector(random, 1));
        view.projection = i % 3 == 0 ? orthographic(3, 1.5, 0.01, 1e3) : perspective(1.2, 1.5, 0.01);
        view.projection[2][0] += i % 3 == 0 ? 0 : 0.2;
        const auto mirrored = mirroredView(view, glass.outline);
        const glm::dvec3 backward(view.view[0][2], view.view[1][2], view.view[2][2]);
        const bool parallel = i % 3 == 0;
        const double front = parallel ? glm::dot(glass.normal, backward) : glm::dot(glass.normal, eye - glass.center);
        ASSERT_EQ(mirrored.has_value(), front > 0) << "case " << i;
        if (!mirrored) {
            ++beside;
            continue;
        }
        ASSERT_TRUE(isUsable(*mirrored));
        ASSERT_TRUE(runsOutward(*mirrored));
        ASSERT_NEAR(glm::determinant(glm::dmat3(mirrored->view)), 1.0, 1e-9);
        // The sight line from the eye to the glass, by the law of reflection, and a point on it.
        const glm::dvec3 origin = parallel ? on + 2.0 * backward : eye;
        const glm::dvec3 in = glm::normalize(on - origin), out = in - 2.0 * glm::dot(in, glass.normal) * glass.normal;
        const glm::dvec3 point = on + random.uniform(0.01, 5.0) * out;
        const glm::dvec4 there = mirrored->projection * mirrored->view * glm::dvec4(point, 1.0);
        const glm::dvec4 here = view.projection * view.view * glm::dvec4(on, 1.0);
        ASSERT_GT(there.w, 0);
        ASSERT_NEAR(there.x / there.w, -here.x / here.w, 1e-9 * scale / std::min(1.0, here.w)) << "case " << i;
        ASSERT_NEAR(there.y / there.w, here.y / here.w, 1e-9 * scale / std::min(1.0, here.w)) << "case " << i;
        const ViewLimits limits = makeViewLimits(*mirrored, eyePosition(*mirrored));
        for (uint32_t plane = 0; plane < limits.volume.count; ++plane)
            ASSERT_GE(glm::dot(limits.volume.planes[plane], glm::dvec4(point - limits.volume.eye, 1.0)), -1e-9 * scale)
                << "case " << i << ", plane " << plane;
        ASSERT_GE(glm::dot(mirrored->sections.planes[0], glm::dvec4(point, 1.0)), 0.0);
        ASSERT_GE(mirrored->through.count, 3u);
        ++seen;
    }
    EXPECT_GT(seen, 5000);
    EXPECT_GT(beside, 5000);
}

TEST(Mirror, IsNothingFromBehindAndOfNoArea) {
    View view;
    view.view = lookAt({0, 0, 5}, {0, 0, 0}, {0, 1, 0});
    view.projection = perspective(1, 1, 0.1);
    const std::vector<glm::dvec3> front{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    const std::vector<glm::dvec3> back(front.rbegin(), front.rend());
    EXPECT_TRUE(mirroredView(view, front));
    EXPECT_FALSE(mirroredView(view, back));
    EXPECT_FALSE(mirroredView(view, std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
    EXPECT_FALSE(mirroredView(view, std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}}));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(mirroredView(view, std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, nan}, {0, 1, 0}}));
    View odd = view;
    odd.through.count = 2;
    EXPECT_FALSE(isUsable(odd));
    odd.through.count = 9;
    EXPECT_FALSE(isUsable(odd));
    // A mirror in a mirror shows the eye's own side again.
    const std::vector<glm::dvec3> other{{-1, -1, 9}, {-1, 1, 9}, {1, 1, 9}, {1, -1, 9}};
    const auto once = mirroredView(view, front);
    ASSERT_TRUE(once);
    const auto twice = mirroredView(*once, other);
    ASSERT_TRUE(twice);
    EXPECT_NEAR(eyePosition(*twice).z, 23, 1e-9);  // -5 reflected at 9
}

}  // namespace
}  // namespace sightline
