// View cells: what their rows hold beside what rays see from the same cells.
// SPDX-License-Identifier: MIT
//
// Daniel Cohen-Or, Gadi Fibich, Dan Halperin, Eyal Zadicario. Conservative Visibility and Strong Occlusion for Viewspace
// Partitioning of Densely Occluded Scenes. 1998.
#include <algorithm>

#include <fmt/format.h>

#include "bench/cases.h"
#include "bench/stopwatch.h"
#include "sightline/bake/bake.h"
#include "sightline/base/random.h"
#include "sightline/geom/leaf_tree.h"
#include "sightline/tools/import/quake/quake_bsp.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/truth/scene_facts.h"

namespace sightline::bench {
using namespace bake;
using namespace tools;
namespace {

constexpr uint32_t kCellsLookedFrom = 64;  // those in which so many seeded cameras stand
constexpr int kRaysAround = 50000, kRaysAtObject = 256;

glm::dvec3 pointIn(const Box3d& box, Random& random) {
    const double x = random.uniform(), y = random.uniform();
    return box.min + glm::dvec3(x, y, random.uniform()) * box.size();
}

glm::dvec3 pointOn(const Scene& scene, uint32_t object, Random& random) {
    const Mesh& mesh = scene.meshes[scene.objects[object].mesh];
    const size_t triangle = random.below(mesh.triangles());
    double a = random.uniform(), b = random.uniform();
    if (a + b > 1) a = 1 - a, b = 1 - b;
    const auto corner = [&](size_t i) { return glm::dvec3(mesh.positions[mesh.indices[3 * triangle + i]]); };
    const glm::dvec3 local = corner(0) + a * (corner(1) - corner(0)) + b * (corner(2) - corner(0));
    return glm::dvec3(scene.objects[object].transform * glm::dvec4(local, 1));
}

/// What rays from a box see.
class Looker {
public:
    explicit Looker(const Scene& scene) : scene_(scene), facts_(scene), probe_(scene), seen_(scene.objects.size()) {}

    /// Looks all around, and at each object of the box's row.
    size_t seenFrom(const Box3d& box, std::span<const uint32_t> row, Random& random) {
        std::fill(seen_.begin(), seen_.end(), uint8_t{0});
        for (int ray = 0; ray < kRaysAround; ++ray) {
            const glm::dvec3 from = pointIn(box, random);
            look({from, pointIn({glm::dvec3(-1), glm::dvec3(1)}, random)});
        }
        for (const uint32_t object : row) {
            if (scene_.meshes[scene_.objects[object].mesh].triangles() == 0) continue;
            for (int ray = 0; ray < kRaysAtObject && !seen_[object]; ++ray) {
                const glm::dvec3 from = pointIn(box, random);
                look({from, pointOn(scene_, object, random) - from});
            }
        }
        return static_cast<size_t>(std::count(seen_.begin(), seen_.end(), 1));
    }

private:
    /// The backs of faces with one side are not there.
    void look(const ProbeRay& ray) {
        const auto isDrawn = [&](const ProbeHit& hit) {
            return hit.front || facts_.facts(hit.object).double_sided[hit.triangle];
        };
        double from = 0;
        for (int met = 0; met < 256; ++met) {
            const auto hit = probe_.nearest(ray, from, isDrawn);
            if (!hit) return;
            seen_[hit->object] = 1;
            if (facts_.facts(hit->object).hides[hit->triangle]) return;
            from = hit->t;
        }
    }

    const Scene& scene_;
    const SceneFacts facts_;
    const RayProbe probe_;
    std::vector<uint8_t> seen_;
};

void measure(const Scene& scene, uint32_t most_cells, Table& table) {
    SoupCellSettings walls;
    for (const CameraFrame& frame : seededCameras(scene, 32, 1).frames) walls.eyes.push_back(frame.eye);
    ViewCellSettings settings;
    settings.most_cells = most_cells;
    settings.least_hidden = 0;
    Result<Baked> baked = Error{Error::Kind::kInput, "not baked"};
    const double milliseconds = millisecondsOf([&] {
        BakeCells cells = soupToBake(scene, scene.name, walls);
        addViewCells(cells, scene, settings);
        baked = bake::bake(std::move(cells), scene, {});
    });
    if (!baked || !baked->cells.views || baked->cells.views->tree.contents.empty()) return;
    const ViewCells& cells = *baked->cells.views;
    const std::string where = fmt::format("{}, {} view cells", scene.name, cells.tree.contents.size());
    Looker looker(scene);
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
        const size_t by_rays = looker.seenFrom(boxes[cell], row, random);
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
