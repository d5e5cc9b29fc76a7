// Knobs that follow frame times, on simulated machines.
// SPDX-License-Identifier: MIT
#include "sightline/lod/frame_control.h"

#include <gtest/gtest.h>

#include <limits>

#include "sightline/base/random.h"

namespace sightline {
namespace {

TEST(ReactiveKnob, FindsTheTargetAndRestsThere) {
    ReactiveKnob knob({.target = 16, .least = 0.5, .most = 64});
    double time = 0;
    for (int frame = 0; frame < 100; ++frame) {
        time = 80 / knob.value();
        knob.observe(time);
    }
    EXPECT_NEAR(time, 16, 1.7);
    const double rests = knob.value();
    knob.observe(16 * 1.05);
    EXPECT_EQ(knob.value(), rests);
}

TEST(ReactiveKnob, StaysBetweenItsLimits) {
    ReactiveKnob knob({.target = 16, .least = 0.5, .most = 8});
    for (int frame = 0; frame < 50; ++frame) knob.observe(1000);
    EXPECT_EQ(knob.value(), 8);
    for (int frame = 0; frame < 50; ++frame) knob.observe(1);
    EXPECT_EQ(knob.value(), 0.5);
}

TEST(ReactiveKnob, IgnoresTimesThatAreNone) {
    ReactiveKnob knob({.target = 16, .least = 1, .most = 8});
    for (const double time :
         {0.0, -1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
        EXPECT_EQ(knob.observe(time), 1);
}

TEST(CostCorrection, FollowsAMachineThatIsSlowerThanItsModel) {
    Random random(1);
    CostCorrection correction;
    for (int frame = 0; frame < 100; ++frame) {
        const double modelled = random.uniform(5, 20);
        correction.observe(3.0 * modelled * random.uniform(0.95, 1.05), modelled);
    }
    EXPECT_NEAR(correction.factor(), 3.0, 0.15);
    correction.observe(std::numeric_limits<double>::quiet_NaN(), 1);
    correction.observe(1, 0);
    EXPECT_NEAR(correction.factor(), 3.0, 0.15);
    const double before = correction.factor();
    correction.observe(1e9, 1);  // one frame that the system took away
    EXPECT_LE(correction.factor(), 1.2 * before + 1e-9);
}

}  // namespace
}  // namespace sightline
