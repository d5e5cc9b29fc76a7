// Half-spaces in a plane: by Helly's theorem three at a time, by Motzkin's the sign of a determinant each time.
// SPDX-License-Identifier: MIT
#include "sightline/math/half_spaces.h"

#include <cmath>

#include "sightline/math/expansion.h"

namespace sightline {
namespace {

using Plane = glm::dvec4;

void addProductOf4(Expansion& sum, double a, double b, double c, double d) {
    if (a == 0 || b == 0 || c == 0 || d == 0) return;
    const double product = a * b, error = productError(a, b);
    sum.addProduct(product, c, d);
    if (error != 0) sum.addProduct(error, c, d);
}

int signOf(double value, double rounding) { return value > rounding ? 1 : value < -rounding ? -1 : 0; }

/// Of a[i] b[j] - a[j] b[i].
int signOfMinor(const Plane& a, const Plane& b, int i, int j) {
    const double left = a[i] * b[j], right = a[j] * b[i];
    const int sign = signOf(left - right, 0x1p-50 * (std::abs(left) + std::abs(right)));
    if (sign != 0 || (left == 0 && right == 0)) return sign;
    Expansion sum;
    sum.addProduct(a[i], b[j]);
    sum.addProduct(-a[j], b[i]);
    return sum.sign();
}

/// The even permutations of three, and which column is left out of four.
constexpr int kCyclic[3][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}};

/// Of the determinant of three normals.
int signOfNormals(const Plane& a, const Plane& b, const Plane& c) {
    double value = 0, size = 0;
    for (const auto& [i, j, k] : kCyclic) {
        const double left = b[j] * c[k], right = b[k] * c[j];
        value += a[i] * (left - right);
        size += std::abs(a[i]) * (std::abs(left) + std::abs(right));
    }
    const int sign = signOf(value, 0x1p-49 * size);
    if (sign != 0 || size == 0) return sign;
    Expansion sum;
    for (const auto& [i, j, k] : kCyclic) {
        if (a[i] == 0) continue;
        sum.addProduct(a[i], b[j], c[k]);
        sum.addProduct(-a[i], b[k], c[j]);
    }
    return sum.sign();
}

/// Of the determinant of four planes.
int signOfPlanes(const Plane& a, const Plane& b, const Plane& c, const Plane& d) {
    // By the minors of the first two rows against those of the last two.
    constexpr int kPairs[6][5] = {{0, 1, 2, 3, 1}, {0, 2, 1, 3, -1}, {0, 3, 1, 2, 1},
                                  {1, 2, 0, 3, 1}, {1, 3, 0, 2, -1}, {2, 3, 0, 1, 1}};
    double value = 0, size = 0;
    for (const auto& [i, j, k, l, s] : kPairs) {
        const double ab = a[i] * b[j], ba = a[j] * b[i], cd = c[k] * d[l], dc = c[l] * d[k];
        value += s * (ab - ba) * (cd - dc);
        size += (std::abs(ab) + std::abs(ba)) * (std::abs(cd) + std::abs(dc));
    }
    const int sign = signOf(value, 0x1p-48 * size);
    if (sign != 0 || size == 0) return sign;
    Expansion sum;
    for (const auto& [i, j, k, l, s] : kPairs) {
        addProductOf4(sum, s * a[i], b[j], c[k], d[l]);
        addProductOf4(sum, -s * a[i], b[j], c[l], d[k]);
        addProductOf4(sum, -s * a[j], b[i], c[k], d[l]);
        addProductOf4(sum, s * a[j], b[i], c[l], d[k]);
    }
    return sum.sign();
}

int largestOf(const Plane& plane) {
    const glm::dvec3 size = glm::abs(glm::dvec3(plane));
    return size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
}

bool parallel(const Plane& a, const Plane& b) {
    return signOfMinor(a, b, 0, 1) == 0 && signOfMinor(a, b, 0, 2) == 0 && signOfMinor(a, b, 1, 2) == 0;
}

/// In the plane two half-spaces look at one another, or away, across parallel lines. Whether nothing lies between.
bool shutBetween(const Plane& plane, const Plane& a, const Plane& b) {
    for (const auto& [i, j, k] : kCyclic) {
        const int sign_a = signOfMinor(a, plane, i, j), sign_b = signOfMinor(b, plane, i, j);
        if (sign_a == 0) continue;
        if (sign_a == sign_b) return false;
        // |minor of b| a + |minor of a| b + (something) plane = 0 in the normals: what is left of the distances?
        const int m = largestOf(plane);
        Expansion sum;
        const auto add = [&, i = i, j = j](const Plane& weight, int sign, const Plane& other) {
            for (const double side : {1.0, -1.0}) {
                const double left = sign * side * (side > 0 ? weight[i] : weight[j]);
                const double right = side > 0 ? plane[j] : plane[i];
                addProductOf4(sum, left, right, other.w, plane[m]);
                addProductOf4(sum, -left, right, plane.w, other[m]);
            }
        };
        add(b, sign_b, a);
        add(a, sign_a, b);
        return sum.sign() * (plane[m] > 0 ? 1 : -1) <= 0;
    }
    return false;
}

}  // namespace

bool openInPlane(const Plane& plane, std::span<const Plane> insides) {
    const int m = largestOf(plane);
    const int up = plane[m] > 0 ? 1 : -1;
    for (const Plane& a : insides)
        if (parallel(a, plane) && signOfMinor(a, plane, 3, m) * up <= 0) return false;
    for (size_t i = 1; i < insides.size(); ++i)
        for (size_t j = 0; j < i; ++j)
            if (signOfNormals(plane, insides[i], insides[j]) == 0 && !parallel(insides[i], plane) &&
                shutBetween(plane, insides[i], insides[j]))
                return false;
    for (size_t i = 2; i < insides.size(); ++i)
        for (size_t j = 1; j < i; ++j) {
            const int ij = signOfNormals(plane, insides[i], insides[j]);
            if (ij == 0) continue;
            for (size_t k = 0; k < j; ++k)
                if (signOfNormals(plane, insides[j], insides[k]) == ij &&
                    signOfNormals(plane, insides[k], insides[i]) == ij &&
                    signOfPlanes(plane, insides[i], insides[j], insides[k]) * ij <= 0)
                    return false;
        }
    return true;
}

bool samePlane(const Plane& a, const Plane& b) {
    const int m = largestOf(a);
    return parallel(a, b) && signOfMinor(a, b, 3, m) == 0;
}

}  // namespace sightline
