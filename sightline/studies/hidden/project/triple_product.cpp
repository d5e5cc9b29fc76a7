// The exact sign of a triple product: on which side of the plane through the origin and two points a third one lies.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/project/triple_product.h"

#include <cmath>

#include "sightline/math/expansion.h"

namespace sightline::studies {
namespace {

int exactSign(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    Expansion sum;
    sum.addProduct(a.y, b.z, c.x);
    sum.addProduct(-a.z, b.y, c.x);
    sum.addProduct(a.z, b.x, c.y);
    sum.addProduct(-a.x, b.z, c.y);
    sum.addProduct(a.x, b.y, c.z);
    sum.addProduct(-a.y, b.x, c.z);
    return sum.sign();
}

}  // namespace

int tripleProductSign(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double yz = a.y * b.z, zy = a.z * b.y;
    const double zx = a.z * b.x, xz = a.x * b.z;
    const double xy = a.x * b.y, yx = a.y * b.x;
    const double product = (yz - zy) * c.x + (zx - xz) * c.y + (xy - yx) * c.z;
    // Five roundings at most on the way of any term; the rest is for those of this sum.
    const double bound =
        0x1p-50 * ((std::abs(yz) + std::abs(zy)) * std::abs(c.x) + (std::abs(zx) + std::abs(xz)) * std::abs(c.y) +
                   (std::abs(xy) + std::abs(yx)) * std::abs(c.z));
    if (product > bound) return 1;
    if (product < -bound) return -1;
    return exactSign(a, b, c);
}

}  // namespace sightline::studies
