// Curves that fill a box: orders of points in which neighbours in the order are neighbours in space, mostly.
// SPDX-License-Identifier: MIT
//
// G. M. Morton. A Computer Oriented Geodetic Data Base and a New Technique in File Sequencing. IBM, 1966.
// John Skilling. Programming the Hilbert Curve. 2004.
#pragma once

#include <algorithm>
#include <cstdint>

#include <glm/glm.hpp>

#include "sightline/math/box.h"

namespace sightline {

/// Spreads 21 bits to every third bit.
inline uint64_t everyThirdBit(uint64_t v) {
    v = (v | v << 32) & 0x1f00000000ffffull;
    v = (v | v << 16) & 0x1f0000ff0000ffull;
    v = (v | v << 8) & 0x100f00f00f00f00full;
    v = (v | v << 4) & 0x10c30c30c30c30c3ull;
    v = (v | v << 2) & 0x1249249249249249ull;
    return v;
}

/// Along the curve of Morton: 21 bits an axis. What is not in the box counts as at its nearest face.
inline uint64_t mortonCode(const glm::dvec3& point, const Box3d& around) {
    uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double size = around.max[axis] - around.min[axis];
        const double share = size > 0 ? (point[axis] - around.min[axis]) / size : 0;
        code |= everyThirdBit(static_cast<uint64_t>(std::clamp(share, 0.0, 1.0) * 0x1fffff)) << axis;
    }
    return code;
}

/// Along the curve of Hilbert, which never jumps: 10 bits an axis. It takes longer than the other.
/// @param x, y, z  of a cube's 1,024 cells an axis
inline uint32_t hilbertCode(uint32_t x, uint32_t y, uint32_t z) {
    constexpr uint32_t kHighest = 1u << 9;
    uint32_t axes[3] = {x, y, z};
    for (uint32_t bit = kHighest; bit > 1; bit >>= 1) {
        const uint32_t below = bit - 1;
        for (uint32_t& axis : axes) {
            const uint32_t flip = axis & bit ? below : 0, swap = (axes[0] ^ axis) & below & ~flip;
            axes[0] ^= flip | swap;
            axis ^= swap;
        }
    }
    axes[1] ^= axes[0];
    axes[2] ^= axes[1];
    uint32_t all = 0;
    for (uint32_t bit = kHighest; bit > 1; bit >>= 1) all ^= axes[2] & bit ? bit - 1 : 0;
    for (uint32_t& axis : axes) axis ^= all;
    return static_cast<uint32_t>(everyThirdBit(axes[0]) << 2 | everyThirdBit(axes[1]) << 1 | everyThirdBit(axes[2]));
}

}  // namespace sightline
