// What a view draws and asks about beside its frustum: section planes, and a window.
// SPDX-License-Identifier: MIT
#include "sightline/geom/view_limits.h"

#include <algorithm>
#include <cmath>

namespace sightline {
namespace {

constexpr double kRounding = 0x1p-19;  // of the terms: a renderer may place what it clips in single precision

/// Of unit length and relative to the eye; a plane without a direction becomes (0, 0, 0, 1 or -1).
glm::dvec4 unitPlane(const glm::dvec4& plane, const glm::dvec3& eye) {
    const double largest = std::max({std::abs(plane.x), std::abs(plane.y), std::abs(plane.z)});
    if (largest == 0.0) return {0, 0, 0, plane.w < 0.0 ? -1.0 : 1.0};
    const glm::dvec4 scaled = plane / largest;  // its length neither vanishes nor overflows
    const double length = glm::length(glm::dvec3(scaled));
    const glm::dvec3 n = glm::dvec3(scaled) / length;
    return {n, scaled.w / length + glm::dot(n, eye)};
}

/// dot(n, T q - eye) + d as a plane of object space, and bounds on its terms.
struct ObjectPlane {
    glm::dvec3 n{0.0};
    double d = 0, size = 0;
};

ObjectPlane toObject(const glm::dvec4& plane, const glm::dmat4& transform, const glm::dvec3& eye) {
    const glm::dvec3 n(plane), place = glm::dvec3(transform[3]) - eye;
    ObjectPlane out;
    out.n = glm::transpose(glm::dmat3(transform)) * n;
    out.d = glm::dot(n, place) + plane.w;
    out.size = std::abs(plane.w) + glm::dot(glm::abs(n), glm::abs(place));
    return out;
}

struct Reach {
    double low = 0, high = 0, margin = 0;
};

/// How far inside of a plane the points of a box lie.
Reach reachOf(const ObjectPlane& plane, const glm::dvec3& min, const glm::dvec3& max) {
    Reach reach{plane.d, plane.d, plane.size};
    for (int axis = 0; axis < 3; ++axis) {
        const double a = plane.n[axis] * min[axis], b = plane.n[axis] * max[axis];
        reach.low += std::min(a, b);
        reach.high += std::max(a, b);
        reach.margin += std::max(std::abs(a), std::abs(b));
    }
    reach.margin *= kRounding;
    return reach;
}

bool isWholeBetween(const ViewLimits& limits, const glm::dvec3& min, const glm::dvec3& max,
                    const glm::dmat4& transform) {
    for (uint32_t i = 0; i < limits.sections; ++i) {
        const Reach reach = reachOf(toObject(limits.volume.planes[i], transform, limits.volume.eye), min, max);
        if (!(reach.low > reach.margin)) return false;
    }
    return true;
}

}  // namespace

ViewLimits makeViewLimits(const View& view, const glm::dvec3& eye) {
    ViewLimits limits;
    limits.volume.eye = eye;
    for (const ViewPlanes* planes : {&view.sections, &view.window})
        for (const glm::dvec4& plane : planes->all())
            limits.volume.planes[limits.volume.count++] = unitPlane(plane, eye);
    limits.sections = view.sections.count;
    return limits;
}

bool isWhole(const ViewLimits& limits, const Box3f& box, const glm::dmat4& transform) {
    return box.empty() || isWholeBetween(limits, glm::dvec3(box.min), glm::dvec3(box.max), transform);
}

bool isWhole(const ViewLimits& limits, const glm::vec3& point, const glm::dmat4& transform) {
    return isWholeBetween(limits, glm::dvec3(point), glm::dvec3(point), transform);
}

bool reachesWindow(const ViewLimits& limits, const Box3d& box, const glm::dmat4& transform) {
    for (uint32_t i = limits.sections; i < limits.volume.count; ++i) {
        const Reach reach = reachOf(toObject(limits.volume.planes[i], transform, limits.volume.eye), box.min, box.max);
        if (!(reach.high > reach.margin)) return false;
    }
    return true;
}

bool addWindow(View& view, const ViewVolume& volume) {
    bool all = !volume.empty || view.window.add({0, 0, 0, -1});
    for (uint32_t i = 0; i < volume.count; ++i) {
        const glm::dvec4& plane = volume.planes[i];
        all &= view.window.add({glm::dvec3(plane), plane.w - glm::dot(glm::dvec3(plane), volume.eye)});
    }
    return all;
}

bool addWindow(View& view, double left, double top, double right, double bottom) {
    if (!isUsable(view)) return false;
    const glm::dvec3 eye = eyePosition(view);
    glm::dmat4 rigid(glm::dmat3(view.view));
    const glm::dmat4 clip = view.projection * rigid;
    const auto row = [&](int r) { return glm::dvec4(clip[0][r], clip[1][r], clip[2][r], clip[3][r]); };
    const auto x = [&](double pixels) { return 2.0 * pixels / view.width - 1.0; };
    const auto y = [&](double pixels) { return 1.0 - 2.0 * pixels / view.height; };
    const double low_x = x(std::min(left, right) - view.jitter), high_x = x(std::max(left, right) + view.jitter);
    const double low_y = y(std::max(top, bottom) + view.jitter), high_y = y(std::min(top, bottom) - view.jitter);
    ViewVolume volume;
    volume.eye = eye;
    const glm::dvec4 sides[4] = {row(0) - low_x * row(3), high_x * row(3) - row(0), row(1) - low_y * row(3),
                                 high_y * row(3) - row(1)};
    for (const glm::dvec4& side : sides) volume.planes[volume.count++] = side;
    return addWindow(view, volume);
}

}  // namespace sightline
