// A hierarchy that lives: where an item goes, and how a full node is split.
// SPDX-License-Identifier: MIT
//
// Antonin Guttman. R-Trees: A Dynamic Index Structure for Spatial Searching. 1984.
// Norbert Beckmann, Hans-Peter Kriegel, Ralf Schneider, Bernhard Seeger. The R*-tree. 1990.
#include <algorithm>
#include <limits>

#include "sightline/space/bvh_node.h"
#include "sightline/space/dynamic_bvh.h"

namespace sightline {
namespace {

/// The child node whose surface grows least by a box, and what else decides whether the box goes there.
struct BestChild {
    int slot = -1;  ///< none: all children are items
    float growth = std::numeric_limits<float>::infinity();
    float area = 0;
    int free_slot = -1;  ///< the first; none: the node is full
    int items = 0, nodes = 0;
};

BestChild findBestChild(const BvhNode& node, const Box3f& box) {
    // Apart from what decides, so that the compiler makes eight at once of it.
    float before[8], growth[8];
    for (int slot = 0; slot < 8; ++slot) {
        float size[3], grown[3];
        for (int axis = 0; axis < 3; ++axis) {
            const float low = node.min[axis][slot], high = node.max[axis][slot];
            size[axis] = high - low;
            grown[axis] = (high > box.max[axis] ? high : box.max[axis]) - (low < box.min[axis] ? low : box.min[axis]);
        }
        before[slot] = size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
        growth[slot] = grown[0] * grown[1] + grown[1] * grown[2] + grown[2] * grown[0] - before[slot];
    }
    BestChild best;
    for (int slot = 0; slot < 8; ++slot) {
        if (node.count[slot] == 0) {
            if (best.free_slot < 0) best.free_slot = slot;
        } else if (node.child[slot] & BvhNode::kLeaf) {
            ++best.items;
        } else {
            ++best.nodes;
            if (growth[slot] < best.growth || (growth[slot] == best.growth && before[slot] < best.area)) {
                best.growth = growth[slot];
                best.area = before[slot];
                best.slot = slot;
            }
        }
    }
    return best;
}

}  // namespace

/// Moves an item that has left its node's bounds: into the smallest node above that holds it, and down from there.
void DynamicBvh::reinsert(uint32_t item, const Box3f& box) {
    const uint32_t place = slot_[item], left = place / 8;
    clearSlot(state_.nodes.change(left), static_cast<int>(place % 8));
    markDirty(left);
    uint32_t above = left;
    for (uint32_t up = notes_[above].parent; up != kNone; up = notes_[above].parent) {
        above = up / 8;
        const uint32_t outer = notes_[above].parent;
        if (outer == kNone || holds(slotBox(state_.node(outer / 8), static_cast<int>(outer % 8)), box)) break;
    }
    insertBelow(above, {box, BvhNode::kLeaf | item, 1});
    cutEmpty(left);
}

/// @param start  a node whose bounds hold the entry, or the root
void DynamicBvh::insertBelow(uint32_t start, const Entry& entry) {
    uint32_t index = start;
    for (;;) {
        const BvhNode& node = state_.node(index);
        const BestChild best = findBestChild(node, entry.box);
        // Among items, in a node with room, it is as good as below: it costs no node.
        if (best.slot < 0 || (best.growth > 0.0f && best.free_slot >= 0 && best.items >= best.nodes)) break;
        const Box3f old = slotBox(node, best.slot);
        if (!holds(old, entry.box)) {
            Box3f grown = old;
            grown.grow(entry.box);
            setSlot(state_.nodes.change(index), best.slot, grown);
        }
        index = state_.node(index).child[best.slot];
    }
    place(index, entry);
}

/// Puts an entry into a node, which is split if it is full; so are those above, up to a new root.
void DynamicBvh::place(uint32_t index, Entry entry) {
    for (;;) {
        const BvhNode& node = state_.node(index);
        for (int slot = 0; slot < 8; ++slot) {
            if (node.count[slot] != 0) continue;
            put(index, slot, entry);
            markDirty(index);
            return;
        }
        markDirty(index);
        const Entry other = splitOff(index, entry);
        const uint32_t parent = notes_[index].parent;
        if (parent == kNone) {
            const uint32_t root = newNode();
            marks_[root] = Mark::kDirty;
            state_.root = root;
            put(root, 0, {boundsOf(state_.node(index)), index, 8});
            put(root, 1, other);
            return;
        }
        setSlot(state_.nodes.change(parent / 8), static_cast<int>(parent % 8), boundsOf(state_.node(index)));
        index = parent / 8;
        entry = other;
    }
}

/// Splits the eight children of a node and one more in two, along the axis and at the place of least surface.
/// @returns the new node, which is in no other yet
DynamicBvh::Entry DynamicBvh::splitOff(uint32_t index, const Entry& entry) {
    constexpr int kCount = 9, kFewest = 3;
    Entry entries[kCount];
    for (int slot = 0; slot < 8; ++slot) entries[slot] = take(index, slot);
    entries[8] = entry;
    int order[kCount], best_order[kCount], best_left = kFewest;
    float best_cost = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const auto center = [&](int i) { return entries[i].box.min[axis] + entries[i].box.max[axis]; };
        for (int i = 0; i < kCount; ++i) order[i] = i;
        std::sort(order, order + kCount,
                  [&](int a, int b) { return center(a) != center(b) ? center(a) < center(b) : a < b; });
        float right[kCount + 1];
        Box3f box;
        for (int i = kCount - 1; i >= kFewest; --i) {
            box.grow(entries[order[i]].box);
            right[i] = halfArea(box);
        }
        box = Box3f();
        for (int i = 0; i < kCount - kFewest; ++i) {
            box.grow(entries[order[i]].box);
            const int left = i + 1;
            if (left < kFewest || !(halfArea(box) + right[left] < best_cost)) continue;
            best_cost = halfArea(box) + right[left];
            best_left = left;
            std::copy(order, order + kCount, best_order);
        }
    }
    const uint32_t other = newNode();
    marks_[other] = Mark::kDirty;  // as those above it will be, for this node is
    state_.nodes.change(index) = emptyNode();
    for (int i = 0; i < kCount; ++i)
        put(i < best_left ? index : other, i < best_left ? i : i - best_left, entries[best_order[i]]);
    return {boundsOf(state_.node(other)), other, static_cast<uint32_t>(kCount - best_left)};
}

}  // namespace sightline
