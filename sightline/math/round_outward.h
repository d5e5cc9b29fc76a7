// Boxes from double to float, never smaller than they were.
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "sightline/math/box.h"

namespace sightline {

/// The largest float that is not above a value; as std::nextafter() would find it, without the call. NaN stays NaN.
inline float roundDown(double value) {
    const float f = static_cast<float>(value);
    // Half of all values need the step: it is made without a branch. A zero that is above its value is the negative one.
    const uint32_t bits = std::bit_cast<uint32_t>(f), step = f > value;
    return std::bit_cast<float>(bits >> 31 ? bits + step : bits - step);
}

/// The smallest float that is not below a value.
inline float roundUp(double value) { return -roundDown(-value); }

/// The box relative to an origin, rounded outward.
inline Box3f relativeBox(const Box3d& box, const glm::dvec3& origin) {
    Box3f out;
    for (int axis = 0; axis < 3; ++axis) {
        // The subtraction itself rounds: step past it in double before rounding to float.
        const double low = box.min[axis] - origin[axis], high = box.max[axis] - origin[axis];
        out.min[axis] = roundDown(low - std::abs(low) * 0x1p-52);
        out.max[axis] = roundUp(high + std::abs(high) * 0x1p-52);
    }
    return out;
}

}  // namespace sightline
