// Portals of a tree: each node's section is pushed down both sides, cut by planes that are moved outward by more than all rounding.
// SPDX-License-Identifier: MIT
//
// Why a portal holds its face. Let T be the face, exactly, after some cuts, B(r) a disc, Q the outline computed: then Q holds
// T + B(s). At first s is without limit, for the square holds all of the plane that lies in the bounds. A cut T' = T and
// {h >= 0} is computed at h >= -m. T' + B(s) lies in Q and in {h >= -s}, so if s <= m - e, where e bounds the rounding of
// h, in Q as it would be cut exactly where the computed corners lie on their edges. Each corner is then rounded by at most u: Q'
// holds T' + B(s - u). After k cuts: s = m - e - k u. With M the largest coordinate, u < 2^-49 M, e < 2^-47 M + k u (the second term for
// corners that are that far off the plane), m half the tolerance, and that at least (k + 2) 2^-46 M: s > tolerance / 4.
#include "sightline/bsp/tree_portals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "sightline/base/assert.h"
#include "sightline/math/half_spaces.h"

namespace sightline {
namespace {

constexpr uint32_t kNoBounds = ~0u;

double heightOf(const glm::dvec4& plane, const glm::dvec3& point) {
    return glm::dot(glm::dvec3(plane), point) + plane.w;
}

/// A half-space that bounds what is being pushed, its plane turned inward, and the one before it.
struct Bound {
    glm::dvec4 inside;
    double length;  // of the normal
    uint32_t before;
};

/// What is left of a section somewhere in the tree: an outline, and the bounds that it may touch.
struct Piece {
    uint32_t child;  // a node or a leaf, as in LeafTreeNode
    uint32_t first, count;
    uint32_t bounds;
};

class Portalizer {
public:
    Portalizer(const LeafTree& tree, const TreePortalSettings& settings)
        : tree_(tree), settings_(settings), parent_(tree.nodes.size(), kNoBounds) {}

    CellGraph run(TreePortalCounts& counts, std::vector<uint32_t>& node_of_portal) {
        numberCells();
        measure();
        for (uint32_t node = 0; node < tree_.nodes.size(); ++node) joinSides(node);
        counts = counts_;
        node_of_portal = std::move(node_of_portal_);
        return std::move(graph_);
    }

private:
    bool passes(uint32_t leaf) const {
        const LeafContents contents = tree_.contents[leaf];
        return contents == LeafContents::kSky ? settings_.sky_is_open : contents != LeafContents::kSolid;
    }

    void numberCells() {
        graph_.cell_of_leaf.assign(tree_.contents.size(), CellGraph::kNoCell);
        std::vector<bool> hangs(tree_.contents.size(), tree_.nodes.empty());
        for (const LeafTreeNode& node : tree_.nodes)
            for (const uint32_t child : node.child)
                if ((child & LeafTreeNode::kLeaf) != 0) hangs[child & ~LeafTreeNode::kLeaf] = true;
        for (uint32_t leaf = 0; leaf < tree_.contents.size(); ++leaf)
            if (hangs[leaf] && passes(leaf)) graph_.cell_of_leaf[leaf] = graph_.cells++;
        open_.assign(tree_.nodes.size(), false);
        for (uint32_t node = static_cast<uint32_t>(tree_.nodes.size()); node-- > 0;)
            for (uint32_t side = 0; side < 2; ++side) {
                const uint32_t child = tree_.nodes[node].child[side];
                if (isOpen(child)) open_[node] = true;
                if ((child & LeafTreeNode::kLeaf) == 0) parent_[child] = node << 1 | side;
            }
    }

    bool isOpen(uint32_t child) const {
        return (child & LeafTreeNode::kLeaf) != 0 ? passes(child & ~LeafTreeNode::kLeaf) : open_[child];
    }

    /// Depth, lengths of normals, and from these the tolerance.
    void measure() {
        std::vector<uint32_t> depth(tree_.nodes.size(), 1);
        uint32_t deepest = 1;
        length_.resize(tree_.nodes.size());
        for (uint32_t node = 0; node < tree_.nodes.size(); ++node) {
            length_[node] = glm::length(glm::dvec3(tree_.nodes[node].plane));
            if (parent_[node] != kNoBounds) depth[node] = depth[parent_[node] >> 1] + 1;
            deepest = std::max(deepest, depth[node]);
        }
        diagonal_ = tree_.bounds.empty() ? 0 : glm::length(tree_.bounds.size());
        const glm::dvec3 far = glm::max(glm::abs(tree_.bounds.min), glm::abs(tree_.bounds.max));
        const double largest = std::max({far.x, far.y, far.z}) + 2 * diagonal_;
        counts_.tolerance = largest * std::max(0x1p-38, (2.0 * deepest + 16) * 0x1p-46);
        margin_ = counts_.tolerance / 2;
    }

