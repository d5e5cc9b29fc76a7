// A part of the image between four pairs of parallel lines: upright, level and the two diagonals.
// SPDX-License-Identifier: MIT
//
// James Klosowski, Martin Held, Joseph Mitchell, Henry Sowizral, Karel Zikan. Efficient Collision Detection Using
// Bounding Volume Hierarchies of k-DOPs. 1998.
#pragma once

#include <algorithm>
#include <limits>

namespace sightline {

/// What x, y, x + y and x - y are at most, each followed by what its negative is at most: all eight are joined by the
/// larger and cut by the smaller. A rectangle has the first four alone; the others are then not looked at.
struct WindowBounds {
    double most[8];

    static WindowBounds nothing() {
        WindowBounds none;
        for (double& value : none.most) value = -std::numeric_limits<double>::infinity();
        return none;
    }

    void grow(double x, double y) {
        const double values[8] = {x, -x, y, -y, x + y, -(x + y), x - y, y - x};
        for (int i = 0; i < 8; ++i) most[i] = std::max(most[i], values[i]);
    }
    void grow(const WindowBounds& other) {
        for (int i = 0; i < 8; ++i) most[i] = std::max(most[i], other.most[i]);
    }
    void cut(const WindowBounds& other) {
        for (int i = 0; i < 8; ++i) most[i] = std::min(most[i], other.most[i]);
    }
    void widen(double x, double y) {
        for (int i = 0; i < 2; ++i) {
            most[i] += x;
            most[2 + i] += y;
            most[4 + i] += x + y;
            most[6 + i] += x + y;
        }
    }
    bool isWithin(const WindowBounds& other, int sides) const {
        for (int i = 0; i < sides; ++i)
            if (!(most[i] <= other.most[i])) return false;
        return true;
    }
    bool isEmpty(int sides) const {
        for (int i = 0; i < sides; i += 2)
            if (!(most[i] + most[i + 1] >= 0)) return true;
        return false;
    }
    /// Moves each of eight sides in until it touches what the others leave. Rounding may take 2^-50 of the values.
    void tighten() {
        const double x = most[0], left = most[1], y = most[2], down = most[3];
        const double sum = most[4], less = most[5], up = most[6], back = most[7];
        most[0] = std::min(std::min(x, 0.5 * (sum + up)), std::min(sum + down, up + y));
        most[1] = std::min(std::min(left, 0.5 * (less + back)), std::min(less + y, back + down));
        most[2] = std::min(std::min(y, 0.5 * (sum + back)), std::min(sum + left, back + x));
        most[3] = std::min(std::min(down, 0.5 * (less + up)), std::min(less + x, up + left));
        most[4] = std::min(sum, most[0] + most[2]);
        most[5] = std::min(less, most[1] + most[3]);
        most[6] = std::min(up, most[0] + most[3]);
        most[7] = std::min(back, most[1] + most[2]);
    }
};

}  // namespace sightline
