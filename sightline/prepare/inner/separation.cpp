// Whether a plane parts two convex things that may touch, and whether triangles meet, by exact predicates.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/inner/separation.h"

#include <algorithm>
#include <cmath>

#include "sightline/prepare/occluder/exact.h"

namespace sightline {
namespace {

/// Bits of what lies where: 1 before the plane, 2 behind it, 4 in doubt.
int sidesOf(std::span<const glm::vec3> points, const glm::vec3& p, const glm::vec3& q, const glm::vec3& r) {
    int sides = 0;
    for (const glm::vec3& point : points) {
        if (point == p || point == q || point == r) continue;
        const Side side = sideOf(point, p, q, r);
        if (side == Side::kUnsure) return 4;
        sides |= side == Side::kBefore ? 1 : side == Side::kBehind ? 2 : 0;
        if (sides == 3) return sides;
    }
    return sides;
}

/// Whether the plane through three points parts the hulls.
bool parts(std::span<const glm::vec3> a, std::span<const glm::vec3> b, const glm::vec3& p, const glm::vec3& q,
           const glm::vec3& r) {
    const int of_a = sidesOf(a, p, q, r);
    if (of_a >= 3) return false;
    const int of_b = sidesOf(b, p, q, r);
    return of_b < 3 && (of_a | of_b) != 0 && (of_a & of_b) == 0;
}

bool haveApartBoxes(std::span<const glm::vec3> a, std::span<const glm::vec3> b) {
    for (int axis = 0; axis < 3; ++axis) {
        float low_a = a[0][axis], high_a = low_a, low_b = b[0][axis], high_b = low_b;
        for (const glm::vec3& p : a) low_a = std::min(low_a, p[axis]), high_a = std::max(high_a, p[axis]);
        for (const glm::vec3& p : b) low_b = std::min(low_b, p[axis]), high_b = std::max(high_b, p[axis]);
        if ((high_a <= low_b || high_b <= low_a) && (low_a < high_a || low_b < high_b)) return true;
    }
    return false;
}

/// A point off the plane of three others, so that planes through it and two points of theirs stand on their line.
glm::vec3 offPlane(const glm::vec3 (&t)[3]) {
    const glm::vec3 normal = glm::abs(glm::cross(t[1] - t[0], t[2] - t[0]));
    const int axis = normal.x >= normal.y && normal.x >= normal.z ? 0 : normal.y >= normal.z ? 1 : 2;
    glm::vec3 off = t[0];
    off[axis] += 1.0f + std::abs(off[axis]);
    return off;
}

/// As misses(), for a segment in the triangle's plane: the line of a side parts them, or the segment's own line.
bool missesInPlane(const glm::vec3& from, const glm::vec3& to, const glm::vec3 (&t)[3]) {
    const glm::vec3 off = offPlane(t);
    const auto opposite = [](Side a, Side b) {
        return (a == Side::kBefore && b == Side::kBehind) || (a == Side::kBehind && b == Side::kBefore);
    };
    for (int k = 0; k < 3; ++k) {
        const glm::vec3 &p = t[k], &q = t[(k + 1) % 3], &r = t[(k + 2) % 3];
        const Side inside = sideOf(r, p, q, off);
        if (opposite(sideOf(from, p, q, off), inside) && opposite(sideOf(to, p, q, off), inside)) return true;
    }
    const Side first = sideOf(t[0], from, to, off);
    return (first == Side::kBefore || first == Side::kBehind) && sideOf(t[1], from, to, off) == first &&
           sideOf(t[2], from, to, off) == first;
}

/// Whether a segment surely has no point in common with a triangle.
bool misses(const glm::vec3& from, const glm::vec3& to, const glm::vec3 (&t)[3]) {
    const Side first = sideOf(from, t[0], t[1], t[2]), second = sideOf(to, t[0], t[1], t[2]);
    if (first == Side::kUnsure || second == Side::kUnsure) return false;
    if (first == second) return first != Side::kOn || missesInPlane(from, to, t);
    bool before = false, behind = false;
    for (int k = 0; k < 3; ++k) {
        const Side side = sideOf(to, from, t[k], t[(k + 1) % 3]);
        before |= side == Side::kBefore;
        behind |= side == Side::kBehind;
    }
    return before && behind;
}

/// Whether a point of a line lies between two others of it.
bool isBetween(const glm::vec3& point, const glm::vec3& a, const glm::vec3& b) {
    for (int axis = 0; axis < 3; ++axis)
        if ((a[axis] < point[axis] && point[axis] < b[axis]) || (b[axis] < point[axis] && point[axis] < a[axis]))
            return true;
    return false;
}

/// As meetInCornersOnly() for triangles in one plane, whose common corners come first: some line parts them, and one of
/// them meets it in common corners alone.
bool meetInPlane(const glm::vec3 (&p)[3], const glm::vec3 (&q)[3], int common) {
    const glm::vec3 off = offPlane(p);
    const glm::vec3 all[6] = {p[0], p[1], p[2], q[0], q[1], q[2]};
    for (int i = 0; i < 6; ++i)
        for (int j = i + 1; j < 6; ++j) {
            if (all[i] == all[j]) continue;
            int sides[2] = {0, 0}, on[2] = {0, 0}, last[2] = {0, 0};
            for (int k = 0; k < 6; ++k) {
                const Side side =
                    all[k] == all[i] || all[k] == all[j] ? Side::kOn : sideOf(all[k], all[i], all[j], off);
                sides[k / 3] |= side == Side::kUnsure ? 3 : side == Side::kBefore ? 1 : side == Side::kBehind ? 2 : 0;
                if (side == Side::kOn && k % 3 >= common) ++on[k / 3], last[k / 3] = k;
            }
            if (sides[0] == 3 || sides[1] == 3 || (sides[0] & sides[1]) != 0) continue;
            if (on[0] == 0 || on[1] == 0) return true;
            // A side of each along the line: they go different ways from the corner in common.
            if (common == 1 && on[0] == 1 && on[1] == 1 && isBetween(p[0], all[last[0]], all[last[1]])) return true;
        }
    return false;
}

}  // namespace

bool areParted(std::span<const glm::vec3> a, std::span<const glm::vec3> b) {
    if (haveApartBoxes(a, b)) return true;
    glm::vec3 points[8];
    const size_t count = a.size() + b.size();
    std::copy(a.begin(), a.end(), points);
    std::copy(b.begin(), b.end(), points + a.size());
    // First the planes of one hull's own corners, which part most.
    const auto own = [&](size_t i) { return i < a.size(); };
    for (const bool of_one : {true, false})
        for (size_t i = 0; i < count; ++i)
            for (size_t j = i + 1; j < count; ++j) {
                if (points[i] == points[j]) continue;
                for (size_t k = j + 1; k < count; ++k) {
                    if ((own(i) == own(j) && own(j) == own(k)) != of_one) continue;
                    if (points[k] == points[i] || points[k] == points[j]) continue;
                    if (parts(a, b, points[i], points[j], points[k])) return true;
                }
            }
    return false;
}

bool meetInCornersOnly(const glm::vec3 (&a)[3], const glm::vec3 (&b)[3]) {
    // Common corners first.
    int common = 0;
    glm::vec3 p[3], q[3];
    bool taken[3] = {};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            if (a[i] == b[k] && !taken[k]) {
                taken[k] = true;
                p[common] = a[i];
                q[common++] = b[k];
                break;
            }
    if (common == 3) return false;
    int rest_a = common, rest_b = common;
    const auto isCommon = [&](const glm::vec3& v) { return std::find(p, p + common, v) != p + common; };
    for (int i = 0; i < 3; ++i) {
        if (!isCommon(a[i]) && rest_a < 3) p[rest_a++] = a[i];
        if (!isCommon(b[i]) && rest_b < 3) q[rest_b++] = b[i];
    }
    if (rest_a != 3 || rest_b != 3) return false;
    Side side[3];
    for (int i = 0; i < 3; ++i) side[i] = i < common ? Side::kOn : sideOf(q[i], p[0], p[1], p[2]);
    if (side[0] == Side::kOn && side[1] == Side::kOn && side[2] == Side::kOn) return meetInPlane(p, q, common);
    if (common == 2) return side[2] != Side::kUnsure;
    // Two triangles that meet elsewhere have a side of one, without common corners, that meets the other.
    for (int i = common; i < 3; ++i)
        for (int j = i + 1; j < 3; ++j)
            if (!misses(p[i], p[j], q) || !misses(q[i], q[j], p)) return false;
    return true;
}

}  // namespace sightline
