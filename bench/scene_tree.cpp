// The tree of names of a scene as a hierarchy of bounds: what a scene's author put together is culled together.
// SPDX-License-Identifier: MIT
#include "bench/scene_tree.h"

#include <algorithm>

namespace sightline::tools {
using namespace studies;
namespace {

/// Adds a name after those above it. `way` is scratch.
void addName(const Scene& scene, uint32_t name, SceneTree& tree, std::vector<uint32_t>& way) {
    constexpr uint32_t kNone = SceneTreeNode::kNone;
    way.clear();
    uint32_t above = name;
    while (above < scene.nodes.size() && tree.node_of_name[above] == kNone && way.size() <= scene.nodes.size()) {
        way.push_back(above);
        above = scene.nodes[above].parent;
    }
    if (way.size() > scene.nodes.size()) {  // a circle
        way.resize(1);
        above = kNone;
    }
    uint32_t parent = above < scene.nodes.size() ? tree.node_of_name[above] : kNone;
    for (; !way.empty(); way.pop_back()) {
        tree.nodes.push_back({parent, glm::dmat4(1.0)});
        parent = static_cast<uint32_t>(tree.nodes.size() - 1);
        tree.node_of_name[way.back()] = parent;
    }
}

}  // namespace

SceneTree sceneTree(const Scene& scene) {
    SceneTree tree;
    tree.node_of_name.assign(scene.nodes.size(), SceneTreeNode::kNone);
    std::vector<uint32_t> way;
    for (uint32_t name = 0; name < scene.nodes.size(); ++name) addName(scene, name, tree, way);
    for (const SceneObject& object : scene.objects) {
        const bool named = object.node < scene.nodes.size();
        tree.items.push_back({static_cast<uint32_t>(tree.nodes.size()), scene.meshes[object.mesh].bounds});
        tree.nodes.push_back({named ? tree.node_of_name[object.node] : SceneTreeNode::kNone, object.transform});
    }
    return tree;
}

}  // namespace sightline::tools
