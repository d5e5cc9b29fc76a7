// What a flat hider hides from every point of a convex region: a few planes.
// SPDX-License-Identifier: MIT
#include "sightline/bake/view_cells/region_shadow.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sightline/base/assert.h"

namespace sightline::bake {
namespace {

/// A corner of the region as an edge sees it.
struct OverEdge {
    double out = 0;     // away from the hider, at right angles to the edge
    double height = 1;  // above the edge
    bool operator<(const OverEdge& other) const { return out * other.height > other.out * height; }
};

}  // namespace

RegionShadow::RegionShadow(const FlatHider& hider, std::span<const glm::dvec3> corners, double reach) {
    SIGHTLINE_ASSERT(hider.corners.size() < kMost);
    const glm::dvec3 normal(hider.plane);
    double lowest = std::numeric_limits<double>::infinity();
    for (const glm::dvec3& corner : corners) lowest = std::min(lowest, glm::dot(normal, corner - hider.corners[0]));
    if (!(lowest > hider.bend)) return;

    const double rounding = 0x1p-48 * reach, lift = hider.bend / 2;
    planes_[0] = glm::dvec4(-normal, glm::dot(normal, hider.corners[0]) - lift - rounding);
    front_ = glm::dvec4(normal, -glm::dot(normal, hider.corners[0]) - lift - rounding);
    uint32_t count = 1;
    for (size_t i = 0; i < hider.corners.size(); ++i) {
        const glm::dvec3 &a = hider.corners[i], &b = hider.corners[(i + 1) % hider.corners.size()];
        const glm::dvec3 along = glm::normalize(b - a), inner = glm::cross(normal, along);
        const auto farthest = [&](double lifted) {
            OverEdge best;
            bool first = true;
            for (const glm::dvec3& corner : corners) {
                const OverEdge over{-glm::dot(inner, corner - a), glm::dot(normal, corner - a) - lifted};
                if (first || over < best) best = over;
                first = false;
            }
            return best;
        };
        OverEdge eye = farthest(lift);
        double lifted = lift;
        if (eye.out < 0) {
            eye = farthest(-lift);
            lifted = -lift;
        }
        const double length = std::hypot(eye.out, eye.height);
        // At right angles to the way from the eye to the edge.
        const glm::dvec3 inward = (eye.height * inner + eye.out * normal) / length;
        const glm::dvec3 on_edge = a + lifted * normal;
        const double margin = rounding * (1 + reach / length);
        planes_[count++] = glm::dvec4(inward, -glm::dot(inward, on_edge) - margin);
    }
    count_ = count;
}

}  // namespace sightline::bake
