// What convex bodies have in common, by clipping their faces: the truth that bounds are tested against, by another principle.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/cull/bounds.h"
#include "tests/support/random.h"

namespace sightline::test {

/// A convex polygon of few corners, in place: the oracle cuts millions.
struct Polygon {
    static constexpr size_t kMost = 64;
    glm::dvec3 corners[kMost];
    size_t count = 0;

    Polygon() {}
    Polygon(std::initializer_list<glm::dvec3> from) {
        for (const glm::dvec3& corner : from) push_back(corner);
    }
    void push_back(const glm::dvec3& corner) { corners[count++] = corner; }
    bool empty() const { return count == 0; }
    size_t size() const { return count; }
    glm::dvec3& operator[](size_t i) { return corners[i]; }
    const glm::dvec3& operator[](size_t i) const { return corners[i]; }
    glm::dvec3* begin() { return corners; }
    glm::dvec3* end() { return corners + count; }
    const glm::dvec3* begin() const { return corners; }
    const glm::dvec3* end() const { return corners + count; }
};

/// The part of a polygon where dot(n, p) + d >= -slack.
inline Polygon clipped(const Polygon& polygon, const glm::dvec4& plane, double slack) {
    Polygon out;
    if (polygon.empty()) return out;
    const auto at = [&](const glm::dvec3& p) { return glm::dot(glm::dvec3(plane), p) + plane.w + slack; };
    double t = at(polygon[0]);
    for (size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3 &a = polygon[i], &b = polygon[i + 1 < polygon.size() ? i + 1 : 0];
        const double s = t;
        t = at(b);
        if (s >= 0.0) out.push_back(a);
        if ((s >= 0.0) != (t >= 0.0)) out.push_back(a + s / (s - t) * (b - a));
    }
    return out;
}

/// The face that one half-space has in common with the body of all, from a square as large as `reach` around the plane's
/// point that is nearest to `around`.
inline Polygon faceOf(const std::vector<glm::dvec4>& body, size_t face, const glm::dvec3& around, double reach) {
    const glm::dvec3 n(body[face]);
    const glm::dvec3 u = glm::normalize(glm::cross(n, std::abs(n.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3 v = glm::cross(n, u), p = around - (glm::dot(n, around) + body[face].w) / glm::dot(n, n) * n;
    Polygon polygon{p - reach * u - reach * v, p + reach * u - reach * v, p + reach * u + reach * v,
                    p - reach * u + reach * v};
    for (size_t i = 0; i < body.size(); ++i)
        if (i != face) polygon = clipped(polygon, body[i], 0.0);
    return polygon;
}

/// A closed convex body: its faces, and a point inside.
struct Body {
    std::vector<Polygon> faces;
    std::vector<glm::dvec4> planes;  ///< inward
    double size = 0.0;               ///< of its coordinates and extents
};

inline Body bodyOf(const OrientedBox& box) {
    Body body;
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {1.0, -1.0}) {
            const glm::dvec3 c = box.center + sign * box.half[axis];
            const glm::dvec3 &u = box.half[(axis + 1) % 3], &v = box.half[(axis + 2) % 3];
            body.faces.push_back({c - u - v, c + u - v, c + u + v, c - u + v});
            glm::dvec3 n = glm::cross(u, v);
            if (glm::dot(n, sign * box.half[axis]) > 0.0) n = -n;
            n = glm::normalize(n);
            body.planes.emplace_back(n, -glm::dot(n, c));
        }
    body.size =
        glm::length(box.center) + glm::length(box.half[0]) + glm::length(box.half[1]) + glm::length(box.half[2]);
    return body;
}

inline Body bodyOf(const Box3d& box) {
    OrientedBox oriented{.center = box.center()};
    for (int axis = 0; axis < 3; ++axis) oriented.half[axis][axis] = 0.5 * box.size()[axis];
    return bodyOf(oriented);
}

inline Body bodyOf(const Dop& dop) {
    Body body;
    const glm::dvec3 low(dop.min[0], dop.min[1], dop.min[2]), high(dop.max[0], dop.max[1], dop.max[2]);
    for (int slab = 0; slab < Dop::kSlabs; ++slab) {
        const double length = glm::length(Dop::kDirections[slab]);
        body.planes.push_back(glm::dvec4(Dop::kDirections[slab], -dop.min[slab]) / length);
        body.planes.push_back(glm::dvec4(-Dop::kDirections[slab], dop.max[slab]) / length);
    }
    body.size = glm::length(low) + glm::length(high);
    for (size_t face = 0; face < body.planes.size(); ++face)
        if (Polygon polygon = faceOf(body.planes, face, 0.5 * (low + high), 2.0 * glm::length(high - low));
            polygon.size() > 2)
            body.faces.push_back(polygon);
    return body;
}

enum class Touch { kApart, kUnsure, kTogether };

/// A volume with a point surely inside it.
struct TruthVolume {
    ViewVolume volume;
    glm::dvec3 point;  ///< relative to the volume's eye
};

inline bool meets(const Body& body, const TruthVolume& truth, double slack) {
    bool holds = true;  // the volume's point is in the body
    for (const glm::dvec4& plane : body.planes)
        holds &= glm::dot(glm::dvec3(plane), truth.volume.eye + truth.point) + plane.w >= -slack;
    if (holds) return true;
    for (const Polygon& face : body.faces) {
        Polygon rest = face;
        for (glm::dvec3& corner : rest) corner -= truth.volume.eye;
        for (uint32_t i = 0; i < truth.volume.count && !rest.empty(); ++i)
            rest = clipped(rest, truth.volume.planes[i], slack);
        if (!rest.empty()) return true;
    }
    return false;
}

/// Whether a body and a volume share a point; unsure where that hangs on less than `band`.
inline Touch touch(const Body& body, const TruthVolume& truth, double band) {
    if (meets(body, truth, -band)) return Touch::kTogether;
    return meets(body, truth, band) ? Touch::kUnsure : Touch::kApart;
}

/// How far a point is from the volume: from the nearest point of its faces, each cut off at `reach`.
inline double distanceByFaces(const ViewVolume& volume, const glm::dvec3& point, double reach) {
    const glm::dvec3 p = point - volume.eye;
    const std::vector<glm::dvec4> planes(volume.planes, volume.planes + volume.count);
    double nearest = INFINITY;
    bool inside = true;
    for (size_t i = 0; i < planes.size(); ++i) {
        const double depth = glm::dot(glm::dvec3(planes[i]), p) + planes[i].w;
        inside &= depth >= 0.0;
        const Polygon face = faceOf(planes, i, p, reach);
        if (face.size() < 3) continue;
        glm::dvec3 normal(0.0);
        for (size_t k = 1; k + 1 < face.size(); ++k) normal += glm::cross(face[k] - face[0], face[k + 1] - face[0]);
        bool over = true;  // the foot of the perpendicular is in the face
        for (size_t k = 0; k < face.size(); ++k) {
            const glm::dvec3 &a = face[k], side = face[(k + 1) % face.size()] - a;
            over &= glm::dot(glm::cross(side, p - a), normal) >= 0.0;
            const double squared = glm::dot(side, side);
            const double t = squared > 0.0 ? std::clamp(glm::dot(p - a, side) / squared, 0.0, 1.0) : 0.0;
            nearest = std::min(nearest, glm::length(p - a - t * side));
        }
        if (over) nearest = std::min(nearest, std::abs(depth));
    }
    return inside ? 0.0 : nearest;
}

/// Volumes of every kind: perspective and parallel, without end, off-centre, oblique, windows, and two that overlap.
inline TruthVolume randomVolume(Random& random, double far_from_origin) {
    const glm::dvec3 eye = far_from_origin * randomUnit(random);
    const glm::dmat4 turn = glm::dmat4(glm::dmat3(lookAt({0, 0, 0}, randomUnit(random), {0, 1, 0})));
    const double aspect = random.uniform(0.5, 2.0), angle = random.uniform(0.2, 2.2), z_far = random.uniform(5.0, 60.0);
    glm::dmat4 projection = perspective(angle, aspect, 0.1, z_far);
    const uint64_t kind = random.below(6);
    if (kind == 1) projection = perspective(angle, aspect, 0.1);
    if (kind == 2) projection = orthographic(random.uniform(1, 30), aspect, 0.1, z_far);
    if (kind == 3) projection[2][0] = random.uniform(-1, 1), projection[2][1] = random.uniform(-1, 1);
    if (kind == 4) {  // a near plane askew, and no far plane to speak of
        const glm::dvec4 oblique(glm::normalize(glm::dvec3(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), -1.0)),
                                 -1.0);
        for (int column = 0; column < 4; ++column)
            projection[column][2] = 0.05 * oblique[column] - projection[column][3];
    }
    TruthVolume truth{volumeOfMatrix(projection * turn, eye), glm::dvec3(0.0)};
    const glm::dvec4 middle = glm::inverse(projection * turn) * glm::dvec4(0.1, -0.1, 0.3, 1.0);
    truth.point = glm::dvec3(middle) / middle.w;
    if (kind == 5) {  // through a window around the point
        std::vector<glm::dvec3> window;
        const glm::dvec3 u = glm::normalize(glm::cross(truth.point, randomUnit(random)));
        const glm::dvec3 v = glm::normalize(glm::cross(truth.point, u));
        for (int i = 0; i < 5; ++i)
            window.push_back(eye + 0.7 * truth.point +
                             0.3 * glm::length(truth.point) * (std::cos(1.2566 * i) * u + std::sin(1.2566 * i) * v));
        intersect(truth.volume, volumeOfWindow(eye, window, random.below(2) == 0));
    }
    for (uint32_t i = 0; i < truth.volume.count; ++i)  // beyond infinity, of a matrix with an oblique plane
        if (glm::dot(glm::dvec3(truth.volume.planes[i]), truth.point) + truth.volume.planes[i].w < 1e-3)
            return randomVolume(random, far_from_origin);
    return truth;
}

/// A place where deciding is hard: somewhere about the volume, nearer to its planes than to its middle.
inline glm::dvec3 randomPlace(Random& random, const TruthVolume& truth, double size) {
    glm::dvec3 p = truth.point + random.uniform(0, 50) * randomUnit(random);
    for (int times = 0; times < 2; ++times) {
        const glm::dvec4& plane = truth.volume.planes[random.below(truth.volume.count)];
        p -= (glm::dot(glm::dvec3(plane), p) + plane.w) * glm::dvec3(plane);
    }
    return truth.volume.eye + p + random.uniform(0, 2) * size * randomUnit(random);
}

/// From far smaller than a volume to far larger.
inline double randomSize(Random& random) { return std::exp2(random.uniform(-5, 7)); }

inline OrientedBox randomOriented(Random& random, const TruthVolume& truth) {
    const double size = randomSize(random);
    OrientedBox box{.center = randomPlace(random, truth, size)};
    const glm::dmat3 turn(lookAt({0, 0, 0}, randomUnit(random), randomUnit(random)));
    for (int axis = 0; axis < 3; ++axis) box.half[axis] = size * random.uniform(0.1, 1.0) * turn[axis];
    return box;
}

inline Box3d randomBox(Random& random, const TruthVolume& truth) {
    const double size = randomSize(random);
    const glm::dvec3 c = randomPlace(random, truth, size);
    const glm::dvec3 half = size * glm::dvec3(random.uniform(0.1, 1), random.uniform(0.1, 1), random.uniform(0.1, 1));
    return {c - half, c + half};
}

inline Dop randomDop(Random& random, const TruthVolume& truth) {
    const double size = randomSize(random);
    const glm::dvec3 c = randomPlace(random, truth, size);
    Dop dop;
    for (int i = 0; i < 6; ++i) dop.grow(c + size * randomUnit(random));
    return dop;
}

inline Sphere randomSphere(Random& random, const TruthVolume& truth) {
    const double size = randomSize(random);
    return {randomPlace(random, truth, size), size};
}

}  // namespace sightline::test
