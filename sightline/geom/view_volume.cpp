// Convex view volumes: frusta of any matrix, portal windows, section planes, two eyes, and what all of them have in common.
// SPDX-License-Identifier: MIT
#include "sightline/geom/view_volume.h"

#include "sightline/math/finite.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline {

namespace {

/// What clip space asks of a row sum: the rows and the sign of the second; the first may be missing.
struct RowSum {
    int first;  // -1: none
    int second;
    double sign;
};

struct RawPlane {
    glm::dvec4 plane{0.0};
    bool has_direction = false;
};

/// A sum that cancels leaves rounding alone: it has no direction.
RawPlane sumOfRows(const glm::dmat4& m, const RowSum& sum) {
    const auto row = [&](int r) { return glm::dvec4(m[0][r], m[1][r], m[2][r], m[3][r]); };
    const glm::dvec4 a = sum.first < 0 ? glm::dvec4(0.0) : row(sum.first), b = sum.sign * row(sum.second);
    RawPlane raw{a + b};
    const double length = glm::length(glm::dvec3(raw.plane));
    raw.has_direction = length > 0x1p-50 * (glm::length(glm::dvec3(a)) + glm::length(glm::dvec3(b)));
    return raw;
}

void planesOfMatrix(const glm::dmat4& clip, const ClipSpace& space, RawPlane planes[6]) {
    const bool zero_to_one = space.depth == ClipDepth::kZeroToOne;
    const RowSum low{zero_to_one ? -1 : 3, 2, 1.0}, high{3, 2, -1.0};
    const RowSum sums[6] = {{3, 0, 1.0}, {3, 0, -1.0}, {3, 1, 1.0}, {3, 1, -1.0}, low, high};
    for (int i = 0; i < 6; ++i) planes[i] = sumOfRows(clip, sums[i]);
    if (space.reversed) std::swap(planes[4], planes[5]);
}

/// Adds a plane relative to the volume's eye, of unit length; one that is there already is not added.
bool addUnitPlane(ViewVolume& volume, const glm::dvec4& plane) {
    for (uint32_t i = 0; i < volume.count; ++i) {
        glm::dvec4& other = volume.planes[i];
        if (glm::dot(glm::dvec3(other), glm::dvec3(plane)) < 1.0 - 1e-15 ||
            glm::length(glm::dvec3(other) - glm::dvec3(plane)) > 1e-14)
            continue;
        if (plane.w < other.w) other = plane;
        return true;
    }
    if (volume.count == ViewVolume::kMostPlanes) return false;
    volume.planes[volume.count++] = plane;
    return true;
}

/// Calls `use` with every three planes and the inverse of their normals, unless those are nearly in one plane.
template <class Use>
void forEachTriple(const ViewVolume& volume, Use use) {
    for (uint32_t i = 0; i < volume.count; ++i)
        for (uint32_t j = i + 1; j < volume.count; ++j)
            for (uint32_t k = j + 1; k < volume.count; ++k) {
                const glm::dvec4 *a = &volume.planes[i], *b = &volume.planes[j], *c = &volume.planes[k];
                const glm::dmat3 normals{glm::dvec3(*a), glm::dvec3(*b), glm::dvec3(*c)};
                if (std::abs(glm::determinant(normals)) < 1e-9) continue;
                use(*a, *b, *c, glm::inverse(normals));
            }
}

}  // namespace

Frustum frustumOfMatrix(const glm::dmat4& clip, const glm::dvec3& eye, const ClipSpace& space) {
    RawPlane raw[6];
    planesOfMatrix(clip, space, raw);
    Frustum frustum;
    frustum.eye = eye;
    for (uint8_t side = 0; side < 6; ++side) {
        if (!raw[side].has_direction) continue;
        const glm::dvec4 plane = raw[side].plane / glm::length(glm::dvec3(raw[side].plane));
        if (!isFinite(plane)) continue;
        frustum.side[frustum.count] = side;
        frustum.planes[frustum.count++] = plane;
    }
    return frustum;
}

ViewVolume volumeOf(const Frustum& frustum) {
    ViewVolume volume;
    volume.eye = frustum.eye;
    volume.count = frustum.count;
    std::copy_n(frustum.planes, frustum.count, volume.planes);
    return volume;
}

ViewVolume volumeOfMatrix(const glm::dmat4& clip, const glm::dvec3& eye, const ClipSpace& space) {
    ViewVolume volume = volumeOf(frustumOfMatrix(clip, eye, space));
    RawPlane raw[6];
    planesOfMatrix(clip, space, raw);
    // Only a normal that is nothing at all proves this: one that is small still has something inside, far away.
    for (const RawPlane& p : raw) volume.empty |= glm::dvec3(p.plane) == glm::dvec3(0.0) && p.plane.w < 0.0;
    return volume;
}

