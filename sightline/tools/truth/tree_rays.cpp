// Segments through a tree: front to back, until something stops them.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/tree_rays.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"

namespace sightline::tools {
namespace {

constexpr uint32_t kTop = ~0u;
constexpr uint32_t kLeaf = LeafTreeNode::kLeaf;

double heightAt(const double (&plane)[4], const glm::dvec3& point) {
    return plane[0] * point.x + plane[1] * point.y + plane[2] * point.z + plane[3];
}

}  // namespace

TreeRays::TreeRays(const LeafTree& tree, const TreeRaySettings& settings)
    : tree_(tree), contents_stop_(settings.contents_stop), above_(tree.nodes.size(), kTop) {
    for (const LeafContents contents : tree.contents)
        passes_.push_back(contents == LeafContents::kEmpty || contents == LeafContents::kLiquid ||
                          (contents == LeafContents::kSky && settings.sky_is_open));
    nodes_.reserve(tree.nodes.size());
    for (uint32_t i = 0; i < tree.nodes.size(); ++i) {
        const LeafTreeNode& from = tree.nodes[i];
        Node node{};
        for (int k = 0; k < 4; ++k) node.plane[k] = from.plane[k];
        for (uint32_t side = 0; side < 2; ++side) {
            node.child[side] = from.child[side];
            if ((from.child[side] & kLeaf) == 0) above_[from.child[side]] = i << 1 | side;
        }
        nodes_.push_back(node);
    }
}

uint32_t TreeRays::leafAt(const glm::dvec3& point) const {
    uint32_t child = nodes_.empty() ? kLeaf : 0;
    while ((child & kLeaf) == 0) child = nodes_[child].child[heightAt(nodes_[child].plane, point) >= 0];
    return child & ~kLeaf;
}

void TreeRays::follow(const glm::dvec3& a, const glm::dvec3& b, TreeWalk& walk) const {
    walk.stretches.clear();
    walk.stack.clear();
    walk.arrived = false;
    uint32_t child = nodes_.empty() ? kLeaf : 0, place = kTop;
    double from = 0, to = 1;
    for (;;) {
        while ((child & kLeaf) == 0) {
            const Node& node = nodes_[child];
            const double at_a = heightAt(node.plane, a), at_b = heightAt(node.plane, b);
            const double slope = at_b - at_a;
            const uint32_t near = at_a + from * slope >= 0, far = at_a + to * slope >= 0;
            if (near != far) {
                const double cross = std::clamp(-at_a / slope, from, to);
                walk.stack.push_back({node.child[far], child << 1 | far, cross, to});
                to = cross;
            }
            place = child << 1 | near;
            child = node.child[near];
        }
        const uint32_t leaf = child & ~kLeaf;
        if (!passes_[leaf]) return;
        if (contents_stop_ && !walk.stretches.empty() && tree_.contents[leaf] != tree_.contents[walk.stretches[0].leaf])
            return;
        walk.stretches.push_back({leaf, place, from, to});
        if (walk.stack.empty()) break;
        child = walk.stack.back().child;
        place = walk.stack.back().place;
        from = walk.stack.back().from;
        to = walk.stack.back().to;
        walk.stack.pop_back();
    }
    walk.arrived = true;
}

/// The crossing may be off along the segment by the rounding of its height, divided by the plane's slope: then heights over
/// another plane change by that times the other's slope.
bool TreeRays::isInside(uint32_t place, const Step& step) const {
    const SegmentRounding rounding(step.a, step.b);
    const auto roundingOf = [&](const Node& node, double at) {
        return rounding.at(at) + SegmentRounding::kPart * std::abs(node.plane[3]);
    };
    const auto slopeOf = [&](const Node& node) {
        return std::abs(heightAt(node.plane, step.b) - heightAt(node.plane, step.a));
    };
    const Node& crossed = nodes_[step.node];
    const double slope = slopeOf(crossed) - roundingOf(crossed, 1);
    if (!(slope > 0)) return false;
    const double off = roundingOf(crossed, step.at) / slope;
    const glm::dvec3 point = step.a + step.at * (step.b - step.a);
    for (; place != kTop; place = above_[place >> 1]) {
        if (place >> 1 == step.node) continue;
        const Node& node = nodes_[place >> 1];
        const double height = heightAt(node.plane, point);
        const double margin = roundingOf(node, step.at) + off * (slopeOf(node) + roundingOf(node, 1));
        if (((place & 1) != 0 ? height : -height) > margin) continue;
        // The same plane once more is no other plane.
        const glm::dvec4 &here = tree_.nodes[place >> 1].plane, &there = tree_.nodes[step.node].plane;
        if (here != there && here != -there) return false;
    }
    return true;
}

bool TreeRays::stands(const glm::dvec3& a, const glm::dvec3& b, const TreeWalk& walk, size_t i, size_t j) const {
    const double length = glm::distance(a, b);
    const SegmentRounding rounding(a, b);
    for (const size_t end : {i, j}) {
        const TreeStretch& stretch = walk.stretches[end];
        if (!((stretch.to - stretch.from) * length > rounding.at(stretch.to))) return false;
    }
    for (size_t k = i; k < j; ++k) {
        const TreeStretch &before = walk.stretches[k], &after = walk.stretches[k + 1];
        // Where two paths from the top part is the node whose plane was crossed: the lower of them is raised first, for
        // parents come before children.
        uint32_t x = before.place, y = after.place;
        while (x >> 1 != y >> 1) {
            if (x >> 1 > y >> 1) x = above_[x >> 1];
            else y = above_[y >> 1];
            if (x == kTop || y == kTop) return false;
        }
        const Step step{a, b, after.from, x >> 1};
        if (!isInside(before.place, step) || !isInside(after.place, step)) return false;
    }
    return true;
}

namespace {

/// A line of sight as two walks from one point, or as one: the places that it passes, in order.
class Checker {
public:
    Checker(const TreeRays& rays, const BitMatrix& rows, std::span<const uint32_t> row_of_leaf, const AimedHoles& holes,
            double farthest, bool gather)
        : rays_(rays), row_of_leaf_(row_of_leaf), holes_(holes), farthest_(farthest), judge_(rows, gather) {
        diagonal_ = rays.tree().bounds.empty() ? 0 : glm::length(rays.tree().bounds.size());
    }

