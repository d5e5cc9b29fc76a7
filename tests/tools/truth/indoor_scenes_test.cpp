// Buildings divided by their cells: whatever rows and portals cull, no witness sees.
// SPDX-License-Identifier: MIT
//
// From doorways, on the borders of cells, with near planes that reach through walls, and with doors opened and shut
// between frames.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sightline/bake/flow/cell_visibility.h"
#include "sightline/bake/marked/scene_cells.h"
#include "sightline/bake/objects/object_cells.h"
#include "sightline/base/random.h"
#include "sightline/geom/mirror.h"
#include "sightline/query/query.h"
#include "sightline/tools/import/scene_file.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/truth/verify.h"
#include "sightline/visfile/visibility_file.h"
#include "test_scenes.h"
#include "tests/support/answers.h"
#include "tests/tools/truth/scene_views.h"
#include "tests/tools/truth/strange_eyes.h"

namespace sightline {
using namespace bake;
using namespace tools;
namespace {

using namespace test;

/// A visibility file in memory, and what it looks into.
struct BakedScene {
    SceneCells cells;
    Array<char> bytes;
    std::unique_ptr<VisibilityFile> file;
};

BakedScene bakeScene(const Scene& scene, bool trusted) {
    BakedScene baked;
    SceneCellSettings settings;
    settings.trusted = trusted;
    baked.cells = cellsOfScene(scene, settings);
    CellSpace& space = baked.cells.space;
    for (uint32_t cell = 0; cell < space.graph.cells; ++cell) space.row_of_cell.push_back(cell);
    CellVisibility rows = bakeCellVisibility(space.graph);
    seeAllFromOutside(space, rows.visible);
    ObjectCellSettings placing;
    placing.walls = baked.cells.report.walls;
    const ObjectCells objects = cellsOfObjects(scene, space, placing);
    VisibilityContent content{rows.visible, {}, scene.name, 1, &space};
    content.objects = &objects.places;
    Result<Array<char>> bytes = visibilityFile(content, VisibilityForm::kInPlace);
    EXPECT_TRUE(bytes.ok()) << bytes.error().message;
    baked.bytes = std::move(*bytes);
    Result<VisibilityFile> file = VisibilityFile::open(baked.bytes, "baked");
    EXPECT_TRUE(file.ok()) << file.error().message;
    baked.file = std::make_unique<VisibilityFile>(std::move(*file));
    return baked;
}

struct Totals {
    uint64_t by_cells = 0, by_portals = 0, kept = 0, frames = 0, known = 0;
};

/// @param doors  are set at random between rounds
Totals expectNothingSeenIsCulled(const Scene& scene, const BakedScene& baked, bool doors, int rounds, int frames) {
    Totals totals;
    Random random(11);
    Scene changed = scene;
    LoadedWorld loaded = loadWorld(scene, {}, loadSettings(false, 0));
    EXPECT_TRUE(loaded.world.attach(*baked.file));
    const CellSpace& space = baked.cells.space;
    Query query;
    for (int round = 0; round < rounds; ++round) {
        for (uint32_t door = 0; doors && door < space.doors.size(); ++door) {
            uint32_t leaf = 0;
            while (scene.objects[leaf].key != space.doors[door].key) ++leaf;
            const bool ajar = scene.objects[leaf].name.find("(open)") != std::string::npos;
            const bool shut = !ajar && random.below(2);
            // The leaf of an open door hangs somewhere else; some stand open as they are made.
            glm::dmat4 place = scene.objects[leaf].transform;
            if (!shut)
                place[3] += glm::dvec4(0, 0.3, 0, 0) + glm::dvec4{random.uniform(-2, 2), 0, random.uniform(-2, 2), 0};
            changed.objects[leaf].transform = place;
            loaded.world.move(loaded.ids[leaf], place);
            EXPECT_TRUE(loaded.world.setPortal({door + 1}, shut ? 0 : 1));
        }
        const Snapshot now = loaded.world.commit();
        const Witness witness(changed);
        for (int frame = 0; frame < frames; ++frame) {
            CameraFrame camera;
            camera.eye = eyeAtPortal(space.graph, random);
            camera.target =
                camera.eye + glm::dvec3{random.uniform(-1, 1), random.uniform(-0.4, 0.4), random.uniform(-1, 1)};
            constexpr double kNear[] = {0.001, 0.05, 0.3, 2.0};
            camera.z_near = kNear[random.below(4)];
            View view = makeView(camera, 320, 180);
            QuerySettings settings{.windows = static_cast<PortalWindows>(frame % 3)};
            settings.stages = frame % 2 ? kDefaultStages : kCellStages;
            settings.bins = frame % 4 == 1 ? 3 : 1;
            const VisibleSet set = query.visible(now, view, settings);
            totals.by_cells += set.stats.stages[static_cast<int>(Stage::kPvs)].culled;
            totals.by_portals += set.stats.stages[static_cast<int>(Stage::kPortals)].culled;
            totals.kept += set.objects.size();
            totals.known += set.stats.stages[static_cast<int>(Stage::kPvs)].culled > 0;
            ++totals.frames;
            expectNoFalseCulls(witness, view, reasonsOf(query, now),
                               {.rays = 20000, .aimed_rays = 10000, .supersampling = 2, .prove = true},
                               scene.name + ", round " + std::to_string(round) + ", frame " + std::to_string(frame));
        }
    }
    return totals;
}

TEST(IndoorScenes, ABuildingHidesNothingThatIsSeen) {
    const Scene scene = makeBuilding(1, 2);
    const BakedScene baked = bakeScene(scene, true);
    // Among these: the near rectangle reaches 0.3 mm into a lintel, less than the cells' tolerance, and a ray from there
    // passes the backs of the wall's faces.
    const Totals open = expectNothingSeenIsCulled(scene, baked, false, 1, 24);
    EXPECT_GT(open.known, open.frames / 4);
    EXPECT_GT(open.by_cells, 0u);
    EXPECT_GT(open.by_portals, 0u);
    const Totals doors = expectNothingSeenIsCulled(scene, baked, true, 3, 12);
    EXPECT_GT(doors.by_portals, 0u);
}

TEST(IndoorScenes, ShutDoorsHideMore) {
    const Scene scene = makeBuilding(3, 1);
    const BakedScene baked = bakeScene(scene, true);
    LoadedWorld loaded = loadWorld(scene, {}, loadSettings(false, 0));
    ASSERT_TRUE(loaded.world.attach(*baked.file));
    Query query;
    uint64_t kept[2] = {};
    for (const int open : {0, 1}) {
        for (uint32_t door = 0; door < baked.cells.space.doors.size(); ++door) loaded.world.setPortal({door + 1}, open);
        const Snapshot now = loaded.world.commit();
        Random random(7);
        for (int frame = 0; frame < 64; ++frame) {
            CameraFrame camera;
            camera.eye = eyeAtPortal(baked.cells.space.graph, random);
            camera.target = camera.eye + glm::dvec3(random.uniform(-1, 1), 0, random.uniform(-1, 1));
            camera.z_near = 0.01;
            View view = makeView(camera, 320, 180);
            kept[open] += query.visible(now, view, {.stages = kCellStages}).objects.size();
        }
    }
    EXPECT_LT(kept[0], kept[1]);
}

/// What a mirror on a wall shows, by its view: rays that begin on the glass see nothing that was culled.
TEST(IndoorScenes, MirrorsHideNothingThatIsSeen) {
    const Scene scene = makeBuilding(2, 1);
    const BakedScene baked = bakeScene(scene, true);
    const CellSpace& space = baked.cells.space;
    LoadedWorld loaded = loadWorld(scene, {}, loadSettings(false, 0));
    ASSERT_TRUE(loaded.world.attach(*baked.file));
    const Snapshot now = loaded.world.commit();
    const Witness witness(scene);
    Query query;
    Random random(5);
    uint64_t by_cells = 0, mirrors = 0;
    for (int i = 0; i < 400 && mirrors < 24; ++i) {
        // Upright, in the midst of a cell, seen from in front of it.
        const CellRegion& room = space.regions[random.below(space.regions.size())];
        const glm::dvec3 center = room.bounds.center(), size = room.bounds.size();
        if (std::min({size.x, size.y, size.z}) < 1.5) continue;
        const double angle = random.uniform(0, 6.283185307179586);
        const glm::dvec3 normal(std::cos(angle), 0, std::sin(angle)), along(normal.z, 0, -normal.x), up(0, 1, 0);
        const std::vector<glm::dvec3> glass{center - 0.4 * along - 0.5 * up, center + 0.4 * along - 0.5 * up,
                                            center + 0.4 * along + 0.5 * up, center - 0.4 * along + 0.5 * up};
        CameraFrame camera;
        camera.eye = center + random.uniform(0.2, 6.0) * normal + random.uniform(-1, 1) * along;
        camera.target = center;
        camera.z_near = 0.01;
        const auto mirrored = mirroredView(makeView(camera, 320, 180), glass);
        ASSERT_TRUE(mirrored);
        View view = *mirrored;
        QuerySettings settings{.windows = static_cast<PortalWindows>(i % 3)};
        settings.stages = i % 2 ? kDefaultStages : kCellStages;
        const VisibleSet set = query.visible(now, view, settings);
        by_cells += set.stats.stages[static_cast<int>(Stage::kPvs)].culled +
                    set.stats.stages[static_cast<int>(Stage::kPortals)].culled;
        ++mirrors;
        // Without the id-buffer, which looks at one point of each object: that may lie beside the glass.
        expectNoFalseCulls(witness, view, reasonsOf(query, now),
                           {.rays = 20000, .aimed_rays = 10000, .supersampling = 0, .prove = true},
                           "mirror " + std::to_string(i));
    }
    EXPECT_EQ(mirrors, 24u);
    EXPECT_GT(by_cells, 0u);
}

/// The house with cells that were marked by hand: walls are held to them, and holes that nobody marked are open.
TEST(IndoorScenes, AHouseMarkedByHandHidesNothingThatIsSeen) {
    const std::string house = std::string(SIGHTLINE_SHARED_DIR) + "/scenes/aws-small-house.glb";
    if (!std::filesystem::exists(house)) GTEST_SKIP() << house << " is not here";
    std::vector<Scene> scenes;
    for (const std::string& file : {house, std::string(SIGHTLINE_EXAMPLES_DIR) + "/small-house-cells.gltf"}) {
        Result<Scene> scene = loadSceneFile(file);
        ASSERT_TRUE(scene.ok()) << scene.error().message;
        scenes.push_back(std::move(*scene));
    }
    const Scene scene = joinScenes(std::move(scenes));
    const BakedScene baked = bakeScene(scene, false);
    const Totals totals = expectNothingSeenIsCulled(scene, baked, false, 1, 24);
    EXPECT_GT(totals.by_cells + totals.by_portals, 0u);
}

}  // namespace
}  // namespace sightline