    /// All portals that lie in a node's plane.
    void joinSides(uint32_t node) {
        const LeafTreeNode& here = tree_.nodes[node];
        if (!isOpen(here.child[0]) || !isOpen(here.child[1]) || !(length_[node] > 0)) return;
        plane_ = here.plane;
        bounds_.clear();
        points_.clear();
        Piece section;
        if (!sectionOf(node, section)) return;
        section.child = here.child[1];
        front_.clear();
        pushDown(section, 1, [&](const Piece& piece) { front_.push_back(piece); });
        for (const Piece& piece : front_) {
            Piece other = piece;
            other.child = here.child[0];
            const uint32_t leaf = piece.child & ~LeafTreeNode::kLeaf;
            pushDown(other, 0,
                     [&](const Piece& both) { addPortal(node, leaf, both.child & ~LeafTreeNode::kLeaf, both); });
        }
    }

    /// A node's plane within the bounds of the tree and the planes above. False: nothing of it is there.
    bool sectionOf(uint32_t node, Piece& section) {
        const Box3d& box = tree_.bounds;
        const glm::dvec3 n = glm::dvec3(plane_) / length_[node];
        const double height = heightOf(plane_, box.center()) / length_[node];
        if (box.empty() || !(std::abs(height) <= diagonal_)) return false;
        const glm::dvec3 middle = box.center() - n * height;
        const glm::dvec3 size = glm::abs(n);
        glm::dvec3 helper(0.0);
        helper[size.x < size.y ? (size.x < size.z ? 0 : 2) : (size.y < size.z ? 1 : 2)] = 1;
        const glm::dvec3 u = 0.6 * diagonal_ * glm::normalize(glm::cross(helper, n));
        const glm::dvec3 v = glm::cross(n, u);
        outline_ = {middle - u - v, middle + u - v, middle + u + v, middle - u + v};
        uint32_t bounds = kNoBounds;
        for (int axis = 0; axis < 3; ++axis)
            for (const double side : {1.0, -1.0}) {
                glm::dvec4 inside(0.0);
                inside[axis] = side;
                inside.w = side > 0 ? -box.min[axis] : box.max[axis];
                if (!cutBy(inside, 1, bounds)) return false;
            }
        for (uint32_t slot = parent_[node]; slot != kNoBounds; slot = parent_[slot >> 1]) {
            const glm::dvec4& plane = tree_.nodes[slot >> 1].plane;
            if (!(length_[slot >> 1] > 0)) {
                if ((plane.w >= 0) != ((slot & 1) != 0)) return false;
                continue;
            }
            if (!cutBy((slot & 1) != 0 ? plane : -plane, length_[slot >> 1], bounds)) return false;
        }
        section = stored(outline_, 0, bounds);
        return true;
    }

    Piece stored(const std::vector<glm::dvec3>& outline, uint32_t child, uint32_t bounds) {
        const Piece piece{child, static_cast<uint32_t>(points_.size()), static_cast<uint32_t>(outline.size()), bounds};
        points_.insert(points_.end(), outline.begin(), outline.end());
        return piece;
    }

    /// Cuts outline_ by a half-space moved outward by the margin, and lists it among the bounds if it may touch what is
    /// left. False: nothing is left, or exactly nothing.
    bool cutBy(const glm::dvec4& inside, double length, uint32_t& bounds) {
        const double margin = margin_ * length;
        heights_.clear();
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const glm::dvec3& point : outline_) {
            heights_.push_back(heightOf(inside, point) + margin);
            low = std::min(low, heights_.back());
            high = std::max(high, heights_.back());
        }
        if (!(high >= 0)) return false;
        if (low < 0) {
            cut_.clear();
            for (size_t i = 0; i < outline_.size(); ++i) {
                const size_t next = i + 1 < outline_.size() ? i + 1 : 0;
                const double here = heights_[i], there = heights_[next];
                if (here >= 0) cut_.push_back(outline_[i]);
                if ((here < 0) != (there < 0))
                    cut_.push_back(outline_[i] + here / (here - there) * (outline_[next] - outline_[i]));
            }
            outline_.swap(cut_);
            if (outline_.size() < 3) return false;
        }
        if (low <= 4 * margin) {
            bounds_.push_back({inside, length, bounds});
            bounds = static_cast<uint32_t>(bounds_.size() - 1);
        }
        // A strip as thin as the margin is often nothing: a face that only touches the plane.
        if (high <= 8 * margin && isNothing(bounds)) {
            ++counts_.touching;
            return false;
        }
        return true;
    }

    /// Whether the bounds leave exactly nothing of outline_: only those matter that it touches.
    bool isNothing(uint32_t bounds) {
        near_.clear();
        for (uint32_t i = bounds; i != kNoBounds; i = bounds_[i].before) {
            double low = std::numeric_limits<double>::infinity();
            for (const glm::dvec3& point : outline_) low = std::min(low, heightOf(bounds_[i].inside, point));
            if (low <= 2 * margin_ * bounds_[i].length) near_.push_back(bounds_[i].inside);
        }
        was_certain_ = near_.size() <= kMostBounds;
        return was_certain_ && !openInPlane(plane_, near_);
    }

