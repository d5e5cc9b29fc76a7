// A view as the witnesses see it: lines of sight, and what lies in the frustum, in double and relative to the eye.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/sight.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace sightline::tools {
namespace {

double distanceTo(const glm::dvec4& plane, const glm::dvec3& point) {
    return glm::dot(glm::dvec3(plane), point) + plane.w;
}

}  // namespace

SightLines::SightLines(const View& view)
    : eye_(eyePosition(view)), orthographic_(isOrthographic(view)), size_(view.width, view.height) {
    const glm::dmat4 m = view.projection * glm::dmat4(glm::dmat3(view.view));
    const auto row = [&](int r) { return glm::dvec4(m[0][r], m[1][r], m[2][r], m[3][r]); };
    x_ = row(0);
    y_ = row(1);
    w_ = row(3);
    const glm::dvec4 z = row(2);
    const glm::dvec4 planes[6] = {w_ + x_, w_ - x_, w_ + y_, w_ - y_, w_ + z, w_ - z};
    for (int i = 0; i < 6; ++i) planes_[i] = planes[i];
    const auto from_eye = [this](const glm::dvec4& plane) {
        return glm::dvec4(glm::dvec3(plane), plane.w + glm::dot(glm::dvec3(plane), eye_));
    };
    for (const glm::dvec4& plane : view.sections.all()) sections_.push_back(from_eye(plane));
    for (const glm::dvec4& plane : view.window.all()) window_.push_back(from_eye(plane));
}

SightRay SightLines::rayThrough(const glm::dvec2& place) const {
    // x/w = place.x and y/w = place.y are planes; they meet in the line of sight.
    const glm::dvec4 a = x_ - place.x * w_, b = y_ - place.y * w_;
    SightRay ray;
    glm::dvec3 along = glm::cross(glm::dvec3(a), glm::dvec3(b));
    const double size = glm::dot(along, along);
    ray.origin = (-a.w * glm::cross(glm::dvec3(b), along) - b.w * glm::cross(along, glm::dvec3(a))) / size;
    const glm::dvec4 &near_plane = planes_[4], &far_plane = planes_[5];
    if (glm::dot(glm::dvec3(near_plane), along) < 0) along = -along;
    ray.direction = glm::normalize(along);
    ray.t_near = -distanceTo(near_plane, ray.origin) / glm::dot(glm::dvec3(near_plane), ray.direction);
    const double closing = glm::dot(glm::dvec3(far_plane), ray.direction);
    // An infinite far plane is never met: its normal is zero but for rounding.
    const bool meets_far = closing < -1e-14 * glm::length(glm::dvec3(w_)) && closing < 0;
    ray.t_far = meets_far ? -distanceTo(far_plane, ray.origin) / closing : std::numeric_limits<double>::infinity();
    for (const glm::dvec4& section : sections_) {
        const double slope = glm::dot(glm::dvec3(section), ray.direction), start = distanceTo(section, ray.origin);
        if (slope > 0) ray.t_near = std::max(ray.t_near, -start / slope);
        else if (slope < 0) ray.t_far = std::min(ray.t_far, -start / slope);
        else if (start < 0) ray.t_far = -std::numeric_limits<double>::infinity();
    }
    return ray;
}

bool SightLines::inWindow(const glm::dvec3& point) const {
    return std::all_of(window_.begin(), window_.end(),
                       [&](const glm::dvec4& plane) { return distanceTo(plane, point) >= 0; });
}

bool SightLines::project(const glm::dvec3& point, glm::dvec2& place) const {
    for (const glm::dvec4& plane : planes_)
        if (!(distanceTo(plane, point) >= 0)) return false;
    for (const glm::dvec4& section : sections_)
        if (!(distanceTo(section, point) >= 0)) return false;
    if (!inWindow(point)) return false;
    const double w = distanceTo(w_, point);
    if (!(w > 0)) return false;
    place = glm::dvec2(distanceTo(x_, point), distanceTo(y_, point)) / w;
    return std::abs(place.x) <= 1 && std::abs(place.y) <= 1;
}

bool SightLines::touches(const Box3d& box) const {
    const glm::dvec3 low = box.min - eye_, high = box.max - eye_;
    const auto reaches = [&](const glm::dvec4& plane) {
        const glm::dvec3 corner(plane.x > 0 ? high.x : low.x, plane.y > 0 ? high.y : low.y,
                                plane.z > 0 ? high.z : low.z);
        const glm::dvec3 size = glm::abs(glm::dvec3(plane)) * glm::abs(corner);
        const double slack = 1e-12 * (size.x + size.y + size.z + std::abs(plane.w));
        return !(distanceTo(plane, corner) < -slack);
    };
    return std::all_of(std::begin(planes_), std::end(planes_), reaches) &&
           std::all_of(sections_.begin(), sections_.end(), reaches);
}

glm::dvec2 SightLines::pixel(const glm::dvec2& place) const {
    return {(0.5 + 0.5 * place.x) * size_.x, (0.5 - 0.5 * place.y) * size_.y};
}

}  // namespace sightline::tools