glm::dvec4 planeOfPoints(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 u = b - a, v = c - a, n = glm::cross(u, v);
    const double length = glm::length(n);
    if (!(length > 1e-14 * glm::length(u) * glm::length(v))) return glm::dvec4(0.0);
    return {n / length, -glm::dot(n / length, a)};
}

ViewVolume volumeOfWindow(const glm::dvec3& eye, std::span<const glm::dvec3> window, bool behind_window) {
    ViewVolume volume;
    volume.eye = eye;
    glm::dvec3 normal(0.0), middle(0.0);
    double size = 0.0;
    for (size_t i = 0; i < window.size(); ++i) {  // Newell's sum: twice the area, along the normal
        const glm::dvec3 a = window[i] - eye, b = window[(i + 1) % window.size()] - eye;
        normal += glm::cross(a, b);
        middle += a / static_cast<double>(window.size());
        size = std::max(size, glm::length(a));
    }
    const double area = glm::length(normal);
    if (!(area > 1e-12 * size * size)) return volume;  // and where a corner is no number
    normal /= area;
    double distance = glm::dot(normal, middle);
    if (!(std::abs(distance) > 1e-9 * size)) return volume;
    const double turn = distance > 0.0 ? 1.0 : -1.0;
    for (size_t i = 0; i < window.size() && volume.count + 1 < ViewVolume::kMostPlanes; ++i) {
        const glm::dvec3 a = window[i] - eye, b = window[(i + 1) % window.size()] - eye;
        const glm::dvec3 n = turn * glm::cross(a, b);
        const double length = glm::length(n);
        if (!(length > 1e-14 * glm::length(a) * glm::length(b))) continue;
        double farthest = 0.0;  // of all corners, outside
        for (const glm::dvec3& corner : window) farthest = std::min(farthest, glm::dot(n / length, corner - eye));
        if (farthest > -1e-9 * size) addUnitPlane(volume, {n / length, -farthest});
    }
    if (behind_window) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const glm::dvec3& corner : window) nearest = std::min(nearest, turn * glm::dot(normal, corner - eye));
        addUnitPlane(volume, {turn * normal, -nearest});
    }
    return volume;
}

bool addPlane(ViewVolume& volume, const glm::dvec4& plane) {
    const double length = glm::length(glm::dvec3(plane));
    if (length == 0.0) {
        volume.empty |= plane.w < 0.0;
        return true;
    }
    const glm::dvec3 n = glm::dvec3(plane) / length;
    const glm::dvec4 unit(n, plane.w / length + glm::dot(n, volume.eye));
    return !isFinite(unit) || addUnitPlane(volume, unit);
}

ViewVolume relativeTo(const ViewVolume& volume, const glm::dvec3& eye) {
    ViewVolume moved = volume;
    moved.eye = eye;
    for (uint32_t i = 0; i < moved.count; ++i)
        moved.planes[i].w += glm::dot(glm::dvec3(moved.planes[i]), eye - volume.eye);
    return moved;
}

bool intersect(ViewVolume& volume, const ViewVolume& other) {
    volume.empty |= other.empty;
    const ViewVolume moved = relativeTo(other, volume.eye);
    bool all = true;
    for (uint32_t i = 0; i < moved.count; ++i) all &= addUnitPlane(volume, moved.planes[i]);
    return all;
}

bool supportPlane(const ViewVolume& volume, const glm::dvec3& normal, glm::dvec4& plane) {
    const double length = glm::length(normal);
    if (!(length > 0.0)) return false;
    bool found = false;
    // Any sum of planes with weights >= 0 holds the volume; by the duality of linear programs three are enough.
    forEachTriple(volume,
                  [&](const glm::dvec4& a, const glm::dvec4& b, const glm::dvec4& c, const glm::dmat3& inverse) {
                      glm::dvec3 weight = inverse * (normal / length);
                      if (!(weight.x > -1e-13 && weight.y > -1e-13 && weight.z > -1e-13)) return;
                      weight = glm::max(weight, glm::dvec3(0.0));
                      if (!(weight.x + weight.y + weight.z < 256.0)) return;  // most of the sum would be rounding
                      const glm::dvec4 sum = weight.x * a + weight.y * b + weight.z * c;
                      if (found && sum.w >= plane.w) return;
                      plane = sum / glm::length(glm::dvec3(sum));
                      found = true;
                  });
    return found;
}

