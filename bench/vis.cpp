// Cell visibility of real maps and of rooms in a grid, beside classic portal flow: seconds, pairs, threads.
// SPDX-License-Identifier: MIT
#include <cmath>

#include <fmt/core.h>

#include "bench/cases.h"
#include "bench/classic_flow.h"
#include "bench/stopwatch.h"
#include "sightline/bake/flow/cell_visibility.h"
#include "sightline/base/random.h"
#include "sightline/base/thread_pool.h"
#include "sightline/tools/import/quake/prt.h"

namespace sightline::bench {
using namespace bake;
using namespace tools;
namespace {

constexpr double kClassicLimit = 30000;  // [milliseconds]

/// Rooms of unit size, three in four of their walls with a door somewhere.
CellGraph gridOfRooms(uint32_t side, uint32_t floors) {
    Random random(1);
    CellGraph graph;
    const uint32_t counts[3] = {side, side, floors};
    graph.cells = side * side * floors;
    for (uint32_t room = 0; room < graph.cells; ++room) {
        const uint32_t at[3] = {room % side, room / side % side, room / (side * side)};
        const uint32_t step[3] = {1, side, side * side};
        for (int axis = 0; axis < 3; ++axis) {
            if (at[axis] + 1 == counts[axis] || random.below(4) == 0) continue;
            glm::dvec3 low(at[0], at[1], at[2]), high = low + 1.0;
            low[axis] = high[axis];
            for (int i = 0; i < 3; ++i) {
                if (i == axis) continue;
                low[i] += random.uniform(0.05, 0.5);
                high[i] = low[i] + random.uniform(0.2, 0.45);
            }
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            glm::dvec3 outline[4] = {low, low, low, low};  // about the axis: as seen from the next room
            outline[1][u] = outline[2][u] = high[u];
            outline[2][v] = outline[3][v] = high[v];
            graph.addPortal(room + step[axis], room, outline);
        }
    }
    return graph;
}

void measure(const std::string& name, const CellGraph& graph, int repeat, Table& table) {
    const Rows row{table, name};
    const auto pairsOf = [&](const BitMatrix& rows) { return static_cast<double>(rows.count() - graph.cells); };
    CellVisibility answer;
    std::vector<double> times;
    for (int i = 0; i < repeat; ++i) times.push_back(millisecondsOf([&] { answer = bakeCellVisibility(graph); }));
    const ClassicFlow classic = classicFlow(graph, kClassicLimit);
    const std::string note = classic.finished
                                 ? fmt::format("{} cells, {} portals", graph.cells, graph.portals.size())
                                 : fmt::format(
                                       "{} cells, {} portals; classic flow was stopped, {:.0f} % of it done: the ratio "
                                       "is less than this",
                                       graph.cells, graph.portals.size(),
                                       100.0 * classic.flowed / (2.0 * static_cast<double>(graph.portals.size())));
    row("bake, one thread", medianOf(times), "ms", "classic flow", classic.milliseconds, note);
    row("steps", answer.steps, "portals clipped", "classic flow", classic.steps);
    if (classic.finished)
        row("visible pairs", pairsOf(answer.visible), "pairs", "classic flow", pairsOf(classic.visible));
    const double visible = pairsOf(answer.visible), witnessed = pairsOf(answer.witnessed);
    row("neither witnessed nor hidden", visible - witnessed, "pairs", "visible", visible);

    ThreadPool pool(2);
    CellVisibilitySettings settings;
    const std::vector<double> wall = timeInterleaved({[&] {
                                                          settings.jobs = &pool;
                                                          bakeCellVisibility(graph, settings);
                                                      },
                                                      [&] {
                                                          settings.jobs = nullptr;
                                                          bakeCellVisibility(graph, settings);
                                                      }},
                                                     repeat);
    row("bake, two threads", wall[0] / 1e3, "ms of the clock", "one thread", wall[1] / 1e3);
    // Its tolerances are guesses.
    uint64_t lacks = 0;
    for (size_t r = 0; r < graph.cells; ++r)
        for (size_t c = 0; c < graph.cells; ++c) lacks += answer.witnessed.at(r, c) && !classic.visible.at(r, c);
    row("witnessed pairs that classic flow lacks", lacks, "pairs", "witnessed", witnessed);
}

}  // namespace

Table benchVis(const Options& options) {
    Table table{"vis", {}};
    const int repeat = options.repeat ? options.repeat : 3;
    const char* const names[] = {"lq_e4m1", "lq_e2m2", "lqdm3", "lq_e1m5"};
    size_t done = 0;
    for (const char* name : names) {
        if (options.progress) options.progress(done++, std::size(names) + 2);
        const Result<CellGraph> graph = readPrt(fmt::format("../shared/maps/{}.prt", name));
        if (graph) measure(name, *graph, repeat, table);
    }
    for (const uint32_t side : {8u, 16u}) {
        if (options.progress) options.progress(done++, std::size(names) + 2);
        measure(fmt::format("{0} x {0} x 3 rooms", side), gridOfRooms(side, 3), repeat, table);
    }
    return table;
}

}  // namespace sightline::bench
