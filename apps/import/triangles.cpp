// Triangles of Assimp's faces, over positions that are joined where they are the same.
// SPDX-License-Identifier: MIT
//
// Gary H. Meisters. Polygons have ears. American Mathematical Monthly, 1975.
#include "apps/import/triangles.h"

#include <bit>
#include <cmath>
#include <utility>

namespace sightline::import {
namespace {

uint64_t hashOf(const glm::vec3& position) {
    uint64_t hash = 0x9e3779b97f4a7c15;
    for (int axis = 0; axis < 3; ++axis) {
        hash ^= std::bit_cast<uint32_t>(position[axis]);
        hash *= 0xff51afd7ed558ccd;
        hash ^= hash >> 32;
    }
    return hash;
}

/// The polygon seen along its normal: two coordinates a corner, counter-clockwise as a whole.
std::vector<glm::dvec2> flattened(const std::vector<glm::dvec3>& corners) {
    glm::dvec3 normal(0);
    for (size_t i = 0; i < corners.size(); ++i)  // relative to the first corner, so that far ones keep their digits
        normal += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
    int drop = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (std::abs(normal[axis]) > std::abs(normal[drop])) drop = axis;
    int u = (drop + 1) % 3, v = (drop + 2) % 3;
    if (normal[drop] < 0) std::swap(u, v);
    std::vector<glm::dvec2> out;
    out.reserve(corners.size());
    for (const glm::dvec3& corner : corners) out.emplace_back(corner[u] - corners[0][u], corner[v] - corners[0][v]);
    return out;
}

/// Twice the area to the left of a, b, c.
double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Not less than half-plane each: a fan from the first corner covers it.
bool isConvex(const std::vector<glm::dvec2>& points) {
    const size_t n = points.size();
    for (size_t i = 0; i < n; ++i)
        if (turn(points[i], points[(i + 1) % n], points[(i + 2) % n]) < 0) return false;
    for (size_t i = 1; i + 1 < n; ++i)  // it goes round once only
        if (turn(points[0], points[i], points[i + 1]) < 0) return false;
    return true;
}

/// The corners that are left, as a ring.
struct Ring {
    std::vector<uint32_t> next, previous;
    size_t left;

    explicit Ring(size_t count) : next(count), previous(count), left(count) {
        for (uint32_t i = 0; i < count; ++i) {
            next[i] = static_cast<uint32_t>((i + 1) % count);
            previous[i] = static_cast<uint32_t>((i + count - 1) % count);
        }
    }
    void remove(uint32_t i) {
        next[previous[i]] = next[i];
        previous[next[i]] = previous[i];
        --left;
    }
};

/// @param flat  takes ears without area, too
bool isEar(const std::vector<glm::dvec2>& points, const Ring& ring, uint32_t corner, bool flat) {
    const uint32_t before = ring.previous[corner], after = ring.next[corner];
    const glm::dvec2 &a = points[before], &b = points[corner], &c = points[after];
    const double area = turn(a, b, c);
    if (area < 0 || (area == 0 && !flat)) return false;
    for (uint32_t i = ring.next[after]; i != before; i = ring.next[i]) {
        const glm::dvec2& p = points[i];
        if (p == a || p == b || p == c) continue;  // a bridge to a hole runs along the same corners twice
        if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) {
            if (area > 0) return false;
            // A spike: nothing is inside of it, but a corner between its ends must not be jumped over.
            if (glm::dot(a - p, c - p) < 0) return false;
        }
    }
    return true;
}

void cutEars(const std::vector<glm::dvec2>& points, std::vector<uint32_t>& out) {
    Ring ring(points.size());
    uint32_t corner = 0;
    size_t since_last = 0;
    // Ears with area first: a corner on a straight edge then stays the corner of a triangle.
    for (bool flat = false; ring.left > 3;) {
        const uint32_t after = ring.next[corner];
        if (isEar(points, ring, corner, flat)) {
            out.insert(out.end(), {ring.previous[corner], corner, after});
            ring.remove(corner);
            since_last = 0;
            flat = false;
        } else if (++since_last > ring.left) {
            if (flat) break;
            flat = true;
            since_last = 0;
        }
        corner = after;
    }
    for (uint32_t i = ring.next[corner]; ring.next[i] != corner; i = ring.next[i])
        out.insert(out.end(), {corner, i, ring.next[i]});
}

}  // namespace

PositionPool::PositionPool(size_t expected) : slots_(std::bit_ceil(2 * expected + 16), 0) {
    positions.reserve(expected / 2);
}

uint32_t PositionPool::add(const glm::vec3& position) {
    const glm::vec3 plain = position + 0.0f;  // -0 becomes 0
    if (2 * positions.size() >= slots_.size()) grow();
    const size_t mask = slots_.size() - 1;
    size_t slot = hashOf(plain) & mask;
    for (; slots_[slot] != 0; slot = (slot + 1) & mask)
        if (positions[slots_[slot] - 1] == plain) return slots_[slot] - 1;
    positions.push_back(plain);
    slots_[slot] = static_cast<uint32_t>(positions.size());
    return slots_[slot] - 1;
}

void PositionPool::grow() {
    std::vector<uint32_t> slots(2 * slots_.size(), 0);
    const size_t mask = slots.size() - 1;
    for (uint32_t i = 0; i < positions.size(); ++i) {
        size_t slot = hashOf(positions[i]) & mask;
        while (slots[slot] != 0) slot = (slot + 1) & mask;
        slots[slot] = i + 1;
    }
    slots_ = std::move(slots);
}

void cutPolygon(const std::vector<glm::dvec3>& corners, std::vector<uint32_t>& out) {
    const auto count = static_cast<uint32_t>(corners.size());
    if (count > 3) {
        const std::vector<glm::dvec2> points = flattened(corners);
        if (!isConvex(points)) {
            cutEars(points, out);
            return;
        }
    }
    for (uint32_t i = 1; i + 1 < count; ++i) out.insert(out.end(), {0, i, i + 1});
}

}  // namespace sightline::import
