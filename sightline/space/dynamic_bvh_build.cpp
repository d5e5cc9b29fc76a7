// A hierarchy that lives: building it, and building parts of it anew that have decayed.
// SPDX-License-Identifier: MIT
//
// Ingo Wald. On fast Construction of SAH-based Bounding Volume Hierarchies. 2007.
#include <algorithm>
#include <numeric>

#include "sightline/base/assert.h"
#include "sightline/space/bvh_node.h"
#include "sightline/space/bvh_split.h"
#include "sightline/space/dynamic_bvh.h"

namespace sightline {

void DynamicBvh::build(std::span<const Box3d> boxes) {
    SIGHTLINE_ASSERT(boxes.size() < BvhNode::kLeaf - 1);
    clear();
    free_items_.clear();
    slot_.assign(boxes.size(), kFree);
    state_.count = static_cast<uint32_t>(boxes.size());
    entries_.clear();
    entries_.reserve(boxes.size());
    for (uint32_t item = 0; item < boxes.size(); ++item) {
        const Box3f box = storable(boxes[item], glm::dvec3(0.0));
        if (box.empty()) enter(item, box);
        else entries_.push_back({box, BvhNode::kLeaf | item, 1});
    }
    if (entries_.empty()) return;
    state_.root = newNode();
    buildBelow(state_.root);
}

void DynamicBvh::rebuild() {
    if (state_.root == kNone) return;
    entries_.clear();
    for (uint32_t item = 0; item < slot_.size(); ++item)
        if (slot_[item] != kFree && !(slot_[item] & kUnbounded))
            entries_.push_back({storedBox(item), BvhNode::kLeaf | item, 1});
    // Without what has no bounds: its places there stay as they are.
    state_.nodes.clear();
    notes_.clear();
    marks_.clear();
    free_nodes_.clear();
    state_.root = newNode();
    buildBelow(state_.root);
}

/// Builds over `entries_` below an empty node, whose place in its parent stays as it is.
void DynamicBvh::buildBelow(uint32_t index) {
    const uint32_t count = static_cast<uint32_t>(entries_.size());
    Array<uint32_t> order(count, def_.memory);
    std::iota(order.begin(), order.end(), 0u);
    BvhSplitter splitter(order, def_.memory);
    splitter.full_nodes = true;
    splitter.boxes.resize(count);
    splitter.centers.resize(count);
    for (uint32_t i = 0; i < count; ++i) {
        splitter.boxes[i] = entries_[i].box;
        splitter.centers[i] = splitCenter(entries_[i].box);
    }
    struct Job {
        BvhRange range;
        uint32_t node;
    };
    Array<Job> jobs({{{0, count, splitter.boundsOf(0, count)}, index}}, def_.memory);
    Array<uint32_t> built(def_.memory);
    while (!jobs.empty()) {
        const Job job = jobs.back();
        jobs.pop_back();
        built.push_back(job.node);
        BvhRange parts[8];
        const int used = splitter.splitToEight(job.range, parts);
        for (int slot = used - 1; slot >= 0; --slot) {
            if (parts[slot].count() == 1) {
                put(job.node, slot, entries_[order[parts[slot].first]]);
                continue;
            }
            const uint32_t below = newNode();
            put(job.node, slot, {parts[slot].bounds, below, parts[slot].count()});
            jobs.push_back({parts[slot], below});
        }
    }
    for (size_t i = built.size(); i-- > 0;) {
        notes_[built[i]].fresh_count = 0;
        refitNode(built[i]);
    }
}

/// Whether the nodes below overlap more than when they were built, or are so many more that it is not known.
bool DynamicBvh::hasDecayed(uint32_t index) const {
    const BvhNode& node = state_.node(index);
    uint32_t count = 0;
    for (uint32_t below : node.count) count += below;
    if (count <= 8) return false;
    const NodeNote& note = notes_[index];
    if (count > 2 * note.fresh_count) return true;
    return note.cost > static_cast<float>(def_.decay) * note.fresh * halfArea(boundsOf(node));
}

/// Builds anew what has decayed, small before large, until the share of items is spent. What is too large for what is
/// left of it is built anew from its upper nodes alone.
uint32_t DynamicBvh::rebuildDecayed() {
    if (decayed_.empty()) return 0;
    const auto below = [&](uint32_t index) {
        uint32_t count = 0;
        for (uint32_t n : state_.node(index).count) count += n;
        return count;
    };
    std::sort(decayed_.begin(), decayed_.end(), [&](uint32_t a, uint32_t b) {
        const uint32_t in_a = below(a), in_b = below(b);
        return in_a != in_b ? in_a < in_b : a < b;
    });
    uint32_t left = static_cast<uint32_t>(def_.rebuilt_share * state_.count);
    uint32_t done = 0;
    for (uint32_t index : decayed_) {
        if (left < 64) break;
        // It may have gone with a larger one, or be better since smaller ones were built anew.
        if (index != state_.root && notes_[index].parent == kNone) continue;
        if (!hasDecayed(index)) continue;
        const uint32_t built = rebuildBelow(index, left);
        done += built;
        left -= std::min(left, built);
    }
    return done;
}

/// @param most  entries to build over
uint32_t DynamicBvh::rebuildBelow(uint32_t index, uint32_t most) {
    collect(index, most);
    state_.nodes.change(index) = emptyNode();
    buildBelow(index);
    for (uint32_t up = notes_[index].parent; up != kNone; up = notes_[up / 8].parent) noteCost(up / 8);
    return static_cast<uint32_t>(entries_.size());
}

/// Lists what is below a node, level by level, as far down as `most` entries allow; the nodes between are freed.
void DynamicBvh::collect(uint32_t index, uint32_t most) {
    entries_.clear();
    for (int slot = 0; slot < 8; ++slot)
        if (state_.node(index).count[slot] != 0) entries_.push_back(take(index, slot));
    size_t opened = 0;
    for (size_t i = 0; i < entries_.size() && entries_.size() - opened + 8 <= most; ++i) {
        const Entry entry = entries_[i];
        if (!entry.isNode()) continue;
        entries_[i].count = 0;
        ++opened;
        for (int slot = 0; slot < 8; ++slot)
            if (state_.node(entry.child).count[slot] != 0) entries_.push_back(take(entry.child, slot));
        freeNode(entry.child);
    }
    std::erase_if(entries_, [](const Entry& entry) { return entry.count == 0; });
}

}  // namespace sightline
