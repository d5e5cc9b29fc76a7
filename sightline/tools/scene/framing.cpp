// Cameras that show all of some points.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/framing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline::tools {
namespace {

constexpr double kFramingAngle = 45;  // of the image, vertical  [degrees]
constexpr double kNarrowest = 1.5;    // width by height of the narrowest image that shows all
constexpr double kSpare = 1.06;       // around the whole

const double kTangent = std::tan(kFramingAngle * 3.14159265358979323846 / 360) / kSpare;  // up and down

struct ImageAxes {
    glm::dvec3 right, up;
};

ImageAxes axesOf(const glm::dvec3& side) {
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), side));
    return {right, glm::cross(side, right)};
}

}  // namespace

glm::dvec3 sideAt(double azimuth, double elevation) {
    return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation), std::cos(elevation) * std::cos(azimuth)};
}

void Framing::add(const Box3d& box) {
    if (box.empty()) return;
    for (int i = 0; i < 8; ++i)
        points_.emplace_back(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                             i & 4 ? box.max.z : box.min.z);
}

CameraFrame Framing::nearest(const glm::dvec3& side) const {
    constexpr double kEndless = std::numeric_limits<double>::infinity();
    const ImageAxes axes = axesOf(side);
    double right_most = -kEndless, left_most = kEndless, top = -kEndless, bottom = kEndless;
    for (const glm::dvec3& p : points_) {
        const double x = glm::dot(axes.right, p), y = glm::dot(axes.up, p), z = glm::dot(side, p);
        right_most = std::max(right_most, x + kNarrowest * kTangent * z);
        left_most = std::min(left_most, x - kNarrowest * kTangent * z);
        top = std::max(top, y + kTangent * z);
        bottom = std::min(bottom, y - kTangent * z);
    }
    const double distance = std::max((right_most - left_most) / (2 * kNarrowest), (top - bottom) / 2) / kTangent;
    const glm::dvec3 middle =
        0.5 * ((right_most + left_most) * axes.right + (top + bottom) * axes.up) + glm::dot(side, center()) * side;
    return at(middle, side, distance - glm::dot(side, center()));
}

double Framing::distanceFrom(const glm::dvec3& side) const {
    const ImageAxes axes = axesOf(side);
    double distance = 0;
    for (const glm::dvec3& p : points_) {
        const glm::dvec3 away = p - center();
        const double across =
            std::max(std::abs(glm::dot(away, axes.up)), std::abs(glm::dot(away, axes.right)) / kNarrowest);
        distance = std::max(distance, across / kTangent + glm::dot(away, side));
    }
    return distance;
}

CameraFrame Framing::at(const glm::dvec3& target, const glm::dvec3& side, double distance) {
    CameraFrame frame;
    frame.eye = target + distance * side;
    frame.target = target;
    frame.fov_y_degrees = kFramingAngle;
    frame.z_near = 0.001 * distance;
    return frame;
}

}  // namespace sightline::tools
