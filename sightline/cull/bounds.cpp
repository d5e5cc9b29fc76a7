// One bound against one view volume: spheres, boxes, oriented boxes and k-DOPs, with masks, and exactly where that is asked for.
// SPDX-License-Identifier: MIT
#include "sightline/cull/bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sightline/base/assert.h"

namespace sightline {
namespace {

// Each of a test's some twenty steps rounds by 2^-53 of the sizes it adds, and normals are of unit length to 2^-52.
constexpr double kBoundRounding = 0x1p-46;
// Sums of planes are as exact as their weights are small beside what is left of the normals: 2^-52 times at most 2^8.
constexpr double kSumRounding = 0x1p-38;
constexpr double kLeastSum = 0x1p-8;

/// How far a bound reaches along a plane's normal, and the sum of the sizes of all terms.
struct Reach {
    double least, most, size;
};

Reach reachOf(const Sphere& sphere, const glm::dvec3& eye, const glm::dvec3& n) {
    const glm::dvec3 c = sphere.center - eye;
    const double at = glm::dot(n, c);
    return {at - sphere.radius, at + sphere.radius,
            std::abs(c.x) + std::abs(c.y) + std::abs(c.z) + sphere.radius +
                0x1p-5 * (std::abs(sphere.center.x) + std::abs(sphere.center.y) + std::abs(sphere.center.z))};
}

Reach reachOf(const Box3d& box, const glm::dvec3& eye, const glm::dvec3& n) {
    Reach reach{0.0, 0.0, 0.0};
    for (int axis = 0; axis < 3; ++axis) {
        const double a = n[axis] * (box.min[axis] - eye[axis]), b = n[axis] * (box.max[axis] - eye[axis]);
        reach.least += std::min(a, b);
        reach.most += std::max(a, b);
        // The eye's share stands for the rounding of the difference.
        reach.size += std::abs(a) + std::abs(b) + 0x1p-5 * std::abs(n[axis] * eye[axis]);
    }
    return reach;
}

Reach reachOf(const OrientedBox& box, const glm::dvec3& eye, const glm::dvec3& n) {
    const glm::dvec3 c = box.center - eye;
    const double at = glm::dot(n, c);
    double radius = 0.0, size = glm::length(c) + 0x1p-5 * glm::length(eye);
    for (const glm::dvec3& half : box.half) {
        radius += std::abs(glm::dot(n, half));
        size += glm::length(half);
    }
    return {at - radius, at + radius, size};
}

/// The farthest that a 14-DOP can reach along a direction. For every three slabs that the direction lies between, the weighted
/// sum of their bounds is a limit; the least of all is the reach itself.
double dopReach(const Dop& dop, const glm::dvec3& n) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < Dop::kSlabs; ++i)
        for (int j = i + 1; j < Dop::kSlabs; ++j)
            for (int k = j + 1; k < Dop::kSlabs; ++k) {
                const glm::dmat3 m{Dop::kDirections[i], Dop::kDirections[j], Dop::kDirections[k]};
                const double determinant = glm::determinant(m);
                if (std::abs(determinant) < 0.5) continue;  // the three lie in a plane
                const glm::dvec3 weight = glm::inverse(m) * n;
                const int slabs[3] = {i, j, k};
                double sum = 0.0;
                for (int s = 0; s < 3; ++s)  // a negative weight turns the slab over
                    sum += weight[s] * (weight[s] >= 0.0 ? dop.max : dop.min)[slabs[s]];
                least = std::min(least, sum);
            }
    return least;
}

Reach reachOf(const Dop& dop, const glm::dvec3& eye, const glm::dvec3& n) {
    double size = glm::length(eye);  // a sum, so that what is not finite makes it so
    for (int slab = 0; slab < Dop::kSlabs; ++slab) size += std::abs(dop.min[slab]) + std::abs(dop.max[slab]);
    const double most = dopReach(dop, n), least = -dopReach(dop, -n), shift = -glm::dot(n, eye);
    return {least + shift, most + shift, size};
}

