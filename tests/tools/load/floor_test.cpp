// One can stand at every place of a floor and go along all its steps, and a floor ends where people cannot go on.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/floor.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/tools/load/floor_way.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/city/city.h"
#include "sightline/tools/scene/solids.h"
#include "sightline/tools/scene/terrain/terrain.h"

namespace sightline {
using namespace tools;
namespace {

/// A scene of one material, an object a box.
class Boxes {
public:
    explicit Boxes(double scale = 1) : scale_(scale) { scene_.materials.resize(1); }

    Boxes& add(const glm::dvec3& min, const glm::dvec3& max) {
        city::MeshBuilder mesh;
        city::addBox(mesh, 0, scale_ * min, scale_ * max);
        SceneObject& object = scene_.objects.emplace_back();
        object.mesh = static_cast<uint32_t>(scene_.meshes.size());
        scene_.meshes.push_back(mesh.finish("box"));
        return *this;
    }

    /// Two rooms, 6 by 5 by 3, beside each other; with a doorway in the wall between them, and a floor.
    Boxes& addRooms(bool doorway, bool floor) {
        if (floor) add({-0.2, -0.2, -0.2}, {12.4, 0, 5.2});
        add({-0.2, 3, -0.2}, {12.4, 3.2, 5.2});  // the ceiling
        add({-0.2, 0, -0.2}, {0, 3, 5.2}).add({12.2, 0, -0.2}, {12.4, 3, 5.2});
        add({0, 0, -0.2}, {12.2, 3, 0}).add({0, 0, 5}, {12.2, 3, 5.2});
        if (!doorway) return add({6, 0, 0}, {6.2, 3, 5});
        return add({6, 0, 0}, {6.2, 3, 2}).add({6, 0, 2.9}, {6.2, 3, 5}).add({6, 2.1, 2}, {6.2, 3, 2.9});
    }

