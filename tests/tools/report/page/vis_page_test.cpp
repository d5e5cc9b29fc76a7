// The page of a map's visibility holds its pictures, whatever the map is.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/page/vis_page.h"

#include <gtest/gtest.h>

#include "sightline/tools/report/pictures/png.h"
#include "tests/tools/report/page/page_files.h"

namespace sightline {
using namespace tools;
namespace {

class VisPageFiles : public PageFiles {};

/// Rooms in a row, each of which sees all others.
struct Row {
    CellGraph graph;
    BitMatrix visible;

    explicit Row(uint32_t rooms) : visible(rooms, rooms) {
        graph.cells = rooms;
        for (uint32_t i = 0; i < rooms; ++i) {
            for (uint32_t k = 0; k < rooms; ++k) visible.set(i, k);
            if (i == 0) continue;
            const double x = 10.0 * i;
            const glm::dvec3 outline[] = {{x, 0, 0}, {x, 0, 9}, {x, 3, 9}, {x, 3, 0}};
            graph.addPortal(i - 1, i, outline);
        }
    }
};

TEST_F(VisPageFiles, HoldsMatrixPlanCellsAndALine) {
    const Row row(5);
    VisSummary summary;
    summary.map = "row<5>.prt";
    summary.leafs = summary.clusters = 5;
    summary.visible_leaf_pairs = 25;
    ASSERT_TRUE(writeVisPage(row.graph, row.visible, row.visible, summary, directory_.string()).ok());
    EXPECT_EQ(pictures(), 6u);
    EXPECT_EQ(read("index.html").find("row<5>"), std::string::npos);  // a name is no markup
    const nlohmann::json data = dataOf(read("index.html"));
    EXPECT_EQ(data["page"], "vis");
    EXPECT_EQ(data["run"]["map"], "row<5>.prt");
    const std::string text = data["pictures"].back()["text"];
    EXPECT_EQ(text.find("A sight line through 4 cells"), 0u) << text;  // it begins in a portal
    EXPECT_EQ(nlohmann::json::parse(read("vis.json"))["visible_leaf_pairs"], 25);
}

TEST_F(VisPageFiles, HasThePlanThatCanBeAsked) {
    Row row(70);
    BitMatrix witnessed(70, 70);
    row.visible.clear(3, 69);
    witnessed.set(3, 65);
    ASSERT_TRUE(writeVisPage(row.graph, row.visible, witnessed, VisSummary(), directory_.string()).ok());
    const nlohmann::json plan = dataOf(read("index.html"))["plan"];
    EXPECT_EQ(plan["cells"].size(), 70u);
    EXPECT_EQ(plan["row_bytes"], 16) << "whole words";
    EXPECT_NE(plan["cells"][3], "");
    // What the script decodes, byte for byte.
    std::string visible(70 * 16, '\0'), seen(70 * 16, '\0');
    for (size_t r = 0; r < 70; ++r)
        for (size_t c = 0; c < 70; ++c) {
            if (row.visible.at(r, c)) visible[r * 16 + c / 8] |= static_cast<char>(1 << c % 8);
            if (witnessed.at(r, c)) seen[r * 16 + c / 8] |= static_cast<char>(1 << c % 8);
        }
    EXPECT_EQ(plan["visible"], base64(visible));
    EXPECT_EQ(plan["witnessed"], base64(seen));
    const Row large(2049);
    ASSERT_TRUE(writeVisPage(large.graph, large.visible, large.visible, VisSummary(), directory_.string()).ok());
    EXPECT_TRUE(dataOf(read("index.html"))["plan"].is_null()) << "its rows would be most of the page";
}

TEST_F(VisPageFiles, TakesGraphsWithoutPortalsOrCells) {
    for (const uint32_t rooms : {1u, 0u}) {
        const Row row(rooms);
        const Status status = writeVisPage(row.graph, row.visible, row.visible, VisSummary(), directory_.string());
        ASSERT_TRUE(status.ok()) << status.error().message;
        EXPECT_EQ(pictures(), rooms == 1 ? 2u : 0u);
    }
}

TEST_F(VisPageFiles, SaysWhatCannotBeWritten) {
    const Row row(3);
    const Status status =
        writeVisPage(row.graph, row.visible, row.visible, VisSummary(), (directory_ / "missing").string());
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().kind, Error::Kind::kOutput);
}

}  // namespace
}  // namespace sightline
