// A part of a polygon's samples: what lies on one side of a line. Splitting polygons like that loses no sample.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

#include "sightline/studies/hidden/project/screen_polygon.h"

namespace sightline::studies {

/// The samples i of rows j with a * i + (b * j + c) >= 0, or all others. A polygon's outline is never split itself: its
/// pieces are its own samples on either side, so that together they have each of them once, whatever rounding does.
struct ScreenCut {
    double a = 0, b = 0, c = 0;
    bool negative = false;  ///< keep the others

    ScreenCut otherSide() const { return {a, b, c, !negative}; }

    /// Whether a sample is kept.
    bool keeps(int32_t row, int32_t sample) const { return (a * sample + (b * row + c) >= 0) != negative; }

    /// Narrows the samples [begin, end) of a row to those that are kept: a run, since rounding is monotonic.
    void narrow(int32_t row, int32_t& begin, int32_t& end) const {
        if (begin >= end) return;
        const double rest = b * row + c;
        const auto inside = [&](int32_t i) { return a * i + rest >= 0; };
        const bool first = inside(begin), last = inside(end - 1);
        if (first == last) {
            if (first == negative) end = begin;
            return;
        }
        // The first sample that differs from `first`: guessed by division, settled by the same sum as everywhere.
        int32_t low = begin, high = end - 1;  // inside(low) == first, inside(high) == last
        const double guess = std::floor(-rest / a);
        if (guess > low && guess < high) {
            const int32_t g = static_cast<int32_t>(guess);
            for (int32_t i = g; i <= g + 1 && i < high; ++i) (inside(i) == first ? low : high) = i;
        }
        while (high - low > 1) {
            const int32_t middle = low + (high - low) / 2;
            (inside(middle) == first ? low : high) = middle;
        }
        if (first != negative) end = high;
        else begin = high;
    }
};

/// The cut that a plane makes in a surface.
/// @param plane  over samples, rows, nearness and 1: Projector::overSamples()
inline ScreenCut cutOf(const glm::dvec4& plane, const DepthPlane& surface) {
    return {plane.x + plane.z * surface.per_sample, plane.y + plane.z * surface.per_row,
            plane.w + plane.z * surface.origin, false};
}

/// The cut between the samples where one surface is at least as near as another, and those where it is not.
inline ScreenCut nearerThan(const DepthPlane& a, const DepthPlane& b) {
    return {a.per_sample - b.per_sample, a.per_row - b.per_row, a.origin - b.origin, false};
}

}  // namespace sightline::studies
