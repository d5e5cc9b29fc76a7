// A hierarchy that lives: items come, move and go, and its bounds hold all of them at every moment.
// SPDX-License-Identifier: MIT
//
// Antonin Guttman. R-Trees: A Dynamic Index Structure for Spatial Searching. 1984.
// Daniel Kopta, Thiago Ize, Josef Spjut, Erik Brunvand, Al Davis, Andrew Kensler. Fast, Effective BVH Updates for
// Animated Scenes. 2012.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "sightline/base/memory.h"
#include "sightline/base/paged.h"
#include "sightline/space/bvh.h"

namespace sightline {

/// What can be asked of a living hierarchy: its nodes as they are, or as they were when a snapshot was taken.
///
/// A node's slot holds a node, or with BvhNode::kLeaf one item; An unused slot is an inverted
/// box with `child` ~0 and `count` 0; of an item it is 1.
/// Of a node it is the number of items below, as it was at the last update(). `first` means nothing here.
struct LivingBvh {
    static constexpr uint32_t kNone = ~0u;

    glm::dvec3 origin{0.0};  ///< an item's box is inside origin + its slot
    Paged<BvhNode, 32> nodes;
    uint32_t root = kNone;      ///< none: no item has bounds
    Array<uint32_t> unbounded;  ///< items that no bounds hold: always visible, in no order that means anything
    uint32_t count = 0;         ///< items, with the unbounded

    explicit LivingBvh(Memory* memory = defaultMemory()) : nodes(memory), unbounded(memory) {}

    const BvhNode& node(uint32_t index) const { return nodes[index]; }
    /// No bound is farther from the origin on any axis.
    float reach() const;
};

/// How a living hierarchy behaves.
struct DynamicBvhDef {
    glm::dvec3 origin{0.0};            ///< near the middle of the world; it stays. Bounds are float around it
    double margin = 0;                 ///< by which boxes are stored wider, so that small moves change nothing
                                       ///< [world units, >= 0]
    double decay = 1.25;               ///< a subtree that costs more than this times what it did fresh is built anew
    double rebuilt_share = 0.125;      ///< of all items that one update() may build anew  [0 to 1]
    bool rotations = true;             ///< update() exchanges children among neighbouring nodes where that pays
    Memory* memory = defaultMemory();  ///< thread-safe if snapshots are let go by other threads; outlives them
};

/// What update() did.
struct DynamicBvhUpdate {
    uint32_t refitted = 0;   ///< nodes whose bounds were looked at
    uint32_t rotations = 0;  ///< children that changed their node, nodes lifted into their parent or merged
    uint32_t rebuilt = 0;    ///< items below what was built anew
};

/// Items are boxes in world space, named by small numbers that this hands out; the number of a removed item is handed out
/// again. At every moment each slot's box holds all that is below it. After update() it is the smallest such box, and the
/// tree is about as good as a fresh one.
///
/// A box that is NaN, infinite, empty, or farther than kFarthest from the origin is kept apart: LivingBvh::unbounded.
/// Not thread-safe; its snapshots are. The same calls give the same tree on every machine.
class DynamicBvh {
public:
    static constexpr uint32_t kNone = LivingBvh::kNone;
    static constexpr double kFarthest = 1e18;  ///< [world units]: surfaces fit into float

    explicit DynamicBvh(const DynamicBvhDef& def = {});

    /// Throws away what there is and builds over boxes, which get the numbers 0, 1, ...  O(n log n).
    void build(std::span<const Box3d> boxes);
    /// Builds anew over the items that there are, which keep their numbers.  O(n log n).
    void rebuild();

    /// @param displacement  how far it will have moved before it is told to move again  [world units]: the box is stored
    ///                      so long that it holds the whole way
    uint32_t insert(const Box3d& box, const glm::dvec3& displacement = glm::dvec3(0.0));
    /// False if there is no such item. Nothing happens if the box as stored still holds the new one and is not much
    /// larger; with no margin and no displacement it is always stored.  O(depth).
    bool move(uint32_t item, const Box3d& box, const glm::dvec3& displacement = glm::dvec3(0.0));
    /// False if there is no such item.
    bool remove(uint32_t item);

