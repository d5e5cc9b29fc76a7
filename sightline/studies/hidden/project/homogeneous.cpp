// Scan conversion without clipping: edge functions in homogeneous space, for any signs of w.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/project/homogeneous.h"

#include <cmath>
#include <limits>
#include <utility>

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

/// A function of the image, linear in x / w and y / w, over samples.
ScreenCut cutOver(const glm::dvec3& f, const SamplePlaces& places) {
    return {f.x * places.scale.x, f.y * places.scale.y, f.x * places.start.x + f.y * places.start.y + f.z, false};
}

int32_t clampedToInt(double value, int32_t low, int32_t high) {
    return value > low ? value < high ? static_cast<int32_t>(value) : high : low;
}

/// Samples and rows that a triangle in front of the eye can touch, with one to spare on each side.
void limitToCorners(HomogeneousTriangle& t) {
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const glm::dvec3& corner : t.corners) {
        const glm::dvec2 place = (glm::dvec2(corner) / corner.z - t.places.start) / t.places.scale;
        low = glm::min(low, place);
        high = glm::max(high, place);
    }
    const int32_t begin = t.begin, row_begin = t.row_begin;
    t.begin = clampedToInt(std::floor(low.x) - 1, begin, t.end);
    t.end = clampedToInt(std::ceil(high.x) + 2, begin, t.end);
    t.row_begin = clampedToInt(std::floor(low.y) - 1, row_begin, t.row_end);
    t.row_end = clampedToInt(std::ceil(high.y) + 2, row_begin, t.row_end);
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

bool HomogeneousTriangle::insideEdgeExactly(int k, double x, double y) const {
    const glm::dvec3& a = corners[(k + 1) % 3];
    const glm::dvec3& b = corners[(k + 2) % 3];
    // A sample on the edge is moved to the right, and by much less down: left and top edges belong.
    if (const int at = tripleProductSign(a, b, {x, y, 1}); at != 0) return at > 0;
    if (const int right = tripleProductSign(a, b, {1, 0, 0}); right != 0) return right > 0;
    return tripleProductSign(a, b, {0, 1, 0}) < 0;
}

bool makeHomogeneous(const glm::dvec4 (&corners)[3], const SamplePlaces& places, const SampleGrid& grid,
                     HomogeneousTriangle& out) {
    double near_distances[3], far_distances[3];
    bool in_front = true;
    for (int k = 0; k < 3; ++k) {
        out.corners[k] = {corners[k].x, corners[k].y, corners[k].w};
        near_distances[k] = corners[k].z;
        far_distances[k] = 2 * corners[k].w - corners[k].z;
        if (!std::isfinite(std::abs(corners[k].x) + std::abs(corners[k].y) + std::abs(far_distances[k]))) return false;
        in_front &= corners[k].w > 0;
    }
    const int winding = tripleProductSign(out.corners[0], out.corners[1], out.corners[2]);
    if (winding == 0) return false;
    if (winding < 0) {
        std::swap(out.corners[1], out.corners[2]);
        std::swap(near_distances[1], near_distances[2]);
        std::swap(far_distances[1], far_distances[2]);
    }
    out.places = places;
    out.begin = 0;
    out.end = static_cast<int32_t>(grid.width);
    out.row_begin = static_cast<int32_t>(grid.first_row);
    out.row_end = static_cast<int32_t>(grid.first_row + grid.height);
    const double x_size = std::max(std::abs(places.x(out.begin)), std::abs(places.x(out.end)));
    const double y_size = std::max(std::abs(places.y(out.row_begin)), std::abs(places.y(out.row_end)));
    glm::dvec3 near_function(0.0), far_function(0.0);
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3& a = out.corners[(k + 1) % 3];
        const glm::dvec3& b = out.corners[(k + 2) % 3];
        out.edges[k] = glm::cross(a, b);
        out.slopes[k] = tripleProductSign(a, b, {1, 0, 0});
        // As in tripleProductSign(), for the largest place of a sample.
        out.doubt[k] = 0x1p-50 * ((std::abs(a.y * b.z) + std::abs(a.z * b.y)) * x_size +
                                  (std::abs(a.z * b.x) + std::abs(a.x * b.z)) * y_size +
                                  (std::abs(a.x * b.y) + std::abs(a.y * b.x)));
        near_function += near_distances[k] * out.edges[k];
        far_function += far_distances[k] * out.edges[k];
    }
    out.has_near = std::min({near_distances[0], near_distances[1], near_distances[2]}) < 0;
    out.has_far = std::min({far_distances[0], far_distances[1], far_distances[2]}) < 0;
    out.near_cut = cutOver(near_function, places);
    out.far_cut = cutOver(far_function, places);
    if (in_front) limitToCorners(out);
    return true;
}

}  // namespace sightline::studies
