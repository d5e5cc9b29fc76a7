// Walks are the same everywhere, smooth, and in free space; and the path of a run is the one that was asked for.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/walk.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include <gtest/gtest.h>

#include "sightline/tools/load/choose_path.h"
#include "sightline/tools/load/orbit.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/load/tour.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/city/city.h"
#include "sightline/tools/scene/terrain/terrain.h"

namespace sightline {
using namespace tools;
namespace {

bool samePaths(const CameraPath& a, const CameraPath& b) {
    return std::equal(
        a.frames.begin(), a.frames.end(), b.frames.begin(), b.frames.end(),
        [](const CameraFrame& p, const CameraFrame& q) { return p.eye == q.eye && p.target == q.target; });
}

/// Holds a walk to its promise, and returns how far it went.
double expectSmooth(const Scene& scene, const WalkSettings& settings, const CameraPath& path) {
    const RayProbe probe(scene);
    EXPECT_EQ(path.frames.size(), settings.frames);
    const double step = settings.speed / settings.fps;
    const double least_cosine = std::cos(1.0471975513 / settings.fps) - 1e-12;
    const auto direction = [](const CameraFrame& frame) { return glm::normalize(frame.target - frame.eye); };
    double far = 0;
    for (size_t i = 1; i < path.frames.size(); ++i) {
        const CameraFrame &before = path.frames[i - 1], &frame = path.frames[i];
        const glm::dvec3 along = frame.eye - before.eye;
        const double length = glm::length(along);
        far += length;
        EXPECT_LE(length, step * (1 + 1e-9) + 1e-12) << "frame " << i;
        EXPECT_GE(glm::dot(direction(before), direction(frame)), least_cosine) << "frame " << i;
        EXPECT_TRUE(isUsable(makeView(frame, 64, 36))) << "frame " << i;
        if (!(length > 0)) continue;
        const auto hit = probe.nearest({before.eye, along});
        EXPECT_FALSE(hit && hit->t < 1) << "frame " << i << " is behind a surface";
    }
    return far;
}

TEST(Walk, IsSmoothAndFree) {
    const Scene city = makeCity(2, 400), building = makeBuilding(1, 2), terrain = makeTerrain(1, 64);
    for (const Scene* scene : {&city, &building, &terrain})
        for (uint64_t seed = 1; seed <= 5; ++seed)
            for (const double fps : {60.0, 10.0, 1.0}) {
                const WalkSettings settings{.frames = 200, .seed = seed, .fps = fps};
                const CameraPath path = walkThrough(*scene, settings);
                const double far = expectSmooth(*scene, settings, path);
                // It does not stand where it began.
                EXPECT_GT(far, 0.5 * settings.speed * settings.frames / fps)
                    << scene->name << ", seed " << seed << ", " << fps << " frames a second";
            }
}

TEST(Walk, IsTheSameForASeed) {
    const Scene scene = makeCity(1, 400);
    const WalkSettings settings{.frames = 50, .seed = 3};
    const CameraPath path = walkThrough(scene, settings);
    EXPECT_TRUE(samePaths(path, walkThrough(scene, settings)));
    EXPECT_FALSE(samePaths(path, walkThrough(scene, {.frames = 50, .seed = 4})));
    const CameraPath longer = walkThrough(scene, {.frames = 20, .seed = 3});
    EXPECT_EQ(longer.frames[0].eye, path.frames[0].eye);
}

TEST(Walk, GoesThroughNothing) {
    const Scene empty;
    EXPECT_GT(expectSmooth(empty, {.frames = 100}, walkThrough(empty, {.frames = 100})), 0.0);
    const Scene scene = makeCity(1, 100);
    EXPECT_EQ(expectSmooth(scene, {.frames = 30, .speed = 0}, walkThrough(scene, {.frames = 30, .speed = 0})), 0.0);
}

TEST(Walk, KeepsTheHeightOfAnEyeOverTheFloor) {
    const Scene building = makeBuilding(1, 2), city = makeCity(2, 400);
    for (const Scene* scene : {&building, &city}) {
        const RayProbe probe(*scene);
        for (const CameraFrame& frame : walkThrough(*scene, {.frames = 300, .seed = 7}).frames) {
            const auto below = probe.nearest({frame.eye, {0, -1, 0}});
            ASSERT_TRUE(below);
            EXPECT_GT(below->t, 0.5);  // a post is stepped over
            EXPECT_LT(below->t, 2.2);
        }
    }
}

TEST(ChoosePath, FileThenKindThenTheScenesOwnThenATour) {
    Scene scene = makeCity(1, 300);
    EXPECT_EQ(choosePath(scene, {})->frames.size(), 16u);
    EXPECT_TRUE(samePaths(*choosePath(scene, {}), tourOf(scene, 16, 1)));
    scene.cameras.resize(2);
    scene.cameras[0].fov_y = 1;
    scene.cameras[1].fov_y = 1;
    EXPECT_EQ(choosePath(scene, {})->frames.size(), 2u);
    PathChoice choice;
    choice.kind = PathKind::kScatter;
    EXPECT_TRUE(samePaths(*choosePath(scene, choice), seededCameras(scene, 16, 1)));
    choice.kind = PathKind::kTour;
    EXPECT_TRUE(samePaths(*choosePath(scene, choice), tourOf(scene, 16, 1)));
    choice.kind = PathKind::kOrbit;
    EXPECT_TRUE(samePaths(*choosePath(scene, choice), orbitAround(scene, 16, 1)));
    choice.kind = PathKind::kOverview;
    EXPECT_TRUE(samePaths(*choosePath(scene, choice), overviewsOf(scene, 1, 1)));
    choice.kind = PathKind::kWalk;
    EXPECT_EQ(choosePath(scene, choice)->frames.size(), 600u);
    choice.walk.frames = 5;
    choice.walk.seed = 9;
    EXPECT_TRUE(samePaths(*choosePath(scene, choice), walkThrough(scene, {.frames = 5, .seed = 9})));
    scene.walk_speed = 30;
    EXPECT_TRUE(samePaths(*choosePath(scene, choice), walkThrough(scene, {.frames = 5, .seed = 9, .speed = 30})));
    EXPECT_FALSE(samePaths(*choosePath(scene, choice), walkThrough(scene, {.frames = 5, .seed = 9})));
    choice.speed_given = true;
    EXPECT_TRUE(samePaths(*choosePath(scene, choice), walkThrough(scene, {.frames = 5, .seed = 9})));
    choice.kind = PathKind::kAny;
    EXPECT_TRUE(samePaths(*choosePath(scene, choice), tourOf(scene, 5, 9)));
    choice.walk.frames = 0;
    choice.seeded = true;
    EXPECT_TRUE(samePaths(*choosePath(scene, choice), tourOf(scene, 16, 9)));
    choice.file = testing::TempDir() + "sightline_choose_path.json";
    std::ofstream(choice.file) << cameraPathJson(cityStreetPath(1, 3));
    EXPECT_TRUE(samePaths(*choosePath(scene, choice), cityStreetPath(1, 3)));
    std::remove(choice.file.c_str());
    const Result<CameraPath> missing = choosePath(scene, choice);
    ASSERT_FALSE(missing.ok());
    EXPECT_NE(missing.error().message.find(choice.file), std::string::npos);
}

}  // namespace
}  // namespace sightline
