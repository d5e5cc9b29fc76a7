// Finds thin portals between two surfaces, and puts those that lie in line together.
// SPDX-License-Identifier: MIT
#include "sightline/bake/soup/wall_gaps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "sightline/math/finite.h"
#include "sightline/prepare/lod/near_triangle.h"
#include "sightline/tools/scene/joined_sets.h"
#include "sightline/tree/bvh.h"
#include "sightline/tree/descend.h"

namespace sightline::bake {
using namespace tools;
namespace {

/// Finds the triangles near a point.
class NearWalls {
public:
    /// @param triangles  must outlive this; those that are not finite are passed over
    explicit NearWalls(const std::vector<WallTriangle>& triangles) {
        std::vector<Box3d> boxes;
        for (const WallTriangle& triangle : triangles) {
            Box3d box;
            bool finite = true;
            for (const glm::dvec3& corner : triangle.corners) {
                finite &= isFinite(corner);
                box.grow(corner);
            }
            if (!finite) continue;
            boxes.push_back(box);
            triangles_.push_back(&triangle);
        }
        tree_ = buildBvh(boxes);
    }

    /// Calls visit(triangle, squared distance) for those within `reach` of a point.
    template <class Visit>
    void near(const glm::dvec3& point, double reach, Visit visit) const {
        const Box3f box = roundOutward({point - glm::dvec3(reach), point + glm::dvec3(reach)}, tree_.origin);
        std::vector<uint32_t> stack;
        if (!tree_.nodes.empty()) stack.push_back(0);
        while (!stack.empty()) {
            const uint32_t child = stack.back();
            stack.pop_back();
            if ((child & BvhNode::kLeaf) != 0) {
                const WallTriangle& triangle = *triangles_[tree_.order[child ^ BvhNode::kLeaf]];
                const double squared =
                    squaredDistance({{triangle.corners[0], triangle.corners[1], triangle.corners[2]}}, point);
                if (squared <= reach * reach) visit(triangle, squared);
                continue;
            }
            const BvhNode& node = tree_.nodes[child];
            forEachSlot(usedSlots(node), [&](int slot) {
                for (int axis = 0; axis < 3; ++axis)
                    if (node.min[axis][slot] > box.max[axis] || node.max[axis][slot] < box.min[axis]) return;
                stack.push_back(node.child[slot]);
            });
        }
    }

private:
    std::vector<const WallTriangle*> triangles_;
    Bvh tree_;
};

/// A convex outline as a strip: between the two parallel lines that hold it and are nearest to one another.
struct Strip {
    FlatPiece piece;
    glm::dvec2 along{1, 0}, across{0, 1};
    double begin = 0, end = 0;  // along

    explicit Strip(FlatPiece outline) : piece(std::move(outline)) {
        double least = std::numeric_limits<double>::infinity();
        for (size_t i = 0; i < piece.size(); ++i) {
            const glm::dvec2 edge = piece[(i + 1) % piece.size()] - piece[i];
            const double length = glm::length(edge);
            if (!(length > 0)) continue;
            const glm::dvec2 inward(-edge.y / length, edge.x / length);
            double width = 0;
            for (const glm::dvec2& point : piece) width = std::max(width, glm::dot(inward, point - piece[i]));
            if (width >= least) continue;
            least = width;
            along = edge / length;
            across = inward;
        }
        begin = std::numeric_limits<double>::infinity(), end = -begin;
        for (const glm::dvec2& point : piece) {
            begin = std::min(begin, glm::dot(along, point));
            end = std::max(end, glm::dot(along, point));
        }
    }
    double length() const { return end - begin; }

