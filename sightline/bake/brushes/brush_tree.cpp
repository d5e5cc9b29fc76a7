// Brushes to a tree: a region is divided along sides of the brushes in it, until each brush left holds all of it.
// SPDX-License-Identifier: MIT
#include "sightline/bake/brushes/brush_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "sightline/bake/brushes/brush_planes.h"

namespace sightline::bake {
using namespace tools;
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Three points of a plane may lie anywhere in it: brushes reach farther than their points, but seldom farther than this.
/// [world units]
constexpr double kBeyondPoints = 1e4;

struct Brush {
    LeafContents contents = LeafContents::kSolid;
    std::vector<glm::dvec4> planes;  // as the map has them; sides may lie in others, which are all but the same
    std::vector<uint32_t> sides;
    std::vector<glm::dvec3> corners;
    Box3d box;
};

/// A brush in a region, and the sides of it that the region is not known to be behind.
struct Guest {
    uint32_t brush;
    std::vector<uint32_t> sides;
};

struct Region {
    uint32_t slot;  // node * 2 + side that it hangs from
    LeafContents base;
    BrushFaces faces;
    std::vector<Guest> guests;
    uint32_t divided = BrushPlanes::kNone;  // the plane of sides that it was cut along last
};

/// Which sides of a plane points lie on, but for a tolerance: bit 0 behind, bit 1 in front.
template <class Points>
uint32_t sidesOf(const Points& points, const glm::dvec4& plane, double tolerance) {
    uint32_t sides = 0;
    for (const glm::dvec3& point : points) {
        const double height = heightOf(plane, point);
        if (height < -tolerance) sides |= 1;
        if (height > tolerance) sides |= 2;
    }
    return sides;
}

/// The same of a box; both bits if it cannot tell.
uint32_t sidesOfBox(const Box3d& box, const glm::dvec4& plane, double tolerance) {
    const glm::dvec3 center = box.center(), half = 0.5 * box.size();
    const double height = heightOf(plane, center), reach = glm::dot(glm::abs(glm::dvec3(plane)), half);
    return height > reach + tolerance ? 2 : height < -reach - tolerance ? 1 : 3;
}

class Builder {
public:
    Builder(const QuakeMap& map, const BrushTreeSettings& settings)
        : map_(map), settings_(settings), planes_(std::min(settings.snap_distance, 0.5)) {}

    BrushTree run() {
        gather();
        Region all;
        all.slot = ~0u;
        all.base = LeafContents::kEmpty;
        all.faces = facesOfBox(out_.tree.bounds);
        for (uint32_t i = 0; i < brushes_.size(); ++i) all.guests.push_back({i, brushes_[i].sides});
        regions_.push_back(std::move(all));
        while (!regions_.empty()) {
            Region region = std::move(regions_.back());
            regions_.pop_back();
            grow(region);
        }
        return std::move(out_);
    }

private:
    void gather() {
        std::vector<glm::dvec3> points;
        BrushRoles& roles = out_.roles = brushRoles(map_, settings_.rules);
        for (const QuakeMapEntity& entity : map_.entities) {
            if (!isWorldEntity(map_, entity)) continue;
            for (const QuakeMapBrush& source : map_.brushesOf(entity)) {
                const BrushRole role = roles.roles[static_cast<size_t>(&source - map_.brushes.data())];
                BrushTreeCounts& counts = out_.counts;
                if (role >= BrushRole::kUnknown) {
                    ++counts.nothing;
                    continue;
                }
                ++(role == BrushRole::kSolid ? counts.solid : role == BrushRole::kSky ? counts.sky : counts.liquid);
                Brush brush;
                brush.contents = role == BrushRole::kSolid ? LeafContents::kSolid
                                 : role == BrushRole::kSky ? LeafContents::kSky
                                                           : LeafContents::kLiquid;
                for (const QuakeMapSide& side : map_.sidesOf(source)) {
                    for (const glm::dvec3& point : side.points) all_points_.grow(point);
                    if (const std::optional<glm::dvec4> plane = planeThrough(side.points))
                        brush.planes.push_back(*plane);
                }
                brushes_.push_back(std::move(brush));
            }
        }
        if (all_points_.empty()) all_points_.grow(glm::dvec3(0.0));
        shape();
    }

