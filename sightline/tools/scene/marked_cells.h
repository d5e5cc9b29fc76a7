// Cells and portals that a file's maker marked: from shapes, and which belongs to which.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/math/box.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// The cell whose planes are those of a solid's triangles, whichever way they wind. A shape that is no solid, or has more than
/// 128 planes, gives a cell without planes and of infinite overhang. O(triangles * planes).
/// @param points   in the world  [finite]
/// @param corners  three points for each triangle  [limit: < points]
SceneCell cellOfShape(std::string name, std::span<const glm::dvec3> points, std::span<const uint32_t> corners);

/// The cell of a box carried through an affine transform; without planes if that leaves no volume.
SceneCell cellOfBox(std::string name, const Box3d& box, const glm::dmat4& transform);

/// The outline of points that lie in a plane, or nearly: their hull as seen along the normal. With fewer than three points if
/// they have no area.
/// @param corners  as above; none: the points are an outline in its order
std::vector<glm::dvec3> outlineOfShape(std::span<const glm::dvec3> points, std::span<const uint32_t> corners);

/// Finds for portals what is still kNone: their cells and doors by name; and the cells of those without a name by where they
/// lie: between the nearest cells before and behind them that have a face there, no farther than a twentieth of the
/// cell's diagonal. Turns outlines so that they run counter-clockwise as seen from cells[0]. What is not found stays
/// kNone, for another file may have it.
void resolvePortals(Scene& scene);

}  // namespace sightline::tools
