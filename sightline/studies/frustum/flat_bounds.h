// Flat lists of bounds against view volumes, sixteen at a time: spheres, boxes, oriented boxes, k-DOPs; many volumes in one pass.
// SPDX-License-Identifier: MIT
//
// Daniel Collin. Culling the Battlefield. 2011.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "sightline/cull/bounds.h"
#include "sightline/cull/frustum.h"

namespace sightline::studies {

/// Spheres as one array per number, relative to one origin.
struct SphereArrays {
    const float* center[3];  ///< [size: count rounded up to 16]
    const float* radius;     ///< [size: count rounded up to 16]; holds the rounding of the centre, too
    size_t count = 0;
    glm::dvec3 origin{0.0};
    float reach = 0;  ///< no point of a sphere is farther from the origin on any axis
};

/// Oriented boxes as one array per number, relative to one origin.
struct OrientedBoxArrays {
    const float* center[3];   ///< [size: count rounded up to 16]
    const float* half[3][3];  ///< per axis of the box: its three coordinates  [size: count rounded up to 16]
    size_t count = 0;
    glm::dvec3 origin{0.0};
    float reach = 0;  ///< no point of a box is farther from the origin on any axis
};

/// 14-DOPs as one array per slab, relative to one origin.
struct DopArrays {
    const float* min[Dop::kSlabs];  ///< [size: count rounded up to 16]
    const float* max[Dop::kSlabs];  ///< [size: count rounded up to 16]
    size_t count = 0;
    glm::dvec3 origin{0.0};
    float reach = 0;  ///< no point of a DOP is farther from the origin on any axis
};

/// What a bound's mask is that shares no point with the volume.
inline constexpr uint32_t kOutsideMask = ~0u;

/// Writes for each bound kOutsideMask, or a bit per plane that it is not surely inside of: 0 of one that is inside.
/// Conservative as testBound(): what touches a plane, what rounding might place on it, and NaN, are kept. The margin grows
/// with `reach` and with the distance of the eye from the origin.
/// @param masks  [size: >= count rounded up to 16]
void testBounds(const ViewVolume& volume, const SphereArrays& spheres, std::span<uint32_t> masks);
void testBounds(const ViewVolume& volume, const BoxArrays& boxes, std::span<uint32_t> masks);
void testBounds(const ViewVolume& volume, const OrientedBoxArrays& boxes, std::span<uint32_t> masks);
void testBounds(const ViewVolume& volume, const DopArrays& dops, std::span<uint32_t> masks);

/// Writes the indices of the bounds that may touch the volume, in rising order, and returns how many.
/// @param kept  [size: >= count rounded up to 16]
size_t cullBounds(const ViewVolume& volume, const SphereArrays& spheres, std::span<uint32_t> kept);
size_t cullBounds(const ViewVolume& volume, const BoxArrays& boxes, std::span<uint32_t> kept);
size_t cullBounds(const ViewVolume& volume, const OrientedBoxArrays& boxes, std::span<uint32_t> kept);
size_t cullBounds(const ViewVolume& volume, const DopArrays& dops, std::span<uint32_t> kept);

/// As cullBounds() of boxes; then, of the boxes that cross a plane and have a side of at least `large`, leaves out those
/// that the refinement separates from the volume. With none of these it costs next to nothing.
/// @param large  [world units]
size_t cullBounds(const RefinedVolume& refined, const BoxArrays& boxes, Refinement refinement, float large,
                  std::span<uint32_t> kept);

/// Tests each box against several volumes (views, cascades, the faces of a cube) while it is in the registers: bit i of its
/// mask is set if it may touch volumes[i].
/// @param volumes  [size: <= 32]
/// @param masks    [size: >= count rounded up to 16]
void testVolumes(std::span<const ViewVolume> volumes, const BoxArrays& boxes, std::span<uint32_t> masks);

}  // namespace sightline::studies
