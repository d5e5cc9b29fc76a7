// Rows of real maps: what the file answers is what the maps' own lumps say, in a fraction of their bytes.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <filesystem>

#include "sightline/tools/import/quake/prt.h"
#include "sightline/tools/import/quake/quake_visibility.h"
#include "sightline/tools/scene/text_file.h"
#include "sightline/visfile/visibility_file.h"

namespace sightline {
using namespace tools;
namespace {

class VisibleMaps : public testing::TestWithParam<const char*> {};

TEST_P(VisibleMaps, AnswerAsTheirLumpsInAFractionOfTheBytes) {
    const std::string stem = std::string(SIGHTLINE_SHARED_DIR) + "/maps/" + GetParam();
    if (!std::filesystem::exists(stem + ".vis.bsp")) GTEST_SKIP() << "the shared maps are not here";
    const Result<CellGraph> graph = readPrt(stem + ".prt");
    ASSERT_TRUE(graph.ok()) << graph.error().message;
    const std::string text = *readTextFile(stem + ".vis.bsp");
    const std::span bytes(reinterpret_cast<const unsigned char*>(text.data()), text.size());
    const Result<QuakeMapFile> map = parseQuakeBsp(bytes, GetParam());
    ASSERT_TRUE(map.ok()) << map.error().message;
    const QuakeVisibility lump = *readQuakeVisibility(*map, GetParam());
    const size_t leaves = graph->cell_of_leaf.size();
    ASSERT_EQ(lump.seen.rows(), leaves - 1);
    const auto bothSee = [&](size_t a, size_t b) {
        return a == b || (lump.seen.at(a - 1, b - 1) && lump.seen.at(b - 1, a - 1));
    };
    BitMatrix visible(graph->cells, graph->cells);
    for (size_t a = 1; a < leaves; ++a)
        for (size_t b = 1; b < leaves; ++b)
            if (bothSee(a, b)) visible.set(graph->cell_of_leaf[a], graph->cell_of_leaf[b]);

    const VisibilityContent content{visible, graph->cell_of_leaf, GetParam()};
    const Array<char> in_place = *visibilityFile(content, VisibilityForm::kInPlace),
                      packed = *visibilityFile(content, VisibilityForm::kPacked);
    for (const Array<char>* form : {&in_place, &packed}) {
        const Result<VisibilityFile> file = VisibilityFile::open(*form, GetParam());
        ASSERT_TRUE(file.ok()) << file.error().message;
        ASSERT_EQ(file->leaves(), leaves);
        EXPECT_EQ(file->cellOfLeaf(0), CellGraph::kNoCell);
        uint64_t wrong = 0;
        std::vector<uint64_t> row(visible.wordsPerRow());
        for (uint32_t a = 1; a < leaves; ++a) {
            const uint32_t cell = file->cellOfLeaf(a);
            file->rows().row(cell, row);
            for (uint32_t b = 1; b < leaves; ++b) {
                // Leaves of one cell have one row, so that what one of them sees, they all see.
                const uint32_t other = file->cellOfLeaf(b);
                const bool seen = cell == other || bothSee(a, b);
                wrong += file->rows().sees(cell, other) != seen || bool(row[other / 64] >> other % 64 & 1) != seen;
            }
        }
        EXPECT_EQ(wrong, 0u);
        EXPECT_LE(double(file->residentBytes()), 0.6 * double(map->visibility.size()));
    }
    EXPECT_LE(double(packed.size()), 0.25 * double(map->visibility.size()));
}

INSTANTIATE_TEST_SUITE_P(Shared, VisibleMaps, testing::Values("lq_e4m1", "lq_e2m2", "lqdm3", "lq_e1m5"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace sightline
