// Shadows of one sun: depth as the sun sees it, in maps that fit what an image shows.
// SPDX-License-Identifier: MIT
//
// Lance Williams. Casting Curved Shadows on Curved Surfaces. 1978.
// William Reeves, David Salesin, Robert Cook. Rendering Antialiased Shadows with Depth Maps. 1987.
// Andrew Lauritzen, Marco Salvi, Aaron Lefohn. Sample Distribution Shadow Maps. 2011.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/studies/hidden/draw_item.h"
#include "sightline/studies/hidden/image.h"
#include "sightline/studies/hidden/shade/unprojection.h"
#include "sightline/studies/hidden/share.h"

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

struct ShadowSettings {
    glm::dvec3 sun{0.0, 1.0, 0.0};  ///< towards it, unit length
    uint32_t size = 2048;           ///< of a map's longer side [texels, >= 1]
    uint32_t maps = 4;              ///< near to far, each for a range of distances from the eye [>= 1]
    ShareWork share;
};

/// Which points of an image the sun reaches.
///
/// Each map is a parallel view along the sun's rays, drawn by the z-buffer, that just holds the points shown in its range
/// of distances; ranges grow in proportion to the distance. Both sides of a triangle cast; what writes no depth casts
/// nothing. A texel is compared with the plane of the surface that asks, not with its depth alone, so that a plane never
/// shadows itself; a bias of one texel, and as much again as the plane slopes, covers surfaces that bend. So a shadow may
/// begin up to that far behind what casts it, and is never nearer to its caster than light would be.
class ShadowMap {
public:
    /// @param casters  what may stand between the sun and the image; more than the image's own list
    /// @param points   of the image's list
    ShadowMap(std::span<const DrawItem> casters, const SurfacePoints& points, const HiddenImage& image,
              const ShadowSettings& settings);

    /// The part of the sun that reaches a point: 0 in shadow, 1 in the light, and between them for one texel. Points
    /// outside all maps are in the light.
    double reach(const SurfacePoint& point) const;

    size_t maps() const { return maps_.size(); }
    /// The side of a texel of the map that serves a point [world units]; 0 if none does.
    double texelFor(const SurfacePoint& point) const;

private:
    struct Map {
        double farthest = 0;  ///< of the points that it serves, from the eye
        double texel = 1;
        glm::dvec2 corner{0.0};  ///< where its first texel begins, across the sun's rays
        uint32_t width = 0, height = 0;
        std::vector<double> depth;  ///< along `sun`, larger is nearer to it; -infinity where nothing casts
        double lowest = 0, highest = 0;
    };

    glm::dvec3 acrossSun(const glm::dvec3& position) const { return to_sun_space_ * position; }
    const Map* mapFor(const SurfacePoint& point) const;
    void fit(const SurfacePoints& points, const HiddenImage& image, const ShadowSettings& settings);
    void draw(std::span<const DrawItem> casters, const glm::dvec3& eye, const ShadowSettings& settings);

    glm::dmat3 to_sun_space_{1.0};  ///< z towards the sun
    std::vector<Map> maps_;
};

}  // namespace sightline::studies
