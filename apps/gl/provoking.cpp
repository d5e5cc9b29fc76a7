// Index lists in which each triangle ends with a corner that is its own, so that it can carry what is the triangle's.
// SPDX-License-Identifier: MIT
#include "apps/gl/provoking.h"

#include <cmath>
#include <numeric>

namespace sightline {
using namespace studies;
namespace {

bool isFinite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

}  // namespace

ProvokingMesh makeProvoking(const DrawItem& item) {
    const MeshView& mesh = item.mesh;
    ProvokingMesh made;
    made.position.resize(mesh.positions.size());
    std::iota(made.position.begin(), made.position.end(), 0u);
    made.triangle.assign(mesh.positions.size(), ProvokingMesh::kNone);
    for (uint32_t t = 0; t < mesh.triangles(); ++t) {
        if (!item.writes_depth.empty() && item.writes_depth[t] == 0) continue;
        const uint32_t* corners = &mesh.indices[3 * size_t{t}];
        bool finite = true;
        for (int k = 0; k < 3; ++k) finite = finite && isFinite(mesh.positions[corners[k]]);
        if (!finite) continue;
        int own = 2;
        for (int k = 0; k < 3; ++k)
            if (made.triangle[corners[k]] == ProvokingMesh::kNone) own = k;
        uint32_t last = corners[own];
        if (made.triangle[last] != ProvokingMesh::kNone) {
            made.position.push_back(last);
            last = static_cast<uint32_t>(made.triangle.size());
            made.triangle.push_back(ProvokingMesh::kNone);
        }
        made.triangle[last] = t;
        const bool both = !item.double_sided.empty() && item.double_sided[t] != 0;
        std::vector<uint32_t>& list = both ? made.double_sided : made.single;
        list.insert(list.end(), {corners[(own + 1) % 3], corners[(own + 2) % 3], last});
    }
    return made;
}

}  // namespace sightline
