// Predicates on positions of meshes whose answers are exact: floats are taken as the numbers that they are.
// SPDX-License-Identifier: MIT
//
// Jonathan Shewchuk. Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates. 1997.
#include "sightline/prepare/exact.h"

#include <algorithm>
#include <cmath>

#include "sightline/math/expansion.h"

namespace sightline {
namespace {

constexpr double kSure = 0x1p-48;  // of the terms' sizes: far above the rounding of a dozen operations

/// Whether the images of three points on one coordinate plane are surely not on a line.
bool surelyTurns(double ax, double ay, double bx, double by, double cx, double cy) {
    const double left = (bx - ax) * (cy - ay), right = (by - ay) * (cx - ax);
    return std::abs(left - right) > kSure * (std::abs(left) + std::abs(right));
}

/// Whether they are on a line, exactly. Products of two floats are exact in double.
bool isStraight(double ax, double ay, double bx, double by, double cx, double cy) {
    Expansion sum;
    sum.add(ax * by);
    sum.add(-(ay * bx));
    sum.add(bx * cy);
    sum.add(-(by * cx));
    sum.add(cx * ay);
    sum.add(-(cy * ax));
    return sum.sign() == 0;
}

/// The difference of two floats, and whether a double holds it.
bool subtract(const glm::vec3& a, const glm::vec3& b, glm::dvec3& difference) {
    bool exact = true;
    for (int i = 0; i < 3; ++i) {
        const double p = a[i], q = b[i], d = p - q, back = p - d;
        difference[i] = d;
        exact &= (p - (d + back)) + (back - q) == 0.0;
    }
    return exact;
}

}  // namespace

bool areCollinear(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    if (surelyTurns(a.x, a.y, b.x, b.y, c.x, c.y) || surelyTurns(a.y, a.z, b.y, b.z, c.y, c.z) ||
        surelyTurns(a.z, a.x, b.z, b.x, c.z, c.x))
        return false;
    return isStraight(a.x, a.y, b.x, b.y, c.x, c.y) && isStraight(a.y, a.z, b.y, b.z, c.y, c.z) &&
           isStraight(a.z, a.x, b.z, b.x, c.z, c.x);
}

bool liesBetween(const glm::vec3& point, const glm::vec3& a, const glm::vec3& b) {
    for (int i = 0; i < 3; ++i)
        if (point[i] < std::min(a[i], b[i]) || point[i] > std::max(a[i], b[i])) return false;
    return point != a && point != b && areCollinear(a, b, point);
}

bool areCoplanar(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
    for (int i = 0; i < 3; ++i)
        if (a[i] == b[i] && a[i] == c[i] && a[i] == d[i]) return true;
    glm::dvec3 u, v, w;
    if (!subtract(b, a, u) || !subtract(c, a, v) || !subtract(d, a, w)) return false;
    const double terms[6] = {u.x * v.y * w.z, u.y * v.z * w.x, u.z * v.x * w.y,
                             u.x * v.z * w.y, u.y * v.x * w.z, u.z * v.y * w.x};
    double size = 0;
    for (double term : terms) size += std::abs(term);
    if (std::abs((terms[0] + terms[1] + terms[2]) - (terms[3] + terms[4] + terms[5])) > kSure * size) return false;
    Expansion sum;
    sum.addProduct(u.x, v.y, w.z);
    sum.addProduct(u.y, v.z, w.x);
    sum.addProduct(u.z, v.x, w.y);
    sum.addProduct(-u.x, v.z, w.y);
    sum.addProduct(-u.y, v.x, w.z);
    sum.addProduct(-u.z, v.y, w.x);
    return sum.sign() == 0;
}

}  // namespace sightline
