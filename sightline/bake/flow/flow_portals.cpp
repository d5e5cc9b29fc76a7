// Lays out a cell graph for light: welds points, finds planes, and sorts portals by the cell that they leave.
// SPDX-License-Identifier: MIT
#include "sightline/bake/flow/flow_portals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <unordered_map>

#include "sightline/base/random.h"
#include "sightline/geom/outline_hull.h"

namespace sightline::bake {
namespace {

/// How well the points of each portal are known. Moving all points to the center rounds them, and so does each height.
/// @param directed  with its precision and its rounding
std::vector<double> precisionsOf(const CellGraph& graph, const FlowPortals& directed) {
    std::vector<double> precisions;
    precisions.reserve(graph.portals.size());
    for (const CellPortal& portal : graph.portals) {
        glm::dvec3 far(0.0);
        for (const glm::dvec3& point : graph.outline(portal)) far = glm::max(far, glm::abs(point));
        const double own = kPortalPrecision * std::max({far.x, far.y, far.z}) + directed.rounding;
        precisions.push_back(std::min(directed.precision, own));
    }
    return precisions;
}

/// Welds points that are near one another to the first of them.
class Welder {
public:
    /// @param points  of `graph`, moved
    Welder(std::vector<glm::dvec3>& points, const CellGraph& graph, std::span<const double> precisions)
        : points_(points), reach_(points.size(), 0) {
        for (size_t i = 0; i < graph.portals.size(); ++i)
            std::fill_n(reach_.begin() + graph.portals[i].first, graph.portals[i].count, precisions[i]);
    }

    void weld() {
        for (uint32_t i = 0; i < points_.size(); ++i) {
            if (!(reach_[i] > 0)) continue;
            const uint32_t same = find(i);
            if (same != i) {
                points_[i] = points_[same];
                continue;
            }
            const int level = levelOf(reach_[i]);
            grids_[level].emplace(keyOf(placeOf(points_[i], level)), i);
        }
    }

private:
    using Place = glm::tvec3<int64_t>;

    /// Points are listed in the grid of their level, where a cell is four times as wide as the widest reach.
    static int levelOf(double reach) { return std::ilogb(reach) >> 3; }
    static double widestOf(int level) { return std::ldexp(1.0, 8 * (level + 1)); }
    static Place placeOf(const glm::dvec3& point, int level) {
        return Place(glm::floor(point / (4 * widestOf(level))));
    }
    static uint64_t keyOf(const Place& place) {
        return mixSeed(mixSeed(static_cast<uint64_t>(place.x), static_cast<uint64_t>(place.y)),
                       static_cast<uint64_t>(place.z));
    }

    uint32_t find(uint32_t i) const {
        uint32_t best = i;
        for (const auto& [level, cells] : grids_) {
            const glm::dvec3 reach(std::min(reach_[i], widestOf(level)));
            const Place low = placeOf(points_[i] - reach, level), high = placeOf(points_[i] + reach, level);
            for (int64_t x = low.x; x <= high.x; ++x)
                for (int64_t y = low.y; y <= high.y; ++y)
                    for (int64_t z = low.z; z <= high.z; ++z) {
                        const auto [begin, end] = cells.equal_range(keyOf({x, y, z}));
                        for (auto other = begin; other != end; ++other)
                            if (isSame(i, other->second)) best = std::min(best, other->second);
                    }
        }
        return best;
    }

    bool isSame(uint32_t a, uint32_t b) const {
        const glm::dvec3 apart = glm::abs(points_[a] - points_[b]);
        return std::max({apart.x, apart.y, apart.z}) <= std::min(reach_[a], reach_[b]);
    }

    std::vector<glm::dvec3>& points_;
    std::vector<double> reach_;
    std::map<int, std::unordered_multimap<uint64_t, uint32_t>> grids_;
};

/// Numbers the planes of portals: portals with one number lie in one plane to within four of their own precisions.
class Sheets {
public:
    /// @param search  planes whose offsets are farther apart are not held against one another
    explicit Sheets(double search) : search_(search) {}

