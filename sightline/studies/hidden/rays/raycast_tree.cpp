// The triangles that rays may meet, in double, and a hierarchy of eight-wide nodes above them.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/rays/raycast_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline::studies {
namespace {

/// A ray in float from its near end on, wide enough for what rounding takes: origins in float are off by less than
/// low and high say, and quotients by less than kStretch.
struct SlabRay {
    static constexpr float kStretch = 0x1p-20f;

    float low[3], high[3], inverse[3];
    bool forward[3];

    SlabRay(const glm::dvec3& origin, const glm::dvec3& direction) {
        const glm::dvec3 size = glm::abs(origin);
        const double slack = 0x1p-22 * std::max({size.x, size.y, size.z}) + 1e-30;
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = static_cast<float>(origin[axis] - slack);
            high[axis] = static_cast<float>(origin[axis] + slack);
            forward[axis] = direction[axis] >= 0;
            // Zero times infinity would be no number.
            const double limit = std::max(std::abs(direction[axis]), 1e-25);
            inverse[axis] = static_cast<float>(forward[axis] ? 1 / limit : -1 / limit);
        }
    }

    /// Where it enters the eight boxes of a node: more than `end` for those that it misses before there.
    void enter(const BvhNode& node, float end, float* enters) const {
        float leaves[8];
        for (int i = 0; i < 8; ++i) {
            enters[i] = 0;
            leaves[i] = end;
        }
        for (int axis = 0; axis < 3; ++axis) {
            const float* first = forward[axis] ? node.min[axis] : node.max[axis];
            const float* last = forward[axis] ? node.max[axis] : node.min[axis];
            const float from_first = forward[axis] ? high[axis] : low[axis];
            const float from_last = forward[axis] ? low[axis] : high[axis];
            for (int i = 0; i < 8; ++i) {
                const float near = (first[i] - from_first) * inverse[axis];
                const float far = (last[i] - from_last) * inverse[axis];
                enters[i] = near > enters[i] ? near : enters[i];
                leaves[i] = far < leaves[i] ? far : leaves[i];
            }
        }
        for (int i = 0; i < 8; ++i) {
            enters[i] *= 1 - kStretch;
            enters[i] = enters[i] <= leaves[i] * (1 + kStretch) ? enters[i] : kMissed;
        }
    }

    static constexpr float kMissed = std::numeric_limits<float>::infinity();
};

/// Not below the value in double.
float endInFloat(double t) { return static_cast<float>(t) * (1 + 0x1p-22f) + 1e-30f; }

}  // namespace

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

RayTriangles rayTriangles(const DrawList& list, const ProjectorSettings& settings) {
    RayTriangles result;
    Box3d world;
    std::vector<glm::dvec3> corners;
    for (size_t i = 0; i < list.items().size(); ++i) {
        const DrawItem& item = list.items()[i];
        const bool turned =
            (glm::determinant(glm::dmat3(item.transform)) < 0) != (settings.front_face == FrontFace::kClockwise);
        corners.clear();
        for (const glm::vec3& position : item.mesh.positions)
            corners.push_back(glm::dvec3(item.transform * glm::dvec4(glm::dvec3(position), 1.0)));
        for (size_t triangle = 0; triangle < item.mesh.triangles(); ++triangle) {
            if (!item.writes_depth.empty() && item.writes_depth[triangle] == 0) continue;
            const uint32_t* indices = item.mesh.indices.data() + 3 * triangle;
            RayTriangle out;
            out.a = corners[indices[0]];
            out.b = corners[indices[turned ? 2 : 1]];
            out.c = corners[indices[turned ? 1 : 2]];
            out.surface = list.firstSurface(i) + static_cast<uint32_t>(triangle);
            out.double_sided =
                !settings.cull_back_faces || (!item.double_sided.empty() && item.double_sided[triangle] != 0);
            Box3d box;
            for (const glm::dvec3& corner : {out.a, out.b, out.c}) box.grow(corner);
            const glm::dvec3 sum = out.a + out.b + out.c;
            if (!std::isfinite(sum.x + sum.y + sum.z)) continue;
            world.grow(box);
            result.triangles.push_back(out);
        }
    }
    if (world.empty()) return result;
    // No farther out than any corner: one at the end of the world takes no digits from the others.
    result.origin = glm::clamp(glm::dvec3(0.0), world.min, world.max);
    result.bounds = {world.min - result.origin, world.max - result.origin};
    for (RayTriangle& triangle : result.triangles)
        for (glm::dvec3* corner : {&triangle.a, &triangle.b, &triangle.c}) *corner -= result.origin;
    return result;
}

