// Index lists in which each triangle ends with a corner that is its own, so that it can carry what is the triangle's.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/studies/hidden/draw_item.h"

namespace sightline {
using namespace studies;

/// What one item draws: triangles that write depth and whose positions are finite. The GL hands a `flat` value of the
/// last corner to the whole triangle.
struct ProvokingMesh {
    static constexpr uint32_t kNone = ~0u;

    std::vector<uint32_t> position;              ///< per vertex: which of the mesh's positions
    std::vector<uint32_t> triangle;              ///< per vertex: which triangle it speaks for, or kNone
    std::vector<uint32_t> single, double_sided;  ///< indices of vertices  [size: 3 * triangles]
};

/// Corners are turned, never swapped: the winding stays. Vertices are doubled only where all three corners of a triangle
/// speak for others already.
ProvokingMesh makeProvoking(const DrawItem& item);

}  // namespace sightline