template <class Bound>
BoundAnswer test(const ViewVolume& volume, const Bound& bound, uint32_t active) {
    SIGHTLINE_DEBUG_ASSERT(volume.count <= ViewVolume::kMostPlanes);
    BoundAnswer answer;
    answer.outside = volume.empty;
    for (uint32_t i = 0; i < volume.count; ++i) {
        if (!(active >> i & 1)) continue;
        const glm::dvec4& plane = volume.planes[i];
        const Reach reach = reachOf(bound, volume.eye, glm::dvec3(plane));
        const double margin = kBoundRounding * (reach.size + std::abs(plane.w));
        answer.outside |= reach.most + plane.w < -margin;
        if (!(reach.least + plane.w >= margin)) answer.planes |= 1u << i;
    }
    return answer;
}

/// True if the box is on the outer side of a plane that is relative to `eye`.
template <class Bound>
bool beyond(const glm::dvec4& plane, const Bound& bound, const glm::dvec3& eye) {
    const Reach reach = reachOf(bound, eye, glm::dvec3(plane));
    return reach.most + plane.w < -kSumRounding * (reach.size + std::abs(plane.w));
}

/// The sum of an edge's planes that runs along an axis; false if there is none: the edge is not seen in
/// outline when one looks along the axis.
bool outlinePlane(const glm::dvec4& a, const glm::dvec4& b, const glm::dvec3& axis, glm::dvec4& plane) {
    const double u = glm::dot(glm::dvec3(a), axis), v = glm::dot(glm::dvec3(b), axis);
    if (!(u * v < 0.0)) return false;
    const glm::dvec4 sum = std::abs(v) * a + std::abs(u) * b;
    const double length = glm::length(glm::dvec3(sum));
    if (!(length > kLeastSum * (std::abs(u) + std::abs(v)))) return false;
    plane = sum / length;
    return true;
}

}  // namespace

OrientedBox orientedBox(const Box3d& box, const glm::dmat4& transform) {
    OrientedBox out;
    const glm::dvec3 half = 0.5 * box.max - 0.5 * box.min;
    out.center = glm::dvec3(transform * glm::dvec4(box.center(), 1.0));
    for (int axis = 0; axis < 3; ++axis) {
        const double outward = half[axis] + 0x1p-50 * (std::abs(box.min[axis]) + std::abs(box.max[axis]));
        out.half[axis] = glm::dvec3(transform[axis]) * outward;
    }
    return out;
}

Dop::Dop() {
    std::fill_n(min, kSlabs, std::numeric_limits<double>::infinity());
    std::fill_n(max, kSlabs, -std::numeric_limits<double>::infinity());
}

void Dop::grow(const glm::dvec3& point) {
    for (int slab = 0; slab < kSlabs; ++slab) {
        const glm::dvec3 terms = kDirections[slab] * point;
        const double at = terms.x + terms.y + terms.z;
        const double slack = slab < 3 ? 0.0 : 0x1p-51 * (std::abs(terms.x) + std::abs(terms.y) + std::abs(terms.z));
        min[slab] = std::min(min[slab], at - slack);
        max[slab] = std::max(max[slab], at + slack);
    }
}

BoundAnswer testBound(const ViewVolume& volume, const Sphere& sphere, uint32_t active) {
    return test(volume, sphere, active);
}

BoundAnswer testBound(const ViewVolume& volume, const Box3d& box, uint32_t active) { return test(volume, box, active); }

BoundAnswer testBound(const ViewVolume& volume, const OrientedBox& box, uint32_t active) {
    return test(volume, box, active);
}

BoundAnswer testBound(const ViewVolume& volume, const Dop& dop, uint32_t active) { return test(volume, dop, active); }