    /// On which side of a node what lies just beside the plane is, all of it: the node has no normal, or its plane is the
    /// same. kNoBounds: the node divides.
    uint32_t onlySide(uint32_t node, uint32_t from_side) const {
        const glm::dvec4& plane = tree_.nodes[node].plane;
        if (!(length_[node] > 0)) return plane.w >= 0;
        const double along = glm::dot(glm::dvec3(plane), glm::dvec3(plane_));
        if (std::abs(along) < 0.999 * length_[node] * glm::length(glm::dvec3(plane_)) || !samePlane(plane, plane_))
            return kNoBounds;
        return (along > 0) == (from_side == 1);
    }

    /// Hands a piece down from piece.child on, which lies on one side of the plane; `arrive` gets what reaches leaves that
    /// can be passed.
    template <class Arrive>
    void pushDown(const Piece& piece, uint32_t from_side, Arrive&& arrive) {
        const size_t bottom = stack_.size();
        stack_.push_back(piece);
        while (stack_.size() > bottom) {
            Piece at = stack_.back();
            stack_.pop_back();
            if ((at.child & LeafTreeNode::kLeaf) != 0) {
                arrive(at);
                continue;
            }
            const LeafTreeNode& node = tree_.nodes[at.child];
            const uint32_t only = onlySide(at.child, from_side);
            for (uint32_t side = 0; side < 2; ++side) {
                if (!isOpen(node.child[side]) || side == (only ^ 1u)) continue;
                if (side == only) {
                    stack_.push_back({node.child[side], at.first, at.count, at.bounds});
                    continue;
                }
                outline_.assign(points_.begin() + at.first, points_.begin() + at.first + at.count);
                uint32_t bounds = at.bounds;
                if (cutBy(side == 1 ? node.plane : -node.plane, length_[at.child], bounds))
                    stack_.push_back(stored(outline_, node.child[side], bounds));
            }
        }
    }

    void addPortal(uint32_t node, uint32_t front_leaf, uint32_t back_leaf, const Piece& piece) {
        if (settings_.contents_stop && tree_.contents[front_leaf] != tree_.contents[back_leaf]) return;
        if (front_leaf == back_leaf) {
            ++counts_.same_leaf;
            return;
        }
        outline_.assign(points_.begin() + piece.first, points_.begin() + piece.first + piece.count);
        glm::dvec3 middle(0.0);
        for (const glm::dvec3& point : outline_) middle += point / static_cast<double>(outline_.size());
        bool wide = true;
        for (uint32_t i = piece.bounds; i != kNoBounds && wide; i = bounds_[i].before)
            wide = heightOf(bounds_[i].inside, middle) > margin_ * bounds_[i].length;
        if (!wide) {
            if (isNothing(piece.bounds)) {
                ++counts_.touching;
                return;
            }
            ++(was_certain_ ? counts_.slivers : counts_.doubtful);
        }
        dropDoubles();
        graph_.addPortal(graph_.cell_of_leaf[front_leaf], graph_.cell_of_leaf[back_leaf], outline_,
                         plane_ / length_[node]);
        node_of_portal_.push_back(node);
    }

    /// Corners that are one but for rounding: the outline shrinks by less than the room that it has.
    void dropDoubles() {
        const double least = counts_.tolerance / 16;
        cut_.clear();
        for (const glm::dvec3& point : outline_)
            if (cut_.empty() || glm::distance(cut_.back(), point) > least) cut_.push_back(point);
        while (cut_.size() > 1 && glm::distance(cut_.back(), cut_.front()) <= least) cut_.pop_back();
        outline_.swap(cut_);
    }

    static constexpr size_t kMostBounds = 40;  ///< that are asked at once what they leave

    const LeafTree& tree_;
    const TreePortalSettings& settings_;
    CellGraph graph_;
    TreePortalCounts counts_;
    std::vector<uint32_t> node_of_portal_;
    std::vector<uint32_t> parent_;  // per node: parent << 1 | side
    std::vector<bool> open_;        // per node: some leaf below can be passed
    std::vector<double> length_;    // per node: of the normal
    double diagonal_ = 0, margin_ = 0;

    // Of one node:
    glm::dvec4 plane_{0.0};
    std::vector<Bound> bounds_;
    std::vector<glm::dvec3> points_;
    std::vector<Piece> front_, stack_;
    // Of one cut:
    std::vector<glm::dvec3> outline_, cut_;
    std::vector<double> heights_;
    std::vector<glm::dvec4> near_;
    bool was_certain_ = true;
};

}  // namespace

CellGraph cellsOfTree(const LeafTree& tree, const TreePortalSettings& settings, TreePortalCounts* counts,
                      std::vector<uint32_t>* node_of_portal) {
    SIGHTLINE_ASSERT(tree.bounds.empty() || tree.bounds.finite());
    TreePortalCounts found;
    std::vector<uint32_t> nodes;
    CellGraph graph = Portalizer(tree, settings).run(found, nodes);
    if (counts) *counts = found;
    if (node_of_portal) *node_of_portal = std::move(nodes);
    return graph;
}

}  // namespace sightline
