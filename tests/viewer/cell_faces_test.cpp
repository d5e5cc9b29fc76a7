// The faces of cells: closed around the cell, and of a tree's leaves without gap or overlap.
// SPDX-License-Identifier: MIT
#include "apps/viewer/cell_faces.h"

#include <gtest/gtest.h>

#include <vector>

#include "sightline/bake/bake.h"
#include "sightline/base/random.h"
#include "sightline/cells/portal_graph.h"
#include "sightline/tools/scene/building/building.h"

namespace sightline::viewer {
namespace {

/// Twice the area of a face, along its normal.
glm::dvec3 areaOf(const CellFaces::Outline& face) {
    glm::dvec3 area(0.0);
    for (size_t i = 0; i < face.size(); ++i) area += glm::cross(face[i], face[(i + 1) % face.size()]);
    return area;
}

/// Of the room that closed faces bound, by the divergence theorem.
double volumeOf(std::span<const CellFaces::Outline> faces) {
    double volume = 0;
    for (const CellFaces::Outline& face : faces) volume += glm::dot(face.front(), areaOf(face)) / 6;
    return volume;
}

void expectClosed(std::span<const CellFaces::Outline> faces, double size) {
    glm::dvec3 sum(0.0);
    for (const CellFaces::Outline& face : faces) sum += areaOf(face);
    EXPECT_LT(glm::length(sum), 1e-9 * size * size);
}

TEST(CellFaces, OfATreesLeavesFillTheBox) {
    Random random(4);
    CellSpace space;
    space.tree.bounds = {glm::dvec3(-2.0), glm::dvec3(3.0)};
    // Each node hangs below the one before, on a side by chance.
    constexpr uint32_t kNodes = 30;
    for (uint32_t i = 0; i < kNodes; ++i) {
        const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
        const glm::dvec3 normal = glm::normalize(glm::dvec3(x, y, z));
        LeafTreeNode node;
        node.plane = glm::dvec4(normal, random.uniform(-1, 1));
        const int deeper = static_cast<int>(random.below(2));
        node.child[deeper] = i + 1 < kNodes ? i + 1 : LeafTreeNode::kLeaf | kNodes;
        node.child[1 - deeper] = LeafTreeNode::kLeaf | i;
        space.tree.nodes.push_back(node);
    }
    space.tree.contents.assign(kNodes + 1, LeafContents::kEmpty);
    space.graph.cells = kNodes + 1;
    const Box3d box{glm::dvec3(-2.0), glm::dvec3(3.0)};
    const CellFaces faces(space, box);
    ASSERT_EQ(faces.cells(), kNodes + 1);
    double volume = 0;
    size_t cells = 0;
    for (uint32_t cell = 0; cell < faces.cells(); ++cell) {
        expectClosed(faces.of(cell), 5);
        volume += volumeOf(faces.of(cell));
        cells += !faces.of(cell).empty();
    }
    EXPECT_NEAR(volume, 125, 1e-9);
    EXPECT_GT(cells, 5u);
    // What is solid has none, and two leaves of one cell have the faces of both.
    const double all = volumeOf(faces.of(0)) + volumeOf(faces.of(1));
    space.graph.cells = 1;
    space.graph.cell_of_leaf.assign(kNodes + 1, CellGraph::kNoCell);
    space.graph.cell_of_leaf[0] = space.graph.cell_of_leaf[1] = 0;
    EXPECT_NEAR(volumeOf(CellFaces(space, box).of(0)), all, 1e-9);
}

TEST(CellFaces, StandAroundTheRoomsOfABuilding) {
    const tools::Scene scene = tools::makeBuilding(1, 1);
    bake::SceneCellSettings marks;
    marks.trusted = true;
    const CellSpace space = bake::sceneToBake(scene, "house", marks).space;
    const PortalGraph graph(space);
    const Box3d box = worldBounds(scene);
    const CellFaces faces(space, box);
    size_t seen = 0;
    for (uint32_t cell = 0; cell < faces.cells(); ++cell) {
        if (faces.of(cell).empty()) continue;
        expectClosed(faces.of(cell), glm::length(box.size()));
        EXPECT_GT(volumeOf(faces.of(cell)), 0.0);
        glm::dvec3 middle(0.0);
        size_t corners = 0;
        for (const CellFaces::Outline& face : faces.of(cell))
            for (const glm::dvec3& corner : face) middle += corner, ++corners;
        middle /= static_cast<double>(corners);
        Array<uint32_t> around;
        ASSERT_TRUE(graph.cellsAround({&middle, 1}, 0, around)) << cell;
        EXPECT_NE(std::find(around.begin(), around.end(), cell), around.end()) << cell;
        ++seen;
    }
    EXPECT_GT(seen, 10u);
}

}  // namespace
}  // namespace sightline::viewer
