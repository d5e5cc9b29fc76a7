// A grid of loose cells for swarms: what moves is put into another cell in a few nanoseconds, and empty space is nothing.
// SPDX-License-Identifier: MIT
//
// Thatcher Ulrich. Loose Octrees. Game Programming Gems, 2000.
#include "sightline/studies/frustum/grid.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/math/round_outward.h"

namespace sightline::studies {
namespace {

// A key is the level, then 16 bits of each coordinate; that of a block has its cells' without their last two bits.
constexpr uint64_t kBlockBits = 0xfffcull << 32 | 0xfffcull << 16 | 0xfffcull;

uint64_t blockKey(uint64_t key) { return key & (0xffull << 48 | kBlockBits); }
uint32_t cellInBlock(uint64_t key) {
    return static_cast<uint32_t>((key >> 32 & 3) | (key >> 16 & 3) << 2 | (key & 3) << 4);
}
uint32_t levelOf(uint64_t key) { return static_cast<uint32_t>(key >> 48); }

uint64_t mix(uint64_t key) {
    key *= 0x9e3779b97f4a7c15ull;
    return key ^ key >> 32;
}

}  // namespace

Grid::Grid(double cell, const glm::dvec3& origin, Memory* memory)
    : memory_(memory),
      origin_(origin),
      items_(memory),
      free_items_(memory),
      unbounded_(memory),
      chunks_(memory),
      free_chunks_(memory),
      blocks_(memory),
      free_blocks_(memory),
      levels_(memory),
      table_(memory) {
    SIGHTLINE_ASSERT(cell > 0.0 && std::isfinite(cell));
    levels_.reserve(kLevels);
    for (uint32_t level = 0; level < kLevels; ++level) {
        width_[level] = std::ldexp(cell, static_cast<int>(level));
        per_width_[level] = 1.0 / width_[level];
        levels_.emplace_back(memory);
    }
    table_.resize(64);
}

void Grid::reserve(uint32_t items) {
    items_.reserve(items);
    chunks_.reserve(items / 4 + 1);
}

/// The cell of a box; kNoKey if there is none.
uint64_t Grid::cellKey(const Box3d& box) const {
    double center[3], size = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        center[axis] = 0.5 * (box.min[axis] - origin_[axis]) + 0.5 * (box.max[axis] - origin_[axis]);
        const double extent = box.max[axis] - box.min[axis];
        if (!(extent >= 0.0)) return kNoKey;
        size = std::max(size, extent);
    }
    uint32_t level = 0;
    while (level < kLevels && !(size <= width_[level])) ++level;
    for (; level < kLevels; ++level) {
        uint64_t key = level;
        bool within = true;
        for (double c : center) {
            const double at = c * per_width_[level] + kReach;
            within &= at >= 0.0 && at < 2.0 * kReach;
            key = key << 16 | (within ? static_cast<uint64_t>(static_cast<int64_t>(at)) : 0);
        }
        if (within) return key;
    }
    return kNoKey;
}

void Grid::cellOfKey(uint64_t block_key, int32_t (&at)[3]) {
    for (int axis = 0; axis < 3; ++axis)
        at[axis] = static_cast<int32_t>(block_key >> (32 - 16 * axis) & 0xffff) - kReach;
}

uint32_t Grid::insert(const Box3d& box) {
    uint32_t item;
    if (!free_items_.empty()) {
        item = free_items_.back();
        free_items_.pop_back();
    } else {
        item = static_cast<uint32_t>(items_.size());
        items_.emplace_back();
    }
    if (count_++ == 0) reach_ = 0.0f;
    enter(item, box, cellKey(box));
    return item;
}

bool Grid::move(uint32_t item, const Box3d& box) {
    if (!contains(item)) return false;
    const uint64_t key = cellKey(box);
    if (items_[item].key == key && key != kNoKey) {
        write(items_[item], relativeBox(box, origin_));
        return true;
    }
    leave(item);
    enter(item, box, key);
    return true;
}

bool Grid::remove(uint32_t item) {
    if (!contains(item)) return false;
    leave(item);
    items_[item].key = kFreeKey;
    free_items_.push_back(item);
    --count_;
    return true;
}

Box3f Grid::storedBox(uint32_t item) const {
    SIGHTLINE_ASSERT(contains(item));
    Box3f box;
    if (items_[item].key == kNoKey) return box;
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = items_[item].min[axis];
        box.max[axis] = items_[item].max[axis];
    }
    return box;
}

void Grid::write(GridItem& item, const Box3f& box) {
    float reach = reach_;
    for (int axis = 0; axis < 3; ++axis) {
        item.min[axis] = box.min[axis];
        item.max[axis] = box.max[axis];
        reach = std::max(reach, std::max(-box.min[axis], box.max[axis]));
    }
    reach_ = reach;
}

void Grid::enter(uint32_t item, const Box3d& box, uint64_t key) {
    items_[item].key = key;
    if (key == kNoKey) {
        items_[item].place = static_cast<uint32_t>(unbounded_.size());
        unbounded_.push_back(item);
        return;
    }
    write(items_[item], relativeBox(box, origin_));
    enterCell(item, key);
}

