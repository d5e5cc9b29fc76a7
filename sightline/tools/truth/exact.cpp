// The last word on an alarm: is a point of an object really unhidden, in double and with every doubt for the defence.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/exact.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline::tools {
namespace {

/// Of the size of the terms that a position relative to the eye was summed from.
constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();
constexpr uint32_t kNobody = ~0u;
/// Depths closer than this part of the distance are equal.
constexpr double kEqualDepth = 1e-9;

/// A ray with two axes across it: seen along the ray, it is the origin of a plane.
struct RayFrame {
    explicit RayFrame(const SightRay& r) : ray(r) {
        const glm::dvec3& d = r.direction;
        const glm::dvec3 size = glm::abs(d);
        glm::dvec3 other(0.0);
        other[size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2] = 1.0;
        right = glm::normalize(glm::cross(d, other));
        up = glm::cross(d, right);
    }
    const SightRay& ray;
    glm::dvec3 right, up;  ///< cross(right, up) = direction
};

/// How a ray meets a triangle: surely and perhaps enclose the answer of exact arithmetic.
struct Crossing {
    bool surely = false, perhaps = false;
    bool front_surely = false, front_perhaps = false;
    bool has_area = false;    ///< as the ray sees it, beyond rounding: else nothing of it is drawn
    double t = 0, t_low = 0;  ///< along the ray; t_low is the nearest that doubt about the facing allows
};

Crossing cross(const RayFrame& frame, const glm::dvec3 (&corner)[3], double rounding) {
    Crossing result;
    glm::dvec2 flat[3];
    double along[3];
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 from_origin = corner[i] - frame.ray.origin;
        flat[i] = {glm::dot(from_origin, frame.right), glm::dot(from_origin, frame.up)};
        along[i] = glm::dot(from_origin, frame.ray.direction);
    }
    const glm::dvec2 low = glm::min(glm::min(flat[0], flat[1]), flat[2]);
    const glm::dvec2 high = glm::max(glm::max(flat[0], flat[1]), flat[2]);
    if (low.x > rounding || low.y > rounding || high.x < -rounding || high.y < -rounding) return result;

    const glm::dvec2 ab = flat[1] - flat[0], ac = flat[2] - flat[0];
    const double area = ab.x * ac.y - ab.y * ac.x;
    const double nearest = std::min({along[0], along[1], along[2]});
    const double farthest = std::max({along[0], along[1], along[2]});
    double inside = std::numeric_limits<double>::infinity(), longest = 0, off_longest = 0;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec2 &a = flat[i], &b = flat[(i + 1) % 3];
        const double length = glm::length(b - a);
        if (length == 0) continue;
        const double off = (a.x * b.y - a.y * b.x) / length;
        inside = std::min(inside, area < 0 ? -off : off);
        if (length > longest) {
            longest = length;
            off_longest = std::abs(off);
        }
    }
    // Seen from its edge a triangle is its longest side, and its sides no longer tell in from out.
    const bool edge_on = std::abs(area) <= 4 * rounding * longest;
    result.perhaps = edge_on ? off_longest <= 8 * rounding : inside >= -rounding;
    result.surely = !edge_on && inside > rounding;
    result.front_surely = area < 0 && !edge_on;
    result.has_area = !edge_on;
    result.front_perhaps = area < 0 || edge_on;
    const glm::dvec3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    const double t = glm::dot(normal, corner[0] - frame.ray.origin) / glm::dot(normal, frame.ray.direction);
    result.t = t >= nearest && t <= farthest ? t : t > farthest ? farthest : nearest;
    result.t_low = edge_on ? nearest : result.t;
    return result;
}

/// True if the ray comes within `slack` of a box at some t of [from, to].
bool meets(const glm::dvec3& origin, const glm::dvec3& direction, double from, double to, const Box3d& box,
           double slack) {
    for (int axis = 0; axis < 3; ++axis) {
        const double low = box.min[axis] - slack - origin[axis], high = box.max[axis] + slack - origin[axis];
        if (direction[axis] == 0) {
            if (low > 0 || high < 0) return false;
            continue;
        }
        const double a = low / direction[axis], b = high / direction[axis];
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
    }
    return from <= to + 1e-12 * std::abs(to);
}

double largest(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// The triangles of one object, relative to the eye.
class ObjectTriangles {
public:
    ObjectTriangles(const SceneFacts& facts, uint32_t object, const glm::dvec3& eye)
        : mesh_(facts.mesh(object)),
          facts_(facts.facts(object)),
          linear_(glm::dmat3(facts.scene().objects[object].transform)),
          moved_(glm::dvec3(facts.scene().objects[object].transform[3]) - eye) {
        flipped_ = glm::determinant(linear_) < 0;
        const Box3d& box = facts_.bounds;
        const glm::dvec3 size = glm::max(glm::abs(box.min), glm::abs(box.max));
        double terms = largest(moved_);
        for (int column = 0; column < 3; ++column) terms += largest(linear_[column]) * size[column];
        rounding_ = kRounding * terms;
    }

    double rounding() const { return rounding_; }

    void corners(uint32_t triangle, glm::dvec3 (&points)[3]) const {
        for (int k = 0; k < 3; ++k)
            points[k] = linear_ * glm::dvec3(mesh_.positions[mesh_.indices[3 * triangle + k]]) + moved_;
        // Turned around, the triangles of a mirrored object are counter-clockwise in front again.
        if (flipped_) std::swap(points[1], points[2]);
    }

    /// Calls visit(triangle) for every triangle that the ray may meet at t in [from, to].
    template <class Visit>
    void forEach(const SightRay& ray, double from, double to, Visit&& visit) const {
        const uint32_t count = static_cast<uint32_t>(mesh_.triangles());
        const glm::dmat3 inverse = glm::inverse(linear_);
        double condition = 0;
        for (int column = 0; column < 3; ++column)
            condition = std::max(condition, largest(linear_[column]) * largest(inverse[column]));
        if (count <= 64 || !(condition < 1e6)) {
            for (uint32_t triangle = 0; triangle < count; ++triangle) visit(triangle);
            return;
        }
        const glm::dvec3 origin = inverse * (ray.origin - moved_), direction = inverse * ray.direction;
        const double slack = 1e-9 * (largest(origin) + largest(facts_.bounds.min) + largest(facts_.bounds.max));
        facts_.triangles(mesh_).walk([&](const Box3d& box) { return meets(origin, direction, from, to, box, slack); },
                                     visit);
    }

private:
    const Mesh& mesh_;
    const MeshFacts& facts_;
    glm::dmat3 linear_;
    glm::dvec3 moved_;
    bool flipped_ = false;
    double rounding_ = 0;
};

double depthSlack(const SightRay& ray, double t) {
    return kEqualDepth * std::max(std::abs(t), largest(ray.origin + t * ray.direction));
}

}  // namespace

