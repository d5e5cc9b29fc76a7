// Cells with their places: rooms in a grid, trees of random planes, scenes that know their cells.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/bsp/tree_portals.h"
#include "sightline/cells/cell_space.h"
#include "sightline/tools/scene/scene.h"
#include "tests/bake/flow/cell_worlds.h"
#include "tests/bsp/leaf_tree_fixture.h"

namespace sightline::test {
using namespace tools;

inline void addRegion(CellSpace& space, const Box3d& box) {
    CellRegion region{.first_plane = static_cast<uint32_t>(space.planes.size()), .plane_count = 6, .bounds = box};
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec4 plane(0.0);
        plane[axis] = 1;
        plane.w = -box.min[axis];
        space.planes.push_back(plane);
        plane[axis] = -1;
        plane.w = box.max[axis];
        space.planes.push_back(plane);
    }
    space.regions.push_back(region);
}

inline CellSpace gridSpace(uint64_t seed, const RoomSettings& settings) {
    CellSpace space;
    space.graph = gridOfRooms(seed, settings);
    const int* n = settings.rooms;
    for (int z = 0; z < n[2]; ++z)
        for (int y = 0; y < n[1]; ++y)
            for (int x = 0; x < n[0]; ++x) {
                const glm::dvec3 low(x, y, z);
                addRegion(space,
                          {settings.origin + settings.size * low, settings.origin + settings.size * (low + 1.0)});
            }
    return space;
}

inline CellSpace treeSpace(LeafTree tree) {
    CellSpace space;
    TreePortalCounts counts;
    space.graph = cellsOfTree(tree, {}, &counts);
    space.tree = std::move(tree);
    space.tolerance = counts.tolerance;
    return space;
}

/// As the scene says, without a check.
inline CellSpace sceneSpace(const Scene& scene) {
    CellSpace space;
    space.graph.cells = static_cast<uint32_t>(scene.cells.size());
    for (const SceneCell& cell : scene.cells) {
        space.regions.push_back(
            {static_cast<uint32_t>(space.planes.size()), static_cast<uint32_t>(cell.planes.size()), cell.bounds});
        space.planes.insert(space.planes.end(), cell.planes.begin(), cell.planes.end());
        space.names.push_back(cell.name);
    }
    for (const ScenePortal& portal : scene.portals) {
        uint32_t door = CellPortal::kNone;
        if (portal.door != ~0u) {
            door = static_cast<uint32_t>(space.doors.size());
            space.doors.push_back({portal.name, scene.objects[portal.door].key});
        }
        space.graph.addPortal(portal.cells[0], portal.cells[1], portal.polygon, door);
    }
    return space;
}

}  // namespace sightline::test
