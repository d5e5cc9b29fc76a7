// Eye-to-cell culling level by level: cells kept and microseconds, beside the windows of portals.
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <fmt/core.h>

#include "bench/cases.h"
#include "bench/eye_worlds.h"
#include "bench/stopwatch.h"
#include "sightline/cells/portals.h"
#include "sightline/studies/cells/eye_cells.h"

namespace sightline::bench {
using namespace studies;
using namespace tools;
namespace {

constexpr size_t kEyesAsked = 256;
constexpr EyeLevel kLevels[] = {EyeLevel::kRow, EyeLevel::kVolume, EyeLevel::kChain, EyeLevel::kSightLine};

struct Asked {
    View view;
    std::vector<uint64_t> rows;
};

size_t cellsOf(const PortalFlood& flood) {
    std::vector<uint32_t> cells;
    for (const SeenCell& seen : flood.cells()) cells.push_back(seen.cell);
    std::sort(cells.begin(), cells.end());
    return static_cast<size_t>(std::unique(cells.begin(), cells.end()) - cells.begin());
}

/// The boxes of a building's objects in the cells that they meet.
struct Placed {
    uint32_t cell;
    Box3d box;
};

std::vector<Placed> placeObjects(const EyeWorld& world) {
    std::vector<Placed> placed;
    Array<uint32_t> cells;
    for (const SceneObject& object : world.scene->objects) {
        const Box3d box = transformBox(world.scene->meshes[object.mesh].bounds, object.transform);
        cells.clear();
        if (world.graph->cellsOf(box, cells))
            for (const uint32_t cell : cells) placed.push_back({cell, box});
    }
    return placed;
}

void measure(const EyeWorld& world, int repeat, Table& table) {
    std::vector<Asked> asked;
    for (const View& view : eyesIn(world, 1, kEyesAsked)) asked.push_back({view, world.rowsOf(view)});
    if (asked.empty()) return;
    const double eyes = static_cast<double>(asked.size());
    EyeCells cells[4];
    PortalFlood floods[3];
    std::vector<std::function<void()>> jobs;
    for (int level = 0; level < 4; ++level)
        jobs.push_back([&, level] {
            for (const Asked& a : asked) cells[level].run(*world.graph, a.view, {.level = kLevels[level]}, a.rows);
        });
    for (int kind = 0; kind < 3; ++kind)
        jobs.push_back([&, kind] {
            for (const Asked& a : asked)
                floods[kind].run(*world.graph, a.view, {.windows = static_cast<PortalWindows>(kind)}, {}, a.rows);
        });
    const std::vector<double> times = threadTimes(jobs, repeat);
    double kept[7] = {}, programs = 0, chains = 0;
    uint64_t spent = 0;
    for (const Asked& a : asked) {
        for (int level = 0; level < 4; ++level) {
            cells[level].run(*world.graph, a.view, {.level = kLevels[level]}, a.rows);
            kept[level] += static_cast<double>(cells[level].cells().size()) / eyes;
        }
        programs += static_cast<double>(cells[3].stats().programs) / eyes;
        chains += static_cast<double>(cells[3].stats().chains) / eyes;
        spent += cells[3].stats().work_spent;
        for (int kind = 0; kind < 3; ++kind) {
            floods[kind].run(*world.graph, a.view, {.windows = static_cast<PortalWindows>(kind)}, {}, a.rows);
            kept[4 + kind] += static_cast<double>(cellsOf(floods[kind])) / eyes;
        }
    }
    const Rows row{table, world.name};
    for (int way = 0; way < 7; ++way) {
        const std::string name = way < 4 ? std::string("eye-to-cell, ") + kEyeLevelNames[way]
                                         : std::string("portals, ") + kWindowNames[way - 4];
        row(name, times[static_cast<size_t>(way)] / eyes, "us an eye", "portals, polygons", times[6] / eyes,
            way == 0 ? fmt::format("{} eyes, {} cells, {} portals", asked.size(), world.space.graph.cells,
                                   world.space.graph.portals.size())
            : way == 3
                ? fmt::format("{:.1f} programs, {:.1f} chains, {} eyes without work left", programs, chains, spent)
                : "");
        row(name, kept[way], "cells", "portals, polygons", kept[6]);
    }
    if (!world.scene) return;
    const std::vector<Placed> objects = placeObjects(world);
    double seen[4] = {};
    std::vector<double> took(4);
    for (int level = 0; level < 4; ++level) {
        double total = 0;
        for (const Asked& a : asked) {
            cells[level].run(*world.graph, a.view, {.level = kLevels[level]}, a.rows);
            size_t some = 0;
            total += millisecondsOf([&] {
                for (const Placed& object : objects) some += cells[level].sees(object.cell, object.box);
            });
            seen[level] += static_cast<double>(some) / eyes;
        }
        took[static_cast<size_t>(level)] = total * 1e3 / eyes;
    }
    for (int level = 0; level < 4; ++level) {
        const std::string name = std::string("eye-to-object, ") + kEyeLevelNames[level];
        row(name, took[static_cast<size_t>(level)], "us an eye", "row", took[0],
            fmt::format("{} objects in cells", objects.size()));
        row(name, seen[level], "objects", "row", seen[0]);
    }
}

}  // namespace

Table benchEye(const Options& options) {
    Table table{"eye", {}};
    const int repeat = options.repeat > 0 ? options.repeat : 5;
    for (const uint32_t floors : {3u, 10u}) measure(buildingWorld(1, floors), repeat, table);
    for (const char* name : {"lq_e2m2", "lqdm3", "lq_e1m5", "lq_e4m1"})
        if (const EyeWorld world = mapWorld(name); world.graph) measure(world, repeat, table);
    return table;
}

}  // namespace sightline::bench
