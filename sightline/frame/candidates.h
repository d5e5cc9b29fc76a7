// Which objects the cells of a world leave to the other stages, and in which part of the image each may be seen.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

#include "sightline/base/assert.h"
#include "sightline/base/levelled_bits.h"
#include "sightline/base/array.h"
#include "sightline/geom/view.h"
#include "sightline/world/world_state.h"

namespace sightline::detail {

/// A part of the image, in clip x and y over w.
struct WindowRect {
    float left = 0, bottom = 0, right = 0, top = 0;

    void grow(const WindowRect& other);
};

/// A node of the hierarchy, and some of its slots.
struct NodeSlots {
    uint32_t node = 0, slots = 0;
};

/// The candidates: the objects that Stage::kPvs and Stage::kPortals leave for a view. Whether an object is a candidate
/// depends on the cells, the doors and its own box, and on no other object. Places are the hierarchy's; objects outside
/// of the view's layers do not count.
///
/// Objects that stand in no cell are candidates: their state lists them.
class Candidates {
public:
    explicit Candidates(Memory* memory);

    /// Takes up a state, and forgets all candidates.
    /// @param state  outlives it
    void begin(const SnapshotState& state, uint32_t layers);
    /// Tells that the PVS decides. Then call admitByPvs() for each row that the PVS shows, before any window.
    void beginPvs() { has_pvs_ = true; }
    void admitByPvs(uint32_t row);
    /// Forgets what portals admitted.
    void beginWindows();
    /// Admits an object by a window of portals. If the PVS decides, the object must be admitted by it, too.
    void admit(uint32_t row, const WindowRect& rect);
    /// @param stages  which of the two stages decide; at least one
    void finish(uint32_t stages);
    /// The same for a world of some of the objects, as stateOfSome() makes it.
    /// @param items  of the state that `from` is about
    void takeSome(const Candidates& from, std::span<const uint32_t> items, const SnapshotState& some);

    bool uses(Stage stage) const { return stages_ & stageBit(stage); }
    uint32_t stages() const { return stages_; }
    uint64_t culled(Stage stage) const { return stage == Stage::kPvs ? by_pvs_ : by_portals_; }
    uint64_t attached() const { return attached_; }  ///< objects that stand in cells

    bool admits(uint32_t place) const {
        SIGHTLINE_DEBUG_ASSERT(stages_ != 0 && place < state_->placed.size());
        return decided().has(place) || isFree(place);
    }
    bool any(uint32_t first, uint32_t end) const {
        SIGHTLINE_DEBUG_ASSERT(stages_ != 0 && first <= end && end <= state_->placed.size());
        return decided().any(first, end) || (free_ && free_->any(first, end));
    }
    /// Which stage culls the object at a place that is no candidate.
    Stage stageOf(uint32_t place) const;
    /// How many objects of a range of places are candidates.
    uint64_t count(uint32_t first, uint32_t end) const;
    /// Calls visit(place) for each candidate, rising; also for objects in no cell that are outside of the layers.
    template <class Visit>
    void forEach(uint32_t first, uint32_t end, Visit&& visit) const;
    /// Where in the image the object at a place may be seen; null: anywhere.
    const WindowRect* window(uint32_t place) const {
        SIGHTLINE_DEBUG_ASSERT(place < state_->placed.size());
        return uses(Stage::kPortals) && decided().has(place) ? &rects_[rect_of_[place]] : nullptr;
    }
    /// The nodes that hold candidates; empty: the descent had better begin at the root.
    std::span<const NodeSlots> nodes() const {
        return free_ || !uses(Stage::kPortals) ? std::span<const NodeSlots>() : nodes_;
    }

private:
    const LevelledBits& decided() const { return uses(Stage::kPortals) ? windowed_ : pvs_; }
    bool isFree(uint32_t place) const { return free_ && free_->has(place); }
    bool isInLayers(uint32_t place) const { return every_layer_ || (state_->placed[place].layers & layers_); }
    void noteNode(uint32_t slot);

    const SnapshotState* state_ = nullptr;
    const PagedBits* free_ = nullptr;  ///< null: no object is in no cell
    uint32_t layers_ = ~0u, stages_ = 0;
    bool every_layer_ = true;
    LevelledBits pvs_, windowed_;
    uint64_t attached_ = 0, in_pvs_ = 0, in_windows_ = 0, by_pvs_ = 0, by_portals_ = 0;
    bool has_pvs_ = false;
    Array<uint32_t> rect_of_;  ///< per place: index into rects_
    Array<WindowRect> rects_;
    Array<uint32_t> node_at_;  ///< per node: 1 + index into nodes_, if it is there
    Array<NodeSlots> nodes_;
};

template <class Visit>
void Candidates::forEach(uint32_t first, uint32_t end, Visit&& visit) const {
    if (first >= end) return;
    SIGHTLINE_DEBUG_ASSERT(stages_ != 0 && end <= state_->placed.size());
    const uint32_t low = first / 64, behind = bit_levels::wordsOf(end);
    const auto next = [&](uint32_t from) {
        const uint32_t word = decided().nextWord(from, behind);
        return free_ ? std::min(word, free_->nextWord(from, behind)) : word;
    };
    for (uint32_t word = next(low); word < behind; word = next(word + 1)) {
        uint64_t bits = decided().word(word) | (free_ ? free_->word(word) : 0);
        if (word == low) bits &= ~uint64_t{0} << first % 64;
        if (word + 1 == behind) bits &= ~uint64_t{0} >> (63 - (end - 1) % 64);
        for (; bits; bits &= bits - 1) visit(64 * word + static_cast<uint32_t>(std::countr_zero(bits)));
    }
}

}  // namespace sightline::detail
