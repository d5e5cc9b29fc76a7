// Makes the cones from which clusters are seen from their backs.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/facing/facing_cone.h"

#include <algorithm>
#include <cmath>

#include "sightline/math/box.h"
#include "sightline/math/round_outward.h"

namespace sightline {
namespace {

/// The normal that is farthest from an axis, and how far: their least product.
double leastAlong(std::span<const Facet> facets, const glm::dvec3& axis, size_t& farthest) {
    double least = 2;
    for (size_t i = 0; i < facets.size(); ++i) {
        const double along = glm::dot(facets[i].normal, axis);
        if (along < least) least = along, farthest = i;
    }
    return least;
}

}  // namespace

FacingCone makeFacingCone(std::span<const Facet> facets) {
    FacingCone cone;
    glm::dvec3 middle(0.0);
    Box3d box;
    for (const Facet& facet : facets) {
        if (facet.normal == glm::dvec3(0.0)) return cone;
        middle += facet.normal;
        for (const glm::dvec3& p : facet.corner) box.grow(p);
    }
    const double length = glm::length(middle);
    if (!(length > 1e-6)) return cone;
    // Steps towards the farthest one, ever smaller, lead to the middle of the ball; the best axis on the way is kept.
    constexpr int kSteps = 32;
    glm::dvec3 best(0.0);
    double best_least = -2;
    middle /= static_cast<double>(facets.size());
    for (int step = 0; step < kSteps; ++step) {
        const double size = glm::length(middle);
        if (!(size > 1e-6)) break;
        size_t farthest = 0;
        const double least = leastAlong(facets, middle / size, farthest);
        if (least > best_least) best_least = least, best = middle / size;
        middle += (facets[farthest].normal - middle) / (step + 3.0);
    }
    if (best == glm::dvec3(0.0)) return cone;  // all normals together lead nowhere
    const glm::vec3 axis(best);
    const double axis_length = glm::length(glm::dvec3(axis));
    size_t farthest = 0;
    const double least = leastAlong(facets, glm::dvec3(axis) / axis_length, farthest) - 2.0 * kNormalError;
    if (!(least > 0.02)) return cone;
    const glm::dvec3 center = box.center();
    double depth = -1e300, reach = 0;
    for (const Facet& facet : facets) {
        const glm::dvec3 from = center - facet.corner[0];
        depth = std::max(depth, glm::dot(facet.normal, from) / glm::dot(facet.normal, glm::dvec3(axis)));
        reach = std::max(reach, glm::length(from));
    }
    // Far enough back for the rounding of the normals and of the apex itself.
    depth += (4.0 * kNormalError * reach + 0x1p-22 * (glm::length(center) + std::abs(depth))) / least;
    cone.axis = axis;
    cone.apex = glm::vec3(center - depth * glm::dvec3(axis));
    // The axis is a little longer or shorter than 1, and the cutoff by as much more.
    cone.cutoff = roundUp(std::sqrt(std::max(0.0, 1.0 - least * least)) * axis_length + 0x1p-22);
    return cone;
}

}  // namespace sightline
