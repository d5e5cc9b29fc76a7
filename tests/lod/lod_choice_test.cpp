// Levels of detail by their error: held to the image, to steadiness under noise, and to fades that no frame may pop in.
// SPDX-License-Identifier: MIT
#include "sightline/lod/lod_choice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "sightline/base/random.h"
#include "tests/support/views.h"

namespace sightline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<LodLevel> someLevels(Random& random, size_t count) {
    std::vector<LodLevel> levels(count);
    double error = random.uniform(1e-4, 1e-2);
    uint32_t triangles = 1u << 14;
    for (size_t i = 0; i < count; ++i) {
        levels[i] = {i == 0 ? 0.0 : error, triangles, triangles / 2 + 2};
        if (i > 0) error *= random.uniform(1.3, 4.0);
        triangles = triangles / 2 + 1;
    }
    return levels;
}

View middleView(double fov = 1.0) {
    View view;
    view.view = lookAt({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
    view.projection = perspective(fov, 16.0 / 9.0, 0.1);
    return view;
}

/// A level as an engine without a fade would have it, from answer to answer.
uint8_t stepLevel(LodState& state, const std::vector<LodLevel>& levels, double pixels, const LodRule& rule,
                  bool remembers) {
    const LodRange range = lodRange(levels, pixels, rule, remembers);
    if (!remembers) state = {range.coarsest, range.coarsest, 0};
    else state = nextState(state, levelIn(range, state.level), levels, pixels, rule);
    return state.level;
}

TEST(LodChoice, AStepSpansNoMorePixelsThanItSaysWhereverItLies) {
    Random random(1);
    int compared = 0;
    for (int round = 0; round < 4000; ++round) {
        const View view = test::anyView(random, glm::dvec3(0.0));
        const LodMeasure measure = makeLodMeasure(view);
        const double corner = cornerStretch(view);
        const glm::dmat4 clip = view.projection * view.view;
        const auto pixel = [&](const glm::dvec3& p) {
            const glm::dvec4 c = clip * glm::dvec4(p, 1.0);
            return 0.5 * glm::dvec2(view.width, view.height) * glm::dvec2(c) / c.w;
        };
        const glm::dvec3 low(random.uniform(-30, 30), random.uniform(-30, 30), random.uniform(-30, 30));
        const Box3d box{low, low + glm::dvec3(random.uniform(0, 9), random.uniform(0, 9), random.uniform(0, 9))};
        const double unit = pixelsOfUnit(measure, box);
        for (int pair = 0; pair < 20; ++pair) {
            glm::dvec3 a, b;
            for (int axis = 0; axis < 3; ++axis) {
                a[axis] = random.uniform(box.min[axis], box.max[axis]);
                b[axis] = a[axis] + random.uniform(-1e-5, 1e-5);
            }
            const glm::dvec4 at = clip * glm::dvec4(a, 1.0);
            if (!(at.w > 0) || std::abs(at.x) > at.w || std::abs(at.y) > at.w) continue;  // not in the image
            // Both axes count as the finer one does, which is what a pixel is taken to be.
            ASSERT_LE(glm::length(pixel(a) - pixel(b)), glm::length(a - b) * unit * corner * 1.001 + 1e-9)
                << "round " << round;
            ++compared;
        }
    }
    EXPECT_GT(compared, 1000);
}

TEST(LodChoice, TheMiddleOfTheImageShowsAnErrorAsLargeAsItSays) {
    const View view = middleView();
    const LodMeasure measure = makeLodMeasure(view);
    const double expected = 0.5 * view.height / std::tan(0.5) / 10.0;
    EXPECT_NEAR(pixelsOfUnit(measure, {{-1, -1, -12}, {1, 1, -10}}), expected, 1e-9);
    EXPECT_EQ(pixelsOfUnit(measure, {{-1, -1, -1}, {1, 1, 1}}), kInfinity);
    EXPECT_NEAR(cornerStretch(view), 1.0 + std::pow(std::tan(0.5), 2) * (1.0 + 256.0 / 81.0), 1e-9);
}

TEST(LodChoice, ShowsTheCoarsestLevelWhoseErrorPassesAndNeverMore) {
    Random random(3);
    for (int round = 0; round < 3000; ++round) {
        const auto levels = someLevels(random, 1 + random.below(kMostLods));
        LodRule rule;
        rule.error = random.uniform(0.3, 4);
        rule.fade = static_cast<uint32_t>(random.below(3) * random.below(20));
        LodState state;
        double pixels = std::exp(random.uniform(-3, 12));
        for (int frame = 0; frame < 60; ++frame) {
            stepLevel(state, levels, pixels, rule, frame > 0);
            const VisibleLod lod = visibleLod(state, levels, pixels, rule);
            ASSERT_LT(lod.level, levels.size());
            for (const uint8_t shown : {lod.level, lod.from})
                ASSERT_LE(shown ? levels[shown].error * pixels : 0.0, rule.error) << "round " << round;
            if (state.left == 0 && lod.level + 1u < levels.size()) {
                // The next one would err too much, or so nearly that the memory keeps it out.
                ASSERT_GT(levels[lod.level + 1].error * pixels, rule.error * (1 - rule.hysteresis))
                    << "round " << round;
            }
            pixels *= random.below(8) ? std::exp(random.uniform(-0.02, 0.02)) : std::exp(random.uniform(-2, 2));
        }
    }
}

TEST(LodChoice, NoiseChangesALevelOnceAtMost) {
    Random random(4);
    for (int round = 0; round < 3000; ++round) {
        const auto levels = someLevels(random, 8);
        LodRule rule;
        rule.fade = random.below(2) ? 10 : 0;
        // A millimetre to and fro, half a metre away or farther; the middle is anywhere, also where levels change.
        const double distance = random.uniform(0.5, 40), focal = 1000;
        LodState state;
        int changes = 0;
        uint8_t last = 0;
        for (int frame = 0; frame < 200; ++frame) {
            const double at = distance + random.uniform(-1e-3, 1e-3);
            const uint8_t level = stepLevel(state, levels, focal / at, rule, frame > 0);
            changes += frame > 0 && level != last;
            last = level;
        }
        ASSERT_LE(changes, 1) << "round " << round;
    }
}

TEST(LodChoice, AFadeTakesItsTimeAndLeavesOneLevel) {
    std::vector<LodLevel> levels = {{0, 1000, 500}, {0.01, 500, 250}};
    LodRule rule;
    rule.fade = 9;
    LodState state;
    float before = 0;
    for (int frame = 0; frame < 10; ++frame) {
        state = nextState(state, 1, levels, 50, rule);
        const VisibleLod lod = visibleLod(state, levels, 50, rule);
        EXPECT_EQ(lod.level, 1);
        EXPECT_EQ(lod.from, frame < 9 ? 0 : 1);
        EXPECT_NEAR(lod.fade, 0.1 * (frame + 1), 1e-6);
        EXPECT_GT(lod.fade, before);
        before = lod.fade;
    }
    EXPECT_EQ(state.left, 0);
    // A jump to where the coarse level errs too much shows the fine one at once.
    state = nextState(state, 0, levels, 500, rule);
    const VisibleLod lod = visibleLod(state, levels, 500, rule);
    EXPECT_EQ(lod.level, 0);
    EXPECT_EQ(lod.from, 0);
    EXPECT_EQ(lod.fade, 1.0f);
}

TEST(LodChoice, MorphsMeetWhereLevelsChange) {
    Random random(5);
    for (int round = 0; round < 200; ++round) {
        auto levels = someLevels(random, 7);
        for (size_t i = 2; i < levels.size(); ++i)  // far enough apart for a morph to begin and to end between them
            levels[i].error = std::max(levels[i].error, 2.5 * levels[i - 1].error);
        const LodRule rule;
        LodState state;
        // The shape as one number: the level and how far it is on its way to the next.
        double last = 0;
        double pixels = 1e6;
        const double step = round % 2 ? 0.999 : 1.001;
        if (step > 1) pixels = 1e-3;
        for (int frame = 0; frame < 30000; ++frame, pixels *= step) {
            stepLevel(state, levels, pixels, rule, frame > 0);
            const VisibleLod lod = visibleLod(state, levels, pixels, rule);
            const double shape = lod.level + static_cast<double>(lod.morph);
            if (frame == 0) last = shape;
            ASSERT_NEAR(shape, last, 0.02) << "round " << round << " level " << int{lod.level};
            last = shape;
            // What is morphed errs no more than what may be seen.
            if (lod.level + 1u < levels.size()) {
                const double fine = levels[lod.level].error, coarse = levels[lod.level + 1].error;
                const double morph = static_cast<double>(lod.morph);
                ASSERT_LE(((1 - morph) * fine + morph * coarse) * pixels, rule.error * (1 + 1e-6));
            }
        }
    }
}

TEST(LodChoice, LevelsThatAreNoNumbersAreNeverChosen) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<LodLevel> levels = {{0, 9, 9}, {nan, 5, 5}, {kInfinity, 2, 2}};
    for (const double pixels : {0.0, 1.0, 1e9, kInfinity}) {
        EXPECT_EQ(lodRange(levels, pixels, {}, false).coarsest, 0);
        EXPECT_EQ(lodRange(levels, pixels, {}, true).coarsest, 0);
    }
    EXPECT_EQ(lodRange({}, 1.0, {}, false).coarsest, 0);
}

TEST(LodChoice, ABoxCoversNoMorePixelsThanItsSphereMayAndNoMoreThanThereAre) {
    const View view = middleView();
    const LodMeasure measure = makeLodMeasure(view);
    EXPECT_EQ(pixelsOfBox(measure, {{-1, -1, -1}, {1, 1, 1}}), 1280.0 * 720.0);
    const double focal = 0.5 * view.height / std::tan(0.5);
    EXPECT_NEAR(pixelsOfBox(measure, {{-1, -1, -101}, {1, 1, -99}}), M_PI * focal * focal * 3.0 / (1e4 - 3.0), 1e-6);
    View parallel = view;
    parallel.projection = orthographic(10.0, 16.0 / 9.0, 0.1, 100);
    EXPECT_NEAR(pixelsOfBox(makeLodMeasure(parallel), {{-1, -1, -2}, {1, 1, 0}}), M_PI * 72.0 * 72.0 * 3.0, 1e-6);
    EXPECT_EQ(cornerStretch(parallel), 1.0);
}

}  // namespace
}  // namespace sightline
