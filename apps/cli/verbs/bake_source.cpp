// Loads what `bake` bakes, by the kind of its file.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/bake_source.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "apps/cli/shell/session.h"
#include "sightline/tools/import/quake/map_source.h"
#include "sightline/tools/import/quake/quake_scene.h"
#include "sightline/tools/scene/procedural.h"

namespace sightline::cli {
using namespace bake;
using namespace tools;
namespace {

/// Faces of compiled maps are drawn so far from the planes of their leaves at most: compilers round and weld corners.
constexpr double kFaceMargin = 0.25;  // [world units]

bool isMap(const std::string& name) {
    const std::string kind = mapKind(name);
    return kind == ".bsp" || kind == ".map" || kind == ".prt" || kind == ".pak" || kind == ".pk3";
}

Result<BakeSource> loadMapSource(const std::string& name, VisCells cells, bool cells_given) {
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
    CellSpace leaves;
    leaves.graph = std::move(*map->leaf_graph);
    leaves.tree = std::move(*map->tree);
    leaves.tolerance = map->tolerance;
    BakeSource out;
    out.cells = mapToBake(std::move(leaves), std::move(map->graph));
    out.cells.name = std::filesystem::path(splitMapName(name).file).filename().string();
    out.cells.hash = map->content_hash;
    out.cells_are = kind == ".map" ? "of the brushes" : "leaves of the map";
    out.rows_are = map->cells_are;
    out.of_bsp = map->map.has_value();
    out.leaks = !map->leaks.empty();
    if (!map->map) return out;
    Result<Scene> scene = quakeScene(*map->map, map->map_name);
    if (!scene) {
        note(scene.error().message + ": the file holds no objects");
        return out;
    }
    out.scene = std::move(*scene);
    out.cells.placing.margin = kFaceMargin;
    for (const SceneObject& object : out.scene.objects)
        out.cells.placing.moves.push_back(map->map->faces[object.key].model != 0);
    return out;
}

Result<BakeSource> loadMarkedScene(const SceneChoice& choice) {
    Result<Scene> scene = loadScene(choice);
    if (!scene) return scene.error();
    if (scene->cells.empty())
        return Error{Error::Kind::kInput, choice.title() +
                                              ": has no cells: they are marked by hand, or the scene is a "
                                              "map or a building"};
    SceneCellSettings settings;
    settings.trusted = !choice.procedural().empty();
    BakeSource out;
    out.cells = sceneToBake(*scene, std::filesystem::path(choice.title()).filename().string(), settings);
    out.cells_are = "marked";
    out.rows_are = "cells";
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
    return loadMapSource(*map, cells, cells_given);
}

}  // namespace sightline::cli