    /// Where the piece begins and ends across, at a place along it.
    std::pair<double, double> chord(double at) const {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (size_t i = 0; i < piece.size(); ++i) {
            const glm::dvec2 &a = piece[i], &b = piece[(i + 1) % piece.size()];
            const double from = glm::dot(along, a) - at, to = glm::dot(along, b) - at;
            if ((from > 0 && to > 0) || (from < 0 && to < 0)) continue;
            // Of an edge across the strip both ends count.
            const glm::dvec2 first = from == to ? a : a + from / (from - to) * (b - a), last = from == to ? b : first;
            for (const glm::dvec2& point : {first, last}) {
                low = std::min(low, glm::dot(across, point));
                high = std::max(high, glm::dot(across, point));
            }
        }
        return {low, high};
    }
};

/// What bounds a slit at one side.
struct Bound {
    uint32_t object = 0;                ///< the nearest; of several as near the first
    bool flush = false;                 ///< a surface lies in the portal's plane
    bool inside = false;                ///< the nearest surface across that plane shows its back
    std::optional<uint32_t> two_sided;  ///< the object of that surface, if it has two sides
};

std::optional<Bound> boundAt(const NearWalls& walls, const glm::dvec3& edge, const glm::dvec3& middle,
                             const glm::dvec4& plane, double reach, double hole) {
    struct Near {
        double distance;
        uint32_t object;
        bool across, front, both;
    };
    std::vector<Near> found;
    Bound out;
    double nearest = reach, nearest_across = reach;
    walls.near(edge, reach, [&](const WallTriangle& triangle, double squared) {
        const glm::dvec3 area =
            glm::cross(triangle.corners[1] - triangle.corners[0], triangle.corners[2] - triangle.corners[0]);
        const double size = glm::length(area), distance = std::sqrt(squared);
        if (!(size > 0)) return;
        const bool across = std::abs(glm::dot(area / size, glm::dvec3(plane))) <= 0.9;
        found.push_back(
            {distance, triangle.object, across, glm::dot(area, middle - triangle.corners[0]) > 0, triangle.both});
        nearest = std::min(nearest, distance);
        if (across) nearest_across = std::min(nearest_across, distance);
        else out.flush |= std::abs(glm::dot(glm::dvec3(plane), triangle.corners[0]) + plane.w) <= 2 * hole;
    });
    if (found.empty()) return std::nullopt;
    // What is nearer than this by less is as near: coordinates are not exact.
    const double same = 2 * hole;
    out.object = std::numeric_limits<uint32_t>::max();
    bool front = false, back = false;
    for (const Near& triangle : found) {
        if (triangle.distance <= nearest + same) out.object = std::min(out.object, triangle.object);
        if (!triangle.across || triangle.distance > nearest_across + same) continue;
        (triangle.both || triangle.front ? front : back) = true;
        if (triangle.both) out.two_sided = std::min(out.two_sided.value_or(triangle.object), triangle.object);
    }
    out.inside = back && !front;
    return out;
}

/// Whether light comes into a slit between two surfaces, and the slit is one of a wall.
bool isGap(const Bound& a, const Bound& b) {
    const bool of_one_leaf = a.two_sided && b.two_sided && *a.two_sided == *b.two_sided;
    return !a.inside && !b.inside && !of_one_leaf && (a.flush || b.flush);
}

/// A portal that may be a slit, or hold some.
class ThinPortal {
public:
    ThinPortal(const NearWalls& walls, std::span<const glm::dvec3> outline, const glm::dvec4& plane, double hole)
        : walls_(walls),
          plane_(plane),
          hole_(hole),
          frame_(outline[0], glm::dvec3(plane)),
          strip_(pieceOf(frame_, outline)) {}

    /// Appends the stretches of it that the same two objects bound.
    void findSlits(double widest, std::vector<WallGap>& slits) const {
        if (!(strip_.length() > 16 * hole_)) return;
        constexpr double kPlaces = 64;
        double width = 0;
        for (int i = 0; i < kPlaces; ++i) width = std::max(width, widthAt(placeOf(i, kPlaces)));
        if (!(width <= widest && width > hole_ && strip_.length() >= kLeastShape * width)) return;
        WallGap slit;
        int places = 0;
        const auto end = [&](double at) {
            slit.to = middleAt(at);
            if (places >= 3 && slit.length() >= kLeastShape * slit.width) slits.push_back(slit);
            places = 0;
        };
        Objects last = kNoGap;
        for (int i = 0; i < kPlaces; ++i) {
            const double at = placeOf(i, kPlaces);
            const Objects now = boundsAt(at);
            if (places > 0 && now != last) end(changeBetween(placeOf(i - 1, kPlaces), at));
            if (now != kNoGap && places == 0) {
                slit = WallGap{};
                slit.objects[0] = now.first;
                slit.objects[1] = now.second;
                slit.from = middleAt(i == 0 ? strip_.begin + hole_ : changeBetween(at, placeOf(i - 1, kPlaces)));
            }
            if (now != kNoGap) {
                slit.width = std::max(slit.width, widthAt(at));
                ++places;
            }
            last = now;
        }
        if (places > 0) end(strip_.end - hole_);
    }

private:
    using Objects = std::pair<uint32_t, uint32_t>;
    static constexpr Objects kNoGap{UINT32_MAX, UINT32_MAX};
    static constexpr double kLeastShape = 3;  // length over width

