// SPDX-License-Identifier: MIT
#include "apps/cli/bake_source.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "apps/cli/session.h"
#include "sightline/bake/scene_hash.h"
#include "sightline/import/map_source.h"
#include "sightline/import/quake_scene.h"
#include "sightline/scene/procedural.h"

namespace sightline::cli {
namespace {

/// Faces of compiled maps are drawn so far from the planes of their leaves at most: compilers round and weld corners.
constexpr double kFaceMargin = 0.25;  // [world units]

bool isMap(const std::string& name) {
    const std::string kind = mapKind(name);
    return kind == ".bsp" || kind == ".map" || kind == ".prt" || kind == ".pak" || kind == ".pk3";
}

/// The rows of leaves, as the file's own graph of them has cells.
void numberRows(const VisMap& map, BakeSource& out) {
    out.space.row_of_cell.assign(out.space.graph.cells, CellGraph::kNoCell);
    for (size_t leaf = 0; leaf < out.space.graph.cell_of_leaf.size(); ++leaf)
        if (const uint32_t cell = out.space.graph.cell_of_leaf[leaf]; cell != CellGraph::kNoCell)
            out.space.row_of_cell[cell] = map.graph.cell_of_leaf[leaf];
}

Result<BakeSource> loadMap(const std::string& name, VisCells cells, bool cells_given) {
    const auto usage = [&](const char* what) { return Error{Error::Kind::kUsage, name + ": " + what}; };
    const std::string kind = mapKind(name);
    if (kind == ".prt") return usage("a portal file has no tree to find an eye in: bake its .bsp or .map");
    if (kind == ".map" && cells_given) return usage("a .map has the cells of its brushes: --cells goes with a .bsp");
    VisMapChoice choice;
    choice.name = name;
    choice.cells = cells;
    choice.keep_leaves = true;
    Result<VisMap> map = loadVisMap(choice);
    if (!map) return map.error();
    BakeSource out;
    out.name = std::filesystem::path(splitMapName(name).file).filename().string();
    out.cells_are = kind == ".map" ? "of the brushes" : "leaves of the map";
    out.rows_are = map->cells_are;
    out.hash = map->content_hash;
    out.leaks = !map->leaks.empty();
    out.space.graph = std::move(*map->leaf_graph);
    out.space.tree = std::move(*map->tree);
    out.space.tolerance = map->tolerance;
    numberRows(*map, out);
    out.row_of_leaf = map->graph.cell_of_leaf;
    out.rows = std::move(map->graph);
    if (!map->map) return out;
    Result<Scene> scene = quakeScene(*map->map, map->map_name);
    if (!scene) {
        note(scene.error().message + ": the file holds no objects");
        return out;
    }
    out.scene = std::move(*scene);
    out.placing.margin = kFaceMargin;
    for (const SceneObject& object : out.scene.objects)
        out.placing.moves.push_back(map->map->faces[object.key].model != 0);
    return out;
}

Result<BakeSource> loadMarkedScene(const SceneChoice& choice) {
    Result<Scene> scene = loadScene(choice);
    if (!scene) return scene.error();
    if (scene->cells.empty())
        return Error{Error::Kind::kInput, choice.title() +
                                              ": has no cells: they are marked by hand, or the scene is a "
                                              "map or a building"};
    BakeSource out;
    SceneCellSettings settings;
    settings.trusted = !choice.procedural().empty();
    for (const ScenePortal& portal : scene->portals)
        if (portal.door < scene->objects.size()) settings.movable.push_back(portal.door);
    std::sort(settings.movable.begin(), settings.movable.end());
    settings.movable.erase(std::unique(settings.movable.begin(), settings.movable.end()), settings.movable.end());
    SceneCells cells = cellsOfScene(*scene, settings);
    out.name = std::filesystem::path(choice.title()).filename().string();
    out.cells_are = "marked";
    out.rows_are = "cells";
    out.hash = hashOf(*scene);
    out.space = std::move(cells.space);
    out.placing.walls = cells.report.walls;
    out.report = std::move(cells.report);
    for (uint32_t cell = 0; cell < out.space.graph.cells; ++cell) out.space.row_of_cell.push_back(cell);
    out.rows = out.space.graph;
    out.scene = std::move(*scene);
    return out;
}

}  // namespace

Result<BakeSource> loadBakeSource(const SceneChoice& scene, VisCells cells, bool cells_given) {
    const auto map = std::find_if(scene.names.begin(), scene.names.end(),
                                  [](const std::string& name) { return !isProcedural(name) && isMap(name); });
    if (map == scene.names.end()) {
        if (cells_given)
            return Error{Error::Kind::kUsage, "--cells goes with a .bsp: scenes have the cells of their makers"};
        return loadMarkedScene(scene);
    }
    if (scene.names.size() > 1) return Error{Error::Kind::kUsage, *map + ": a map is baked alone"};
    if (!scene.up.empty() || !scene.unit.empty() || !scene.sides.empty())
        return Error{Error::Kind::kUsage, *map + ": --up, --unit and --sides do not go with a map"};
    return loadMap(*map, cells, cells_given);
}

}  // namespace sightline::cli
