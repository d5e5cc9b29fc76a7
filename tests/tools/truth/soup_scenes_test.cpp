// Scenes divided by their own walls and by view cells: whatever portals and rows cull, no witness sees.
// SPDX-License-Identifier: MIT
//
// From portals, from the borders of cells, against walls and inside of furniture, on walks through all of it, and while doors
// and furniture move.
#include <gtest/gtest.h>

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "sightline/bake/bake.h"
#include "sightline/base/thread_pool.h"
#include "sightline/query/query.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/scene/city/city.h"
#include "tests/support/answers.h"
#include "tests/support/shared_scenes.h"
#include "tests/tools/truth/scene_views.h"
#include "tests/tools/truth/strange_eyes.h"

namespace sightline {
using namespace bake;
using namespace tools;
namespace {

using namespace test;

/// SIGHTLINE_FULL: finer view cells, eight times as many frames, each with a hundred times as many rays, and larger scenes.
bool full() { return std::getenv("SIGHTLINE_FULL") != nullptr; }

/// As `bake SCENE --cells walls --view-cells N` makes it.
/// @param movable  objects that may be elsewhere at run time  [Scene::objects]
Baked bakeSoup(const Scene& scene, uint32_t view_cells, const std::vector<uint32_t>& movable = {}) {
    ThreadPool threads(2);
    SoupCellSettings settings;
    settings.jobs = &threads;
    settings.movable = movable;
    for (const CameraFrame& frame : seededCameras(scene, 32, 1).frames) settings.eyes.push_back(frame.eye);
    BakeCells cells = soupToBake(scene, scene.name, settings);
    ViewCellSettings views;
    views.most_cells = view_cells;
    for (const CameraFrame& frame : seededCameras(scene, 1024, 1).frames) views.eyes.push_back(frame.eye);
    views.least_hidden = 0;
    views.movable = movable;
    views.jobs = &threads;
    addViewCells(cells, scene, views);
    cells.placing.moves.assign(scene.objects.size(), false);
    for (const uint32_t object : movable) cells.placing.moves[object] = true;
    BakeSettings in_place;
    in_place.jobs = &threads;
    in_place.form = VisibilityForm::kInPlace;
    Result<Baked> baked = bake::bake(std::move(cells), scene, in_place);
    EXPECT_TRUE(baked.ok()) << baked.error().message;
    return std::move(*baked);
}

/// One hard place after the other; between them walks, a step a frame, through whatever is in the way.
class StrangeWalk {
public:
    StrangeWalk(const Scene& scene, const Baked& baked, uint64_t seed)
        : scene_(scene), baked_(baked), bounds_(worldBounds(scene)), random_(seed) {}

    CameraFrame next() {
        if (left_ == 0) {
            eye_ = anywhere();
            ahead_ = glm::normalize(randomVector(random_, {1, 0.4, 1}));
            left_ = random_.below(3) ? 1 : 4;
        }
        CameraFrame camera;
        camera.eye = eye_;
        camera.target = eye_ + ahead_;
        constexpr double kNear[] = {0.001, 0.05, 0.3, 2.0};
        camera.z_near = kNear[random_.below(4)];
        eye_ += random_.uniform(0, 0.5) * ahead_;
        ahead_ = glm::normalize(ahead_ + randomVector(random_, 0.3));
        --left_;
        return camera;
    }

private:
    glm::dvec3 anywhere() {
        const CellGraph& graph = baked_.cells.space.graph;
        switch (random_.below(4)) {
            case 0:
                if (!graph.portals.empty()) return eyeAtPortal(graph, random_);
                [[fallthrough]];
            case 1:
                if (baked_.cells.views && !baked_.cells.views->tree.nodes.empty())
                    return eyeAtBorder(baked_.cells.views->tree, bounds_, random_);
                [[fallthrough]];
            case 2:
                return eyeAtWall(scene_, random_);
            default:
                return eyeInside(scene_, random_);
        }
    }

