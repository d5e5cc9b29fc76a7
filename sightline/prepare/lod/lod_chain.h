// Makes a chain of coarser levels of a mesh, each with the proved error that it has against the mesh itself.
// SPDX-License-Identifier: MIT
//
// Michael Garland, Paul Heckbert. Surface Simplification Using Quadric Error Metrics. 1997.
// David Luebke, Martin Reddy, Jonathan Cohen, Amitabh Varshney, Benjamin Watson, Robert Huebner. Level of Detail for 3D
// Graphics. 2002.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/base/memory.h"
#include "sightline/geom/lod_chain.h"
#include "sightline/geom/mesh_view.h"
#include "sightline/prepare/facing/draw_clusters.h"
#include "sightline/prepare/lod/surface_distance.h"

namespace sightline {

/// How far a mesh is made simpler.
struct LodChainSettings {
    uint32_t levels = kMostLods;     ///< at most, with the mesh itself  [limit: 1 to kMostLods]
    double share = 0.5;              ///< of the last level's triangles that the next one is to have  [limit: > 0, < 1]
    double least_saving = 0.2;       ///< of the last level's triangles; a level that saves less ends the chain
    uint32_t fewest_triangles = 12;  ///< a level with fewer has no next one
    double most_error = 0.25;        ///< of the diagonal of the mesh's box; a level with more ends the chain
    /// Goes on where collapsing edges saves too little, by merging what lies near together. That keeps neither holes
    /// nor borders between parts: for what is far away.
    bool sloppy = false;
    DistanceLimits distance;  ///< how exactly the errors are known
};

/// Each level has about half as many triangles as the one before. Its error is SurfaceDistance::upper against the
/// mesh's own triangles: no point of the level is farther from the mesh, and none of the mesh from the level. It says
/// nothing of normals, colours, texture coordinates, nor of which part lies where.
///
/// Vertices in one place are one vertex while edges are collapsed, so that surfaces which are cut along seams of
/// normals or texture coordinates hang together. A level's corners get vertices of their part again: in a place that
/// has several, the one whose own triangles lie most like the new one. A seam between two textures may be crossed.
///
/// Parts are made simpler one by one, to the same error. A part that has places in common with another keeps its open
/// borders as they are in all levels. So no gap opens where border meets border, and what is made of many small parts
/// that touch does not become simple.
///
/// A level is left out if the next one that stays has no larger error, as far as errors are known (`distance`): a plane
/// has one coarser level. A mesh with a triangle that is not finite has no coarser level. Vertices that no part names
/// do not count.
///
/// O(n log n) a level; deterministic. docs/techniques/lod.md says how long it takes.
/// @param parts  do not overlap; none: one part of all triangles
LodChain makeLods(const MeshView& mesh, std::span<const MeshPart> parts = {}, const LodChainSettings& settings = {},
                  Memory* memory = defaultMemory());

}  // namespace sightline