    void uniform(Random& random) {
        if (left_from_here_ == 0) {
            // A place in the open is dear to find: sixteen segments leave from it.
            for (int tries = 0; tries < 1000; ++tries) {
                start_ = pointInBounds(random);
                if (rays_.passes(rays_.leafAt(start_))) break;
            }
            left_from_here_ = 16;
        }
        --left_from_here_;
        pass(start_, pointInBounds(random));
    }

    void aimed(Random& random) {
        const size_t hole = random.below(holes_.size());
        const glm::dvec3 through = pointInHole(random, holes_.outline(hole));
        glm::dvec3 direction = randomDirection(random);
        if (random.below(2) == 0) {
            // Holes are listed as the tree has them: those with near numbers are often near.
            const size_t other =
                (hole + random.below(128) + holes_.size() - std::min<size_t>(64, holes_.size())) % holes_.size();
            const glm::dvec3 at = pointInHole(random, holes_.outline(other));
            const double distance = glm::distance(at, through);
            if (distance > 0) direction = (at - through) / distance;
        }
        // Both ways from the hole, as far as they go; together they are one segment.
        const glm::dvec3 back = endOf(through, -direction), to = endOf(through, direction);
        rays_.follow(through, back, back_walk_);
        rays_.follow(through, to, walk_);
        if (back_walk_.stretches.empty() || walk_.stretches.empty()) return;
        const glm::dvec3 from = middleOf(back_walk_.stretches.back(), through, back);
        places_.clear();
        extents_.clear();
        const Line behind(through, back), ahead(through, to);
        for (size_t i = back_walk_.stretches.size(); i-- > 0;) {
            const Extent extent = behind.extentOf(back_walk_.stretches[i]);
            addPlace(back_walk_.stretches[i], {-extent.to, -extent.from, extent.rounding});
        }
        for (const TreeStretch& stretch : walk_.stretches) addPlace(stretch, ahead.extentOf(stretch));
        const glm::dvec3 end = middleOf(walk_.stretches.back(), through, to);
        seen_.assign(places_.begin(), places_.end());
        seen_extents_.assign(extents_.begin(), extents_.end());
        bool walked = false;
        judge_.judge(
            seen_, from, end,
            [&](size_t i, size_t j) {
                // Only an alarm needs the walk as a whole. If that finds other places, the segment passes a corner too
                // closely.
                if (!walked) walkWhole(from, to);
                walked = true;
                return places_ == seen_ && rays_.stands(from, to, walk_, stretch_[i], stretch_[j]);
            },
            [&](size_t i, size_t j) { return isNear(seen_extents_[i], seen_extents_[j]); });
    }

    const RowJudge& judge() const { return judge_; }

private:
    /// Where a line is in a place, along the line.  [world units]
    struct Extent {
        double from, to, rounding;
    };
    struct Line {
        Line(const glm::dvec3& a, const glm::dvec3& b) : length(glm::distance(a, b)), rounding(a, b) {}
        Extent extentOf(const TreeStretch& stretch) const {
            return {stretch.from * length, stretch.to * length, rounding.at(stretch.to)};
        }
        double length;
        SegmentRounding rounding;
    };

