// A dense closed surface, for cases that need triangles.
// SPDX-License-Identifier: MIT
#include "bench/statue.h"

#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace sightline::bench {
using namespace tools;

Mesh makeStatue(uint32_t divisions) {
    Mesh mesh;
    mesh.name = "statue";
    std::map<std::array<int, 3>, uint32_t> known;
    const int n = static_cast<int>(divisions);
    const auto vertex = [&](int x, int y, int z) {
        const auto [at, fresh] = known.try_emplace({x, y, z}, static_cast<uint32_t>(mesh.positions.size()));
        if (fresh) {
            const glm::dvec3 d = glm::normalize(glm::dvec3(x, y, z));
            const double bumps = std::sin(9.0 * d.x) * std::sin(7.0 * d.y + 1.0) * std::sin(8.0 * d.z + 2.0);
            mesh.positions.push_back(glm::vec3(d * (1.0 + 0.08 * bumps)));
            mesh.bounds.grow(glm::dvec3(mesh.positions.back()));
        }
        return at->second;
    };
    for (int face = 0; face < 8; ++face) {
        const int sx = face & 1 ? -1 : 1, sy = face & 2 ? -1 : 1, sz = face & 4 ? -1 : 1;
        const auto corner = [&](int i, int j) { return vertex(sx * (n - i - j), sy * i, sz * j); };
        const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
            if (sx * sy * sz < 0) std::swap(b, c);
            for (const uint32_t v : {a, b, c}) mesh.indices.push_back(v);
        };
        for (int i = 0; i < n; ++i)
            for (int j = 0; i + j < n; ++j) {
                add(corner(i, j), corner(i + 1, j), corner(i, j + 1));
                if (i + j + 1 < n) add(corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1));
            }
    }
    mesh.primitives.push_back({0, static_cast<uint32_t>(mesh.triangles()), 0});
    return mesh;
}

}  // namespace sightline::bench
