// Worlds in cells: what is seen through holes is kept, and what is culled cannot be seen.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>

#include "sightline/world/world_state.h"
#include "tests/support/furnished_rooms.h"

namespace sightline::test {
namespace {

TEST(CellStages, KeepWhatASightLineReaches) {
    uint64_t seen = 0, by_portals = 0;
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        Random random(seed);
        MadeRooms rooms(seed, 5, 4);
        furnish(rooms, random, 300);
        ASSERT_TRUE(rooms.world.attach(rooms.space));
        const Snapshot now = rooms.world.commit();
        Query query;
        for (int frame = 0; frame < 40; ++frame) {
            const glm::dvec3 eye = randomEye(rooms, random);
            View view = viewAt(eye, rooms.pointInside(random), kRoomCamera);
            const VisibleSet set =
                query.visible(now, view,
                              {.stages = frame % 4 == 0 ? stageBit(Stage::kPortals) : kCells | kFrustum,
                               .windows = static_cast<PortalWindows>(frame % 3)});
            by_portals += culledBy(set.stats, Stage::kPortals);
            EXPECT_EQ(set.stats.stages[static_cast<int>(Stage::kPortals)].doubt, 0u) << "seed " << seed << " " << frame;
            const std::set<uint64_t> kept = keySetOf(set);
            for (size_t i = 0; i < rooms.boxes.size(); ++i)
                if (seenPlace(rooms, i, eye, view, random)) {
                    ++seen;
                    EXPECT_TRUE(kept.count(i)) << "seed " << seed << " frame " << frame << " object " << i;
                }
        }
    }
    EXPECT_GT(seen, 500u);
    EXPECT_GT(by_portals, 10000u);
}

TEST(CellStages, OfThePvsCullWhatNoRowShows) {
    RoomsWithRows made(3);
    Random random(3);
    const Snapshot now = made.furnished(random, 400);
    Query query;
    uint64_t culled = 0;
    for (int frame = 0; frame < 60; ++frame) {
        const glm::dvec3 eye = randomEye(made.rooms, random);
        View view = viewAt(eye, made.rooms.pointInside(random), kRoomCamera);
        const VisibleSet set =
            query.visible(now, view, {.stages = stageBit(Stage::kPvs) | (frame % 2 ? kCells | kFrustum : 0)});
        const std::vector<uint8_t> reasons = reasonsOf(query, now);
        std::set<uint32_t> start;
        for (uint32_t room : made.roomsOf(MadeRooms::boxAround(eye, 1e-9))) start.insert(made.parts[room]);
        for (size_t i = 0; i < reasons.size(); ++i) {
            bool shown = false;
            for (const uint32_t room : made.roomsOf(made.rooms.boxes[i])) shown |= start.count(made.parts[room]) > 0;
            EXPECT_EQ(reasons[i] == kByPvs, !shown) << "frame " << frame << " object " << i;
        }
        for (const Stage stage : {Stage::kPvs, Stage::kPortals})
            EXPECT_EQ(culledBy(set.stats, stage),
                      static_cast<uint64_t>(std::count(reasons.begin(), reasons.end(), 1 + static_cast<int>(stage))));
        EXPECT_EQ(set.stats.visible, static_cast<uint64_t>(std::count(reasons.begin(), reasons.end(), 0)));
        culled += culledBy(set.stats, Stage::kPvs);
    }
    EXPECT_GT(culled, 5000u);
}

TEST(CellStages, CullNothingThatOthersKeepAndMoreThanThey) {
    RoomsWithRows made(5);
    Random random(5);
    const Snapshot now = made.furnished(random, 300);
    Query query;
    uint64_t fewer = 0;
    for (int frame = 0; frame < 40; ++frame) {
        View view = viewAt(randomEye(made.rooms, random), made.rooms.pointInside(random), kRoomCamera);
        QuerySettings settings;
        const auto ask = [&](uint32_t stages) {
            settings.stages = stages;
            return keySetOf(query.visible(now, view, settings));
        };
        const auto all = ask(0), frustum = ask(kFrustum), pvs = ask(stageBit(Stage::kPvs)),
                   portals = ask(stageBit(Stage::kPortals)), both = ask(kCells), together = ask(kCells | kFrustum);
        EXPECT_EQ(all.size(), made.rooms.boxes.size());
        EXPECT_EQ(both, portals) << "rows show more than windows do, and no less";
        EXPECT_TRUE(std::includes(pvs.begin(), pvs.end(), portals.begin(), portals.end()));
        std::set<uint64_t> meet;
        std::set_intersection(both.begin(), both.end(), frustum.begin(), frustum.end(),
                              std::inserter(meet, meet.end()));
        EXPECT_EQ(together, meet);
        fewer += frustum.size() - together.size();
    }
    EXPECT_GT(fewer, 500u);
}

TEST(CellStages, GoByDoorsAsTheSnapshotHasThem) {
    MadeRooms rooms(8, 5, 4, true);
    Random random(8);
    furnish(rooms, random, 300);
    ASSERT_TRUE(rooms.world.attach(rooms.space));
    EXPECT_EQ(rooms.world.findPortal("no such door"), PortalId());
    EXPECT_FALSE(rooms.world.setPortal({}, 0));
    EXPECT_FALSE(rooms.world.setPortal({static_cast<uint32_t>(rooms.holes.size() + 1)}, 0));
    Snapshot open = rooms.world.commit();
    Query query;
    uint64_t seen = 0, shut_away = 0;
    for (int frame = 0; frame < 60; ++frame) {
        for (size_t i = 0; i < rooms.holes.size(); ++i) {
            rooms.holes[i].open = random.below(2);
            const PortalId door = rooms.world.findPortal("door " + std::to_string(i));
            ASSERT_NE(door, PortalId());
            ASSERT_TRUE(rooms.world.setPortal(door, rooms.holes[i].open));
        }
        const Snapshot now = rooms.world.commit();
        const glm::dvec3 eye = rooms.pointInside(random);
        View view = viewAt(eye, rooms.pointInside(random), kRoomCamera);
        QuerySettings settings{.stages = kCells | kFrustum};
        const std::set<uint64_t> all = keySetOf(query.visible(open, view, settings)),
                                 kept = keySetOf(query.visible(now, view, settings));
        EXPECT_TRUE(std::includes(all.begin(), all.end(), kept.begin(), kept.end()));
        shut_away += all.size() - kept.size();
        for (size_t i = 0; i < rooms.boxes.size(); ++i)
            if (seenPlace(rooms, i, eye, view, random)) {
                ++seen;
                EXPECT_TRUE(kept.count(i)) << "frame " << frame << " object " << i;
            }
    }
    EXPECT_GT(seen, 200u);
    EXPECT_GT(shut_away, 100u);
}

TEST(CellStages, KeepWhatStandsInNoCellAndWhatHasNoBounds) {
    MadeRooms rooms(2, 3, 3);
    rooms.add(MadeRooms::boxAround({6, 40, 6}, 1));  // above the house
    rooms.add({{5, 1, 5}, {5, 1, std::numeric_limits<double>::infinity()}});
    rooms.add(MadeRooms::boxAround({10, 1, 10}, 1));  // in another room
    ASSERT_TRUE(rooms.world.attach(rooms.space));
    const Snapshot now = rooms.world.commit();
    Query query;
    View view = viewAt({2, 1.5, 2}, {2, 1.5, -10}, kRoomCamera);
    QuerySettings settings{.stages = kCells};
    EXPECT_EQ(keySetOf(query.visible(now, view, settings)), (std::set<uint64_t>{0, 1}));
    EXPECT_EQ(reasonsOf(query, now), (std::vector<uint8_t>{0, 0, kByPortals}));
    // Once it moves out of the house it is kept, and no longer when it is back.
    rooms.move(2, MadeRooms::boxAround({10, 20, 10}, 1));
    EXPECT_EQ(query.visible(rooms.world.commit(), view, settings).objects.size(), 3u);
    rooms.move(2, MadeRooms::boxAround({10, 1, 10}, 1));
    EXPECT_EQ(query.visible(rooms.world.commit(), view, settings).objects.size(), 2u);
    // An eye that is in no cell sees all.
    View above = viewAt({2, 30, 2}, {2, 0, 2.1}, kRoomCamera);
    const VisibleSet all = query.visible(now, above, settings);
    EXPECT_EQ(all.objects.size(), 3u);
    EXPECT_EQ(all.stats.stages[static_cast<int>(Stage::kPortals)].doubt, 2u);
}

TEST(CellStages, KeepAllWhereTheirLimitsOrTheViewForbidTheirWord) {
    MadeRooms rooms(4, 5, 5);
    Random random(4);
    furnish(rooms, random, 100);
    ASSERT_TRUE(rooms.world.attach(rooms.space));
    const Snapshot now = rooms.world.commit();
    Query query;
    View view = viewAt({2, 1.5, 2}, {18, 1.5, 17}, kRoomCamera);
    QuerySettings settings{.stages = kCells};
    const size_t some = query.visible(now, view, settings).objects.size();
    EXPECT_LT(some, 100u);
    settings.portal_work = 1;
    const VisibleSet spent = query.visible(now, view, settings);
    EXPECT_EQ(spent.objects.size(), 100u);
    EXPECT_EQ(spent.stats.stages[static_cast<int>(Stage::kPortals)].doubt, 100u);
    settings.portal_work = QuerySettings().portal_work;
    view.sections.add({0, -1, 0, 2});  // cuts the walls open, too
    EXPECT_EQ(query.visible(now, view, settings).objects.size(), 100u);
    view.sections = {};
    view.eye_radius = 1;  // there are no rows
    EXPECT_EQ(query.visible(now, view, settings).objects.size(), 100u);
    view.eye_radius = 0;
    EXPECT_EQ(query.visible(now, view, settings).objects.size(), some);
    rooms.world.detach();
    EXPECT_EQ(query.visible(rooms.world.commit(), view, settings).objects.size(), 100u);
}

TEST(CellStages, OfEyesWithinARadiusHoldForEachOfThem) {
    RoomsWithRows made(7);
    Random random(7);
    const Snapshot now = made.furnished(random, 300);
    Query query;
    uint64_t culled = 0;
    for (int frame = 0; frame < 30; ++frame) {
        const glm::dvec3 eye = made.rooms.pointInside(random);
        View view = viewAt(eye, made.rooms.pointInside(random), kRoomCamera);
        QuerySettings settings;
        view.eye_radius = random.uniform(0.01, 0.5);
        settings.stages = kAllStages;
        const std::set<uint64_t> all = keySetOf(query.visible(now, view, settings));
        culled += made.rooms.boxes.size() - all.size();
        for (int other = 0; other < 10; ++other) {
            glm::dvec3 way(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
            const glm::dvec3 near = eye + view.eye_radius * random.uniform(0, 1) * glm::normalize(way);
            const View one = viewAt(near, made.rooms.pointInside(random), kRoomCamera);
            const VisibleSet set = query.visible(now, one, {.stages = stageBit(Stage::kPvs)});
            if (set.stats.stages[0].doubt > 0) continue;  // it left the house
            const std::set<uint64_t> seen = keySetOf(set);
            EXPECT_TRUE(std::includes(all.begin(), all.end(), seen.begin(), seen.end()));
        }
    }
    EXPECT_GT(culled, 1000u);
}

TEST(CellStages, CountObjectsOfTheLayersAlone) {
    RoomsWithRows made(9);
    Random random(9);
    for (int i = 0; i < 200; ++i)
        made.rooms.add(MadeRooms::boxAround(made.rooms.pointInside(random), 0.3), 1u << random.below(3));
    made.rooms.add(MadeRooms::boxAround({6, 40, 6}, 1), 2);
    ASSERT_TRUE(made.rooms.world.attach(made.rooms.space, &made.rows));
    const Snapshot now = made.rooms.world.commit();
    Query query;
    for (int frame = 0; frame < 30; ++frame) {
        View view = viewAt(randomEye(made.rooms, random), made.rooms.pointInside(random), kRoomCamera);
        view.layers = 1 + random.below(7);
        const VisibleSet set =
            query.visible(now, view, {.stages = frame % 2 ? kCells | kFrustum : stageBit(Stage::kPvs)});
        const std::vector<uint8_t> reasons = reasonsOf(query, now);
        uint64_t by[256] = {};
        for (size_t i = 0; i < reasons.size(); ++i) {
            ++by[reasons[i]];
            EXPECT_EQ(reasons[i] == 255, !(now.state().object(static_cast<uint32_t>(i)).layers & view.layers));
        }
        EXPECT_EQ(set.stats.visible, by[0]);
        EXPECT_EQ(set.stats.objects, reasons.size() - by[255]);
        for (int stage = 0; stage < kStageCount; ++stage) EXPECT_EQ(set.stats.stages[stage].culled, by[1 + stage]);
    }
}

}  // namespace
}  // namespace sightline::test
