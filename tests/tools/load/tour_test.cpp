// Overviews and orbits have all of a scene in the image; a tour goes on from one to what suits the scene.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/tour.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "sightline/tools/load/orbit.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/city/city.h"
#include "sightline/tools/scene/solids.h"
#include "sightline/tools/scene/terrain/terrain.h"

namespace sightline {
using namespace tools;
namespace {

Scene makeThing() {
    Scene scene;
    scene.materials.resize(1);
    city::MeshBuilder mesh;
    city::addBox(mesh, 0, {10, -3, 0}, {14, -2, 2});
    scene.meshes.push_back(mesh.finish("thing"));
    scene.objects.push_back({});
    return scene;
}

bool inside(const Box3d& box, const glm::dvec3& p) {
    return glm::all(glm::greaterThanEqual(p, box.min)) && glm::all(glm::lessThanEqual(p, box.max));
}

/// How far to its edges the corners of all objects' boxes reach in an image of 3 by 2: 1 is the edge.
double reach(const Scene& scene, const CameraFrame& frame) {
    const glm::dmat4 clip = makeView(frame, 300, 200).projection * makeView(frame, 300, 200).view;
    double most = 0;
    for (const SceneObject& object : scene.objects) {
        const Box3d box = transformBox(scene.meshes[object.mesh].bounds, object.transform);
        for (int i = 0; i < 8; ++i) {
            const glm::dvec4 p = clip * glm::dvec4(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                                                   i & 4 ? box.max.z : box.min.z, 1);
            EXPECT_GT(p.w, frame.z_near);
            most = std::max({most, std::abs(p.x / p.w), std::abs(p.y / p.w)});
        }
    }
    return most;
}

TEST(Overview, HasAllOfTheSceneInTheImage) {
    const Scene thing = makeThing(), building = makeBuilding(1, 3), terrain = makeTerrain(1, 64);
    for (const Scene* scene : {&thing, &building, &terrain})
        for (uint64_t seed = 1; seed <= 8; ++seed) {
            for (const CameraFrame& frame : overviewsOf(*scene, 5, seed).frames) {
                EXPECT_LE(reach(*scene, frame), 1) << scene->name;
                EXPECT_GT(reach(*scene, frame), 0.9) << scene->name << " is small in it";
                EXPECT_TRUE(isUsable(makeView(frame, 300, 200)));
                EXPECT_FALSE(inside(worldBounds(*scene), frame.eye));
            }
        }
}

TEST(Orbit, GoesOnceAroundAtOneDistance) {
    const Scene thing = makeThing(), building = makeBuilding(1, 3);
    for (const Scene* scene : {&thing, &building}) {
        const CameraPath path = orbitAround(*scene, 24, 3);
        ASSERT_EQ(path.frames.size(), 24u);
        const glm::dvec3 center = worldBounds(*scene).center();
        double most = 0;
        for (size_t i = 0; i < 24; ++i) {
            const CameraFrame &frame = path.frames[i], &next = path.frames[(i + 1) % 24];
            EXPECT_NEAR(glm::length(frame.eye - center), glm::length(path.frames[0].eye - center), 1e-9);
            EXPECT_NEAR(glm::length(frame.eye - next.eye), glm::length(path.frames[0].eye - path.frames[1].eye), 1e-9);
            EXPECT_LE(reach(*scene, frame), 1);
            most = std::max(most, reach(*scene, frame));
        }
        EXPECT_GT(most, 0.85);
    }
    EXPECT_EQ(orbitAround({}, 4, 1).frames.size(), 4u) << "around nothing";
    EXPECT_TRUE(isUsable(makeView(overviewsOf({}, 1, 1).frames[0], 300, 200)));
}

TEST(Tour, ShowsTheWholeAndThenWalksInIt) {
    const Scene building = makeBuilding(1, 2), city = makeCity(3, 400), terrain = makeTerrain(1, 64);
    for (const Scene* scene : {&building, &city, &terrain}) {
        const RayProbe probe(*scene);
        for (uint64_t seed = 1; seed <= 4; ++seed) {
            const CameraPath path = tourOf(*scene, 16, seed);
            ASSERT_EQ(path.frames.size(), 16u);
            EXPECT_LE(reach(*scene, path.frames[0]), 1);
            double far = 0;
            for (size_t i = 1; i < 16; ++i) {
                const glm::dvec3 eye = path.frames[i].eye;
                EXPECT_TRUE(inside(worldBounds(*scene), eye)) << scene->name;
                const auto below = probe.nearest({eye, {0, -1, 0}});
                ASSERT_TRUE(below) << scene->name << ", frame " << i << " is over nothing";
                EXPECT_GT(below->t, 0.5);  // a post is stepped over
                if (i == 1) continue;
                const glm::dvec3 along = eye - path.frames[i - 1].eye;
                far += glm::length(along);
                if (!(glm::length(along) > 0)) continue;
                const auto hit = probe.nearest({path.frames[i - 1].eye, along});
                EXPECT_FALSE(hit && hit->t < 1) << scene->name << ", frame " << i << " is behind a surface";
            }
            EXPECT_GT(far, 4) << scene->name << ", seed " << seed;
        }
    }
}

/// The share of the image that one flat surface within a metre fills, by rays.
double wallBefore(const Scene& scene, const RayProbe& probe, const CameraFrame& frame) {
    const glm::dmat4 from_clip = glm::inverse(makeView(frame, 160, 90).projection * makeView(frame, 160, 90).view);
    constexpr int kWide = 16, kHigh = 9;
    int near = 0;
    for (int i = 0; i < kWide * kHigh; ++i) {
        const glm::dvec4 p =
            from_clip * glm::dvec4((i % kWide + 0.5) / kWide * 2 - 1, (i / kWide + 0.5) / kHigh * 2 - 1, 0.5, 1);
        const auto hit = probe.nearest({frame.eye, glm::normalize(glm::dvec3(p) / p.w - frame.eye)});
        near += hit && hit->t < 1 && hit->object < scene.objects.size() ? 1 : 0;
    }
    return near / static_cast<double>(kWide * kHigh);
}

TEST(Tour, HasFewWallsBeforeTheEye) {
    const Scene building = makeBuilding(1, 2), city = makeCity(3, 400), terrain = makeTerrain(1, 64);
    for (const Scene* scene : {&building, &city, &terrain}) {
        const RayProbe probe(*scene);
        for (uint64_t seed = 1; seed <= 6; ++seed) {
            int walls = 0;
            for (const CameraFrame& frame : tourOf(*scene, 16, seed).frames)
                walls += wallBefore(*scene, probe, frame) > 0.6 ? 1 : 0;
            EXPECT_LE(walls, 1) << scene->name << ", seed " << seed;
        }
    }
}

TEST(Tour, OrbitsAThing) {
    const Scene thing = makeThing();
    const CameraPath path = tourOf(thing, 9, 2), orbit = orbitAround(thing, 8, 2);
    ASSERT_EQ(path.frames.size(), 9u);
    for (size_t i = 0; i < 8; ++i) EXPECT_EQ(path.frames[i + 1].eye, orbit.frames[i].eye);
    EXPECT_EQ(tourOf(thing, 1, 2).frames.size(), 1u);
    EXPECT_EQ(tourOf(thing, 0, 2).frames.size(), 0u);
    EXPECT_EQ(tourOf({}, 3, 1).frames.size(), 3u);
}

}  // namespace
}  // namespace sightline