void ExactSight::corners(uint32_t object, uint32_t triangle, glm::dvec3 (&points)[3]) const {
    ObjectTriangles(facts_, object, sight_.eye()).corners(triangle, points);
}

/// Calls found(object, triangle, crossing) for triangles that hide and may be met at t in [from, to], until it returns true.
template <class Found>
void ExactSight::forEachHider(const SightRay& ray, double from, double to, uint32_t by_others_than,
                              Found&& found) const {
    const RayFrame frame(ray);
    const glm::dvec3 origin = ray.origin + sight_.eye();
    const double box_slack = 1e-12 * (largest(origin) + std::abs(to));
    bool done = false;
    const auto touches = [&](const Box3d& box) {
        return !done && meets(origin, ray.direction, from, to, box, box_slack);
    };
    facts_.distinct().walk(touches, [&](uint32_t object) {
        if (object == by_others_than || !touches(facts_.box(object))) return;
        const MeshFacts& mesh = facts_.facts(object);
        const ObjectTriangles triangles(facts_, object, sight_.eye());
        triangles.forEach(ray, from, to, [&](uint32_t triangle) {
            if (done || !mesh.hides[triangle]) return;
            glm::dvec3 points[3];
            triangles.corners(triangle, points);
            const Crossing met = cross(frame, points, triangles.rounding());
            if (!met.perhaps || !(met.front_perhaps || mesh.double_sided[triangle])) return;
            done = found(object, triangle, met);
        });
    });
}

bool ExactSight::hidden(const SightRay& ray, double t, uint32_t by_others_than) const {
    const double slack = depthSlack(ray, t);
    const double from = ray.t_near - slack, to = t - slack;
    if (by_others_than != kNobody && facts_.hasEqual(by_others_than))
        by_others_than = kNobody;  // an equal one is another
    bool found = false;
    forEachHider(ray, from, to, by_others_than, [&](uint32_t, uint32_t, const Crossing& met) {
        found = met.t >= from && met.t_low < to;
        return found;
    });
    return found;
}

void ExactSight::hidersOn(const SightRay& ray, std::vector<Met>& met) const {
    met.clear();
    const double slack = depthSlack(ray, ray.t_far), from = ray.t_near - slack, to = ray.t_far + slack;
    forEachHider(ray, from, to, kNobody, [&](uint32_t object, uint32_t triangle, const Crossing& crossing) {
        if (crossing.t >= from && crossing.t_low <= to) met.push_back({object, triangle});
        return false;
    });
}

double ExactSight::roundingOf(uint32_t object) const {
    return ObjectTriangles(facts_, object, sight_.eye()).rounding();
}

bool ExactSight::seesObject(const glm::dvec2& place, uint32_t object) const {
    const SightRay ray = sight_.rayThrough(place);
    const RayFrame frame(ray);
    const MeshFacts& mesh = facts_.facts(object);
    const ObjectTriangles triangles(facts_, object, sight_.eye());
    double nearest = std::numeric_limits<double>::infinity();
    triangles.forEach(ray, ray.t_near, ray.t_far, [&](uint32_t triangle) {
        glm::dvec3 points[3];
        triangles.corners(triangle, points);
        const Crossing met = cross(frame, points, triangles.rounding());
        if (!met.surely || !(met.front_surely || mesh.double_sided[triangle])) return;
        if (met.t >= ray.t_near && met.t <= ray.t_far) nearest = std::min(nearest, met.t);
    });
    if (!std::isfinite(nearest) || !sight_.inWindow(ray.origin + nearest * ray.direction)) return false;
    return !hidden(ray, nearest, object);
}

bool ExactSight::seesPoint(uint32_t object, uint32_t triangle, const glm::dvec3& point, glm::dvec2& place) const {
    return sight_.project(point, place) && seesPointOn(sight_.rayThrough(place), object, triangle, point);
}

bool ExactSight::seesPointOn(const SightRay& ray, uint32_t object, uint32_t triangle, const glm::dvec3& point) const {
    const ObjectTriangles triangles(facts_, object, sight_.eye());
    glm::dvec3 points[3];
    triangles.corners(triangle, points);
    const Crossing met = cross(RayFrame(ray), points, triangles.rounding());
    if (!met.has_area || !(met.front_surely || facts_.facts(object).double_sided[triangle])) return false;
    return !hidden(ray, glm::dot(point - ray.origin, ray.direction), object);
}

}  // namespace sightline::tools
