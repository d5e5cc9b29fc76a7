// The hierarchy of a scene's names: every object in its place, whatever the names look like.
// SPDX-License-Identifier: MIT
#include "bench/scene_tree.h"

#include <gtest/gtest.h>

#include "sightline/math/round_outward.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/city/city.h"

namespace sightline {
using namespace studies;
using namespace tools;
namespace {

void expectPlaced(const Scene& scene) {
    const SceneTree tree = sceneTree(scene);
    ASSERT_EQ(tree.nodes.size(), scene.nodes.size() + scene.objects.size());
    for (uint32_t i = 0; i < tree.nodes.size(); ++i)
        ASSERT_TRUE(tree.nodes[i].parent == SceneTreeNode::kNone || tree.nodes[i].parent < i);
    for (size_t name = 0; name < scene.nodes.size(); ++name) {
        const uint32_t parent = scene.nodes[name].parent, in_tree = tree.nodes[tree.node_of_name[name]].parent;
        ASSERT_EQ(in_tree, parent < scene.nodes.size() ? tree.node_of_name[parent] : SceneTreeNode::kNone);
    }
    NodeTree bounds;
    bounds.build(tree.nodes, tree.items);
    for (uint32_t i = 0; i < scene.objects.size(); ++i) {
        const SceneObject& object = scene.objects[i];
        const Box3f wanted =
            relativeBox(transformBox(scene.meshes[object.mesh].bounds, object.transform), glm::dvec3(0.0));
        ASSERT_EQ(bounds.storedBox(i).min, wanted.min) << i;
        ASSERT_EQ(bounds.storedBox(i).max, wanted.max) << i;
    }
}

TEST(SceneTree, HasEveryObjectInItsPlace) {
    const Scene building = makeBuilding(1, 2);
    ASSERT_GT(building.nodes.size(), 10u);
    expectPlaced(building);
    expectPlaced(makeCity(1, 2000));
}

TEST(SceneTree, TakesNamesInAnyOrderAndCutsCircles) {
    Scene scene;
    scene.meshes.resize(1);
    scene.meshes[0].bounds = {glm::dvec3(0.0), glm::dvec3(1.0)};
    scene.nodes = {{"leaf", 2}, {"top", SceneNode::kNone}, {"middle", 1}, {"astray", 77}};
    scene.objects.resize(4);
    for (uint32_t i = 0; i < 4; ++i) {
        scene.objects[i].node = i;
        scene.objects[i].transform[3].x = 10.0 * i;
    }
    expectPlaced(scene);
    scene.nodes = {{"a", 1}, {"b", 2}, {"c", 0}, {"beside", 1}};
    const SceneTree tree = sceneTree(scene);
    uint32_t tops = 0;
    for (uint32_t i = 0; i < tree.nodes.size(); ++i) {
        ASSERT_TRUE(tree.nodes[i].parent == SceneTreeNode::kNone || tree.nodes[i].parent < i);
        tops += tree.nodes[i].parent == SceneTreeNode::kNone;
    }
    EXPECT_EQ(tops, 1u) << "the circle is cut in one place";
    EXPECT_EQ(tree.nodes.size(), 8u);
}

}  // namespace
}  // namespace sightline
