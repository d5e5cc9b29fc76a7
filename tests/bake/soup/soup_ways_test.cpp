// Ways through cells of any polygons: who can go from one place to another without passing a triangle is connected.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "sightline/bake/soup/soup_cells.h"
#include "sightline/query/connectivity.h"
#include "tests/bake/aimed_points.h"
#include "tests/bake/any_triangles.h"
#include "tests/bake/marked/random_rooms.h"
#include "tests/bake/opaque_triangles.h"

namespace sightline {
using namespace bake;
using namespace tools;
namespace {

using namespace test;

/// A room without a door, in all that is walked through.
const Box3d kCloset{{0.5, 0.5, 0.5}, {2, 2, 2}};

struct Walked {
    uint64_t steps = 0, ways = 0, apart = 0;
    double longer = 0;  // the longest way, as a share of the walk to its end
};

/// Walks at random, and never through a triangle, be it seen from its front or from its back.
void walkAbout(const MarkedRooms& made, const SoupCells& cells, int steps, Random& random, Walked& counts) {
    const OpaqueTriangles truth(made.scene);
    const double room = cells.report.smallest_hole;
    const Box3d box = worldBounds(made.scene);
    World world = World::create({});
    ASSERT_TRUE(world.attach(cells.space));
    const Snapshot now = world.commit();
    ConnectivityQuery query;
    const glm::dvec3 begin = pointIn(box, random);
    if (!query.begin(now, begin)) return;
    glm::dvec3 at = begin;
    double walked = 0;
    for (int i = 0; i < steps; ++i) {
        const glm::dvec3 to = i % 2 ? pointAtPortal(cells.space.graph, random) : pointIn(box, random);
        const double length = std::pow(10, random.uniform(-1, 1)) * glm::distance(at, to);
        const glm::dvec3 along = glm::normalize(to - at), next = at + length * along;
        if (!contains(box, next) || !(length > 0)) continue;
        if (truth.meets(at, along, 0, length, room) || truth.meets(next, -along, 0, length, room)) {
            const Way way = query.to(glm::dvec3(made.place * glm::dvec4(pointIn(kCloset, random), 1)));
            counts.apart += way.known && !way.connected;
            continue;
        }
        at = next;
        walked += length;
        ++counts.steps;
        const Way way = query.to(at);
        if (!way.known) continue;
        ASSERT_TRUE(way.connected) << "from (" << begin.x << ", " << begin.y << ", " << begin.z << ") to (" << at.x
                                   << ", " << at.y << ", " << at.z << ")";
        ++counts.ways;
        ASSERT_GE(way.distance, glm::distance(begin, at) * (1 - 1e-9));
        counts.longer = std::max(counts.longer, way.distance / walked);
    }
}

TEST(SoupWays, WhoWalksWithoutPassingATriangleIsConnected) {
    Random random(1);
    Walked counts;
    for (int round = 0; round < 60; ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        MarkedRooms made = round % 3 == 0 ? anyTriangles(random) : randomRooms(random, round);
        made.room(kCloset);
        SoupCellSettings settings;
        settings.smallest_occluder = round % 2 ? std::pow(10, random.uniform(-2, 0.5)) : -1;
        const SoupCells cells = cellsOfSoup(made.scene, settings);
        if (cells.space.graph.portals.empty()) continue;
        walkAbout(made, cells, 400, random, counts);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(counts.ways, 3000u);
    EXPECT_GT(counts.apart, 300u);
    RecordProperty("longer", std::to_string(counts.longer));
    RecordProperty("ways", std::to_string(counts.ways));
    EXPECT_LT(counts.longer, 1.5);
}

/// A room, drawn from within alone, and a wall across it with a doorway.
TEST(SoupWays, GoByHolesThatAreOpenFromBothSides) {
    MarkedRooms made;
    made.room({{0, 0, 0}, {12, 3, 8}});  // drawn from within alone
    const FlatRect section{{0, 0}, {3, 8}};
    const FlatRect door{{0, 5}, {2, 6}};
    made.wall(0, 6, section, -1, {door});  // across the room, each side drawn by itself
    made.wall(0, 6.25, section, 1, {door});
    made.room({{6, door.min.x, door.min.y}, {6.25, door.max.x, door.max.y}}, 3);
    SoupCellSettings settings;
    settings.smallest_occluder = 0.1;
    const SoupCells cells = cellsOfSoup(made.scene, settings);
    World world = World::create({});
    ASSERT_TRUE(world.attach(cells.space));
    ConnectivityQuery query;
    ASSERT_TRUE(query.begin(world.commit(), {2, 1, 2}));
    const Way across = query.to({10, 1, 2});
    ASSERT_TRUE(across.known && across.connected);
    // By the two near corners of the doorway.
    ASSERT_EQ(across.points.size(), 4u);
    EXPECT_NEAR(across.points[1].z, 5, 1e-3);
    EXPECT_NEAR(across.points[2].z, 5, 1e-3);
    EXPECT_NEAR(across.distance, 5 + 0.25 + std::sqrt(3.75 * 3.75 + 3 * 3), 1e-3);
    EXPECT_NEAR(across.narrowest, 1, 1e-3);
    // Whoever stands outside sees through the backs of the walls, and yet is not in the room.
    const Way outside = query.to({-3, 1, 2});
    EXPECT_TRUE(outside.known);
    EXPECT_FALSE(outside.connected);
    // Nor is who stands within the wall.
    const Way inside = query.to({6.1, 1, 2});
    EXPECT_TRUE(inside.known);
    EXPECT_FALSE(inside.connected);
}

}  // namespace
}  // namespace sightline
