// The hierarchy of a world whose items come, move and go: items below a node have neighbouring places, some to spare.
// SPDX-License-Identifier: MIT
//
// Jon Louis Bentley, James B. Saxe. Decomposable Searching Problems I: Static-to-Dynamic Transformation. 1980.
// Ingo Wald. On fast Construction of SAH-based Bounding Volume Hierarchies. 2007.
// Ibrahim Kamel, Christos Faloutsos. On Packing R-trees. 1993.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/base/array.h"
#include "sightline/base/assert.h"
#include "sightline/base/paged.h"
#include "sightline/tree/bvh.h"

namespace sightline {

/// A hierarchy over items with places, for reading. In a node's slot, `first` and `count` say which places the items
/// below it have. Some of these places may be empty, because their items have left; `empty` says how many.
struct PlacedBvh {
    static constexpr uint32_t kNone = ~0u;
    static constexpr uint32_t kOrderPage = 1024;

    glm::dvec3 origin{0.0};             ///< an item's box is inside origin + its slot
    Paged<BvhNode, 8> nodes;            ///< the root is nodes[0]; empty if there never was an item
    Paged<uint32_t, kOrderPage> order;  ///< place to item; kNone: the place is empty
    Paged<uint32_t, 256> slot;          ///< per item: node's index * 8 + slot; kNone: it is not here

    explicit PlacedBvh(Memory* memory = defaultMemory()) : nodes(memory), order(memory), slot(memory) {}

    /// The place of an item, or kNone.
    uint32_t placeOf(uint32_t item) const {
        const uint32_t at = item < slot.size() ? slot[item] : kNone;
        SIGHTLINE_DEBUG_ASSERT(at == kNone || at / 8 < nodes.size());
        return at == kNone ? kNone : nodes[at / 8].first[at % 8];
    }
    /// Items that are here.
    uint32_t size() const;
    /// No bound is farther from the origin on any axis.
    float reach() const;
};

/// Items are named by numbers that the caller gives out. Nodes have spare places, which insert() gives to new items.
/// Items that find no spare place nearby come in batches: append(). Each batch gets a tree of its own below the common
/// root, beside the tree that was built. A batch takes in earlier batches that are not much larger, so that there are
/// at most seven, and an item costs O(log² items) over time. The caller may keep items that move often in batches: then
/// the tree that was built stays as it is.
///
/// Boxes are as tight as can be after every call. The same calls give the same tree.
class WorldBvh {
public:
    static constexpr uint32_t kNone = PlacedBvh::kNone;
    struct Places {
        uint32_t first = 0, end = 0;
    };

    explicit WorldBvh(Memory* memory = defaultMemory());

    /// Throws away what there is and builds over items.  O(n log n).
    /// @param boxes  of the items, world space, finite and not empty
    void build(std::span<const Box3d> boxes, std::span<const uint32_t> items);

    /// The trees that an item may go to.
    enum class Among : uint8_t { kAll, kBatches };

    /// Puts an item where the bounds grow least, if there is a place to spare on the way there.  O(depth).
    /// @returns its place, or kNone: then it is not here
    /// @pre it is not here
    uint32_t insert(uint32_t item, const Box3d& box, Among among = Among::kAll);

    /// Adds items as a batch. Places from the one returned on are given anew.
    uint32_t append(std::span<const Box3d> boxes, std::span<const uint32_t> items);

    /// True if an item is in a batch, and false if it is in the tree that was built.
    /// @pre it is here
    bool isInBatch(uint32_t item) const {
        SIGHTLINE_DEBUG_ASSERT(contains(item));
        return trees_.size() > 1 && now_.nodes[slotOf(item) / 8].first[slotOf(item) % 8] >= trees_[1].first;
    }
    /// Items in batches.
    uint32_t inBatches() const;

    /// Gives items new boxes, wherever these are, and builds all batches anew as one. Places from the one returned on are
    /// given anew.  O(b log b) for b items in batches.
    /// @pre they are in batches
    uint32_t renewBatches(std::span<const Box3d> boxes, std::span<const uint32_t> items);

    /// Gives an item a new box. False, and nothing has changed, if it has strayed so far from its neighbours that the
    /// caller should remove it and insert it again.  O(depth).
    /// @pre it is here
    bool move(uint32_t item, const Box3d& box);

    /// @returns the place that it leaves empty
    /// @pre it is here
    uint32_t remove(uint32_t item);

    /// A node's number * 8 + the slot that the item is in, or kNone.
    uint32_t slotOf(uint32_t item) const { return item < now_.slot.size() ? now_.slot[item] : kNone; }
    bool contains(uint32_t item) const { return slotOf(item) != kNone; }
    uint32_t size() const { return living_; }
    /// Builds subtrees anew whose bounds have grown far larger than they were when they were built, small subtrees
    /// first.
    /// @param most  places that may be given anew; one subtree in any case
    /// @returns ranges of places that are given anew; good until the next call
    std::span<const Places> mend(uint32_t most);

    /// True if building the whole tree anew pays: too many items came since it was built, too many places are empty, or
    /// an item is so far away that floats are coarse there.
    /// @param coming  items that are about to be appended
    bool isWorn(uint32_t coming = 0) const;

    const PlacedBvh& now() const { return now_; }
    /// As it is now. O(nodes / 8 + items / 256).
    PlacedBvh share();

private:
    static constexpr uint32_t kTrees = 8;  ///< the first is the one that was built

    /// A tree of its own: its places begin where those of the tree before it end.
    struct Tree {
        uint32_t first = 0;
    };

    void clear();
    uint32_t newNode();
    void freeNode(uint32_t index);
    void hang(uint32_t parent, uint32_t child);
    void openRoot();
    /// By surface area, or along a curve: see BvhSplitter.
    enum class Growth : uint8_t { kGood, kQuick };
    void growTree(uint32_t root, uint32_t parent, uint32_t first, uint32_t spare, Growth growth);
    void takeInLast();
    uint32_t hangTree(Growth growth);
    void setSlotOf(uint32_t item, uint32_t slot);
    void countEmpty(uint32_t index, uint32_t more);
    void noteDecay(uint32_t index, uint32_t places, const Box3f& box);
    void rebuildBelow(uint32_t index);
    void gather(uint32_t child, const Box3f& box);
    void tightenAbove(uint32_t index);
    uint32_t placesOf(size_t tree) const;

    Memory* const memory_;
    PlacedBvh now_;
    Array<uint32_t> parent_;  ///< per node: parent's index * 8 + slot; the root's is kNone
    Array<float> fresh_;      ///< per node: half its surface when it was built
    Array<uint8_t> marked_;   ///< per node: it is in decayed_
    Array<uint32_t> decayed_;
    Array<Places> given_anew_;  ///< by mend()
    Array<uint32_t> free_nodes_;
    uint32_t living_ = 0;
    float reach_ = 0;        ///< of the items when the tree was built: the farthest from the origin
    float farthest_ = 0;     ///< of any since then
    Array<Tree> trees_;      ///< if there is more than one, each hangs in the root's slot of its number
    Array<uint32_t> items_;  ///< scratch: what a tree is to be built over
    Array<Box3f> boxes_;
    Array<uint32_t> sorted_;
};

}  // namespace sightline
