// The stage of occluder volumes in a query: sound by itself and before the tiles, explained, and the same everywhere.
// SPDX-License-Identifier: MIT
#include "sightline/stages/stage_memory.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sightline/query/explain/credits.h"
#include "sightline/query/explain/explain.h"
#include "tests/support/made_world.h"
#include "tests/support/targets.h"

namespace sightline::test {
namespace {

constexpr uint32_t kFrustum = stageBit(Stage::kFrustum), kVolumes = stageBit(Stage::kVolumes);
constexpr uint8_t kByVolumes = 1 + static_cast<uint8_t>(Stage::kVolumes);

QuerySettings withStages(uint32_t stages) { return {.stages = stages}; }

/// Also that each stage is asked of what the ones before it left.
void expectInTurn(MadeWorld& made, Query& query, const Snapshot& now, const View& view, const QuerySettings& settings,
                  const std::string& what) {
    const VisibleSet set = expectSound(made, query, now, view, settings, what);
    uint64_t left = set.stats.objects;
    const uint32_t counted = countedStages(stagesInUse(view, settings) & ~kCellStages);
    for (const Stage stage : kStageOrder) {
        EXPECT_EQ(set.stats.of(stage).tested, counted & stageBit(stage) ? left : 0) << what;
        left -= set.stats.of(stage).culled;
    }
}

TEST(Volumes, KeepWhatIsSeenAloneAndBeforeTheTiles) {
    uint64_t culled = 0;
    for (uint64_t seed = 1; seed <= 16; ++seed) {
        MadeWorld made(seed, 400);
        const Snapshot now = made.world.commit();
        Query query;
        Random random(seed);
        for (int frame = 0; frame < 8; ++frame) {
            View view = randomView(random, {.z_near = frame % 3 ? 0.1 : 3.0});
            QuerySettings settings = withStages(frame % 4 == 0   ? kVolumes
                                                : frame % 4 == 1 ? kFrustum | kVolumes
                                                                 : kAllStages);
            if (frame == 6) view.projection = orthographic(15, 16.0 / 9.0, 0.1, 100);
            settings.occluder_volumes = 1 + static_cast<uint32_t>(random.below(64));
            expectInTurn(made, query, now, view, settings,
                         "seed " + std::to_string(seed) + " frame " + std::to_string(frame));
            culled += culledBy(query.visible(now, view, settings).stats, Stage::kVolumes);
        }
    }
    EXPECT_GT(culled, 2000u);
}

struct WallAndThings {
    MadeWorld made;
    Snapshot now;

