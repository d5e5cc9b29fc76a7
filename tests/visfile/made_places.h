// Cells as places and objects in them, made for tests: boxes in a row, or the leaves of a tree.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "sightline/base/bit_matrix.h"
#include "sightline/base/random.h"
#include "sightline/bsp/tree_portals.h"
#include "sightline/cells/cell_space.h"
#include "sightline/visfile/object_section.h"

namespace sightline::test {

struct MadePlaces {
    CellSpace space;
    ObjectPlaces objects;
    BitMatrix object_rows;
    LeafTree view_tree;  ///< one leaf on each side of some planes, and a row of objects for each
    BitMatrix view_rows;

    /// @pre objects
    void addViews(uint32_t planes, Random& random) {
        view_tree.bounds = {glm::dvec3(0), glm::dvec3(1)};
        view_tree.contents.assign(planes + 1, LeafContents::kEmpty);
        for (uint32_t i = 0; i < planes; ++i)
            view_tree.nodes.push_back(
                {{1, 0, 0, -random.uniform()},
                 {LeafTreeNode::kLeaf | i, i + 1 < planes ? i + 1 : LeafTreeNode::kLeaf | planes}});
        view_rows = BitMatrix(planes + 1, objects.size());
        for (size_t row = 0; row <= planes; ++row)
            for (size_t i = 0; i < objects.size(); ++i)
                if (random.below(3) == 0) view_rows.set(row, i);
    }
    void addObjects(size_t count, size_t rows, Random& random) {
        for (size_t i = 0; i < count; ++i) {
            std::vector<uint32_t> in;
            for (uint32_t cell = 0; cell < space.graph.cells; ++cell)
                if (random.below(space.graph.cells) < 2) in.push_back(cell);
            const glm::dvec3 low(random.uniform(), random.uniform(), random.uniform());
            objects.add(i / 2, {low, low + glm::dvec3(i % 3)}, in, in.empty() || i % 7 == 0, i % 5 == 0);
        }
        object_rows = BitMatrix(rows, count);
        for (size_t row = 0; row < rows; ++row)
            for (size_t i = 0; i < count; ++i)
                if (row % 3 != 2 ? random.below(4) == 0 : row >= 3 && object_rows.at(row - 3, i))
                    object_rows.set(row, i);
    }
    void addRows(size_t rows, Random& random) {
        for (uint32_t cell = 0; cell < space.graph.cells; ++cell)
            space.row_of_cell.push_back(cell % 9 == 8 ? CellGraph::kNoCell : static_cast<uint32_t>(random.below(rows)));
    }
};

/// Boxes along x, each open to the next through a door or a hole; the last cell is the outside.
inline MadePlaces boxesInARow(uint64_t seed, uint32_t cells, size_t rows, size_t objects) {
    Random random(seed);
    MadePlaces made;
    CellSpace& space = made.space;
    space.graph.cells = cells;
    space.tolerance = 0.001;
    space.outside = cells - 1;
    for (uint32_t i = 0; i < cells; ++i) {
        CellRegion region{.first_plane = static_cast<uint32_t>(space.planes.size()),
                          .bounds = {glm::dvec3(i, 0, 0), glm::dvec3(i + 1, 1, 2)}};
        if (i != space.outside) {
            for (int axis = 0; axis < 3; ++axis)
                for (const double sign : {1.0, -1.0}) {
                    glm::dvec4 plane(0.0);
                    plane[axis] = sign;
                    plane.w = sign > 0 ? -region.bounds.min[axis] : region.bounds.max[axis];
                    space.planes.push_back(plane);
                }
            region.plane_count = 6;
        } else {
            region.bounds = Box3d();
        }
        space.regions.push_back(region);
        space.names.push_back(i % 3 == 1 ? "" : "cell " + std::to_string(i));
        if (i % 2 == 1) {
            space.doors.push_back({"door " + std::to_string(i), i % 4 == 1 ? i : CellDoor::kNoKey, {0, i % 3, 0}});
        }
        const double x = i;
        const std::vector<glm::dvec3> outline = {{x, 0.2, 0.2}, {x, 0.8, 0.2}, {x, 0.8, 1}, {x, 0.2, 1}};
        const uint32_t door = i % 2 == 1 ? static_cast<uint32_t>(space.doors.size() - 1) : CellPortal::kNone;
        if (i > 0) space.graph.addPortal(i, i - 1, outline, door);
    }
    made.addRows(rows, random);
    made.addObjects(objects, rows, random);
    return made;
}

/// A tree of random planes, some of its leaves solid.
inline MadePlaces leavesOfATree(uint64_t seed, uint32_t nodes, size_t rows, size_t objects) {
    Random random(seed);
    MadePlaces made;
    LeafTree& tree = made.space.tree;
    tree.bounds = {glm::dvec3(0), glm::dvec3(1)};
    const auto leaf = [&] {
        tree.contents.push_back(static_cast<LeafContents>(random.below(4)));
        return LeafTreeNode::kLeaf | static_cast<uint32_t>(tree.contents.size() - 1);
    };
    for (uint32_t i = 0; i < nodes; ++i) {
        LeafTreeNode node;
        const glm::dvec3 normal(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
        const glm::dvec3 through(random.uniform(), random.uniform(), random.uniform());
        node.plane = glm::dvec4(glm::normalize(normal), 0);
        node.plane.w = -glm::dot(glm::dvec3(node.plane), through);
        if (i > 0) {  // in the place of a leaf that is there
            LeafTreeNode& parent = tree.nodes[random.below(tree.nodes.size())];
            const uint32_t side = static_cast<uint32_t>(random.below(2));
            if ((parent.child[side] & LeafTreeNode::kLeaf) == 0) continue;
            node.child[side] = parent.child[side];
            parent.child[side] = static_cast<uint32_t>(tree.nodes.size());
            node.child[1 - side] = leaf();
        } else {
            node.child[0] = leaf();
            node.child[1] = leaf();
        }
        tree.nodes.push_back(node);
    }
    if (nodes == 0) leaf();
    made.space.graph = cellsOfTree(tree);
    made.addRows(rows, random);
    made.addObjects(objects, rows, random);
    return made;
}

}  // namespace sightline::test
