// Which objects stand in which cell: lists of boxes, eight side by side, in pages that snapshots share.
// SPDX-License-Identifier: MIT
#include "sightline/world/cell_objects.h"

#include "sightline/base/assert.h"

namespace sightline::detail {
namespace {

void setBox(CellBlock& block, uint32_t lane, const Box3f& box) {
    SIGHTLINE_DEBUG_ASSERT(lane < 8);
    for (int axis = 0; axis < 3; ++axis) {
        block.min[axis][lane] = box.min[axis];
        block.max[axis][lane] = box.max[axis];
    }
}

bool hasBox(const CellBlock& block, uint32_t lane, const Box3f& box) {
    bool same = true;
    for (int axis = 0; axis < 3; ++axis)
        same = same && block.min[axis][lane] == box.min[axis] && block.max[axis][lane] == box.max[axis];
    return same;
}

}  // namespace

CellObjects::CellObjects(Memory* memory)
    : memory_(memory), now_(memory), first_of_(memory), stands_(memory), free_stands_(memory), free_blocks_(memory) {}

void CellObjects::reset(uint32_t cells) {
    now_.first.clear();
    now_.blocks.clear();
    now_.count.clear();
    now_.count.resize(cells);
    now_.stands = 0;
    now_.first.resize(cells);
    for (uint32_t cell = 0; cell < cells; ++cell) now_.first.set(cell, CellBlock::kNone);
    first_of_.clear();
    stands_.clear();
    free_stands_.clear();
    free_blocks_.clear();
}

bool CellObjects::standsIn(uint32_t row, std::span<const uint32_t> cells) const {
    uint32_t at = row < first_of_.size() ? first_of_[row] : kNone;
    for (const uint32_t cell : cells) {
        SIGHTLINE_DEBUG_ASSERT(at == kNone || at < stands_.size());
        if (at == kNone || stands_[at].cell != cell) return false;
        at = stands_[at].next;
    }
    return at == kNone;
}

void CellObjects::put(uint32_t row, const Box3f& box, std::span<const uint32_t> cells) {
    for (size_t i = 0; i < cells.size(); ++i)
        SIGHTLINE_DEBUG_ASSERT(cells[i] < now_.first.size() && (i == 0 || cells[i - 1] < cells[i]));
    if (standsIn(row, cells)) {
        for (uint32_t at = cells.empty() ? kNone : first_of_[row]; at != kNone; at = stands_[at].next) {
            const uint32_t block = stands_[at].at / 8, lane = stands_[at].at % 8;
            if (!hasBox(now_.blocks[block], lane, box)) setBox(now_.blocks.change(block), lane, box);
        }
        return;
    }
    take(row);
    if (first_of_.size() <= row) first_of_.resize(row + 1, kNone);
    for (size_t i = cells.size(); i-- > 0;) add(row, box, cells[i]);
}

void CellObjects::take(uint32_t row) {
    if (row >= first_of_.size()) return;
    uint32_t at = first_of_[row];
    first_of_[row] = kNone;
    while (at != kNone) {
        const Stand stand = stands_[at];
        SIGHTLINE_DEBUG_ASSERT(stand.at / 8 < now_.blocks.size() && now_.blocks[stand.at / 8].row[stand.at % 8] == row);
        free_stands_.push_back(at);
        removeAt(stand.cell, stand.at);
        at = stand.next;
    }
}

/// Puts an object at the end of a cell's first block, and before its other cells.
void CellObjects::add(uint32_t row, const Box3f& box, uint32_t cell) {
    SIGHTLINE_DEBUG_ASSERT(cell < now_.first.size() && row < first_of_.size());
    SIGHTLINE_DEBUG_ASSERT(first_of_[row] == kNone || stands_[first_of_[row]].cell > cell);
    uint32_t block = now_.first[cell];
    if (block == CellBlock::kNone || now_.blocks[block].used == 8) {
        CellBlock fresh;
        fresh.next = block;
        if (free_blocks_.empty()) {
            block = now_.blocks.size();
            now_.blocks.push_back(fresh);
        } else {
            block = free_blocks_.back();
            free_blocks_.pop_back();
            now_.blocks.set(block, fresh);
        }
        now_.first.set(cell, block);
    }
    ++now_.count.change(cell);
    ++now_.stands;
    CellBlock& in = now_.blocks.change(block);
    SIGHTLINE_DEBUG_ASSERT(in.used < 8);
    const uint32_t lane = in.used++;
    in.row[lane] = row;
    setBox(in, lane, box);
    if (free_stands_.empty()) {
        free_stands_.push_back(static_cast<uint32_t>(stands_.size()));
        stands_.emplace_back();
    }
    const uint32_t at = free_stands_.back();
    free_stands_.pop_back();
    stands_[at] = {cell, 8 * block + lane, first_of_[row]};
    first_of_[row] = at;
}

/// Fills a place with the last one of the cell's first block.
void CellObjects::removeAt(uint32_t cell, uint32_t at) {
    SIGHTLINE_DEBUG_ASSERT(now_.count[cell] > 0 && now_.stands > 0);
    --now_.count.change(cell);
    --now_.stands;
    const uint32_t first = now_.first[cell];
    CellBlock& from = now_.blocks.change(first);
    SIGHTLINE_DEBUG_ASSERT(from.used > 0 && from.used <= 8);
    const uint32_t lane = --from.used;
    if (at != 8 * first + lane) {
        const uint32_t row = from.row[lane];
        Box3f box;
        for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = from.min[axis][lane];
            box.max[axis] = from.max[axis][lane];
        }
        CellBlock& to = now_.blocks.change(at / 8);
        to.row[at % 8] = row;
        setBox(to, at % 8, box);
        standOf(row, cell).at = at;
    }
    const CellBlock& left = now_.blocks[first];
    if (left.used > 0) return;
    now_.first.set(cell, left.next);
    free_blocks_.push_back(first);
}

CellObjects::Stand& CellObjects::standOf(uint32_t row, uint32_t cell) {
    SIGHTLINE_DEBUG_ASSERT(row < first_of_.size());
    uint32_t at = first_of_[row];
    while (at != kNone && stands_[at].cell != cell) at = stands_[at].next;
    SIGHTLINE_ASSERT(at != kNone);
    return stands_[at];
}

CellLists CellObjects::share() {
    CellLists shared(memory_);
    shared.first = now_.first.share();
    shared.blocks = now_.blocks.share();
    shared.count = now_.count.share();
    shared.stands = now_.stands;
    return shared;
}

}  // namespace sightline::detail
