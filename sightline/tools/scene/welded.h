// Corners of a mesh that lie in one place.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// Numbers of the places of a mesh's positions, from 0 in the order in which they are met: equal positions have one
/// number, whatever the sign of a zero. O(n log n).
/// @return  [size: positions]
inline std::vector<uint32_t> weldedPositions(const Mesh& mesh) {
    std::map<std::array<float, 3>, uint32_t> places;
    std::vector<uint32_t> out;
    for (const glm::vec3& p : mesh.positions) {
        const std::array<float, 3> key = {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};  // no zero has a sign
        out.push_back(places.try_emplace(key, static_cast<uint32_t>(places.size())).first->second);
    }
    return out;
}

}  // namespace sightline::tools
