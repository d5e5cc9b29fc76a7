// Makes occluders from meshes: their hiding triangles in pairs, in clusters that hang together, with edges.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "sightline/geom/mesh_view.h"
#include "sightline/geom/occluder.h"
#include "sightline/prepare/occluder_source.h"

namespace sightline {

/// Prepares the given triangles as an occluder.
///
/// Keeps every triangle except those whose corners lie on a line or whose positions are not finite. Positions are kept
/// bit for bit (a negative zero becomes zero); nothing is welded by tolerance. Double-sided triangles may be turned, so
/// that neighbours wind the same way. Triangles that share an edge and make a convex, nearly flat quadrangle are
/// paired; with OccluderSettings::merge, larger polygons replace those of which they are made, exactly.
/// Three polygons or more that hang together by shared edges make joined clusters of their own; all others are gathered
/// in loose ones. O(n log n), and the same on every machine.
///
/// @param hides, double_sided  as in OccluderSource
Occluder prepareOccluder(const MeshView& mesh, std::span<const uint8_t> hides = {},
                         std::span<const uint8_t> double_sided = {}, const OccluderSettings& settings = {});

/// The same for meshes that are always drawn together, in one object space, wherever one of them is drawn: parts of one
/// thing that never moves against itself. Polygons hang together across meshes; with OccluderSettings::rings, no seam
/// stays open between two meshes that have the same edge, or parts of it. One occluder per mesh.
std::vector<Occluder> prepareOccluders(std::span<const OccluderSource> sources, const OccluderSettings& settings = {});

/// The same as one occluder, whose clusters take polygons of any of the meshes: for walls of many small panels.
Occluder prepareJoined(std::span<const OccluderSource> sources, const OccluderSettings& settings = {});

}  // namespace sightline
