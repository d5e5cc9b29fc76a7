// Buildings and maps as cells, baked on the spot.
// SPDX-License-Identifier: MIT
#include "bench/eye_worlds.h"

#include <cmath>
#include <map>

#include "sightline/bake/flow/cell_visibility.h"
#include "sightline/bake/marked/scene_cells.h"
#include "sightline/base/random.h"
#include "sightline/bsp/merge_cells.h"
#include "sightline/bsp/tree_portals.h"
#include "sightline/studies/cells/eye_cells.h"
#include "sightline/tools/import/quake/map_source.h"
#include "sightline/tools/scene/building/building.h"

namespace sightline::bench {
using namespace bake;
using namespace studies;
using namespace tools;
namespace {

/// In seconds: what is not settled by then is seen.
BitMatrix bakedRows(const CellGraph& graph) {
    CellVisibilitySettings settings;
    settings.budget = 1u << 14;
    return bakeCellVisibility(graph, settings).visible;
}

}  // namespace

std::vector<uint64_t> EyeWorld::rowsOf(const View& view) const {
    EyeCells start;
    const std::vector<uint64_t> none(rows.wordsPerRow(), 0);
    if (!start.run(*graph, view, {.level = EyeLevel::kRow}, none)) return {};
    std::vector<uint64_t> seen = none;
    for (const uint32_t cell : start.cells())
        for (size_t word = 0; word < seen.size(); ++word) {
            const uint32_t row = graph->rowOf(cell);
            seen[word] |= row == PortalGraph::kNoCell ? ~uint64_t{0} : rows.row(row)[word];
        }
    return seen;
}

EyeWorld buildingWorld(uint64_t seed, uint32_t floors) {
    EyeWorld world;
    world.name = "building:" + std::to_string(seed) + ":" + std::to_string(floors);
    world.scene = std::make_shared<Scene>(makeBuilding(seed, floors));
    SceneCellSettings trusted;
    trusted.trusted = true;
    world.space = cellsOfScene(*world.scene, trusted).space;
    world.space.row_of_cell.resize(world.space.graph.cells);
    for (uint32_t cell = 0; cell < world.space.graph.cells; ++cell) world.space.row_of_cell[cell] = cell;
    world.rows = bakedRows(world.space.graph);
    world.graph = std::make_unique<PortalGraph>(world.space);
    return world;
}

EyeWorld mapWorld(const std::string& name) {
    EyeWorld world;
    world.name = name;
    const std::string file = "../shared/maps/" + name + ".vis.bsp";
    Result<QuakeMapFile> map = readQuakeMap(file);
    if (!map) return world;
    TreePortalCounts counts;
    world.space.graph = cellsOfTree(map->tree, {}, &counts);
    world.space.tree = std::move(map->tree);
    world.space.tolerance = counts.tolerance;
    // Leaves that share a row of the file are a row.
    std::map<int32_t, uint32_t> row_at;
    std::vector<uint32_t> row_of_leaf;
    for (const uint32_t cluster : map->cluster_of_leaf) {
        row_of_leaf.push_back(CellGraph::kNoCell);
        if (cluster == QuakeMapFile::kNoCluster || map->row_offsets[cluster] < 0) continue;
        row_of_leaf.back() =
            row_at.emplace(map->row_offsets[cluster], static_cast<uint32_t>(row_at.size())).first->second;
    }
    world.space.row_of_cell = cellsFromLeaves(world.space.graph, row_of_leaf);
    world.rows = bakedRows(
        joinPortals(mergeCells(world.space.graph, world.space.row_of_cell, static_cast<uint32_t>(row_at.size()))));
    world.graph = std::make_unique<PortalGraph>(world.space);
    world.size = 40;
    return world;
}

std::vector<View> eyesIn(const EyeWorld& world, uint64_t seed, size_t count, const std::vector<uint32_t>& among) {
    std::vector<View> views;
    Random random(seed);
    Box3d bounds = world.space.tree.bounds;
    for (const CellRegion& region : world.space.regions) bounds.grow(region.bounds);
    EyeCells start;
    const std::vector<uint64_t> none(world.rows.wordsPerRow(), 0);
    for (size_t tries = 0; views.size() < count && tries < 1000 * count; ++tries) {
        const Box3d& box = among.empty() ? bounds : world.space.regions[among[random.below(among.size())]].bounds;
        glm::dvec3 eye;
        for (int axis = 0; axis < 3; ++axis) eye[axis] = random.uniform(box.min[axis], box.max[axis]);
        const double turn = random.uniform(0, 6.283185307179586);
        View view;
        view.width = 1280;
        view.height = 720;
        view.view = lookAt(eye, eye + glm::dvec3(std::cos(turn), 0, std::sin(turn)), {0, 1, 0});
        view.projection = perspective(glm::radians(58.7), 16.0 / 9.0, 0.05 * world.size);  // 90 degrees across
        if (start.run(*world.graph, view, {.level = EyeLevel::kRow}, none)) views.push_back(view);
    }
    return views;
}

}  // namespace sightline::bench
