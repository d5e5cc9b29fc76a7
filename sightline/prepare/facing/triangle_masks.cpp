// Makes the masks that say, per sector of space around a cluster, which of its triangles are seen from their backs.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/facing/triangle_masks.h"

#include <algorithm>
#include <cmath>

#include "sightline/math/box.h"
#include "sightline/math/round_outward.h"

namespace sightline {

TriangleMasks addTriangleMasks(std::span<const Facet> facets, const glm::dvec3& shape, uint32_t steps,
                               Array<uint64_t>& words) {
    TriangleMasks masks;
    masks.first_word = static_cast<uint32_t>(words.size());
    const size_t words_each = (facets.size() + 63) / 64;
    words.resize(words.size() + 6 * steps * steps * words_each, 0);
    Box3d box;
    for (const Facet& facet : facets)
        for (const glm::dvec3& p : facet.corner) box.grow(p);
    if (facets.empty()) return masks;
    masks.center = glm::vec3(box.center());
    const glm::dvec3 center(masks.center);
    double half = 0;
    for (int axis = 0; axis < 3; ++axis)
        half = std::max(
            {half, (box.max[axis] - center[axis]) / shape[axis], (center[axis] - box.min[axis]) / shape[axis]});
    masks.half = roundUp(half * (1.0 + 0x1p-20));
    // The eye's sector is found in float: each is as much wider.
    constexpr double kWider = 0x1p-16;
    // Normals and distances are off by kNormalError, of which a flat shape makes more.
    constexpr double kDoubt = 256.0 * kNormalError;
    for (uint32_t sector = 0; sector < 6 * steps * steps; ++sector) {
        const uint32_t face = sector / (steps * steps), row = sector / steps % steps, column = sector % steps;
        const int axis = static_cast<int>(face / 2);
        glm::dvec3 corner[4];
        for (uint32_t k = 0; k < 4; ++k) {
            const auto at = [&](uint32_t cell, bool end) {
                return 2.0 * (cell + (end ? 1 : 0)) / steps - 1.0 + (end ? kWider : -kWider);
            };
            corner[k][axis] = face % 2 ? -1.0 : 1.0;
            corner[k][(axis + 1) % 3] = at(column, k & 1);
            corner[k][(axis + 2) % 3] = at(row, k & 2);
        }
        uint64_t* const bits = words.data() + masks.first_word + sector * words_each;
        for (size_t i = 0; i < facets.size(); ++i) {
            const Facet& facet = facets[i];
            if (facet.normal == glm::dvec3(0.0)) continue;
            // In the space where the box is a cube.
            const glm::dvec3 scaled = facet.normal * shape, from = (center - facet.corner[0]) / shape;
            const double size = glm::length(scaled);
            const glm::dvec3 n = scaled / size;
            const double at = glm::dot(n, from);
            bool back = true;
            for (const glm::dvec3& d : corner) {
                const double along = glm::dot(n, d);
                back &= along <= -kDoubt;
                back &= at + masks.half * along <= -kDoubt * (glm::length(from) + masks.half);
            }
            if (back) bits[i / 64] |= uint64_t{1} << i % 64;
        }
    }
    return masks;
}

}  // namespace sightline
