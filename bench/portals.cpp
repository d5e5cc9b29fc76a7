// Portals as windows in real maps: microseconds, and leaves beside those that are truly seen and those of the maps' own rows.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/core.h>

#include "bench/cases.h"
#include "bench/map_eyes.h"
#include "bench/stopwatch.h"
#include "sightline/bake/flow/cell_visibility.h"
#include "sightline/cells/portals.h"
#include "sightline/geom/frustum.h"
#include "sightline/tools/import/quake/prt.h"
#include "sightline/tools/import/quake/quake_visibility.h"

namespace sightline::bench {
using namespace bake;
using namespace tools;
namespace {

constexpr uint32_t kViews = 200, kSegments = 10000;

/// What one way of asking gave for all views.
struct Ways {
    std::vector<double> microseconds;
    double leaves = 0, entered = 0;
};

bool touches(const Frustum& frustum, const Box3d& box) {
    for (uint32_t i = 0; i < frustum.count; ++i) {
        const glm::dvec4& plane = frustum.planes[i];
        double most = plane.w - glm::dot(glm::dvec3(plane), frustum.eye);
        for (int axis = 0; axis < 3; ++axis) most += std::max(plane[axis] * box.min[axis], plane[axis] * box.max[axis]);
        if (most < 0) return false;
    }
    return true;
}

uint64_t distinctCells(const PortalFlood& flood, std::vector<bool>& marked) {
    std::fill(marked.begin(), marked.end(), false);
    uint64_t count = 0;
    for (const SeenCell& cell : flood.cells()) {
        count += !marked[cell.cell];
        marked[cell.cell] = true;
    }
    return count;
}

double meanOf(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double shareOf(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values[std::min(values.size() - 1, static_cast<size_t>(share * static_cast<double>(values.size())))];
}

/// The time of the fastest of some runs for each view: other programs' turns do not count.
template <class Run>
Ways timeViews(const std::vector<View>& views, int repeat, Run run) {
    Ways ways;
    for (size_t i = 0; i < views.size(); ++i) {
        constexpr int kTogether = 8;
        double best = INFINITY;
        for (int round = 0; round < repeat; ++round) {
            const double start = threadTime();
            for (int k = 0; k < kTogether; ++k) run(i);
            best = std::min(best, (threadTime() - start) / kTogether);
        }
        ways.microseconds.push_back(best);
    }
    return ways;
}

void measureMap(const std::string& name, const MapOfLeaves& cells, int repeat, Table& table) {
    const CellGraph& graph = cells.space.graph;
    const Rows row{table, name};
    const TreeRays rays(cells.map.tree, {.contents_stop = true});
    const PortalGraph portals(cells.space);
    std::vector<View> views = playerViews(cells, rays, kViews, 1);
    PortalFlood flood;
    const size_t wanted = views.size();
    std::erase_if(views, [&](const View& view) { return !flood.run(portals, view); });
    const double count = static_cast<double>(views.size());
    if (views.empty()) return;

    Random random(2);
    std::vector<std::vector<bool>> truth;
    double true_leaves = 0;
    uint64_t missed = 0;
    std::vector<bool> marked(graph.cells);
    for (const View& view : views) {
        flood.run(portals, view, {.windows = PortalWindows::kBoxes});
        truth.push_back(trulySeen(cells, rays, view, flood, kSegments, random));
        true_leaves += static_cast<double>(std::count(truth.back().begin(), truth.back().end(), true));
    }

    // The map's own rows: a bit for each leaf, which is a cell of ours or none; then the leaves' boxes.
    const Result<QuakeVisibility> own = readQuakeVisibility(cells.map, name);
    Array<uint32_t> start;
    if (own) {
        std::vector<Frustum> frusta;
        std::vector<uint32_t> eye_leaves;
        for (const View& view : views) {
            frusta.push_back(makeFrustum(view));
            eye_leaves.push_back(rays.leafAt(frusta.back().eye));
        }
        uint64_t submitted = 0;
        const auto ask = [&](size_t i) {
            const auto seen = own->seen.row(cells.map.cluster_of_leaf[eye_leaves[i]]);
            for (uint32_t cell = 0; cell < graph.cells; ++cell) {
                const uint32_t cluster = cells.map.cluster_of_leaf[cells.leaf_of_cell[cell]];
                if ((seen[cluster / 64] >> cluster % 64 & 1) != 0) submitted += touches(frusta[i], cells.bounds[cell]);
            }
        };
        const Ways ways = timeViews(views, repeat, ask);
        submitted = 0;
        for (size_t i = 0; i < views.size(); ++i) ask(i);
        row("leaves, the map's own rows and the frustum", static_cast<double>(submitted) / count, "leaves",
            "truly visible", true_leaves / count,
            fmt::format("{} cells, {} portals, {} of {} eyes", graph.cells, graph.portals.size(), views.size(),
                        wanted));
        row("query, the map's own rows and the frustum", medianOf(ways.microseconds), "us", "", 0);
    }

    // Rows of the clusters of the map's portal file. That file lacks slivers of holes: what they hide is not held
    // against the windows.
    BitMatrix baked;
    CellSpace with_rows = cells.space;
    const Result<CellGraph> clusters = readPrt("../shared/maps/" + name + ".prt");
    const bool bake = clusters.ok();
    if (bake) {
        baked = bakeCellVisibility(*clusters).visible;
        for (uint32_t cell = 0; cell < graph.cells; ++cell)
            with_rows.row_of_cell.push_back(clusters->cell_of_leaf[cells.leaf_of_cell[cell]]);
    }
    const PortalGraph row_graph(with_rows);

    double exact_leaves = 0;
    for (const PortalWindows windows : {PortalWindows::kPolygons, PortalWindows::kOctagons, PortalWindows::kBoxes})
        for (const bool by_rows : {false, true}) {
            if (by_rows && !bake) continue;
            const PortalGraph& asked = by_rows ? row_graph : portals;
            std::vector<std::vector<uint64_t>> may(views.size());
            if (by_rows)
                for (size_t i = 0; i < views.size(); ++i) {
                    may[i].assign(baked.wordsPerRow(), 0);
                    PortalFlood first;
                    first.run(portals, views[i], {.windows = PortalWindows::kBoxes});
                    for (const SeenCell& cell : first.cells())
                        if (const uint32_t own_row = row_graph.rowOf(cell.cell);
                            cell.from == ~0u && own_row != PortalGraph::kNoCell)
                            for (size_t w = 0; w < may[i].size(); ++w) may[i][w] |= baked.row(own_row)[w];
                }
            const auto ask = [&](size_t i) {
                return flood.run(asked, views[i], {.windows = windows}, {},
                                 by_rows ? may[i] : std::span<const uint64_t>());
            };
            Ways ways = timeViews(views, repeat, ask);
            for (size_t i = 0; i < views.size(); ++i) {
                ask(i);
                ways.entered += static_cast<double>(flood.stats().cells);
                ways.leaves += static_cast<double>(distinctCells(flood, marked));
                for (uint32_t cell = 0; cell < graph.cells; ++cell)
                    missed += !by_rows && truth[i][cell] && !marked[cell];
            }
            if (windows == PortalWindows::kPolygons && !by_rows) exact_leaves = ways.leaves;
            const std::string kind =
                fmt::format("{}{}", kWindowNames[static_cast<int>(windows)], by_rows ? " and baked rows" : "");
            row("leaves, " + kind, ways.leaves / count, "leaves", "truly visible", true_leaves / count,
                fmt::format("{:.2f}x of polygons", ways.leaves / exact_leaves));
            row("query, " + kind, medianOf(ways.microseconds), "us", "", 0,
                fmt::format("mean {:.1f}, 95 % below {:.1f}; {:.0f} ns a cell entered", meanOf(ways.microseconds),
                            shareOf(ways.microseconds, 0.95), 1e3 * meanOf(ways.microseconds) * count / ways.entered));
        }
    if (missed > 0) table.faults.push_back(fmt::format("{}: {} leaves are seen that an answer lacks", name, missed));
}

}  // namespace

Table benchPortals(const Options& options) {
    Table table{"portals", {}};
    for (const char* name : {"lq_e1m5", "lqdm3", "lq_e2m2", "lq_e4m1"}) {
        MapOfLeaves cells;
        if (readMapOfLeaves(std::string("../shared/maps/") + name + ".vis.bsp", cells))
            measureMap(name, cells, options.repeat ? options.repeat : 5, table);
    }
    return table;
}

}  // namespace sightline::bench
