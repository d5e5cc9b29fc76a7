// Maps of games: no ray passes between cells that are hidden from one another, and no row is larger than the map's own.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "sightline/bake/brushes/brush_tree.h"
#include "sightline/bake/brushes/outside.h"
#include "sightline/base/thread_pool.h"
#include "sightline/bsp/tree_portals.h"
#include "sightline/tools/import/quake/prt.h"
#include "sightline/tools/import/quake/quake_bsp.h"
#include "sightline/tools/import/quake/quake_map.h"
#include "sightline/tools/import/quake/quake_visibility.h"
#include "sightline/tools/scene/text_file.h"
#include "sightline/tools/truth/tree_rays.h"
#include "tests/bake/flow/visibility_laws.h"
#include "tests/support/random.h"

namespace sightline::test {
using namespace bake;
using namespace tools;
namespace {

/// Long tests hold each map against as many rays as the promise says.
uint64_t raysToCast() { return testsAreLong() ? 100000000 : 200000; }

ThreadPool& pool() {
    static ThreadPool threads(std::max(1u, std::thread::hardware_concurrency()));
    return threads;
}

std::string fileOf(const std::string& map, const char* ending) {
    return std::string(SIGHTLINE_SHARED_DIR) + "/maps/" + map + ending;
}

class Maps : public ::testing::TestWithParam<const char*> {
protected:
    void SetUp() override {
        const std::string file = fileOf(GetParam(), ".prt");
        if (!std::filesystem::exists(file)) GTEST_SKIP() << "there is no such map: " << file;
        const Result<CellGraph> graph = readPrt(file);
        ASSERT_TRUE(graph.ok()) << graph.error().message;
        if (graph->cells > 2000 && !testsAreLong()) GTEST_SKIP() << "it takes long: SIGHTLINE_LONG_TESTS=1 bakes it";
        graph_ = *graph;
    }

    /// The compiled map, which is there.
    void readBsp(QuakeMapFile& map) const {
        const std::string file = bspFile();
        const Result<std::string> text = readTextFile(file);
        ASSERT_TRUE(text.ok()) << text.error().message;
        const Result<QuakeMapFile> read =
            parseQuakeBsp({reinterpret_cast<const unsigned char*>(text->data()), text->size()}, file);
        ASSERT_TRUE(read.ok()) << read.error().message;
        map = *read;
    }
    std::string bspFile() const {
        const std::string visited = fileOf(GetParam(), ".vis.bsp");
        return std::filesystem::exists(visited) ? visited : fileOf(GetParam(), ".bsp");
    }

