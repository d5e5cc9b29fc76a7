// How far two triangle surfaces are apart at most: an upper bound of their Hausdorff distance, proved and tight.
// SPDX-License-Identifier: MIT
//
// Nicolas Aspert, Diego Santa-Cruz, Touradj Ebrahimi. MESH: Measuring Errors between Surfaces using the Hausdorff
// Distance. 2002.
// Michael Guthe, Pavel Borodin, Reinhard Klein. Fast and Accurate Hausdorff Distance Calculation between Meshes. 2005.
// Min Tang, Minkyoung Lee, Young J. Kim. Interactive Hausdorff Distance Computation for General Polygonal Models. 2009.
#pragma once

#include <cstdint>

#include "sightline/geom/mesh_view.h"
#include "sightline/prepare/lod/distance_surface.h"

namespace sightline {

/// How near the bounds are to come to one another, and what that may take.
struct DistanceLimits {
    double relative = 0.05;  ///< of the lower bound  [limit: >= 0]
    double absolute = 1e-6;  ///< of the diagonal of the box around both surfaces  [limit: >= 0]
    /// Cuts that may be made, for each triangle of both surfaces and 1000 more. Where they do not suffice, the upper
    /// bound is larger.
    uint32_t cuts = 64;
};

/// Bounds of the two-sided Hausdorff distance: the largest distance of a point of one surface from the nearest point of
/// the other one.
struct SurfaceDistance {
    double lower = 0;   ///< some point of one surface is no nearer to the other
    double upper = 0;   ///< each point of either surface is within so much of the other
    uint64_t cuts = 0;  ///< that were made; a cut takes one to three microseconds
};

/// lower <= the distance <= upper, rounding included, whatever the limits are. Unless the cuts run out,
/// upper <= (1 + relative) * lower + absolute * diagonal, but for rounding (2^-39 of the largest coordinate).
///
/// Surfaces of the same triangles have the distance 0, exactly. Triangles may be points or segments. Infinite, both, if
/// a triangle is not finite or if just one of the surfaces is empty.
///
/// The distance from one convex triangle is a convex function of the place. So over a piece of the other surface it is
/// largest in a corner of the piece, and the least such maximum over several triangles bounds the distance of the whole
/// piece. Pieces with the largest bounds are cut first, where two triangles are equally near, until the largest bound
/// is little above the distance of a point that was met on the way.
///
/// O(n log n) for surfaces that are alike; deterministic.
SurfaceDistance surfaceDistance(const DistanceSurface& a, const DistanceSurface& b, const DistanceLimits& limits = {});

/// The same, of meshes whose surfaces are measured just once.
SurfaceDistance surfaceDistance(const MeshView& a, const MeshView& b, const DistanceLimits& limits = {});

}  // namespace sightline
