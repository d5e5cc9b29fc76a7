// Axis-aligned boxes, in float for what is packed and in double for what is placed in a world.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "sightline/math/glm_types.h"

namespace sightline {

/// min <= max on each axis, or empty (min > max). Touching counts as overlapping.
template <class T>
struct Box {
    using Vector = glm::vec<3, T, glm::defaultp>;

    Vector min{std::numeric_limits<T>::infinity()};
    Vector max{-std::numeric_limits<T>::infinity()};

    bool empty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
    Vector center() const { return T(0.5) * min + T(0.5) * max; }
    Vector size() const { return max - min; }
    /// @param i  bit 0: at the greatest x; bit 1: y; bit 2: z
    Vector corner(uint32_t i) const { return {i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z}; }
    void grow(const Vector& point) {
        min = glm::min(min, point);
        max = glm::max(max, point);
    }
    void grow(const Box& other) {
        min = glm::min(min, other.min);
        max = glm::max(max, other.max);
    }
    /// All of another box that is not empty, borders included.
    bool holds(const Box& other) const {
        for (int axis = 0; axis < 3; ++axis)
            if (!(min[axis] <= other.min[axis] && other.max[axis] <= max[axis])) return false;
        return true;
    }
    /// False if any bound is NaN or infinite; an empty box is not finite.
    bool finite() const {
        for (int axis = 0; axis < 3; ++axis)
            if (!std::isfinite(min[axis]) || !std::isfinite(max[axis])) return false;
        return true;
    }
};

using Box3f = Box<float>;
using Box3d = Box<double>;

/// The smallest box that holds a box carried through an affine transform, up to rounding: each
/// bound is moved outward by a few units in the last place of the terms it was summed from.
///
/// James Arvo. Transforming Axis-Aligned Bounding Boxes. Graphics Gems, 1990.
inline Box3d transformBox(const Box3d& box, const glm::dmat4& transform) {
    if (box.empty()) return box;
    Box3d out;
    for (int row = 0; row < 3; ++row) {
        double low = transform[3][row], high = low, size = std::abs(low);
        for (int column = 0; column < 3; ++column) {
            const double a = transform[column][row] * box.min[column];
            const double b = transform[column][row] * box.max[column];
            low += a < b ? a : b;
            high += a < b ? b : a;
            size += std::abs(a) > std::abs(b) ? std::abs(a) : std::abs(b);
        }
        const double slack = size * 0x1p-50;  // 7 roundings of at most 2^-53 of the size each
        out.min[row] = low - slack;
        out.max[row] = high + slack;
    }
    return out;
}

}  // namespace sightline
