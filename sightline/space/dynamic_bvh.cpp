// A hierarchy that lives: its nodes and items, and what comes, moves and goes.
// SPDX-License-Identifier: MIT
#include "sightline/space/dynamic_bvh.h"

#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/math/round_outward.h"
#include "sightline/space/bvh_node.h"

namespace sightline {

namespace {

/// An item stays in its node, which grows, unless the surface becomes larger than this factor: what wanders off is left to
/// rotations.
constexpr float kWorthLeaving = 1.06f;

}  // namespace

float LivingBvh::reach() const {
    if (root == kNone) return 0.0f;
    const Box3f box = boundsOf(node(root));
    float reach = 0.0f;
    for (int axis = 0; axis < 3; ++axis)
        reach = std::max(reach, std::max(std::abs(box.min[axis]), std::abs(box.max[axis])));
    return reach;
}

DynamicBvh::DynamicBvh(const DynamicBvhDef& def)
    : def_(def),
      state_(def.memory),
      notes_(def.memory),
      marks_(def.memory),
      free_nodes_(def.memory),
      slot_(def.memory),
      free_items_(def.memory),
      changed_(def.memory),
      decayed_(def.memory),
      entries_(def.memory) {
    SIGHTLINE_ASSERT(def.margin >= 0.0 && std::isfinite(def.margin));
    state_.origin = def.origin;
}

uint32_t DynamicBvh::newNode() {
    uint32_t index;
    if (!free_nodes_.empty()) {
        index = free_nodes_.back();
        free_nodes_.pop_back();
        notes_[index] = {};
    } else {
        index = static_cast<uint32_t>(notes_.size());
        state_.nodes.push_back({});
        notes_.emplace_back();
        marks_.push_back(Mark::kNone);
    }
    state_.nodes.change(index) = emptyNode();
    return index;
}

void DynamicBvh::freeNode(uint32_t index) {
    notes_[index] = {};
    marks_[index] = Mark::kNone;
    free_nodes_.push_back(index);
}

void DynamicBvh::markDirty(uint32_t index) {
    while (marks_[index] != Mark::kDirty) {
        marks_[index] = Mark::kDirty;
        if (notes_[index].parent == kNone) return;
        index = notes_[index].parent / 8;
    }
}

void DynamicBvh::put(uint32_t index, int slot, const Entry& entry) {
    BvhNode& node = state_.nodes.change(index);
    setSlot(node, slot, entry.box);
    node.child[slot] = entry.child;
    node.count[slot] = entry.count;
    const uint32_t place = index * 8 + static_cast<uint32_t>(slot);
    if (entry.isNode()) notes_[entry.child].parent = place;
    else slot_[entry.child & ~BvhNode::kLeaf] = place;
}

DynamicBvh::Entry DynamicBvh::take(uint32_t index, int slot) const {
    const BvhNode& node = state_.node(index);
    return {slotBox(node, slot), node.child[slot], node.count[slot]};
}

/// Forgets all nodes and items. Pages that a snapshot holds stay with it.
void DynamicBvh::clear() {
    state_.nodes.clear();
    state_.unbounded.clear();
    state_.root = kNone;
    state_.count = 0;
    notes_.clear();
    marks_.clear();
    free_nodes_.clear();
}

/// The box as it is kept; empty if no bounds hold it.
Box3f DynamicBvh::storable(const Box3d& box, const glm::dvec3& displacement) const {
    Box3d fat = box;
    for (int axis = 0; axis < 3; ++axis) {
        fat.min[axis] += std::min(displacement[axis], 0.0) - def_.margin;
        fat.max[axis] += std::max(displacement[axis], 0.0) + def_.margin;
        // Written so that what is no number fails, too, and so that an empty box does not become one by its margin.
        const bool usable = box.min[axis] <= box.max[axis] && fat.min[axis] - state_.origin[axis] > -kFarthest &&
                            fat.max[axis] - state_.origin[axis] < kFarthest && std::isfinite(displacement[axis]);
        if (!usable) return Box3f();
    }
    return relativeBox(fat, state_.origin);
}

uint32_t DynamicBvh::insert(const Box3d& box, const glm::dvec3& displacement) {
    uint32_t item;
    if (!free_items_.empty()) {
        item = free_items_.back();
        free_items_.pop_back();
    } else {
        item = static_cast<uint32_t>(slot_.size());
        SIGHTLINE_ASSERT(item < BvhNode::kLeaf - 1);
        slot_.push_back(kFree);
    }
    ++state_.count;
    enter(item, storable(box, displacement));
    return item;
}

/// Puts an item that is nowhere where it belongs.
void DynamicBvh::enter(uint32_t item, const Box3f& box) {
    if (box.empty()) {
        slot_[item] = kUnbounded | static_cast<uint32_t>(state_.unbounded.size());
        state_.unbounded.push_back(item);
        return;
    }
    if (state_.root == kNone) state_.root = newNode();
    insertBelow(state_.root, {box, BvhNode::kLeaf | item, 1});
}

/// Takes an item from where it is.
void DynamicBvh::leave(uint32_t item) {
    const uint32_t place = slot_[item];
    if (place & kUnbounded) {
        const uint32_t last = state_.unbounded.back();
        state_.unbounded[place & ~kUnbounded] = last;
        slot_[last] = place;
        state_.unbounded.pop_back();
        return;
    }
    clearSlot(state_.nodes.change(place / 8), static_cast<int>(place % 8));
    markDirty(place / 8);
    cutEmpty(place / 8);
}

/// Takes nodes that hold nothing away, from one of them upward.
void DynamicBvh::cutEmpty(uint32_t index) {
    const auto isEmpty = [&](const BvhNode& node) {
        uint32_t sum = 0;
        for (uint32_t count : node.count) sum |= count;
        return sum == 0;
    };
    while (isEmpty(state_.node(index))) {
        const uint32_t parent = notes_[index].parent;
        freeNode(index);
        if (parent == kNone) {
            state_.root = kNone;
            return;
        }
        clearSlot(state_.nodes.change(parent / 8), static_cast<int>(parent % 8));
        index = parent / 8;
    }
}

/// Makes the bounds of a node, and those above, hold a box.
void DynamicBvh::growAbove(uint32_t index, const Box3f& box) {
    for (uint32_t up = notes_[index].parent; up != kNone; up = notes_[up / 8].parent) {
        Box3f bounds = slotBox(state_.node(up / 8), static_cast<int>(up % 8));
        if (holds(bounds, box)) return;
        bounds.grow(box);
        setSlot(state_.nodes.change(up / 8), static_cast<int>(up % 8), bounds);
    }
}

bool DynamicBvh::move(uint32_t item, const Box3d& box, const glm::dvec3& displacement) {
    if (!contains(item)) return false;
    const Box3f fat = storable(box, displacement);
    const bool was_unbounded = slot_[item] & kUnbounded;
    if (was_unbounded || fat.empty()) {
        if (was_unbounded && fat.empty()) return true;
        leave(item);
        enter(item, fat);
        return true;
    }
    const uint32_t place = slot_[item];
    const int slot = static_cast<int>(place % 8);
    const Box3f stored = slotBox(state_.node(place / 8), slot);
    Box3f largest = fat;
    const glm::vec3 slack = glm::vec3(glm::abs(displacement) + 2.0 * def_.margin);
    largest.min -= slack;
    largest.max += slack;
    if (holds(largest, stored) && holds(stored, relativeBox(box, state_.origin))) return true;
    const uint32_t parent = notes_[place / 8].parent;
    if (parent != kNone) {
        const Box3f bounds = slotBox(state_.node(parent / 8), static_cast<int>(parent % 8));
        Box3f grown = bounds;
        grown.grow(fat);
        if (halfArea(grown) > kWorthLeaving * halfArea(bounds)) {
            reinsert(item, fat);
            return true;
        }
        growAbove(place / 8, fat);
    }
    setSlot(state_.nodes.change(place / 8), slot, fat);
    markDirty(place / 8);
    return true;
}

bool DynamicBvh::remove(uint32_t item) {
    if (!contains(item)) return false;
    leave(item);
    slot_[item] = kFree;
    free_items_.push_back(item);
    --state_.count;
    return true;
}

std::shared_ptr<const LivingBvh> DynamicBvh::snapshot() {
    auto taken = makeShared<LivingBvh>(def_.memory, def_.memory);
    taken->origin = state_.origin;
    taken->nodes = state_.nodes.share();
    taken->root = state_.root;
    taken->unbounded = state_.unbounded;
    taken->count = state_.count;
    return taken;
}

Box3f DynamicBvh::storedBox(uint32_t item) const {
    SIGHTLINE_ASSERT(contains(item));
    const uint32_t place = slot_[item];
    return place & kUnbounded ? Box3f() : slotBox(state_.node(place / 8), static_cast<int>(place % 8));
}

double DynamicBvh::surfaceCost() const {
    if (state_.root == kNone) return 0.0;
    const double area = static_cast<double>(halfArea(boundsOf(state_.node(state_.root))));
    return area > 0.0 ? static_cast<double>(notes_[state_.root].cost) / area : static_cast<double>(notes_.size());
}

}  // namespace sightline
