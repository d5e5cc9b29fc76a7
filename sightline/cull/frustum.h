// Keeps the boxes that may touch a view frustum: eight children of a tree node at once, or a flat list.
// SPDX-License-Identifier: MIT
//
// Ulf Assarsson, Tomas Moller. Optimized View Frustum Culling Algorithms for Bounding Boxes. 2000.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "sightline/base/assert.h"
#include "sightline/geom/frustum.h"
#include "sightline/geom/view_volume.h"
#include "sightline/tree/bvh.h"

namespace sightline {

/// Eight boxes relative to the eye, in float: each bound is wrong by at most 2^-23 of itself.
struct EyeBoxes {
    alignas(64) float min[3][8];
    alignas(64) float max[3][8];
};

/// One of them.
inline Box3f boxOf(const EyeBoxes& boxes, int which) {
    SIGHTLINE_DEBUG_ASSERT(which >= 0 && which < 8);
    return {{boxes.min[0][which], boxes.min[1][which], boxes.min[2][which]},
            {boxes.max[0][which], boxes.max[1][which], boxes.max[2][which]}};
}

/// The children of a node as the eye sees them.
/// @param offset  tree origin - eye [world units]
EyeBoxes eyeBoxes(const BvhNode& node, const glm::dvec3& offset);
/// The same of any eight boxes.
EyeBoxes eyeBoxes(const float (&min)[3][8], const float (&max)[3][8], const glm::dvec3& offset);

/// Where eight boxes lie relative to the planes of a frustum or of a volume.
struct FrustumAnswer {
    uint32_t outside = 0;  ///< bit per box: surely outside some plane
    uint32_t planes[8];    ///< per box: bit per plane that it is not surely inside of
};

/// Tests boxes against the planes named in `active`; planes that hold a parent wholly need not be asked again.
/// A box that touches a plane, or that rounding might place on it, is kept; so is a NaN.
FrustumAnswer testFrustum(const Frustum& frustum, const EyeBoxes& boxes, uint32_t active);
/// The same for a volume, which must be relative to the same eye.
FrustumAnswer testViewVolume(const ViewVolume& volume, const EyeBoxes& boxes, uint32_t active);

/// Bit per box that is surely outside of one of the planes, which are relative to the eye and of unit length.
uint32_t outsideAny(std::span<const glm::dvec4> planes, const EyeBoxes& boxes);

/// Boxes as one array per bound, relative to one origin.
struct BoxArrays {
    const float* min[3];  ///< [size: count rounded up to 16]
    const float* max[3];  ///< [size: count rounded up to 16]
    size_t count = 0;
    glm::dvec3 origin{0.0};
    float reach = 0;  ///< no bound is farther from the origin on any axis
};

/// Writes the indices of the boxes that may touch the frustum, in rising order, and returns how many.
/// Conservative as testFrustum(); the margin grows with the distance of the eye from the origin.
/// @param kept  [size: >= count rounded up to 16]
size_t cullFrustum(const Frustum& frustum, const BoxArrays& boxes, std::span<uint32_t> kept);

}  // namespace sightline
