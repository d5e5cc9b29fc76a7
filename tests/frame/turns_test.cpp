// What a query does not ask: nothing seen is lost by it, and what is hidden is found out soon.
// SPDX-License-Identifier: MIT
#include "sightline/frame/turns.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "sightline/query/explain/explain.h"
#include "tests/support/made_world.h"
#include "tests/support/random.h"
#include "tests/support/targets.h"

namespace sightline::test {
using namespace studies;
namespace {

const QuerySettings kEachTime{.unasked_answers = 0};

/// Steps of a walk through a made world.
struct Walk {
    glm::dvec3 eye, step;
    glm::dvec3 ahead;

    explicit Walk(Random& random)
        : eye(random.uniform(-12, 12), random.uniform(-3, 3), random.uniform(-12, 12)),
          step(random.uniform(-0.05, 0.05), 0, random.uniform(-0.05, 0.05)),
          ahead(random.uniform(-1, 1), 0, random.uniform(-1, 1)) {}
    View next() {
        eye += step;
        return viewAt(eye, ahead, {70.0, 320, 180});
    }
};

TEST(Turns, KeepWhatIsSeenInAWorldThatChanges) {
    uint64_t unasked = 0, kept = 0, kept_alone = 0;
    for (uint64_t seed = 1; seed <= rounds(8, 2); ++seed) {
        MadeWorld made(seed, 300);
        Random random(seed);
        Walk walk(random);
        Query query;
        for (int frame = 0; frame < 32; ++frame) {
            if (frame % 4 == 3)
                for (int i = 0; i < 5; ++i) {
                    const size_t object = random.below(made.transforms.size());
                    made.transforms[object][3] += glm::dvec4(random.uniform(-2, 2), 0, random.uniform(-2, 2), 0);
                    made.world.move(made.ids[object], made.transforms[object]);
                }
            if (frame == 16) walk.eye = -walk.eye;
            const View view = walk.next();
            const Snapshot now = made.world.commit();
            const VisibleSet set = expectSound(made, query, now, view, {},
                                               "seed " + std::to_string(seed) + " frame " + std::to_string(frame));
            unasked += set.stats.unasked;
            kept += set.objects.size();
            kept_alone += Query().visible(now, view, {.stateless = true}).objects.size();
        }
    }
    EXPECT_GT(4 * unasked, kept);
    EXPECT_LT(100 * kept, 115 * kept_alone);
    RecordProperty("kept", std::to_string(kept) + " beside " + std::to_string(kept_alone));
}

TEST(Turns, FindOutSoonWhatHasBeenHidden) {
    MadeWorld made;
    Random random(3);
    for (int i = 0; i < 60; ++i) {
        const glm::dvec3 at(random.uniform(-4, 4), random.uniform(-3, 3), random.uniform(-30, -20));
        made.add(at, at + glm::dvec3(0.5));
    }
    const ObjectId wall = made.add({40, -20, -10}, {80, 20, -9});  // aside
    const View view = viewAt({0, 0, 0}, {0, 0, -1}, {60.0, 320, 180});
    Query query;
    for (int frame = 0; frame < 40; ++frame) query.visible(made.world.commit(), view);
    glm::dmat4 before_them = made.transforms.back();
    before_them[3].x = -20;
    made.world.move(wall, before_them);
    const Snapshot now = made.world.commit();
    size_t last = 61;
    for (uint32_t frame = 0; frame <= QuerySettings{}.unasked_answers; ++frame) {
        const size_t kept = query.visible(now, view).objects.size();
        EXPECT_LE(kept, last);
        last = kept;
    }
    EXPECT_EQ(last, 1u) << "all but the wall are hidden";
}

TEST(Turns, AskAllAgainWhereSomethingElseIsAskedFor) {
    MadeWorld made(9, 200);
    const Snapshot now = made.world.commit();
    View view = viewAt({1, 0, 2}, {-5, 0, -3}, {70.0, 320, 180});
    Query query;
    const auto unaskedAfter = [&](auto change, QuerySettings settings = {}) {
        for (int frame = 0; frame < 6; ++frame) query.visible(now, view);
        EXPECT_GT(query.visible(now, view).stats.unasked, 0u);
        View other = view;
        change(other);
        return query.visible(now, other, settings).stats.unasked;
    };
    EXPECT_EQ(unaskedAfter([](View& v) { v.sections.add({1, 0, 0, 9}); }), 0u);
    EXPECT_EQ(unaskedAfter([](View& v) { v.layers = 1; }), 0u);
    EXPECT_EQ(unaskedAfter([](View&) {}, {.stages = stageBit(Stage::kOcclusion)}), 0u);
    EXPECT_GT(unaskedAfter([](View&) {}), 0u);
}

TEST(Turns, AskAllAgainWhereTheEyeHasMovedFar) {
    uint64_t unasked = 0;
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        MadeWorld made(seed, 200);
        const Snapshot now = made.world.commit();
        Random random(seed);
        Query query;
        for (int frame = 0; frame < 8; ++frame) {
            const View view = randomView(random, {70.0, 320, 180}, {15, 4, 15});
            const VisibleSet set = query.visible(now, view, {.proofs = false});
            unasked += set.stats.unasked;
            EXPECT_EQ(keysOf(set), keysOf(Query().visible(now, view, {.stateless = true})))
                << "seed " << seed << " frame " << frame;
        }
    }
    EXPECT_EQ(unasked, 0u);
}

TEST(Turns, LeaveOutWhatStandsAroundAnEyeThatMovesLittle) {
    MadeWorld made;
    made.shapes = true;
    glm::dmat4 across = glm::rotate(glm::dmat4(1.0), glm::radians(45.0), {0.0, 1.0, 0.0});
    across = across * glm::scale(glm::dmat4(1.0), {20.0, 2.0, 0.2});
    across[3] = {-7.0, -1.0, 2.0, 1.0};  // a wall before the eye, whose box reaches around it
    made.add(across, true);
    const Snapshot now = made.world.commit();
    const auto looksWhere = [&](double step, uint32_t unasked_answers) {
        Query query;
        uint64_t looks = 0;
        for (int frame = 0; frame < 20; ++frame) {
            const View view = viewAt({frame % 2 ? step : 0.0, 0, 0}, {0, 0, -1}, {60.0, 320, 180});
            const VisibleSet set = query.visible(now, view, {.unasked_answers = unasked_answers, .proofs = false});
            EXPECT_EQ(set.objects.size(), 1u);
            looks += set.stats.second_looks;
        }
        return looks;
    };
    EXPECT_EQ(looksWhere(0.02, 0), 20u);
    EXPECT_LE(looksWhere(0.02, 15), 7u);
    EXPECT_EQ(looksWhere(2.0, 15), 20u) << "further than a sixteenth of its size";
}

TEST(Turns, GiveTheSameAnswersForTheSameCalls) {
    std::vector<std::vector<uint64_t>> all;
    forEachTarget([&](const std::string&) {
        MadeWorld made(5, 250);
        Random random(5);
        Walk walk(random);
        Query query;
        std::vector<uint64_t> keys;
        const Snapshot now = made.world.commit();
        for (int frame = 0; frame < 24; ++frame)
            for (const uint64_t key : keysOf(query.visible(now, walk.next(), {.bins = frame % 3 ? 1u : 3u})))
                keys.push_back(key);
        all.push_back(keys);
    });
    for (const auto& keys : all) EXPECT_EQ(keys, all[0]);
}

TEST(Turns, ReportNothingWhereAllIsAsked) {
    MadeWorld made(2, 150);
    const Snapshot now = made.world.commit();
    Random random(2);
    Walk walk(random);
    Query each, alone, parallel;
    for (int frame = 0; frame < 12; ++frame) {
        View view = walk.next();
        EXPECT_EQ(each.visible(now, view, kEachTime).stats.unasked, 0u);
        EXPECT_EQ(alone.visible(now, view, {.stateless = true}).stats.unasked, 0u);
        view.projection = orthographic(12, 16.0 / 9.0, 0.1, 100);
        EXPECT_EQ(parallel.visible(now, view).stats.unasked, 0u);
    }
}

TEST(Turns, AreToldOfByExplanations) {
    MadeWorld made;
    made.add({-20, -20, -10}, {20, 20, -9});
    const ObjectId behind = made.add({-1, -1, -30}, {1, 1, -28});
    const View view = viewAt({0, 0, 0}, {0, 0, -1}, {60.0, 320, 180});
    glm::dmat4 aside = made.transforms[0];
    aside[3].x = 40;
    made.world.move(made.ids[0], aside);
    Query query;
    for (int frame = 0; frame < 12; ++frame) query.visible(made.world.commit(), view);
    made.world.move(made.ids[0], made.transforms[0]);
    const Snapshot now = made.world.commit();
    bool was_unasked = false;
    for (int frame = 0; frame < 20; ++frame) {
        const bool kept = query.visible(now, view).objects.size() == 2;
        const Explanation why = query.explain(now, view, behind);
        EXPECT_EQ(why.verdict, Verdict::kOccluded) << "a question finds it hidden at once";
        EXPECT_EQ(why.unasked, kept) << "frame " << frame;
        EXPECT_FALSE(Explainer(now, view).explain(behind).unasked);
        was_unasked |= kept;
    }
    EXPECT_TRUE(was_unasked);
    EXPECT_EQ(query.visible(now, view).objects.size(), 1u);
}

}  // namespace
}  // namespace sightline::test
