// Triangles of Assimp's faces, over positions that are joined where they are the same.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace sightline::import {

/// Positions of one mesh without repetition. Only the very same numbers are the same; 0 and -0 are.
class PositionPool {
public:
    /// @param expected  how many positions may come
    explicit PositionPool(size_t expected);

    /// The index of a position, which is new or was there.
    uint32_t add(const glm::vec3& position);

    std::vector<glm::vec3> positions;

private:
    void grow();

    std::vector<uint32_t> slots_;  ///< hash table of indices + 1; its size is a power of two
};

/// Cuts a polygon into triangles and appends their corners. No area is lost and none added to a polygon that is planar
/// and does not meet itself: convex ones become fans, others have their ears cut. Of others, what has no ear becomes a fan.
/// @param corners  positions in order [size: count >= 3]
/// @param out      three indices into `corners` a triangle
void cutPolygon(const std::vector<glm::dvec3>& corners, std::vector<uint32_t>& out);

}  // namespace sightline::import