    static FlatPiece pieceOf(const FlatFrame& frame, std::span<const glm::dvec3> outline) {
        FlatPiece piece = frame.to(outline);
        if (areaOf(piece) < 0) std::reverse(piece.begin(), piece.end());
        return piece;
    }
    double placeOf(int i, double places) const { return strip_.begin + strip_.length() * (i + 0.5) / places; }
    /// As it was before it was widened.
    double widthAt(double at) const {
        const auto [low, high] = strip_.chord(at);
        return high - low - 2 * hole_;
    }
    glm::dvec3 pointAt(double at, double height) const {
        return frame_.from(at * strip_.along + height * strip_.across);
    }
    glm::dvec3 middleAt(double at) const {
        const auto [low, high] = strip_.chord(std::clamp(at, strip_.begin, strip_.end));
        return pointAt(at, (low + high) / 2);
    }
    /// The objects that bound a gap at a place, or kNoGap.
    Objects boundsAt(double at) const {
        const auto [low, high] = strip_.chord(at);
        const double width = high - low - 2 * hole_;
        const glm::dvec3 middle = middleAt(at);
        bool covered = false;  // by the back of a wall: a portal from one side alone
        walls_.near(middle, 2 * hole_, [&](const WallTriangle&, double) { covered = true; });
        if (covered) return kNoGap;
        const double reach = std::max(width, 0.0) / 4 + 2 * hole_;
        const auto first = boundAt(walls_, pointAt(at, low + hole_), middle, plane_, reach, hole_);
        const auto second = boundAt(walls_, pointAt(at, high - hole_), middle, plane_, reach, hole_);
        if (!first || !second || !isGap(*first, *second)) return kNoGap;
        return std::minmax(first->object, second->object);
    }
    /// Where the objects that bound it change, on the side of a place.
    double changeBetween(double at, double other) const {
        const Objects here = boundsAt(at);
        for (int i = 0; i < 10; ++i) {
            const double middle = 0.5 * (at + other);
            (boundsAt(middle) == here ? at : other) = middle;
        }
        return at;
    }

    const NearWalls& walls_;
    const glm::dvec4 plane_;
    const double hole_;
    const FlatFrame frame_;
    const Strip strip_;
};

bool inLine(const WallGap& a, const WallGap& b, double apart) {
    const bool longer = a.length() >= b.length();
    const WallGap &line = longer ? a : b, &other = longer ? b : a;
    const double length = line.length();
    if (!(length > 0)) return false;
    const glm::dvec3 along = (line.to - line.from) / length;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const glm::dvec3& end : {other.from, other.to}) {
        const double at = glm::dot(along, end - line.from);
        if (glm::distance(line.from + at * along, end) > apart) return false;
        low = std::min(low, at);
        high = std::max(high, at);
    }
    return low <= length + apart && high >= -apart;
}

/// One gap of slits in line.
WallGap joined(const std::vector<const WallGap*>& slits) {
    const WallGap& longest = **std::max_element(
        slits.begin(), slits.end(), [](const WallGap* a, const WallGap* b) { return a->length() < b->length(); });
    WallGap out = longest;
    const glm::dvec3 along = longest.to - longest.from;
    const auto at = [&](const glm::dvec3& end) { return glm::dot(along, end - longest.from); };
    for (const WallGap* slit : slits) {
        out.width = std::max(out.width, slit->width);
        for (const glm::dvec3& end : {slit->from, slit->to}) {
            if (at(end) < at(out.from)) out.from = end;
            if (at(end) > at(out.to)) out.to = end;
        }
    }
    return out;
}

}  // namespace

std::vector<WallGap> gapsOfWalls(const SoupWalls& walls, const CellSpace& space, double hole, double widest) {
    const NearWalls near(walls.triangles);
    std::map<std::pair<uint32_t, uint32_t>, std::vector<WallGap>> slits;
    std::vector<WallGap> found;
    for (const CellPortal& portal : space.graph.portals)
        ThinPortal(near, space.graph.outline(portal), portal.plane, hole).findSlits(widest, found);
    for (const WallGap& slit : found) slits[{slit.objects[0], slit.objects[1]}].push_back(slit);
    std::vector<WallGap> out;
    for (const auto& [objects, of] : slits) {
        JoinedSets lines(of.size());
        for (uint32_t i = 0; i < of.size(); ++i)
            for (uint32_t j = 0; j < i; ++j)
                if (inLine(of[i], of[j], widest)) lines.join(i, j);
        std::map<uint32_t, std::vector<const WallGap*>> members;
        for (uint32_t i = 0; i < of.size(); ++i) members[lines.find(i)].push_back(&of[i]);
        for (const auto& [first, line] : members) out.push_back(joined(line));
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const WallGap& a, const WallGap& b) { return a.width * a.length() > b.width * b.length(); });
    return out;
}

}  // namespace sightline::bake
