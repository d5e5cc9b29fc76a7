// The planes of a frustum in float, for boxes around an origin.
// SPDX-License-Identifier: MIT
#include "sightline/cull/relative_planes.h"

#include <cmath>

#include "sightline/base/assert.h"

namespace sightline {

RelativePlanes relativePlanes(const Frustum& frustum, const glm::dvec3& origin, float reach) {
    SIGHTLINE_DEBUG_ASSERT(frustum.count <= std::size(frustum.planes) && reach >= 0);
    constexpr float kRounding = 0x1p-19f;  // as in cullFrustum()
    RelativePlanes planes;
    planes.count = frustum.count;
    const glm::dvec3 shift = origin - frustum.eye;
    for (uint32_t i = 0; i < frustum.count; ++i) {
        const glm::dvec4& p = frustum.planes[i];
        double size = std::abs(p.w) + std::abs(glm::dot(glm::dvec3(p), shift));
        for (int axis = 0; axis < 3; ++axis) {
            planes.normal[i][axis] = static_cast<float>(p[axis]);
            size += std::abs(p[axis]) * reach;
        }
        planes.distance[i] = static_cast<float>(p.w + glm::dot(glm::dvec3(p), shift) + kRounding * size);
    }
    return planes;
}

}  // namespace sightline
