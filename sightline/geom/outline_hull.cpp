// Hulls by two chains, left to right and back, in the plane of two axes.
// SPDX-License-Identifier: MIT
#include "sightline/geom/outline_hull.h"

#include <algorithm>
#include <cmath>

namespace sightline {

std::vector<glm::dvec3> outlineHull(std::span<const glm::dvec3> points, const glm::dvec3& normal) {
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(normal[i]) > std::abs(normal[axis])) axis = i;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::vector<glm::dvec3> sorted(points.begin(), points.end()), hull;
    std::sort(sorted.begin(), sorted.end(),
              [&](const glm::dvec3& a, const glm::dvec3& b) { return a[u] != b[u] ? a[u] < b[u] : a[v] < b[v]; });
    sorted.erase(std::unique(sorted.begin(), sorted.end(),
                             [&](const glm::dvec3& a, const glm::dvec3& b) { return a[u] == b[u] && a[v] == b[v]; }),
                 sorted.end());
    if (sorted.size() < 3) return sorted;
    for (int pass = 0; pass < 2; ++pass) {
        const size_t begin = hull.size();
        for (const glm::dvec3& point : sorted) {
            while (hull.size() >= begin + 2) {
                const glm::dvec3 &a = hull[hull.size() - 2], &b = hull.back();
                if ((b[u] - a[u]) * (point[v] - a[v]) - (b[v] - a[v]) * (point[u] - a[u]) > 0) break;
                hull.pop_back();
            }
            hull.push_back(point);
        }
        hull.pop_back();
        std::reverse(sorted.begin(), sorted.end());
    }
    if (normal[axis] < 0) std::reverse(hull.begin(), hull.end());
    return hull;
}

}  // namespace sightline
