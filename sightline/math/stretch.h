// How much a transform stretches what it stretches most.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/glm.hpp>

namespace sightline {

/// An upper bound on how much the linear part stretches any vector, its largest singular value: exact if its columns are
/// orthogonal. Infinite if an element is not finite.
inline double largestStretch(const glm::dmat4& matrix) {
    // Gershgorin on the transposed times itself: its largest eigenvalue is the square of the stretch.
    const glm::dmat3 linear(matrix);
    double largest = 0;
    for (int row = 0; row < 3; ++row) {
        double sum = 0;
        for (int column = 0; column < 3; ++column) sum += std::abs(glm::dot(linear[row], linear[column]));
        if (!std::isfinite(sum)) return std::numeric_limits<double>::infinity();
        largest = std::max(largest, sum);
    }
    return std::sqrt(largest) * (1 + 1e-12);
}

}  // namespace sightline
