// A scene's own hierarchy: how it is built.
// SPDX-License-Identifier: MIT
#include "sightline/studies/frustum/node_tree.h"

#include <algorithm>
#include <utility>

#include "sightline/base/assert.h"
#include "sightline/tree/bvh_node.h"

namespace sightline::studies {

NodeTree::NodeTree(const glm::dvec3& origin, Memory* memory)
    : memory_(memory),
      bounds_(memory),
      nodes_(memory),
      items_(memory),
      world_(memory),
      runs_(memory),
      child_nodes_(memory),
      own_items_(memory),
      stands_(memory),
      branch_of_(memory),
      notes_(memory),
      slot_(memory),
      marked_(memory),
      dirty_nodes_(memory),
      dirty_items_(memory),
      stamp_(memory),
      stack_(memory),
      touched_(memory) {
    bounds_.origin = origin;
}

void NodeTree::build(std::span<const SceneTreeNode> nodes, std::span<const SceneTreeItem> items) {
    SIGHTLINE_ASSERT(items.size() < BvhNode::kLeaf && nodes.size() < BvhNode::kLeaf);
    nodes_.assign(nodes.begin(), nodes.end());
    items_.assign(items.begin(), items.end());
    hang();
    layOut();
    const size_t count = nodes.size();
    world_.resize(count);
    marked_.assign(count, 0);
    stamp_.assign(count, 0);
    updates_ = 0;
    dirty_nodes_.clear();
    dirty_items_.clear();
    touched_.clear();
    for (uint32_t node = 0; node < count; ++node) place(node);
    for (uint32_t item = 0; item < items.size(); ++item) refresh(item);
    for (uint32_t branch = 0; branch < notes_.size(); ++branch) touch(branch);
    NodeTreeUpdate done;
    mendBranches(done);
}

/// Finds what hangs in each node, and what stands for it in its parent: itself, or the only thing that is below.
void NodeTree::hang() {
    const uint32_t world = nodes();
    const auto parentOf = [&](uint32_t node) {
        const uint32_t parent = nodes_[node].parent;
        SIGHTLINE_ASSERT(parent == SceneTreeNode::kNone || parent < node);
        return parent == SceneTreeNode::kNone ? world : parent;
    };
    runs_.assign(size_t{world} + 1, Runs());
    child_nodes_.resize(world);
    own_items_.resize(items());
    for (uint32_t node = 0; node < world; ++node) ++runs_[parentOf(node)].end_child;
    for (const SceneTreeItem& item : items_) {
        SIGHTLINE_ASSERT(item.node < world);
        ++runs_[item.node].end_item;
    }
    uint32_t child = 0, item = 0;
    for (Runs& runs : runs_) {
        runs.first_child = child;
        runs.first_item = item;
        child += std::exchange(runs.end_child, child);
        item += std::exchange(runs.end_item, item);
    }
    for (uint32_t node = 0; node < world; ++node) child_nodes_[runs_[parentOf(node)].end_child++] = node;
    for (uint32_t i = 0; i < items(); ++i) own_items_[runs_[items_[i].node].end_item++] = i;
    stands_.assign(world, Entry());
    for (uint32_t node = world; node-- > 0;) {
        const Runs& runs = runs_[node];
        Entry only, &all = stands_[node];
        uint32_t entries = 0;
        for (uint32_t i = runs.first_child; i < runs.end_child; ++i) {
            const Entry& below = stands_[child_nodes_[i]];
            if (below.count == 0) continue;
            only = below;
            all.count += below.count;
            ++entries;
        }
        for (uint32_t i = runs.first_item; i < runs.end_item; ++i, ++entries) {
            only = {own_items_[i] | BvhNode::kLeaf, 1};
            ++all.count;
        }
        all.what = entries == 1 ? only.what : node;
    }
}

void NodeTree::gather(const Runs& runs, Array<Entry>& out) const {
    out.clear();
    for (uint32_t i = runs.first_child; i < runs.end_child; ++i)
        if (stands_[child_nodes_[i]].count > 0) out.push_back(stands_[child_nodes_[i]]);
    for (uint32_t i = runs.first_item; i < runs.end_item; ++i) out.push_back({own_items_[i] | BvhNode::kLeaf, 1});
}

/// Makes the branches in depth-first order, so that each stands before all below it.
void NodeTree::layOut() {
    bounds_.blocks.clear();
    bounds_.branches.clear();
    branch_of_.clear();
    notes_.clear();
    bounds_.order.resize(items());
    slot_.resize(items());
    struct Next {
        uint32_t node, slot, first;
    };
    Array<Next> stack(memory_);
    Array<Entry> entries(memory_);
    if (items() > 0) stack.push_back({nodes(), SceneTreeNode::kNone, 0});
    while (!stack.empty()) {
        const Next next = stack.back();
        stack.pop_back();
        gather(runs_[next.node], entries);
        if (next.node == nodes() && entries.size() == 1 && !(entries[0].what & BvhNode::kLeaf)) {
            stack.push_back({entries[0].what, SceneTreeNode::kNone, 0});
            continue;
        }
        const uint32_t branch = static_cast<uint32_t>(bounds_.branches.size());
        notes_.push_back({next.slot});
        if (next.slot != SceneTreeNode::kNone) bounds_.blocks[next.slot / 8].child[next.slot % 8] = branch;
        layOutBranch(branch, entries, next.first);
        const uint32_t first_slot = 8 * bounds_.branches[branch].first_block;
        for (uint32_t i = static_cast<uint32_t>(entries.size()); i-- > 0;) {
            const uint32_t slot = first_slot + i;
            if (entries[i].what & BvhNode::kLeaf) continue;
            stack.push_back({entries[i].what, slot, bounds_.blocks[slot / 8].first[slot % 8]});
        }
    }
}

/// @param first  place of the first item below
void NodeTree::layOutBranch(uint32_t branch, std::span<const Entry> entries, uint32_t first) {
    const uint32_t first_block = static_cast<uint32_t>(bounds_.blocks.size());
    const uint32_t block_count = static_cast<uint32_t>((entries.size() + 7) / 8);
    bounds_.branches.push_back({first_block, block_count});
    bounds_.blocks.resize(size_t{first_block} + block_count, emptyNode());
    branch_of_.resize(size_t{first_block} + block_count, branch);
    for (uint32_t i = 0; i < entries.size(); ++i) {
        BvhNode& block = bounds_.blocks[first_block + i / 8];
        const uint32_t slot = i % 8, what = entries[i].what;
        block.child[slot] = what;
        block.first[slot] = first;
        block.count[slot] = entries[i].count;
        if (what & BvhNode::kLeaf) {
            bounds_.order[first] = what & ~BvhNode::kLeaf;
            slot_[what & ~BvhNode::kLeaf] = 8 * first_block + i;
        }
        first += entries[i].count;
    }
}

}  // namespace sightline::studies
