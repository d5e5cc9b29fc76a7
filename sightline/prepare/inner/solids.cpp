// Finds the closed surfaces among triangles: those of which it is certain what lies inside.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/inner/solids.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sightline/prepare/inner/separation.h"
#include "sightline/prepare/inner/triangle_grid.h"

namespace sightline {
namespace {

constexpr size_t kMostNearSolid = 4096;  // triangles near one: beyond that the solid is given up

struct HalfSide {
    uint32_t low, high, triangle;
    bool forward;
};

std::vector<HalfSide> halfSides(std::span<const SolidTriangle> triangles) {
    std::vector<HalfSide> sides;
    sides.reserve(3 * triangles.size());
    for (uint32_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const uint32_t a = triangles[t].vertex[k], b = triangles[t].vertex[(k + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), t, a < b});
        }
    std::sort(sides.begin(), sides.end(), [](const HalfSide& a, const HalfSide& b) {
        return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.triangle < b.triangle;
    });
    return sides;
}

/// The parts that hang together by sides; those with a side that is not shared by just two that run opposite ways are
/// left out.
std::vector<Solid> closedParts(std::span<const SolidTriangle> triangles) {
    std::vector<uint32_t> parent(triangles.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    std::vector<uint8_t> open(triangles.size(), 0);
    const std::vector<HalfSide> sides = halfSides(triangles);
    for (size_t i = 0, end = 0; i < sides.size(); i = end) {
        while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
        const bool closed = end - i == 2 && sides[i].forward != sides[i + 1].forward;
        for (size_t k = i; k < end; ++k) {
            if (!closed) open[sides[k].triangle] = 1;
            const uint32_t a = root(sides[i].triangle), b = root(sides[k].triangle);
            parent[std::max(a, b)] = std::min(a, b);
        }
    }
    std::vector<uint8_t> spoilt(triangles.size(), 0);
    for (uint32_t t = 0; t < triangles.size(); ++t) spoilt[root(t)] |= open[t];
    std::vector<Solid> parts;
    std::vector<uint32_t> part_of(triangles.size(), ~uint32_t{0});
    for (uint32_t t = 0; t < triangles.size(); ++t) {
        const uint32_t at = root(t);
        if (spoilt[at]) continue;
        if (part_of[at] == ~uint32_t{0}) {
            part_of[at] = static_cast<uint32_t>(parts.size());
            parts.emplace_back();
        }
        parts[part_of[at]].triangles.push_back(t);
    }
    return parts;
}

class Judge {
public:
    Judge(std::span<const glm::vec3> positions, std::span<const SolidTriangle> triangles)
        : positions_(positions), triangles_(triangles) {}

    bool isSolid(const Solid& part) const { return facesOutward(part) && meetsItselfNowhere(part); }

private:
    const glm::vec3& at(uint32_t triangle, int k) const { return positions_[triangles_[triangle].vertex[k]]; }

    Box3f boxOf(uint32_t triangle) const {
        Box3f box;
        for (int k = 0; k < 3; ++k) box.grow(at(triangle, k));
        return box;
    }

    /// Whether the volume within is surely more than nothing.
    bool facesOutward(const Solid& part) const {
        double volume = 0, size = 0;
        const glm::dvec3 middle(at(part.triangles[0], 0));
        for (uint32_t t : part.triangles) {
            const glm::dvec3 a = glm::dvec3(at(t, 0)) - middle, b = glm::dvec3(at(t, 1)) - middle,
                             c = glm::dvec3(at(t, 2)) - middle;
            volume += glm::dot(a, glm::cross(b, c));
            const glm::dvec3 u = glm::abs(a), v = glm::abs(b), w = glm::abs(c);
            size += u.x * (v.y * w.z + v.z * w.y) + u.y * (v.z * w.x + v.x * w.z) + u.z * (v.x * w.y + v.y * w.x);
        }
        return volume > size * 0x1p-50 * static_cast<double>(part.triangles.size() + 16);
    }

    bool meetsItselfNowhere(const Solid& part) const {
        Box3f region;
        for (uint32_t t : part.triangles) region.grow(boxOf(t));
        TriangleGrid grid(region, part.triangles.size());
        for (uint32_t t : part.triangles) {
            const Box3f box = boxOf(t);
            const glm::vec3 a[3] = {at(t, 0), at(t, 1), at(t, 2)};
            size_t met = 0;
            bool apart = true;
            grid.near(box, [&](uint32_t other) {
                const Box3f beside = boxOf(other);
                for (int axis = 0; axis < 3; ++axis)
                    if (beside.min[axis] > box.max[axis] || beside.max[axis] < box.min[axis]) return true;
                const glm::vec3 b[3] = {at(other, 0), at(other, 1), at(other, 2)};
                apart = ++met < kMostNearSolid && meetInCornersOnly(a, b);
                return apart;
            });
            if (!apart) return false;
            grid.add(t, box);
        }
        return true;
    }

    std::span<const glm::vec3> positions_;
    std::span<const SolidTriangle> triangles_;
};

}  // namespace

std::vector<Solid> findSolids(std::span<const glm::vec3> positions, std::span<const SolidTriangle> triangles) {
    std::vector<Solid> parts = closedParts(triangles);
    const Judge judge(positions, triangles);
    std::erase_if(parts, [&](const Solid& part) { return !judge.isSolid(part); });
    return parts;
}

}  // namespace sightline
