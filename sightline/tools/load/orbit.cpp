// Cameras around a scene that show the whole of it.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/orbit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "sightline/base/random.h"

namespace sightline::tools {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kAngle = 45;           // of the image, vertical  [degrees]
constexpr double kNarrowest = 1.5;      // width by height of the narrowest image that shows all
constexpr double kSpare = 1.06;         // around the whole
constexpr double kGolden = 2.39996323;  // between two sides in turn: no two of many are close  [radians]
constexpr size_t kMostBoxes = 65536;    // of more objects only the box around all is framed

const double kTangent = std::tan(kAngle * kPi / 360) / kSpare;  // up and down

/// Towards the eye.
glm::dvec3 sideAt(double azimuth, double elevation) {
    return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation), std::cos(elevation) * std::cos(azimuth)};
}

/// What an image is to show: points whose hull holds the scene.
class Subject {
public:
    explicit Subject(const Scene& scene) : bounds_(worldBounds(scene)) {
        const double diagonal = bounds_.finite() ? glm::length(bounds_.size()) : 0;
        if (!(diagonal > 0) || !std::isfinite(diagonal)) {
            bounds_ = {};
            bounds_.grow(glm::dvec3(-0.5));
            bounds_.grow(glm::dvec3(0.5));
            addBox(bounds_);
        } else if (scene.objects.size() > kMostBoxes) {
            addBox(bounds_);
        } else {
            for (const SceneObject& object : scene.objects)
                addBox(transformBox(scene.meshes[object.mesh].bounds, object.transform));
        }
    }

    /// From that side, as near as it can be.
    CameraFrame nearest(const glm::dvec3& side) const {
        const Axes axes = axesOf(side);
        double right_most = -kFar, left_most = kFar, top = -kFar, bottom = kFar;
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
        return frameFrom(middle, side, distance - glm::dot(side, center()));
    }

    /// From how far away, looking at the centre, all is in the image.
    double distanceFrom(const glm::dvec3& side) const {
        const Axes axes = axesOf(side);
        double distance = 0;
        for (const glm::dvec3& p : points_) {
            const glm::dvec3 away = p - center();
            const double across =
                std::max(std::abs(glm::dot(away, axes.up)), std::abs(glm::dot(away, axes.right)) / kNarrowest);
            distance = std::max(distance, across / kTangent + glm::dot(away, side));
        }
        return distance;
    }

    glm::dvec3 center() const { return bounds_.center(); }

    static CameraFrame frameFrom(const glm::dvec3& target, const glm::dvec3& side, double distance) {
        CameraFrame frame;
        frame.eye = target + distance * side;
        frame.target = target;
        frame.fov_y_degrees = kAngle;
        frame.z_near = 0.001 * distance;
        return frame;
    }

private:
    static constexpr double kFar = std::numeric_limits<double>::infinity();

    struct Axes {
        glm::dvec3 right, up;
    };
    static Axes axesOf(const glm::dvec3& side) {
        const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), side));
        return {right, glm::cross(side, right)};
    }

    void addBox(const Box3d& box) {
        if (box.empty()) return;
        for (int i = 0; i < 8; ++i)
            points_.emplace_back(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                                 i & 4 ? box.max.z : box.min.z);
    }

    Box3d bounds_;
    std::vector<glm::dvec3> points_;
};

/// Between two faces of the box, where both are seen.
double seededSide(uint64_t seed) {
    Random random(mixSeed(seed, 0x73696465));
    return kPi / 2 * static_cast<double>(random.below(4)) + random.uniform(0.15, 0.35) * kPi;
}

}  // namespace

CameraPath orbitAround(const Scene& scene, uint32_t frames, uint64_t seed) {
    constexpr double kElevation = 0.3;
    const Subject subject(scene);
    const double first = seededSide(seed);
    double distance = 0;
    for (int i = 0; i < 64; ++i) distance = std::max(distance, subject.distanceFrom(sideAt(kPi / 32 * i, kElevation)));
    CameraPath path;
    for (uint32_t i = 0; i < frames; ++i) {
        const glm::dvec3 side = sideAt(first + 2 * kPi * i / frames, kElevation);
        path.frames.push_back(Subject::frameFrom(subject.center(), side, distance));
    }
    return path;
}

CameraPath overviewsOf(const Scene& scene, uint32_t frames, uint64_t seed) {
    constexpr double kElevation = kPi / 6;
    const Subject subject(scene);
    CameraPath path;
    for (uint32_t i = 0; i < frames; ++i)
        path.frames.push_back(subject.nearest(sideAt(seededSide(seed) + kGolden * i, kElevation)));
    return path;
}

}  // namespace sightline::tools
