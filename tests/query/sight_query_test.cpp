// Lines of sight against triangles one by one, and sets of regions against what is seen from points in them.
// SPDX-License-Identifier: MIT
#include "sightline/query/sight_query.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "sightline/prepare/occluder/occluder.h"
#include "sightline/query/query.h"
#include "tests/support/furnished_rooms.h"
#include "tests/support/made_world.h"
#include "tests/support/meshes.h"

namespace sightline::test {
namespace {

/// How far from its middle a segment passes the inside of a unit cube: the room between it and the nearest edge of a
/// face, as a share of the cube; less than 0: it passes no face, or begins inside.
double roomInCube(const glm::dmat4& transform, const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dmat4 back = glm::inverse(transform);
    const glm::dvec3 a(back * glm::dvec4(from, 1)), b(back * glm::dvec4(to, 1));
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {0.0, 1.0}) {
            // From outside of the face to beyond it.
            const double outside = side == 0 ? -a[axis] : a[axis] - 1, inside = side == 0 ? b[axis] : 1 - b[axis];
            if (!(outside > 0 && outside + inside > 0 && inside > 0)) continue;
            const glm::dvec3 p = a + outside / (outside + inside) * (b - a);
            double room = std::min(outside, inside);
            for (int other = 0; other < 3; ++other)
                if (other != axis) room = std::min({room, p[other], 1 - p[other]});
            if (room > 0) return room;
        }
    return -1;
}

TEST(SightLine, IsBlockedByFrontsAlone) {
    uint64_t blocked = 0, open = 0;
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        MadeWorld made(seed, 120);
        Random random(seed);
        const Snapshot now = made.world.commit();
        SightQuery query;
        Box3d all;
        for (const glm::dmat4& t : made.transforms) all.grow(transformBox({glm::dvec3(0), glm::dvec3(1)}, t));
        for (int i = 0; i < 3000; ++i) {
            const glm::dvec3 from = randomIn(random, all), to = randomIn(random, all);
            const SightLine line = query.look(now, from, to);
            double room = -1;
            for (size_t k = 0; k < made.transforms.size(); ++k)
                if (made.hides[k]) room = std::max(room, roomInCube(made.transforms[k], from, to));
            // Of a face a segment may meet the diagonal, or an edge.
            if (line.blocked) { EXPECT_GT(room, -1e-9) << i; }
            if (room > 1e-6 && !line.blocked) ++open;
            blocked += line.blocked;
            if (!line.blocked) continue;
            // Whoever stands in the way does not when he is ignored.
            const ObjectId by = line.by.id;
            const SightLine without = query.look(now, from, to, {.layers = ~0u, .ignored = {&by, 1}});
            EXPECT_TRUE(!without.blocked || without.by.id != by);
            EXPECT_FALSE(query.look(now, from, to, {.layers = 0, .ignored = {}}).blocked);
        }
    }
    EXPECT_GT(blocked, 1000u);
    EXPECT_LT(open, blocked / 1000);
}

TEST(SightLine, PassesWhatCannotBeAsked) {
    World world = World::create({});
    SightQuery query;
    EXPECT_FALSE(query.look(world.commit(), glm::dvec3(0), glm::dvec3(1)).blocked);
    EXPECT_FALSE(query.look(Snapshot(), glm::dvec3(0), glm::dvec3(1)).blocked);
    ObjectDef def;
    def.bounds = {glm::dvec3(0), glm::dvec3(1)};
    def.occluder = world.addOccluder(prepareOccluder(boxMesh().view()));
    world.add(def);
    const Snapshot now = world.commit();
    EXPECT_TRUE(query.look(now, {-9, 0.3, 0.2}, {9, 0.3, 0.2}).blocked);
    EXPECT_FALSE(query.look(now, {-9, 3, 0}, {9, 3, 0}).blocked);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(query.look(now, {nan, 0, 0}, {9, 0, 0}).blocked);
    EXPECT_FALSE(query.look(now, {0.5, -1, 0.5}, {0, std::numeric_limits<double>::infinity(), 0}).blocked);
    EXPECT_FALSE(query.look(now, {0.5, 0.2, 0.3}, {9, 0.2, 0.3}).blocked) << "from within, its backs are seen through";
}

/// What is seen from a region is all that is seen from any place in it.
TEST(SeenFrom, HoldsWhatQueriesSeeFromPlacesInTheRegion) {
    uint64_t culled = 0, regions = 0;
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        RoomsWithRows made(seed);
        MadeRooms& rooms = made.rooms;
        Random random(seed);
        furnish(rooms, random, 200);
        ObjectDef endless;
        endless.key = 1000;
        endless.layers = 3;
        const ObjectId unbounded = rooms.world.add(endless);
        ASSERT_TRUE(rooms.world.attach(rooms.space, &made.rows));
        const Snapshot now = rooms.world.commit();
        Query query;
        SightQuery sight;
        for (int i = 0; i < 40; ++i) {
            const glm::dvec3 eye = rooms.pointInside(random);
            const double half = std::pow(10, random.uniform(-2, 0));
            const Box3d region{eye - half, eye + half};
            const RegionSet set = sight.seenFrom(now, region);
            std::set<uint64_t> keys;
            for (const Visible& v : set.objects) keys.insert(v.key);
            EXPECT_EQ(keys.size(), set.objects.size());
            EXPECT_TRUE(std::is_sorted(set.objects.begin(), set.objects.end(),
                                       [](const Visible& a, const Visible& b) { return a.key < b.key; }));
            EXPECT_TRUE(keys.count(1000)) << "it has no bounds";
            regions += set.known;
            culled += rooms.boxes.size() + 1 - keys.size();
            EXPECT_EQ(set.known || keys.size() == rooms.boxes.size() + 1, true);
            for (int k = 0; k < 8; ++k) {
                const glm::dvec3 place = randomIn(random, {eye - 0.9 * half, eye + 0.9 * half});
                const View view = viewAt(place, rooms.pointInside(random), Camera{70, 320, 180, 0.01 * half});
                for (const Visible& v : query.visible(now, view, {.stages = stageBit(Stage::kPvs) | kFrustum}).objects)
                    EXPECT_TRUE(keys.count(v.key)) << v.key;
            }
            for (const Visible& v : sight.seenFrom(now, region, 2).objects) EXPECT_EQ(v.id, unbounded);
        }
        const double nan = std::numeric_limits<double>::quiet_NaN();
        for (const Box3d& region :
             {Box3d(), Box3d{glm::dvec3(nan), glm::dvec3(1)}, Box3d{glm::dvec3(900), glm::dvec3(901)}}) {
            const RegionSet all = sight.seenFrom(now, region);
            EXPECT_FALSE(all.known);
            EXPECT_EQ(all.objects.size(), now.objectCount());
        }
    }
    EXPECT_GT(regions, 60u);
    EXPECT_GT(culled, 2000u);
    EXPECT_TRUE(SightQuery().seenFrom(Snapshot(), {glm::dvec3(0), glm::dvec3(1)}).objects.empty());
}

}  // namespace
}  // namespace sightline::test
