// The laws of the query: what is seen is kept, in every kind of view; and the answer is the same everywhere.
// SPDX-License-Identifier: MIT
#include "sightline/query/query.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <thread>

#include "sightline/query/connectivity.h"
#include "sightline/query/explain/credits.h"
#include "sightline/query/explain/explain.h"
#include "sightline/query/shadow_query.h"
#include "sightline/query/sight_query.h"
#include "tests/support/furnished_rooms.h"
#include "tests/support/made_world.h"
#include "tests/support/memory.h"
#include "tests/support/targets.h"

namespace sightline::test {
namespace {

TEST(Query, KeepsEverythingThatIsSeenFromRandomPlaces) {
    uint64_t culled = 0;
    for (uint64_t seed = 1; seed <= 12; ++seed) {
        MadeWorld made(seed, 400);
        const Snapshot now = made.world.commit();
        Query query;
        Random random(seed);
        for (int frame = 0; frame < 6; ++frame) {
            const VisibleSet set = expectSound(made, query, now, randomView(random), {},
                                               "seed " + std::to_string(seed) + " frame " + std::to_string(frame));
            culled += culledBy(set.stats, Stage::kOcclusion);
        }
    }
    EXPECT_GT(culled, 1000u);
}

TEST(Query, KeepsEverythingThatIsSeenInViewsChosenToHurt) {
    for (const double far : {0.0, 1e6}) {
        const glm::dvec3 home(far, -far, far);
        MadeWorld made;
        made.fill(7, 300, home);
        made.add(home + glm::dvec3(-30, -6, -30), home + glm::dvec3(30, -5.5, 30));  // a floor under all
        const Snapshot now = made.world.commit();
        Query query;
        for (int i = 0; i < 24; ++i) {
            const glm::dvec3 in_box =
                glm::dvec3(made.transforms[static_cast<size_t>(i) * 12] * glm::dvec4(0.5, 0.5, 0.5, 1));
            const glm::dvec3 at_face =
                glm::dvec3(made.transforms[static_cast<size_t>(i) * 12] * glm::dvec4(0.5, 0.5, 1.0001, 1));
            const glm::dvec3 ahead(std::cos(i), 0.1, std::sin(i));
            const std::string name = "far " + std::to_string(far) + " view " + std::to_string(i);
            expectSound(made, query, now, viewFrom(in_box, ahead), {}, name + " inside a bound");
            expectSound(made, query, now, viewFrom(at_face, {0, 0, -1}), {}, name + " against a wall");
            expectSound(made, query, now, viewFrom(at_face, ahead, {.z_near = 2.0}), {},
                        name + " near plane through objects");
            expectSound(made, query, now, viewFrom(at_face, ahead, {1}), {}, name + " 1 degree");
            expectSound(made, query, now, viewFrom(at_face, ahead, {150}), {}, name + " 150 degrees");
            expectSound(made, query, now, viewFrom(at_face, ahead, {60, 1, 1}), {}, name + " 1x1", 32);
            View parallel = viewFrom(home + glm::dvec3(0, 1, 0), ahead);
            parallel.projection =
                orthographic(12.0, 16.0 / 9.0, 0.1, i % 2 ? 60.0 : std::numeric_limits<double>::infinity());
            expectSound(made, query, now, parallel, {}, name + " orthographic");
            View shifted = viewFrom(at_face + glm::dvec3(0, 0, 3), ahead);
            shifted.projection[2][0] = 0.7;
            shifted.projection[2][1] = -0.4;
            expectSound(made, query, now, shifted, {}, name + " off-centre");
            if (HasFailure()) return;
        }
        expectSound(made, query, now, viewFrom(home, {1, 0, 0}, {60, 4096, 2160}), {}, "4096x2160", 1);
    }
}

TEST(Query, KeepsWhatAJitteredImageShows) {
    MadeWorld made(9, 400);
    const Snapshot now = made.world.commit();
    Query query;
    Random random(9);
    for (int frame = 0; frame < 20; ++frame) {
        const View view =
            viewFrom({random.uniform(-20, 20), 0, random.uniform(-20, 20)}, {random.uniform(-1, 1), 0, 1});
        const std::vector<uint8_t> kept = keptOf(query.visible(now, view), made.transforms.size());
        for (int shift = 0; shift < 4; ++shift) {
            const glm::dvec2 offset(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
            const std::vector<uint8_t> seen = made.seen(view, 2, offset);
            for (size_t i = 0; i < kept.size(); ++i)
                ASSERT_TRUE(kept[i] || !seen[i]) << "frame " << frame << " object " << i;
        }
    }
}

TEST(Query, AWallHidesWhatStandsBehindItAndNothingElse) {
    MadeWorld made;
    made.add({-5, -5, -10}, {5, 5, -9});
    for (int i = 0; i < 50; ++i) made.add({-2, -2, -20.0 - i}, {-1, -1, -19.5 - i});
    made.add({-2, -2, -8}, {-1, -1, -7});     // in front
    made.add({4.5, 0, -10.5}, {7, 1, -9.5});  // half behind, half beside
    Query query;
    const View view = viewFrom({0, 0, 0}, {0, 0, -1});
    std::vector<uint64_t> keys = keysOf(query.visible(made.world.commit(), view));
    std::sort(keys.begin(), keys.end());
    EXPECT_EQ(keys, (std::vector<uint64_t>{0, 51, 52}));
}

TEST(Query, ASnapshotOutlivesChanges) {
    MadeWorld made;
    const ObjectId wall = made.add({-5, -5, -10}, {5, 5, -9});
    const ObjectId behind = made.add({-1, -1, -20}, {1, 1, -19});
    const View view = viewFrom({0, 0, 0}, {0, 0, -1});
    const Snapshot before = made.world.commit();
    glm::dmat4 aside = made.transforms[0];
    aside[3].x = 100;
    EXPECT_TRUE(made.world.move(wall, aside));
    const Snapshot moved = made.world.commit();
    EXPECT_TRUE(made.world.remove(behind));
    EXPECT_FALSE(made.world.remove(behind));
    EXPECT_FALSE(made.world.move(behind, aside));
    const Snapshot removed = made.world.commit();
    made.add({-1, -1, -3}, {1, 1, -2});
    const Snapshot added = made.world.commit();
    Query query;
    EXPECT_EQ(keysOf(query.visible(before, view)), (std::vector<uint64_t>{0}));
    EXPECT_EQ(keysOf(query.visible(moved, view)), (std::vector<uint64_t>{1}));
    EXPECT_EQ(keysOf(query.visible(removed, view)), std::vector<uint64_t>{});
    EXPECT_EQ(keysOf(query.visible(added, view)), (std::vector<uint64_t>{2}));
    EXPECT_EQ(added.objectCount(), 2u);
}

TEST(Query, StaysSoundWhileObjectsComeMoveAndGo) {
    MadeWorld made(3, 600);
    Query query;
    Random random(3);
    std::vector<uint8_t> gone(made.transforms.size(), 0);
    for (int step = 0; step < 60; ++step) {
        if (step % 5 == 1) made.fill(100 + static_cast<uint64_t>(step), 1 + 15 * (step % 3), {0, 0, 0});
        gone.resize(made.transforms.size(), 0);
        for (int k = 0; k < 12; ++k) {
            const size_t i = random.below(made.ids.size());
            if (gone[i]) continue;
            if (step % 4 == 3) {
                ASSERT_TRUE(made.world.remove(made.ids[i]));
                gone[i] = 1;
                made.transforms[i] = glm::dmat4(0.0);  // draws nothing
                made.transforms[i][3] = glm::dvec4(1e5, 1e5, 1e5, 1);
                continue;
            }
            const double way = k % 4 ? 3 : 30;
            made.transforms[i][3] +=
                glm::dvec4(random.uniform(-way, way), random.uniform(-1, 1), random.uniform(-way, way), 0);
            ASSERT_TRUE(made.world.move(made.ids[i], made.transforms[i]));
        }
        const Snapshot now = made.world.commit();
        const View view =
            viewFrom({random.uniform(-20, 20), 0, random.uniform(-20, 20)}, {random.uniform(-1, 1), 0, 1});
        std::vector<uint8_t> kept(made.transforms.size(), 0);
        const VisibleSet set = query.visible(now, view, {.bins = step % 3 == 2 ? 4u : 1u});
        for (const Visible& v : set.objects) {
            EXPECT_FALSE(gone[v.key]);
            EXPECT_FALSE(kept[v.key]) << "reported twice";
            kept[v.key] = 1;
        }
        const std::vector<uint8_t> seen = made.seen(view, 2);
        for (size_t i = 0; i < kept.size(); ++i) ASSERT_TRUE(kept[i] || !seen[i]) << "step " << step << " object " << i;
        const std::vector<uint8_t> reasons = reasonsOf(query, now);
        EXPECT_EQ(accountedFor(set.stats), now.objectCount());
        EXPECT_EQ(static_cast<uint64_t>(std::count(reasons.begin(), reasons.end(), 0)), set.stats.visible);
        for (size_t i = 0, item = 0; i < gone.size(); ++i) {
            if (gone[i]) continue;
            ASSERT_EQ(kept[i] == 1, reasons[item] == 0) << "step " << step << " object " << i;
            ++item;
        }
    }
}

TEST(Query, SnapshotsAreAskedWhileTheWorldGoesOn) {
    MadeWorld made(11, 500);
    const View view = viewFrom({-20, 1, 3}, {1, 0, 0});
    std::vector<std::thread> readers;
    std::vector<std::vector<uint64_t>> expected(12), found(12);
    Random random(11);
    for (size_t frame = 0; frame < found.size(); ++frame) {
        const Snapshot now = made.world.commit();
        Query here;
        expected[frame] = keysOf(here.visible(now, view));
        readers.emplace_back([now, &view, &keys = found[frame]] {
            for (int again = 0; again < 20; ++again) {
                Query query;
                keys = keysOf(query.visible(now, view));
            }
        });
        for (int i = 0; i < 60; ++i) {
            const size_t which = random.below(made.ids.size());
            glm::dmat4 elsewhere = made.transforms[which];
            elsewhere[3].z += random.uniform(-20, 20);
            made.world.move(made.ids[which], elsewhere);
            if (i % 10 == 0) made.world.remove(made.ids[which]);
        }
        made.fill(100 + frame, 6, {0, 0, 0});
    }
    for (std::thread& reader : readers) reader.join();
    EXPECT_EQ(found, expected);
}

/// What is moved goes on where it was.
TEST(Query, AndItsKinMoveWithAllTheyRemember) {
    MadeWorld made(5, 300);
    World world = std::move(made.world);
    const Snapshot now = world.commit();
    Random random(5);
    Query still, from, to;
    ShadowQuery shadow, other_shadow;
    SightQuery sight, other_sight;
    for (int frame = 0; frame < 12; ++frame) {
        const View view = randomView(random);
        const std::vector<uint64_t> keys = keysOf(still.visible(now, view));
        Query made_of(std::move(from));
        EXPECT_EQ(keysOf(made_of.visible(now, view)), keys) << frame;
        to = std::move(made_of);
        EXPECT_EQ(to.changes().appeared.size(), still.changes().appeared.size()) << frame;
        from = std::move(to);

        const Light sun{.direction = {0.3, -1, 0.2}};
        const VisibleSet seen = still.visible(now, view, {.stateless = true});
        const std::vector<Visible> receivers(seen.objects.begin(), seen.objects.end());
        const size_t casters = shadow.casters(now, view, receivers, sun).casters.size();
        ShadowQuery shadow_of(std::move(shadow));
        EXPECT_EQ(shadow_of.casters(now, view, receivers, sun).casters.size(), casters);
        other_shadow = std::move(shadow_of);
        shadow = std::move(other_shadow);

        const glm::dvec3 a = randomVector(random, 8.0), b = randomVector(random, 8.0);
        const bool blocked = sight.look(now, a, b).blocked;
        SightQuery sight_of(std::move(sight));
        EXPECT_EQ(sight_of.look(now, a, b).blocked, blocked);
        other_sight = std::move(sight_of);
        sight = std::move(other_sight);

        Explainer explainer(now, view);
        const Verdict verdict = explainer.explain(made.ids[7]).verdict;
        Explainer explainer_of(std::move(explainer)), other_explainer(now, view);
        EXPECT_EQ(explainer_of.explain(made.ids[7]).verdict, verdict);
        other_explainer = std::move(explainer_of);
        EXPECT_EQ(other_explainer.explain(made.ids[7]).verdict, verdict);

        CreditBook book(now), other_book(now);
        const size_t credits = book.credits(view).size();
        CreditBook book_of(std::move(book));
        EXPECT_EQ(book_of.credits(view).size(), credits);
        other_book = std::move(book_of);
        EXPECT_EQ(other_book.credits(view).size(), credits);
    }
}

/// What was asked of one world and then of another keeps nothing of the first one.
TEST(Query, AndItsKinLetTheMemoryOfAWorldGo) {
    RoomsWithRows made(3);
    Random random(3);
    furnish(made.rooms, random, 50);
    CountingMemory arena;
    MadeWorld other(4, 50);
    const Snapshot there = other.world.commit();
    Query query;
    SightQuery sight;
    ShadowQuery shadow;
    ConnectivityQuery ways;
    const glm::dvec3 eye = made.rooms.pointInside(random);
    const View view = viewAt(eye, made.rooms.pointInside(random), kRoomCamera);
    const Light sun{.direction = {0.3, -1, 0.2}};
    const auto askAll = [&](const Snapshot& now) {
        const VisibleSet seen = query.visible(now, view, {.stages = kAllStages});
        const std::vector<Visible> receivers(seen.objects.begin(), seen.objects.end());
        shadow.casters(now, view, receivers, sun);
        sight.look(now, eye, eye + 1.0);
        sight.seenFrom(now, {eye - 0.1, eye + 0.1});
        ways.begin(now, eye);
        return ways.to(eye + 0.01).known;
    };
    for (int round = 0; round < 2; ++round) {
        {
            World world = World::create({.memory = &arena});
            for (size_t i = 0; i < made.rooms.boxes.size(); ++i) world.add(MadeRooms::objectOf(made.rooms.boxes[i], i));
            ASSERT_TRUE(world.attach(made.rooms.space, &made.rows));
            const Snapshot here = world.commit();
            EXPECT_TRUE(askAll(here));
            EXPECT_FALSE(askAll(there)) << "it has no cells";
        }
        EXPECT_EQ(arena.bytes, 0u);
    }
}

TEST(Query, IsTheSameOnEveryInstructionSetAndThread) {
    MadeWorld made(5, 2000);
    const Snapshot now = made.world.commit();
    const View view = viewFrom({3, 0, 3}, {1, 0, -0.4}, {70, 640, 360});
    Query query;
    const std::vector<uint64_t> expected = keysOf(query.visible(now, view));
    EXPECT_GT(expected.size(), 20u);
    forEachTarget([&](const std::string& target) {
        Query fresh;
        EXPECT_EQ(keysOf(fresh.visible(now, view)), expected) << target;
    });
    std::vector<uint64_t> answers[4];
    std::vector<std::thread> threads;
    for (auto& answer : answers)
        threads.emplace_back([&] {
            Query own;
            for (int i = 0; i < 10; ++i) answer = keysOf(own.visible(now, view));
        });
    for (std::thread& thread : threads) thread.join();
    // The same calls before, for an answer may depend on them.
    std::vector<uint64_t> tenth = expected;
    for (int i = 1; i < 10; ++i) tenth = keysOf(query.visible(now, view));
    for (const auto& answer : answers) EXPECT_EQ(answer, tenth);
}

TEST(Query, StagesCanBeLeftOutAndOnlyAdd) {
    MadeWorld made(6, 800);
    const Snapshot now = made.world.commit();
    View view = viewFrom({3, 0, 3}, {1, 0, -0.4});
    QuerySettings settings;
    Query query;
    const auto sorted = [&](uint32_t stages) {
        settings.stages = stages;
        std::vector<uint64_t> keys = keysOf(query.visible(now, view, settings));
        std::sort(keys.begin(), keys.end());
        return keys;
    };
    const auto all = sorted(kAllStages), frustum = sorted(stageBit(Stage::kFrustum)),
               occlusion = sorted(stageBit(Stage::kOcclusion)), none = sorted(0);
    EXPECT_EQ(none.size(), 800u);
    EXPECT_LT(all.size(), frustum.size());
    EXPECT_LT(frustum.size(), none.size());
    EXPECT_TRUE(std::includes(frustum.begin(), frustum.end(), all.begin(), all.end()));
    EXPECT_TRUE(std::includes(occlusion.begin(), occlusion.end(), all.begin(), all.end()));
}

TEST(Query, LayersNeitherReportNorHide) {
    MadeWorld made;
    made.add({-5, -5, -10}, {5, 5, -9}, true, 2);
    made.add({-1, -1, -20}, {1, 1, -19}, true, 1);
    const Snapshot now = made.world.commit();
    View view = viewFrom({0, 0, 0}, {0, 0, -1});
    Query query;
    EXPECT_EQ(keysOf(query.visible(now, view)), (std::vector<uint64_t>{0}));
    view.layers = 1;
    const VisibleSet set = query.visible(now, view);
    EXPECT_EQ(keysOf(set), (std::vector<uint64_t>{1}));
    EXPECT_EQ(set.stats.objects, 1u);
    EXPECT_EQ(reasonsOf(query, now), (std::vector<uint8_t>{255, 0}));
}

TEST(Query, ASpentBudgetKeepsMoreAndSaysSo) {
    MadeWorld made(8, 800);
    const Snapshot now = made.world.commit();
    View view = viewFrom({3, 0, 3}, {1, 0, -0.4});
    QuerySettings settings;
    Query query;
    const QueryStats rich = query.visible(now, view, settings).stats;
    settings.occluder_triangles = 40;
    const QueryStats poor = query.visible(now, view, settings).stats;
    EXPECT_FALSE(rich.budget_spent);
    EXPECT_TRUE(poor.budget_spent);
    EXPECT_GT(poor.visible, rich.visible);
    EXPECT_LE(poor.occluder_triangles, 40u + 2 * OccluderCluster::kMaxOwn);
}

TEST(Query, TakesViewportsOfAnyShape) {
    MadeWorld made(4, 100);
    const Snapshot now = made.world.commit();
    Query query;
    for (const auto& [width, height] : {std::pair{1u, 4000000000u}, {4000000000u, 1u}, {1u, 1u}, {65535u, 65535u}}) {
        const View view = viewFrom({3, 0, 3}, {1, 0, -0.4}, {60, width, height});
        const VisibleSet set = query.visible(now, view);
        EXPECT_LE(set.objects.size(), 100u) << width << "x" << height;
        EXPECT_EQ(accountedFor(set.stats), 100u);
    }
}

TEST(Query, KeepsWhateverItCannotJudge) {
    MadeWorld made;
    made.add({-5, -5, -10}, {5, 5, -9});
    ObjectDef broken;
    broken.key = 77;
    made.world.add(broken);  // empty bounds
    broken.bounds = {glm::dvec3(0), glm::dvec3(std::numeric_limits<double>::infinity())};
    made.world.add(broken);
    broken.bounds = {glm::dvec3(0), glm::dvec3(1)};
    broken.transform[3].x = std::numeric_limits<double>::quiet_NaN();
    broken.occluder = made.cube;
    made.world.add(broken);
    const Snapshot now = made.world.commit();
    View view = viewFrom({0, 0, 0}, {0, 0, -1});
    Query query;
    VisibleSet set = query.visible(now, view);
    EXPECT_EQ(set.objects.size(), 4u);
    EXPECT_EQ(set.stats.stages[static_cast<int>(Stage::kFrustum)].doubt, 3u);
    view.view[3].x = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(query.visible(now, view).objects.size(), 4u);
    view = viewFrom({100, 0, 0}, {1, 0, 0});
    view.jitter = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(query.visible(now, view).objects.size(), 4u);
    view = viewFrom({100, 0, 0}, {1, 0, 0});
    view.width = 0;
    EXPECT_EQ(query.visible(now, view).objects.size(), 4u);
    EXPECT_EQ(query.visible(Snapshot(), view).objects.size(), 0u);
    World empty;
    EXPECT_EQ(query.visible(empty.commit(), view).objects.size(), 0u);
}

}  // namespace
}  // namespace sightline::test