    uint32_t of(const FlowPortal& portal, std::span<const glm::dvec3> outline) {
        // Both sides of a plane are the same sheet.
        const double sign = firstSign(portal.normal);
        const glm::dvec3 normal = sign * portal.normal;
        const double offset = sign * portal.offset;
        const double step = 0x1p-10;  // coarse: neighbouring buckets are searched too
        const glm::dvec3 at = normal / step;
        for (int64_t x = floorOf(at.x - .01); x <= floorOf(at.x + .01); ++x)
            for (int64_t y = floorOf(at.y - .01); y <= floorOf(at.y + .01); ++y)
                for (int64_t z = floorOf(at.z - .01); z <= floorOf(at.z + .01); ++z)
                    for (int64_t w = floorOf(offset - search_); w <= floorOf(offset + search_); ++w) {
                        const auto [begin, end] = known_.equal_range(key(x, y, z, w));
                        for (auto other = begin; other != end; ++other)
                            if (holds(sheets_[other->second], outline, 4 * portal.precision)) return other->second;
                    }
        const auto number = static_cast<uint32_t>(sheets_.size());
        sheets_.push_back(glm::dvec4(normal, offset));
        known_.emplace(key(floorOf(at.x), floorOf(at.y), floorOf(at.z), floorOf(offset)), number);
        return number;
    }

    /// The number of a bent portal, which lies in no plane.
    uint32_t ofItsOwn() {
        sheets_.emplace_back(0.0);
        return static_cast<uint32_t>(sheets_.size()) - 1;
    }

private:
    static int64_t floorOf(double value) { return static_cast<int64_t>(std::floor(value)); }
    static double firstSign(const glm::dvec3& normal) {
        int axis = 0;
        for (int i = 1; i < 3; ++i)
            if (std::abs(normal[i]) > std::abs(normal[axis]) + 1e-6) axis = i;
        return normal[axis] < 0 ? -1 : 1;
    }
    static uint64_t key(int64_t x, int64_t y, int64_t z, int64_t w) {
        return mixSeed(mixSeed(static_cast<uint64_t>(x), static_cast<uint64_t>(y)),
                       mixSeed(static_cast<uint64_t>(z), static_cast<uint64_t>(w)));
    }
    static bool holds(const glm::dvec4& plane, std::span<const glm::dvec3> outline, double tolerance) {
        return std::all_of(outline.begin(), outline.end(), [&](const glm::dvec3& point) {
            return std::abs(glm::dot(glm::dvec3(plane), point) + plane.w) <= tolerance;
        });
    }

    double search_;
    std::vector<glm::dvec4> sheets_;
    std::unordered_multimap<uint64_t, uint32_t> known_;
};

/// The middle of an outline, and how far its points are from it.
void findMiddle(std::span<const glm::dvec3> outline, FlowPortal& portal) {
    glm::dvec3 sum(0);
    for (const glm::dvec3& point : outline) sum += point;
    portal.center = sum / static_cast<double>(outline.size());
    double squared = 0;
    for (const glm::dvec3& point : outline)
        squared = std::max(squared, glm::dot(point - portal.center, point - portal.center));
    portal.radius = std::sqrt(squared) * (1 + 0x1p-40);
}

/// How far a corner lies beyond the line of an edge, at most.
double bulgeOf(std::span<const glm::dvec3> outline, const glm::dvec3& normal) {
    double bulge = 0;
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 edge = outline[i + 1 == outline.size() ? 0 : i + 1] - outline[i];
        const double length = glm::length(edge);
        if (!(length > 0)) continue;
        const glm::dvec3 outward = glm::cross(edge, normal) / length;
        for (const glm::dvec3& point : outline) bulge = std::max(bulge, glm::dot(outward, point - outline[i]));
    }
    return bulge;
}

/// The place of a portal, and its convex outline. The graph's normal points into cells[0]: this is the way from cells[1].
/// The plane is the graph's: that of a thin outline, found from points that are known to the precision only, may be
/// turned by as much as the precision is of its width.
/// @param center  FlowPortals::center
FlowPortal wayThrough(const CellPortal& portal, const glm::dvec3& center, std::span<const glm::dvec3> given,
                      std::vector<glm::dvec3>& hull) {
    hull = outlineHull(given, glm::dvec3(portal.plane));
    if (hull.size() < 3) hull.assign(given.begin(), given.end());
    FlowPortal way;
    findMiddle(hull, way);
    way.normal = glm::dvec3(portal.plane);
    way.offset = glm::dot(way.normal, center) + portal.plane.w;
    return way;
}

}  // namespace

