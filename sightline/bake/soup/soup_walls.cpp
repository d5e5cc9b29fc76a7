// Sorts opaque triangles into planes, and finds how large the parts are that hang together.
// SPDX-License-Identifier: MIT
#include "sightline/bake/soup/soup_walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "sightline/base/random.h"
#include "sightline/tools/scene/joined_sets.h"

namespace sightline::bake {
using namespace tools;
namespace {

/// Twice a triangle's area, along its normal.
glm::dvec3 areaVectorOf(const WallTriangle& triangle) {
    return glm::cross(triangle.corners[1] - triangle.corners[0], triangle.corners[2] - triangle.corners[0]);
}

bool liesIn(const WallTriangle& triangle, const glm::dvec4& plane, double reach) {
    for (const glm::dvec3& corner : triangle.corners)
        if (!(std::abs(glm::dot(glm::dvec3(plane), corner) + plane.w) <= reach)) return false;
    return true;
}

/// Planes by their normals and their distances from a middle, so that nearly equal ones are found.
class PlaneTable {
public:
    PlaneTable(const glm::dvec3& middle, double step) : middle_(middle), step_(step) {}

    /// Calls test(number) for planes that may be nearly the same, until it says true.
    template <class Test>
    bool find(const glm::dvec4& plane, Test test) const {
        const std::array<double, 4> at = placeOf(plane);
        std::array<std::array<int64_t, 2>, 4> cells;
        std::array<int, 4> counts;
        for (size_t i = 0; i < 4; ++i) {
            const double whole = std::floor(at[i]), part = at[i] - whole;
            cells[i] = {static_cast<int64_t>(whole), static_cast<int64_t>(whole) + (part < 0.5 ? -1 : 1)};
            counts[i] = part < 0.25 || part > 0.75 ? 2 : 1;
        }
        for (int a = 0; a < counts[0]; ++a)
            for (int b = 0; b < counts[1]; ++b)
                for (int c = 0; c < counts[2]; ++c)
                    for (int d = 0; d < counts[3]; ++d) {
                        const auto found = table_.find(keyOf(
                            {cells[0][size_t(a)], cells[1][size_t(b)], cells[2][size_t(c)], cells[3][size_t(d)]}));
                        if (found == table_.end()) continue;
                        for (const uint32_t number : found->second)
                            if (test(number)) return true;
                    }
        return false;
    }

    void add(const glm::dvec4& plane, uint32_t number) {
        const std::array<double, 4> at = placeOf(plane);
        std::array<int64_t, 4> cell;
        for (size_t i = 0; i < 4; ++i) cell[i] = static_cast<int64_t>(std::floor(at[i]));
        table_[keyOf(cell)].push_back(number);
    }

private:
    static constexpr double kNormals = 16;  // steps of a normal's coordinates from 0 to 1

    /// The same for both sides of a plane, but where the sides are told apart by a hair.
    std::array<double, 4> placeOf(const glm::dvec4& plane) const {
        const glm::dvec3 size = glm::abs(glm::dvec3(plane));
        const int largest = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const double sign = plane[largest] < 0 ? -1 : 1;
        const double height = glm::dot(glm::dvec3(plane), middle_) + plane.w;
        return {kNormals * sign * plane.x, kNormals * sign * plane.y, kNormals * sign * plane.z, sign * height / step_};
    }
    static uint64_t keyOf(const std::array<int64_t, 4>& cell) {
        uint64_t key = 0;
        for (const int64_t part : cell) key = mixSeed(key, static_cast<uint64_t>(part));
        return key;
    }

    glm::dvec3 middle_;
    double step_;
    std::unordered_map<uint64_t, std::vector<uint32_t>> table_;
};

/// Numbers of corners that are the same to within a step or two.
class CornerNumbers {
public:
    explicit CornerNumbers(double step) : step_(step) {}

