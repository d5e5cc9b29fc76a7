// Holds rows of cells against slow truths: plans of rooms by every chain of doors, and rays through graphs.
// SPDX-License-Identifier: MIT
#include "sightline/bake/flow/cell_visibility.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "sightline/base/thread_pool.h"
#include "sightline/bsp/merge_cells.h"
#include "sightline/bsp/tree_portals.h"
#include "tests/bake/flow/visibility_laws.h"
#include "tests/bake/marked/plan_oracle.h"
#include "tests/bsp/leaf_tree_fixture.h"
#include "tests/support/targets.h"

namespace sightline::test {
using namespace bake;
namespace {

CellGraph worldOf(uint64_t kind, uint64_t seed) {
    if (kind == 0) return gridOfRooms(seed, {.rooms = {10, 10, 1}, .upright = true});
    if (kind == 1) return gridOfRooms(seed, {.rooms = {5, 4, 4}});
    if (kind == 2) return bentTube(seed, 90, 0.05);
    return cellsOfTree(randomLeafTree(seed, 9, glm::dvec3(0.0), false));
}

CellVisibility bakeWithin(const CellGraph& graph, uint64_t budget, Jobs* jobs = nullptr) {
    CellVisibilitySettings settings;
    settings.budget = budget;
    settings.jobs = jobs;
    return bakeCellVisibility(graph, settings);
}

TEST(CellVisibility, LiesBetweenTheTruthsOfNarrowerAndWiderDoors) {
    uint64_t truths = 0, visibles = 0, witnessed = 0, all = 0;
    for (uint64_t seed = 1; seed <= 60; ++seed) {
        const int side = 3 + static_cast<int>(seed % 4);
        const CellGraph graph =
            gridOfRooms(seed, {.rooms = {side, side, 1}, .doors = seed % 3 ? 0.7 : 0.9, .upright = true});
        const CellVisibility answer = bakeCellVisibility(graph);
        const BitMatrix surely = PlanOracle(graph, -1e-9).all(), perhaps = PlanOracle(graph, 1e-9).all();
        ASSERT_TRUE(isWithin(surely, perhaps));
        EXPECT_TRUE(isWithin(surely, answer.visible)) << "seed " << seed;
        EXPECT_TRUE(isWithin(answer.witnessed, perhaps)) << "seed " << seed;
        EXPECT_EQ(answer.over_budget, 0u);
        EXPECT_FALSE(answer.stopped);
        truths += perhaps.count();
        visibles += answer.visible.count();
        witnessed += answer.witnessed.count();
        all += uint64_t(graph.cells) * graph.cells;
    }
    RecordProperty("truth", static_cast<int>(truths));
    RecordProperty("visible", static_cast<int>(visibles));
    RecordProperty("witnessed", static_cast<int>(witnessed));
    EXPECT_LT(truths, all / 2);
    EXPECT_LT(static_cast<double>(visibles), 1.02 * static_cast<double>(truths));
    EXPECT_GT(static_cast<double>(witnessed), 0.97 * static_cast<double>(truths));
}

TEST(CellVisibility, SeesThroughDoorsInAllDirectionsWhatRaysSee) {
    uint64_t uppers = 0, visibles = 0, witnessed = 0, sampled = 0, confirmed = 0;
    for (uint64_t seed = 1; seed <= 12; ++seed) {
        const CellGraph graph = gridOfRooms(seed, {.rooms = {4, 3, 3}, .doors = 0.8});
        const CellVisibility answer = bakeCellVisibility(graph);
        BitMatrix seen(graph.cells, graph.cells);
        expectLaws(graph, answer, 200000, nameOf("rooms", seed), &seen);
        const BitMatrix perhaps = PlanOracle(graph, 1e-9).all();
        EXPECT_TRUE(isWithin(seen, perhaps)) << "seed " << seed;
        EXPECT_TRUE(isWithin(answer.witnessed, perhaps)) << "seed " << seed;
        uppers += perhaps.count();
        visibles += answer.visible.count();
        witnessed += answer.witnessed.count();
        sampled += seen.count();
        confirmed += answer.witnessed.count() - countOutside(answer.witnessed, seen);
    }
    EXPECT_LE(visibles, uppers + uppers / 20);
    EXPECT_GT(static_cast<double>(witnessed), 0.97 * static_cast<double>(visibles));
    EXPECT_GT(static_cast<double>(witnessed), 0.99 * static_cast<double>(sampled));
    EXPECT_GT(static_cast<double>(confirmed), 0.9 * static_cast<double>(witnessed));
}

TEST(CellVisibility, SeesAlongTubesWhatRaysSee) {
    uint64_t visibles = 0, unresolved = 0;
    for (uint64_t seed = 1; seed <= 30; ++seed) {
        const CellGraph graph = bentTube(seed, 20 + static_cast<uint32_t>(seed), 0.02 * static_cast<double>(seed % 7));
        const CellVisibility answer = bakeCellVisibility(graph);
        expectLaws(graph, answer, 40000, nameOf("tube", seed));
        visibles += answer.visible.count();
        unresolved += answer.visible.count() - answer.witnessed.count();
    }
    EXPECT_LT(static_cast<double>(unresolved), 0.05 * static_cast<double>(visibles));
}

TEST(CellVisibility, SeesInTreesOfPlanesWhatRaysSee) {
    uint64_t visibles = 0, unresolved = 0;
    for (uint64_t seed = 1; seed <= 30; ++seed) {
        const CellGraph graph = cellsOfTree(randomLeafTree(seed, 8, glm::dvec3(0.0), false));
        const CellVisibility answer = bakeCellVisibility(graph);
        expectLaws(graph, answer, 100000, nameOf("tree", seed));
        visibles += answer.visible.count();
        unresolved += answer.visible.count() - answer.witnessed.count();
    }
    EXPECT_GT(visibles, 1000u);
    EXPECT_LT(static_cast<double>(unresolved), 0.05 * static_cast<double>(visibles));
}

TEST(CellVisibility, SeesThroughCellsThatAreUnions) {
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        const CellGraph graph = worldOf(seed % 4, seed);
        Random random(seed);
        std::vector<uint32_t> numbers(graph.cells);
        const uint32_t cells = graph.cells / 2 + 1;
        for (uint32_t& number : numbers) number = static_cast<uint32_t>(random.below(cells));
        const CellGraph merged = mergeCells(graph, numbers, cells);
        const CellVisibility answer = bakeCellVisibility(merged);
        expectLaws(merged, answer, 20000, nameOf("union", seed));
        // What the cells see, their unions see.
        const CellVisibility fine = bakeCellVisibility(graph);
        BitMatrix expected(cells, cells);
        for (uint32_t a = 0; a < graph.cells; ++a)
            for (uint32_t b = 0; b < graph.cells; ++b)
                if (fine.witnessed.at(a, b)) expected.set(numbers[a], numbers[b]);
        for (uint32_t cell = 0; cell < cells; ++cell) expected.set(cell, cell);
        EXPECT_TRUE(isWithin(expected, answer.visible)) << "seed " << seed;
    }
}

void expectSame(const CellVisibility& a, const CellVisibility& b, const std::string& name) {
    EXPECT_TRUE(a.visible == b.visible) << name;
    EXPECT_TRUE(a.witnessed == b.witnessed) << name;
    EXPECT_EQ(a.steps, b.steps) << name;
    EXPECT_EQ(a.over_budget, b.over_budget) << name;
}

TEST(CellVisibility, IsTheSameForAnyThreadsAndInstructions) {
    for (uint64_t kind = 0; kind < 4; ++kind) {
        const CellGraph graph = worldOf(kind, 7);
        for (const uint64_t budget : {uint64_t(0), uint64_t(7)}) {
            const CellVisibility alone = bakeWithin(graph, budget);
            EXPECT_GT(alone.steps, 0u);
            for (const uint32_t threads : {1u, 2u, 3u, 8u}) {
                ThreadPool pool(threads);
                expectSame(alone, bakeWithin(graph, budget, &pool), nameOf("threads", threads));
            }
            EXPECT_GE(
                forEachTarget([&](const std::string& target) { expectSame(alone, bakeWithin(graph, budget), target); }),
                2);
        }
    }
}

TEST(CellVisibility, GoesOnFromEveryCheckpoint) {
    for (uint64_t kind = 0; kind < 4; ++kind) {
        const CellGraph graph = worldOf(kind, 11);
        for (const uint64_t budget : {uint64_t(0), uint64_t(20)}) {
            std::vector<CellVisibilityState> states;
            CellVisibilitySettings settings;
            settings.budget = budget;
            settings.checkpoint = [&](const CellVisibilityState& state) { states.push_back(state); };
            const CellVisibility whole = bakeCellVisibility(graph, settings);
            settings.checkpoint = nullptr;
            ASSERT_GE(states.size(), 2u);
            for (size_t i = 0; i < states.size(); ++i) {
                settings.resume = &states[i];
                expectSame(whole, bakeCellVisibility(graph, settings), nameOf("checkpoint", i));
            }
        }
    }
}

TEST(CellVisibility, KeepsWhatABudgetLeavesUnsettled) {
    for (uint64_t kind = 0; kind < 4; ++kind) {
        const CellGraph graph = worldOf(kind, 5);
        const CellVisibility whole = bakeCellVisibility(graph);
        EXPECT_EQ(whole.over_budget, 0u);
        uint64_t before = uint64_t(graph.cells) * graph.cells + 1;
        for (const uint64_t budget : {1, 10, 100, 1000000}) {
            const CellVisibility some = bakeWithin(graph, budget);
            expectLaws(graph, some, 20000, nameOf("budget", budget));
            EXPECT_TRUE(isWithin(whole.witnessed, some.visible));
            // Fewer settled portals: what the rest is held against is wider.
            EXPECT_TRUE(isWithin(whole.visible, some.visible)) << nameOf("budget", budget);
            EXPECT_LE(some.visible.count(), before);
            before = some.visible.count();
            if (budget == 1) { EXPECT_GT(some.over_budget, 0u); }
            if (budget == 1000000) {
                EXPECT_EQ(some.over_budget, 0u);
                EXPECT_TRUE(some.visible == whole.visible);
            }
            EXPECT_LE(some.steps, budget * 2 * graph.portals.size());
        }
    }
}

/// Whether some two points of the portals around two cells are as near as this: in boxes, as slowly as can be.
bool haveNearPortals(const CellGraph& graph, uint32_t a, uint32_t b, double distance) {
    const auto boxOf = [&](const CellPortal& portal) {
        Box3d box;
        for (const glm::dvec3& point : graph.outline(portal)) box.grow(point);
        return box;
    };
    const auto isOf = [](const CellPortal& portal, uint32_t cell) {
        return portal.cells[0] == cell || portal.cells[1] == cell;
    };
    for (const CellPortal& p : graph.portals)
        for (const CellPortal& q : graph.portals) {
            if (!isOf(p, a) || !isOf(q, b)) continue;
            const Box3d one = boxOf(p), other = boxOf(q);
            const glm::dvec3 gap = glm::max(glm::max(one.min - other.max, other.min - one.max), glm::dvec3(0.0));
            if (glm::length(gap) <= distance) return true;
        }
    return false;
}

TEST(CellVisibility, SightMayEndAtADistance) {
    uint64_t wholes = 0, nears = 0, too_far = 0;
    for (uint64_t kind = 0; kind < 4; ++kind)
        for (uint64_t seed = 1; seed <= 5; ++seed) {
            const CellGraph graph = worldOf(kind, seed);
            const CellVisibility whole = bakeCellVisibility(graph);
            const double size = largestCoordinate(graph);
            for (const double share : {0.05, 0.2, 0.6, 8.0}) {
                const std::string name = nameOf("farthest", seed) + " of kind " + std::to_string(kind);
                CellVisibilitySettings settings;
                settings.farthest = share * size;
                const CellVisibility some = bakeCellVisibility(graph, settings);
                expectShape(some, graph.cells, name);
                // Flows in another order prove other pairs hidden.
                EXPECT_LE(countOutside(some.visible, whole.visible), whole.visible.count() / 50) << name;
                if (share > 4) { EXPECT_TRUE(some.visible == whole.visible) << name; }
                const GraphRays judge(graph, 2 * kGraphPrecision * size);
                RowCheckSettings within;
                within.segments = 40000;
                within.farthest = settings.farthest;
                EXPECT_EQ(checkCellRows(judge, some.visible, within).misses, 0u) << name;
                for (uint32_t a = 0; a < graph.cells; ++a)
                    for (uint32_t b = 0; b < graph.cells; ++b)
                        if (a != b && some.visible.at(a, b) && !haveNearPortals(graph, a, b, settings.farthest * 1.001))
                            ADD_FAILURE() << name << ": " << a << " sees " << b << ", which is too far away";
                within.farthest *= 2;
                if (share < 1) {
                    wholes += whole.visible.count();
                    nears += some.visible.count();
                    too_far += checkCellRows(judge, some.visible, within).misses;
                }
            }
        }
    EXPECT_LT(nears, wholes * 3 / 4);
    EXPECT_GT(too_far, 100u);  // segments twice as long are seen to miss something
}

TEST(CellVisibility, KeepsWhatTheWorkOfAllLeavesUnsettled) {
    for (uint64_t kind = 0; kind < 4; ++kind) {
        const CellGraph graph = worldOf(kind, 6);
        const CellVisibility whole = bakeCellVisibility(graph);
        uint64_t before = uint64_t(graph.cells) * graph.cells + 1;
        for (const uint64_t work : {uint64_t(1), uint64_t(3000), uint64_t(100000), kUsualWork}) {
            CellVisibilitySettings settings;
            settings.work = work;
            std::vector<CellVisibilityState> states;
            settings.checkpoint = [&](const CellVisibilityState& state) { states.push_back(state); };
            const CellVisibility some = bakeCellVisibility(graph, settings);
            settings.checkpoint = nullptr;
            EXPECT_TRUE(isWithin(whole.visible, some.visible)) << "kind " << kind << " work " << work;
            EXPECT_LE(some.visible.count(), before);
            before = some.visible.count();
            EXPECT_FALSE(some.stopped);
            if (work == 1) {
                EXPECT_GT(some.over_budget, 0u);
                EXPECT_LT(some.steps, whole.steps);
                expectLaws(graph, some, 20000, "hardly any work");
            }
            if (work == kUsualWork) {
                EXPECT_EQ(some.over_budget, 0u);
                expectSame(whole, some, nameOf("work that suffices", kind));
            }
            for (const uint32_t threads : {2u, 3u}) {
                ThreadPool pool(threads);
                settings.jobs = &pool;
                expectSame(some, bakeCellVisibility(graph, settings), nameOf("threads", threads));
            }
            settings.jobs = nullptr;
            for (size_t i = 0; i < states.size(); ++i) {
                settings.resume = &states[i];
                expectSame(some, bakeCellVisibility(graph, settings), nameOf("checkpoint", i));
            }
        }
    }
}

/// Of a grid of rooms with doors on all sides: whoever stops it stops it within the first bound and within a flow.
TEST(CellVisibility, HearsWithinEachStep) {
    const CellGraph graph = gridOfRooms(4, {.rooms = {12, 12, 1}, .upright = true});
    const CellVisibility whole = bakeCellVisibility(graph);
    std::vector<std::string> heard_in;
    for (int calls = 0;; ++calls) {
        int left = calls;
        std::string step;
        CellVisibilitySettings settings;
        settings.stop = [&] { return left-- <= 0; };
        settings.progress = [&](const BakeProgress& progress) { step = progress.step; };
        size_t checkpoints = 0;
        uint64_t flowed = 0;
        settings.checkpoint = [&](const CellVisibilityState& state) {
            ++checkpoints;
            flowed = state.flowed;
        };
        const CellVisibility some = bakeCellVisibility(graph, settings);
        EXPECT_TRUE(isWithin(whole.visible, some.visible)) << calls;
        if (!some.stopped) break;
        EXPECT_GE(left, -2) << calls;  // once it has been told, it does not go on asking
        if (heard_in.empty() || heard_in.back() != step) heard_in.push_back(step);
        if (step == "base") { EXPECT_EQ(checkpoints, 0u) << calls; }
        EXPECT_EQ(flowed % 64, 0u) << calls;  // a batch that was cut short is not in the state
    }
    EXPECT_EQ(heard_in, (std::vector<std::string>{"base", "rays", "flow"}));
}

TEST(CellVisibility, StopsWithAllThatMayBeSeen) {
    for (uint64_t kind = 0; kind < 4; ++kind) {
        const CellGraph graph = worldOf(kind, 3);
        const CellVisibility whole = bakeCellVisibility(graph);
        for (int calls = 0; calls < 40; ++calls) {
            int left = calls;
            CellVisibilitySettings settings;
            settings.stop = [&] { return left-- == 0; };
            const CellVisibility some = bakeCellVisibility(graph, settings);
            expectShape(some, graph.cells, nameOf("stop", static_cast<uint64_t>(calls)));
            EXPECT_TRUE(isWithin(whole.visible, some.visible)) << calls;
            EXPECT_EQ(some.stopped, left < 0);
            if (!some.stopped) {
                expectSame(whole, some, "no stop");
                break;
            }
            if (calls == 0) expectLaws(graph, some, 20000, "stopped at once");
        }
    }
}

TEST(CellVisibility, TellsHowFarItHasCome) {
    const CellGraph graph = worldOf(1, 2);
    std::vector<std::string> steps;
    double last = 0;
    CellVisibilitySettings settings;
    settings.progress = [&](const BakeProgress& progress) {
        if (steps.empty() || steps.back() != progress.step) {
            steps.emplace_back(progress.step);
            last = 0;
        }
        EXPECT_GE(progress.done, last);
        EXPECT_LE(progress.done, 1);
        last = progress.done;
    };
    bakeCellVisibility(graph, settings);
    EXPECT_EQ(steps, (std::vector<std::string>{"base", "rays", "flow"}));
    EXPECT_EQ(last, 1);
}

}  // namespace
}  // namespace sightline::test