void Grid::enterCell(uint32_t item, uint64_t key) {
    const uint32_t index = findOrMakeBlock(blockKey(key));
    const uint32_t in_block = cellInBlock(key);
    GridBlock& block = blocks_[index];
    const bool used = block.used >> in_block & 1;
    if (!used || chunks_[block.first[in_block]].count == 8) {
        const uint32_t made = newChunk();
        GridChunk& chunk = chunks_[made];
        chunk.cell = index * 64 + in_block;
        chunk.next = used ? block.first[in_block] : kNone;
        chunk.count = 0;
        block.first[in_block] = made;
        block.used |= uint64_t{1} << in_block;
    }
    const uint32_t first = block.first[in_block];
    GridChunk& chunk = chunks_[first];
    items_[item].place = first * 8 + chunk.count;
    chunk.item[chunk.count++] = item;
}

/// Takes an item from where it is; the last of the cell's first chunk takes its place.
void Grid::leave(uint32_t item) {
    const uint32_t place = items_[item].place;
    if (items_[item].key == kNoKey) {
        const uint32_t last = unbounded_.back();
        unbounded_[place] = last;
        items_[last].place = place;
        unbounded_.pop_back();
        return;
    }
    const uint32_t cell = chunks_[place / 8].cell;
    uint32_t& first = blocks_[cell / 64].first[cell % 64];
    GridChunk& chunk = chunks_[first];
    const uint32_t last = --chunk.count;
    if (first * 8 + last != place) {
        chunks_[place / 8].item[place % 8] = chunk.item[last];
        items_[chunk.item[last]].place = place;
    }
    if (last > 0) return;
    free_chunks_.push_back(first);
    if (chunk.next != kNone) first = chunk.next;
    else dropCell(cell, items_[item].key);
}

void Grid::dropCell(uint32_t cell, uint64_t key) {
    GridBlock& block = blocks_[cell / 64];
    block.used &= ~(uint64_t{1} << cell % 64);
    if (block.used == 0) freeBlock(cell / 64, blockKey(key));
}

uint32_t Grid::newChunk() {
    if (free_chunks_.empty()) {
        chunks_.emplace_back();
        return static_cast<uint32_t>(chunks_.size() - 1);
    }
    const uint32_t index = free_chunks_.back();
    free_chunks_.pop_back();
    return index;
}

/// Where a key is in the table, or would be.
size_t Grid::slotOf(uint64_t key) const {
    const size_t last = table_.size() - 1;
    size_t slot = mix(key) & last;
    while (table_[slot].key != key && table_[slot].key != kNoKey) slot = (slot + 1) & last;
    return slot;
}

uint32_t Grid::findBlock(uint32_t level, const int32_t (&at)[3]) const {
    uint64_t key = level;
    for (int32_t block : at) key = key << 16 | static_cast<uint64_t>(block * 4 + kReach);
    const Hashed& found = table_[slotOf(key)];
    return found.key == key ? found.block : kNone;
}

uint32_t Grid::findOrMakeBlock(uint64_t key) {
    size_t slot = slotOf(key);
    if (table_[slot].key == key) return table_[slot].block;
    if (2 * (in_table_ + 1) > table_.size()) {
        growTable();
        slot = slotOf(key);
    }
    uint32_t index;
    if (!free_blocks_.empty()) {
        index = free_blocks_.back();
        free_blocks_.pop_back();
    } else {
        index = static_cast<uint32_t>(blocks_.size());
        SIGHTLINE_ASSERT(index < 1u << 26);
        blocks_.emplace_back();
    }
    table_[slot] = {key, index};
    ++in_table_;
    Level& level = levels_[levelOf(key)];
    int32_t at[3];
    cellOfKey(key, at);
    for (int axis = 0; axis < 3; ++axis) {
        const bool first = level.blocks.empty();
        level.low[axis] = first ? at[axis] >> 2 : std::min(level.low[axis], at[axis] >> 2);
        level.high[axis] = first ? at[axis] >> 2 : std::max(level.high[axis], at[axis] >> 2);
    }
    blocks_[index].listed = static_cast<uint32_t>(level.blocks.size());
    level.blocks.push_back({key, index});
    return index;
}

/// Takes a block without cells away, and closes the gap that it leaves in the table.
void Grid::freeBlock(uint32_t index, uint64_t key) {
    Level& level = levels_[levelOf(key)];
    const uint32_t listed = blocks_[index].listed;
    level.blocks[listed] = level.blocks.back();
    blocks_[level.blocks[listed].block].listed = listed;
    level.blocks.pop_back();
    free_blocks_.push_back(index);
    --in_table_;
    const size_t last = table_.size() - 1;
    size_t gap = slotOf(key);
    for (size_t slot = (gap + 1) & last; table_[slot].key != kNoKey; slot = (slot + 1) & last) {
        const size_t home = mix(table_[slot].key) & last;
        // What has its home behind the gap may not be moved before it.
        if (((slot - home) & last) < ((slot - gap) & last)) continue;
        table_[gap] = table_[slot];
        gap = slot;
    }
    table_[gap].key = kNoKey;
}

void Grid::growTable() {
    Array<Hashed> old(memory_);
    old.swap(table_);
    table_.resize(old.size() * 2);
    for (const Hashed& entry : old)
        if (entry.key != kNoKey) table_[slotOf(entry.key)] = entry;
}

}  // namespace sightline::studies
