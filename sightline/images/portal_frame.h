// A doorway as a window of images: its rectangle, which side it is seen from, and views whose image plane it is.
// SPDX-License-Identifier: MIT
//
// Daniel Aliaga, Anselmo Lastra. Architectural Walkthroughs Using Portal Textures. 1997.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/base/result.h"
#include "sightline/geom/view.h"

namespace sightline::images {

/// The rectangle around a doorway, upright as its viewer sees it. Its own coordinates are x to the right and y up from the
/// corner, and z from its plane towards the viewer, so that what is seen through it has z < 0.
struct PortalFrame {
    glm::dvec3 corner{0.0};             ///< the lower left one  [world units]
    glm::dvec3 right{1, 0, 0};          ///< unit length, as are up and front
    glm::dvec3 up{0, 1, 0};             ///<
    glm::dvec3 front{0, 0, 1};          ///< towards the viewer
    double width = 1, height = 1;       ///< [world units, > 0]
    std::vector<glm::dvec2> outline{};  ///< of the doorway, own coordinates, convex, counter-clockwise  [size: >= 3]

    glm::dvec3 toFrame(const glm::dvec3& point) const {
        const glm::dvec3 from = point - corner;
        return {glm::dot(from, right), glm::dot(from, up), glm::dot(from, front)};
    }
    glm::dvec3 toWorld(const glm::dvec3& own) const { return corner + own.x * right + own.y * up + own.z * front; }
    glm::dvec3 centre() const { return toWorld({0.5 * width, 0.5 * height, 0}); }
    /// True inside of the outline and on it; own coordinates.
    bool holds(const glm::dvec2& point) const;
};

/// The frame of a flat convex polygon, on the side of a place.
/// @param polygon    either way round  [world units] [size: >= 3]
/// @param seen_from  any place on the viewer's side
/// @param up         what is upright; of a polygon that lies flat in it, another axis is taken
/// Errors (kInput): fewer than three corners or one that is not finite; no area; corners farther from its plane than a
/// thousandth of its size; not convex; a viewer in its plane.
Result<PortalFrame> portalFrame(std::span<const glm::dvec3> polygon, const glm::dvec3& seen_from,
                                const glm::dvec3& up = {0, 1, 0});

/// The same doorway with a larger rectangle around it.  [world units on each side, >= 0]
PortalFrame widened(const PortalFrame& frame, const glm::dvec2& margin);

/// Where an eye stands to a doorway. Only kBefore can be served by images.
enum class EyePlace : uint8_t {
    kBefore,
    kEdgeOn,     ///< sees the doorway's middle at less than kLeastSine over its plane
    kInPlane,    ///< nearer to the plane than a millionth of the doorway's size
    kBehind,     ///< on the other side
    kNotFinite,  ///<
};
inline constexpr double kLeastSine = 0.05;  ///< 3 degrees
inline constexpr double kPlaneGap = 3e-5;
EyePlace eyePlace(const PortalFrame& frame, const glm::dvec3& eye);
/// In words: "the eye sees the doorway edge-on".
const char* wordsOf(EyePlace place);

/// What an eye sees through a doorway, as an image whose plane is the doorway: pixel (i, j) is the same piece of the
/// rectangle for every eye. The near plane lies kPlaneGap of width + height beyond it, so that only what is beyond is drawn,
/// and what lies in the doorway's own plane, as a door's frame does, is before it whatever rounding says. There is no far
/// plane. Clip w is the distance from the eye along the doorway's normal.
/// Errors (kUsage): an eye that is not kBefore, an image without pixels.
Result<View> portalView(const PortalFrame& frame, const glm::dvec3& eye, uint32_t width, uint32_t height);

}  // namespace sightline::images
