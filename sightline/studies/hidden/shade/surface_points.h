// Where a sample's line of sight meets the surface that the sample shows.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "sightline/studies/hidden/draw_item.h"
#include "sightline/studies/hidden/shade/unprojection.h"

namespace sightline::studies {

/// A point of a triangle, relative to the eye, with the world's axes.
struct SurfacePoint {
    glm::dvec3 position{0.0};
    glm::dvec3 normal{0.0};   ///< of the triangle, towards the eye; unit length, or 0 if it has no area
    glm::dvec3 weights{0.0};  ///< of the triangle's vertices; they sum to 1
    uint32_t item = 0, triangle = 0;
    bool from_behind = false;  ///< seen on the side that its winding calls the back
};

/// The geometry of an image: works from HiddenImage::surface alone, so that it serves every method alike.
class SurfacePoints {
public:
    /// @param list  must outlive it
    SurfacePoints(const DrawList& list, const View& view)
        : list_(list),
          unprojection_(view, view.width, view.height),
          to_world_(glm::transpose(glm::dmat3(view.view))),
          eye_(eyePosition(view)) {}

    /// The point stays within the triangle, whatever rounding and grazing angles say.
    SurfacePoint at(uint32_t row, uint32_t sample, uint32_t surface) const;

    /// Along the line of sight: unit length.
    glm::dvec3 directionAt(uint32_t row, uint32_t sample) const {
        return glm::normalize(to_world_ * unprojection_.lineOfSight(sample, row).direction);
    }

    const glm::dvec3& eye() const { return eye_; }

private:
    const DrawList& list_;
    Unprojection unprojection_;
    glm::dmat3 to_world_;
    glm::dvec3 eye_;
};

}  // namespace sightline::studies