    CellGraph graph_;
};

uint64_t pairsOf(const BitMatrix& rows) { return rows.count() - rows.rows(); }

TEST_P(Maps, SeeWhatRaysSee) {
    const CellVisibility answer = bakeCellVisibility(graph_);
    expectLaws(graph_, answer, raysToCast(), GetParam(), nullptr, &pool());
    EXPECT_EQ(answer.over_budget, 0u);
    // Unresolved: 3 % of what is visible.
    EXPECT_LE(100 * (answer.visible.count() - answer.witnessed.count()), 3 * pairsOf(answer.visible));
}

/// Maps that were compiled with rows: of lq_e4m4 there is no compiled map.
class CompiledMaps : public Maps {};

TEST_P(CompiledMaps, SeeNoMoreThanTheRowsThatTheyCameWith) {
    QuakeMapFile map;
    if (!std::filesystem::exists(bspFile())) GTEST_SKIP() << "there is no such map: " << bspFile();
    ASSERT_NO_FATAL_FAILURE(readBsp(map));
    const Result<QuakeVisibility> lump = readQuakeVisibility(map, GetParam());
    ASSERT_TRUE(lump.ok());
    const CellVisibility answer = bakeCellVisibility(graph_);
    std::vector<uint32_t> leaf_of(graph_.cells, 0);
    for (uint32_t leaf = 1; leaf < graph_.cell_of_leaf.size(); ++leaf) leaf_of[graph_.cell_of_leaf[leaf]] = leaf;
    uint64_t theirs = 0;
    for (const uint32_t a : leaf_of)
        for (const uint32_t b : leaf_of) theirs += a != b && lump->seen.at(a - 1, b - 1);
    EXPECT_LE(pairsOf(answer.visible), theirs);
}

INSTANTIATE_TEST_SUITE_P(Real, Maps, ::testing::Values("lq_e4m1", "lq_e2m2", "lqdm3", "lq_e1m5", "lq_e4m4"),
                         [](const auto& map) { return std::string(map.param); });
INSTANTIATE_TEST_SUITE_P(Real, CompiledMaps, ::testing::Values("lq_e4m1", "lq_e2m2", "lqdm3", "lq_e1m5"),
                         [](const auto& map) { return std::string(map.param); });

/// Maps whose leaves are few enough to be cells.
class SmallMaps : public Maps {};

TEST_P(SmallMaps, SeeByTheirTreesPortalsWhatTheirTreesSee) {
    QuakeMapFile map;
    if (!std::filesystem::exists(bspFile())) GTEST_SKIP() << "there is no such map: " << bspFile();
    ASSERT_NO_FATAL_FAILURE(readBsp(map));
    const CellGraph graph = cellsOfTree(map.tree);
    const CellVisibility answer = bakeCellVisibility(graph);
    expectLaws(graph, answer, raysToCast(), GetParam(), nullptr, &pool());
    AimedHoles holes;
    for (const CellPortal& portal : graph.portals) holes.add(graph.outline(portal));
    const RowReport report = checkLeafRows(TreeRays(map.tree), answer.visible, graph.cell_of_leaf, holes,
                                           {.segments = raysToCast(), .jobs = &pool()});
    EXPECT_EQ(report.misses, 0u) << "the first: " << report.examples[0].row << ", " << report.examples[0].column;
    EXPECT_EQ(report.unmapped, 0u);
    EXPECT_LE(100 * (answer.visible.count() - answer.witnessed.count()), 3 * pairsOf(answer.visible));
}

INSTANTIATE_TEST_SUITE_P(Real, SmallMaps, ::testing::Values("lq_e2m2", "e3m5"),
                         [](const auto& map) { return std::string(map.param); });

/// The source of a map, by our own tree of its brushes.
class Sources : public ::testing::TestWithParam<const char*> {};

TEST_P(Sources, SeeByTheirBrushesPortalsWhatTheirTreesSee) {
    const std::string file = fileOf(GetParam(), ".map");
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "there is no such map: " << file;
    const Result<std::string> text = readTextFile(file);
    ASSERT_TRUE(text.ok()) << text.error().message;
    const Result<QuakeMap> source =
        parseQuakeMap({reinterpret_cast<const unsigned char*>(text->data()), text->size()}, file);
    ASSERT_TRUE(source.ok()) << source.error().message;
    const BrushTree brushes = treeOfBrushes(*source);
    const CellGraph graph = cellsInside(*source, brushes).graph;
    const CellVisibility answer = bakeCellVisibility(graph);
    expectLaws(graph, answer, 5 * raysToCast(), GetParam(), nullptr, &pool());
    AimedHoles holes;
    for (const CellPortal& portal : graph.portals) holes.add(graph.outline(portal));
    const RowReport report = checkLeafRows(TreeRays(brushes.tree), answer.visible, graph.cell_of_leaf, holes,
                                           {.segments = 5 * raysToCast(), .jobs = &pool()});
    EXPECT_EQ(report.misses, 0u) << "the first: " << report.examples[0].row << ", " << report.examples[0].column;
}

INSTANTIATE_TEST_SUITE_P(Real, Sources, ::testing::Values("lq_e2m2", "lq_e4m1", "byob_rabbit"),
                         [](const auto& map) { return std::string(map.param); });

}  // namespace
}  // namespace sightline::test
