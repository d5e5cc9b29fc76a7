// The page of a bake of any scene holds its plans, and rows that a reader can ask.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/page/bake_page.h"

#include <gtest/gtest.h>

#include "sightline/tools/scene/solids.h"
#include "tests/tools/report/page/page_files.h"

namespace sightline {
using namespace tools;
namespace {

/// Two boxes that stand apart along x, and one above them; view cells are what is left and right of x = 5, below and above y = 4.
struct TwoHalves {
    TwoHalves() {
        city::MeshBuilder mesh;
        city::addBox(mesh, 0, {0, 0, 0}, {2, 3, 2});
        scene.materials.resize(1);
        scene.meshes.push_back(mesh.finish("box"));
        for (const glm::dvec3& place : {glm::dvec3(0, 0, 0), glm::dvec3(8, 0, 8), glm::dvec3(4, 9, 4)}) {
            SceneObject& object = scene.objects.emplace_back();
            object.key = scene.objects.size();
            object.transform[3] = glm::dvec4(place, 1);
        }
        // A slab: what lies over it is another storey.
        city::MeshBuilder slab;
        city::addBox(slab, 0, {0, 4, 0}, {10, 4.1, 10});
        scene.meshes.push_back(slab.finish("slab"));
        scene.objects.emplace_back().mesh = 1;
        space.graph.cells = 1;
        space.graph.cell_of_leaf = {0};
        space.tree.contents = {LeafContents::kEmpty};
        views.nodes = {{{0, 1, 0, -4}, {1, LeafTreeNode::kLeaf | 2}},
                       {{1, 0, 0, -5}, {LeafTreeNode::kLeaf | 0, LeafTreeNode::kLeaf | 1}}};
        views.contents.assign(3, LeafContents::kEmpty);
        rows = BitMatrix(3, 4);
        rows.set(0, 0), rows.set(0, 2);
        for (size_t object = 0; object < 3; ++object) rows.set(1, object);
        for (size_t object = 0; object < 4; ++object) rows.set(2, object);
        bake.scene = &scene;
        bake.space = &space;
        bake.views = &views;
        bake.rows = &rows;
        bake.object_of = object_of;
        bake.eye = {5, 1.5, 5};
    }

    Scene scene;
    CellSpace space;
    LeafTree views;
    BitMatrix rows;
    std::vector<uint32_t> object_of{1, 0, 2, 3};
    DrawnBake bake;
};

class BakePageFiles : public PageFiles {};

TEST_F(BakePageFiles, HoldsBothPlansAndRowsToAsk) {
    const TwoHalves halves;
    ASSERT_TRUE(writeBakePage(halves.bake, "{\"scene\":\"a<b\"}", directory_.string()).ok());
    const nlohmann::json data = dataOf(read("index.html"));
    EXPECT_EQ(data["page"], "bake");
    EXPECT_EQ(data["run"]["scene"], "a<b");
    EXPECT_EQ(read("bake.json"), "{\"scene\":\"a<b\"}");
    ASSERT_EQ(pictures(), 2u);
    const nlohmann::json& plan = data["plan"];
    ASSERT_EQ(plan["cells"].size(), 2u) << "the third is above the height";
    EXPECT_EQ(plan["row_bytes"], 8);
    ASSERT_EQ(plan["objects"].size(), 4u);
    EXPECT_FALSE(plan["objects"][0].is_null());
    EXPECT_FALSE(plan["objects"][1].is_null());
    EXPECT_TRUE(plan["objects"][2].is_null()) << "it is above the slab";
    EXPECT_LT(plan["objects"][1][0], plan["objects"][0][0]) << "in the order of the rows' columns";
    // The right half sees three, the left two; the first to be asked is the one in the middle of their order.
    const bool left_first = plan["cells"][0]["held"] == 2;
    EXPECT_EQ(plan["cells"][left_first ? 1 : 0]["held"], 3);
    EXPECT_EQ(plan["first"], left_first ? 1 : 0);
    std::string bits(16, '\0');
    bits[left_first ? 0 : 8] = 0b101;
    bits[left_first ? 8 : 0] = 0b111;
    EXPECT_EQ(plan["rows"], base64(bits));
}

TEST_F(BakePageFiles, TellsWhatRaysHaveSeenOfRows) {
    TwoHalves halves;
    ASSERT_TRUE(writeBakePage(halves.bake, "{}", directory_.string()).ok());
    EXPECT_TRUE(dataOf(read("index.html"))["plan"]["seen"].is_null());
    BitMatrix seen(3, 4);
    seen.set(0, 2), seen.set(1, 0), seen.set(1, 1), seen.set(1, 2);
    halves.bake.seen = &seen;
    ASSERT_TRUE(writeBakePage(halves.bake, "{}", directory_.string()).ok());
    const nlohmann::json data = dataOf(read("index.html"));
    EXPECT_EQ(pictures(), 3u);
    const nlohmann::json& plan = data["plan"];
    const bool left_first = plan["cells"][0]["held"] == 2;
    EXPECT_EQ(plan["cells"][left_first ? 0 : 1]["witnessed"], 1);
    EXPECT_EQ(plan["cells"][left_first ? 1 : 0]["witnessed"], 3);
    std::string bits(16, '\0');
    bits[left_first ? 0 : 8] = 0b100;
    bits[left_first ? 8 : 0] = 0b111;
    EXPECT_EQ(plan["seen"], base64(bits));
    // Where rays have seen all of a row it is black, where they have not it is brighter.
    const BakePlan drawn(halves.bake);
    const Image<Rgb> open = drawn.open();
    const auto light = [&](double x) {
        const glm::dvec2 at = drawn.at({x, 0, 3.3});
        const Rgb colour = open.at(static_cast<uint32_t>(at.x), static_cast<uint32_t>(at.y));
        return colour.x + colour.y + colour.z;
    };
    EXPECT_LT(light(7.4), light(3.4));
}

TEST_F(BakePageFiles, DrawsGapsWhateverTheirHeight) {
    TwoHalves halves;
    const BakePlan without(halves.bake);
    const Image<Rgb> before = without.cells();
    halves.bake.gaps = {{{3, 100, 5}, {7, 100, 5}}};
    const BakePlan with(halves.bake);
    const Image<Rgb> after = with.cells();
    const glm::dvec2 middle = with.at({5, 0, 5});
    const auto x = static_cast<uint32_t>(middle.x), y = static_cast<uint32_t>(middle.y);
    EXPECT_NE(after.at(x, y), before.at(x, y));
    EXPECT_GT(after.at(x, y).x, after.at(x, y).z + 100) << "red";
}

TEST_F(BakePageFiles, TakesABakeWithoutViewCells) {
    TwoHalves halves;
    halves.bake.views = nullptr;
    halves.bake.rows = nullptr;
    ASSERT_TRUE(writeBakePage(halves.bake, "{}", directory_.string()).ok());
    const nlohmann::json data = dataOf(read("index.html"));
    EXPECT_EQ(pictures(), 1u);
    EXPECT_TRUE(data["plan"].is_null());
    const Scene empty;
    halves.bake.scene = &empty;
    EXPECT_TRUE(writeBakePage(halves.bake, "{}", directory_.string()).ok());
}

TEST_F(BakePageFiles, SaysWhatCannotBeWritten) {
    const TwoHalves halves;
    const Status status = writeBakePage(halves.bake, "{}", (directory_ / "missing").string());
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().kind, Error::Kind::kOutput);
}

}  // namespace
}  // namespace sightline
