// Follows light from a region through portals, each clipped by planes between the region and the portal before it.
// SPDX-License-Identifier: MIT
#include "sightline/bake/flow/region_flow.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <iterator>
#include <numeric>
#include <utility>

#include "sightline/base/assert.h"
#include "sightline/base/random.h"

namespace sightline::bake {
namespace {

double heightOf(const glm::dvec4& plane, const glm::dvec3& p) { return glm::dot(glm::dvec3(plane), p) + plane.w; }

using Polygon = std::vector<glm::dvec3>;

/// Whether a convex polygon holds another one of the same plane, or all but so much of its width.
bool holds(const Polygon& window, const Polygon& part, const glm::dvec3& normal, double but) {
    const glm::dvec3 middle = std::accumulate(window.begin(), window.end(), glm::dvec3(0.0)) / double(window.size());
    for (size_t i = 0; i < window.size(); ++i) {
        const glm::dvec3 &a = window[i], &b = window[i + 1 == window.size() ? 0 : i + 1];
        glm::dvec3 inward = glm::cross(normal, b - a);
        const double length = glm::length(inward);
        if (!(length > 0)) continue;
        inward /= glm::dot(inward, middle - a) < 0 ? -length : length;
        for (const glm::dvec3& point : part)
            if (glm::dot(inward, point - a) < -but) return false;
    }
    return true;
}

/// The convex hull of two polygons of one plane; less than three corners if they are that thin. What is left out of it by
/// rounding is as narrow as that.
/// A. M. Andrew. Another efficient algorithm for convex hulls in two dimensions. 1979.
Polygon hullOf(const Polygon& a, const Polygon& b, const glm::dvec3& normal) {
    const glm::dvec3 size = glm::abs(normal);
    const int drop = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int u = (drop + 1) % 3, v = (drop + 2) % 3;
    Polygon points = a;
    points.insert(points.end(), b.begin(), b.end());
    std::sort(points.begin(), points.end(),
              [&](const glm::dvec3& p, const glm::dvec3& q) { return p[u] != q[u] ? p[u] < q[u] : p[v] < q[v]; });
    Polygon hull;
    const auto turn = [&](const glm::dvec3& o, const glm::dvec3& p, const glm::dvec3& q) {
        return (p[u] - o[u]) * (q[v] - o[v]) - (p[v] - o[v]) * (q[u] - o[u]);
    };
    for (const int half : {0, 1}) {
        const size_t begin = hull.size();
        for (size_t i = 0; i < points.size(); ++i) {
            const glm::dvec3& point = points[half ? points.size() - 1 - i : i];
            while (hull.size() >= begin + 2 && turn(hull[hull.size() - 2], hull.back(), point) <= 0) hull.pop_back();
            hull.push_back(point);
        }
        hull.pop_back();
    }
    return hull;
}

double farthest(const Box3d& box) {
    const glm::dvec3 most = glm::max(glm::abs(box.min), glm::abs(box.max));
    return std::max({most.x, most.y, most.z});
}

}  // namespace

Penumbra::Penumbra(const Box3d& region, std::span<const glm::dvec3> window, const glm::dvec4& beyond, double slack,
                   std::span<const glm::dvec4> passed) {
    // A polygon of which less than three corners are left has no point as close as the slack.
    const auto take = [&](const glm::dvec4& plane) { planes_[count_++] = plane + glm::dvec4(0, 0, 0, 2 * slack); };
    take(beyond);
    glm::dvec3 middle(0.0);
    for (const glm::dvec3& corner : window) middle += corner / static_cast<double>(window.size());
    const glm::dvec3 center = region.center(), half = 0.5 * region.size();
    for (size_t i = 0; i < window.size() && count_ < kMost; ++i) {
        const glm::dvec3 &a = window[i], along = window[i + 1 == window.size() ? 0 : i + 1] - a;
        glm::dvec3 outward = glm::cross(along, glm::dvec3(beyond));
        if (glm::dot(outward, middle - a) > 0) outward = -outward;
        const double length = glm::length(outward);
        if (!(length > 0)) continue;
        outward /= length;
        // Across the edge: how far the region's corners stand out over it, and how high before the window's plane.
        glm::dvec2 corners[8], farthest_in(0.0, 0.0);
        uint32_t best = 8;
        for (uint32_t corner = 0; corner < 8; ++corner) {
            const glm::dvec3 to = region.corner(corner) - a;
            const glm::dvec2 at(glm::dot(outward, to), -glm::dot(glm::dvec3(beyond), to));
            corners[corner] = at;
            if (!(at.y > 0) || (best < 8 && at.x * farthest_in.y >= farthest_in.x * at.y)) continue;
            best = corner;
            farthest_in = at;
        }
        if (best == 8) continue;
        // The plane through the edge and this corner must have all others on the one side, where the window is not.
        const bool divides = std::all_of(std::begin(corners), std::end(corners), [&](const glm::dvec2& at) {
            return farthest_in.x * at.y - farthest_in.y * at.x <= slack * glm::length(farthest_in);
        });
        if (!divides) continue;
        // Moved outward a little, it leaves room for the slack; where it is steep to the window's plane, that takes more.
        double away = std::max(2.0, 1.6 * glm::length(farthest_in) / farthest_in.y) * slack;
        for (int more = 0; more < 3; ++more, away *= 4) {
            const glm::dvec3 from = a + away * outward;
            glm::dvec3 normal = glm::cross(along, region.corner(best) - from);
            const double size = glm::length(normal);
            if (!(size > 0)) break;
            normal /= glm::dot(normal, middle - from) < 0 ? -size : size;
            const double highest = glm::dot(normal, center) + glm::dot(glm::abs(normal), half);
            const glm::dvec4 plane(normal, -highest - 0.125 * slack);
            double lowest = heightOf(plane, window[0]);
            for (const glm::dvec3& point : window) lowest = std::min(lowest, heightOf(plane, point));
            if (lowest < 1.375 * slack) continue;
            take(plane);
            break;
        }
    }
    edges_ = count_ - 1;
    for (const glm::dvec4& plane : passed.first(std::min(passed.size(), kMostPassed))) planes_[count_++] = plane;
}

bool Penumbra::divides(const glm::dvec4& plane, std::span<const glm::dvec3> window, double slack) {
    // It was moved by two slacks when it was taken.
    return std::all_of(window.begin(), window.end(),
                       [&](const glm::dvec3& point) { return heightOf(plane, point) >= (2 + 1.375) * slack; });
}

void Penumbra::clip(std::vector<glm::dvec3>& polygon, std::vector<glm::dvec3>& scratch, uint64_t by) const {
    for (by &= (uint64_t{1} << count_) - 1; by != 0; by &= by - 1) {
        const glm::dvec4& plane = planes_[static_cast<size_t>(std::countr_zero(by))];
        scratch.clear();
        for (size_t i = 0; i < polygon.size(); ++i) {
            const glm::dvec3 &a = polygon[i], &b = polygon[i + 1 == polygon.size() ? 0 : i + 1];
            const double above_a = heightOf(plane, a), above_b = heightOf(plane, b);
            if (above_a >= 0) scratch.push_back(a);
            if ((above_a >= 0) != (above_b >= 0)) scratch.push_back(a + above_a / (above_a - above_b) * (b - a));
        }
        polygon.swap(scratch);
        if (polygon.size() < 3) return polygon.clear();
    }
}

RegionFlow::RegionFlow(const CellSpace& space, const RegionFlowSettings& settings)
    : space_(space), settings_(settings) {
    SIGHTLINE_ASSERT(space.ofTree());
    const CellGraph& graph = space.graph;
    double reach = farthest(space.tree.bounds), thickest = 0;
    for (const glm::dvec3& point : graph.points) reach = std::max(reach, farthest({point, point}));
    for (const CellPortal& portal : graph.portals) thickest = std::max(thickest, portal.thickness);
    reach_ = reach;
    slack_ = 2 * space.tolerance + thickest + 1e-9 * reach;
    first_way_.assign(graph.cells + 1, 0);
    const auto forEachWay = [&](const auto& visit) {
        for (uint32_t portal = 0; portal < graph.portals.size(); ++portal) {
            const CellPortal& of = graph.portals[portal];
            Box3d box;
            for (const glm::dvec3& point : graph.outline(of)) box.grow(point);
            const double radius = 0.5 * glm::length(box.size()) + 1e-9 * reach;
            visit(Way{portal, of.cells[0], of.cells[1], false, box.center(), radius});
            if (!of.one_way) visit(Way{portal, of.cells[1], of.cells[0], true, box.center(), radius});
        }
    };
    forEachWay([&](const Way& way) { ++first_way_[way.from + 1]; });
    for (uint32_t cell = 0; cell < graph.cells; ++cell) first_way_[cell + 1] += first_way_[cell];
    ways_.resize(first_way_.back());
    std::vector<uint32_t> next = first_way_;
    forEachWay([&](const Way& way) { ways_[next[way.from]++] = way; });
    arrived_.resize(ways_.size());
}

/// The plane of a portal, its normal into the cell that the way leads to.
glm::dvec4 RegionFlow::planeOf(const Way& way) const {
    const glm::dvec4& plane = space_.graph.portals[way.portal].plane;  // points into cells[0]
    return way.reversed ? plane : -plane;
}

/// Whether all of a region lies where a way leads to.
bool RegionFlow::isBeyond(const Box3d& region, const Way& way) const {
    const glm::dvec4 plane = planeOf(way);
    return heightOf(plane, region.center()) - 0.5 * glm::dot(glm::abs(glm::dvec3(plane)), region.size()) > slack_;
}

RegionFlow::Polygon RegionFlow::outlineOf(uint32_t way) const {
    const auto outline = space_.graph.outline(space_.graph.portals[ways_[way].portal]);
    return {outline.begin(), outline.end()};
}

void RegionFlow::findStarts(const Box3d& region) {
    starts_.clear();
    const LeafTree& tree = space_.tree;
    std::vector<uint32_t> stack{tree.nodes.empty() ? LeafTreeNode::kLeaf : 0};
    while (!stack.empty()) {
        const uint32_t at = stack.back();
        stack.pop_back();
        if (at & LeafTreeNode::kLeaf) {
            const uint32_t cell = space_.graph.cell_of_leaf[at & ~LeafTreeNode::kLeaf];
            if (cell != CellGraph::kNoCell) starts_.push_back(cell);
            continue;
        }
        const LeafTreeNode& node = tree.nodes[at];
        const glm::dvec4 plane = node.plane / glm::length(glm::dvec3(node.plane));
        const double middle = heightOf(plane, region.center());
        const double reach = 0.5 * glm::dot(glm::abs(glm::dvec3(plane)), region.size()) + slack_;
        if (middle <= reach) stack.push_back(node.child[0]);
        if (middle >= -reach) stack.push_back(node.child[1]);
    }
    std::sort(starts_.begin(), starts_.end());
    starts_.erase(std::unique(starts_.begin(), starts_.end()), starts_.end());
}

/// Notes that light comes to a part of a way's portal. A plane that some of the light has passed is kept if all of it has.
void RegionFlow::arrive(uint32_t way, const Polygon& part, std::span<const uint32_t> passed) {
    Arrived& at = arrived_[way];
    if (at.window.empty()) {
        touched_.push_back(way);
        at.window = part;
        at.passed.assign(passed.begin(), passed.end());
    } else {
        const auto hasPassed = [&](uint32_t plane, std::span<const uint32_t> known, const Polygon& window) {
            return std::binary_search(known.begin(), known.end(), plane, std::greater()) ||
                   Penumbra::divides(planes_[plane], window, slack_);
        };
        const glm::dvec3 normal(space_.graph.portals[ways_[way].portal].plane);
        const bool held = holds(at.window, part, normal, 0.125 * slack_);
        std::vector<uint32_t> kept;
        for (const uint32_t plane : at.passed)
            if (hasPassed(plane, passed, part)) kept.push_back(plane);
        if (held && kept.size() == at.passed.size()) return;
        if (at.turns >= settings_.turns) {
            at.window = outlineOf(way);
            kept.clear();
        } else if (!held) {
            for (const uint32_t plane : passed)
                if (!std::binary_search(at.passed.begin(), at.passed.end(), plane, std::greater()) &&
                    Penumbra::divides(planes_[plane], at.window, slack_))
                    kept.push_back(plane);
            std::sort(kept.begin(), kept.end(), std::greater());
            kept.resize(std::min(kept.size(), Penumbra::kMostPassed));
            at.window = hullOf(at.window, part, normal);
            if (at.window.size() < 3) at.window = outlineOf(way);
        }
        at.passed = std::move(kept);
    }
    if (std::exchange(at.waits, true)) return;
    const Polygon& window = at.window;
    const glm::dvec3 middle = std::accumulate(window.begin(), window.end(), glm::dvec3(0.0)) / double(window.size());
    queue_.emplace_back(-glm::distance(middle, middle_), way);
    std::push_heap(queue_.begin(), queue_.end());
}

/// Planes that are nowhere in the tree farther apart than a fiftieth of the slack are one: edges in line make many.
uint32_t RegionFlow::numberOf(const glm::dvec4& plane) {
    const glm::dvec4 step(glm::dvec3(slack_ / (200 * reach_)), slack_ / 200);
    uint64_t bits = 0;
    for (int i = 0; i < 4; ++i) bits = mixSeed(bits, static_cast<uint64_t>(std::llround(plane[i] / step[i])));
    const auto next = static_cast<uint32_t>(planes_.size());
    const uint32_t number = numbers_.try_emplace(bits, next).first->second;
    if (number < next && glm::all(glm::lessThanEqual(glm::abs(planes_[number] - plane), step))) return number;
    planes_.push_back(plane);
    return next;
}

/// Lists in onward_ what light has passed behind a window: the planes of its edges, and those before. The latest are kept.
void RegionFlow::passOn(const Penumbra& penumbra, std::span<const uint32_t> passed) {
    onward_.assign(passed.begin(), passed.end());
    for (const glm::dvec4& plane : penumbra.edges()) onward_.push_back(numberOf(plane));
    std::sort(onward_.begin(), onward_.end(), std::greater());
    onward_.erase(std::unique(onward_.begin(), onward_.end()), onward_.end());
    onward_.resize(std::min(onward_.size(), Penumbra::kMostPassed));
}

RegionFlow::End RegionFlow::from(const Box3d& region, const Reach& reach) {
    const Box3d& bounds = space_.tree.bounds;
    if (glm::any(glm::lessThan(region.min, bounds.min)) || glm::any(glm::greaterThan(region.max, bounds.max)))
        return End::kOutOfBounds;
    const Box3d grown{region.min - space_.tolerance, region.max + space_.tolerance};
    const End ended = flow(grown, reach);
    queue_.clear();
    for (const uint32_t way : touched_) arrived_[way] = {};
    touched_.clear();
    planes_.clear();
    numbers_.clear();
    return ended;
}

RegionFlow::End RegionFlow::flow(const Box3d& region, const Reach& reach) {
    const uint64_t end = clipped_ + settings_.budget;
    middle_ = region.center();
    findStarts(region);
    for (const uint32_t start : starts_) {
        if (!reach(start, nullptr)) return End::kStopped;
        for (uint32_t way = first_way_[start]; way < first_way_[start + 1]; ++way)
            if (!isBeyond(region, ways_[way])) arrive(way, outlineOf(way), {});
    }
    Polygon part, scratch;
    while (!queue_.empty()) {
        if (clipped_ > end) return End::kOverBudget;
        std::pop_heap(queue_.begin(), queue_.end());
        const uint32_t number = queue_.back().second;
        queue_.pop_back();
        const Way& way = ways_[number];
        Arrived& at = arrived_[number];
        at.waits = false;
        ++at.turns;
        before_.clear();
        for (const uint32_t plane : at.passed) before_.push_back(planes_[plane]);
        const Penumbra penumbra(region, at.window, planeOf(way), slack_, before_);
        if (!reach(way.to, &penumbra)) return End::kStopped;
        passOn(penumbra, at.passed);
        for (uint32_t next = first_way_[way.to]; next < first_way_[way.to + 1]; ++next) {
            // Cells are convex: no line comes back into the one that it has left. Nor does one from beyond a portal pass it.
            if (ways_[next].to == way.from || isBeyond(region, ways_[next])) continue;
            ++clipped_;
            const std::optional<uint64_t> cutting = penumbra.cutting(ways_[next].center, ways_[next].radius);
            if (!cutting) continue;
            part = outlineOf(next);
            penumbra.clip(part, scratch, *cutting);
            if (!part.empty()) arrive(next, part, onward_);
        }
    }
    return End::kDone;
}

}  // namespace sightline::bake
