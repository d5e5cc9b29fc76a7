// The verb info tells what a visibility file holds.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/visibility_file.h"
#include "tests/cli/tool.h"

namespace sightline {
namespace {

using InfoVisibility = Tool;

/// Four cells in a row, each of which sees its neighbours; cell 1 has two leaves, leaf 0 has none.
std::string rowOfFour(VisibilityForm form) {
    BitMatrix visible(4, 4);
    for (size_t i = 0; i < 4; ++i)
        for (size_t k = i == 0 ? 0 : i - 1; k < std::min<size_t>(i + 2, 4); ++k) visible.set(i, k);
    const std::vector<uint32_t> leaves = {CellGraph::kNoCell, 0, 1, 1, 2, 3};
    const Array<char> bytes = *visibilityFile({visible, leaves, "row.bsp", 0xabc}, form);
    return {bytes.begin(), bytes.end()};
}

TEST_F(InfoVisibility, CountsCellsLeavesAndPairs) {
    for (const VisibilityForm form : {VisibilityForm::kInPlace, VisibilityForm::kPacked}) {
        const std::string bytes = rowOfFour(form);
        write("row.see", bytes);
        const Outcome text = succeed("info row.see");
        EXPECT_NE(text.out.find("row.bsp (hash 0000000000000abc)"), std::string::npos) << text.out;
        const auto json = answer("info row.see");
        EXPECT_EQ(json["schema"], "sightline.visibility/1");
        EXPECT_EQ(json["form"], form == VisibilityForm::kPacked ? "packed" : "in place");
        EXPECT_EQ(json["cells"], 4);
        EXPECT_EQ(json["different_rows"], 4);
        EXPECT_EQ(json["leafs"], 6);
        EXPECT_EQ(json["leafs_in_cells"], 5);
        EXPECT_EQ(json["visible_cell_pairs"], 4 + 2 * 3);
        // By leaves: 0 sees 0, 1, 1; each leaf of 1 sees 0, 1, 1, 2; 2 sees 1, 1, 2, 3; 3 sees 2, 3.
        EXPECT_EQ(json["visible_leaf_pairs"], 3 + 2 * 4 + 4 + 2);
        EXPECT_EQ(json["bytes"], bytes.size());
    }
}

TEST_F(InfoVisibility, DamageIsALineAndAnExitCode) {
    std::string bytes = rowOfFour(VisibilityForm::kInPlace);
    bytes[bytes.size() / 2] ^= 1;
    write("row.see", bytes);
    expectError("info row.see", 3, "row.see: the content does not have the hash that it says at byte 24");
    write("row.see", bytes.substr(0, 40));
    expectError("info row.see", 3, "row.see: the file ends within its head at byte 40");
    write("row.see", rowOfFour(VisibilityForm::kInPlace));
    expectError("info row.see --objects", 2, "--objects");
    EXPECT_EQ(run("info row.see --json no-such-folder/x.json").exit_code, 4);
}

}  // namespace
}  // namespace sightline
