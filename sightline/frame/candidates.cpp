// Which objects the cells of a world leave to the other stages, and in which part of the image each may be seen.
// SPDX-License-Identifier: MIT
#include "sightline/frame/candidates.h"

#include <limits>

#include "sightline/base/assert.h"

namespace sightline::detail {

void WindowRect::grow(const WindowRect& other) {
    left = std::min(left, other.left);
    bottom = std::min(bottom, other.bottom);
    right = std::max(right, other.right);
    top = std::max(top, other.top);
}

Candidates::Candidates(Memory* memory)
    : pvs_(memory), windowed_(memory), rect_of_(memory), rects_(memory), node_at_(memory), nodes_(memory) {}

void Candidates::begin(const SnapshotState& state, uint32_t layers) {
    beginWindows();  // of the state before
    state_ = &state;
    free_ = state.cell_state.free_count > 0 ? &state.cell_state.free : nullptr;
    layers_ = layers;
    every_layer_ = (state.common_layers & layers) != 0;
    stages_ = 0;
    SIGHTLINE_DEBUG_ASSERT(state.placed.size() == state.bvh.order.size());
    const uint32_t places = state.placed.size();
    pvs_.clear(places);
    windowed_.clear(places);
    if (rect_of_.size() < places) rect_of_.resize(places);
    if (node_at_.size() < state.bvh.nodes.size()) node_at_.resize(state.bvh.nodes.size(), 0);
    in_pvs_ = 0;
    has_pvs_ = false;
    attached_ = state.count - state.unbounded.size() - state.cell_state.free_count;
    if (every_layer_) return;
    attached_ = 0;
    for (uint32_t place = 0; place < places; ++place) attached_ += isInLayers(place) && !isFree(place);
}

void Candidates::admitByPvs(uint32_t row) {
    SIGHTLINE_DEBUG_ASSERT(state_ && has_pvs_);
    const uint32_t place = state_->bvh.placeOf(row);
    SIGHTLINE_DEBUG_ASSERT(place != PlacedBvh::kNone);
    if (isInLayers(place)) in_pvs_ += pvs_.insert(place);
}

void Candidates::beginWindows() {
    if (!state_) return;
    windowed_.clear(0);
    rects_.clear();
    in_windows_ = 0;
    for (const NodeSlots& node : nodes_) node_at_[node.node] = 0;
    nodes_.clear();
}

void Candidates::noteNode(uint32_t slot) {
    SIGHTLINE_DEBUG_ASSERT(slot / 8 < node_at_.size());
    uint32_t& at = node_at_[slot / 8];
    if (at == 0) {
        nodes_.push_back({slot / 8, 0});
        at = static_cast<uint32_t>(nodes_.size());
    }
    nodes_[at - 1].slots |= 1u << slot % 8;
}

void Candidates::admit(uint32_t row, const WindowRect& rect) {
    SIGHTLINE_DEBUG_ASSERT(state_ && row < state_->bvh.slot.size());
    const uint32_t slot = state_->bvh.slot[row];
    SIGHTLINE_DEBUG_ASSERT(slot != PlacedBvh::kNone);
    const uint32_t place = state_->bvh.nodes[slot / 8].first[slot % 8];
    if (windowed_.has(place)) return rects_[rect_of_[place]].grow(rect);
    if (!isInLayers(place) || (has_pvs_ && !pvs_.has(place))) return;
    windowed_.insert(place);
    ++in_windows_;
    rect_of_[place] = static_cast<uint32_t>(rects_.size());
    rects_.push_back(rect);
    noteNode(slot);
}

void Candidates::finish(uint32_t stages) {
    SIGHTLINE_DEBUG_ASSERT(stages != 0 && (stages & ~kCellStages) == 0);
    stages_ = stages;
    const uint64_t left = uses(Stage::kPvs) ? in_pvs_ : attached_;
    SIGHTLINE_DEBUG_ASSERT(left <= attached_ && (!uses(Stage::kPortals) || in_windows_ <= left));
    by_pvs_ = attached_ - left;
    by_portals_ = uses(Stage::kPortals) ? left - in_windows_ : 0;
}

void Candidates::takeSome(const Candidates& from, std::span<const uint32_t> items, const SnapshotState& some) {
    begin(some, from.layers_);
    if (from.uses(Stage::kPvs)) beginPvs();
    const uint32_t places = some.placed.size();
    constexpr float kFar = std::numeric_limits<float>::max();
    for (uint32_t place = 0; place < places; ++place) {
        const uint32_t row = some.bvh.order[place];
        if (row == PlacedBvh::kNone) continue;
        SIGHTLINE_DEBUG_ASSERT(row < items.size());
        const uint32_t before = from.state_->bvh.placeOf(from.state_->rowOf(items[row]));
        SIGHTLINE_DEBUG_ASSERT(before != PlacedBvh::kNone);
        const bool free = from.isFree(before);
        if (from.uses(Stage::kPvs) && (free || from.pvs_.has(before))) admitByPvs(row);
        if (!from.uses(Stage::kPortals) || !from.admits(before)) continue;
        const WindowRect* const window = from.window(before);
        admit(row, window ? *window : WindowRect{-kFar, -kFar, kFar, kFar});
    }
    finish(from.stages_);
}

Stage Candidates::stageOf(uint32_t place) const {
    SIGHTLINE_DEBUG_ASSERT(!admits(place));
    return uses(Stage::kPvs) && !pvs_.has(place) ? Stage::kPvs : Stage::kPortals;
}

uint64_t Candidates::count(uint32_t first, uint32_t end) const {
    SIGHTLINE_DEBUG_ASSERT(first <= end && end <= state_->placed.size());
    uint64_t count = 0;
    decided().forEachWord(first, end,
                          [&](uint32_t, uint64_t bits) { count += static_cast<uint64_t>(std::popcount(bits)); });
    if (!free_) return count;
    free_->forEachWord(first, end, [&](uint32_t word, uint64_t bits) {
        if (every_layer_) count += static_cast<uint64_t>(std::popcount(bits));
        else
            for (; bits; bits &= bits - 1)
                count += isInLayers(64 * word + static_cast<uint32_t>(std::countr_zero(bits)));
    });
    return count;
}

}  // namespace sightline::detail
