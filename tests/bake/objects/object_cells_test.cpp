// Objects lie in the cells that points of theirs lie in, and in none that they do not touch.
// SPDX-License-Identifier: MIT
#include "sightline/bake/objects/object_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sightline/bake/marked/scene_cells.h"
#include "sightline/base/random.h"
#include "sightline/base/thread_pool.h"
#include "sightline/bsp/tree_portals.h"
#include "sightline/tools/scene/procedural.h"

namespace sightline {
using namespace bake;
using namespace tools;
namespace {

/// Planes of a cell, by whatever says what it is.
struct Shapes {
    std::vector<std::vector<glm::dvec4>> planes;  ///< per cell
};

Shapes shapesOfTree(const CellSpace& space) {
    Shapes out;
    out.planes.resize(space.graph.cells);
    struct At {
        uint32_t child;
        std::vector<glm::dvec4> planes;
    };
    std::vector<At> stack = {{space.tree.nodes.empty() ? LeafTreeNode::kLeaf : 0, {}}};
    while (!stack.empty()) {
        At at = std::move(stack.back());
        stack.pop_back();
        if ((at.child & LeafTreeNode::kLeaf) != 0) {
            const uint32_t cell = space.graph.cell_of_leaf[at.child ^ LeafTreeNode::kLeaf];
            if (cell != CellGraph::kNoCell) out.planes[cell] = at.planes;
            continue;
        }
        const LeafTreeNode& node = space.tree.nodes[at.child];
        const glm::dvec4 plane = node.plane / glm::length(glm::dvec3(node.plane));
        At back{node.child[0], at.planes}, front{node.child[1], at.planes};
        back.planes.push_back(-plane);
        front.planes.push_back(plane);
        stack.push_back(back);
        stack.push_back(front);
    }
    return out;
}

Shapes shapesOfRegions(const CellSpace& space) {
    Shapes out;
    for (uint32_t cell = 0; cell < space.graph.cells; ++cell) {
        const std::span<const glm::dvec4> planes = space.planesOf(space.regions[cell]);
        out.planes.emplace_back(planes.begin(), planes.end());
    }
    return out;
}

double depthBelow(const std::vector<glm::dvec4>& planes, const glm::dvec3& p) {
    double depth = -1e300;
    for (const glm::dvec4& plane : planes) depth = std::max(depth, -(glm::dot(glm::dvec3(plane), p) + plane.w));
    return depth;
}

/// Whether a triangle has a point that is no deeper than `depth` below any plane: by all corners that two bounds of a
/// linear programme in its plane may have.
bool touches(const std::vector<glm::dvec4>& planes, std::span<const glm::dvec3> triangle, double depth) {
    const glm::dvec3 u = triangle[1] - triangle[0], v = triangle[2] - triangle[0];
    std::vector<glm::dvec3> bounds = {{1, 0, 0}, {0, 1, 0}, {-1, -1, 1}};  // a s + b t + c >= 0
    for (const glm::dvec4& plane : planes)
        bounds.emplace_back(glm::dot(glm::dvec3(plane), u), glm::dot(glm::dvec3(plane), v),
                            glm::dot(glm::dvec3(plane), triangle[0]) + plane.w + depth);
    const auto holds = [&](double s, double t) {
        return std::all_of(bounds.begin(), bounds.end(),
                           [&](const glm::dvec3& b) { return b.x * s + b.y * t + b.z >= -1e-9; });
    };
    for (size_t i = 0; i < bounds.size(); ++i)
        for (size_t k = 0; k < i; ++k) {
            const glm::dvec3 at = glm::cross(bounds[i], bounds[k]);
            if (at.z != 0 && holds(at.x / at.z, at.y / at.z)) return true;
        }
    return false;
}

void expectRightPlaces(const Scene& scene, const CellSpace& space, const Shapes& shapes, const ObjectCells& found,
                       double margin, uint64_t seed) {
    Random random(seed);
    for (size_t i = 0; i < found.places.size(); ++i) {
        const SceneObject& object = scene.objects[found.object_of[i]];
        const Mesh& mesh = scene.meshes[object.mesh];
        std::vector<glm::dvec3> corners;
        for (const uint32_t index : mesh.indices)
            corners.push_back(glm::dvec3(object.transform * glm::dvec4(glm::dvec3(mesh.positions[index]), 1)));
        const std::span<const uint32_t> in = found.places.cellsOf(i);
        for (size_t t = 0; t < corners.size(); t += 3)
            for (int k = 0; k < 3; ++k) {
                double s = random.uniform(), r = random.uniform();
                if (s + r > 1) s = 1 - s, r = 1 - r;
                const glm::dvec3 p = corners[t] + s * (corners[t + 1] - corners[t]) + r * (corners[t + 2] - corners[t]);
                bool in_some = false;
                for (uint32_t cell = 0; cell < shapes.planes.size(); ++cell) {
                    if (cell == space.outside || depthBelow(shapes.planes[cell], p) > margin) continue;
                    ASSERT_TRUE(std::binary_search(in.begin(), in.end(), cell)) << i << " in " << cell;
                    in_some = true;
                }
                if (!in_some && space.outside != CellGraph::kNoCell) {
                    ASSERT_TRUE(std::binary_search(in.begin(), in.end(), space.outside)) << i;
                }
            }
        for (const uint32_t cell : in) {
            if (cell == space.outside) continue;
            bool near = false;
            for (size_t t = 0; t < corners.size() && !near; t += 3)
                near = touches(shapes.planes[cell], {corners.data() + t, 3}, margin + 1e-6);
            ASSERT_TRUE(near) << i << " in " << cell;
        }
        EXPECT_EQ(found.places.everywhere[i], in.empty());
        if (space.outside == CellGraph::kNoCell) continue;
        bool inside = false;  // of one cell, with room to spare
        for (const uint32_t cell : in)
            inside = inside || (cell != space.outside && std::all_of(corners.begin(), corners.end(), [&](glm::dvec3 p) {
                                    return depthBelow(shapes.planes[cell], p) < -margin - 1e-6;
                                }));
        EXPECT_FALSE(inside && std::binary_search(in.begin(), in.end(), space.outside)) << i;
    }
}

/// Triangles here and there, some of them in planes of the cells, some large, some no more than a point.
Scene strewn(size_t count, const std::vector<glm::dvec4>& planes, uint64_t seed) {
    Random random(seed);
    const auto point = [&] {
        return glm::dvec3(random.uniform(-0.2, 1.2), random.uniform(-0.2, 1.2), random.uniform(-0.2, 1.2));
    };
    Scene scene;
    scene.materials.emplace_back();
    for (size_t i = 0; i < count; ++i) {
        Mesh& mesh = scene.meshes.emplace_back();
        const double size = i % 4 == 0 ? 1 : i % 4 == 1 ? 0 : 0.05;
        for (size_t k = 0; k < 3 * (1 + i % 3); ++k) {
            glm::dvec3 p = glm::mix(k % 3 == 0 ? point() : glm::dvec3(mesh.positions[k / 3 * 3]), point(), size);
            if (i % 5 == 0 && !planes.empty()) {  // in a plane, as floats are
                const glm::dvec4& plane = planes[i % planes.size()];
                p -= (glm::dot(glm::dvec3(plane), p) + plane.w) * glm::dvec3(plane);
            }
            mesh.positions.emplace_back(p);
            mesh.indices.push_back(static_cast<uint32_t>(k));
            mesh.bounds.grow(glm::dvec3(mesh.positions.back()));
        }
        mesh.primitives = {{0, static_cast<uint32_t>(mesh.triangles()), 0}};
        SceneObject& object = scene.objects.emplace_back();
        object.key = 1000 - i / 2;
        object.mesh = static_cast<uint32_t>(i);
        if (i % 3 == 0) object.transform[3] = glm::dvec4(0.1, -0.1, 0.05, 1);
    }
    return scene;
}

LeafTree randomTree(uint32_t nodes, uint64_t seed) {
    Random random(seed);
    LeafTree tree;
    tree.bounds = {glm::dvec3(-4), glm::dvec3(5)};
    const auto leaf = [&] {
        tree.contents.push_back(random.below(4) == 0 ? LeafContents::kSolid : LeafContents::kEmpty);
        return LeafTreeNode::kLeaf | static_cast<uint32_t>(tree.contents.size() - 1);
    };
    while (tree.nodes.size() < nodes) {
        LeafTreeNode node;
        glm::dvec3 normal(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
        if (random.below(2) == 0) normal = glm::dvec3(random.below(2) == 0, 0, 1);
        normal = glm::normalize(normal);
        node.plane =
            glm::dvec4(normal, -glm::dot(normal, glm::dvec3(random.uniform(), random.uniform(), random.uniform())));
        node.child[0] = leaf();
        node.child[1] = leaf();
        if (!tree.nodes.empty()) {
            LeafTreeNode& parent = tree.nodes[random.below(tree.nodes.size())];
            const uint64_t side = random.below(2);
            if ((parent.child[side] & LeafTreeNode::kLeaf) == 0) continue;
            parent.child[side] = static_cast<uint32_t>(tree.nodes.size());
        }
        tree.nodes.push_back(node);
    }
    return tree;
}

TEST(ObjectCells, OfATreeAreThoseThatTheirPointsLieIn) {
    for (const uint32_t nodes : {0, 1, 5, 40})
        for (const double margin : {0.0, 0.01}) {
            SCOPED_TRACE(testing::Message() << nodes << " nodes, margin " << margin);
            CellSpace space;
            space.tree = randomTree(nodes, nodes + 3);
            if (nodes == 0) space.tree.contents = {LeafContents::kEmpty};
            space.graph = cellsOfTree(space.tree);
            std::vector<glm::dvec4> planes;
            for (const LeafTreeNode& node : space.tree.nodes) planes.push_back(node.plane);
            const Scene scene = strewn(200, planes, nodes);
            ObjectCellSettings settings;
            settings.margin = margin;
            const ObjectCells found = cellsOfObjects(scene, space, settings);
            ASSERT_EQ(found.places.size(), scene.objects.size());
            expectRightPlaces(scene, space, shapesOfTree(space), found, margin, 5);
        }
}

TEST(ObjectCells, OfRegionsAreThoseThatTheirPointsLieIn) {
    for (const double tolerance : {0.0, 0.06, -0.003, -0.06}) {
        const bool with_outside = tolerance < 0;
        CellSpace space;
        const std::vector<Box3d> boxes = {
            {{0, 0, 0}, {0.5, 1, 1}}, {{0.5, 0, 0}, {1, 1, 0.5}}, {{0.6, 0.2, 0.5}, {1, 1, 1}}};
        for (const Box3d& box : boxes) {
            CellRegion region{.first_plane = static_cast<uint32_t>(space.planes.size()), .bounds = box};
            for (int axis = 0; axis < 3; ++axis)
                for (const double sign : {1.0, -1.0}) {
                    glm::dvec4 plane(0.0);
                    plane[axis] = sign;
                    plane.w = sign > 0 ? -box.min[axis] : box.max[axis];
                    space.planes.push_back(plane);
                }
            region.plane_count = 6;
            if (space.regions.empty()) {  // one that is no box
                space.planes.emplace_back(glm::normalize(glm::dvec3(-1, -1, 0)), 0.9);
                ++region.plane_count;
            }
            space.regions.push_back(region);
        }
        if (with_outside) {
            space.outside = static_cast<uint32_t>(space.regions.size());
            space.regions.emplace_back();
        }
        space.graph.cells = static_cast<uint32_t>(space.regions.size());
        space.tolerance = std::abs(tolerance);
        const Scene scene = strewn(400, space.planes, 9);
        const ObjectCells found = cellsOfObjects(scene, space);
        ASSERT_EQ(found.places.size(), scene.objects.size());
        expectRightPlaces(scene, space, shapesOfRegions(space), found, space.tolerance, 6);
        EXPECT_EQ(found.everywhere > 0, !with_outside);
        EXPECT_EQ(found.outside > 0, with_outside);
    }
}

TEST(ObjectCells, OfABuildingAreThoseThatTheirPointsLieIn) {
    const Scene scene = *makeProcedural("building:2:2");
    SceneCellSettings trusted;
    trusted.trusted = true;
    const CellSpace space = cellsOfScene(scene, trusted).space;
    const ObjectCells found = cellsOfObjects(scene, space);
    ASSERT_EQ(found.places.size(), scene.objects.size());
    EXPECT_LE(found.everywhere, 2u);
    expectRightPlaces(scene, space, shapesOfRegions(space), found, space.tolerance, 7);
}

TEST(ObjectCells, AreTheSameForAnyThreadsAndInTheOrderOfKeys) {
    CellSpace space;
    space.tree = randomTree(30, 2);
    space.graph = cellsOfTree(space.tree);
    const Scene scene = strewn(500, {}, 3);
    const ObjectCells alone = cellsOfObjects(scene, space);
    ThreadPool pool(4);
    ObjectCellSettings settings;
    settings.jobs = &pool;
    const ObjectCells shared = cellsOfObjects(scene, space, settings);
    EXPECT_EQ(alone.places.keys, shared.places.keys);
    EXPECT_EQ(alone.places.cells, shared.places.cells);
    EXPECT_EQ(alone.places.first_cell, shared.places.first_cell);
    EXPECT_EQ(alone.object_of, shared.object_of);
    EXPECT_TRUE(std::is_sorted(alone.places.keys.begin(), alone.places.keys.end()));
}

TEST(ObjectCells, LeaveOutWhatMovesAndPlaceWhatDeformsByItsBox) {
    CellSpace space;
    space.tree = randomTree(30, 4);
    space.graph = cellsOfTree(space.tree);
    Scene scene = strewn(20, {}, 5);
    const ObjectCells before = cellsOfObjects(scene, space);
    scene.meshes[4].deforms = true;
    scene.meshes[6].bounds = Box3d();
    ObjectCellSettings settings;
    settings.moves.assign(20, false);
    settings.moves[3] = settings.moves[8] = true;
    settings.walls = {4, 5};
    const ObjectCells after = cellsOfObjects(scene, space, settings);
    EXPECT_EQ(after.moving, 2u);
    EXPECT_EQ(after.unbounded, 1u);
    EXPECT_EQ(after.by_box, 1u);
    EXPECT_EQ(after.places.size(), 17u);
    for (size_t i = 0; i < after.places.size(); ++i) {
        const uint32_t object = after.object_of[i];
        EXPECT_EQ(after.places.wall[i], object == 4 || object == 5);
        EXPECT_TRUE(object != 3 && object != 8 && object != 6);
        const size_t was = static_cast<size_t>(std::find(before.object_of.begin(), before.object_of.end(), object) -
                                               before.object_of.begin());
        const auto now = after.places.cellsOf(i), then = before.places.cellsOf(was);
        if (object == 4) {
            EXPECT_TRUE(std::includes(now.begin(), now.end(), then.begin(), then.end()));
        } else {
            EXPECT_TRUE(std::ranges::equal(now, then));
        }
    }
}

}  // namespace
}  // namespace sightline