    static std::vector<glm::dvec3> cornersOf(const std::vector<glm::dvec4>& planes, const Box3d& wide) {
        std::vector<glm::dvec3> corners;
        for (size_t i = 0; i < planes.size(); ++i) {
            std::vector<glm::dvec4> others = planes;
            others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
            for (const glm::dvec3& corner : faceIn(planes[i], wide, others)) corners.push_back(corner);
        }
        return corners;
    }

    /// Numbers the sides of a brush. The corners in a side's plane are those of all faces: of a side that a map has twice,
    /// the face itself is rounding, and the faces beside it are not.
    void findSides(Brush& brush, const Box3d& wide) {
        const std::vector<glm::dvec3> corners = cornersOf(brush.planes, wide);
        std::vector<glm::dvec3> face;
        for (const glm::dvec4& plane : brush.planes) {
            face.clear();
            for (const glm::dvec3& corner : corners)
                if (heightOf(plane, corner) >= -out_.tolerance) face.push_back(corner);
            brush.sides.push_back(planes_.sideOf(plane, face));
        }
        std::sort(brush.sides.begin(), brush.sides.end());
        brush.sides.erase(std::unique(brush.sides.begin(), brush.sides.end()), brush.sides.end());
    }

    /// Sides, corners and boxes; the bounds from them.
    void shape() {
        const Box3d wide{all_points_.min - kBeyondPoints, all_points_.max + kBeyondPoints};
        const glm::dvec3 size = glm::max(glm::abs(wide.min), glm::abs(wide.max));
        const double largest = std::max({size.x, size.y, size.z});
        out_.tolerance = 0x1p-36 * largest;
        // Of the map's extent, gaps close by rounding alone. The squares that corners are cut from reach as far as 7 of
        // `largest`: heights, and how far a corner is off its plane, are off by less than 128 roundings of 2^-53 of it.
        gap_ = 0x1p-36 * kBeyondPoints + 0x1p-46 * largest;
        Box3d held;
        std::vector<Brush> kept;
        for (Brush& brush : brushes_) {
            findSides(brush, wide);
            std::vector<glm::dvec4> planes;
            for (const uint32_t side : brush.sides) planes.push_back(planes_.planeOf(side));
            brush.corners = cornersOf(planes, wide);
            for (const glm::dvec3& corner : brush.corners) brush.box.grow(corner);
            if (!hasVolume(brush, planes)) {
                ++out_.counts.empty;
                continue;
            }
            bool open = false;
            for (int axis = 0; axis < 3; ++axis)
                open |= brush.box.min[axis] < wide.min[axis] || brush.box.max[axis] > wide.max[axis];
            out_.counts.open_ended += open;
            if (!open) held.grow(brush.box);
            kept.push_back(std::move(brush));
        }
        brushes_ = std::move(kept);
        if (held.empty()) held = all_points_;
        out_.tree.bounds = {held.min - settings_.margin, held.max + settings_.margin};
    }

    bool hasVolume(const Brush& brush, const std::vector<glm::dvec4>& planes) const {
        if (brush.corners.size() < 12 || brush.sides.size() < 4) return false;  // four triangles
        for (const glm::dvec4& plane : planes)
            if ((sidesOf(brush.corners, plane, out_.tolerance) & 1) == 0) return false;
        return true;
    }

