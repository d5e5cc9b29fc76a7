// A scene's own hierarchy: how it follows what is placed anew.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sightline/base/assert.h"
#include "sightline/math/round_outward.h"
#include "sightline/studies/frustum/node_tree.h"
#include "sightline/tree/bvh_node.h"

namespace sightline::studies {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

Box3f storable(const Box3d& box, const glm::dvec3& origin) {
    bool bounded = !box.empty() && box.finite();
    for (int axis = 0; axis < 3 && bounded; ++axis)
        bounded = std::abs(box.min[axis] - origin[axis]) <= NodeTree::kFarthest &&
                  std::abs(box.max[axis] - origin[axis]) <= NodeTree::kFarthest;
    return bounded ? relativeBox(box, origin) : Box3f{glm::vec3(-kInfinity), glm::vec3(kInfinity)};
}

float reachOf(const Box3f& box) {
    float reach = 0.0f;
    for (int axis = 0; axis < 3; ++axis)
        reach = std::max(reach, std::max(std::abs(box.min[axis]), std::abs(box.max[axis])));
    return reach;
}

bool same(const Box3f& a, const Box3f& b) { return a.min == b.min && a.max == b.max; }

}  // namespace

void NodeTree::setTransform(uint32_t node, const glm::dmat4& local) {
    nodes_[node].local = local;
    if (marked_[node]) return;
    marked_[node] = 1;
    dirty_nodes_.push_back(node);
}

void NodeTree::setBox(uint32_t item, const Box3d& box) {
    items_[item].box = box;
    dirty_items_.push_back(item);
}

Box3f NodeTree::storedBox(uint32_t item) const {
    return slotBox(bounds_.blocks[slot_[item] / 8], static_cast<int>(slot_[item] % 8));
}

void NodeTree::place(uint32_t node) {
    const SceneTreeNode& from = nodes_[node];
    world_[node] = from.parent == SceneTreeNode::kNone ? from.local : world_[from.parent] * from.local;
}

/// Makes an item's box in the world anew.
void NodeTree::refresh(uint32_t item) {
    const SceneTreeItem& from = items_[item];
    const Box3f box = storable(transformBox(from.box, world_[from.node]), bounds_.origin);
    const uint32_t slot = slot_[item];
    BvhNode& block = bounds_.blocks[slot / 8];
    if (same(box, slotBox(block, static_cast<int>(slot % 8)))) return;
    setSlot(block, static_cast<int>(slot % 8), box);
    touch(branch_of_[slot / 8]);
}

void NodeTree::touch(uint32_t branch) {
    if (notes_[branch].touched) return;
    notes_[branch].touched = true;
    touched_.push_back(branch);
    std::push_heap(touched_.begin(), touched_.end());
}

NodeTreeUpdate NodeTree::update() {
    NodeTreeUpdate done;
    ++updates_;
    // Parents have smaller numbers: what hangs in a node that was placed anew is placed with it.
    std::sort(dirty_nodes_.begin(), dirty_nodes_.end());
    for (const uint32_t top : dirty_nodes_) {
        marked_[top] = 0;
        if (stamp_[top] == updates_) continue;
        stack_.push_back(top);
        while (!stack_.empty()) {
            const uint32_t node = stack_.back();
            stack_.pop_back();
            stamp_[node] = updates_;
            place(node);
            ++done.nodes;
            const Runs& runs = runs_[node];
            for (uint32_t i = runs.first_item; i < runs.end_item; ++i) refresh(own_items_[i]);
            done.items += runs.end_item - runs.first_item;
            stack_.insert(stack_.end(), child_nodes_.begin() + runs.first_child, child_nodes_.begin() + runs.end_child);
        }
    }
    for (const uint32_t item : dirty_items_) {
        if (stamp_[items_[item].node] == updates_) continue;
        refresh(item);
        ++done.items;
    }
    dirty_nodes_.clear();
    dirty_items_.clear();
    mendBranches(done);
    return done;
}

/// The last branch first: all below it is as it will be.
void NodeTree::mendBranches(NodeTreeUpdate& done) {
    while (!touched_.empty()) {
        const uint32_t branch = touched_.front();
        std::pop_heap(touched_.begin(), touched_.end());
        touched_.pop_back();
        notes_[branch].touched = false;
        ++done.branches;
        if (mend(branch) && notes_[branch].slot != SceneTreeNode::kNone) touch(branch_of_[notes_[branch].slot / 8]);
    }
    bounds_.reach = notes_.empty() ? 0.0f : notes_[0].reach;
}

/// Makes a branch's bounds anew; returns whether what stands above it hangs on that.
bool NodeTree::mend(uint32_t branch) {
    const NodeTreeBounds::Branch& of = bounds_.branches[branch];
    Box3f all;
    float reach = 0.0f;
    for (uint32_t i = of.first_block; i < of.first_block + of.block_count; ++i) {
        const BvhNode& block = bounds_.blocks[i];
        const Box3f box = boundsOf(block);
        all.grow(box);
        if (box.finite()) {
            reach = std::max(reach, reachOf(box));
            continue;
        }
        for (int slot = 0; slot < 8; ++slot) {  // past what has no end
            if (block.count[slot] == 0) continue;
            if (!(block.child[slot] & BvhNode::kLeaf)) reach = std::max(reach, notes_[block.child[slot]].reach);
            else if (slotBox(block, slot).finite()) reach = std::max(reach, reachOf(slotBox(block, slot)));
        }
    }
    bool changed = std::exchange(notes_[branch].reach, reach) != reach;
    const uint32_t slot = notes_[branch].slot;
    if (slot == SceneTreeNode::kNone) return changed;
    BvhNode& above = bounds_.blocks[slot / 8];
    if (!same(all, slotBox(above, static_cast<int>(slot % 8)))) {
        setSlot(above, static_cast<int>(slot % 8), all);
        changed = true;
    }
    return changed;
}

}  // namespace sightline::studies