    bool isNear(const Extent& first, const Extent& second) const {
        return !(farthest_ > 0) || second.from - first.to + 2 * (first.rounding + second.rounding) <= farthest_;
    }

    glm::dvec3 pointInBounds(Random& random) const {
        const Box3d& box = rays_.tree().bounds;
        const double x = random.uniform(), y = random.uniform(), z = random.uniform();
        return box.min + glm::dvec3(x, y, z) * box.size();
    }

    /// Where a ray leaves the bounds.
    glm::dvec3 endOf(const glm::dvec3& from, const glm::dvec3& direction) const {
        const Box3d& box = rays_.tree().bounds;
        double reach = diagonal_;
        for (int axis = 0; axis < 3; ++axis) {
            if (direction[axis] == 0) continue;
            const double to = direction[axis] > 0 ? box.max[axis] : box.min[axis];
            reach = std::min(reach, std::max(0.0, (to - from[axis]) / direction[axis]));
        }
        return from + reach * direction;
    }

    static glm::dvec3 middleOf(const TreeStretch& stretch, const glm::dvec3& a, const glm::dvec3& b) {
        return a + 0.5 * (stretch.from + stretch.to) * (b - a);
    }

    /// Adds where a stretch lies, unless it is too short to tell or goes on where the last one was. True if it was
    /// added.
    bool addPlace(const TreeStretch& stretch, const Extent& extent) {
        if (!(extent.to - extent.from > extent.rounding)) return false;
        const uint32_t row = row_of_leaf_.empty() ? stretch.leaf : row_of_leaf_[stretch.leaf];
        if (!places_.empty() && places_.back() == row) {
            extents_.back().to = extent.to;
            extents_.back().rounding = std::max(extents_.back().rounding, extent.rounding);
            return false;
        }
        places_.push_back(row);
        extents_.push_back(extent);
        return true;
    }

    void walkWhole(const glm::dvec3& a, const glm::dvec3& b) {
        rays_.follow(a, b, walk_);
        places_.clear();
        extents_.clear();
        stretch_.clear();
        const Line line(a, b);
        for (uint32_t i = 0; i < walk_.stretches.size(); ++i)
            if (addPlace(walk_.stretches[i], line.extentOf(walk_.stretches[i]))) stretch_.push_back(i);
    }

    void pass(const glm::dvec3& a, const glm::dvec3& b) {
        walkWhole(a, b);
        if (places_.empty()) return;
        // To the middle of the last stretch: the way back is a segment, too.
        judge_.judge(
            places_, a, middleOf(walk_.stretches.back(), a, b),
            [&](size_t i, size_t j) { return rays_.stands(a, b, walk_, stretch_[i], stretch_[j]); },
            [&](size_t i, size_t j) { return isNear(extents_[i], extents_[j]); });
    }

    const TreeRays& rays_;
    std::span<const uint32_t> row_of_leaf_;
    const AimedHoles& holes_;
    double farthest_;
    RowJudge judge_;
    double diagonal_ = 0;
    glm::dvec3 start_{0.0};
    int left_from_here_ = 0;
    TreeWalk walk_, back_walk_;
    std::vector<uint32_t> places_, seen_, stretch_;
    std::vector<Extent> extents_, seen_extents_;  // of `places_` and `seen_`
};

}  // namespace

RowReport checkLeafRows(const TreeRays& rays, const BitMatrix& rows, std::span<const uint32_t> row_of_leaf,
                        const AimedHoles& holes, const RowCheckSettings& settings, BitMatrix* seen) {
    SIGHTLINE_ASSERT(row_of_leaf.empty() ? rays.tree().contents.size() <= rows.rows()
                                         : row_of_leaf.size() == rays.tree().contents.size());
    constexpr uint32_t kParts = 16;
    std::vector<Checker> parts(kParts, Checker(rays, rows, row_of_leaf, holes, settings.farthest, seen != nullptr));
    runJobs(settings.jobs, kParts, [&](uint32_t part) {
        Random random(mixSeed(settings.seed, part));
        for (uint64_t i = 0; i < (settings.segments + kParts - 1) / kParts; ++i) {
            if (holes.size() > 0 && random.uniform() < settings.aimed) parts[part].aimed(random);
            else parts[part].uniform(random);
        }
    });
    RowReport report;
    BitMatrix missed(rows.rows(), rows.columns());
    for (const Checker& part : parts) part.judge().addTo(report, missed, settings.most_examples, seen);
    return report;
}

}  // namespace sightline::tools