double distanceTo(const ViewVolume& volume, const glm::dvec3& point) {
    SIGHTLINE_DEBUG_ASSERT(volume.count <= ViewVolume::kMostPlanes);
    const glm::dvec4* planes = volume.planes;
    double depth[ViewVolume::kMostPlanes];  // how far outside
    double farthest = 0.0;
    for (uint32_t i = 0; i < volume.count; ++i) {
        depth[i] = -(glm::dot(glm::dvec3(planes[i]), point - volume.eye) + planes[i].w);
        farthest = std::max(farthest, depth[i]);
    }
    if (farthest == 0.0) return 0.0;
    // A sum of planes with weights >= 0 holds the volume, and is as far from the point as its depth over the length of its
    // normal: whatever the weights, that is no more than the distance. Those that solve (Gram matrix) * w = depths are best.
    const auto take = [&](const glm::dvec3& w, const glm::dvec3& sum, double total_depth) {
        const double length = glm::length(sum);
        if (length > 1e-4 * (w.x + w.y + w.z)) farthest = std::max(farthest, total_depth / length);
    };
    for (uint32_t i = 0; i < volume.count; ++i)
        for (uint32_t j = i + 1; j < volume.count; ++j) {
            const glm::dvec3 a(planes[i]), b(planes[j]);
            const double c = glm::dot(a, b);
            const glm::dvec3 pair(depth[i] - c * depth[j], depth[j] - c * depth[i], 0.0);
            if (pair.x >= 0.0 && pair.y >= 0.0)
                take(pair, pair.x * a + pair.y * b, pair.x * depth[i] + pair.y * depth[j]);
            for (uint32_t k = j + 1; k < volume.count; ++k) {
                const glm::dmat3 normals{a, b, glm::dvec3(planes[k])};
                if (!(std::abs(glm::determinant(normals)) > 1e-12)) continue;
                const glm::dvec3 depths(depth[i], depth[j], depth[k]);
                const glm::dmat3 inverse = glm::inverse(normals);
                const glm::dvec3 w =
                    inverse * (depths * inverse);  // the corner is at -(depths * inverse) from the point
                if (w.x >= 0.0 && w.y >= 0.0 && w.z >= 0.0) take(w, normals * w, glm::dot(w, depths));
            }
        }
    return farthest;
}

bool surelyOutside(const ViewVolume& volume, const Sphere& sphere) {
    if (volume.empty) return true;
    const glm::dvec3 c = sphere.center - volume.eye;
    const double size = glm::length(c) + sphere.radius + 0x1p-5 * glm::length(sphere.center);
    return distanceTo(volume, sphere.center) > sphere.radius + 1e-11 * size;
}

bool separated(const ViewVolume& volume, const OrientedBox& box, Refinement refinement) {
    if (refinement == Refinement::kNone) return false;
    glm::dvec4 plane;
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 face = glm::cross(box.half[(axis + 1) % 3], box.half[(axis + 2) % 3]);
        for (const double sign : {1.0, -1.0})
            if (supportPlane(volume, sign * face, plane) && beyond(plane, box, volume.eye)) return true;
    }
    if (refinement == Refinement::kCorners) return false;
    PlanePair edges[3 * ViewVolume::kMostPlanes];
    const uint32_t count = edgesOf(volume, edges);
    for (uint32_t i = 0; i < count; ++i)
        for (const glm::dvec3& half : box.half)
            if (outlinePlane(volume.planes[edges[i].first], volume.planes[edges[i].second], half, plane) &&
                beyond(plane, box, volume.eye))
                return true;
    return false;
}

RefinedVolume refineVolume(const ViewVolume& volume, Refinement refinement) {
    RefinedVolume refined;
    refined.volume = volume;
    glm::dvec4 plane;
    if (refinement == Refinement::kNone) return refined;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 normal(0.0);
        for (const double sign : {1.0, -1.0}) {
            normal[axis] = sign;
            if (supportPlane(volume, normal, plane)) refined.axes[refined.axis_count++] = plane;
        }
    }
    SIGHTLINE_DEBUG_ASSERT(refined.axis_count <= std::size(refined.axes));
    if (refinement == Refinement::kCorners) return refined;
    PlanePair edges[3 * ViewVolume::kMostPlanes];
    const uint32_t count = edgesOf(volume, edges);
    for (uint32_t i = 0; i < count; ++i)
        for (int axis = 0; axis < 3 && refined.crossed_count < RefinedVolume::kMostCrossed; ++axis) {
            glm::dvec3 along(0.0);
            along[axis] = 1.0;
            if (outlinePlane(volume.planes[edges[i].first], volume.planes[edges[i].second], along, plane))
                refined.crossed[refined.crossed_count++] = plane;
        }
    return refined;
}

bool separated(const RefinedVolume& refined, const Box3d& box, Refinement refinement) {
    SIGHTLINE_DEBUG_ASSERT(refined.axis_count <= std::size(refined.axes) &&
                           refined.crossed_count <= RefinedVolume::kMostCrossed);
    if (refinement == Refinement::kNone) return false;
    for (uint32_t i = 0; i < refined.axis_count; ++i)
        if (beyond(refined.axes[i], box, refined.volume.eye)) return true;
    if (refinement == Refinement::kCorners) return false;
    for (uint32_t i = 0; i < refined.crossed_count; ++i)
        if (beyond(refined.crossed[i], box, refined.volume.eye)) return true;
    return false;
}

}  // namespace sightline
