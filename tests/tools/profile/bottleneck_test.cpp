// Loads with a known limit are told by what the frame does under more of each stage; mixtures are called mixed.
// SPDX-License-Identifier: MIT
#include "sightline/tools/profile/bottleneck.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <string>

#include "tests/tools/profile/simulated_subject.h"

namespace sightline::test {
namespace {

constexpr double kMagnitudes[] = {0.4e-3, 5e-3, 40e-3};  // [s]

/// One stage is `part` of the frame, the others share the rest.
SimulatedSubject limitedBy(int stage, double seconds, double part, uint64_t seed) {
    SimulatedSubject subject;
    for (int i = 0; i < kFrameStages; ++i) subject.parts[i] = seconds * (i == stage ? part : (1 - part) / 3);
    subject.noise = 0.05;
    subject.spikes = 0.05;
    subject.random = Random(seed);
    return subject;
}

std::string nameOf(int stage, double seconds, uint64_t seed) {
    return std::string(kFrameStageNames[stage]) + ", " + std::to_string(seconds) + " s, seed " + std::to_string(seed);
}

TEST(Bottleneck, TellsTwelveLoadsOfTwelve) {
    for (uint64_t seed = 1; seed <= 10; ++seed)
        for (const bool pipelined : {false, true})
            for (int stage = 0; stage < kFrameStages; ++stage)
                for (const double seconds : kMagnitudes) {
                    SimulatedSubject subject = limitedBy(stage, seconds, 0.7, seed);
                    subject.pipelined = pipelined;
                    const Bottleneck found = findBottleneck(std::ref(subject));
                    EXPECT_EQ(found.verdict(), LimitVerdict::kLimited) << nameOf(stage, seconds, seed);
                    EXPECT_EQ(static_cast<int>(found.judgement.first), stage) << nameOf(stage, seconds, seed);
                    EXPECT_GE(found.confidence, 0.9) << nameOf(stage, seconds, seed);
                    EXPECT_EQ(verdictWords(found), std::string("limited by ") + kFrameStageNames[stage]);
                }
}

TEST(Bottleneck, CallsHalvesMixedInSeriesAndInAPipeline) {
    for (uint64_t seed = 1; seed <= 5; ++seed)
        for (const bool pipelined : {false, true})
            for (int a = 0; a < kFrameStages; ++a)
                for (int b = a + 1; b < kFrameStages; ++b) {
                    SimulatedSubject subject;
                    subject.parts[a] = subject.parts[b] = 4e-3;
                    subject.pipelined = pipelined;
                    subject.noise = 0.05;
                    subject.random = Random(seed);
                    const Bottleneck found = findBottleneck(std::ref(subject));
                    EXPECT_EQ(found.verdict(), LimitVerdict::kMixed) << a << b << pipelined << " seed " << seed;
                    for (int i = 0; i < kFrameStages; ++i)
                        EXPECT_EQ(found.judgement.limits[size_t(i)], i == a || i == b) << a << b << i;
                    EXPECT_NEAR(found.judgement.proportions[size_t(a)], 0.5, 0.1);
                    // What tells both kinds of frame apart: how much the shares are together.
                    EXPECT_NEAR(found.judgement.sum, pipelined ? 2 : 1, 0.2);
                }
}

TEST(Bottleneck, SharesAreThePartsOfASerialFrame) {
    SimulatedSubject subject;
    const double parts[] = {4e-3, 3e-3, 2e-3, 1e-3};
    std::copy(std::begin(parts), std::end(parts), subject.parts);
    const Bottleneck found = findBottleneck(std::ref(subject));
    for (int i = 0; i < kFrameStages; ++i) {
        EXPECT_NEAR(found.stages[size_t(i)].share, parts[i] / 10e-3, 1e-9);
        EXPECT_NEAR(found.stages[size_t(i)].exponent, std::log2(1 + parts[i] / 10e-3), 1e-9);
        EXPECT_NEAR(found.stages[size_t(i)].seconds, 10e-3 + parts[i], 1e-9);
    }
    EXPECT_NEAR(found.judgement.sum, 1, 1e-9);
    EXPECT_EQ(found.verdict(), LimitVerdict::kMixed);  // 40, 30, 20 and 10 %: no stage by itself
    EXPECT_TRUE(found.settled);
    EXPECT_EQ(found.rounds, BottleneckSettings().least_rounds);
    EXPECT_EQ(found.waiting, 0);
    EXPECT_EQ(verdictWords(found), "mixed: fill 40 %, transform 30 %, bus 20 %");
}

// What overlaps and takes less than half as long as what limits does not matter at all; above, by how much it would come
// out under twice the load.
TEST(Bottleneck, OfAPipelineTellsWhatIsNearlyAsSlow) {
    for (const double r : {0.3, 0.5, 0.7, 0.9}) {
        SimulatedSubject subject;
        subject.pipelined = true;
        subject.parts[1] = 10e-3;
        subject.parts[3] = r * 10e-3;
        const Bottleneck found = findBottleneck(std::ref(subject));
        EXPECT_NEAR(found.of(FrameStage::kTransform).share, 1, 1e-9);
        EXPECT_NEAR(found.of(FrameStage::kCpu).share, std::max(0.0, 2 * r - 1), 1e-9);
        EXPECT_EQ(found.verdict(), r < 0.75 ? LimitVerdict::kLimited : LimitVerdict::kMixed) << r;
    }
}

TEST(Bottleneck, SaysWhenTheFrameIsElsewhere) {
    SimulatedSubject subject = limitedBy(0, 3e-3, 0.7, 1);
    subject.rest = 7e-3;
    subject.noise = subject.spikes = 0;
    const Bottleneck found = findBottleneck(std::ref(subject));
    EXPECT_EQ(found.verdict(), LimitVerdict::kUndecided);
    EXPECT_EQ(found.doubt, Doubt::kElsewhere);
    EXPECT_NE(verdictWords(found).find("only 30 % of the frame"), std::string::npos) << verdictWords(found);
}

TEST(Bottleneck, ADisplaysRefreshIsNoVerdict) {
    // 12 of 16.7 ms: twice the fill takes a refresh more, twice of anything else none. It looks like a pipeline's limit.
    SimulatedSubject subject = limitedBy(0, 12e-3, 0.6, 1);
    subject.noise = 0.01;
    subject.spikes = 0;
    subject.refresh = 1 / 60.0;
    Bottleneck found = findBottleneck(std::ref(subject));
    EXPECT_EQ(found.verdict(), LimitVerdict::kUndecided);
    EXPECT_EQ(found.doubt, Doubt::kQuantised);
    EXPECT_EQ(found.judgement.verdict, LimitVerdict::kLimited);  // the shares alone would say so
    // 4 of 16.7 ms: nothing moves it.
    subject = limitedBy(0, 4e-3, 0.7, 1);
    subject.spikes = 0;
    subject.refresh = 1 / 60.0;
    found = findBottleneck(std::ref(subject));
    EXPECT_EQ(found.doubt, Doubt::kWaits);
    EXPECT_NEAR(found.waiting, 0.76, 0.05);
}

TEST(Bottleneck, NoiseCostsRoundsAndThenConfidence) {
    SimulatedSubject quiet = limitedBy(2, 5e-3, 0.7, 1), loud = quiet, louder = quiet;
    quiet.noise = 0.01;
    loud.noise = 0.08;
    louder.noise = 0.6;
    louder.parts[0] = 0.48 * louder.parts[2];  // between limited and mixed
    const Bottleneck a = findBottleneck(std::ref(quiet)), b = findBottleneck(std::ref(loud)),
                     c = findBottleneck(std::ref(louder));
    EXPECT_TRUE(a.settled);
    EXPECT_LT(a.rounds, b.rounds);
    EXPECT_GT(a.confidence, 0.99);
    EXPECT_FALSE(c.settled);
    EXPECT_EQ(c.rounds, BottleneckSettings().most_rounds);
    EXPECT_LT(c.confidence, 0.9);
}

TEST(Bottleneck, DriftMeetsAllAlike) {
    for (uint64_t seed = 1; seed <= 10; ++seed) {
        SimulatedSubject subject = limitedBy(3, 5e-3, 0.7, seed);
        subject.drift = 0.002;  // a processor that grows hot: twice as slow after 350 frames
        const Bottleneck found = findBottleneck(std::ref(subject));
        EXPECT_EQ(verdictWords(found), "limited by cpu") << "seed " << seed;
    }
}

TEST(Bottleneck, StopsAtItsLimits) {
    SimulatedSubject subject = limitedBy(0, 5e-3, 0.7, 1);
    subject.noise = 0.3;
    BottleneckSettings settings;
    settings.most_rounds = 9;
    Bottleneck found = findBottleneck(std::ref(subject), settings);
    EXPECT_EQ(found.rounds, 9u);
    EXPECT_FALSE(found.settled);
    EXPECT_FALSE(found.out_of_time);
    // Six warm it up, and a round are six more.
    EXPECT_EQ(subject.frames, 6u + 9 * 6 * found.frames_a_sample);
    settings.seconds = 1e-12;
    found = findBottleneck(std::ref(subject), settings);
    EXPECT_EQ(found.rounds, 1u);
    EXPECT_TRUE(found.out_of_time);
}

TEST(Bottleneck, ShortFramesAreDrawnSeveralTimesAMeasurement) {
    SimulatedSubject subject = limitedBy(0, 0.1e-3, 0.7, 1);
    EXPECT_GE(findBottleneck(std::ref(subject)).frames_a_sample, 10u);
    subject = limitedBy(0, 40e-3, 0.7, 1);
    EXPECT_EQ(findBottleneck(std::ref(subject)).frames_a_sample, 1u);
}

TEST(Bottleneck, TheSameMeasurementsSayTheSame) {
    SimulatedSubject subject = limitedBy(1, 5e-3, 0.6, 3), again = subject;
    const Bottleneck a = findBottleneck(std::ref(subject)), b = findBottleneck(std::ref(again));
    EXPECT_EQ(a.confidence, b.confidence);
    EXPECT_EQ(a.rounds, b.rounds);
    for (size_t i = 0; i < kFrameStages; ++i) EXPECT_EQ(a.stages[i].share, b.stages[i].share);
}

TEST(Bottleneck, SharesAreJudgedByTheirProportions) {
    const auto judged = [](double fill, double transform, double bus, double cpu) {
        const std::array<double, kFrameStages> shares = {fill, transform, bus, cpu};
        return judgeShares(shares);
    };
    EXPECT_EQ(judged(0.7, 0.1, 0.1, 0.1).verdict, LimitVerdict::kLimited);
    EXPECT_EQ(judged(0.7, -0.1, 0, 0.3).verdict, LimitVerdict::kLimited);
    EXPECT_EQ(judged(0.6, 0.4, 0, 0).verdict, LimitVerdict::kMixed);
    EXPECT_EQ(judged(0.1, 0.1, 0.1, 0.1).verdict, LimitVerdict::kUndecided);
    EXPECT_EQ(judged(-1, -1, -1, -1).verdict, LimitVerdict::kUndecided);
    const Judgement four = judged(0.25, 0.25, 0.25, 0.25);
    EXPECT_EQ(four.limits, (std::array<bool, 4>{true, true, true, true}));
    // Whatever the shares are, what is mixed is of several.
    Random random(1);
    for (int i = 0; i < 100000; ++i) {
        const Judgement any =
            judged(random.uniform(-0.1, 1), random.uniform(-0.1, 1), random.uniform(-0.1, 1), random.uniform(-0.1, 1));
        const auto count = std::count(any.limits.begin(), any.limits.end(), true);
        EXPECT_TRUE(any.verdict == LimitVerdict::kMixed     ? count >= 2
                    : any.verdict == LimitVerdict::kLimited ? count == 1
                                                            : count == 0);
    }
}

}  // namespace
}  // namespace sightline::test
