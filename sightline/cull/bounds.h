// One bound against one view volume: spheres, boxes, oriented boxes and k-DOPs, with masks, and exactly where that is asked for.
// SPDX-License-Identifier: MIT
//
// Ulf Assarsson, Tomas Moller. Optimized View Frustum Culling Algorithms for Bounding Boxes. 2000.
// Stefan Gottschalk, Ming Lin, Dinesh Manocha. OBBTree: A Hierarchical Structure for Rapid Interference Detection. 1996.
// James Klosowski, Martin Held, Joseph Mitchell, Henry Sowizral, Karel Zikan. Efficient Collision Detection Using Bounding
// Volume Hierarchies of k-DOPs. 1998.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "sightline/geom/view_volume.h"
#include "sightline/math/box.h"

namespace sightline {

/// How much is asked of bounds that the planes of a view volume keep.
enum class Refinement : uint8_t {
    kNone,
    kCorners,         ///< all corners of the volume are beyond one face of the bound
    kSeparatingAxes,  ///< also planes along one edge of each: exact for boxes, apart from rounding
};

struct Sphere {
    glm::dvec3 center{0.0};
    double radius = 0.0;  ///< [world units, >= 0]
};

/// A box of any orientation. The axes need not be orthogonal: any parallelepiped will do.
struct OrientedBox {
    glm::dvec3 center{0.0};
    glm::dvec3 half[3] = {};  ///< from the centre to the middle of three faces  [world units]
};

/// The box that an object's own box becomes in the world; holds it up to rounding.
OrientedBox orientedBox(const Box3d& box, const glm::dmat4& transform);

/// A box with its eight corners cut: seven slabs (a 14-DOP). The diagonals are sums of coordinates, not of unit length.
struct Dop {
    static constexpr int kSlabs = 7;
    static constexpr glm::dvec3 kDirections[kSlabs] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1}, {1, 1, 1},
                                                       {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};
    double min[kSlabs];
    double max[kSlabs];

    Dop();  ///< empty
    void grow(const glm::dvec3& point);
};

/// Where a bound lies relative to a volume.
struct BoundAnswer {
    bool outside = false;  ///< it surely shares no point with the volume
    uint32_t planes = 0;   ///< bit per plane that it is not surely inside of; 0, if it is not outside: it is inside

    bool inside() const { return !outside && planes == 0; }
    bool crossing() const { return !outside && planes != 0; }
};

/// Tests a bound against the planes named in `active`; planes that hold a parent wholly need not be asked again. A
/// bound is kept if it touches a plane, if rounding might place it there, or if it is not finite. A bound beyond the
/// common edge of two planes, or beyond a corner, may be kept as well: the refinements below remove it.
BoundAnswer testBound(const ViewVolume& volume, const Sphere& sphere, uint32_t active = ~0u);
BoundAnswer testBound(const ViewVolume& volume, const Box3d& box, uint32_t active = ~0u);
BoundAnswer testBound(const ViewVolume& volume, const OrientedBox& box, uint32_t active = ~0u);
BoundAnswer testBound(const ViewVolume& volume, const Dop& dop, uint32_t active = ~0u);

/// How far a point is from the volume; 0 inside. It is the largest distance that one, two or three planes together
/// prove, which is exact apart from rounding. A sphere is outside if the distance exceeds its radius. O(planes^3) for a
/// point outside.
double distanceTo(const ViewVolume& volume, const glm::dvec3& point);

/// True if the sphere shares no point with the volume: exact, beyond edges and corners too.
bool surelyOutside(const ViewVolume& volume, const Sphere& sphere);

/// True if the refinement proves that the box shares no point with the volume. It is exact with kSeparatingAxes, if the
/// volume has an inside. It does not ask the planes of the volume. Each call sets up the axes: meant for a few large
/// bounds.
bool separated(const ViewVolume& volume, const OrientedBox& box, Refinement refinement);

/// Planes that hold a volume, found at once for all boxes along the axes of the world: they separate the boxes that the
/// volume's own planes do not.
struct RefinedVolume {
    static constexpr uint32_t kMostCrossed = 72;

    ViewVolume volume;
    glm::dvec4 axes[6];  ///< across the axes: the volume's corners against a box's faces
    uint32_t axis_count = 0;
    glm::dvec4 crossed[kMostCrossed];  ///< along an edge of the volume and one of the box
    uint32_t crossed_count = 0;
};

/// O(planes^3); about 10 us for six planes, and a fifth of that for kCorners, which has no use for `crossed`.
RefinedVolume refineVolume(const ViewVolume& volume, Refinement refinement = Refinement::kSeparatingAxes);

/// As above, for a box along the axes.
bool separated(const RefinedVolume& refined, const Box3d& box, Refinement refinement);

}  // namespace sightline
