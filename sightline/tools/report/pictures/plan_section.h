// What a plan shows at the height of the eye: walls where they are cut, cells, and the portals between them.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/cells/cell_space.h"
#include "sightline/math/box.h"
#include "sightline/tools/report/pictures/plan.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// The lines in which the triangles of a scene meet the horizontal plane at a height, of the objects that the plan shows.
/// @param bounds  of the objects, world space  [size: Scene::objects]
std::vector<PlanLine> wallsAt(const Scene& scene, std::span<const Box3d> bounds, const PlanArea& area, double height);

/// Cells and portals as a plan shows them.
struct PlanCells {
    std::vector<std::vector<glm::dvec4>> regions;  ///< the planes of each, pointing inward; none of cells of a tree
    std::vector<std::vector<glm::dvec3>> portals;  ///< outlines
};
PlanCells planCells(const Scene& scene);
PlanCells planCells(const CellSpace& space);

/// The borders of the cells at a height, as far as they lie near the plan.
std::vector<PlanLine> cellsAt(const PlanCells& cells, const PlanArea& area, double height);

/// What of a leaf of a tree lies at a height: a convex outline in x and z.
struct LeafAt {
    uint32_t leaf = 0;
    std::vector<glm::dvec2> outline;
};
/// The leaves at a height, as far as they lie in the plan.
std::vector<LeafAt> leavesAt(const LeafTree& tree, const PlanArea& area, double height);

/// The portals at a height.
std::vector<PlanLine> portalsAt(const PlanCells& cells, double height);

}  // namespace sightline::tools
