// Ways through rooms: whether there is one, by arithmetic alone, and how long, by a search over many points of each hole.
// SPDX-License-Identifier: MIT
#include "sightline/query/connectivity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "tests/support/furnished_rooms.h"
#include "tests/support/made_rooms.h"
#include "tests/support/random.h"

namespace sightline::test {
namespace {

using Hole = MadeRooms::Hole;

double widthOf(const Hole& hole) { return std::min(hole.high - hole.low, hole.top - hole.bottom); }

/// Which rooms hang together by some of the holes.
std::vector<uint32_t> roomsTogether(const MadeRooms& rooms, const std::function<bool(const Hole&)>& counts) {
    std::vector<uint32_t> part(rooms.space.graph.cells);
    for (uint32_t i = 0; i < part.size(); ++i) part[i] = i;
    for (size_t round = 0; round < part.size(); ++round)
        for (const Hole& hole : rooms.holes)
            if (counts(hole)) part[hole.a] = part[hole.b] = std::min(part[hole.a], part[hole.b]);
    return part;
}

/// The shortest way over a grid of points of each hole: not shorter than the shortest way, and hardly longer.
double gridDistance(const MadeRooms& rooms, const glm::dvec3& from, const glm::dvec3& to) {
    constexpr int kAlong = 9, kUp = 5;
    struct Node {
        glm::dvec3 at;
        uint32_t rooms[2];
    };
    std::vector<Node> nodes = {{from, {rooms.roomOf(from), rooms.roomOf(from)}},
                               {to, {rooms.roomOf(to), rooms.roomOf(to)}}};
    for (const Hole& hole : rooms.holes) {
        if (hole.open <= 0) continue;
        for (int i = 0; i < kAlong; ++i)
            for (int k = 0; k < kUp; ++k) {
                const double along = glm::mix(hole.low, hole.high, double(i) / (kAlong - 1)),
                             up = glm::mix(hole.bottom, hole.top, double(k) / (kUp - 1));
                nodes.push_back({hole.axis == 0 ? glm::dvec3(hole.at, up, along) : glm::dvec3(along, up, hole.at),
                                 {hole.a, hole.b}});
            }
    }
    std::vector<std::vector<uint32_t>> in_room(rooms.space.graph.cells);
    for (uint32_t i = 0; i < nodes.size(); ++i) {
        in_room[nodes[i].rooms[0]].push_back(i);
        if (nodes[i].rooms[1] != nodes[i].rooms[0]) in_room[nodes[i].rooms[1]].push_back(i);
    }
    std::vector<double> distance(nodes.size(), INFINITY);
    std::priority_queue<std::pair<double, uint32_t>, std::vector<std::pair<double, uint32_t>>, std::greater<>> queue;
    distance[0] = 0;
    queue.emplace(0, 0);
    while (!queue.empty()) {
        const auto [far, node] = queue.top();
        queue.pop();
        if (far > distance[node]) continue;
        if (node == 1) return far;
        for (const uint32_t room : nodes[node].rooms)
            for (const uint32_t next : in_room[room]) {
                const double length = far + glm::distance(nodes[node].at, nodes[next].at);
                if (length >= distance[next]) continue;
                distance[next] = length;
                queue.emplace(length, next);
            }
    }
    return INFINITY;
}

/// The rooms with holes a little larger, so that a way may touch their edges.
MadeRooms widened(const MadeRooms& rooms, double by) {
    MadeRooms wide(1, 1, 1);
    wide.columns = rooms.columns;
    wide.rows = rooms.rows;
    wide.holes = rooms.holes;
    for (Hole& hole : wide.holes) {
        hole.low -= by;
        hole.high += by;
        hole.bottom -= by;
        hole.top += by;
    }
    return wide;
}

/// That a way begins and ends where it should, passes walls by holes alone, and tells its cells and its width.
void checkWay(const MadeRooms& rooms, const Way& way, const glm::dvec3& from, const glm::dvec3& to) {
    ASSERT_GE(way.points.size(), 2u);
    EXPECT_EQ(way.points.front(), from);
    EXPECT_EQ(way.points.back(), to);
    const MadeRooms wide = widened(rooms, 1e-3);
    double length = 0;
    for (size_t i = 1; i < way.points.size(); ++i) {
        length += glm::distance(way.points[i - 1], way.points[i]);
        EXPECT_TRUE(wide.sees(way.points[i - 1], way.points[i])) << i;
    }
    EXPECT_NEAR(length, way.distance, 1e-9 * length);
    ASSERT_GE(way.cells.size(), 1u);
    EXPECT_EQ(way.cells.front(), rooms.roomOf(from));
    EXPECT_EQ(way.cells.back(), rooms.roomOf(to));
    double narrowest = INFINITY;
    for (size_t i = 1; i < way.cells.size(); ++i) {
        const auto hole = std::find_if(rooms.holes.begin(), rooms.holes.end(), [&](const Hole& at) {
            return at.a == std::min(way.cells[i - 1], way.cells[i]) && at.b == std::max(way.cells[i - 1], way.cells[i]);
        });
        ASSERT_NE(hole, rooms.holes.end());
        EXPECT_GT(hole->open, 0);
        narrowest = std::min(narrowest, widthOf(*hole));
    }
    if (way.cells.size() > 1) {
        EXPECT_NEAR(way.narrowest, narrowest, 1e-9);
    } else {
        EXPECT_EQ(way.narrowest, INFINITY);
    }
}

TEST(Connectivity, IsThatOfTheHolesAndNearlyTheShortestWay) {
    uint64_t ways = 0, none = 0;
    double longest = 0, sum = 0;
    for (uint64_t seed = 1; seed <= 8; ++seed) {
        MadeRooms rooms(seed, 6, 6, true);
        ASSERT_TRUE(rooms.world.attach(rooms.space));
        Random random(seed);
        ConnectivityQuery query;
        for (int round = 0; round < 3; ++round) {
            // Some doors are shut; those that stand ajar are open.
            for (Hole& hole : rooms.holes) {
                hole.open = random.below(5) == 0 ? 0 : 1;
                const PortalId door = rooms.world.findPortal(rooms.space.doors[hole.door].name);
                ASSERT_TRUE(rooms.world.setPortal(door, hole.open > 0 && random.below(3) == 0 ? 0.5 : hole.open));
            }
            const Snapshot now = rooms.world.commit();
            const std::vector<uint32_t> parts = roomsTogether(rooms, [](const Hole& hole) { return hole.open > 0; });
            const glm::dvec3 from = rooms.pointInside(random);
            ASSERT_TRUE(query.begin(now, from));
            for (int i = 0; i < 24; ++i) {
                SCOPED_TRACE("seed " + std::to_string(seed) + ", round " + std::to_string(round) + ", place " +
                             std::to_string(i));
                const glm::dvec3 to = rooms.pointInside(random);
                const Way way = query.to(to);
                ASSERT_TRUE(way.known);
                ASSERT_EQ(way.connected, parts[rooms.roomOf(from)] == parts[rooms.roomOf(to)]);
                if (!way.connected) {
                    ++none;
                    EXPECT_TRUE(way.points.empty());
                    continue;
                }
                checkWay(rooms, way, from, to);
                if (HasFatalFailure()) return;
                const double shortest = gridDistance(rooms, from, to);
                // The grid's way bends at its points alone.
                EXPECT_GT(way.distance, 0.98 * shortest);
                longest = std::max(longest, way.distance / shortest);
                sum += way.distance / shortest;
                ++ways;
                // Whatever was asked for before.
                ConnectivityQuery other;
                ASSERT_TRUE(other.begin(now, from));
                EXPECT_EQ(other.to(to).distance, way.distance);
            }
        }
    }
    EXPECT_GT(ways, 300u);
    EXPECT_GT(none, 30u);
    RecordProperty("ways", std::to_string(ways));
    RecordProperty("longest", std::to_string(longest));
    RecordProperty("mean", std::to_string(sum / double(ways)));
    EXPECT_LT(longest, 1.02);
    EXPECT_LT(sum / double(ways), 1.0005);
}

TEST(Connectivity, LeavesOutWhatIsNarrowOrFar) {
    uint64_t narrow = 0, far = 0, near = 0;
    for (uint64_t seed = 11; seed <= 16; ++seed) {
        MadeRooms rooms(seed, 6, 6);
        ASSERT_TRUE(rooms.world.attach(rooms.space));
        const Snapshot now = rooms.world.commit();
        Random random(seed);
        ConnectivityQuery query;
        for (int i = 0; i < 60; ++i) {
            const glm::dvec3 from = rooms.pointInside(random), to = rooms.pointInside(random);
            WaySettings settings;
            settings.narrowest = random.uniform(0.4, 1.2);
            const std::vector<uint32_t> parts =
                roomsTogether(rooms, [&](const Hole& hole) { return widthOf(hole) >= settings.narrowest; });
            ASSERT_TRUE(query.begin(now, from, settings));
            const Way wide = query.to(to);
            EXPECT_EQ(wide.connected, parts[rooms.roomOf(from)] == parts[rooms.roomOf(to)]);
            if (wide.connected) { EXPECT_GE(wide.narrowest, settings.narrowest); }
            narrow += !wide.connected;

            ASSERT_TRUE(query.begin(now, from));
            const Way any = query.to(to);
            if (!any.connected) continue;
            const double distance = any.distance;
            settings = {.narrowest = 0, .farthest = distance * random.uniform(0.5, 1.5)};
            ASSERT_TRUE(query.begin(now, from, settings));
            const Way close = query.to(to);
            if (close.connected) { EXPECT_EQ(close.distance, distance); }
            if (distance > settings.farthest) { EXPECT_FALSE(close.connected); }
            far += !close.connected;
            near += close.connected;
        }
    }
    EXPECT_GT(narrow, 50u);
    EXPECT_GT(far, 50u);
    EXPECT_GT(near, 50u);
}

TEST(Connectivity, IsStraightInARoomAndBendsAtADoor) {
    CellSpaceBuilder build;
    const uint32_t hall = *build.addCell("hall", Box3d{{0, 0, 0}, {4, 3, 4}}),
                   study = *build.addCell("study", Box3d{{4, 0, 0}, {8, 3, 4}});
    ASSERT_TRUE(build.addPortal("door", hall, study, {{{4, 0, 1}, {4, 2, 1}, {4, 2, 2}, {4, 0, 2}}}));
    World world = World::create({});
    ASSERT_TRUE(world.attach(build.take()));
    const Snapshot now = world.commit();
    ConnectivityQuery query;
    ASSERT_TRUE(query.begin(now, {1, 1, 3}));
    const Way inside = query.to({3, 2, 1});
    EXPECT_EQ(inside.points.size(), 2u);
    EXPECT_DOUBLE_EQ(inside.distance, 3);
    EXPECT_EQ(inside.cells.size(), 1u);
    // Straight through the door.
    ASSERT_TRUE(query.begin(now, {1, 1, 1.5}));
    const Way through = query.to({7, 1.5, 1.25});
    EXPECT_EQ(through.points.size(), 2u);
    EXPECT_EQ(through.cells.size(), 2u);
    ASSERT_TRUE(query.begin(now, {1, 1, 3}));
    // By the jamb at z = 2, at the height of both.
    const Way bent = query.to({7, 1, 3});
    ASSERT_EQ(bent.points.size(), 3u);
    EXPECT_NEAR(glm::distance(bent.points[1], {4, 1, 2}), 0, 1e-6);
    EXPECT_NEAR(bent.distance, 2 * std::sqrt(10.0), 1e-9);
    EXPECT_DOUBLE_EQ(bent.narrowest, 1);
    // In the doorway it is in both rooms.
    const Way doorway = query.to({4, 1, 1.5});
    EXPECT_EQ(doorway.points.size(), 2u);
    EXPECT_EQ(doorway.cells.size(), 1u);
}

TEST(Connectivity, SaysWhereNothingIsKnown) {
    MadeRooms rooms(3, 3, 3);
    ConnectivityQuery query;
    const glm::dvec3 inside(1, 1, 1);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto isUnknown = [](const Way& way) {
        return !way.known && way.connected && way.points.empty() && way.cells.empty();
    };
    EXPECT_TRUE(isUnknown(query.to(inside))) << "nowhere was begun";
    EXPECT_FALSE(query.begin(Snapshot(), inside));
    EXPECT_FALSE(query.begin(rooms.world.commit(), inside)) << "the world has no cells";
    ASSERT_TRUE(rooms.world.attach(rooms.space));
    const Snapshot now = rooms.world.commit();
    for (const glm::dvec3& place : {glm::dvec3(nan), glm::dvec3(1e300), glm::dvec3(-5, 1, 1), glm::dvec3(1, 3.5, 1)}) {
        EXPECT_FALSE(query.begin(now, place));
        EXPECT_TRUE(isUnknown(query.to(inside)));
        ASSERT_TRUE(query.begin(now, inside));
        EXPECT_TRUE(isUnknown(query.to(place)));
    }
    // Other cells are taken at the next beginning.
    rooms.world.detach();
    EXPECT_FALSE(query.begin(rooms.world.commit(), inside));
    MadeRooms others(4, 2, 2);
    ASSERT_TRUE(others.world.attach(others.space));
    ASSERT_TRUE(query.begin(others.world.commit(), inside));
    EXPECT_TRUE(query.to(inside).known);
    ConnectivityQuery moved = std::move(query);
    EXPECT_TRUE(moved.to({2, 1, 2}).connected);
}

}  // namespace
}  // namespace sightline::test
