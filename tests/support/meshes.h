// Meshes for tests, of triangles that are given one by one, as boxes and as grids.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/geom/mesh_view.h"

namespace sightline::test {

struct TestMesh {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;

    MeshView view() const { return {positions, indices}; }

    /// A convex polygon of vertices that are there.
    void fan(std::initializer_list<uint32_t> corners) {
        for (const uint32_t* v = corners.begin() + 2; v < corners.end(); ++v)
            indices.insert(indices.end(), {*corners.begin(), v[-1], *v});
    }
    /// A convex polygon with vertices of its own.
    void add(const std::vector<glm::vec3>& corners) {
        const auto first = static_cast<uint32_t>(positions.size());
        positions.insert(positions.end(), corners.begin(), corners.end());
        for (uint32_t k = 2; k < corners.size(); ++k) fan({first, first + k - 1, first + k});
    }
    void add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) { add({a, b, c}); }

    /// The quads between so many columns and rows of vertices that are there, row by row, from the first on.
    /// @param closed  quads join the last column with the first
    void addGrid(uint32_t columns, uint32_t rows, bool closed = false) {
        for (uint32_t y = 0; y + 1 < rows; ++y)
            for (uint32_t x = 0; x + !closed < columns; ++x) {
                const uint32_t a = y * columns + x, b = y * columns + (x + 1) % columns;
                fan({a, b, b + columns, a + columns});
            }
    }
};

/// The corners of a box's faces as seen from outside, counter-clockwise. Corner i is at the upper end of axis k where
/// bit k of i is set.
inline constexpr uint32_t kBoxFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                             {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

/// Twelve triangles over eight vertices, fronts outward.
inline TestMesh boxMesh(const glm::vec3& low = glm::vec3(0), const glm::vec3& high = glm::vec3(1)) {
    TestMesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
    for (const auto& f : kBoxFaces) mesh.fan({f[0], f[1], f[2], f[3]});
    return mesh;
}

}  // namespace sightline::test
