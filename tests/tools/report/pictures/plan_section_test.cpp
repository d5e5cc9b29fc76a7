// A plan's lines at the height of the eye: walls where triangles are cut, borders of cells, portals.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/plan_section.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/tools/scene/solids.h"

namespace sightline {
using namespace tools;
namespace {

double lengthOf(const std::vector<PlanLine>& lines) {
    double sum = 0;
    for (const PlanLine& line : lines) sum += glm::length(line.to - line.from);
    return sum;
}

PlanArea squareCut(double side) {
    PlanArea area;
    area.width = area.height = side;
    return area;
}

/// A wall of 4 by 3 by 0.5, placed at x = 2.
struct Wall {
    Wall() {
        city::MeshBuilder mesh;
        city::addBox(mesh, 0, {0, 0, 1}, {4, 3, 1.5});
        scene.materials.resize(1);
        scene.meshes.push_back(mesh.finish("wall"));
        scene.objects.emplace_back().transform[3] = {2, 0, 0, 1};
        bounds.push_back(transformBox(scene.meshes[0].bounds, scene.objects[0].transform));
    }
    Scene scene;
    std::vector<Box3d> bounds;
};

TEST(PlanSection, CutsWallsAtAHeight) {
    const Wall wall;
    const std::vector<PlanLine> lines = wallsAt(wall.scene, wall.bounds, squareCut(10), 1.7);
    EXPECT_EQ(lines.size(), 8u);  // two triangles a side
    EXPECT_NEAR(lengthOf(lines), 9, 1e-9);
    for (const PlanLine& line : lines)
        for (const glm::dvec3& end : {line.from, line.to}) {
            EXPECT_NEAR(end.y, 1.7, 1e-12);
            EXPECT_GE(end.x, 2 - 1e-9);
            EXPECT_LE(end.x, 6 + 1e-9);
        }
    EXPECT_TRUE(wallsAt(wall.scene, wall.bounds, squareCut(10), 3.5).empty());
    EXPECT_TRUE(wallsAt(wall.scene, wall.bounds, squareCut(1), 1.7).empty()) << "beside the plan";
}

TEST(PlanSection, LiesOverThePlan) {
    Image<glm::u8vec4> image(100, 100, glm::u8vec4(0));
    const glm::u8vec4 ink(1, 2, 3, 255);
    const Wall wall;
    drawOnPlan(image, squareCut(10), wallsAt(wall.scene, wall.bounds, squareCut(10), 1.7), ink, 0);
    EXPECT_EQ(image.at(40, 10), ink);
    EXPECT_EQ(image.at(20, 12), ink);
    EXPECT_EQ(image.at(40, 12).w, 0) << "within the wall";
    EXPECT_EQ(image.at(80, 10).w, 0);
}

TEST(PlanSection, ShowsPortalsAndTheBordersOfCells) {
    Scene scene;
    SceneCell cell;
    cell.planes = {{1, 0, 0, -1}, {-1, 0, 0, 5}, {0, 0, 1, -1}, {0, 0, -1, 3}, {0, 1, 0, 0}, {0, -1, 0, 3}};
    scene.cells = {cell, SceneCell()};  // the second is no solid
    ScenePortal door;
    door.polygon = {{5, 0, 1.5}, {5, 2, 1.5}, {5, 2, 2.5}, {5, 0, 2.5}};
    ScenePortal hatch;
    hatch.polygon = {{2, 3, 2}, {3, 3, 2}, {3, 3, 3}};
    scene.portals = {door, hatch};
    const PlanCells cells = planCells(scene);
    EXPECT_NEAR(lengthOf(cellsAt(cells, squareCut(10), 1.7)), 12, 1e-9);
    EXPECT_TRUE(cellsAt(cells, squareCut(10), 3.7).empty()) << "above its ceiling";
    const std::vector<PlanLine> portals = portalsAt(cells, 1.7);
    ASSERT_EQ(portals.size(), 1u);
    EXPECT_NEAR(lengthOf(portals), 1, 1e-12);
    EXPECT_EQ(portals[0].from.x, 5);
    EXPECT_TRUE(portalsAt(cells, 2.5).empty());
    EXPECT_TRUE(portalsAt({}, 1.7).empty());
}

TEST(PlanSection, ShowsWhatOfLeavesLiesAtAHeight) {
    // Below y = 2 a slanted plane divides: x + y = 5, so that at 1.7 it is crossed at 3.3.
    LeafTree tree;
    const double half = std::sqrt(0.5);
    tree.nodes = {{{0, 1, 0, -2}, {1, LeafTreeNode::kLeaf | 2}},
                  {{half, half, 0, -5 * half}, {LeafTreeNode::kLeaf | 0, LeafTreeNode::kLeaf | 1}}};
    const auto areaOf = [](const std::vector<LeafAt>& leaves, uint32_t leaf) {
        double area = 0;
        for (const LeafAt& at : leaves)
            for (size_t i = 0; at.leaf == leaf && i < at.outline.size(); ++i) {
                const glm::dvec2 &a = at.outline[i], &b = at.outline[(i + 1) % at.outline.size()];
                area += 0.5 * (a.x * b.y - a.y * b.x);
            }
        return std::abs(area);
    };
    const std::vector<LeafAt> low = leavesAt(tree, squareCut(10), 1.7), high = leavesAt(tree, squareCut(10), 2.5);
    EXPECT_EQ(low.size(), 2u);
    EXPECT_NEAR(areaOf(low, 0), 33, 1e-9);
    EXPECT_NEAR(areaOf(low, 1), 67, 1e-9);
    ASSERT_EQ(high.size(), 1u);
    EXPECT_NEAR(areaOf(high, 2), 100, 1e-9);
    EXPECT_EQ(leavesAt(LeafTree(), squareCut(10), 1).size(), 1u) << "no planes: one leaf is all";
}

TEST(PlanSection, TakesTheCellsOfAVisibilityFile) {
    CellSpace space;
    space.graph.cells = 2;
    space.planes = {{1, 0, 0, 0}, {-1, 0, 0, 4}, {0, 0, 1, 0}, {0, 0, -1, 4}, {1, 0, 0, -90}};
    space.regions = {{0, 4, {}}, {4, 1, {}}};
    space.outside = 1;
    const glm::dvec3 outline[] = {{4, 0, 1}, {4, 2, 1}, {4, 2, 2}, {4, 0, 2}};
    ASSERT_TRUE(space.graph.addPortal(0, 1, outline));
    const PlanCells cells = planCells(space);
    EXPECT_EQ(cells.regions.size(), 1u) << "the outside has no borders";
    EXPECT_NEAR(lengthOf(cellsAt(cells, squareCut(10), 1)), 16, 1e-9);
    EXPECT_NEAR(lengthOf(portalsAt(cells, 1)), 1, 1e-12);
}

}  // namespace
}  // namespace sightline
