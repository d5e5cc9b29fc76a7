// Makes the volumes from which clusters are seen from their backs, and measures how much of space they are.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/facing/culling_volume.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sightline/math/round_outward.h"

namespace sightline {
namespace {

/// The largest n * q over the box of normals.
double highest(const CullingVolume& volume, const glm::dvec3& q) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis)
        sum += std::max(double(volume.most[axis]) * q[axis], double(volume.least[axis]) * q[axis]);
    return sum;
}

}  // namespace

CullingVolume cullingVolumeAt(std::span<const Facet> facets, const glm::vec3& origin) {
    CullingVolume volume;
    volume.origin = origin;
    glm::dvec3 most(-2.0), least(2.0);
    double back = 1e300, front = -1e300, reach = 0;
    for (const Facet& facet : facets) {
        if (facet.normal == glm::dvec3(0.0)) return volume;
        const glm::dvec3 from = facet.corner[0] - glm::dvec3(origin);
        const double at = glm::dot(facet.normal, from);
        most = glm::max(most, facet.normal);
        least = glm::min(least, facet.normal);
        back = std::min(back, at);
        front = std::max(front, at);
        reach = std::max(reach, taxicabLength(from));
    }
    if (facets.empty()) return volume;
    const double error = 2.0 * kNormalError * reach;
    for (int axis = 0; axis < 3; ++axis) {
        volume.most[axis] = roundUp(most[axis] + kNormalError);
        volume.least[axis] = roundDown(least[axis] - kNormalError);
    }
    volume.back = roundDown(back - error);
    volume.front = roundUp(front + error);
    return volume;
}

CullingVolume makeCullingVolume(std::span<const Facet> facets, const Box3d& eyes) {
    Box3d box;
    for (const Facet& facet : facets)
        for (const glm::dvec3& p : facet.corner) box.grow(p);
    if (facets.empty()) return {};
    CullingVolume best = cullingVolumeAt(facets, glm::vec3(box.center()));
    double largest = cullingProbability(best, eyes);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 origin(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                               corner & 4 ? box.max.z : box.min.z);
        const CullingVolume volume = cullingVolumeAt(facets, origin);
        const double share = cullingProbability(volume, eyes);
        if (share > largest) best = volume, largest = share;
    }
    return best;
}

TurnedBox makeTurnedBox(std::span<const Facet> facets) {
    TurnedBox turned;
    glm::dvec3 mean(0.0);
    for (const Facet& facet : facets) mean += facet.normal;
    const double length = glm::length(mean);
    if (!(length > 1e-6)) return turned;
    const glm::dvec3 ahead = mean / length;
    const glm::dvec3 other = std::abs(ahead.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 across = glm::normalize(glm::cross(other, ahead));
    turned.axes[0] = glm::vec3(across);
    turned.axes[1] = glm::vec3(glm::cross(ahead, across));
    turned.axes[2] = glm::vec3(ahead);
    glm::dvec3 most(-2.0), least(2.0);
    for (const Facet& facet : facets) {
        if (facet.normal == glm::dvec3(0.0)) return {};
        for (int k = 0; k < 3; ++k) {
            const double along = glm::dot(glm::dvec3(turned.axes[k]), facet.normal);
            most[k] = std::max(most[k], along);
            least[k] = std::min(least[k], along);
        }
    }
    for (int k = 0; k < 3; ++k) {
        turned.most[k] = roundUp(most[k] + 2.0 * kNormalError);
        turned.least[k] = roundDown(least[k] - 2.0 * kNormalError);
    }
    return turned;
}

CullingVolume joinVolumes(const CullingVolume& a, const CullingVolume& b, const glm::vec3& origin) {
    CullingVolume joined;
    joined.origin = origin;
    joined.most = glm::max(a.most, b.most);
    joined.least = glm::min(a.least, b.least);
    double back = 1e300, front = -1e300;
    for (const CullingVolume* one : {&a, &b}) {
        // n * (p - c') = n * (p - c) - n * (c' - c), whatever the normal.
        const glm::dvec3 moved = glm::dvec3(origin) - glm::dvec3(one->origin);
        const double error = 0x1p-48 * taxicabLength(moved);
        back = std::min(back, one->back - highest(*one, moved) - error);
        front = std::max(front, one->front + highest(*one, -moved) + error);
    }
    joined.back = roundDown(back);
    joined.front = roundUp(front);
    return joined;
}

double volumeBelow(const glm::dvec3& sides, const glm::dvec3& weight, double limit) {
    const double whole = sides.x * sides.y * sides.z;
    if (!(whole > 0)) return 0;
    // From the corner where the sum is least, all weights are positive.
    double reach[3], total = 0, largest = 0;
    for (int k = 0; k < 3; ++k) {
        reach[k] = weight[k] * sides[k];
        if (reach[k] < 0) limit -= reach[k], reach[k] = -reach[k];
        total += reach[k];
        largest = std::max(largest, reach[k]);
    }
    if (limit < 0 || total == 0) return limit >= 0 ? whole : 0;
    if (limit >= total) return whole;
    // Sums of cubes lose what a small weight adds: such an axis is taken by its middle.
    int used = 0;
    double left[3];
    for (const double r : reach) {
        if (r < 1e-3 * largest) limit -= 0.5 * r;
        else left[used++] = r;
    }
    double sum = 0, divisor = 1;
    for (int k = 0; k < used; ++k) divisor *= (k + 1) * left[k];
    for (int set = 0; set < 1 << used; ++set) {
        double rest = limit;
        for (int k = 0; k < used; ++k)
            if (set >> k & 1) rest -= left[k];
        if (rest <= 0) continue;
        const double power = used == 3 ? rest * rest * rest : used == 2 ? rest * rest : rest;
        sum += std::popcount(static_cast<unsigned>(set)) % 2 ? -power : power;
    }
    return whole * std::clamp(sum / divisor, 0.0, 1.0);
}

double cullingProbability(const CullingVolume& volume, const Box3d& eyes) {
    const glm::dvec3 origin(volume.origin), size = eyes.max - eyes.min;
    double sum = 0;
    for (int octant = 0; octant < 8; ++octant) {
        glm::dvec3 low, sides, weight;
        bool empty = false;
        for (int axis = 0; axis < 3; ++axis) {
            const bool above = octant >> axis & 1;
            const double from = eyes.min[axis] - origin[axis], to = eyes.max[axis] - origin[axis];
            low[axis] = above ? std::max(from, 0.0) : from;
            sides[axis] = (above ? to : std::min(to, 0.0)) - low[axis];
            weight[axis] = above ? volume.most[axis] : volume.least[axis];
            empty |= !(sides[axis] > 0);
        }
        if (!empty) sum += volumeBelow(sides, weight, volume.back - glm::dot(weight, low));
    }
    return sum / (size.x * size.y * size.z);
}

}  // namespace sightline
