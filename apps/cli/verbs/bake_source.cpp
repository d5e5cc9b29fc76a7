// Loads what `bake` bakes, by the kind of its file.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/bake_source.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/core.h>

#include "apps/cli/shell/progress.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/bake_run.h"
#include "apps/cli/verbs/common.h"
#include "sightline/tools/import/quake/map_source.h"
#include "sightline/tools/import/quake/quake_scene.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/report/readable.h"
#include "sightline/tools/scene/one_line.h"
#include "sightline/tools/scene/procedural.h"
#include "sightline/tools/scene/scene_core.h"

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

Result<BakeSource> loadMapSource(const std::string& name, const BakeSourceChoice& asked) {
    const auto usage = [&](const char* what) { return Error{Error::Kind::kUsage, name + ": " + what}; };
    const std::string kind = mapKind(name);
    if (!asked.moves.empty()) return usage("the map says by itself what moves: --moves is for scenes");
    if (asked.of_walls || asked.view_cells > 0 || asked.cells == "walls" || asked.cells == "none")
        return usage(
            "a map has cells of its own: --cells walls, --cells none, --smallest-occluder, --smallest-hole, "
            "--widest-gap and --view-cells are for scenes");
    if (kind == ".prt") return usage("a portal file has no tree to find an eye in: bake its .bsp or .map");
    if (kind == ".map" && !asked.cells.empty())
        return usage("a .map has the cells of its brushes: --cells goes with a .bsp");
    VisMapChoice choice;
    choice.name = name;
    choice.cells = visCellsOf(asked.cells);
    choice.keep_leaves = true;
    choice.rules = asked.rules;
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
    out.roles = std::move(map->roles);
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

/// The leaves of doors, and what each of the words names: the objects with that key; else those whose paths have the word
/// in them. Errors (kUsage): one names nothing.
Result<std::vector<uint32_t>> movableOf(const Scene& scene, const std::vector<std::string>& words) {
    std::vector<bool> moves(scene.objects.size());
    for (const ScenePortal& portal : scene.portals)
        if (portal.door < scene.objects.size()) moves[portal.door] = true;
    const auto mark = [&](const auto& isMeant) {
        bool any = false;
        for (uint32_t i = 0; i < scene.objects.size(); ++i)
            if (isMeant(scene.objects[i])) any = moves[i] = true;
        return any;
    };
    for (const std::string& word : words) {
        const std::string part = lower(word);
        if (!mark([&](const SceneObject& object) { return word == std::to_string(object.key); }) &&
            !mark([&](const SceneObject& object) {
                return lower(objectPath(scene, object)).find(part) != std::string::npos;
            }))
            return Error{Error::Kind::kUsage,
                         fmt::format("--moves {}: {} has no object of that key, and none whose path has that in it; "
                                     "info --objects lists them",
                                     oneLine(word), scene.name)};
    }
    std::vector<uint32_t> out;
    for (uint32_t i = 0; i < moves.size(); ++i)
        if (moves[i] || scene.objects[i].changes != 0) out.push_back(i);
    return out;
}

/// Adds view cells, if they are wanted.
Status addViews(const BakeSourceChoice& choice, const Scene& scene, const std::vector<uint32_t>& movable,
                BakeCells& cells) {
    if (choice.view_cells < 2) return success();
    const Result<RowJournal*> journal = choice.begin_view_cells();
    if (!journal) return journal.error();
    ViewCellSettings settings;
    settings.most_cells = choice.view_cells;
    settings.smallest_hole = choice.smallest_hole;
    settings.movable = movable;
    constexpr uint32_t kViewers = 1024;
    for (const CameraFrame& frame : seededCameras(scene, kViewers, 1).frames) settings.eyes.push_back(frame.eye);
    settings.jobs = choice.jobs;
    settings.journal = *journal;
    settings.stop = [&] { return interrupted() || !(*journal)->written(); };
    Progress progress("dividing space", "view cells", 0);
    settings.progress = [&](size_t done, size_t total) { progress.set(done, total); };
    addViewCells(cells, scene, settings);
    return (*journal)->written();
}

/// Cells of a scene's own walls. Where they leave most of it in sight, they are not worth their portals: then space is
/// one cell.
Result<BakeSource> wallsOf(const Scene& scene, const SceneChoice& names, const std::string& name,
                           const BakeSourceChoice& choice, const std::vector<uint32_t>& movable) {
    BakeSource out;
    out.rows_are = "none";
    const auto takeAllOfSpace = [&] {
        out.cells = openToBake(scene, name);
        out.cells_are = "all of space";
        return out;
    };
    if (choice.cells == "none") return takeAllOfSpace();
    SoupCellSettings settings;
    settings.smallest_occluder = choice.smallest_occluder;
    settings.smallest_hole = choice.smallest_hole;
    settings.widest_gap = choice.widest_gap;
    settings.jobs = choice.jobs;
    constexpr uint32_t kPlaces = 32;
    if (choice.smallest_occluder < 0)
        for (const CameraFrame& frame : seededCameras(scene, kPlaces, 1).frames) settings.eyes.push_back(frame.eye);
    settings.movable = movable;
    Progress progress("finding portals", "faces", 0);
    settings.progress = [&](size_t done, size_t total) { progress.set(done, total); };
    out.cells = soupToBake(scene, name, settings, &out.walls.emplace());
    if (const std::string text = asideText(scene, out.walls->aside); !text.empty())
        note(text + ": what is beyond does not divide space");
    if (choice.cells.empty() && out.walls->hardlyAnInside()) return takeAllOfSpace();
    if (out.cells.space.graph.cells == 0)
        return Error{Error::Kind::kInput,
                     names.title() +
                         ": has no cells, and no opaque surface that is large enough to divide it (see "
                         "--smallest-occluder)"};
    out.cells_are = "of its own walls";
    return out;
}

Result<BakeSource> loadScene(const SceneChoice& names, const BakeSourceChoice& choice) {
    Result<Scene> scene = loadScene(names);
    if (!scene) return scene.error();
    const Result<std::vector<uint32_t>> movable = movableOf(*scene, choice.moves);
    if (!movable) return movable.error();
    const std::string name = std::filesystem::path(names.title()).filename().string();
    if (scene->cells.empty() || choice.cells == "walls" || choice.cells == "none") {
        Result<BakeSource> out = wallsOf(*scene, names, name, choice, *movable);
        if (!out) return out.error();
        if (Status added = addViews(choice, *scene, *movable, out->cells); !added) return added.error();
        out->movable = movable->size();
        out->scene = std::move(*scene);
        return out;
    }
    if (choice.of_walls)
        return Error{Error::Kind::kUsage,
                     "--smallest-occluder, --smallest-hole, --widest-gap: the scene has marked cells, which they "
                     "say nothing of; --cells walls takes its walls instead"};
    BakeSource out;
    SceneCellSettings settings;
    settings.trusted = !names.procedural().empty();
    settings.movable = *movable;
    out.cells = sceneToBake(*scene, name, settings);
    if (Status added = addViews(choice, *scene, *movable, out.cells); !added) return added.error();
    out.movable = movable->size();
    out.cells_are = "marked";
    out.rows_are = "cells";
    out.scene = std::move(*scene);
    return out;
}

}  // namespace

Result<BakeSource> loadBakeSource(const SceneChoice& scene, const BakeSourceChoice& choice) {
    const auto map = std::find_if(scene.names.begin(), scene.names.end(),
                                  [](const std::string& name) { return !isProcedural(name) && isMap(name); });
    if (map == scene.names.end()) {
        if (!choice.cells.empty() && choice.cells != "walls" && choice.cells != "none")
            return Error{Error::Kind::kUsage, "--cells " + choice.cells + " goes with a .bsp"};
        if (choice.rules.given()) return Error{Error::Kind::kUsage, "--game, --shaders and --solid go with a .map"};
        return loadScene(scene, choice);
    }
    if (scene.names.size() > 1) return Error{Error::Kind::kUsage, *map + ": a map is baked alone"};
    if (!scene.up.empty() || !scene.unit.empty() || !scene.sides.empty())
        return Error{Error::Kind::kUsage, *map + ": --up, --unit and --sides do not go with a map"};
    return loadMapSource(*map, choice);
}

}  // namespace sightline::cli
