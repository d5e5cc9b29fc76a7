// Whether all numbers of a vector or of a matrix are finite.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include <glm/glm.hpp>

namespace sightline {

template <glm::length_t N, class T>
bool isFinite(const glm::vec<N, T>& v) {
    for (glm::length_t i = 0; i < N; ++i)
        if (!std::isfinite(v[i])) return false;
    return true;
}

template <glm::length_t C, glm::length_t R, class T>
bool isFinite(const glm::mat<C, R, T>& m) {
    for (glm::length_t column = 0; column < C; ++column)
        if (!isFinite(m[column])) return false;
    return true;
}

}  // namespace sightline
