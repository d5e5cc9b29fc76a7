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

int32_t firstSampleRightOf(glm::dvec2 a, glm::dvec2 b, int32_t row, int32_t width) {
    if (a.y > b.y) std::swap(a, b);
    const double y = row + 0.5;
    const double x = a.x + (y - a.y) * ((b.x - a.x) / (b.y - a.y)) - 0.5;
    if (!(x > -1)) return 0;
    if (x > width) return width;
    // Rounding moved x by less than ten units in the last place of the ends; where that could decide
    // between two samples, the exact predicate does.
    const double nearest = std::rint(x);
    const double doubt = 0x1p-47 * (std::abs(a.x) + std::abs(b.x) + 1.0);
    double first = std::ceil(x);
    if (std::abs(x - nearest) <= doubt) first = orientation(a, b, {nearest + 0.5, y}) <= 0 ? nearest : nearest + 1;
    return first < 0 ? 0 : first > width ? width : static_cast<int32_t>(first);
}

}  // namespace sightline::studies
