// Predicates on positions of meshes whose answers are exact: floats are taken as the numbers that they are.
// SPDX-License-Identifier: MIT
//
// Jonathan Shewchuk. Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates. 1997.
#include "sightline/prepare/occluder/exact.h"

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

/// The difference of two points in doubles, and what they leave: together exact.
struct Difference {
    glm::dvec3 whole, rest;

    Difference(const glm::vec3& a, const glm::vec3& b) {
        for (int i = 0; i < 3; ++i) {
            const double p = a[i], q = b[i], d = p - q, back = p - d;
            whole[i] = d;
            rest[i] = (p - (d + back)) + (back - q);
        }
    }
};

/// Adds a product of one coordinate of each of three differences, or takes it away.
void addProduct(Expansion& sum, double sign, const Difference& u, int i, const Difference& v, int j,
                const Difference& w, int k) {
    for (const double a : {u.whole[i], u.rest[i]})
        for (const double b : {v.whole[j], v.rest[j]})
            for (const double c : {w.whole[k], w.rest[k]})
                if (a != 0 && b != 0 && c != 0) sum.addProduct(sign * a, b, c);
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
    return sideOf(d, a, b, c) == Side::kOn;
}

Side sideOf(const glm::vec3& point, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const Difference du(b, a), dv(c, a), dw(point, a);
    const glm::dvec3 &u = du.whole, &v = dv.whole, &w = dw.whole;
    const double terms[6] = {u.x * v.y * w.z, u.y * v.z * w.x, u.z * v.x * w.y,
                             u.x * v.z * w.y, u.y * v.x * w.z, u.z * v.y * w.x};
    double size = 0;
    for (double term : terms) size += std::abs(term);
    const double volume = (terms[0] + terms[1] + terms[2]) - (terms[3] + terms[4] + terms[5]);
    if (!std::isfinite(size)) return Side::kUnsure;
    if (std::abs(volume) > kSure * size) return volume > 0 ? Side::kBefore : Side::kBehind;
    Expansion sum;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        addProduct(sum, 1, du, i, dv, j, dw, k);
        addProduct(sum, -1, du, i, dv, k, dw, j);
    }
    return static_cast<Side>(sum.sign());
}

}  // namespace sightline
