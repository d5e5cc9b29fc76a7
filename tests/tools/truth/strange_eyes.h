// Places from which cells are hard to judge: in their portals, on their borders, against walls and inside of things.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "sightline/base/random.h"
#include "sightline/cells/cell_space.h"
#include "sightline/tools/scene/scene.h"
#include "tests/support/random.h"

namespace sightline::test {
using namespace tools;

/// Nothing, or up to half a unit to either side.
inline double aLittleAway(Random& random) {
    constexpr double kAway[] = {0.0, 1e-9, 1e-4, 0.02, 0.5};
    const double side = random.below(2) ? 1 : -1;
    return side * kAway[random.below(5)];
}

/// On a portal, or a little beside its plane.
/// @pre there are portals
inline glm::dvec3 eyeAtPortal(const CellGraph& graph, Random& random) {
    const CellPortal& portal = graph.portals[random.below(graph.portals.size())];
    const auto outline = graph.outline(portal);
    const size_t i = 1 + random.below(outline.size() - 2);
    const double u = random.uniform(), v = random.uniform() * (1 - u);
    const glm::dvec3 on = outline[0] + u * (outline[i] - outline[0]) + v * (outline[i + 1] - outline[0]);
    return on + aLittleAway(random) * glm::dvec3(portal.plane);
}

/// In the plane of one of a tree's nodes, or a little beside it.
/// @pre the tree has nodes
inline glm::dvec3 eyeAtBorder(const LeafTree& tree, const Box3d& bounds, Random& random) {
    const glm::dvec4 plane = tree.nodes[random.below(tree.nodes.size())].plane;
    const glm::dvec3 anywhere = bounds.center() + 0.5 * randomVector(random, bounds.size());
    const double off = glm::dot(plane, glm::dvec4(anywhere, 1)) - aLittleAway(random);
    return anywhere - off * glm::dvec3(plane);
}

/// A little beside a corner of a triangle.
inline glm::dvec3 eyeAtWall(const Scene& scene, Random& random) {
    const SceneObject& object = scene.objects[random.below(scene.objects.size())];
    const Mesh& mesh = scene.meshes[object.mesh];
    if (mesh.positions.empty()) return glm::dvec3(object.transform[3]);
    const glm::dvec4 corner(glm::dvec3(mesh.positions[random.below(mesh.positions.size())]), 1);
    return glm::dvec3(object.transform * corner) + aLittleAway(random) * randomUnit(random);
}

/// In the middle of an object's bounds.
inline glm::dvec3 eyeInside(const Scene& scene, Random& random) {
    const SceneObject& object = scene.objects[random.below(scene.objects.size())];
    return transformBox(scene.meshes[object.mesh].bounds, object.transform).center();
}

}  // namespace sightline::test
