// View cells: what their rows hold beside what rays see from the same cells.
// SPDX-License-Identifier: MIT
//
// Daniel Cohen-Or, Gadi Fibich, Dan Halperin, Eyal Zadicario. Conservative Visibility and Strong Occlusion for Viewspace
// Partitioning of Densely Occluded Scenes. 1998.
#include <algorithm>

#include <fmt/format.h>

#include "bench/cases.h"
#include "bench/stopwatch.h"
#include "sightline/bake/view_cells/view_cells.h"
#include "sightline/base/random.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/camera_path.h"

namespace sightline::bench {
using namespace bake;
using namespace tools;
namespace {

constexpr size_t kCellsLookedFrom = 64;
constexpr int kRaysAround = 50000, kRaysAtObject = 256;

/// The leaves of a tree as boxes, cut by its planes, which lie across axes.
std::vector<Box3d> boxesOf(const LeafTree& tree) {
    std::vector<Box3d> boxes(tree.contents.size());
    struct Part {
        uint32_t child;
        Box3d box;
    };
    std::vector<Part> parts{{tree.nodes.empty() ? LeafTreeNode::kLeaf : 0, tree.bounds}};
    while (!parts.empty()) {
        const Part part = parts.back();
        parts.pop_back();
        if (part.child & LeafTreeNode::kLeaf) {
            boxes[part.child & ~LeafTreeNode::kLeaf] = part.box;
            continue;
        }
        const LeafTreeNode& node = tree.nodes[part.child];
        for (int axis = 0; axis < 3; ++axis) {
            if (node.plane[axis] == 0) continue;
            const double at = -node.plane.w / node.plane[axis];
            Box3d below = part.box, above = part.box;
            below.max[axis] = std::min(below.max[axis], at);
            above.min[axis] = std::max(above.min[axis], at);
            const bool up = node.plane[axis] > 0;
            parts.push_back({node.child[up ? 0 : 1], below});
            parts.push_back({node.child[up ? 1 : 0], above});
        }
    }
    return boxes;
}

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

/// Objects that rays from a box see first: all around, and at each object of its row.
size_t seenFrom(const RayProbe& probe, const Scene& scene, const Box3d& box, std::span<const uint32_t> row,
                Random& random) {
    std::vector<uint8_t> seen(scene.objects.size(), 0);
    for (int ray = 0; ray < kRaysAround; ++ray) {
        const glm::dvec3 from = pointIn(box, random), towards = pointIn({glm::dvec3(-1), glm::dvec3(1)}, random);
        if (const auto hit = probe.nearest({from, towards})) seen[hit->object] = 1;
    }
    for (const uint32_t object : row) {
        if (scene.meshes[scene.objects[object].mesh].triangles() == 0) continue;
        for (int ray = 0; ray < kRaysAtObject && !seen[object]; ++ray) {
            const glm::dvec3 from = pointIn(box, random);
            if (const auto hit = probe.nearest({from, pointOn(scene, object, random) - from})) seen[hit->object] = 1;
        }
    }
    return static_cast<size_t>(std::count(seen.begin(), seen.end(), 1));
}

void measure(const Scene& scene, uint32_t most_cells, Table& table) {
    ViewCellSettings settings;
    settings.most_cells = most_cells;
    settings.least_hidden = 0;
    ViewCells cells;
    const double baked = millisecondsOf([&] { cells = viewCellsOf(scene, settings); });
    const std::string where = fmt::format("{}, {} view cells", scene.name, cells.tree.contents.size());
    if (cells.tree.contents.empty()) return;
    const RayProbe probe(scene);
    const std::vector<Box3d> boxes = boxesOf(cells.tree);
    Random random(1);
    double held = 0, seen = 0;
    std::vector<double> ratios;
    for (size_t i = 0; i < kCellsLookedFrom; ++i) {
        const size_t cell = random.below(boxes.size());
        if (boxes[cell].empty()) continue;
        std::vector<uint32_t> row;
        for (uint32_t object = 0; object < scene.objects.size(); ++object)
            if (cells.visible.at(cell, object)) row.push_back(object);
        const size_t by_rays = seenFrom(probe, scene, boxes[cell], row, random);
        held += static_cast<double>(row.size());
        seen += static_cast<double>(by_rays);
        if (by_rays > 0) ratios.push_back(static_cast<double>(row.size()) / static_cast<double>(by_rays));
    }
    const double count = static_cast<double>(std::max<size_t>(ratios.size(), 1));
    table.rows.push_back({where, "objects of a row", held / count, "", "seen by rays", seen / count,
                          fmt::format("median ratio {:.2f} of {} cells, of {} objects; baked in {:.1f} s",
                                      medianOf(ratios), ratios.size(), scene.objects.size(), 1e-3 * baked)});
}

}  // namespace

Table benchViewCells(const Options& options) {
    Table table{"view-cells", {}, {}};
    Scene building;
    if (!options.scene) {
        building = makeBuilding(1, 1);
        building.name = "building:1:1 without its marks";
    }
    for (const uint32_t most : {512u, 2048u}) measure(options.scene ? *options.scene : building, most, table);
    return table;
}

}  // namespace sightline::bench
