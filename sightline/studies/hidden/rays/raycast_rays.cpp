// The rays of a view: one through each sample, from the near plane on.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/rays/raycast_rays.h"

#include <algorithm>
#include <limits>

namespace sightline::studies {

SampleRays::SampleRays(const View& view) : parallel_(isOrthographic(view)), eye_(eyePosition(view)) {
    const glm::dmat4& p = view.projection;
    const glm::dmat3 to_world = glm::transpose(glm::dmat3(view.view));
    const glm::dvec2 scale(2.0 / view.width, 2.0 / view.height), start(1.0 / view.width - 1.0, 1.0 / view.height - 1.0);
    const auto row = [&](int i) { return glm::dvec3(p[0][i], p[1][i], p[2][i]); };
    if (parallel_) {
        // across * (x, y) + tilt * z + shift = w * clip position; rays run along -z with x and y that leave it the same.
        const glm::dmat2 back = glm::inverse(glm::dmat2(p[0][0], p[0][1], p[1][0], p[1][1]));
        const double w = p[3][3];
        const auto inEye = [&](const glm::dvec2& clip) { return to_world * glm::dvec3(back * clip, 0.0); };
        origin_ = inEye(w * start - glm::dvec2(p[3]));
        origin_per_sample_ = inEye({w * scale.x, 0.0});
        origin_per_row_ = inEye({0.0, w * scale.y});
        direction_ = to_world * glm::dvec3(back * glm::dvec2(p[2]), -1.0);
        depth_axis_ = to_world * glm::dvec3(0, 0, -1);
    } else {
        // The direction in which (x, y, w) grow as clip position and 1.
        const glm::dmat3 back = glm::inverse(glm::transpose(glm::dmat3(row(0), row(1), row(3))));
        direction_ = to_world * (back * glm::dvec3(start, 1.0));
        direction_per_sample_ = to_world * (back * glm::dvec3(scale.x, 0.0, 0.0));
        direction_per_row_ = to_world * (back * glm::dvec3(0.0, scale.y, 0.0));
        depth_axis_ = to_world * row(3);
    }
    near_ = {to_world * (row(2) + row(3)), p[3][2] + p[3][3]};
    far_ = {to_world * (row(3) - row(2)), p[3][3] - p[3][2]};
}

SampleRay SampleRays::at(double row, double sample) const {
    SampleRay ray;
    ray.origin = origin_ + sample * origin_per_sample_ + row * origin_per_row_;
    ray.direction = direction_ + sample * direction_per_sample_ + row * direction_per_row_;
    ray.t_near = parallel_ ? -std::numeric_limits<double>::infinity() : 0.0;
    ray.t_far = std::numeric_limits<double>::infinity();
    for (const glm::dvec4& plane : {near_, far_}) {
        const double here = glm::dot(glm::dvec3(plane), ray.origin) + plane.w;
        const double grows = glm::dot(glm::dvec3(plane), ray.direction);
        if (grows > 0) ray.t_near = std::max(ray.t_near, -here / grows);
        else if (grows < 0) ray.t_far = std::min(ray.t_far, -here / grows);
        else if (here < 0) ray.t_far = -std::numeric_limits<double>::infinity();
    }
    return ray;
}

}  // namespace sightline::studies
