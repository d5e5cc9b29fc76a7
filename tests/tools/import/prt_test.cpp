// Portal files: the three kinds, which way an outline runs, and what is refused.
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "map_check.h"
#include "mutated.h"
#include "sightline/base/random.h"
#include "sightline/tools/import/quake/prt.h"
#include "tests/support/corpus.h"

namespace sightline {
using namespace tools;
namespace {

constexpr uint32_t kNoCell = CellGraph::kNoCell;

Result<CellGraph> parse(const std::string& text, PrtNotes* notes = nullptr) {
    return parsePrt({reinterpret_cast<const unsigned char*>(text.data()), text.size()}, "test.prt", notes);
}

/// A square at x = 8, clockwise as seen from the side of the larger x.
const std::string kSquare = "4 0 1 (8 0 0) (8 0 4) (8 4 4) (8 4 0)\n";

void expectSquare(const CellGraph& graph) {
    ASSERT_EQ(graph.cells, 2u);
    ASSERT_EQ(graph.portals.size(), 1u);
    const CellPortal& portal = graph.portals[0];
    EXPECT_EQ(portal.cells[0], 0u);
    EXPECT_EQ(portal.cells[1], 1u);
    EXPECT_EQ(portal.plane, glm::dvec4(1, 0, 0, -8));
    EXPECT_EQ(portal.thickness, 0);
    const std::vector<glm::dvec3> wanted = {{8, 0, -4}, {8, 4, -4}, {8, 4, 0}, {8, 0, 0}};
    EXPECT_EQ(graph.points, wanted);
}

TEST(Prt, ReadsWhatHasALeafACell) {
    PrtNotes notes;
    const Result<CellGraph> graph = parse("PRT1\n2\n1\n" + kSquare, &notes);
    ASSERT_TRUE(graph.ok()) << graph.error().message;
    expectSquare(*graph);
    EXPECT_EQ(graph->cell_of_leaf, (std::vector<uint32_t>{kNoCell, 0, 1}));
    EXPECT_STREQ(notes.kind, "PRT1");
    EXPECT_EQ(notes.leaves, 2u);
}

TEST(Prt, ReadsListsOfLeaves) {
    PrtNotes notes;
    const Result<CellGraph> graph = parse("PRT2\r\n5\r\n2\r\n1\r\n" + kSquare + "3 0 -1\r\n1 4 -1", &notes);
    ASSERT_TRUE(graph.ok()) << graph.error().message;
    expectSquare(*graph);
    EXPECT_EQ(graph->cell_of_leaf, (std::vector<uint32_t>{kNoCell, 0, 1, kNoCell, 0, 1}));
    EXPECT_EQ(notes.leaves, 5u);
}

TEST(Prt, ReadsACellForEachLeaf) {
    const Result<CellGraph> graph = parse("PRT1-AM\n2\n1\n3\n" + kSquare + "1\n0\n1\n");
    ASSERT_TRUE(graph.ok()) << graph.error().message;
    expectSquare(*graph);
    EXPECT_EQ(graph->cell_of_leaf, (std::vector<uint32_t>{kNoCell, 1, 0, 1}));
}

TEST(Prt, LeavesOutAndListsWhatHasNoArea) {
    PrtNotes notes;
    const Result<CellGraph> graph = parse("PRT1\n2\n2\n3 0 1 (0 0 0) (1 1 1) (2 2 2)\n" + kSquare, &notes);
    ASSERT_TRUE(graph.ok()) << graph.error().message;
    expectSquare(*graph);
    EXPECT_EQ(notes.flat_lines, std::vector<uint32_t>{4});
}

TEST(Prt, KeepsEveryBitOfItsNumbers) {
    for (uint64_t seed = 1; seed <= 200; ++seed) {
        Random random(seed);
        std::string text;
        std::vector<glm::dvec3> points;
        const uint64_t portals = random.below(6), cells = 2 + random.below(5);
        for (uint64_t i = 0; i < portals; ++i) {
            const uint64_t count = 3 + random.below(4), a = random.below(cells - 1);
            text += fmt::format("{} {} {} ", count, a, a + 1);
            for (uint64_t k = 0; k < count; ++k) {
                const double scale = random.below(2) ? 1e6 : 1e-3;
                const double x = random.uniform(-scale, scale), y = random.uniform(-scale, scale),
                             z = random.uniform(-scale, scale);
                text += fmt::format("({} {} {}) ", x, y, z);
                points.insert(points.end() - static_cast<std::ptrdiff_t>(k), {x, z, -y});  // the other way round
            }
            text += "\n";
        }
        const Result<CellGraph> graph = parse(fmt::format("PRT1\n{}\n{}\n", cells, portals) + text);
        ASSERT_TRUE(graph.ok()) << seed << ": " << graph.error().message;
        EXPECT_EQ(graph->portals.size(), portals) << seed;
        EXPECT_EQ(graph->points, points) << seed;
    }
}

TEST(Prt, SaysInOneLineWhereItIsWrong) {
    const auto expectLine = [](const std::string& text, const std::string& line) {
        const Result<CellGraph> graph = parse(text);
        ASSERT_FALSE(graph.ok()) << text;
        EXPECT_EQ(graph.error().message, "test.prt: " + line);
        EXPECT_EQ(graph.error().kind, Error::Kind::kInput);
    };
    const std::string none = "line 1: not a portal file: it begins with none of PRT1, PRT2, PRT1-AM";
    expectLine("", none);
    expectLine("PRT3\n1\n0\n", none);
    expectLine("PRT1", "line 1: the file's end is no count of clusters");
    expectLine("PRT1\n4000000000\n0\n", "line 2: count of clusters 4000000000 is not in 0 to 18");
    expectLine("PRT1\n99999999999999999999\n0\n", "line 2: '99999999999999999999' is no count of clusters");
    expectLine("PRT1\n2\n-1\n", "line 3: count of portals -1 is not in 0 to 10");
    expectLine("PRT1\n2\n1\n", "line 4: the file's end is no count of points");
    expectLine("PRT1\n2\n1\n2 0 1 (0 0 0) (1 0 0)", "line 4: count of points 2 is not in 3 to 2147483647");
    expectLine("PRT1\n2\n1\n3 0 2 (0 0 0) (1 0 0) (0 1 0)", "line 4: cluster 2 is not in 0 to 1");
    expectLine("PRT1\n2\n1\n3 1 1 (0 0 0) (1 0 0) (0 1 0)", "line 4: a portal from cluster 1 into itself");
    expectLine("PRT1\n2\n1\n3 0 1 (0 0 0) (1 0 0)\n", "line 5: the file's end where '(' was expected");
    expectLine("PRT1\n2\n1\n3 0 1 (0 0 0) (1 nan 0) (0 1 0)", "line 4: 'nan' is too large for a coordinate");
    expectLine("PRT1\n2\n1\n3 0 1 (0 0 0) (1 inf 0) (0 1 0)", "line 4: 'inf' is too large for a coordinate");
    expectLine("PRT1\n2\n1\n3 0 1 (0 0 0) (1 1e300 0) (0 1 0)", "line 4: '1e300' is too large for a coordinate");
    expectLine("PRT1\n2\n1\n3 0 1 (0 0 0) (1 1e999 0) (0 1 0)", "line 4: '1e999' is no coordinate");
    expectLine("PRT1\n2\n1\n3 0 1 (0 0 0 0) (1 0 0) (0 1 0)", "line 4: '0)' where ')' was expected");
    expectLine("PRT1\n2\n1\n3 0 1 (0 \x01x\x80 0) (1 0 0) (0 1 0)", "line 4: '?x?' is no coordinate");
    expectLine("PRT1\n2\n1\n" + kSquare + "0", "line 5: more follows where the file should end");
    expectLine("PRT2\n3\n2\n1\n" + kSquare + "0 -1\n3 -1\n", "line 7: leaf 3 is not in -1 to 2");
    expectLine("PRT2\n3\n2\n1\n" + kSquare + "0 -1\n0 -1\n", "line 7: leaf 0 is in two clusters");
    expectLine("PRT2\n3\n2\n1\n" + kSquare + "0 -1\n1 2\n", "line 8: the file's end is no leaf");
    expectLine("PRT1-AM\n2\n1\n3\n" + kSquare + "1\n2\n1\n", "line 7: cluster 2 is not in 0 to 1");
}

TEST(Prt, EachCutOfItIsRefused) {
    const std::string whole = "PRT2\n5\n2\n1\n" + kSquare + "3 0 -1\n1 4 -1\n";
    for (size_t size = 0; size + 1 < whole.size(); ++size) EXPECT_FALSE(parse(whole.substr(0, size)).ok()) << size;
}

TEST(Prt, FilesAreReadAndMissedByName) {
    EXPECT_FALSE(readPrt("/nowhere/x.prt").ok());
    EXPECT_EQ(readPrt("/nowhere/x.prt").error().message, "/nowhere/x.prt: no such file");
}

/// Cells are convex: all portals of a cell lie on its side of each of them. An outline read the wrong way round would
/// have all of them behind it.
TEST(PrtOfRealMaps, CellsLieWhereTheirPortalsFace) {
    struct Map {
        const char* name;
        uint32_t leaves, cells, portals;
        uint32_t concave = 0;  ///< one cell of lq_e4m4 is, by 16 units: its writer's, not the reader's
    };
    for (const Map& map :
         {Map{"lq_e4m1", 4469, 370, 764}, Map{"lq_e2m2", 1927, 794, 1808}, Map{"lqdm3", 3148, 620, 1682},
          Map{"lq_e1m5", 3911, 1684, 3729}, Map{"lq_e4m4", 6180, 3323, 9277, 1}}) {
        const std::string file = fmt::format("{}/maps/{}.prt", SIGHTLINE_SHARED_DIR, map.name);
        if (!std::filesystem::exists(file)) GTEST_SKIP() << "the shared maps are not there";
        PrtNotes notes;
        const Result<CellGraph> graph = readPrt(file, &notes);
        ASSERT_TRUE(graph.ok()) << graph.error().message;
        EXPECT_EQ(notes.leaves, map.leaves);
        EXPECT_EQ(graph->cells, map.cells);
        EXPECT_EQ(graph->portals.size() + notes.flat_lines.size(), map.portals);
        EXPECT_TRUE(notes.flat_lines.empty());
        const CellFaults faults = checkCells(*graph, 0.5);
        EXPECT_EQ(faults.concave_portals, 0u) << map.name;
        EXPECT_EQ(faults.bent_portals, 0u) << map.name;
        EXPECT_EQ(faults.concave_cells, map.concave) << map.name << ": " << faults.worst_concavity;
        for (size_t leaf = 1; leaf < graph->cell_of_leaf.size(); ++leaf)
            ASSERT_NE(graph->cell_of_leaf[leaf], kNoCell) << map.name << " leaf " << leaf;
    }
}

TEST(PrtMutation, SurvivesTwentyThousandMutations) {
    const std::vector<std::string> samples = {"PRT1\n2\n1\n" + kSquare,
                                              "PRT2\n5\n2\n1\n" + kSquare + "3 0 -1\n1 4 -1\n",
                                              "PRT1-AM\n2\n1\n3\n" + kSquare + "1\n0\n1\n"};
    for (uint64_t seed = 1; seed <= 20000; ++seed) {
        Random random(seed);
        const std::string bytes = test::mutated(samples[random.below(samples.size())], random);
        ASSERT_EQ(test::prtFault(bytes), "") << "seed " << seed;
    }
}

TEST(PrtMutation, CorpusOfTheFuzzerIsSound) {
    test::forCorpus("prt", 4, [](const std::string& name, const std::string& bytes) {
        EXPECT_EQ(test::prtFault(bytes), "") << name;
    });
}

}  // namespace
}  // namespace sightline