bool provedEmpty(const ViewVolume& volume) {
    if (volume.empty) return true;
    for (uint32_t i = 0; i < volume.count; ++i) {
        glm::dvec4 opposite;
        if (!supportPlane(volume, -glm::dvec3(volume.planes[i]), opposite)) continue;
        const double room = volume.planes[i].w + opposite.w;
        if (room < -1e-9 * (std::abs(volume.planes[i].w) + std::abs(opposite.w))) return true;
    }
    return false;
}

uint32_t edgesOf(const ViewVolume& volume, std::span<PlanePair> edges) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < volume.count; ++i)
        for (uint32_t j = i + 1; j < volume.count; ++j) {
            const glm::dvec3 a(volume.planes[i]), b(volume.planes[j]);
            const glm::dvec3 along = glm::cross(a, b);
            const double squared = glm::dot(along, along);
            if (squared < 1e-18) continue;
            // The line's point that is nearest to the eye; then what the other planes leave of the line.
            const glm::dvec3 point =
                (volume.planes[i].w * glm::cross(along, b) + volume.planes[j].w * glm::cross(a, along)) / squared;
            const glm::dvec3 unit = along / std::sqrt(squared);
            double low = -std::numeric_limits<double>::infinity(), high = -low;
            for (uint32_t k = 0; k < volume.count && low <= high; ++k) {
                if (k == i || k == j) continue;
                const double slope = glm::dot(glm::dvec3(volume.planes[k]), unit);
                const double at = glm::dot(glm::dvec3(volume.planes[k]), point) + volume.planes[k].w;
                const double slack = 1e-9 * (glm::length(point) + std::abs(volume.planes[k].w)) + 1e-300;
                if (std::abs(slope) < 1e-12) {
                    if (at < -slack) high = -std::numeric_limits<double>::infinity();
                } else if (slope > 0.0) {
                    low = std::max(low, (-at - slack) / slope);
                } else {
                    high = std::min(high, (at + slack) / -slope);
                }
            }
            if (low > high) continue;
            if (count == edges.size()) return count;
            edges[count++] = {static_cast<uint8_t>(i), static_cast<uint8_t>(j)};
        }
    return count;
}

namespace {

/// The tightest plane of a direction that holds two volumes of one eye.
bool supportBoth(const ViewVolume& a, const ViewVolume& b, const glm::dvec3& normal, glm::dvec4& plane) {
    glm::dvec4 other;
    if (!supportPlane(a, normal, plane) || !supportPlane(b, normal, other)) return false;
    plane.w = std::max(plane.w, other.w);
    // Both normals are what was asked for up to rounding; the step outward is for what that does far away.
    plane = {normal, plane.w + 1e-12 * std::abs(plane.w)};
    return true;
}

}  // namespace

ViewVolume volumeOfBoth(const ViewVolume& left, const ViewVolume& right) {
    if (left.empty) return right;
    if (right.empty) return left;
    const ViewVolume other = relativeTo(right, left.eye);
    ViewVolume both;
    both.eye = left.eye;
    glm::dvec4 plane;
    bool all = true;
    for (const ViewVolume* from : {&left, &other})
        for (uint32_t i = 0; i < from->count; ++i)
            if (supportBoth(left, other, glm::dvec3(from->planes[i]), plane)) addUnitPlane(both, plane);
            else all = false;
    if (all) return both;
    // Where a plane of one cannot hold the other (volumes without end), planes along an edge of each do.
    PlanePair edges[2][2 * ViewVolume::kMostPlanes];
    const uint32_t counts[2] = {edgesOf(left, edges[0]), edgesOf(other, edges[1])};
    const auto along = [](const ViewVolume& v, const PlanePair& e) {
        return glm::cross(glm::dvec3(v.planes[e.first]), glm::dvec3(v.planes[e.second]));
    };
    for (uint32_t i = 0; i < counts[0]; ++i)
        for (uint32_t j = 0; j < counts[1]; ++j)
            for (const double sign : {1.0, -1.0}) {
                const glm::dvec3 normal = sign * glm::cross(along(left, edges[0][i]), along(other, edges[1][j]));
                const double length = glm::length(normal);
                glm::dvec4 present;
                if (length < 1e-6 || !supportBoth(left, other, normal / length, plane)) continue;
                // One that the planes so far give anyway, or nearly, is not worth its tests.
                if (supportPlane(both, normal, present) && present.w <= plane.w + 1e-6 * (1.0 + std::abs(plane.w)))
                    continue;
                addUnitPlane(both, plane);
            }
    return both;
}

}  // namespace sightline
