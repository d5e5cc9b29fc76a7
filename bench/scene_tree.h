// The tree of names of a scene as a hierarchy of bounds: what a scene's author put together is culled together.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/studies/frustum/node_tree.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {
using namespace studies;

/// What NodeTree::build() takes. Names stand where the world does: they have no transforms of their own. Each object has a
/// node of its own below its name, placed by its transform; item i is object i.
struct SceneTree {
    std::vector<SceneTreeNode> nodes;
    std::vector<SceneTreeItem> items;
    std::vector<uint32_t> node_of_name;  ///< per node of the scene
};

/// A name whose parents go in a circle, or whose parent is none of the scene's, hangs in the world.
SceneTree sceneTree(const Scene& scene);

}  // namespace sightline::tools