    const Scene& scene() const { return scene_; }

private:
    double scale_;
    Scene scene_;
};

WalkFloor floorOf(const Scene& scene, uint64_t seed = 1) { return findFloor(scene, RayProbe(scene), seed); }

/// Places on both sides of the wall between two rooms.
std::pair<int, int> inRooms(const WalkFloor& floor, double scale = 1) {
    std::pair<int, int> count{0, 0};
    for (const WalkFloor::Place& place : floor.places) ++(place.foot.x < 6.1 * scale ? count.first : count.second);
    return count;
}

bool blocked(const RayProbe& probe, const glm::dvec3& from, const glm::dvec3& to) {
    const auto hit = probe.nearest({from, to - from});
    return hit && hit->t < 1;
}

TEST(Floor, CarriesWhoStandsAndWalksThere) {
    const Scene building = makeBuilding(1, 2), city = makeCity(3, 400), terrain = makeTerrain(1, 64);
    for (const Scene* scene : {&building, &city, &terrain})
        for (uint64_t seed = 1; seed <= 4; ++seed) {
            const RayProbe probe(*scene);
            const WalkFloor floor = findFloor(*scene, probe, seed);
            ASSERT_GT(floor.places.size(), 50u) << scene->name << ", seed " << seed;
            ASSERT_LE(floor.places.size(), 2500u);
            EXPECT_EQ(floor.unit, 1);
            std::vector<bool> reached(floor.places.size());
            std::vector<uint32_t> queue = {0};
            reached[0] = true;
            for (size_t i = 0; i < queue.size(); ++i) {
                const uint32_t here = queue[i];
                const glm::dvec3 eye = floor.eye(here);
                const auto below = probe.nearest({eye, {0, -1, 0}}), above = probe.nearest({eye, {0, 1, 0}});
                ASSERT_TRUE(below) << scene->name;
                EXPECT_NEAR(below->t, 1.6, 1e-6);
                EXPECT_TRUE(!above || above->t > 0.1);
                for (const uint32_t next : floor.places[here].next) {
                    EXPECT_FALSE(blocked(probe, eye, floor.eye(next))) << scene->name << ", seed " << seed;
                    const auto& back = floor.places[next].next;
                    EXPECT_EQ(std::count(back.begin(), back.end(), here), 1);
                    EXPECT_LE(std::abs(floor.eye(next).y - eye.y), floor.climb);
                    if (!reached[next]) queue.push_back(next);
                    reached[next] = true;
                }
            }
            EXPECT_EQ(queue.size(), floor.places.size()) << "not all can be reached";
        }
}

TEST(Floor, LeadsThroughADoorwayAndNotThroughAWall) {
    const auto [left, right] = inRooms(floorOf(Boxes().addRooms(true, true).scene()));
    EXPECT_GT(left, 60);
    EXPECT_GT(right, 60);
    const auto [one, other] = inRooms(floorOf(Boxes().addRooms(false, true).scene()));
    EXPECT_GT(std::max(one, other), 60);
    EXPECT_EQ(std::min(one, other), 0);
}

TEST(Floor, TellsWhatAMetreIs) {
    for (const double scale : {1.0, 16.0, 40.0}) {
        Boxes rooms(scale);
        rooms.addRooms(true, true);
        // A unit is told by the rooms' heights alone; they are of all kinds in a building of three such rooms.
        const WalkFloor floor = floorOf(rooms.scene());
        const auto [left, right] = inRooms(floor, scale);
        EXPECT_GT(std::min(left, right), 20) << scale;
        EXPECT_GT(1.6 * floor.unit, 0.3 * scale) << "the eye is at the knee";
        EXPECT_LT(1.6 * floor.unit, 2.2 * scale) << "the eye is at the ceiling";
    }
}

TEST(Floor, IsTheGroundWhereRoomsHaveNone) {
    const Scene rooms = Boxes().addRooms(true, false).scene();
    const WalkFloor floor = floorOf(rooms);
    const auto [left, right] = inRooms(floor);
    EXPECT_GT(std::min(left, right), 60);
    for (const WalkFloor::Place& place : floor.places) EXPECT_NEAR(place.foot.y, 0, 1e-9);
    ASSERT_TRUE(floor.ground.has_value());
}

TEST(Floor, IsNotOnThings) {
    EXPECT_TRUE(floorOf({}).places.empty());
    EXPECT_TRUE(floorOf(Boxes().add({0, 0, 0}, {1, 1, 1}).scene()).places.empty());
    EXPECT_TRUE(floorOf(Boxes().add({0, 0, 0}, {4, 1, 2}).add({1, 1, 0}, {3, 1.5, 2}).scene()).places.empty())
        << "a car";
    EXPECT_TRUE(floorOf(Boxes().add({-3, 0, -3}, {3, 1, 3}).add({-1, 1, -1}, {1, 8, 1}).scene()).places.empty())
        << "a statue";
    // Gaps of all sizes, as between the parts of an engine.
    Boxes engine;
    double height = 0;
    for (int i = 0; i < 12; ++i) {
        engine.add({0, height, 0}, {300, height + 5, 300});
        height += 5 + 0.4 * std::pow(1.8, i);
    }
    EXPECT_TRUE(floorOf(engine.scene()).places.empty());
}

TEST(Floor, IsTheSameForASeed) {
    const Scene scene = makeBuilding(1, 2);
    const WalkFloor one = floorOf(scene, 5), same = floorOf(scene, 5), other = floorOf(scene, 6);
    ASSERT_EQ(one.places.size(), same.places.size());
    for (size_t i = 0; i < one.places.size(); ++i) {
        EXPECT_EQ(one.places[i].foot, same.places[i].foot);
        EXPECT_EQ(one.places[i].next, same.places[i].next);
    }
    EXPECT_NE(one.places[0].foot, other.places[0].foot);
}

TEST(FloorWay, GoesToBothRoomsInTheOpen) {
    const Scene scene = Boxes().addRooms(true, true).scene();
    const RayProbe probe(scene);
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        const std::vector<glm::dvec3> way = wayOver(findFloor(scene, probe, seed), probe, 1e9);
        ASSERT_GE(way.size(), 3u);
        bool left = false, right = false;
        for (size_t i = 0; i < way.size(); ++i) {
            left |= way[i].x < 5;
            right |= way[i].x > 7.2;
            EXPECT_NEAR(way[i].y, 1.6, 1e-9);
            EXPECT_FALSE(i > 0 && blocked(probe, way[i - 1], way[i])) << "seed " << seed << ", leg " << i;
        }
        EXPECT_TRUE(left && right) << "seed " << seed;
    }
    EXPECT_TRUE(wayOver({}, probe, 10).empty());
}

TEST(FloorWay, IsAsLongAsAskedForWhereThereIsRoom) {
    const Scene scene = makeCity(3, 400);
    const RayProbe probe(scene);
    const WalkFloor floor = findFloor(scene, probe, 1);
    double length = 0;
    const std::vector<glm::dvec3> way = wayOver(floor, probe, 50);
    for (size_t i = 1; i < way.size(); ++i) length += glm::length(way[i] - way[i - 1]);
    EXPECT_GT(length, 40);
    EXPECT_EQ(way.front(), floor.eye(0));
}

}  // namespace
}  // namespace sightline