    void grow(Region& region) {
        settle(region);
        glm::dvec4 plane(0.0);
        uint32_t number = BrushPlanes::kNone;
        if (region.guests.empty() || !choose(region, plane, number)) return hangLeaf(region);
        const uint32_t node = static_cast<uint32_t>(out_.tree.nodes.size());
        out_.tree.nodes.emplace_back();
        out_.tree.nodes[node].plane = plane;
        hang(region.slot, node);
        Region behind, front;
        behind.slot = node << 1;
        front.slot = node << 1 | 1;
        behind.base = front.base = region.base;
        behind.divided = front.divided = number;
        cutFaces(region.faces, plane, out_.tree.bounds, behind.faces, front.faces);
        for (Guest& guest : region.guests) {
            const uint32_t own = sideIn(guest, number);
            uint32_t sides =
                own != BrushPlanes::kNone ? ((own & 1) != 0 ? 2 : 1) : sidesOfBrush(brushes_[guest.brush], plane);
            if ((sides & 1) != 0) behind.guests.push_back(guest);
            if ((sides & 2) != 0) front.guests.push_back(std::move(guest));
        }
        regions_.push_back(std::move(behind));
        regions_.push_back(std::move(front));
    }

    static uint32_t sideIn(const Guest& guest, uint32_t plane) {
        for (const uint32_t side : guest.sides)
            if (side >> 1 == plane) return side;
        return BrushPlanes::kNone;
    }
    uint32_t sidesOfBrush(const Brush& brush, const glm::dvec4& plane) const {
        const uint32_t by_box = sidesOfBox(brush.box, plane, out_.tolerance);
        return by_box != 3 ? by_box : sidesOf(brush.corners, plane, out_.tolerance);
    }

    /// Takes out the guests that hold all of the region, which become its contents, and those that hold none.
    void settle(Region& region) {
        std::vector<glm::dvec3> corners;
        for (const BrushFace& face : region.faces)
            corners.insert(corners.end(), face.outline.begin(), face.outline.end());
        Box3d box;
        for (const glm::dvec3& corner : corners) box.grow(corner);
        std::vector<Guest> kept;
        for (Guest& guest : region.guests) {
            bool apart = false;
            std::vector<uint32_t> sides;
            for (const uint32_t side : guest.sides) {
                const glm::dvec4 plane = planes_.planeOf(side);
                uint32_t where = sidesOfBox(box, plane, gap_);
                if (where == 3) where = sidesOf(corners, plane, gap_);
                // What is left in front of a plane that it was cut along is rounding, and to cut again would not end.
                if (where == 3 && side >> 1 == region.divided) where = 1;
                if (where == 2 || where == 0) apart = true;
                if (apart) break;
                if (where == 3) sides.push_back(side);
            }
            if (apart) continue;
            if (sides.empty()) {
                region.base = std::max(region.base, brushes_[guest.brush].contents);
                continue;
            }
            guest.sides = std::move(sides);
            kept.push_back(std::move(guest));
        }
        region.guests.clear();
        for (Guest& guest : kept)
            if (brushes_[guest.brush].contents > region.base) region.guests.push_back(std::move(guest));
    }

