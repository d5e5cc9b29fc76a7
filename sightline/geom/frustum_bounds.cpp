// The box around what a frustum and a region have in common.
// SPDX-License-Identifier: MIT
#include "sightline/geom/frustum_bounds.h"

#include <algorithm>
#include <cmath>

namespace sightline {
namespace {

/// The largest a.x of a region, by weak duality: for weights w >= 0, n.x + d >= 0 gives
/// a.x <= (a + sum w n).x + sum w d, and the first term is bounded by the region alone.
struct Support {
    const Frustum& frustum;
    Box3d region;  ///< relative to the eye
    glm::dvec3 direction{0.0};
    double best = 0;

    /// Tries a set of planes with weights.
    template <size_t kCount>
    void offer(const uint32_t (&planes)[kCount], const double (&weights)[kCount]) {
        glm::dvec3 rest = direction;
        double bound = 0.0, size = 0.0;
        for (size_t i = 0; i < kCount; ++i) {
            if (!(weights[i] >= 0.0 && std::isfinite(weights[i]))) return;
            const glm::dvec4& p = frustum.planes[planes[i]];
            rest += weights[i] * glm::dvec3(p);
            bound += weights[i] * p.w;
            size += weights[i] * std::abs(p.w);
        }
        for (int axis = 0; axis < 3; ++axis) {
            const double low = rest[axis] * region.min[axis], high = rest[axis] * region.max[axis];
            double weight = 1.0;
            for (double w : weights) weight += w;
            bound += std::max(low, high);
            size += weight * std::max(std::abs(region.min[axis]), std::abs(region.max[axis]));
        }
        bound += 0x1p-44 * size;
        if (bound < best) best = bound;
    }

    /// The weights of `planes` that leave nothing of the direction on as many axes.
    void offerSingle(uint32_t plane, int axis) {
        const double n = frustum.planes[plane][axis];
        if (n * direction[axis] < 0.0) offer({plane}, {-direction[axis] / n});
    }
    void offerPair(uint32_t a, uint32_t b, int i, int j) {
        const glm::dvec4 &p = frustum.planes[a], &q = frustum.planes[b];
        const double area = p[i] * q[j] - p[j] * q[i];
        offer({a, b},
              {(direction[j] * q[i] - direction[i] * q[j]) / area, (direction[i] * p[j] - direction[j] * p[i]) / area});
    }
    void offerTriple(uint32_t a, uint32_t b, uint32_t c) {
        const glm::dvec3 p(frustum.planes[a]), q(frustum.planes[b]), r(frustum.planes[c]);
        const double volume = -glm::dot(p, glm::cross(q, r));
        offer({a, b, c},
              {glm::dot(direction, glm::cross(q, r)) / volume, glm::dot(p, glm::cross(direction, r)) / volume,
               glm::dot(p, glm::cross(q, direction)) / volume});
    }
};

}  // namespace

Box3d frustumBounds(const Frustum& frustum, const Box3d& within) {
    Box3d bounds;
    if (within.empty()) return bounds;
    const Box3d region{within.min - frustum.eye, within.max - frustum.eye};
    for (int axis = 0; axis < 3; ++axis) {
        for (const double sign : {-1.0, 1.0}) {
            Support support{frustum, region};
            support.direction[axis] = sign;
            support.best = sign > 0 ? region.max[axis] : -region.min[axis];
            for (uint32_t a = 0; a < frustum.count; ++a) {
                support.offerSingle(a, axis);
                for (uint32_t b = a + 1; b < frustum.count; ++b) {
                    support.offerPair(a, b, axis, (axis + 1) % 3);
                    support.offerPair(a, b, axis, (axis + 2) % 3);
                    for (uint32_t c = b + 1; c < frustum.count; ++c) support.offerTriple(a, b, c);
                }
            }
            // The eye's own place is rounded, too.
            const double slack = 0x1p-50 * (std::abs(frustum.eye[axis]) + std::abs(support.best));
            if (sign > 0) bounds.max[axis] = frustum.eye[axis] + support.best + slack;
            else bounds.min[axis] = frustum.eye[axis] - support.best - slack;
        }
    }
    return bounds.empty() ? Box3d() : bounds;
}

}  // namespace sightline
