// The eye that a user moves: flies where it looks, or turns around a point.
// SPDX-License-Identifier: MIT
#include "apps/viewer/fly_camera.h"

#include <algorithm>
#include <cmath>

namespace sightline::viewer {
namespace {

constexpr double kSteepest = 1.55;  // short of straight up, where right is not known

}  // namespace

void FlyCamera::take(const tools::CameraFrame& frame) {
    const View view = makeView(frame, 16, 9);
    eye_ = eyePosition(view);
    const glm::dvec3 ahead = -glm::dvec3(view.view[0][2], view.view[1][2], view.view[2][2]);
    yaw_ = std::atan2(ahead.x, -ahead.z);
    pitch_ = std::clamp(std::asin(std::clamp(ahead.y, -1.0, 1.0)), -kSteepest, kSteepest);
    if (!frame.projection && !frame.orthographic_height) fov_y_degrees = frame.fov_y_degrees;
    z_near = frame.z_near;
    z_far_ = frame.z_far;
    orthographic_height_ = frame.projection ? std::nullopt : frame.orthographic_height;
    given_ = frame;
}

glm::dvec3 FlyCamera::forward() const {
    return {std::sin(yaw_) * std::cos(pitch_), std::sin(pitch_), -std::cos(yaw_) * std::cos(pitch_)};
}

void FlyCamera::fly(const glm::dvec3& steps) {
    if (steps == glm::dvec3(0.0)) return;
    const glm::dvec3 right(std::cos(yaw_), 0, std::sin(yaw_));
    eye_ += steps.x * right + steps.y * glm::dvec3(0, 1, 0) + steps.z * forward();
    given_.reset();
}

void FlyCamera::look(double right, double up) {
    if (right == 0 && up == 0) return;
    yaw_ += right;
    pitch_ = std::clamp(pitch_ + up, -kSteepest, kSteepest);
    given_.reset();
}

void FlyCamera::orbit(const glm::dvec3& around, double right, double up) {
    const double distance = glm::length(around - eye_);
    const glm::dvec3 ahead = distance > 0 ? (around - eye_) / distance : forward();
    yaw_ = std::atan2(ahead.x, -ahead.z) + right;
    pitch_ = std::clamp(std::asin(std::clamp(ahead.y, -1.0, 1.0)) + up, -kSteepest, kSteepest);
    eye_ = around - distance * forward();
    given_.reset();
}

void FlyCamera::frame(const glm::dvec3& center, double radius, double aspect) {
    const double up = 0.5 * glm::radians(fov_y_degrees), across = std::atan(std::tan(up) * aspect);
    const double distance = std::max(radius, 1e-6) / std::sin(std::min(up, across));
    eye_ = center - distance * forward();
    if (orthographic_height_) orthographic_height_ = 2 * std::max(radius, 1e-6) / std::min(1.0, aspect);
    if (z_far_ && *z_far_ < distance + radius) z_far_.reset();
    given_.reset();
}

tools::CameraFrame FlyCamera::cameraFrame() const {
    if (given_) return *given_;
    tools::CameraFrame frame;
    frame.eye = eye_;
    frame.target = eye_ + forward();
    frame.fov_y_degrees = fov_y_degrees;
    frame.z_near = z_near;
    frame.z_far = z_far_;
    frame.orthographic_height = orthographic_height_;
    return frame;
}

}  // namespace sightline::viewer
