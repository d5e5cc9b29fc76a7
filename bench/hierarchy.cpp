// What is asked of a world's hierarchy and of grids, beside the flat list.
// SPDX-License-Identifier: MIT
#include <bit>
#include <cmath>

#include "bench/cases.h"
#include "bench/flat_boxes.h"
#include "bench/stopwatch.h"
#include "bench/swarm.h"
#include "sightline/base/random.h"
#include "sightline/cull/box_query.h"
#include "sightline/cull/hierarchy.h"
#include "sightline/studies/frustum/grid.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/city/city.h"

namespace sightline::bench {
using namespace studies;
using namespace tools;
namespace {

constexpr int kFramesOfMoves = 10;

Frustum frustumFrom(double z_far) { return makeFrustum(viewFrom(z_far)); }

Frustum frustumOfAll() { return makeFrustum(viewOfAll()); }

/// A world's tree after every tenth box has moved for some frames, one that is built anew, and the flat list.
void measureFrusta(Table& table, int repeat) {
    Swarm swarm(1000000, 1);
    const std::string where = "1,000,000 boxes, every tenth has moved";
    WorldBvh tree = treeOver(swarm.boxes);
    for (int frame = 0; frame < kFramesOfMoves; ++frame) {
        swarm.step();
        for (uint32_t i = 0; i < swarm.movers(); ++i) {
            const uint32_t item = swarm.mover(i);
            const Box3d& box = swarm.boxes[item];
            if (tree.move(item, box)) continue;
            tree.remove(item);
            if (tree.insert(item, box) == WorldBvh::kNone) tree.append({&box, 1}, {&item, 1});
        }
        tree.mend(2 * swarm.movers());
    }
    const WorldBvh fresh = treeOver(swarm.boxes);
    FlatBoxes flat(swarm.boxes);
    HierarchyScratch scratch;
    std::vector<uint32_t> kept(swarm.boxes.size() + 8);
    const auto queries = [&](const Frustum& frustum, const std::string& view) {
        size_t by_tree = 0, by_flat = 0;
        const std::vector<double> times =
            threadTimes({[&] { by_tree = cullHierarchy(frustum, tree.now(), scratch, kept); },
                         [&] { cullHierarchy(frustum, fresh.now(), scratch, kept); },
                         [&] { by_flat = cullFrustum(frustum, flat.arrays, flat.kept); }},
                        repeat ? repeat : 15);
        const double per_box = 1e3 / static_cast<double>(swarm.boxes.size());
        const Rows row{table, view};
        row("query after the frames", times[0] * per_box, "ns/box", "query of a fresh tree", times[1] * per_box);
        row("query of a fresh tree", times[1] * per_box, "ns/box", "flat, SIMD", times[2] * per_box);
        row("kept by the tree", by_tree, "boxes", "kept by the flat list", by_flat);
    };
    queries(frustumFrom(std::numeric_limits<double>::infinity()), where + "; far view");
    queries(frustumFrom(0.2 * kWorld), where + "; short view");
    queries(frustumOfAll(), where + "; all in view");
    measureManyFrusta(table, tree.now(), "1,000,000 boxes", kWorld, repeat);
}

/// A swarm all of which moves, in a grid.
void measureGrid(Table& table, uint32_t count, int repeat) {
    Swarm swarm(count, 4);
    const std::string where = "swarm of " + std::to_string(count);
    // About eight to a cell, but no cell smaller than the largest box.
    const double cell = std::max(4.0, std::cbrt(8.0 * 8.0 * kWorld * kWorld * kWorld / count));
    std::vector<double> inserts, moves, steps;
    std::vector<glm::dvec3> velocity(count);
    Random random(5);
    for (glm::dvec3& v : velocity)
        for (int axis = 0; axis < 3; ++axis) v[axis] = random.uniform(-2.0, 2.0);
    const auto step = [&] {
        for (uint32_t i = 0; i < count; ++i) {
            swarm.boxes[i].min += velocity[i];
            swarm.boxes[i].max += velocity[i];
        }
    };
    Grid grid(cell);
    for (int round = 0; round < 5; ++round) {
        // Into memory that has been used before: a swarm that comes and goes.
        for (uint32_t i = count; i-- > 0;) grid.remove(i);
        const double took = millisecondsOf([&] {
            for (const Box3d& box : swarm.boxes) grid.insert(box);
        });
        if (round > 0) inserts.push_back(took);
        for (int frame = 0; frame < 4; ++frame) {
            step();
            moves.push_back(millisecondsOf([&] {
                for (uint32_t i = 0; i < count; ++i) grid.move(i, swarm.boxes[i]);
            }));
        }
    }
    std::vector<double> small_moves;
    for (int frame = 0; frame < 8; ++frame) {
        const double by = frame % 2 ? 0.01 : -0.01;
        for (Box3d& box : swarm.boxes) box = {box.min + by, box.max + by};
        small_moves.push_back(millisecondsOf([&] {
            for (uint32_t i = 0; i < count; ++i) grid.move(i, swarm.boxes[i]);
        }));
    }
    const double each = 1e6 / count;
    const Rows row{table, where};
    row("insert, at random", medianOf(inserts) * each, "ns", "", 0);
    row("move, next to none to another cell", medianOf(small_moves) * each, "ns", "", 0);
    row("move, some to another cell", medianOf(moves) * each, "ns", "", 0);
    const WorldBvh tree = treeOver(swarm.boxes);
    FlatBoxes flat(swarm.boxes);
    HierarchyScratch scratch;
    std::vector<uint32_t> kept(count + 8);
    for (const double z_far : {std::numeric_limits<double>::infinity(), 0.1 * kWorld}) {
        const Frustum frustum = frustumFrom(z_far);
        GridStats stats;
        const std::vector<double> times = threadTimes(
            {[&] { cullGrid(frustum, grid, kept, &stats); }, [&] { cullHierarchy(frustum, tree.now(), scratch, kept); },
             [&] { cullFrustum(frustum, flat.arrays, flat.kept); }},
            repeat ? repeat : 15);
        const std::string view = where + (z_far < kWorld ? "; short view" : "; far view");
        table.rows.push_back({view, "query of the grid", times[0], "us", "query of a fresh tree", times[1]});
        table.rows.push_back({view, "query of the grid", times[0], "us", "flat, SIMD", times[2]});
        uint64_t used = 0;
        for (uint32_t level = 0; level < Grid::kLevels; ++level)
            for (const Grid::Level::Listed& listed : grid.level(level).blocks)
                used += static_cast<uint64_t>(std::popcount(grid.block(listed.block).used));
        table.rows.push_back(
            {view, "cells looked at", static_cast<double>(stats.cells), "cells", "in use", static_cast<double>(used)});
    }
}

/// The same view of a world that grows far beyond it.
void measureReach(Table& table, int repeat) {
    double first_cells = 0;
    for (const double side : {1000.0, 4000.0, 16000.0}) {
        const uint32_t count = static_cast<uint32_t>(side * side / 256.0);
        Random random(6);
        Grid grid(16.0);
        grid.reserve(count);
        for (uint32_t i = 0; i < count; ++i) {
            const double x = random.uniform(-0.5, 0.5) * side, z = random.uniform(-0.5, 0.5) * side;
            const glm::dvec3 at(x, random.uniform(-8, 8), z);
            grid.insert({at, at + random.uniform(0.5, 4)});
        }
        const Frustum frustum = frustumFrom(300.0);
        std::vector<uint32_t> kept(count + 8);
        GridStats stats;
        const double time = threadTimes({[&] { cullGrid(frustum, grid, kept, &stats); }}, repeat ? repeat : 15)[0];
        if (first_cells == 0) first_cells = static_cast<double>(stats.cells);
        const std::string where = "outdoors, " + std::to_string(count) + " boxes, view of 300";
        table.rows.push_back({where, "query of the grid", time, "us", "", 0});
        table.rows.push_back(
            {where, "cells looked at", static_cast<double>(stats.cells), "cells", "in the first world", first_cells});
    }
}

/// Boxes that hold a share of the world.
void measureBoxQueries(Table& table, int repeat) {
    const Swarm swarm(1000000, 7);
    const WorldBvh tree = treeOver(swarm.boxes);
    FlatBoxes flat(swarm.boxes);
    HierarchyScratch scratch;
    std::vector<uint32_t> kept(swarm.boxes.size() + 16);
    Random random(8);
    for (const double share : {0.00001, 0.001, 0.07, 0.5}) {
        const double half = kWorld * std::cbrt(share), room = kWorld - half;
        std::vector<Box3d> asked;
        for (int i = 0; i < (share < 0.01 ? 200 : 8); ++i) {
            const double x = random.uniform(-room, room), y = random.uniform(-room, room);
            const glm::dvec3 at(x, y, random.uniform(-room, room));
            asked.push_back({at - half, at + half});
        }
        size_t found = 0;
        const auto each = [&](const auto& query) {
            return [&asked, &found, query] {
                found = 0;
                for (const Box3d& box : asked) found += query(box);
            };
        };
        const std::vector<double> times =
            threadTimes({each([&](const Box3d& box) { return queryBox(box, flat.arrays, kept); }),
                         each([&](const Box3d& box) { return queryBox(box, tree.now(), scratch, kept); })},
                        repeat ? repeat : 15);
        const double each_one = 1.0 / static_cast<double>(asked.size());
        const std::string where = "1,000,000 boxes, a box that meets " +
                                  std::to_string(static_cast<long>(each_one * static_cast<double>(found) + 0.5));
        table.rows.push_back(
            {where, "query of the world's tree", times[1] * each_one, "us", "flat, SIMD", times[0] * each_one});
    }
}

}  // namespace

Table benchHierarchy(const Options& options) {
    Table table{"hierarchy", {}};
    if (options.scene) {
        addSceneTree(table, options.scene->name, *options.scene, options.repeat);
        return table;
    }
    measureFrusta(table, options.repeat);
    measureBoxQueries(table, options.repeat);
    for (const uint32_t count : {100000u, 1000000u}) measureGrid(table, count, options.repeat);
    measureReach(table, options.repeat);
    addSceneTree(table, "building of 8 floors", makeBuilding(1, 8), options.repeat);
    addSceneTree(table, "city of 100,000", makeCity(1, 100000), options.repeat);
    addWorld(table, "world of 100,000", 100000, options.repeat);
    addWorld(table, "world of 1,000,000", 1000000, options.repeat);
    return table;
}

}  // namespace sightline::bench
