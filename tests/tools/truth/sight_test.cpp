// Lines of sight run through the places that points are projected to, from the near plane to the far plane.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/sight.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/random.h"

namespace sightline {
using namespace tools;
namespace {

std::vector<glm::dmat4> projections() {
    glm::dmat4 skewed = perspective(1.0, 1.5, 0.1, 50), shifted = orthographic(20, 1.5, 1, 40);
    skewed[2][0] = 0.5;
    skewed[2][1] = -0.7;
    shifted[3][1] = 0.3;
    const double inf = std::numeric_limits<double>::infinity();
    return {perspective(1.0, 1.5, 0.1),   perspective(2.6, 1.5, 0.01, 30), skewed,
            orthographic(20, 1.5, 1, 40), orthographic(20, 1.5, 1, inf),   shifted};
}

TEST(SightLines, RaysPassThroughProjectedPoints) {
    int inside = 0;
    for (const glm::dmat4& projection : projections()) {
        Random random(9);
        for (int i = 0; i < 500; ++i) {
            View view;
            view.projection = projection;
            const glm::dvec3 eye(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
            view.view = lookAt(eye, eye + glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), 2), {0, 1, 0});
            const SightLines sight(view);
            EXPECT_LT(glm::length(sight.eye() - eye), 1e-13);
            const glm::dvec3 point(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-40, 40));
            const glm::dvec4 clip = view.projection * view.view * glm::dvec4(eye + point, 1);
            glm::dvec2 place;
            const bool in = sight.project(point, place);
            const double margin =
                std::min({clip.w - std::abs(clip.x), clip.w - std::abs(clip.y), clip.w - clip.z, clip.w + clip.z});
            if (std::abs(margin) < 1e-9) continue;
            ASSERT_EQ(in, margin > 0) << "case " << i;
            if (!in) continue;
            ++inside;
            EXPECT_NEAR(place.x, clip.x / clip.w, 1e-11);
            EXPECT_NEAR(place.y, clip.y / clip.w, 1e-11);
            const SightRay ray = sight.rayThrough(place);
            const double t = glm::dot(point - ray.origin, ray.direction);
            EXPECT_LT(glm::length(ray.origin + t * ray.direction - point), 1e-12);
            EXPECT_GE(t, ray.t_near);
            EXPECT_LE(t, ray.t_far);
            EXPECT_TRUE(sight.orthographic() || ray.origin == glm::dvec3(0));
            Box3d box;
            box.grow(eye + point);
            EXPECT_TRUE(sight.touches(box));
        }
    }
    EXPECT_GT(inside, 200);
}

TEST(SightLines, RaysBeginAndEndAtThePlanes) {
    View view;
    view.projection = perspective(1.0, 1.0, 0.5, 8.0);
    const SightRay middle = SightLines(view).rayThrough({0, 0});
    EXPECT_NEAR(middle.t_near, 0.5, 1e-12);
    EXPECT_NEAR(middle.t_far, 8.0, 1e-12);
    view.projection = perspective(1.0, 1.0, 0.5);
    EXPECT_EQ(SightLines(view).rayThrough({0.3, 0.2}).t_far, std::numeric_limits<double>::infinity());
    view.projection = orthographic(2.0, 1.0, -3.0, 8.0);
    const SightRay parallel = SightLines(view).rayThrough({0.5, -0.25});
    EXPECT_LT(glm::length(parallel.origin - glm::dvec3(0.5, -0.25, 0)), 1e-14);
    EXPECT_NEAR(parallel.t_near, -3.0, 1e-12);
    EXPECT_NEAR(parallel.t_far, 8.0, 1e-12);
}

TEST(SightLines, PixelsCountFromTheTopLeft) {
    View view;
    view.width = 200;
    view.height = 100;
    const SightLines sight(view);
    EXPECT_EQ(sight.pixel({-1, 1}), glm::dvec2(0, 0));
    EXPECT_EQ(sight.pixel({1, -1}), glm::dvec2(200, 100));
}

}  // namespace
}  // namespace sightline