bool meets(const RayTriangle& triangle, const glm::dvec3& from, const glm::dvec3& direction, const glm::dvec3& axis,
           double& t) {
    const glm::dvec3 a = triangle.a - from, b = triangle.b - from, c = triangle.c - from;
    const double u = glm::dot(direction, glm::cross(c, b)), v = glm::dot(direction, glm::cross(a, c)),
                 w = glm::dot(direction, glm::cross(b, a));
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
    const double volume = u + v + w;
    if (volume == 0 || (volume < 0 && !triangle.double_sided)) return false;
    const glm::dvec3 at(glm::dot(axis, a), glm::dot(axis, b), glm::dot(axis, c));
    t = std::clamp((u * at.x + v * at.y + w * at.z) / volume, std::min({at.x, at.y, at.z}),
                   std::max({at.x, at.y, at.z}));
    return true;
}

RayTree::RayTree(const RayTriangles& triangles) : origin_(triangles.origin) {
    std::vector<Box3d> boxes;
    boxes.reserve(triangles.triangles.size());
    for (const RayTriangle& triangle : triangles.triangles) {
        Box3d box;
        for (const glm::dvec3& corner : {triangle.a, triangle.b, triangle.c}) box.grow(corner);
        boxes.push_back(box);
    }
    bvh_ = buildBvh(boxes);
    triangles_.reserve(boxes.size());
    for (const uint32_t triangle : bvh_.order) triangles_.push_back(triangles.triangles[triangle]);
}

RayHit RayTree::nearest(const SampleRays& rays, const SampleRay& ray, std::vector<RayVisit>& stack) const {
    RayHit hit;
    if (bvh_.nodes.empty() || !(ray.t_near <= ray.t_far)) return hit;
    hit.t = ray.t_far;
    const glm::dvec3 from = ray.origin + (rays.eye() - origin_);
    const SlabRay slabs(from + ray.t_near * ray.direction - bvh_.origin, ray.direction);
    float end = endInFloat(hit.t - ray.t_near);
    stack.clear();
    stack.push_back({0, 0});
    while (!stack.empty()) {
        const RayVisit visit = stack.back();
        stack.pop_back();
        if (visit.enters > end) continue;
        if ((visit.child & BvhNode::kLeaf) != 0) {
            const RayTriangle& triangle = triangles_[visit.child & ~BvhNode::kLeaf];
            double t;
            if (!meets(triangle, from, ray.direction, rays.depthAxis(), t) || t < ray.t_near) continue;
            if (t < hit.t || (t == hit.t && triangle.surface < hit.surface)) {
                hit = {t, triangle.surface};
                end = endInFloat(t - ray.t_near);
            }
            continue;
        }
        const BvhNode& node = bvh_.nodes[visit.child];
        float enters[8];
        slabs.enter(node, end, enters);
        const size_t base = stack.size();
        for (int i = 0; i < 8; ++i) {
            if (enters[i] == SlabRay::kMissed || node.count[i] == 0) continue;
            // The nearest goes on top.
            stack.push_back({enters[i], node.child[i]});
            for (size_t j = stack.size() - 1; j > base && stack[j - 1].enters < stack[j].enters; --j)
                std::swap(stack[j - 1], stack[j]);
        }
    }
    return hit;
}

}  // namespace sightline::studies