    uint32_t of(const glm::dvec3& point) {
        uint64_t key = 0;
        for (int axis = 0; axis < 3; ++axis)
            key = mixSeed(key, static_cast<uint64_t>(static_cast<int64_t>(std::llround(point[axis] / step_))));
        return numbers_.try_emplace(key, static_cast<uint32_t>(numbers_.size())).first->second;
    }
    size_t count() const { return numbers_.size(); }

private:
    double step_;
    std::unordered_map<uint64_t, uint32_t> numbers_;
};

/// Fills SoupWalls::part of a sheet's triangles, and WallSheet::largest.
void measureParts(SoupWalls& walls, WallSheet& sheet, double step) {
    for (const double side : {1.0, -1.0}) {
        CornerNumbers corners(step);
        struct Member {
            uint32_t triangle;
            uint32_t corners[3];
        };
        std::vector<Member> members;
        for (const uint32_t t : sheet.triangles) {
            const WallTriangle& triangle = walls.triangles[t];
            if (!triangle.both && side * glm::dot(areaVectorOf(triangle), glm::dvec3(sheet.plane)) <= 0) continue;
            Member& member = members.emplace_back(Member{t, {}});
            for (int c = 0; c < 3; ++c) member.corners[c] = corners.of(triangle.corners[c]);
        }
        JoinedSets parts(corners.count());
        for (const Member& member : members)
            for (int c = 1; c < 3; ++c) parts.join(member.corners[0], member.corners[c]);
        std::vector<double> area(corners.count(), 0);
        for (const Member& member : members)
            area[parts.find(member.corners[0])] +=
                std::abs(glm::dot(areaVectorOf(walls.triangles[member.triangle]), glm::dvec3(sheet.plane))) / 2;
        for (const Member& member : members) {
            const double whole = area[parts.find(member.corners[0])];
            sheet.largest = std::max(sheet.largest, whole);
            walls.part[member.triangle] = std::max(walls.part[member.triangle], whole);
        }
    }
}

}  // namespace

SoupWalls sheetsOf(std::vector<WallTriangle> triangles, double least_area) {
    SoupWalls out;
    out.triangles = std::move(triangles);
    out.part.assign(out.triangles.size(), 0);
    std::vector<double> areas(out.triangles.size());
    Box3d bounds;
    double coarsest = 0;
    for (size_t i = 0; i < areas.size(); ++i) {
        coarsest = std::max(coarsest, out.triangles[i].rounding);
        areas[i] = glm::length(areaVectorOf(out.triangles[i]));
        for (const glm::dvec3& corner : out.triangles[i].corners) bounds.grow(corner);
    }
    if (bounds.empty()) return out;
    // The largest first: their planes are known best.
    std::vector<uint32_t> order(areas.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return areas[a] > areas[b]; });

    PlaneTable table(bounds.center(), std::max(glm::length(bounds.size()) / 4096, 4 * coarsest));
    std::vector<WallSheet> sheets;
    for (const uint32_t t : order) {
        const WallTriangle& triangle = out.triangles[t];
        if (!(areas[t] > 0) || !std::isfinite(areas[t])) continue;
        const glm::dvec3 normal = areaVectorOf(triangle) / areas[t];
        const glm::dvec4 plane(normal, -glm::dot(normal, triangle.corners[0]));
        const bool known = table.find(plane, [&](uint32_t number) {
            WallSheet& sheet = sheets[number];
            const double reach = std::min(triangle.rounding, out.triangles[sheet.triangles[0]].rounding) / 2;
            if (!liesIn(triangle, sheet.plane, reach)) return false;
            sheet.triangles.push_back(t);
            sheet.rounding = std::max(sheet.rounding, triangle.rounding);
            return true;
        });
        if (known) continue;
        table.add(plane, static_cast<uint32_t>(sheets.size()));
        sheets.push_back({plane, {t}, 0, triangle.rounding});
    }
    for (WallSheet& sheet : sheets) {
        double all = 0;
        for (const uint32_t t : sheet.triangles) all += areas[t] / 2;
        if (all >= least_area) measureParts(out, sheet, 2 * sheet.rounding);
        if (sheet.largest >= least_area) {
            out.sheets.push_back(std::move(sheet));
            continue;
        }
        for (const uint32_t t : sheet.triangles) out.part[t] = 0;
        out.small_triangles += sheet.triangles.size();
    }
    std::stable_sort(out.sheets.begin(), out.sheets.end(),
                     [](const WallSheet& a, const WallSheet& b) { return a.largest > b.largest; });
    return out;
}

}  // namespace sightline::bake
