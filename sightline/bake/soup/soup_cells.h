// Cells and portals of any polygons: the leaves of a tree of their own planes, and all of its faces that no wall covers.
// SPDX-License-Identifier: MIT
//
// Seth Teller. Visibility Computations in Densely Occluded Polyhedral Environments. 1992.
#pragma once

#include "sightline/bake/soup/soup_report.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::bake {
using namespace tools;

/// Divides a scene without marks into convex cells. A sight line that leaves a cell either meets a drawn, opaque front or
/// passes a portal, whatever the polygons are: one-sided, open, turned round, doubled, through one another. Which planes
/// divide and how tight they are never makes it wrong: where no wall is known there is a portal.
///
/// The argument. Leaves fill space, so a sight line that goes from leaf to leaf crosses a face, which lies in a node's
/// plane. Think of the boundary between the leaves as bent through the triangles that lie in that plane to within half of
/// their rounding. Of a face, the portal from A to B is what is left of it once those triangles are taken away whose
/// fronts A sees; a line that crosses elsewhere has met such a front. Triangles are grown by a third of that
/// before, and a strip as wide as that along the edges of a face counts as the neighbour's wall, for sheets that meet do
/// not do so bit for bit: so holes narrower than that are closed. Portals are widened by the smallest of the walls
/// beside them, and what is as
/// close to a plane belongs to both sides.
///
/// O(triangles * log) for a tree, and for faces their number times the triangles of their planes that are near.
SoupCells cellsOfSoup(const Scene& scene, const SoupCellSettings& settings = {});

}  // namespace sightline::bake
