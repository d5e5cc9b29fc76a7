// A grid of loose cells for swarms: what moves is put into another cell in a few nanoseconds, and empty space is nothing.
// SPDX-License-Identifier: MIT
//
// Thatcher Ulrich. Loose Octrees. Game Programming Gems, 2000.
// Daniel Collin. Culling the Battlefield: Data Oriented Design in Practice. Game Developers Conference, 2011.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "sightline/base/array.h"
#include "sightline/geom/frustum.h"
#include "sightline/math/box.h"

namespace sightline::studies {

/// Eight items of a cell: one line of the cache. Their boxes stand by the items, so that a move within a cell touches
/// nothing else.
struct alignas(64) GridChunk {
    uint32_t item[8];
    uint32_t cell;   ///< block * 64 + place in the block
    uint32_t next;   ///< another chunk of the cell, which is full; or Grid::kNone
    uint32_t count;  ///< the first chunk of a cell has 1 to 8, the others 8
};

/// An item of a grid.
struct GridItem {
    float min[3];
    float max[3];
    uint32_t place = 0;  ///< chunk * 8 + lane
    uint64_t key = 0;    ///< of its cell
};

/// 4 x 4 x 4 cells, of which at least one is in use.
struct GridBlock {
    uint64_t used = 0;   ///< bit per cell; the cell at (x, y, z) in the block is bit x + 4 * y + 16 * z
    uint32_t first[64];  ///< per cell in use: its first chunk
    uint32_t listed = 0;
};

/// Items are boxes in world space around an origin, in cells by their centers. A cell's loose bounds are twice as wide as
/// itself and hold its items wholly; what is larger than a cell is in a level of cells twice as wide, and so on. Levels,
/// blocks of cells and cells are there only while they hold items.
///
/// A box that is NaN, infinite, empty, or beyond all levels is kept apart: unbounded(). Deterministic; not thread-safe.
class Grid {
public:
    static constexpr uint32_t kNone = ~0u;
    static constexpr uint32_t kLevels = 24;
    static constexpr double kLoose = 0.5 + 0x1p-6;  ///< of a cell's width, on each side; the rest is for rounding

    /// Blocks of a level, and the box of block coordinates that they have been in since the level was last empty.
    struct Level {
        struct Listed {
            uint64_t key = 0;
            uint32_t block = 0;
        };
        Array<Listed> blocks;
        int32_t low[3], high[3];
        explicit Level(Memory* memory) : blocks(memory) {}
    };

    /// @param cell    width of the smallest cells; twice what most items measure is good  [world units, > 0]
    /// @param origin  near the middle of the world
    explicit Grid(double cell, const glm::dvec3& origin = glm::dvec3(0.0), Memory* memory = defaultMemory());

    /// Room for so many items, so that none of the first calls is long.
    void reserve(uint32_t items);
    /// @returns the item's number; those of removed items are handed out again
    uint32_t insert(const Box3d& box);
    /// False if there is no such item.
    bool move(uint32_t item, const Box3d& box);
    bool remove(uint32_t item);

    uint32_t size() const { return count_; }
    bool contains(uint32_t item) const { return item < items_.size() && items_[item].key != kFreeKey; }
    /// Relative to the origin, rounded outward as roundOutward() does; empty if it is unbounded. @pre contains(item)
    Box3f storedBox(uint32_t item) const;
    const Array<uint32_t>& unbounded() const { return unbounded_; }

    // For queries
    const glm::dvec3& origin() const { return origin_; }
    double cellWidth(uint32_t level) const { return width_[level]; }
    const Level& level(uint32_t level) const { return levels_[level]; }
    const GridBlock& block(uint32_t index) const { return blocks_[index]; }
    const GridChunk& chunk(uint32_t index) const { return chunks_[index]; }
    const GridItem& item(uint32_t index) const { return items_[index]; }
    /// The block at block coordinates, each -kReach / 4 to kReach / 4 - 1; or kNone.
    uint32_t findBlock(uint32_t level, const int32_t (&at)[3]) const;
    /// No bound has been farther from the origin on any axis since the grid was last empty.
    float reach() const { return reach_; }

    static constexpr int32_t kReach = 1 << 15;  ///< cells are numbered from -kReach to kReach - 1 on each axis
    /// The first cell of a block, by its key.
    static void cellOfKey(uint64_t block_key, int32_t (&at)[3]);

private:
    static constexpr uint64_t kNoKey = ~uint64_t{0};  ///< in GridItem::key: unbounded; `place` is its place there
    static constexpr uint64_t kFreeKey = kNoKey - 1;  ///< in GridItem::key: there is no such item

    struct Hashed {
        uint64_t key = kNoKey;
        uint32_t block = 0;
    };

    uint64_t cellKey(const Box3d& box) const;
    void enter(uint32_t item, const Box3d& box, uint64_t key);
    void enterCell(uint32_t item, uint64_t key);
    void leave(uint32_t item);
    void dropCell(uint32_t cell, uint64_t key);
    void write(GridItem& item, const Box3f& box);
    uint32_t newChunk();
    uint32_t findOrMakeBlock(uint64_t key);
    void freeBlock(uint32_t index, uint64_t key);
    void growTable();
    size_t slotOf(uint64_t key) const;

    Memory* memory_;
    glm::dvec3 origin_;
    double width_[kLevels], per_width_[kLevels];
    float reach_ = 0;
    uint32_t count_ = 0;
    Array<GridItem> items_;
    Array<uint32_t> free_items_, unbounded_;
    Array<GridChunk> chunks_;
    Array<uint32_t> free_chunks_;
    Array<GridBlock> blocks_;
    Array<uint32_t> free_blocks_;
    Array<Level> levels_;
    Array<Hashed> table_;  ///< by key, linear probing  [size: a power of two, at least twice the blocks]
    uint32_t in_table_ = 0;
};

/// What a query of a grid did.
struct GridStats {
    uint64_t blocks = 0;        ///< of 64 cells, whose bounds were tested
    uint64_t cells = 0;         ///< in use and in the frustum's bounds: the only ones that were looked at
    uint64_t inside_cells = 0;  ///< whose items were kept without a test
    uint64_t items = 0;         ///< that were tested
};

/// The box around what a frustum and the cells in use have in common: what lies beside it is not looked at.
Box3d gridQueryBounds(const Frustum& frustum, const Grid& grid);

/// Writes the numbers of the items that may touch the frustum, and of all that are unbounded, and returns how many. The
/// order hangs on the grid alone. The set is, to the bit, that of cullFrustum() over the stored boxes without those that
/// lie beside gridQueryBounds(). Needs no memory.
/// Costs nothing for empty space and for cells that the frustum's bounds do not touch; for the latter to matter, the
/// view must have a far plane or the world must end.
/// @param kept  [size: >= grid.size() + 8]
size_t cullGrid(const Frustum& frustum, const Grid& grid, std::span<uint32_t> kept, GridStats* stats = nullptr);

}  // namespace sightline::studies
