// A scene's own hierarchy: nodes that hang in one another, each placed in its parent, with tight bounds of what is below.
// SPDX-License-Identifier: MIT
//
// James Clark. Hierarchical Geometric Models for Visible Surface Algorithms. 1976.
// Ulf Assarsson, Tomas Moller. Optimized View Frustum Culling Algorithms for Bounding Boxes. 2000.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "sightline/base/array.h"
#include "sightline/cull/hierarchy.h"
#include "sightline/math/box.h"
#include "sightline/tree/bvh.h"

namespace sightline::studies {

/// A node of a scene, as it is handed in.
struct SceneTreeNode {
    static constexpr uint32_t kNone = ~0u;
    uint32_t parent = kNone;  ///< [limit: < its own number]; none: it hangs in the world
    glm::dmat4 local{1.0};    ///< to the parent's space
};

/// Something that is drawn in a node.
struct SceneTreeItem {
    uint32_t node = 0;
    Box3d box;  ///< in the node's space
};

/// What can be asked of a scene's bounds.
///
/// A branch is a node with two children or more, of those below which there are items; nodes with one child or one item
/// are left out, so that chains cost nothing. Its children stand in blocks of eight slots: a branch, or with
/// BvhNode::kLeaf an item. An unused slot is an inverted box with `child` ~0; `first` and `count` tell the items below.
struct NodeTreeBounds {
    struct Branch {
        uint32_t first_block = 0, block_count = 0;
    };
    glm::dvec3 origin{0.0};  ///< an item's box is inside origin + its slot
    Array<BvhNode> blocks;
    Array<Branch> branches;  ///< the first is the root; empty if there are no items
    Array<uint32_t> order;   ///< items, those below each branch in a row
    float reach = 0;         ///< no finite bound is farther from the origin on any axis

    explicit NodeTreeBounds(Memory* memory = defaultMemory()) : blocks(memory), branches(memory), order(memory) {}
};

/// What NodeTree::update() did.
struct NodeTreeUpdate {
    uint32_t nodes = 0;     ///< that got a new world transform
    uint32_t items = 0;     ///< whose boxes were made anew
    uint32_t branches = 0;  ///< whose bounds were looked at
};

/// Nodes and items are fixed when it is built; transforms and boxes change. An item's box in the world is the smallest
/// along the axes that holds its own box; a branch's is the smallest that holds its children's.
///
/// A box that is empty, or that becomes NaN, infinite or farther than kFarthest from the origin, is held to be without end, as
/// are all bounds above it: what is below is asked one by one, and it is always kept. Not thread-safe.
class NodeTree {
public:
    static constexpr double kFarthest = 1e18;  ///< [world units]

    /// @param origin  near the middle of the world: bounds are float around it
    explicit NodeTree(const glm::dvec3& origin = glm::dvec3(0.0), Memory* memory = defaultMemory());

    /// Throws away what there is. O(nodes + items).
    void build(std::span<const SceneTreeNode> nodes, std::span<const SceneTreeItem> items);

    /// Places a node anew in its parent, with all that hangs in it. Nothing else changes until update(). O(1).
    void setTransform(uint32_t node, const glm::dmat4& local);
    /// Gives an item another box. Nothing else changes until update(). O(1).
    void setBox(uint32_t item, const Box3d& box);
    /// Mends world transforms and bounds. O(n log n) in the nodes and items below those that were placed anew and in the
    /// bounds above them that change; a branch among these costs O(its children).
    NodeTreeUpdate update();

    uint32_t nodes() const { return static_cast<uint32_t>(nodes_.size()); }
    uint32_t items() const { return static_cast<uint32_t>(items_.size()); }
    /// To the world, as of the last update(): the product of all above it, from the top down.
    const glm::dmat4& world(uint32_t node) const { return world_[node]; }
    /// As of the last update(); what is asked of it is valid until the next one.
    const NodeTreeBounds& now() const { return bounds_; }
    /// The box that stands for an item, relative to the origin; infinite on all sides if it is without end.
    Box3f storedBox(uint32_t item) const;

private:
    /// What stands in a slot: an item with BvhNode::kLeaf, or a node that is a branch.
    struct Entry {
        uint32_t what = SceneTreeNode::kNone;
        uint32_t count = 0;  ///< items below
    };
    /// What hangs in a node: runs of child_nodes_ and of own_items_.
    struct Runs {
        uint32_t first_child = 0, end_child = 0, first_item = 0, end_item = 0;
    };
    struct BranchNote {
        uint32_t slot = SceneTreeNode::kNone;  ///< that holds it; the root's is none
        float reach = 0;                       ///< of finite bounds below
        bool touched = false;
    };

    void hang();
    void layOut();
    void layOutBranch(uint32_t branch, std::span<const Entry> entries, uint32_t first);
    void gather(const Runs& runs, Array<Entry>& out) const;
    void place(uint32_t node);
    void refresh(uint32_t item);
    void touch(uint32_t branch);
    void mendBranches(NodeTreeUpdate& done);
    bool mend(uint32_t branch);

    Memory* const memory_;
    NodeTreeBounds bounds_;
    Array<SceneTreeNode> nodes_;
    Array<SceneTreeItem> items_;
    Array<glm::dmat4> world_;
    Array<Runs> runs_;             ///< per node, and one more for the world
    Array<uint32_t> child_nodes_;  ///< of each node in a row
    Array<uint32_t> own_items_;    ///< of each node in a row
    Array<Entry> stands_;          ///< per node: what its parent's slot holds for it; count 0: nothing is below
    Array<uint32_t> branch_of_;    ///< per block
    Array<BranchNote> notes_;      ///< per branch
    Array<uint32_t> slot_;         ///< per item: block * 8 + slot
    Array<uint8_t> marked_;        ///< per node: it is in dirty_nodes_
    Array<uint32_t> dirty_nodes_, dirty_items_;
    Array<uint32_t> stamp_;  ///< per node: the last update() that placed it
    uint32_t updates_ = 0;
    Array<uint32_t> stack_;
    Array<uint32_t> touched_;  ///< branches; a heap, the last first
};

/// Writes the numbers of the items whose stored boxes may touch the frustum, and of all that are without end, and returns
/// how many. The order hangs on the tree alone. The set is that of cullFrustum() over the stored boxes, to the bit.
/// @param kept   [size: >= tree.order.size() + 8]
/// @param stats  HierarchyStats::nodes counts blocks of eight children
size_t cullNodeTree(const Frustum& frustum, const NodeTreeBounds& tree, HierarchyScratch& scratch,
                    std::span<uint32_t> kept, HierarchyStats* stats = nullptr);

}  // namespace sightline::studies