    const Scene& scene_;
    const Baked& baked_;
    const Box3d bounds_;
    Random random_;
    glm::dvec3 eye_{0.0}, ahead_{0.0};
    uint64_t left_ = 0;
};

struct CellTotals {
    uint64_t by_rows = 0, by_portals = 0, culled = 0, frames = 0;
};

CellTotals expectSoupHidesNothing(const Scene& scene, uint64_t frames) {
    CellTotals totals;
    const Baked baked = bakeSoup(scene, full() ? 2048 : 64);
    const Result<VisibilityFile> file = VisibilityFile::open(baked.file.bytes(VisibilityForm::kInPlace), "baked");
    EXPECT_TRUE(file.ok()) << file.error().message;
    LoadedWorld loaded = loadWorld(scene);
    EXPECT_TRUE(loaded.world.attach(*file));
    const Snapshot now = loaded.world.commit();
    const Witness witness(scene);
    StrangeWalk walk(scene, baked, 21);
    Query query;
    for (uint64_t frame = 0; frame < (full() ? 8 * frames : rounds(frames, frames / 4)); ++frame) {
        const View view = makeView(walk.next(), 320, 180);
        QuerySettings settings{.windows = static_cast<PortalWindows>(frame % 3)};
        settings.stages = frame % 2 ? kDefaultStages : kCellStages;
        const VisibleSet set = query.visible(now, view, settings);
        totals.by_rows += culledBy(set.stats, Stage::kPvs);
        totals.by_portals += culledBy(set.stats, Stage::kPortals);
        const std::vector<uint8_t> reasons = reasonsOf(query, now);
        totals.culled += reasons.size() - set.objects.size();
        ++totals.frames;
        WitnessSettings looks{.rays = full() ? 1000000u : 10000u};
        looks.aimed_rays = looks.rays / 2;
        looks.supersampling = 2;
        expectNoFalseCulls(witness, view, reasons, looks, scene.name + ", frame " + std::to_string(frame));
    }
    if (full())
        std::printf("%s: %" PRIu64 " frames, %" PRIu64 " culls, by rows %" PRIu64 ", by portals %" PRIu64 "\n",
                    scene.name.c_str(), totals.frames, totals.culled, totals.by_rows, totals.by_portals);
    return totals;
}

TEST(SoupScenes, ABuildingWithoutItsMarksHidesNothingThatIsSeen) {
    for (const uint32_t floors : full() ? std::vector<uint32_t>{1, 10} : std::vector<uint32_t>{1}) {
        Scene scene = makeBuilding(1, floors);
        scene.name = "building:1:" + std::to_string(floors);
        scene.cells.clear();
        scene.portals.clear();
        const CellTotals totals = expectSoupHidesNothing(scene, 24);
        EXPECT_GT(totals.by_rows, 0u);
        EXPECT_GT(totals.by_portals, 0u);
    }
}

/// Doors swing, chairs are carried about and may be thrown into the next room. With what was said to be movable cells and
/// rows hold; once a wall has moved they are off. `scene` is moved, too.
TEST(SoupScenes, WhatMovesHidesNothingThatIsSeen) {
    Scene scene = makeBuilding(1, 1);
    scene.name = "building:1:1, moving";
    std::vector<uint32_t> doors, movable;
    for (const ScenePortal& portal : scene.portals)
        if (portal.door != ScenePortal::kNone) doors.push_back(portal.door);
    scene.cells.clear();
    scene.portals.clear();
    movable = doors;
    Random random(5);
    for (uint32_t object = 0; object < scene.objects.size(); ++object)
        if (random.below(8) == 0) movable.push_back(object);
    std::sort(movable.begin(), movable.end());
    movable.erase(std::unique(movable.begin(), movable.end()), movable.end());
    const Baked baked = bakeSoup(scene, full() ? 2048 : 256, movable);
    const Result<VisibilityFile> file = VisibilityFile::open(baked.file.bytes(VisibilityForm::kInPlace), "baked");
    ASSERT_TRUE(file.ok()) << file.error().message;
    LoadedWorld loaded = loadWorld(scene);
    ASSERT_TRUE(loaded.world.attach(*file));
    StrangeWalk walk(scene, baked, 22);
    Query query;
    CellTotals totals;
    const auto place = [&](uint32_t object, const glm::dmat4& transform) {
        scene.objects[object].transform = transform;
        ASSERT_TRUE(loaded.world.move(loaded.ids[object], transform));
    };
    const auto look = [&](uint64_t frame) {
        const Snapshot now = loaded.world.commit();
        const View view = makeView(walk.next(), 320, 180);
        QuerySettings settings{.windows = static_cast<PortalWindows>(frame % 3)};
        settings.stages = frame % 2 ? kDefaultStages : kCellStages;
        const VisibleSet set = query.visible(now, view, settings);
        const std::vector<uint8_t> reasons = reasonsOf(query, now);
        totals.by_rows += culledBy(set.stats, Stage::kPvs);
        totals.by_portals += culledBy(set.stats, Stage::kPortals);
        totals.culled += reasons.size() - set.objects.size();
        WitnessSettings looks{.rays = full() ? 1000000u : 10000u};
        looks.aimed_rays = looks.rays / 2;
        looks.supersampling = 2;
        expectNoFalseCulls(Witness(scene), view, reasons, looks, "frame " + std::to_string(frame));
        return culledBy(set.stats, Stage::kPvs) + culledBy(set.stats, Stage::kPortals);
    };
    const uint64_t frames = full() ? 128 : rounds(32, 8);
    for (uint64_t frame = 0; frame < frames; ++frame) {
        for (uint64_t i = random.below(12); i > 0; --i) {
            const uint32_t leaf = doors[random.below(doors.size())], thing = movable[random.below(movable.size())];
            place(leaf, glm::rotate(scene.objects[leaf].transform, random.uniform(-1.5, 1.5), {0, 1, 0}));
            glm::dmat4 carried = scene.objects[thing].transform;
            carried[3] += glm::dvec4(randomVector(random, random.below(4) ? 0.5 : 8.0), 0);
            place(thing, carried);
        }
        look(frame);
    }
    EXPECT_GT(totals.by_rows, 0u);
    EXPECT_GT(totals.by_portals, 0u);
    if (full())
        std::printf("moving: %" PRIu64 " frames, %" PRIu64 " culls, by rows %" PRIu64 ", by portals %" PRIu64 "\n",
                    frames, totals.culled, totals.by_rows, totals.by_portals);

    uint32_t wall = 0;
    while (wall < file->objects().size() && !file->objects().isWall(wall)) ++wall;
    ASSERT_LT(wall, file->objects().size());
    uint32_t moved = 0;
    while (moved < scene.objects.size() && scene.objects[moved].key != file->objects().key(wall)) ++moved;
    ASSERT_LT(moved, scene.objects.size());
    place(moved, glm::translate(scene.objects[moved].transform, {0.0, 0.05, 0.0}));
    for (uint64_t frame = frames; frame < frames + 8; ++frame) EXPECT_EQ(look(frame), 0u) << "a wall has moved";
}

TEST(SoupScenes, ACityHidesNothingThatIsSeen) {
    for (const uint32_t objects : full() ? std::vector<uint32_t>{800, 100000} : std::vector<uint32_t>{800}) {
        Scene scene = makeCity(1, objects);
        scene.name = "city:1:" + std::to_string(objects);
        EXPECT_GT(expectSoupHidesNothing(scene, 16).by_rows, 0u);
    }
}

using SoupScenes = SceneTest;

TEST_P(SoupScenes, OfRealWallsHideNothingThatIsSeen) {
    const CellTotals totals = expectSoupHidesNothing(*scene, 16);
    EXPECT_GT(totals.by_rows + totals.by_portals, 0u);
}

std::vector<const char*> scenesOfSoup() {
    std::vector<const char*> names = {"bsi-duplex", "aws-small-house", "gazebo-willowgarage", "redeclipse-auster"};
    if (full()) names.insert(names.end(), {"sauer-pandora", "nibs-clinic-mep"});
    return names;
}

INSTANTIATE_TEST_SUITE_P(Scenes, SoupScenes, testing::ValuesIn(scenesOfSoup()), sceneLabel);

}  // namespace
}  // namespace sightline
