// Scan conversion that is exact for the vertices given: which samples of a row a polygon covers.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/project/scan.h"

#include "sightline/math/expansion.h"

namespace sightline::studies {
namespace {

int exactOrientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    Expansion sum;
    sum.addProduct(a.x, b.y);
    sum.addProduct(-a.y, b.x);
    sum.addProduct(b.x, c.y);
    sum.addProduct(-b.y, c.x);
    sum.addProduct(c.x, a.y);
    sum.addProduct(-c.y, a.x);
    return sum.sign();
}

}  // namespace

int orientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    const double left = (a.x - c.x) * (b.y - c.y);
    const double right = (a.y - c.y) * (b.x - c.x);
    const double area = left - right;
    const double bound = 3.3306690738754716e-16 * (std::abs(left) + std::abs(right));
    if (area > bound) return 1;
    if (area < -bound) return -1;
    return exactOrientation(a, b, c);
}

}  // namespace sightline::studies