    WallAndThings() {
        made.add({-6, -6, -10}, {6, 6, -9});  // 0
        for (int i = 0; i < 40; ++i)
            made.add({i % 8 - 4.0, i / 8 - 2.0, -20}, {i % 8 - 3.7, i / 8 - 1.7, -19.5});  // behind
        made.add({-20, -1, -20}, {-19, 1, -19});                                           // 41: beside
        made.add({3, 2, -6}, {3.2, 2.2, -5.8});                                            // 42: before
        now = made.world.commit();
    }
};

TEST(Volumes, AWallHidesWhatStandsBehindItAndNothingElse) {
    WallAndThings world;
    Query query;
    const View view = viewFrom({0, 0, 0}, {0, 0, -1});
    QuerySettings settings = withStages(kFrustum | kVolumes);
    VisibleSet set = query.visible(world.now, view, settings);
    std::vector<uint64_t> keys = keysOf(set);
    std::sort(keys.begin(), keys.end());
    EXPECT_EQ(keys, (std::vector<uint64_t>{0, 41, 42}));
    EXPECT_EQ(culledBy(set.stats, Stage::kVolumes), 40u);
    settings.occluder_volumes = 0;
    EXPECT_EQ(query.visible(world.now, view, settings).objects.size(), 43u);
    settings.occluder_volumes = 64;
    EXPECT_EQ(query.visible(world.now, view, settings).objects.size(), 3u);
    settings.stages = kDefaultStages;
    set = query.visible(world.now, view, settings);
    EXPECT_EQ(culledBy(set.stats, Stage::kVolumes), 0u) << "only if asked for";
}

TEST(Volumes, OfObjectsOutsideTheLayersHideNothing) {
    MadeWorld made;
    made.add({-5, -5, -10}, {5, 5, -9}, true, 2);
    made.add({-1, -1, -20}, {1, 1, -19}, true, 1);
    const Snapshot now = made.world.commit();
    View view = viewFrom({0, 0, 0}, {0, 0, -1});
    const QuerySettings settings = withStages(kFrustum | kVolumes);
    Query query;
    EXPECT_EQ(keysOf(query.visible(now, view, settings)), (std::vector<uint64_t>{0}));
    view.layers = 1;
    EXPECT_EQ(keysOf(query.visible(now, view, settings)), (std::vector<uint64_t>{1}));
}

TEST(Volumes, AreTheSameOnEveryInstructionSet) {
    MadeWorld made(3, 600);
    const Snapshot now = made.world.commit();
    std::vector<std::vector<uint64_t>> expected;
    forEachTarget([&](const std::string& target) {
        std::vector<std::vector<uint64_t>> answers;
        Query query;
        Random random(4);
        for (int frame = 0; frame < 10; ++frame)
            answers.push_back(keysOf(
                query.visible(now, randomView(random), withStages(frame % 2 ? kFrustum | kVolumes : kAllStages))));
        if (expected.empty()) expected = answers;
        EXPECT_EQ(answers, expected) << target;
    });
}

TEST(Volumes, AreExplainedByTheirOneObject) {
    WallAndThings world;
    for (const uint32_t stages : {kFrustum | kVolumes, kAllStages}) {
        Explainer explainer(world.now, viewFrom({0, 0, 0}, {0, 0, -1}), withStages(stages));
        const Explanation why = explainer.explain(world.made.ids[7]);
        EXPECT_EQ(why.verdict, Verdict::kOccluded);
        EXPECT_EQ(why.occlusion.stage, Stage::kVolumes);
        ASSERT_EQ(why.occlusion.hiders.size(), 1u);
        EXPECT_EQ(why.occlusion.hiders[0].id, world.made.ids[0]);
        EXPECT_EQ(why.occlusion.hiders[0].share, 1.0);
        EXPECT_TRUE(why.occlusion.sufficient);
        EXPECT_GE(why.together, 1u);
        EXPECT_EQ(why.occlusion.without, Without::kVisible);
        EXPECT_EQ(explainer.explain(world.made.ids[41]).verdict, Verdict::kVisible);
    }
}

/// Whatever the stage culls is hidden by the one that is named, in a world of the two.
TEST(Volumes, NameAHiderThatSuffices) {
    uint64_t named = 0;
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        MadeWorld made(seed, 300);
        const Snapshot now = made.world.commit();
        Random random(seed);
        for (int frame = 0; frame < 4; ++frame) {
            const View view = randomView(random);
            const QuerySettings settings = withStages(kAllStages);
            Query query;
            query.visible(now, view, settings);
            const std::vector<uint8_t> reasons = reasonsOf(query, now);
            Explainer explainer(now, view, settings);
            for (size_t i = 0; i < reasons.size(); ++i) {
                if (reasons[i] != kByVolumes) continue;
                const Explanation why = explainer.explain(made.ids[i], {.without = false});
                ASSERT_EQ(why.occlusion.hiders.size(), 1u);
                const uint64_t hider = why.occlusion.hiders[0].key;
                ASSERT_NE(hider, i);
                MadeWorld pair;
                pair.add(made.transforms[hider], made.hides[hider]);
                pair.add(made.transforms[i], made.hides[i]);
                // It may lie outside, culled with a node that does not.
                const QuerySettings of_pair = withStages(kFrustum | kVolumes);
                for (const uint64_t key : keysOf(query.visible(pair.world.commit(), view, of_pair)))
                    EXPECT_EQ(key, 0u) << "seed " << seed << " frame " << frame << " object " << i << " behind "
                                       << hider;
                ++named;
            }
        }
    }
    EXPECT_GT(named, 100u);
}

TEST(Volumes, AreCreditedToTheirObjects) {
    WallAndThings world;
    CreditBook book(world.now);
    const auto credits = book.credits(viewFrom({0, 0, 0}, {0, 0, -1}), withStages(kAllStages));
    double hidden = 0;
    for (const Credit& credit : credits) {
        hidden += credit.hidden;
        if (credit.id == world.made.ids[0]) {
            EXPECT_EQ(credit.hidden, 40.0);
            EXPECT_GT(credit.triangles, 0u);
        }
    }
    EXPECT_EQ(hidden, 40.0);
    const auto alone = book.credits(viewFrom({0, 0, 0}, {0, 0, -1}), withStages(kFrustum | kVolumes));
    ASSERT_EQ(alone.size(), 1u);
    EXPECT_EQ(alone[0].hidden, 40.0);
}

}  // namespace
}  // namespace sightline::test
