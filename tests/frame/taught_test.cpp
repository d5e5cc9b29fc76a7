// Queries that learn from another one: what they cull is hidden, whatever they were taught, and they draw next to nothing.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "sightline/query/query.h"
#include "tests/support/rooms.h"
#include "tests/support/targets.h"

namespace sightline::test {
namespace {

TEST(Taught, KeepWhatIsSeenInRoomsWhoseWallsMove) {
    uint64_t proved = 0, drawn = 0, frames = 0, kept = 0, kept_alone = 0, alone_drawn = 0;
    for (uint64_t seed = 11; seed <= 10 + rounds(6, 2); ++seed) {
        Rooms rooms(seed);
        Random random(seed);
        Steps steps(random);
        Query query, teacher, alone;
        for (int frame = 0; frame < 160; ++frame) {
            if (frame % 40 == 39) steps.jump(random);
            if (frame % 10 == 9) rooms.disturb(random);
            const View view = steps.next(frame / 20 % 3 == 2 ? 140 : 70, frame / 16 % 4 == 3 ? 0.8 : 0.05);
            const Snapshot now = rooms.world.commit();
            const std::string what = "seed " + std::to_string(seed) + " frame " + std::to_string(frame);
            const VisibleSet set = expectSound(rooms, query, now, view, {}, what, 2);
            proved += set.stats.proved;
            drawn += set.stats.occluder_triangles > 0;
            kept += set.objects.size();
            alone_drawn += alone.visible(now, view).stats.occluder_triangles > 0;
            kept_alone += Query().visible(now, view, {.stateless = true}).objects.size();
            ++frames;
            // It is a frame behind, or some, and answers for its own view are as good as any.
            if (random.below(3) == 0) continue;
            expectSound(rooms, teacher, now, view, {}, what + ", teacher", 1);
            query.learn(teacher);
        }
    }
    EXPECT_GT(proved, 10 * frames);
    EXPECT_LT(drawn, alone_drawn);
    EXPECT_LT(2 * drawn, frames) << "but at cuts, and where it would keep too much";
    EXPECT_LT(100 * kept, 120 * kept_alone);
    RecordProperty("drawn", std::to_string(drawn) + " of " + std::to_string(frames));
    RecordProperty("kept", std::to_string(kept) + " beside " + std::to_string(kept_alone));
}

/// What a teacher says is not believed: of another world, another view, another scale.
TEST(Taught, ByWhoeverNothingThatIsSeenIsCulled) {
    uint64_t proved = 0;
    for (uint64_t seed = 1; seed <= rounds(4, 2); ++seed) {
        Rooms rooms(seed), others(seed + 1);
        Random random(seed);
        Steps steps(random), elsewhere(random);
        Query query, teacher;
        for (int frame = 0; frame < 60; ++frame) {
            const Snapshot now = rooms.world.commit();
            const View view = steps.next();
            const std::string what = "seed " + std::to_string(seed) + " frame " + std::to_string(frame);
            proved += expectSound(rooms, query, now, view, {}, what, 2).stats.proved;
            if (random.below(4) == 0) elsewhere.jump(random);
            const bool other = random.below(2) == 0;
            teacher.visible(other ? others.world.commit() : now, elsewhere.next(20 + 100 * double(random.below(2))),
                            {.stateless = random.below(8) == 0});
            query.learn(teacher);
            query.learn(query);
            if (random.below(4) == 0) teacher.learn(query);
        }
    }
    EXPECT_GT(proved, 30u);
}

TEST(Taught, AnswerTheSameAgainAndWithEveryInstructionSet) {
    std::vector<std::vector<uint64_t>> first;
    forEachTarget([&](const std::string& target) {
        Rooms rooms(3);
        Random random(3);
        Steps steps(random);
        Query query, teacher;
        const Snapshot now = rooms.world.commit();
        for (size_t frame = 0; frame < 40; ++frame) {
            const View view = steps.next();
            query.learn(teacher);
            const VisibleSet set = query.visible(now, view);
            std::vector<uint64_t> keys = keysOf(set);
            keys.push_back(set.stats.proved);
            if (frame >= first.size()) first.push_back(keys);
            EXPECT_EQ(keys, first[frame]) << target << ", frame " << frame;
            teacher.visible(now, view);
        }
    });
}

/// Hundreds of things behind a wall, hidden as a whole; one after the other comes out from behind its edge. What is still
/// hidden is culled in the same answer, without drawing: what hid all of it hides most of it.
TEST(Taught, WhatIsLeftOfAGroupStaysHiddenWhenAPartComesIntoSight) {
    MadeWorld made;
    made.add({-6, -6, -10}, {6, 6, -9});
    for (int x = 0; x < 32; ++x)
        for (int y = 0; y < 32; ++y) {
            const glm::dvec3 at(x * 0.35 - 5.6, y * 0.35 - 5.6, -13);
            made.add(at, at + glm::dvec3(0.1, 0.1, 0.1));
        }
    const Snapshot now = made.world.commit();
    Query query, teacher;
    uint64_t came = 0, more = 0;
    for (int frame = 0; frame < 120; ++frame) {
        const View view = viewFrom({0.15 * frame, 0, 0}, {0, 0, -11});
        query.learn(teacher);
        const VisibleSet set = query.visible(now, view);
        const size_t seen = Query().visible(now, view, {.stateless = true}).objects.size();
        came = std::max<uint64_t>(came, seen);
        if (frame > 0) { EXPECT_EQ(set.stats.occluder_triangles, 0u) << frame; }
        more = std::max<uint64_t>(more, set.objects.size() - std::min(seen, set.objects.size()));
        teacher.visible(now, view);
    }
    EXPECT_GT(came, 200u);
    EXPECT_LE(more, 8u);
    RecordProperty("more", std::to_string(more));
}

TEST(Taught, DrawAgainWhereNobodyTeachesAnyLonger) {
    MadeWorld made;
    made.add({-6, -6, -10}, {6, 6, -9});
    for (int i = 0; i < 40; ++i) made.add({i % 8 - 4.0, i / 8 - 2.0, -20}, {i % 8 - 3.7, i / 8 - 1.7, -19.5});
    const Snapshot now = made.world.commit();
    const View view = viewFrom({0, 0, 0}, {0, 0, -1});
    Query query, teacher;
    const auto draws = [&](Query& asked) { return asked.visible(now, view).stats.occluder_triangles > 0; };
    for (int frame = 0; frame < 200; ++frame) {
        EXPECT_EQ(draws(query), frame == 0) << frame;
        EXPECT_TRUE(draws(teacher)) << frame;
        query.learn(teacher);
    }
    int taught = 0;
    while (taught < 1000 && !draws(query)) ++taught;
    EXPECT_GE(taught, 127);
    EXPECT_LT(taught, 300);
}

/// From whom nobody learns is a query like any other again, that seeks no more than it may.
TEST(Taught, TeachersStopWhereNobodyLearns) {
    Rooms rooms(1);
    Random random(1);
    Steps steps(random);
    const Snapshot now = rooms.world.commit();
    Query query, teacher;
    uint64_t taught = 0, later = 0;
    for (int frame = 0; frame < 400; ++frame) {
        if (frame % 40 == 39) steps.jump(random);
        const View view = steps.next();
        const QueryStats stats = teacher.visible(now, view).stats;
        if (frame < 200) query.learn(teacher);
        if (frame < 200) { EXPECT_GT(stats.occluder_triangles, 0u) << frame; }
        if (frame < 200) taught = std::max(taught, stats.proofs_sought);
        if (frame >= 328) later = std::max(later, stats.proofs_sought);
    }
    EXPECT_GT(taught, 64u);
    EXPECT_LE(later, 33u);
}

/// The teacher answers on another thread while this one asks, and things move.
TEST(Taught, ByAnotherThread) {
    std::vector<uint64_t> draws;  // of 20 walks three were drawn in half of their frames or more
    for (uint64_t seed = 1; seed <= 9; ++seed) {
        Rooms rooms(seed);
        Random random(seed);
        Steps steps(random);
        Query query, teacher;
        std::optional<std::thread> other;
        uint64_t drawn = 0;
        for (int frame = 0; frame < 80; ++frame) {
            if (frame % 8 == 7) {
                const auto thing = rooms.things[random.below(rooms.things.size())];
                rooms.moveTo(thing, {random.uniform(-2, 2), 0, random.uniform(-2, 2)});
            }
            const Snapshot now = rooms.world.commit();
            const View view = steps.next();
            if (other) {
                other->join();
                query.learn(teacher);
            }
            other.emplace([&teacher, now, view] { teacher.visible(now, view); });
            const std::string what = "seed " + std::to_string(seed) + " frame " + std::to_string(frame);
            drawn += expectSound(rooms, query, now, view, {}, what, 1).stats.occluder_triangles > 0;
        }
        other->join();
        draws.push_back(drawn);
    }
    std::nth_element(draws.begin(), draws.begin() + 4, draws.end());
    EXPECT_LT(draws[4], 10u) << "of 80 frames";
}

/// Each eye learns from the same eye of the teacher.
TEST(Taught, WithTwoEyes) {
    Rooms rooms(4);
    Random random(4);
    Steps steps(random);
    Query query, teacher;
    uint64_t drawn = 0, frames = 0;
    for (int frame = 0; frame < 60; ++frame) {
        const Snapshot now = rooms.world.commit();
        const View left = steps.next();
        View right = left;
        right.view[3][0] -= 0.065;
        query.learn(teacher);
        const StereoSet set = query.visibleStereo(now, left, right);
        drawn += (set.left.occluder_triangles > 0) + (set.right.occluder_triangles > 0);
        ++frames;
        std::vector<uint8_t> kept(rooms.ids.size(), 0);
        for (const Visible& v : set.objects) kept[v.key] = 1;
        for (const View& view : {left, right}) {
            const std::vector<uint8_t> seen = rooms.seen(view, 1);
            for (size_t i = 0; i < kept.size(); ++i)
                EXPECT_GE(kept[i], seen[i]) << "frame " << frame << " object " << i;
        }
        teacher.visibleStereo(now, left, right);
    }
    EXPECT_LT(drawn, frames / 2);
}

}  // namespace
}  // namespace sightline::test
