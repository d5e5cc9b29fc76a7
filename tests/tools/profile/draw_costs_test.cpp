// Costs that made the times are found again, and never below nothing.
// SPDX-License-Identifier: MIT
#include "sightline/tools/profile/draw_costs.h"

#include <gtest/gtest.h>

#include <vector>

#include "sightline/base/random.h"
#include "sightline/tools/profile/loaded_reference.h"
#include "tests/studies/hidden/made_lists.h"

namespace sightline::test {
using namespace studies;
using namespace tools;
namespace {

DrawCosts madeCosts(Random& random) {
    DrawCosts costs;
    costs.object = random.uniform(50, 5000);
    costs.triangle = random.uniform(2, 50);
    costs.vertex = random.uniform(2, 50);
    costs.pixel = random.uniform(0.1, 5);
    costs.sample = random.uniform(0, 1);
    costs.frame = random.uniform(0, 1e5);
    return costs;
}

std::vector<CostSample> samplesOf(const DrawCosts& costs, size_t count, double noise, Random& random) {
    std::vector<CostSample> samples;
    for (size_t i = 0; i < count; ++i) {
        CostSample sample;
        sample.objects = double(random.below(1000));
        sample.triangles = double(random.below(200000));
        sample.vertices = double(random.below(200000));
        sample.pixels = double(random.below(3000000));
        sample.samples = random.below(2) ? 921600 : 230400;
        sample.seconds = 1e-9 * costs.nanosecondsOf(sample) * (1 + noise * random.uniform(-1, 1));
        samples.push_back(sample);
    }
    return samples;
}

TEST(DrawCosts, FindsWhatMadeTheTimes) {
    for (uint64_t seed = 1; seed <= 50; ++seed) {
        Random random(seed);
        const DrawCosts made = madeCosts(random), found = fitDrawCosts(samplesOf(made, 40, 0, random));
        EXPECT_NEAR(found.object, made.object, 1e-6 * made.object) << "seed " << seed;
        EXPECT_NEAR(found.triangle, made.triangle, 1e-6 * made.triangle) << "seed " << seed;
        EXPECT_NEAR(found.vertex, made.vertex, 1e-6 * made.vertex) << "seed " << seed;
        EXPECT_NEAR(found.pixel, made.pixel, 1e-6 * made.pixel) << "seed " << seed;
        EXPECT_LT(found.error, 1e-9) << "seed " << seed;
        EXPECT_EQ(found.samples, 40u);
        const DrawCosts noisy = fitDrawCosts(samplesOf(made, 40, 0.02, random));
        EXPECT_NEAR(noisy.vertex, made.vertex, 0.25 * made.vertex + 1) << "seed " << seed;
        EXPECT_LT(noisy.error, 0.02) << "seed " << seed;
    }
}

// Two vertices a triangle, always: nobody can tell which of both costs. What they cost together is right.
TEST(DrawCosts, OfWhatGoesTogetherTheSumIsRight) {
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        const DrawCosts made = madeCosts(random);
        std::vector<CostSample> samples = samplesOf(made, 30, 0, random);
        for (CostSample& sample : samples) {
            sample.vertices = 2 * sample.triangles;
            sample.seconds = 1e-9 * made.nanosecondsOf(sample);
        }
        const DrawCosts found = fitDrawCosts(samples);
        const double together = made.triangle + 2 * made.vertex;
        EXPECT_NEAR(found.triangle + 2 * found.vertex, together, 1e-4 * together) << "seed " << seed;
        EXPECT_NEAR(found.pixel, made.pixel, 1e-4 * made.pixel) << "seed " << seed;
    }
}

TEST(DrawCosts, NothingCostsLessThanNothing) {
    for (uint64_t seed = 1; seed <= 50; ++seed) {
        Random random(seed);
        DrawCosts made = madeCosts(random);
        made.vertex = -2;  // as caches have it: more vertices, and yet faster
        const DrawCosts found = fitDrawCosts(samplesOf(made, 40, 0.05, random));
        for (const double cost : {found.object, found.triangle, found.vertex, found.pixel, found.sample, found.frame})
            EXPECT_GE(cost, 0) << "seed " << seed;
        EXPECT_EQ(found.vertex, 0) << "seed " << seed;
    }
    EXPECT_EQ(fitDrawCosts({}).samples, 0u);
    const CostSample nothing;
    EXPECT_EQ(fitDrawCosts({&nothing, 1}).samples, 0u);
}

/// A renderer whose clock is computed from what it is given.
class CountedRenderer : public LoadedRenderer {
public:
    CountedRenderer(const DrawCosts& costs, bool draws_anything) : costs_(costs), anything_(draws_anything) {}

    FrameTimes draw(const View& view, const SubmitFrame& submit, const StageLoads& loads) override {
        CostSample sample;
        const std::span<const DrawItem> items = submit();
        for (const DrawItem& item : items) {
            sample.triangles += loads.transform * double(item.mesh.triangles());
            sample.vertices += loads.transform * double(item.mesh.positions.size());
        }
        sample.objects = double(items.size());
        sample.pixels = double(countFragments(items, view, 1));
        sample.samples = double(view.width) * view.height;
        return {1e-9 * costs_.nanosecondsOf(sample), 0, 0.0};
    }
    bool drawsAnything() const override { return anything_; }

private:
    DrawCosts costs_;
    bool anything_;
};

TEST(DrawCosts, TrialsTellAllOfThemApart) {
    std::vector<MadeList> lists;
    for (uint64_t seed = 1; seed <= 12; ++seed) lists.push_back(clutter(seed, 20 * seed * seed, 0.3));
    // With corners of their own, and with more vertices than they need.
    std::vector<DrawItem> items;
    std::vector<std::vector<glm::vec3>> more(lists.size());
    for (size_t i = 0; i < lists.size(); ++i) {
        items.push_back(lists[i].items()[0]);
        more[i].assign(items[i].mesh.positions.begin(), items[i].mesh.positions.end());
        if (i % 3 == 0) more[i].resize(5 * more[i].size(), more[i][0]);
        items[i].mesh.positions = more[i];
    }
    Random random(7);
    const DrawCosts made = madeCosts(random);
    for (const bool anything : {true, false}) {
        CountedRenderer renderer(made, anything);
        const CostView view{madeView(320, 180), items};
        DrawCostSettings settings;
        settings.rounds = 1;
        const DrawCosts found = measureDrawCosts(renderer, {&view, 1}, settings);
        EXPECT_GE(found.samples, 13u);
        EXPECT_LT(found.error, 1e-6);
        EXPECT_NEAR(found.triangle, made.triangle, 0.01 * made.triangle) << anything;
        EXPECT_NEAR(found.vertex, made.vertex, 0.01 * made.vertex) << anything;
        EXPECT_NEAR(found.pixel, made.pixel, 0.01 * made.pixel) << anything;
        if (anything) { EXPECT_NEAR(found.object, made.object, 0.01 * made.object); }
    }
}

}  // namespace
}  // namespace sightline::test
