// Ways through cells: from hole to hole as they bend, beside a plain search by the middles of holes.
// SPDX-License-Identifier: MIT
//
// Edsger Dijkstra. A Note on Two Problems in Connexion with Graphs. 1959.
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "bench/cases.h"
#include "bench/stopwatch.h"
#include "sightline/bake/bake.h"
#include "sightline/cells/portal_graph.h"
#include "sightline/query/connectivity.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/building/building.h"

namespace sightline::bench {
namespace {

using namespace bake;
using namespace tools;

constexpr uint32_t kPlaces = 24;

/// Distances to all cells by the middles of portals: what an engine's own loop over a graph does.
class PlainWays {
public:
    explicit PlainWays(const CellSpace& space) : graph_(space.graph), of_cell_(space.graph.cells) {
        for (uint32_t i = 0; i < graph_.portals.size(); ++i) {
            const CellPortal& portal = graph_.portals[i];
            glm::dvec3 sum(0.0);
            for (const glm::dvec3& corner : graph_.outline(portal)) sum += corner;
            middles_.push_back(sum / static_cast<double>(portal.count));
            for (const uint32_t cell : portal.cells) of_cell_[cell].push_back(i);
        }
    }
    void from(uint32_t cell, const glm::dvec3& place) {
        far_.assign(of_cell_.size(), kNever);
        at_.assign(of_cell_.size(), place);
        std::priority_queue<std::pair<double, uint32_t>, std::vector<std::pair<double, uint32_t>>, std::greater<>>
            queue;
        far_[cell] = 0;
        queue.emplace(0, cell);
        while (!queue.empty()) {
            const auto [far, here] = queue.top();
            queue.pop();
            if (far > far_[here]) continue;
            for (const uint32_t i : of_cell_[here]) {
                const CellPortal& portal = graph_.portals[i];
                const uint32_t beyond = portal.cells[portal.cells[0] == here ? 1 : 0];
                const double length = far + glm::distance(at_[here], middles_[i]);
                if (length >= far_[beyond]) continue;
                far_[beyond] = length;
                at_[beyond] = middles_[i];
                queue.emplace(length, beyond);
            }
        }
    }
    double to(uint32_t cell, const glm::dvec3& place) const { return far_[cell] + glm::distance(at_[cell], place); }

private:
    static constexpr double kNever = std::numeric_limits<double>::infinity();

    const CellGraph& graph_;
    std::vector<std::vector<uint32_t>> of_cell_;
    std::vector<glm::dvec3> middles_, at_;
    std::vector<double> far_;
};

void measure(const std::string& name, const CellSpace& space, const std::vector<glm::dvec3>& places, Table& table) {
    World world = World::create({});
    if (!world.attach(space)) return;
    const Snapshot now = world.commit();
    const PortalGraph graph(space);
    Array<uint32_t> cells;
    std::vector<std::pair<glm::dvec3, uint32_t>> known;
    for (const glm::dvec3& place : places)
        if (graph.cellsAround({&place, 1}, 0, cells)) known.emplace_back(place, cells[0]);
    ConnectivityQuery query;
    PlainWays plain(space);
    if (known.empty() || !query.begin(now, known[0].first)) return;
    double apart = 0, ways = 0, ours = 0, theirs = 0, bends = 0, passed = 0;
    for (const auto& [from, cell] : known) {
        query.begin(now, from);
        plain.from(cell, from);
        for (const auto& [to, other] : known) {
            const Way way = query.to(to);
            if (!way.connected) ++apart;
            if (!way.connected || other == cell) continue;
            ++ways;
            ours += way.distance;
            theirs += plain.to(other, to);
            bends += static_cast<double>(way.points.size() - 2);
            passed += static_cast<double>(way.cells.size() - 1);
        }
    }
    const auto pairs = static_cast<double>(known.size() * known.size());
    double sum = 0;
    const std::vector<double> times = timeInTurn({[&] {
                                                      for (const auto& one : known)
                                                          for (const auto& other : known) {
                                                              query.begin(now, one.first);
                                                              sum += query.to(other.first).distance;
                                                          }
                                                  },
                                                  [&] {
                                                      for (const auto& one : known) {
                                                          query.begin(now, one.first);
                                                          for (const auto& other : known)
                                                              sum += query.to(other.first).distance;
                                                      }
                                                  },
                                                  [&] {
                                                      for (const auto& [from, cell] : known) {
                                                          plain.from(cell, from);
                                                          for (const auto& other : known)
                                                              sum += plain.to(other.second, other.first);
                                                      }
                                                  }},
                                                 5, threadTime);
    const Rows rows{table, fmt::format("{}, {} cells, {} portals", name, graph.cells(), graph.portals())};
    rows("a way between two places", times[0] / pairs, "us", "a search of all cells",
         times[2] / static_cast<double>(known.size()),
         fmt::format("{:.1f} bends, {:.1f} portals; of {:.0f} pairs {:.0f} are apart", bends / ways, passed / ways,
                     pairs, apart));
    rows("a way to one of many places", times[1] / pairs, "us", "a search of all cells, shared", times[2] / pairs);
    rows("length of a way", ours / ways, "", "by the middles of portals", theirs / ways);
}

std::vector<glm::dvec3> placesOf(const Scene& scene) {
    std::vector<glm::dvec3> places;
    for (const CameraFrame& camera : seededCameras(scene, kPlaces, 2).frames) places.push_back(camera.eye);
    return places;
}

void measureWalls(const Scene& scene, Table& table) {
    SoupCellSettings settings;
    for (const CameraFrame& frame : seededCameras(scene, 32, 1).frames) settings.eyes.push_back(frame.eye);
    const SoupCells cells = cellsOfSoup(scene, settings);
    if (cells.space.graph.cells > 0) measure(scene.name + ", its own walls", cells.space, placesOf(scene), table);
}

}  // namespace

Table benchWays(const Options& options) {
    Table table{"ways", {}, {}};
    if (options.scene) {
        measureWalls(*options.scene, table);
        return table;
    }
    for (const uint32_t floors : {1u, 10u}) {
        Scene scene = makeBuilding(1, floors);
        scene.name = fmt::format("building:1:{}", floors);
        measure(scene.name, sceneToBake(scene, scene.name).space, placesOf(scene), table);
        if (floors == 1) measureWalls(scene, table);
    }
    return table;
}

}  // namespace sightline::bench
