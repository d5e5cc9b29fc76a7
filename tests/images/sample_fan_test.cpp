// Laws of the sample points before a doorway and their weights.
// SPDX-License-Identifier: MIT
#include "sightline/images/sample_fan.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/images/doorway_room.h"

namespace sightline::test {
namespace {

std::vector<double> denseWeights(const SampleFan& fan, const glm::dvec3& eye) {
    std::vector<double> weights(fan.eyes.size(), 0.0);
    const SampleWeights found = nearestSamples(fan, eye);
    for (uint32_t k = 0; k < found.count; ++k) weights[found.sample[k]] += found.weight[k];
    return weights;
}

TEST(SampleFan, StandsOnArcsAtTheHeightOfEyes) {
    const SampleFan fan = *sampleFan(madeDoorway(), {1.5, 1, 4, 3, 5, 1.0});
    ASSERT_EQ(fan.eyes.size(), 15u);
    for (size_t i = 0; i < fan.eyes.size(); ++i) {
        const double radius = i < 5 ? 1 : i < 10 ? 2 : 4;
        EXPECT_NEAR(fan.eyes[i].y, 1.5, 1e-12);
        EXPECT_NEAR(glm::length(fan.eyes[i] - glm::dvec3(0.5, 1.5, 0)), radius, 1e-12);
        EXPECT_GT(fan.eyes[i].z, 0);
    }
    EXPECT_NEAR(fan.eyes[2].x, 0.5, 1e-12) << "the middle one stands before the middle";
    EXPECT_LT(fan.eyes[0].x, fan.eyes[4].x) << "left to right";
}

TEST(SampleFan, RefusesSettingsOutsideOfTheirLimits) {
    const PortalFrame frame = madeDoorway();
    EXPECT_FALSE(sampleFan(frame, {1.5, 1, 4, 0, 5, 1.0}).ok());
    EXPECT_FALSE(sampleFan(frame, {1.5, 1, 4, 3, 0, 1.0}).ok());
    EXPECT_FALSE(sampleFan(frame, {1.5, 0, 4, 3, 5, 1.0}).ok());
    EXPECT_FALSE(sampleFan(frame, {1.5, 4, 1, 3, 5, 1.0}).ok());
    EXPECT_FALSE(sampleFan(frame, {1.5, 1, 4, 3, 5, 1.6}).ok());
    EXPECT_FALSE(sampleFan(frame, {std::numeric_limits<double>::quiet_NaN(), 1, 4, 3, 5, 1.0}).ok());
}

TEST(SampleWeights, SumToOneAndAreOneAtASample) {
    Random random(4);
    for (int i = 0; i < 400; ++i) {
        const AnyDoorway any(random);
        const double nearest = random.uniform(0.3, 3);
        FanSettings settings{random.uniform(-2, 3), nearest, nearest * random.uniform(1, 5)};
        settings.arcs = 1 + static_cast<uint32_t>(random.below(4));
        settings.angles = 1 + static_cast<uint32_t>(random.below(9));
        settings.half_angle = random.uniform(0, 1.4);
        const SampleFan fan = *sampleFan(any.frame, settings);
        const SampleWeights found = nearestSamples(fan, any.eye(random));
        ASSERT_GE(found.count, 1u);
        ASSERT_LE(found.count, 3u);
        double sum = 0;
        for (uint32_t k = 0; k < found.count; ++k) {
            sum += found.weight[k];
            EXPECT_GT(found.weight[k], 0);
            ASSERT_LT(found.sample[k], fan.eyes.size());
            EXPECT_LE(found.weight[k], found.weight[k > 0 ? k - 1 : 0]);
        }
        EXPECT_NEAR(sum, 1, 1e-12);
        const auto at = static_cast<uint32_t>(random.below(fan.eyes.size()));
        EXPECT_NEAR(denseWeights(fan, fan.eyes[at])[at], 1, settings.half_angle > 0.01 ? 1e-9 : 1.1) << "case " << i;
    }
}

TEST(SampleWeights, ChangeWithoutAJumpAsTheEyeMoves) {
    const SampleFan fan = *sampleFan(madeDoorway(), {1.5, 1, 4, 4, 9, 1.1});
    Random random(5);
    constexpr double kStep = 1e-5;
    for (int walk = 0; walk < 50; ++walk) {
        glm::dvec3 eye(random.uniform(-3, 4), random.uniform(0, 3), random.uniform(0.5, 5));
        const glm::dvec3 towards = randomUnit(random);
        std::vector<double> last = denseWeights(fan, eye);
        for (int step = 0; step < 2000; ++step) {
            // Long strides in between, so that every kind of border is crossed somewhere.
            eye += (step % 2 == 0 ? kStep : 1e-3) * towards;
            if (eye.z < 0.5) break;
            const std::vector<double> now = denseWeights(fan, eye);
            for (size_t i = 0; step % 2 == 0 && i < now.size(); ++i)
                ASSERT_LT(std::abs(now[i] - last[i]), 40 * kStep) << "sample " << i << ", walk " << walk;
            last = now;
        }
    }
}

TEST(SampleWeights, AreThoseOfTwoNeighboursOnASingleArc) {
    const SampleFan fan = *sampleFan(madeDoorway(), {1.5, 2, 2, 1, 120, 1.0});
    const SampleWeights found = nearestSamples(fan, 0.25 * fan.eyes[17] + 0.75 * fan.eyes[18]);
    ASSERT_EQ(found.count, 2u);
    EXPECT_EQ(found.sample[0], 18u);
    EXPECT_EQ(found.sample[1], 17u);
    EXPECT_NEAR(found.weight[0], 0.75, 1e-4);
}

}  // namespace
}  // namespace sightline::test
