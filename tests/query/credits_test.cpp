// Credits of occluders: they add up to what was culled, and go to who hides it.
// SPDX-License-Identifier: MIT
#include "sightline/query/explain/credits.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <vector>

#include "tests/support/made_world.h"

namespace sightline::test {
namespace {

constexpr Camera kCamera{.width = 320, .height = 180};

TEST(Credits, GoToTheWallThatHidesTheThings) {
    MadeWorld made;
    made.add({-60, -60, -10}, {0.05, 60, -9});  // the left half, and a little more: a gap would be seen
    made.add({0, -60, -10}, {60, 60, -9});      // the right half
    made.add({-60, -60, -100}, {60, 60, -99});  // far behind both
    for (int i = 0; i < 30; ++i) made.add({-8.0 - i % 5, -2, -22.0 - i}, {-7.5 - i % 5, -1, -21.5 - i});
    for (int i = 0; i < 10; ++i) made.add({7.0, -2, -22.0 - i}, {7.5, -1, -21.5 - i});
    std::vector<double> weights(made.ids.size(), 2.0);
    CreditBook book(made.world.commit(), weights);
    std::map<uint32_t, Credit> by_item;
    for (const Credit& credit : book.credits(viewFrom({0, 0, 0}, {0, 0, -1}, kCamera))) by_item[credit.item] = credit;
    ASSERT_EQ(by_item.size(), 2u) << "only the walls are rasterized";
    EXPECT_EQ(by_item[0].id, made.ids[0]);
    EXPECT_NEAR(by_item[0].hidden, 30.5, 0.02);  // the wall far behind is shared half and half
    EXPECT_NEAR(by_item[1].hidden, 10.5, 0.02);
    EXPECT_NEAR(by_item[0].hidden_weight, 2 * by_item[0].hidden, 1e-9);
    EXPECT_EQ(by_item[0].triangles, 12u);
    EXPECT_EQ(book.unshared(), 0.0);
}

TEST(Credits, AddUpToWhatTheOcclusionStageCulled) {
    uint64_t culled = 0;
    for (uint64_t seed = 1; seed <= 30; ++seed) {
        MadeWorld made(seed, 400);
        if (seed % 3 == 0)
            for (int i = 0; i < 40; ++i) made.add({i * 0.5 - 10, -3, 5}, {i * 0.5 - 9.7, -2, 6}, true, 2);
        const Snapshot now = made.world.commit();
        std::vector<double> weights;
        for (size_t i = 0; i < made.ids.size(); ++i) weights.push_back(static_cast<double>(i % 7));
        CreditBook book(now, weights);
        Query query;
        Random random(seed);
        for (int frame = 0; frame < 6; ++frame) {
            View view = randomView(random, kCamera);
            if (frame % 3 == 1) view.projection = orthographic(15, 16.0 / 9.0, 0.1, 100);
            if (seed % 3 == 0 && frame % 2) view.layers = 2;
            const QueryStats stats = query.visible(now, view, {.proofs = false}).stats;
            const std::vector<uint8_t> reasons = reasonsOf(query, now);
            double expected = 0, expected_weight = 0, hidden = 0, weight = 0;
            for (size_t i = 0; i < reasons.size(); ++i) {
                if (reasons[i] != 1 + static_cast<int>(Stage::kOcclusion)) continue;
                expected += 1;
                expected_weight += weights[i];
            }
            uint64_t triangles = 0;
            for (const Credit& credit : book.credits(view)) {
                EXPECT_EQ(reasons[credit.item], 0) << "seed " << seed << ": only what is kept is rasterized";
                EXPECT_EQ(credit.id, made.ids[credit.item]);
                hidden += credit.hidden;
                weight += credit.hidden_weight;
                triangles += credit.triangles;
            }
            const uint64_t by_occlusion = stats.stages[static_cast<int>(Stage::kOcclusion)].culled;
            culled += by_occlusion;
            EXPECT_EQ(static_cast<double>(by_occlusion), expected);
            EXPECT_NEAR(hidden, expected, 1e-6) << "seed " << seed << " frame " << frame;
            EXPECT_NEAR(weight, expected_weight, 1e-6) << "seed " << seed << " frame " << frame;
            EXPECT_EQ(triangles, stats.occluder_triangles);
            EXPECT_EQ(book.unshared(), 0.0) << "seed " << seed << " frame " << frame;
        }
    }
    EXPECT_GT(culled, 3000u);
}

TEST(Credits, AreNoneWithoutOccluders) {
    MadeWorld made;
    CreditBook empty(made.world.commit());
    EXPECT_TRUE(empty.credits(View()).empty());
    made.add({-5, -5, -10}, {5, 5, -9});
    CreditBook book(made.world.commit());
    View view = viewFrom({0, 0, 0}, {0, 0, -1}, kCamera);
    EXPECT_EQ(book.credits(view).size(), 0u) << "with nothing left to hide, nothing is drawn";
    EXPECT_TRUE(book.credits(view, {.stages = stageBit(Stage::kFrustum)}).empty());
    view.projection[0][0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(book.credits(view).empty());
    EXPECT_TRUE(CreditBook(Snapshot()).credits(View()).empty());
}

}  // namespace
}  // namespace sightline::test
