// A mesh's triangles by the direction in which they face: two bytes each.
// SPDX-License-Identifier: MIT
//
// Hansong Zhang, Kenneth Hoff. Fast Backface Culling Using Normal Masks. 1997.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sightline/base/array.h"

namespace sightline {

/// Where column or row i of a face of the cube of directions begins, in the component over the largest one: steps that are of
/// nearly equal angles, the tangent's shape by a cubic.
/// @param i  0 to cells
inline double classBorder(int i, int cells) {
    const double t = 2.0 * i / cells - 1.0;
    return t * (0.79 + 0.21 * t * t);
}

/// The cube of directions cut into 6 * cells * cells classes: by the axis of the largest component and its sign, then by
/// the other two over that one, at the classBorder()s. prepare/facing/normal_classes.h makes it.
struct NormalClasses {
    static constexpr int kMaxCells = 18;  ///< so that a byte's number fits into a byte
    static constexpr size_t kPadding = 64;

    /// Of each triangle's class: the byte of a mask and the bit in it. Where rounding hides how a triangle faces, the bit
    /// is 0: no mask culls it.
    Array<uint8_t> byte, bit;  ///< [size: count rounded up to kPadding]
    size_t count = 0;
    int cells = 16;

    explicit NormalClasses(Memory* memory = defaultMemory()) : byte(memory), bit(memory) {}
};

}  // namespace sightline
