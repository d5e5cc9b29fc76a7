// View cells: what their rows hold beside what rays see from the same cells.
// SPDX-License-Identifier: MIT
//
// Daniel Cohen-Or, Gadi Fibich, Dan Halperin, Eyal Zadicario. Conservative Visibility and Strong Occlusion for Viewspace
// Partitioning of Densely Occluded Scenes. 1998.
#include <algorithm>

#include <fmt/core.h>

#include "bench/cases.h"
#include "bench/stopwatch.h"
#include "sightline/bake/bake.h"
#include "sightline/base/random.h"
#include "sightline/geom/leaf_tree.h"
#include "sightline/tools/import/quake/quake_bsp.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/truth/region_sight.h"

namespace sightline::bench {
using namespace bake;
using namespace tools;
namespace {

constexpr uint32_t kCellsLookedFrom = 64;  // those in which so many seeded cameras stand
constexpr RegionRays kRays{50000, 256};

void measure(const Scene& scene, uint32_t most_cells, Table& table) {
    SoupCellSettings walls;
    for (const CameraFrame& frame : seededCameras(scene, 32, 1).frames) walls.eyes.push_back(frame.eye);
    ViewCellSettings settings;
    settings.most_cells = most_cells;
    settings.least_hidden = 0;
    for (const CameraFrame& frame : seededCameras(scene, 1024, 1).frames) settings.eyes.push_back(frame.eye);
    Result<Baked> baked = Error{Error::Kind::kInput, "not baked"};
    const double milliseconds = millisecondsOf([&] {
        BakeCells cells = soupToBake(scene, scene.name, walls);
        addViewCells(cells, scene, settings);
        baked = bake::bake(std::move(cells), scene, {});
    });
    if (!baked || !baked->cells.views || baked->cells.views->tree.contents.empty()) return;
    const ViewCells& cells = *baked->cells.views;
    const std::string where = fmt::format("{}, {} view cells", scene.name, cells.tree.contents.size());
    const RegionSight sight(scene);
    const std::vector<Box3d> boxes = leafBoxes(cells.tree);
    Random random(1);
    double by_shadows = 0, held = 0, seen = 0;
    std::vector<double> ratios;
    for (const CameraFrame& camera : seededCameras(scene, kCellsLookedFrom, 2).frames) {
        const uint32_t cell = leafAt(cells.tree, camera.eye);
        if (boxes[cell].empty()) continue;
        std::vector<uint32_t> row;
        for (size_t place = 0; place < baked->objects.object_of.size(); ++place) {
            const uint32_t object = baked->objects.object_of[place];
            by_shadows += cells.visible.at(cell, object);
            if (baked->view_rows.at(cell, place)) row.push_back(object);
        }
        std::vector<uint8_t> is_seen(scene.objects.size(), 0);
        sight.look(boxes[cell], row, kRays, random, is_seen);
        const auto by_rays = std::count(is_seen.begin(), is_seen.end(), 1);
        held += static_cast<double>(row.size());
        seen += static_cast<double>(by_rays);
        if (by_rays > 0) ratios.push_back(static_cast<double>(row.size()) / static_cast<double>(by_rays));
    }
    const double count = static_cast<double>(std::max<size_t>(ratios.size(), 1));
    const Rows rows{table, where};
    rows("objects of a row, by shadows alone", by_shadows / count, "", "seen by rays", seen / count);
    rows("by shadows and portals", held / count, "", "seen by rays", seen / count,
         fmt::format("median ratio {:.2f} of {} cells, of {} objects; baked in {:.1f} s", medianOf(ratios),
                     ratios.size(), scene.objects.size(), 1e-3 * milliseconds));
}

}  // namespace

Table benchViewCells(const Options& options) {
    Table table{"view-cells", {}, {}};
    Scene building;
    if (!options.scene) {
        building = makeBuilding(1, 1);
        building.name = "building:1:1 without its marks";
        building.cells.clear();
        building.portals.clear();
    }
    for (const uint32_t most : {512u, 2048u}) measure(options.scene ? *options.scene : building, most, table);
    return table;
}

}  // namespace sightline::bench
