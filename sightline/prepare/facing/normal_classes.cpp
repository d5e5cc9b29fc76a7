// Sorts a mesh's triangles into classes by the direction in which they face.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/facing/normal_classes.h"

#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/prepare/facing/unit_normal.h"

namespace sightline {

int normalClass(const glm::dvec3& direction, int cells) {
    const glm::dvec3 size = glm::abs(direction);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int face = 2 * axis + (direction[axis] < 0 ? 1 : 0);
    const auto step = [&](int other) {
        const double along = direction[other % 3] / size[axis];
        int low = 0;
        for (int high = cells; high - low > 1;) {
            const int middle = (low + high) / 2;
            (along >= classBorder(middle, cells) ? low : high) = middle;
        }
        return low;
    };
    return (face * cells + step(axis + 2)) * cells + step(axis + 1);
}

NormalClasses makeNormalClasses(const MeshView& mesh, int cells, Memory* memory) {
    SIGHTLINE_ASSERT(cells >= 1 && cells <= NormalClasses::kMaxCells);
    NormalClasses classes(memory);
    classes.cells = cells;
    classes.count = mesh.triangles();
    const size_t padded =
        (classes.count + NormalClasses::kPadding - 1) / NormalClasses::kPadding * NormalClasses::kPadding;
    classes.byte.assign(padded, 0);
    classes.bit.assign(padded, 0);
    for (size_t i = 0; i < classes.count; ++i) {
        const glm::dvec3 n = unitNormal(mesh.positions[mesh.indices[3 * i]], mesh.positions[mesh.indices[3 * i + 1]],
                                        mesh.positions[mesh.indices[3 * i + 2]]);
        if (n == glm::dvec3(0.0)) continue;
        const int number = normalClass(n, cells);
        classes.byte[i] = static_cast<uint8_t>(number >> 3);
        classes.bit[i] = static_cast<uint8_t>(1u << (number & 7));
    }
    return classes;
}

}  // namespace sightline
