// Which objects stand in which cell: lists of boxes, eight side by side, in pages that snapshots share.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "sightline/base/array.h"
#include "sightline/base/paged.h"
#include "sightline/math/box.h"

namespace sightline::detail {

/// Up to eight objects of a cell, relative to AttachedCells::origin.
struct CellBlock {
    static constexpr uint32_t kNone = ~0u;
    alignas(64) float min[3][8] = {};
    float max[3][8] = {};
    uint32_t row[8] = {};   ///< the world's
    uint32_t next = kNone;  ///< the next block of the same cell, which is full
    uint32_t used = 0;      ///< the first so many
};

/// For reading. The blocks of cell c are first[c], its next one, and so on.
struct CellLists {
    Paged<uint32_t, 256> first;
    Paged<CellBlock, 8> blocks;
    Paged<uint32_t, 256> count;  ///< per cell how many stand in it
    uint64_t stands = 0;         ///< in all cells together

    explicit CellLists(Memory* memory) : first(memory), blocks(memory), count(memory) {}
};

/// The lists as they change. An object stands in any number of cells.
class CellObjects {
public:
    explicit CellObjects(Memory* memory);

    /// Empties all lists.
    void reset(uint32_t cells);
    /// Puts an object into cells, and takes it out of all others.  O(its cells), and O(cells of those whose places it
    /// takes).
    /// @param box    relative to the origin
    /// @param cells  each once, rising
    void put(uint32_t row, const Box3f& box, std::span<const uint32_t> cells);
    void take(uint32_t row);

    const CellLists& now() const { return now_; }
    /// As it is now. O(cells / 256 + objects / 64).
    CellLists share();

private:
    static constexpr uint32_t kNone = ~0u;
    /// Where an object stands in one cell. The stands of one object are linked, by rising cells.
    struct Stand {
        uint32_t cell = 0;
        uint32_t at = 0;  ///< block * 8 + its place in it
        uint32_t next = kNone;
    };

    bool standsIn(uint32_t row, std::span<const uint32_t> cells) const;
    void add(uint32_t row, const Box3f& box, uint32_t cell);
    void removeAt(uint32_t cell, uint32_t at);
    Stand& standOf(uint32_t row, uint32_t cell);

    Memory* const memory_;
    CellLists now_;
    Array<uint32_t> first_of_;  ///< per row: its first stand
    Array<Stand> stands_;
    Array<uint32_t> free_stands_, free_blocks_;
};

}  // namespace sightline::detail
