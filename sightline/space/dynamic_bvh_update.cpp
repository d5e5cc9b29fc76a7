// A hierarchy that lives: bounds made tight along the paths that changed, and children moved to better places.
// SPDX-License-Identifier: MIT
//
// Andrew Kensler. Tree Rotations for Improving Bounding Volume Hierarchies. 2008.
// Daniel Kopta, Thiago Ize, Josef Spjut, Erik Brunvand, Al Davis, Andrew Kensler. Fast, Effective BVH Updates for
// Animated Scenes. 2012.
#include <algorithm>

#include "sightline/space/bvh_node.h"
#include "sightline/space/dynamic_bvh.h"

namespace sightline {
namespace {

/// A rotation must gain this share of the surface of the node that it takes from; less is not worth the writing.
constexpr float kWorthRotating = 0.1f;
/// Two nodes become one unless its surface is larger than theirs together by this factor.
constexpr float kWorthMerging = 1.3f;
constexpr int kMostRotations = 3;  // of one node and update

int usedSlots(const BvhNode& node) {
    int used = 0;
    for (uint32_t count : node.count) used += count != 0;
    return used;
}

int freeSlot(const BvhNode& node) {
    for (int slot = 0; slot < 8; ++slot)
        if (node.count[slot] == 0) return slot;
    return -1;
}

bool isNode(const BvhNode& node, int slot) { return node.count[slot] != 0 && !(node.child[slot] & BvhNode::kLeaf); }

float grownArea(const Box3f& a, const Box3f& b) {
    Box3f box = a;
    box.grow(b);
    return halfArea(box);
}

/// Per slot: the box around all the others.
void boundsWithoutEach(const BvhNode& node, Box3f (&rest)[8]) {
    Box3f box;
    for (int slot = 0; slot < 8; ++slot) {
        rest[slot] = box;
        box.grow(slotBox(node, slot));
    }
    box = Box3f();
    for (int slot = 7; slot >= 0; --slot) {
        rest[slot].grow(box);
        box.grow(slotBox(node, slot));
    }
}

}  // namespace

/// A grandchild that leaves its node: for a free slot of the node above, for another node beside its own, or in exchange
/// for an item or node beside its own.
struct DynamicBvh::Rotation {
    enum class Kind : uint8_t { kNone, kUp, kAcross, kExchange } kind = Kind::kNone;
    float gain = 0;  ///< of surface
    int from = 0;    ///< slot of the node that it leaves
    int which = 0;   ///< its slot there
    int to = 0;      ///< a free slot, or that of the node or of the child to exchange it with
};

DynamicBvhUpdate DynamicBvh::update() {
    DynamicBvhUpdate done;
    findDirty();
    done.refitted = static_cast<uint32_t>(changed_.size());
    decayed_.clear();
    for (size_t i = changed_.size(); i-- > 0;) {
        const uint32_t index = changed_[i];
        done.rotations += lift(index);
        if (def_.rotations) done.rotations += merge(index);
        if (replaceByOnlyChild(index)) continue;
        if (def_.rotations) done.rotations += rotate(index);
        refitNode(index);
        marks_[index] = Mark::kChanged;
        if (hasDecayed(index)) decayed_.push_back(index);
    }
    for (uint32_t index : changed_) marks_[index] = Mark::kNone;
    done.rebuilt = rebuildDecayed();
    return done;
}

/// Lists the dirty nodes, parents before their children.
void DynamicBvh::findDirty() {
    changed_.clear();
    if (state_.root == kNone || marks_[state_.root] != Mark::kDirty) return;
    changed_.push_back(state_.root);
    for (size_t i = 0; i < changed_.size(); ++i) {
        const BvhNode& node = state_.node(changed_[i]);
        for (int slot = 0; slot < 8; ++slot)
            if (isNode(node, slot) && marks_[node.child[slot]] == Mark::kDirty) changed_.push_back(node.child[slot]);
    }
}

/// Takes a node away that has one child only, and puts the child in its place.
bool DynamicBvh::replaceByOnlyChild(uint32_t index) {
    const BvhNode& node = state_.node(index);
    if (usedSlots(node) != 1) return false;
    int slot = 0;
    while (node.count[slot] == 0) ++slot;
    const Entry child = take(index, slot);
    const uint32_t parent = notes_[index].parent;
    if (parent == kNone && !child.isNode()) return false;
    freeNode(index);
    if (parent == kNone) {
        state_.root = child.child;
        notes_[child.child].parent = kNone;
    } else {
        put(parent / 8, static_cast<int>(parent % 8), child);
    }
    return true;
}

/// Makes the node's bounds in its parent tight, and its count and cost right. Those of its children are.
void DynamicBvh::refitNode(uint32_t index) {
    noteCost(index);
    const uint32_t parent = notes_[index].parent;
    if (parent == kNone) return;
    const BvhNode& node = state_.node(index);
    const int slot = static_cast<int>(parent % 8);
    uint32_t count = 0;
    for (uint32_t below : node.count) count += below;
    const Box3f box = boundsOf(node), old = slotBox(state_.node(parent / 8), slot);
    // A page that a snapshot holds is not copied for nothing.
    if (box.min == old.min && box.max == old.max && state_.node(parent / 8).count[slot] == count) return;
    put(parent / 8, slot, {box, index, count});
}

void DynamicBvh::noteCost(uint32_t index) {
    const BvhNode& node = state_.node(index);
    const float area = halfArea(boundsOf(node));
    NodeNote& note = notes_[index];
    note.cost = area;
    uint32_t count = 0;
    for (int slot = 0; slot < 8; ++slot) {
        count += node.count[slot];
        if (isNode(node, slot)) note.cost += notes_[node.child[slot]].cost;
    }
    if (note.fresh_count != 0) return;
    note.fresh_count = count;
    note.fresh = area > 0.0f ? note.cost / area : 0.0f;
}

/// Takes the place of children that are nodes with no more children than the node has room for.
uint32_t DynamicBvh::lift(uint32_t index) {
    uint32_t lifted = 0;
    for (int slot = 0; slot < 8; ++slot) {
        const BvhNode& node = state_.node(index);
        if (!isNode(node, slot) || marks_[node.child[slot]] != Mark::kChanged) continue;
        const uint32_t child = node.child[slot];
        if (usedSlots(state_.node(child)) - 1 > 8 - usedSlots(node)) continue;
        Entry entries[8];
        int count = 0;
        for (int below = 0; below < 8; ++below)
            if (state_.node(child).count[below] != 0) entries[count++] = take(child, below);
        clearSlot(state_.nodes.change(index), slot);
        freeNode(child);
        for (int i = 0; i < count; ++i) put(index, freeSlot(state_.node(index)), entries[i]);
        ++lifted;
        slot = -1;  // what was lifted may have come before
    }
    return lifted;
}

/// Puts the children of two nodes side by side into one where they fit and the surface grows little: splits leave
/// nodes half full.
uint32_t DynamicBvh::merge(uint32_t index) {
    uint32_t merged = 0;
    for (int a = 0; a < 8; ++a) {
        const BvhNode& node = state_.node(index);
        if (!isNode(node, a) || marks_[node.child[a]] != Mark::kChanged) continue;
        const int used = usedSlots(state_.node(node.child[a]));
        if (used > 5) continue;
        const Box3f box = slotBox(node, a);
        int best = -1;
        float least = kWorthMerging;
        for (int b = 0; b < 8; ++b) {
            if (b == a || !isNode(node, b) || usedSlots(state_.node(node.child[b])) + used > 8) continue;
            const float apart = halfArea(box) + halfArea(slotBox(node, b));
            const float growth = grownArea(box, slotBox(node, b)) / apart;
            if (!(growth < least)) continue;
            least = growth;
            best = b;
        }
        if (best < 0) continue;
        const uint32_t from = node.child[a], to = node.child[best];
        for (int slot = 0; slot < 8; ++slot)
            if (state_.node(from).count[slot] != 0) put(to, freeSlot(state_.node(to)), take(from, slot));
        clearSlot(state_.nodes.change(index), a);
        freeNode(from);
        refitNode(to);
        ++merged;
    }
    return merged;
}

uint32_t DynamicBvh::rotate(uint32_t index) {
    uint32_t done = 0;
    for (int round = 0; round < kMostRotations; ++round) {
        const Rotation best = bestRotation(index);
        if (best.kind == Rotation::Kind::kNone) break;
        apply(index, best);
        ++done;
    }
    return done;
}

/// The rotation that gains most, of those that take from a child that has changed.
DynamicBvh::Rotation DynamicBvh::bestRotation(uint32_t index) const {
    Rotation best;
    const BvhNode& node = state_.node(index);
    for (int from = 0; from < 8; ++from) {
        if (!isNode(node, from) || marks_[node.child[from]] != Mark::kChanged) continue;
        const BvhNode& child = state_.node(node.child[from]);
        if (usedSlots(child) < 3) continue;
        const float area = halfArea(slotBox(node, from));
        Box3f rest[8];
        boundsWithoutEach(child, rest);
        for (int which = 0; which < 8; ++which) {
            if (child.count[which] == 0 || area - halfArea(rest[which]) <= kWorthRotating * area) continue;
            tryTargets(index, from, which, take(node.child[from], which), rest[which], best);
        }
    }
    return best;
}

void DynamicBvh::tryTargets(uint32_t index, int from, int which, const Entry& moved, const Box3f& rest,
                            Rotation& best) const {
    using Kind = Rotation::Kind;
    const BvhNode& node = state_.node(index);
    const float area = halfArea(slotBox(node, from));
    const float worth = kWorthRotating * area, shrunk = area - halfArea(rest);
    const auto offer = [&](Kind kind, float gain, int to) {
        if (gain > worth && gain > best.gain) best = {kind, gain, from, which, to};
    };
    for (int to = 0; to < 8; ++to) {
        if (to == from) continue;
        if (node.count[to] == 0) {
            offer(Kind::kUp, moved.isNode() ? shrunk : 0.5f * shrunk, to);
            continue;
        }
        const Box3f box = slotBox(node, to);
        offer(Kind::kExchange, area - grownArea(rest, box), to);
        if (!isNode(node, to)) continue;
        const float gain = shrunk - (grownArea(box, moved.box) - halfArea(box));
        if (gain > worth && gain > best.gain && freeSlot(state_.node(node.child[to])) >= 0)
            offer(Kind::kAcross, gain, to);
    }
}

void DynamicBvh::apply(uint32_t index, const Rotation& rotation) {
    using Kind = Rotation::Kind;
    const uint32_t from = state_.node(index).child[rotation.from];
    const Entry moved = take(from, rotation.which);
    const Entry other = take(index, rotation.to);
    clearSlot(state_.nodes.change(from), rotation.which);
    if (rotation.kind == Kind::kExchange) put(from, rotation.which, other);
    if (rotation.kind == Kind::kAcross) {
        put(other.child, freeSlot(state_.node(other.child)), moved);
        refitNode(other.child);
    } else {
        put(index, rotation.to, moved);
    }
    refitNode(from);
}

}  // namespace sightline
