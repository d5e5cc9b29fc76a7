// The cells of a world as it changes: what stands in which, what in none, and the doors.
// SPDX-License-Identifier: MIT
#include "sightline/world/world_cells.h"

#include "sightline/base/assert.h"

namespace sightline::detail {

void WorldCells::attach(std::shared_ptr<const AttachedCells> cells) {
    cells_ = std::move(cells);
    doors_.assign(cells_ ? cells_->graph.doors() : 0, DoorState());
    shared_doors_ = nullptr;
    ranges_.clear();
    all_ = true;
}

bool WorldCells::setDoor(uint32_t door, float open) {
    if (door >= doors_.size()) return false;
    if (doors_[door].open == open) return true;
    doors_[door].open = open;
    shared_doors_ = nullptr;
    return true;
}

void WorldCells::begin() {
    if (!all_) return;
    objects_.reset(cells_ ? cells_->graph.cells() : 0);
    strangers_.reset(1);
    free_.clear();
    places_ = 0;
    free_rows_.clear();
    free_count_ = 0;
    claims_.clear();
    claims_.resize(cells_ ? static_cast<uint32_t>(cells_->objects.size()) : 0);
    claimed_.clear();
    walls_ = claimed_walls_ = 0;
    for (uint32_t i = 0; i < claims_.size(); ++i) {
        claims_.set(i, kNobody);
        walls_ += cells_->objects.isWall(i);
    }
}

void WorldCells::setFree(uint32_t row, bool free) {
    if (isFree(row) == free) return;
    if (free_rows_.size() <= row / 64) free_rows_.resize(row / 64 + 1, 0);
    free_rows_[row / 64] ^= uint64_t{1} << row % 64;
    SIGHTLINE_DEBUG_ASSERT(free || free_count_ > 0);
    free ? ++free_count_ : --free_count_;
    rows_.push_back(row);
}

void WorldCells::put(uint32_t row, const ObjectRecord& object) {
    SIGHTLINE_DEBUG_ASSERT(cells_ && object.id.index != 0);
    const Box3d box = worldBounds(object);
    if (!box.finite()) return take(row);
    unclaim(row);
    if (object.moved || !putAsBaked(row, object, box)) putByBox(row, box);
}

void WorldCells::putByBox(uint32_t row, const Box3d& box) {
    SIGHTLINE_DEBUG_ASSERT(box.finite() && !box.empty());
    const bool any = cells_->graph.cellsOf(box, cells_scratch_);
    if (any) objects_.put(row, roundOutward(box, cells_->origin), cells_scratch_);
    else objects_.take(row);
    setFree(row, !any);
    putAmongStrangers(row, box, any);
}

/// Has no use without view cells: only their rows name objects.
void WorldCells::putAmongStrangers(uint32_t row, const Box3d& box, bool is_one) {
    constexpr uint32_t kAll = 0;
    if (!cells_->views) return;
    if (is_one) strangers_.put(row, roundOutward(box, cells_->origin), {&kAll, 1});
    else strangers_.take(row);
}

/// Puts an object into the cells that it was baked into; false if it is not known to be what was baked.
bool WorldCells::putAsBaked(uint32_t row, const ObjectRecord& object, const Box3d& box) {
    const uint32_t baked = cells_->objectOf(object.key, box);
    if (baked == AttachedCells::kNone || claims_[baked] == kMany) return false;
    if (claims_[baked] != kNobody) {
        // Two objects have this key and these bounds: nobody knows which of them was baked.
        const uint32_t other = claims_[baked];
        SIGHTLINE_DEBUG_ASSERT(other < claimed_.size() && claimed_[other] == baked && other != row);
        unclaim(other);
        claims_.set(baked, kMany);
        Box3d either = cells_->objects.bounds(baked);
        either.grow(box);
        putByBox(other, either);
        return false;
    }
    claims_.set(baked, row);
    claimed_walls_ += cells_->objects.isWall(baked);
    if (claimed_.size() <= row) claimed_.resize(row + 1, kNobody);
    claimed_[row] = baked;
    const bool everywhere = cells_->objects.seenFromEverywhere(baked);
    cells_scratch_.clear();
    const PlacedNumbers<uint32_t> cells = cells_->objects.cells(baked);
    for (size_t i = 0; i < cells.size() && !everywhere; ++i) cells_scratch_.push_back(cells[i]);
    if (everywhere) objects_.take(row);
    else objects_.put(row, roundOutward(box, cells_->origin), cells_scratch_);
    setFree(row, everywhere);
    putAmongStrangers(row, box, false);
    return true;
}

/// Notes that an object is no longer the one of the file that it stood for.
void WorldCells::unclaim(uint32_t row) {
    if (row >= claimed_.size() || claimed_[row] == kNobody) return;
    SIGHTLINE_DEBUG_ASSERT(claims_[claimed_[row]] == row);
    claims_.set(claimed_[row], kNobody);
    claimed_walls_ -= cells_->objects.isWall(claimed_[row]);
    SIGHTLINE_DEBUG_ASSERT(claimed_walls_ <= walls_);
    claimed_[row] = kNobody;
}

void WorldCells::take(uint32_t row) {
    SIGHTLINE_DEBUG_ASSERT(cells_);
    unclaim(row);
    objects_.take(row);
    if (cells_->views) strangers_.take(row);
    setFree(row, false);
}

void WorldCells::finish(const PlacedBvh& bvh) {
    SIGHTLINE_DEBUG_ASSERT(cells_);
    const auto look = [&](uint32_t place) {
        const uint32_t row = bvh.order[place];
        free_.set(place, row != PlacedBvh::kNone && isFree(row));
    };
    const uint32_t places = bvh.order.size();
    if (all_ || places < places_) {  // built anew
        free_.clear();
        places_ = 0;
        ranges_.assign(1, {0, places});
    }
    if (places > places_) free_.resize(places);
    places_ = places;
    if (free_count_ > 0 || !rows_.empty())
        for (const WorldBvh::Places& range : ranges_)
            for (uint32_t place = range.first; place < std::min(range.end, places); ++place) look(place);
    for (const uint32_t row : rows_) {
        const uint32_t place = bvh.placeOf(row);
        if (place != PlacedBvh::kNone) look(place);
    }
    ranges_.clear();
    rows_.clear();
    all_ = false;
}

void WorldCells::share(CellState& state) {
    SIGHTLINE_DEBUG_ASSERT(ranges_.empty() && rows_.empty());
    if (!cells_) return;
    if (!shared_doors_) shared_doors_ = makeShared<Array<DoorState>>(memory_, doors_);
    state.cells = cells_;
    state.doors = shared_doors_;
    state.lists = objects_.share();
    state.free = free_.share();
    state.free_count = free_count_;
    if (cells_->views) {
        state.claims = claims_.share();
        state.strangers = strangers_.share();
    }
    state.has_walls = walls_ > 0;
    state.walls_stand = claimed_walls_ == walls_;
}

}  // namespace sightline::detail
