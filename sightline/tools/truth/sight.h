// A view as the witnesses see it: lines of sight, and what lies in the frustum, in double and relative to the eye.
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "sightline/geom/view.h"
#include "sightline/math/box.h"

namespace sightline::tools {

/// The visible part of a line of sight: origin + t * direction with t_near <= t <= t_far; none if t_near > t_far.
/// Positions are relative to the eye, axes are the world's.
struct SightRay {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0, 0.0, -1.0};  ///< unit length
    double t_near = 0, t_far = 0;          ///< the near and the far plane, or sections; far may be infinite
};

/// Written from the matrices alone, apart from the frusta that cull.
class SightLines {
public:
    /// @param view  isUsable(view)
    explicit SightLines(const View& view);

    const glm::dvec3& eye() const { return eye_; }
    bool orthographic() const { return orthographic_; }

    /// The line of sight through a place of the image.
    /// @param place  x and y of clip space divided by w  [-1 to 1, y up]
    SightRay rayThrough(const glm::dvec2& place) const;

    /// Where a point appears; false if it lies outside of the frustum, of a section or of the window.
    /// @param point  relative to the eye
    bool project(const glm::dvec3& point, glm::dvec2& place) const;

    /// False only if a box, in world space, lies wholly outside of one plane of the frustum or of a section: what lies
    /// outside of the window alone is drawn, and may hide.
    bool touches(const Box3d& box) const;

    /// False if a point lies outside of the window.
    /// @param point  relative to the eye
    bool inWindow(const glm::dvec3& point) const;

    /// Pixels from the left and the top.
    glm::dvec2 pixel(const glm::dvec2& place) const;

private:
    glm::dvec3 eye_;
    bool orthographic_;
    glm::dvec2 size_;
    glm::dvec4 x_, y_, w_;  ///< rows: clip coordinates of a point relative to the eye
    glm::dvec4 planes_[6];  ///< left, right, bottom, top, near, far; inside is >= 0, not normalised
    std::vector<glm::dvec4> sections_, window_;  ///< the view's, likewise
};

}  // namespace sightline::tools
