// Boxes that cells see: all that lines meet, no more than lies in visible cells.
// SPDX-License-Identifier: MIT
#include "sightline/bake/objects/box_visibility.h"

#include <limits>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/base/thread_pool.h"
#include "sightline/tools/truth/graph_rays.h"
#include "tests/bake/flow/cell_worlds.h"
#include "tests/bake/flow/visibility_laws.h"

namespace sightline {
using namespace bake;
using namespace tools;
namespace {

using namespace test;

/// Small boxes about points on lines that begin in a portal: each lies in the cell that the line is in there.
struct BoxesOnLines {
    CellBoxes boxes;
    std::vector<uint32_t> seen_from;  ///< per box a cell that the line comes from
};

BoxesOnLines boxesOnLines(const CellGraph& graph, uint64_t seed, uint32_t count) {
    BoxesOnLines out;
    const GraphRays rays(graph, 1e-6);
    Random random(seed);
    std::vector<GraphStep> steps;
    for (uint32_t tries = 0; out.boxes.boxes.size() < count && tries < 100 * count; ++tries) {
        const CellPortal& portal = graph.portals[random.below(graph.portals.size())];
        glm::dvec3 from(0);
        double sum = 0;
        for (const glm::dvec3& point : graph.outline(portal)) {
            const double weight = 0.01 + random.uniform();
            from += weight * point;
            sum += weight;
        }
        from /= sum;
        glm::dvec3 direction(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        const bool against = glm::dot(glm::dvec3(portal.plane), direction) < 0;
        rays.follow(portal.cells[against], from, direction, steps);
        if (steps.size() < 2) continue;
        // Between where the line enters a cell and where it leaves it.
        const size_t i = random.below(steps.size() - 1);
        const GraphStep &here = steps[i], &next = steps[i + 1];
        if (next.before != i || !(next.at > here.at)) continue;
        const glm::dvec3 point = from + (here.at + random.uniform(0.1, 0.9) * (next.at - here.at)) * direction;
        const glm::dvec3 half(random.uniform(1e-9, 1e-6));
        const uint32_t cells[] = {here.cell};
        out.boxes.add({point - half, point + half}, cells);
        out.seen_from.push_back(portal.cells[!against]);
    }
    return out;
}

BoxVisibility bakeBoth(const CellGraph& graph, const CellBoxes& boxes, CellVisibilitySettings settings,
                       CellVisibility& cells) {
    settings.keep_follows = true;
    cells = bakeCellVisibility(graph, settings);
    return bakeBoxVisibility(graph, cells, boxes, settings);
}

TEST(BoxVisibility, HoldsWhatLinesMeet) {
    uint64_t visible = 0, by_cells = 0;
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        const CellGraph graph = seed % 2 ? gridOfRooms(seed, {}) : bentTube(seed, 12, 0.3);
        const BoxesOnLines made = boxesOnLines(graph, seed, 200);
        CellVisibility cells;
        const BoxVisibility answer = bakeBoth(graph, made.boxes, {}, cells);
        for (size_t box = 0; box < made.seen_from.size(); ++box)
            EXPECT_TRUE(answer.visible.at(made.seen_from[box], box)) << seed << " box " << box;
        for (uint32_t cell = 0; cell < graph.cells; ++cell)
            for (size_t box = 0; box < made.boxes.boxes.size(); ++box)
                if (answer.visible.at(cell, box)) {
                    EXPECT_TRUE(cells.visible.at(cell, made.boxes.cells[box])) << seed;
                }
        visible += answer.visible.count();
        by_cells += answer.by_cells;
    }
    EXPECT_LT(visible, by_cells);  // or else it is of no use
}

TEST(BoxVisibility, IsTheSameForAnyThreads) {
    const CellGraph graph = gridOfRooms(7, {});
    const BoxesOnLines made = boxesOnLines(graph, 7, 300);
    CellVisibility cells;
    const BoxVisibility one = bakeBoth(graph, made.boxes, {}, cells);
    for (const uint32_t threads : {2u, 8u}) {
        ThreadPool pool(threads);
        CellVisibilitySettings settings;
        settings.jobs = &pool;
        EXPECT_EQ(bakeBoth(graph, made.boxes, settings, cells).visible, one.visible);
    }
}

TEST(BoxVisibility, DoubtIsVisible) {
    const CellGraph graph = gridOfRooms(3, {});
    BoxesOnLines made = boxesOnLines(graph, 3, 50);
    CellVisibility cells;
    const BoxVisibility whole = bakeBoth(graph, made.boxes, {}, cells);
    CellVisibilitySettings settings;
    settings.budget = 3;
    const BoxVisibility spent = bakeBoth(graph, made.boxes, settings, cells);
    EXPECT_TRUE(isWithin(whole.visible, spent.visible));
    EXPECT_GT(spent.over_budget, 0u);
    settings.budget = 0;
    settings.stop = [] { return true; };
    CellVisibilitySettings keeping;
    keeping.keep_follows = true;
    cells = bakeCellVisibility(graph, keeping);
    const BoxVisibility stopped = bakeBoxVisibility(graph, cells, made.boxes, settings);
    EXPECT_TRUE(stopped.stopped);
    EXPECT_EQ(stopped.visible.count(), graph.cells * made.boxes.boxes.size());
    // Of no cell, or of no place.
    made.boxes.add({glm::dvec3(0), glm::dvec3(1)}, {});
    const uint32_t first[] = {0};
    made.boxes.add({glm::dvec3(std::numeric_limits<double>::quiet_NaN()), glm::dvec3(1)}, first);
    const BoxVisibility odd = bakeBoxVisibility(graph, cells, made.boxes);
    for (uint32_t cell = 0; cell < graph.cells; ++cell)
        for (const size_t box : {made.boxes.boxes.size() - 2, made.boxes.boxes.size() - 1})
            EXPECT_TRUE(odd.visible.at(cell, box));
}

}  // namespace
}  // namespace sightline
