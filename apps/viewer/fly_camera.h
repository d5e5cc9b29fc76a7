// The eye that a user moves: flies where it looks, or turns around a point.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "sightline/geom/view.h"
#include "sightline/tools/scene/camera_path.h"

namespace sightline::viewer {

/// y is up. Angles are in radians; a pitch of 0 is level. Of a camera that it takes, roll and what matrices of its own say
/// are lost when it moves.
class FlyCamera {
public:
    /// Takes the place, the direction and the projection of a frame; matrices of its own are used until it is moved.
    void take(const tools::CameraFrame& frame);

    /// @param steps  to the right, up and ahead  [world units]
    void fly(const glm::dvec3& steps);
    /// Turns where it stands.
    void look(double right, double up);
    /// Turns around a point, at the same distance, and looks at it.
    void orbit(const glm::dvec3& around, double right, double up);
    /// Looks at a sphere from where it looks now, so far that all of it is in the picture.
    /// @param aspect  of the picture, width by height
    void frame(const glm::dvec3& center, double radius, double aspect);

    glm::dvec3 eye() const { return eye_; }
    glm::dvec3 forward() const;
    double fov_y_degrees = 60, z_near = 0.1;

    tools::CameraFrame cameraFrame() const;
    View view(uint32_t width, uint32_t height) const { return makeView(cameraFrame(), width, height); }

private:
    glm::dvec3 eye_{0.0};
    double yaw_ = 0, pitch_ = 0;
    std::optional<double> z_far_, orthographic_height_;
    std::optional<tools::CameraFrame> given_;  ///< as it was taken, while it has not been moved
};

}  // namespace sightline::viewer