    /// Makes bounds tight along all paths that changed, improves the tree around them, and builds subtrees anew that have
    /// decayed. O(what changed). Call it once a frame; between calls bounds hold, but may be larger than needed.
    DynamicBvhUpdate update();

    /// As it is now; what is asked of it is valid until the next change.
    const LivingBvh& now() const { return state_; }
    /// As it is now, for as long as the pointer is held, whatever happens here; for any thread. Costs 16 bytes for 32 nodes;
    /// after it each page of nodes is copied once that is changed.
    std::shared_ptr<const LivingBvh> snapshot();

    bool contains(uint32_t item) const { return item < slot_.size() && slot_[item] != kFree; }
    uint32_t size() const { return state_.count; }
    /// The box that stands for an item, relative to the origin; empty if it is unbounded. @pre contains(item)
    Box3f storedBox(uint32_t item) const;
    /// Sum over nodes of their surface, relative to the root's, as of the last update().
    double surfaceCost() const;

private:
    static constexpr uint32_t kFree = ~0u;
    static constexpr uint32_t kUnbounded = 1u << 31;  ///< in slot_: the rest is the place in LivingBvh::unbounded

    /// What a node's slot holds.
    struct Entry {
        Box3f box;
        uint32_t child = 0, count = 0;
        bool isNode() const { return !(child & BvhNode::kLeaf); }
    };
    /// What is known of a node besides its slots.
    struct NodeNote {
        uint32_t parent = kNone;   ///< parent * 8 + slot; the root's is kNone
        uint32_t fresh_count = 0;  ///< items below when it was built; 0: not known yet
        float fresh = 0;           ///< cost over surface when it was built
        float cost = 0;            ///< sum of the surfaces of all nodes below and of itself
    };
    enum class Mark : uint8_t {
        kNone,
        kDirty,    ///< it, or a node below, has changed since the last update()
        kChanged,  ///< this update() has looked at it
    };
    struct Rotation;

    // dynamic_bvh.cpp: nodes and items
    uint32_t newNode();
    void freeNode(uint32_t index);
    void markDirty(uint32_t index);
    void put(uint32_t index, int slot, const Entry& entry);
    Entry take(uint32_t index, int slot) const;
    void clear();
    Box3f storable(const Box3d& box, const glm::dvec3& displacement) const;
    void enter(uint32_t item, const Box3f& box);
    void leave(uint32_t item);
    void cutEmpty(uint32_t index);
    void growAbove(uint32_t index, const Box3f& box);

    // dynamic_bvh_insert.cpp: where an item goes
    void reinsert(uint32_t item, const Box3f& box);
    void insertBelow(uint32_t start, const Entry& entry);
    void place(uint32_t index, Entry entry);
    Entry splitOff(uint32_t index, const Entry& entry);

    // dynamic_bvh_update.cpp: keeping the tree good
    void findDirty();
    bool replaceByOnlyChild(uint32_t index);
    void refitNode(uint32_t index);
    void noteCost(uint32_t index);
    uint32_t lift(uint32_t index);
    uint32_t merge(uint32_t index);
    uint32_t rotate(uint32_t index);
    Rotation bestRotation(uint32_t index) const;
    void tryTargets(uint32_t index, int from, int which, const Entry& moved, const Box3f& rest, Rotation& best) const;
    void apply(uint32_t index, const Rotation& rotation);

    // dynamic_bvh_build.cpp: building anew
    bool hasDecayed(uint32_t index) const;
    uint32_t rebuildDecayed();
    uint32_t rebuildBelow(uint32_t index, uint32_t most);
    void collect(uint32_t index, uint32_t most);
    void buildBelow(uint32_t index);

    DynamicBvhDef def_;
    LivingBvh state_;
    Array<NodeNote> notes_;  ///< per node
    Array<Mark> marks_;      ///< per node; above a dirty one all are
    Array<uint32_t> free_nodes_;
    Array<uint32_t> slot_;  ///< per item: node * 8 + slot, or kUnbounded | place, or kFree
    Array<uint32_t> free_items_;
    Array<uint32_t> changed_, decayed_;  ///< scratch of update()
    Array<Entry> entries_;               ///< scratch of building: what is below the node
};

}  // namespace sightline
