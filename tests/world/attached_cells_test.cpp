// Worlds that cells are attached to: it does not matter how the world came about, and files and spaces are held to their word.
// SPDX-License-Identifier: MIT
#include <limits>

#include "sightline/query/explain/explain.h"
#include "sightline/visfile/visibility_file.h"
#include "tests/support/furnished_rooms.h"

namespace sightline::test {
namespace {

/// Furniture that comes, goes and moves from room to room each frame.
TEST(CellStages, OfAWorldThatHasLivedAreThoseOfANewOne) {
    for (uint64_t seed = 1; seed <= 3; ++seed) {
        RoomsWithRows made(seed);
        Random random(seed);
        MadeRooms& rooms = made.rooms;
        furnish(rooms, random, 200);
        ASSERT_TRUE(rooms.world.attach(rooms.space, &made.rows));
        std::vector<uint8_t> gone(rooms.boxes.size(), 0);
        Query query;
        Snapshot before;
        std::vector<uint64_t> before_keys;
        View before_view;
        for (int frame = 0; frame < 60; ++frame) {
            const int changes = frame % 7 == 0 ? 150 : 6;
            for (int i = 0; i < changes; ++i) {
                const auto which = random.below(static_cast<uint32_t>(rooms.boxes.size()));
                if (random.below(4) == 0) {
                    furnish(rooms, random, 1);
                    gone.push_back(0);
                } else if (random.below(5) == 0 && !gone[which]) {
                    rooms.world.remove(rooms.ids[which]);
                    gone[which] = 1;
                } else if (!gone[which]) {
                    Box3d box = MadeRooms::boxAround(rooms.pointInside(random), random.uniform(0.05, 1.0));
                    if (random.below(10) == 0) box.min.y = box.max.y = 50;  // in no room
                    if (random.below(10) == 0) box.max.x = std::numeric_limits<double>::infinity();
                    rooms.move(which, box);
                }
            }
            if (frame == 30) rooms.world.detach();
            if (frame == 40) { ASSERT_TRUE(rooms.world.attach(rooms.space, &made.rows)); }
            const Snapshot now = rooms.world.commit();
            World other;
            if (frame < 30 || frame >= 40) { ASSERT_TRUE(other.attach(rooms.space, &made.rows)); }
            for (size_t i = 0; i < rooms.boxes.size(); ++i) {
                if (!gone[i]) other.add(MadeRooms::objectOf(rooms.boxes[i], i));
            }
            const Snapshot fresh = other.commit();
            View view = viewAt(randomEye(rooms, random), rooms.pointInside(random), kRoomCamera);
            QuerySettings settings{.stages = kCells | kFrustum};
            const VisibleSet set = query.visible(now, view, settings);
            Query anew;
            const VisibleSet wanted = anew.visible(fresh, view, settings);
            EXPECT_EQ(keySetOf(set), keySetOf(wanted)) << "seed " << seed << " frame " << frame;
            for (int stage = 0; stage < kStageCount; ++stage)
                EXPECT_EQ(set.stats.stages[stage].culled, wanted.stats.stages[stage].culled) << frame << " " << stage;
            EXPECT_EQ(reasonsOf(query, now), reasonsOf(anew, fresh));
            // The snapshot before stays what it was.
            if (before) {
                std::vector<uint64_t> again;
                for (const Visible& v : query.visible(before, before_view, settings).objects) again.push_back(v.key);
                EXPECT_EQ(again, before_keys);
            }
            before = now;
            before_view = view;
            before_keys.clear();
            for (const Visible& v : query.visible(before, view, settings).objects) before_keys.push_back(v.key);
        }
    }
}

/// Objects that stand where they were baked are in the cells that the file says, others where their bounds are.
TEST(CellStages, TakeTheCellsOfWhatWasBakedFromTheFile) {
    RoomsWithRows made(11);
    MadeRooms& rooms = made.rooms;
    Random random(11);
    furnish(rooms, random, 150);
    const uint32_t count = 150, twin = 149, everywhere = 7, elsewhere = 9;
    const auto boundsOf = [](const Box3d& box) {
        return transformBox({glm::dvec3(0.0), glm::dvec3(1.0)}, MadeRooms::placed(box));
    };
    ObjectPlaces places;
    for (uint32_t i = 0; i < count; ++i) {
        const std::set<uint32_t> in = made.roomsOf(rooms.boxes[i]);
        // One is said to be in a room where its bounds are not: the file's word counts.
        const std::vector<uint32_t> cells =
            i == elsewhere ? std::vector<uint32_t>{35} : std::vector(in.begin(), in.end());
        places.add(i, boundsOf(rooms.boxes[i]), cells, i == everywhere);
    }
    const BitMatrix visible = made.visible();
    VisibilityContent content{visible, {}, "rooms"};
    content.space = &rooms.space;
    content.objects = &places;
    const Result<Array<char>> bytes = visibilityFile(content, VisibilityForm::kInPlace);
    ASSERT_TRUE(bytes.ok()) << bytes.error().message;
    const Result<VisibilityFile> file = VisibilityFile::open(*bytes, "rooms.vis");
    ASSERT_TRUE(file.ok()) << file.error().message;
    ASSERT_TRUE(rooms.world.attach(*file));
    QuerySettings settings{.stages = kCells};
    const auto cellsOf = [&](const Snapshot& now, uint32_t key) {
        View view = viewAt({2, 1.5, 2}, {3, 1.5, 3}, kRoomCamera);
        const Explanation why = Explainer(now, view, settings).explain(rooms.ids[key]);
        return std::set<uint32_t>(why.cells.object.begin(), why.cells.object.end());
    };
    Snapshot now = rooms.world.commit();
    for (uint32_t i = 0; i < count; ++i) {
        const std::set<uint32_t> wanted = i == elsewhere    ? std::set<uint32_t>{35}
                                          : i == everywhere ? std::set<uint32_t>{}
                                                            : made.roomsOf(rooms.boxes[i]);
        EXPECT_EQ(cellsOf(now, i), wanted) << i;
    }
    Query query;
    for (int frame = 0; frame < 10; ++frame) {
        const View view = viewAt(randomEye(rooms, random), rooms.pointInside(random), kRoomCamera);
        EXPECT_TRUE(keySetOf(query.visible(now, view, settings)).count(everywhere));
    }
    // What has moved goes by its bounds, also when it is back; so does one of two that look the same.
    const Box3d stood = rooms.boxes[elsewhere], there = rooms.boxes[twin];
    for (const Box3d& box : {MadeRooms::boxAround({2, 1, 2}, 0.5), stood}) {
        rooms.move(elsewhere, box);
        now = rooms.world.commit();
        EXPECT_EQ(cellsOf(now, elsewhere), made.roomsOf(box));
    }
    rooms.move(everywhere, MadeRooms::boxAround({2, 1, 2}, 0.5));
    now = rooms.world.commit();
    EXPECT_EQ(cellsOf(now, everywhere), (std::set<uint32_t>{0}));
    rooms.ids.push_back(rooms.world.add(MadeRooms::objectOf(there, twin)));
    now = rooms.world.commit();
    for (const uint32_t i : {twin, count}) EXPECT_EQ(cellsOf(now, i), made.roomsOf(there));
    rooms.world.remove(rooms.ids[twin]);
    now = rooms.world.commit();
    EXPECT_EQ(cellsOf(now, count), made.roomsOf(there));
}

TEST(CellStages, SayNothingOnceAWallIsGone) {
    RoomsWithRows made(12);
    MadeRooms& rooms = made.rooms;
    Random random(12);
    furnish(rooms, random, 60);
    const uint32_t wall = 3;
    ObjectPlaces places;
    for (uint32_t i = 0; i < 60; ++i) {
        const std::set<uint32_t> in = made.roomsOf(rooms.boxes[i]);
        const Box3d bounds = transformBox({glm::dvec3(0.0), glm::dvec3(1.0)}, MadeRooms::placed(rooms.boxes[i]));
        places.add(i, bounds, std::vector(in.begin(), in.end()), false, i == wall);
    }
    const uint32_t cells = rooms.space.graph.cells;
    BitMatrix visible(cells, cells);
    for (uint32_t a = 0; a < cells; ++a) visible.set(a, a);
    VisibilityContent content{visible, {}, "rooms"};
    content.space = &rooms.space;
    content.objects = &places;
    const Result<Array<char>> bytes = visibilityFile(content, VisibilityForm::kInPlace);
    ASSERT_TRUE(bytes.ok()) << bytes.error().message;
    const Result<VisibilityFile> file = VisibilityFile::open(*bytes, "rooms.vis");
    ASSERT_TRUE(file.ok()) << file.error().message;
    ASSERT_TRUE(rooms.world.attach(*file));
    View view = viewAt(randomEye(rooms, random), rooms.pointInside(random), kRoomCamera);
    Query query;
    const auto culled = [&] {
        const VisibleSet set = query.visible(rooms.world.commit(), view, {.stages = kCells});
        const uint64_t doubt = set.stats.stages[static_cast<int>(Stage::kPvs)].doubt;
        EXPECT_TRUE(doubt == 0 || set.objects.size() == set.stats.objects);
        return set.stats.objects - set.objects.size();
    };
    for (int i = 0; i < 50 && culled() == 0; ++i)
        view = viewAt(randomEye(rooms, random), rooms.pointInside(random), kRoomCamera);
    ASSERT_GT(culled(), 0u);
    rooms.move(wall, MadeRooms::boxAround({2, 1, 2}, 0.5));
    EXPECT_EQ(culled(), 0u);
    ASSERT_TRUE(rooms.world.attach(*file));
    EXPECT_EQ(culled(), 0u);
    rooms.world.remove(rooms.ids[wall]);
    EXPECT_EQ(culled(), 0u);
}

TEST(CellStages, RefuseSpacesThatAreNone) {
    MadeRooms rooms(1, 3, 3);
    Random random(1);
    furnish(rooms, random, 10);
    const auto refused = [&](auto change) {
        CellSpace space = rooms.space;
        change(space);
        const Status status = rooms.world.attach(space);
        ASSERT_FALSE(status);
        EXPECT_EQ(status.error().message.find("the cells cannot be attached: "), 0u);
    };
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    refused([](CellSpace& s) { s = {}; });
    refused([](CellSpace& s) { s.regions.pop_back(); });
    refused([](CellSpace& s) { s.graph.points[0].x = kNaN; });
    refused([](CellSpace& s) { s.graph.portals[0].cells[1] = s.graph.cells; });
    refused([](CellSpace& s) { s.graph.portals[0].count = 1u << 31; });
    refused([](CellSpace& s) { s.graph.portals[0].door = 0; });
    refused([](CellSpace& s) { s.planes[3].w = kNaN; });
    refused([](CellSpace& s) { s.regions[1].first_plane = 4000; });
    refused([](CellSpace& s) { s.outside = s.graph.cells; });
    refused([](CellSpace& s) { s.tolerance = -1; });
    refused([](CellSpace& s) { s.row_of_cell = {0}; });
    // Nothing has changed.
    Query query;
    View view = viewAt({2, 1.5, 2}, {10, 1.5, 10}, kRoomCamera);
    EXPECT_EQ(query.visible(rooms.world.commit(), view, {.stages = kCells}).objects.size(), 10u);
}

}  // namespace
}  // namespace sightline::test
