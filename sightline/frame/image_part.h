// The part of an image that one traversal answers for: the whole image, or a strip of it.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/base/assert.h"
#include "sightline/cull/occlusion.h"

namespace sightline::detail {

/// A range of columns of tiles of the occlusion buffer. Other parts answer for what lies beside it. The outermost parts
/// reach beyond the buffer.
struct ImagePart {
    static constexpr uint32_t kMost = 16;

    uint32_t first_column = 0, end_column = 0;  ///< [tiles]; not used if the part is the whole image
    bool leftmost = true, rightmost = true;

    bool whole() const { return leftmost && rightmost; }
    /// Whether a box surely lies beside the part.
    /// @param from  the screen, seen from the box's space
    bool misses(const Screen& from, const Box3f& box) const {
        return (!leftmost && isLeftOf(from, box, 8.0 * first_column)) ||
               (!rightmost && isRightOf(from, box, 8.0 * end_column));
    }
};

/// A part of equal width.
/// @param columns  of the buffer  [tiles]
inline ImagePart imagePart(uint32_t index, uint32_t count, uint32_t columns) {
    SIGHTLINE_DEBUG_ASSERT(index < count && count <= ImagePart::kMost && count <= columns);
    const auto border = [&](uint64_t i) { return static_cast<uint32_t>(columns * i / count); };
    return {border(index), border(index + 1), index == 0, index + 1 == count};
}

}  // namespace sightline::detail
