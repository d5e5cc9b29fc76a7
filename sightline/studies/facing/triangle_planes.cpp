// Makes the planes of a mesh's triangles.
// SPDX-License-Identifier: MIT
#include "sightline/studies/facing/triangle_planes.h"

#include <algorithm>

#include "sightline/math/box.h"
#include "sightline/prepare/facing/unit_normal.h"

namespace sightline::studies {

TrianglePlanes makeTrianglePlanes(const MeshView& mesh, Memory* memory) {
    TrianglePlanes planes(memory);
    planes.count = mesh.triangles();
    const size_t padded =
        (planes.count + TrianglePlanes::kPadding - 1) / TrianglePlanes::kPadding * TrianglePlanes::kPadding;
    for (Array<float>* numbers : {&planes.x, &planes.y, &planes.z, &planes.d}) numbers->assign(padded, 0.0f);
    Box3d box;
    for (const uint32_t index : mesh.indices) box.grow(glm::dvec3(mesh.positions[index]));
    if (planes.count) planes.origin = box.center();
    for (size_t i = 0; i < planes.count; ++i) {
        const glm::vec3 corner[3] = {mesh.positions[mesh.indices[3 * i]], mesh.positions[mesh.indices[3 * i + 1]],
                                     mesh.positions[mesh.indices[3 * i + 2]]};
        for (const glm::vec3& p : corner) {
            const glm::dvec3 q = glm::abs(glm::dvec3(p) - planes.origin);
            planes.reach = std::max(planes.reach, q.x + q.y + q.z);
        }
        const glm::dvec3 n = unitNormal(corner[0], corner[1], corner[2]);
        planes.x[i] = static_cast<float>(n.x);
        planes.y[i] = static_cast<float>(n.y);
        planes.z[i] = static_cast<float>(n.z);
        planes.d[i] = static_cast<float>(-glm::dot(n, glm::dvec3(corner[0]) - planes.origin));
    }
    return planes;
}

}  // namespace sightline::studies
