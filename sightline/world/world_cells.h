// The cells of a world as it changes: what stands in which, what in none, and the doors.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>

#include "sightline/base/array.h"
#include "sightline/world/world_state.h"

namespace sightline::detail {

/// Follows a world's changes: rows that come, move and go, and places of the hierarchy that get other rows.
class WorldCells {
public:
    explicit WorldCells(Memory* memory)
        : memory_(memory),
          objects_(memory),
          strangers_(memory),
          free_(memory),
          free_rows_(memory),
          claims_(memory),
          claimed_(memory),
          doors_(memory),
          ranges_(memory),
          rows_(memory),
          cells_scratch_(memory) {}

    const AttachedCells* attached() const { return cells_.get(); }
    /// Null: the world has no cells. The next update must put everything.
    void attach(std::shared_ptr<const AttachedCells> cells);
    bool setDoor(uint32_t door, float open);

    /// Tells that rows have new numbers: the next update must put everything.
    void renumber() { all_ = true; }
    bool isAllNew() const { return all_; }
    /// Tells of places that hold other rows than before, or none.
    void notePlaces(uint32_t first, uint32_t end) {
        if (cells_) ranges_.push_back({first, end});
    }

    /// An update is begin(), then put() and take() of the rows that have changed, or of all rows if isAllNew(), then
    /// finish().
    void begin();
    void put(uint32_t row, const ObjectRecord& object);
    void take(uint32_t row);
    void finish(const PlacedBvh& bvh);

    void share(CellState& state);

private:
    bool isFree(uint32_t row) const { return row / 64 < free_rows_.size() && (free_rows_[row / 64] >> row % 64 & 1); }
    void setFree(uint32_t row, bool free);
    bool putAsBaked(uint32_t row, const ObjectRecord& object, const Box3d& box);
    void putByBox(uint32_t row, const Box3d& box);
    void putAmongStrangers(uint32_t row, const Box3d& box, bool is_one);
    void unclaim(uint32_t row);

    Memory* const memory_;
    std::shared_ptr<const AttachedCells> cells_;
    CellObjects objects_;
    CellObjects strangers_;      ///< CellState::strangers
    PagedBits free_;             ///< CellState::free
    uint32_t places_ = 0;        ///< that it has
    Array<uint64_t> free_rows_;  ///< a bit per row: it has bounds, and is in no cell
    uint32_t free_count_ = 0;
    /// Per object of the file: the row of the object that stands for it; kMany: there were several.
    static constexpr uint32_t kNobody = ~0u, kMany = CellState::kNoRow;
    Paged<uint32_t, 256> claims_;
    uint32_t walls_ = 0, claimed_walls_ = 0;  ///< objects of the file that are walls; those of them that stand
    Array<uint32_t> claimed_;                 ///< per row: the object that it stands for; kNobody: none
    Array<DoorState> doors_;
    std::shared_ptr<const Array<DoorState>> shared_doors_;  ///< null: they have changed
    bool all_ = true;
    Array<WorldBvh::Places> ranges_;  ///< places to look at again
    Array<uint32_t> rows_;            ///< rows that are in no cell now, or no longer in none
    Array<uint32_t> cells_scratch_;
};

}  // namespace sightline::detail
