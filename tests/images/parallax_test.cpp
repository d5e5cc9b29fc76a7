// The bound of what an image does wrong for another eye, held against points.
// SPDX-License-Identifier: MIT
#include "sightline/images/parallax.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/images/doorway_room.h"

namespace sightline::test {
namespace {

TEST(Displacement, IsTheUsualFormulaForAStepAside) {
    const PortalFrame frame = madeDoorway();
    const glm::dvec3 from(0.4, 1.2, 2), to = from + glm::dvec3(0.03, -0.04, 0);
    const Displacement bound = displacementBound(frame, from, to, {0, 5}, 320);
    EXPECT_NEAR(bound.pixels, parallaxPixels(320, 0.05, 2, 7), 1e-9);
    EXPECT_NEAR(parallaxPixels(320, 0.05, 2, 7), 320 * 0.05 * (1.0 / 2 - 1.0 / 7), 1e-12);
    EXPECT_NEAR(bound.exposed, bound.pixels, 1e-9) << "what is nearest stands in the doorway itself";
    EXPECT_NEAR(displacementBound(frame, from, to, {5, 5}, 320).exposed, 0, 1e-9);
    EXPECT_NEAR(displacementBound(frame, from, to, {}, 320).pixels, 320 * 0.05 / 2, 1e-9) << "the sky";
}

TEST(Displacement, IsNothingWhereTheImageWasTaken) {
    EXPECT_EQ(displacementBound(madeDoorway(), {1, 1, 1}, {1, 1, 1}, {}, 320).pixels, 0);
}

TEST(Displacement, IsInfiniteWhereAnEyeIsNotBefore) {
    const PortalFrame frame = madeDoorway();
    EXPECT_TRUE(std::isinf(displacementBound(frame, {0.5, 1, 1}, {0.5, 1, -1}, {}, 320).pixels));
    EXPECT_TRUE(std::isinf(displacementBound(frame, {0.5, 1, 0}, {0.5, 1, 1}, {}, 320).pixels));
}

TEST(FocalLength, IsHalfTheImageByTheTangent) {
    const View view = viewAt({0, 0, 0}, {0, 0, -1}, {.degrees = 60, .width = 640, .height = 360});
    EXPECT_NEAR(focalLength(view), 360 / (2 * std::tan(glm::radians(30.0))), 1e-9);
}

/// Holds the bound against random points; returns the largest share of it that one reached.
double largestShare(uint64_t seed, size_t cases) {
    Random random(seed);
    double largest = 0;
    for (size_t i = 0; i < cases; ++i) {
        const AnyDoorway any(random);
        const glm::dvec3 from = any.eye(random);
        // Steps from a hair to right across.
        const glm::dvec3 to =
            random.below(3) == 0 ? any.eye(random) : from + std::exp(random.uniform(-9, 0)) * randomUnit(random);
        if (eyePlace(any.frame, to) != EyePlace::kBefore) continue;
        BeyondRange range;
        range.nearest = random.uniform(0, 3);
        range.farthest = range.nearest + (random.below(4) == 0 ? 0.0 : std::exp(random.uniform(-3, 5)));
        const double focal = random.uniform(50, 2000);
        const Displacement bound = displacementBound(any.frame, from, to, range, focal);
        // A view that faces the doorway shows both places.
        View facing = *portalView(any.frame, to, 1, 1);
        facing.projection[0] = glm::dvec4(1, 0, 0, 0);
        facing.projection[1] = glm::dvec4(0, 1, 0, 0);
        facing.projection[2] = glm::dvec4(0, 0, -1, -1);
        const auto onImage = [&](const glm::dvec3& point) {
            const glm::dvec4 clip = facing.projection * facing.view * glm::dvec4(point, 1.0);
            return focal * glm::dvec2(clip) / clip.w;
        };
        for (int k = 0; k < 20; ++k) {
            const bool corner = random.below(3) == 0;
            glm::dvec2 share(random.uniform(), random.uniform());
            if (corner) share = glm::round(share);
            const glm::dvec3 shown = any.frame.toWorld({share.x * any.frame.width, share.y * any.frame.height, 0.0});
            const double depth = corner ? range.farthest : random.uniform(range.nearest, range.farthest);
            const double before = any.frame.toFrame(from).z;
            const glm::dvec3 point = from + (shown - from) * ((before + depth) / before);
            const double pixels = glm::length(onImage(shown) - onImage(point));
            EXPECT_LE(pixels, bound.pixels * (1 + 1e-9) + 1e-7) << "seed " << seed << ", case " << i;
            if (bound.pixels > 1e-3) largest = std::max(largest, pixels / bound.pixels);
        }
    }
    return largest;
}

TEST(Displacement, OfNoPointExceedsTheBoundAndSomeReachIt) {
    const double largest = largestShare(6, casesToMake(20000, 1000000));
    EXPECT_GT(largest, 0.999) << "the bound is no larger than it must be";
}

TEST(Displacement, ExposesNoWiderGapThanItSays) {
    Random random(7);
    for (int i = 0; i < 20000; ++i) {
        const AnyDoorway any(random);
        const glm::dvec3 from = any.eye(random), to = any.eye(random);
        const BeyondRange range{random.uniform(0, 2), random.uniform(2, 40)};
        const Displacement bound = displacementBound(any.frame, from, to, range, 300);
        const glm::dvec3 shown =
            any.frame.toWorld({random.uniform(0, any.frame.width), random.uniform(0, any.frame.height), 0.0});
        const double before = any.frame.toFrame(from).z, behind = any.frame.toFrame(to).z;
        // Two points that were seen one beside the other, at both ends of the range.
        glm::dvec2 at[2];
        for (int k = 0; k < 2; ++k) {
            const double depth = k == 0 ? range.nearest : range.farthest;
            const glm::dvec3 point = from + (shown - from) * ((before + depth) / before);
            const glm::dvec3 met = any.frame.toFrame(to + (point - to) * (behind / (behind + depth)));
            at[k] = 300 / behind * glm::dvec2(met);
        }
        EXPECT_LE(glm::length(at[0] - at[1]), bound.exposed * (1 + 1e-9) + 1e-7) << "case " << i;
    }
}

}  // namespace
}  // namespace sightline::test
