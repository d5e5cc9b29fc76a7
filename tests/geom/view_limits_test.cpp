// Sections and windows as the eye sees them, held to sums over corners.
// SPDX-License-Identifier: MIT
#include "sightline/geom/view_limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sightline/base/random.h"
#include "tests/support/random.h"

namespace sightline {
namespace {

/// The least and the largest distance of a box's corners, in multiples of the normal's length.
std::pair<double, double> reach(const glm::dvec4& plane, const Box3d& box, const glm::dmat4& transform) {
    std::pair<double, double> out(std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity());
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 p(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                           corner & 4 ? box.max.z : box.min.z, 1.0);
        const double at = glm::dot(plane, transform * p) / glm::length(glm::dvec3(plane));
        out.first = std::min(out.first, at);
        out.second = std::max(out.second, at);
    }
    return out;
}

TEST(ViewLimits, TellWhatIsWholeAndWhatReachesIn) {
    Random random(11);
    int whole = 0, cut = 0, in = 0, beside = 0;
    for (int i = 0; i < 20000; ++i) {
        const double away = i % 4 == 0 ? 1e6 : 1.0;
        const glm::dvec3 eye = away * test::randomVector(random, 10);
        View view;
        const glm::dvec3 n = test::randomVector(random, 1), p = eye + test::randomVector(random, 10);
        const glm::dvec4 plane =
            std::pow(10.0, random.uniform(-200, 200) * (i % 8 == 0)) * glm::dvec4(n, -glm::dot(n, p));
        (i % 2 ? view.sections : view.window).add(plane);
        glm::dmat4 transform(
            glm::dmat3(test::randomVector(random, 2), test::randomVector(random, 2), test::randomVector(random, 2)));
        transform[3] = glm::dvec4(eye + test::randomVector(random, 10), 1.0);
        Box3d box;
        box.grow(test::randomVector(random, 2));
        box.grow(test::randomVector(random, 2));
        const Box3f packed{glm::vec3(box.min), glm::vec3(box.max)};
        box = {glm::dvec3(packed.min), glm::dvec3(packed.max)};
        const ViewLimits limits = makeViewLimits(view, eye);
        ASSERT_EQ(limits.cut(), i % 2 == 1);
        ASSERT_EQ(limits.windowed(), i % 2 == 0);
        const auto [low, high] = reach(plane, box, transform);
        const double doubt = 1e-4;  // single precision of some tens of units
        if (i % 2) {
            if (low < 0) { ASSERT_FALSE(isWhole(limits, packed, transform)) << "case " << i; }
            if (low > doubt) { ASSERT_TRUE(isWhole(limits, packed, transform)) << "case " << i; }
            ++(low < 0 ? cut : whole);
            ASSERT_EQ(isWhole(limits, Box3f{packed.min, packed.min}, transform),
                      isWhole(limits, packed.min, transform));
            ASSERT_TRUE(reachesWindow(limits, box, transform)) << "a section is no window";
        } else {
            if (high < 0) { ASSERT_FALSE(reachesWindow(limits, box, transform)) << "case " << i; }
            if (high > doubt) { ASSERT_TRUE(reachesWindow(limits, box, transform)) << "case " << i; }
            ++(high < 0 ? beside : in);
            ASSERT_TRUE(isWhole(limits, packed, transform)) << "a window cuts nothing";
        }
    }
    EXPECT_GT(std::min({whole, cut, in, beside}), 1000);
}

TEST(ViewLimits, APlaneWithoutDirectionHoldsAllOrNothing) {
    for (const double d : {0.0, 1e-300, 3.0, -1e-300, -2.0}) {
        View view;
        view.sections.add({0, 0, 0, d});
        EXPECT_TRUE(isUsable(view));
        const ViewLimits limits = makeViewLimits(view, {1, 2, 3});
        EXPECT_EQ(isWhole(limits, glm::vec3(5), glm::dmat4(1.0)), d >= 0);
    }
}

TEST(ViewLimits, ARectangleOfTheImageHoldsWhatItShows) {
    Random random(12);
    int inside = 0;
    for (int i = 0; i < 4000; ++i) {
        View view;
        view.width = 200;
        view.height = 100;
        view.jitter = 0.25;
        view.projection = i % 2 ? perspective(1.0, 2.0, 0.1) : orthographic(20, 2.0, 0.1, 50);
        view.projection[2][0] = i % 2 ? 0.3 : 0.0;
        const glm::dvec3 eye = test::randomVector(random, 100);
        view.view = lookAt(eye, eye + test::randomVector(random, 1), {0, 1, 0});
        const glm::dvec3 point = eye + test::randomVector(random, 20);
        const glm::dvec4 clip = view.projection * view.view * glm::dvec4(point, 1.0);
        if (!(clip.w > 0)) continue;
        const double x = (0.5 + 0.5 * clip.x / clip.w) * 200, y = (0.5 - 0.5 * clip.y / clip.w) * 100;
        const double left = random.uniform(0, 200), right = random.uniform(0, 200);
        const double top = random.uniform(0, 100), bottom = random.uniform(0, 100);
        ASSERT_TRUE(addWindow(view, left, top, right, bottom));
        const double over = std::max({std::min(left, right) - 0.25 - x, x - std::max(left, right) - 0.25,
                                      std::min(top, bottom) - 0.25 - y, y - std::max(top, bottom) - 0.25});
        if (std::abs(over) < 1e-9) continue;
        bool in = true;
        for (const glm::dvec4& plane : view.window.all()) in &= glm::dot(plane, glm::dvec4(point, 1.0)) >= 0;
        ASSERT_EQ(in, over < 0) << "case " << i;
        inside += in;
    }
    EXPECT_GT(inside, 50);
}

TEST(ViewLimits, AWindowOfAVolumeIsTheVolume) {
    Random random(13);
    for (int i = 0; i < 500; ++i) {
        ViewVolume volume;
        volume.eye = test::randomVector(random, 1000);
        for (int k = 0; k < 5; ++k) {
            const glm::dvec3 n = test::randomVector(random, 1);
            addPlane(volume, {n, -glm::dot(n, volume.eye) + random.uniform(-1, 3)});
        }
        View view;
        ASSERT_TRUE(addWindow(view, volume));
        const ViewLimits limits = makeViewLimits(view, volume.eye);
        ASSERT_EQ(limits.volume.count, volume.count);
        for (uint32_t k = 0; k < volume.count; ++k)
            for (int c = 0; c < 4; ++c) ASSERT_NEAR(limits.volume.planes[k][c], volume.planes[k][c], 1e-12);
    }
    View view;
    ViewVolume none;
    none.empty = true;
    ASSERT_TRUE(addWindow(view, none));
    EXPECT_FALSE(reachesWindow(makeViewLimits(view, {}), {glm::dvec3(-1e9), glm::dvec3(1e9)}, glm::dmat4(1.0)));
    ViewVolume many;
    for (uint32_t k = 0; k < 8; ++k) addPlane(many, {1, double(k), 0, 5});
    EXPECT_FALSE(addWindow(view, many)) << "eight planes do not fit beside one";
    EXPECT_EQ(view.window.count, ViewPlanes::kMost);
}

}  // namespace
}  // namespace sightline
