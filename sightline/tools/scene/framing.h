// Cameras that show all of some points.
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "sightline/math/box.h"
#include "sightline/tools/scene/camera_path.h"

namespace sightline::tools {

/// What an image is to show: points whose hull holds it. The cameras are 45 degrees high, and all of the points are in each image of
/// 3 by 2 or wider, with a rim. Near is a thousandth of the distance, far infinite.
class Framing {
public:
    /// @param center  about the middle of what is shown
    explicit Framing(const glm::dvec3& center) : center_(center) {}

    /// The eight corners; nothing of an empty box.
    void add(const Box3d& box);
    void add(const glm::dvec3& point) { points_.push_back(point); }

    const glm::dvec3& center() const { return center_; }

    /// As near as it can be.
    /// @param side  towards the eye  [unit length, not vertical]
    /// @pre some point was added, and not all lie in one place
    CameraFrame nearest(const glm::dvec3& side) const;

    /// From how far away, looking at the centre, all is in the image.
    double distanceFrom(const glm::dvec3& side) const;

    static CameraFrame at(const glm::dvec3& target, const glm::dvec3& side, double distance);

private:
    std::vector<glm::dvec3> points_;
    glm::dvec3 center_;
};

/// Towards an eye that stands so far around the vertical axis, from +z to +x, and so far above the horizon.  [radians]
glm::dvec3 sideAt(double azimuth, double elevation);

}  // namespace sightline::tools
