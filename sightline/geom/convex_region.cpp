// Faces by clipping a large square in each plane by all others.
// SPDX-License-Identifier: MIT
//
// Ivan Sutherland, Gary Hodgman. Reentrant Polygon Clipping. 1974.
#include "sightline/geom/convex_region.h"

#include <algorithm>
#include <cmath>

namespace sightline {
namespace {

constexpr double kRounding = 0x1p-40;

double heightOf(const glm::dvec4& plane, const glm::dvec3& point) {
    return glm::dot(glm::dvec3(plane), point) + plane.w;
}

/// Two unit vectors across a unit normal; with it right-handed.
void axesAcross(const glm::dvec3& normal, glm::dvec3& u, glm::dvec3& v) {
    const glm::dvec3 size = glm::abs(normal);
    const int least = size.x <= size.y ? (size.x <= size.z ? 0 : 2) : (size.y <= size.z ? 1 : 2);
    glm::dvec3 axis(0);
    axis[least] = 1;
    u = glm::normalize(glm::cross(axis, normal));
    v = glm::cross(normal, u);
}

/// All faces about an origin, out of squares of that half width.
std::vector<RegionFace> facesAbout(std::span<const glm::dvec4> planes, double reach, bool& unbounded) {
    std::vector<RegionFace> faces;
    for (uint32_t i = 0; i < planes.size(); ++i) {
        const glm::dvec3 normal(planes[i]);
        glm::dvec3 u, v;
        axesAcross(normal, u, v);
        const glm::dvec3 foot = -planes[i].w * normal;
        std::vector<glm::dvec3> outline{foot - reach * u - reach * v, foot + reach * u - reach * v,
                                        foot + reach * u + reach * v, foot - reach * u + reach * v};
        for (uint32_t k = 0; k < planes.size() && !outline.empty(); ++k) {
            // Of planes that are the same, the first has the face.
            const bool same = k != i && glm::dot(glm::dvec3(planes[k]), normal) > 1 - 1e-14 &&
                              std::abs(planes[k].w - planes[i].w) <= kRounding * std::abs(planes[i].w);
            if (same && k < i) outline.clear();
            if (k != i && !same) outline = clipOutline(outline, planes[k]);
        }
        if (outline.empty()) continue;
        for (const glm::dvec3& point : outline)
            unbounded |= std::max(std::abs(glm::dot(point - foot, u)), std::abs(glm::dot(point - foot, v))) > reach / 2;
        faces.push_back({i, std::move(outline)});
    }
    return faces;
}

Box3d boundsOf(const std::vector<RegionFace>& faces) {
    Box3d bounds;
    for (const RegionFace& face : faces)
        for (const glm::dvec3& point : face.outline) bounds.grow(point);
    return bounds;
}

}  // namespace

std::vector<glm::dvec3> clipOutline(std::span<const glm::dvec3> outline, const glm::dvec4& plane) {
    std::vector<glm::dvec3> kept;
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 &a = outline[i], &b = outline[(i + 1) % outline.size()];
        const double at_a = heightOf(plane, a), at_b = heightOf(plane, b);
        if (at_a >= 0) kept.push_back(a);
        if ((at_a > 0 && at_b < 0) || (at_a < 0 && at_b > 0)) kept.push_back(a + (at_a / (at_a - at_b)) * (b - a));
    }
    if (kept.size() < 3) kept.clear();
    return kept;
}

ConvexRegion convexRegion(std::span<const glm::dvec4> planes) {
    ConvexRegion region;
    double farthest = 0;
    for (const glm::dvec4& plane : planes) farthest = std::max(farthest, std::abs(plane.w));
    if (farthest == 0) farthest = 1;
    bool unbounded = planes.size() < 4;
    // Twice: first to learn where it is, then near it, where numbers are finer.
    std::vector<RegionFace> faces = facesAbout(planes, farthest * 0x1p12, unbounded);
    region.bounds = boundsOf(faces);
    if (!faces.empty() && !unbounded) {
        const glm::dvec3 center = region.bounds.center();
        const glm::dvec3 size = region.bounds.size();
        std::vector<glm::dvec4> moved(planes.begin(), planes.end());
        for (glm::dvec4& plane : moved) plane.w = heightOf(plane, center);
        const double reach = 64 * std::max({size.x, size.y, size.z, farthest * 0x1p-30});
        // Planes far beyond it touch nothing of it, and their squares need not reach.
        std::vector<RegionFace> near_by = facesAbout(moved, reach, unbounded);
        if (!unbounded) faces = std::move(near_by);
        for (RegionFace& face : faces)
            for (glm::dvec3& point : face.outline) point += center;
        region.bounds = boundsOf(faces);
    }
    if (unbounded) {
        region.kind = ConvexRegion::Kind::kUnbounded;
        return region;
    }
    const glm::dvec3 size = region.bounds.size();
    if (faces.size() < 4 || !(std::min({size.x, size.y, size.z}) > kRounding * farthest)) return region;
    region.kind = ConvexRegion::Kind::kSolid;
    region.faces = std::move(faces);
    return region;
}

std::vector<glm::dvec4> planesAround(std::span<const glm::dvec3> points) {
    Box3d bounds;
    for (const glm::dvec3& point : points) bounds.grow(point);
    std::vector<glm::dvec4> planes;
    if (points.size() < 4 || !bounds.finite()) return planes;
    const glm::dvec3 size = bounds.size(), center = bounds.center();
    const double extent = std::max({size.x, size.y, size.z});
    const double flat = extent * 0x1p-30;
    for (size_t i = 0; i < points.size(); ++i)
        for (size_t j = i + 1; j < points.size(); ++j)
            for (size_t k = j + 1; k < points.size(); ++k) {
                const glm::dvec3 a = points[i] - center,
                                 across = glm::cross(points[j] - points[i], points[k] - points[i]);
                const double length = glm::length(across);
                if (!(length > flat * extent)) continue;
                glm::dvec4 plane(across / length, -glm::dot(across / length, a));
                double low = 0, high = 0;
                for (const glm::dvec3& point : points) {
                    const double height = heightOf(plane, point - center);
                    low = std::min(low, height);
                    high = std::max(high, height);
                }
                if (high <= flat && low >= -flat) return {};  // all in one plane
                if (high > flat && low < -flat) continue;
                if (high <= flat) plane = -plane;
                // No point is to be left outside by rounding.
                plane.w += high <= flat ? high : -low;
                const bool known = std::any_of(planes.begin(), planes.end(), [&](const glm::dvec4& other) {
                    return glm::dot(glm::dvec3(other), glm::dvec3(plane)) > 1 - 1e-9 &&
                           std::abs(other.w - plane.w) <= 4 * flat;
                });
                if (!known) planes.push_back(plane);
            }
    for (glm::dvec4& plane : planes) plane.w -= glm::dot(glm::dvec3(plane), center);
    return planes;
}

std::vector<glm::dvec4> planesOfBox(const Box3d& box) {
    std::vector<glm::dvec4> planes;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec4 low(0), high(0);
        low[axis] = 1;
        low.w = -box.min[axis];
        high[axis] = -1;
        high.w = box.max[axis];
        planes.push_back(low);
        planes.push_back(high);
    }
    return planes;
}

}  // namespace sightline