FlowPortals flowPortalsOf(const CellGraph& graph) {
    FlowPortals directed;
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const glm::dvec3& point : graph.points) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    directed.first_of_cell.assign(graph.cells + 1, 0);
    if (graph.portals.empty()) return directed;
    directed.center = glm::round(0.5 * low + 0.5 * high);
    const glm::dvec3 half = glm::max(high - directed.center, directed.center - low);
    directed.extent = std::max({half.x, half.y, half.z});
    const double largest = std::max({glm::length(low), glm::length(high), directed.extent});
    directed.precision = largest * kGraphPrecision;
    directed.rounding = directed.extent * 0x1p-48;

    std::vector<glm::dvec3> points = graph.points;
    for (glm::dvec3& point : points) point -= directed.center;
    const std::vector<double> precisions = precisionsOf(graph, directed);
    Welder(points, graph, precisions).weld();

    // Portals are sorted by the cell that they leave; those of one cell keep the graph's order.
    for (const CellPortal& portal : graph.portals)
        for (const uint32_t cell : portal.cells) ++directed.first_of_cell[cell + 1];
    std::partial_sum(directed.first_of_cell.begin(), directed.first_of_cell.end(), directed.first_of_cell.begin());
    std::vector<uint32_t> next(directed.first_of_cell.begin(), directed.first_of_cell.end() - 1);
    directed.portals.resize(2 * graph.portals.size());
    Sheets sheets(256 * directed.precision);
    for (uint32_t i = 0; i < graph.portals.size(); ++i) {
        const CellPortal& portal = graph.portals[i];
        const std::span<const glm::dvec3> given{points.data() + portal.first, portal.count};
        std::vector<glm::dvec3> hull;
        FlowPortal way = wayThrough(portal, directed.center, given, hull);
        way.portal = i;
        way.precision = precisions[i];
        for (const glm::dvec3& point : hull) way.bend = std::max(way.bend, std::abs(way.height(point)));
        way.straight = bulgeOf(hull, way.normal) <= directed.rounding;
        // A line that leaves a flat portal rises, so it passes every later portal higher up. It may leave a bent portal
        // as far below its plane as it is bent.
        const bool flat = way.bend <= way.precision;
        way.above = flat ? way.precision : -way.bend;
        way.sheet = flat ? sheets.of(way, hull) : sheets.ofItsOwn();
        const uint32_t there = next[portal.cells[1]]++, back = next[portal.cells[0]]++;
        way.count = static_cast<uint32_t>(hull.size());
        for (const bool forward : {true, false}) {
            way.first = static_cast<uint32_t>(directed.points.size());
            way.from = portal.cells[forward ? 1 : 0];
            way.to = portal.cells[forward ? 0 : 1];
            way.reverse = forward ? back : there;
            directed.points.insert(directed.points.end(), hull.begin(), hull.end());
            directed.portals[forward ? there : back] = way;
            std::reverse(hull.begin(), hull.end());
            way.normal = -way.normal;
            way.offset = -way.offset;
        }
    }
    return directed;
}

}  // namespace sightline::bake