    /// The plane to divide by; false if there is none.
    bool choose(const Region& region, glm::dvec4& plane, uint32_t& number) {
        Box3d box;
        for (const BrushFace& face : region.faces)
            for (const glm::dvec3& corner : face.outline) box.grow(corner);
        if (chooseOfGrid(box, plane)) return true;
        tried_.clear();
        for (const Guest& guest : region.guests)
            for (const uint32_t side : guest.sides) tried_.push_back(side >> 1);
        std::sort(tried_.begin(), tried_.end());
        std::vector<std::pair<uint32_t, uint32_t>> uses;  // each plane once, and how often it is a side
        for (const uint32_t p : tried_) {
            if (uses.empty() || uses.back().first != p) uses.emplace_back(p, 0);
            ++uses.back().second;
        }
        if (uses.empty()) return false;
        if (uses.size() > settings_.candidates) {
            // The planes with the most sides, and some of the others, evenly spread.
            std::stable_sort(uses.begin(), uses.end(),
                             [](const auto& a, const auto& b) { return a.second > b.second; });
            const size_t first = settings_.candidates / 2, rest = settings_.candidates - first;
            for (size_t i = 0; i < rest; ++i) uses[first + i] = uses[first + i * (uses.size() - first) / rest];
            uses.resize(settings_.candidates);
        }
        double best = kInfinity;
        for (const auto& [candidate, sides] : uses) {
            const glm::dvec4& tried = planes_.plane(candidate);
            int64_t behind = 0, front = 0, both = 0;
            for (const Guest& guest : region.guests) {
                const uint32_t own = sideIn(guest, candidate);
                const uint32_t where =
                    own != BrushPlanes::kNone ? ((own & 1) != 0 ? 2 : 1) : sidesOfBrush(brushes_[guest.brush], tried);
                behind += where == 1;
                front += where == 2;
                both += where == 3;
            }
            const bool axial = std::abs(tried.x) == 1 || std::abs(tried.y) == 1 || std::abs(tried.z) == 1;
            // Cells are what counts: few brushes divided, then many sides in one plane. Balance only decides between
            // equals.
            const double cost = 8.0 * static_cast<double>(both) - 2.0 * sides + (axial ? 0 : 10) +
                                1e-3 * static_cast<double>(std::abs(front - behind));
            if (cost >= best) continue;
            best = cost;
            number = candidate;
        }
        plane = planes_.plane(number);
        return true;
    }

    /// Along the grid, across the region's longest extent.
    bool chooseOfGrid(const Box3d& box, glm::dvec4& plane) const {
        const glm::dvec3 all = out_.tree.bounds.size();
        const double block = std::max(settings_.block, std::max({all.x, all.y, all.z}) / 64);
        if (!(settings_.block > 0)) return false;
        int longest = -1;
        double at = 0, length = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double middle = std::round(box.center()[axis] / block) * block;
            const double least = 0.125 * block;
            if (box.size()[axis] <= std::max(block, length) || middle - box.min[axis] < least ||
                box.max[axis] - middle < least)
                continue;
            longest = axis;
            at = middle;
            length = box.size()[axis];
        }
        if (longest < 0) return false;
        plane = glm::dvec4(0.0);
        plane[longest] = 1;
        plane.w = -at;
        return true;
    }

    void hang(uint32_t slot, uint32_t child) {
        if (slot != ~0u) out_.tree.nodes[slot >> 1].child[slot & 1] = child;
    }

    void hangLeaf(const Region& region) {
        const uint32_t leaf = static_cast<uint32_t>(out_.tree.contents.size());
        out_.tree.contents.push_back(region.base);
        hang(region.slot, LeafTreeNode::kLeaf | leaf);
        if (region.base == LeafContents::kSolid) return;
        const Box3d& bounds = out_.tree.bounds;
        for (const BrushFace& face : region.faces)
            for (int axis = 0; axis < 3; ++axis) {
                const double at = face.plane[axis] == 1 ? bounds.max[axis] : bounds.min[axis];
                if (std::abs(face.plane[axis]) != 1 || -face.plane.w * face.plane[axis] != at) continue;
                glm::dvec3 middle(0.0);
                for (const glm::dvec3& corner : face.outline)
                    middle += corner / static_cast<double>(face.outline.size());
                out_.edge_leaves.push_back(leaf);
                out_.edge_points.push_back(middle);
                return;
            }
    }

    const QuakeMap& map_;
    const BrushTreeSettings& settings_;
    BrushPlanes planes_;
    Box3d all_points_;
    double gap_ = 0;  ///< a region that reaches no farther in front of a side counts as behind it  [world units]
    std::vector<Brush> brushes_;
    std::vector<Region> regions_;
    std::vector<uint32_t> tried_;
    BrushTree out_;
};

}  // namespace

BrushTree treeOfBrushes(const QuakeMap& map, const BrushTreeSettings& settings) { return Builder(map, settings).run(); }

}  // namespace sightline::bake
