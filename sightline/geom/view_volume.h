// Convex view volumes: frusta of any matrix, portal windows, section planes, two eyes, and what all of them have in common.
// SPDX-License-Identifier: MIT
//
// Gil Gribb, Klaus Hartmann. Fast Extraction of Viewing Frustum Planes from the World-View-Projection
// Matrix. 2001.
#pragma once

#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "sightline/geom/clip_space.h"
#include "sightline/geom/frustum.h"

namespace sightline {

/// All points on the inner side of every plane. Planes are relative to `eye` as a Frustum's are: normals inward and of
/// unit length, dot(n, p - eye) + d >= 0 inside. Without planes it holds everything.
struct ViewVolume {
    static constexpr uint32_t kMostPlanes = 31;

    glm::dvec3 eye{0.0};
    glm::dvec4 planes[kMostPlanes];
    uint32_t count = 0;
    bool empty = false;  ///< it holds no point, whatever the planes say

    /// A bit per plane.
    uint32_t allPlanes() const { return (1u << count) - 1; }
};

/// The frustum of any matrix: perspective or parallel, off-centre, mirrored, with an oblique near plane, with a far plane
/// at infinity. A plane that the matrix does not have, or that is not finite, is left out.
/// @param clip   from positions relative to `eye` to clip space
/// @param eye    what the planes are relative to; near the volume, for precision  [world units]
/// @param space  its depth, and by `reversed` alone Frustum::side; the planes do not depend on the rest
Frustum frustumOfMatrix(const glm::dmat4& clip, const glm::dvec3& eye, const ClipSpace& space = {});

ViewVolume volumeOf(const Frustum& frustum);

/// The volume of any matrix, as frustumOfMatrix(); empty if a plane without direction has nothing on its inner side.
ViewVolume volumeOfMatrix(const glm::dmat4& clip, const glm::dvec3& eye, const ClipSpace& space = {});

/// The plane through three points, dot(n, p) + d, towards those that see them counter-clockwise. Zero if they are in a
/// line.
glm::dvec4 planeOfPoints(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

/// What an eye sees through a convex window: the pyramid of the eye and the window's edges, with the part before the
/// window cut off on request. An eye in the window's plane, or a window without area, gives a volume without planes: it
/// holds everything. So does, for its own plane, an edge that has corners on both sides (the window is not convex), and
/// every corner beyond the 30th.
/// @param window  corners in either order of turn  [world units]
ViewVolume volumeOfWindow(const glm::dvec3& eye, std::span<const glm::dvec3> window, bool behind_window);

/// Keeps what is on the inner side of a plane, too.
/// @param plane  dot(n, p) + d >= 0 inside, of any length, positions in the world. Not finite, or without direction:
///               ignored, unless nothing is on its inner side
/// @returns false if there was no room: the volume then holds more than it should
bool addPlane(ViewVolume& volume, const glm::dvec4& plane);

/// Keeps what is in another volume, too; equal planes count once.
/// @returns false if there was no room for all planes: the volume then holds more than it should
bool intersect(ViewVolume& volume, const ViewVolume& other);

/// The same volume, relative to another point.
ViewVolume relativeTo(const ViewVolume& volume, const glm::dvec3& eye);

/// The tightest plane of a given normal that holds the volume, from those that weighted sums of three of its planes
/// give: for a volume with corners, that is the plane that touches it. False if the volume has no end that way.
/// O(planes^3).
/// @param normal  of any length
/// @param plane   relative to the volume's eye; its normal may differ from what was asked for by 1e-12
bool supportPlane(const ViewVolume& volume, const glm::dvec3& normal, glm::dvec4& plane);

/// True if it is certain that the volume holds no point. Volumes that are flat, or nearly so, are not proved empty.
bool provedEmpty(const ViewVolume& volume);

/// A volume that holds two others: for views of two eyes that are culled in one pass. Parallel eyes with the same
/// projection give six planes; canted ones more. O(planes^4).
ViewVolume volumeOfBoth(const ViewVolume& left, const ViewVolume& right);

/// Planes that share an edge of a volume.
struct PlanePair {
    uint8_t first = 0, second = 0;
};

/// Writes the pairs of planes that share an edge, or might share one, and returns how many.
/// @param edges  further ones are left out where it is full
uint32_t edgesOf(const ViewVolume& volume, std::span<PlanePair> edges);

}  // namespace sightline
