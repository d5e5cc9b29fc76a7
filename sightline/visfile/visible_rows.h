// Which cells see one another, in tiles of bits: any row, and any pair, straight from the bytes.
// SPDX-License-Identifier: MIT
//
// Guy Jacobson. Space-efficient Static Trees and Graphs. 1989 (rank).
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <string_view>

#include "sightline/base/bit_matrix.h"
#include "sightline/base/array.h"
#include "sightline/base/result.h"
#include "sightline/visfile/placed_numbers.h"

namespace sightline {

namespace tiled_rows {

/// The bytes: numbers of cells, of classes and of stored tiles, and a zero, of 4 bytes each; then the arrays below,
/// without gaps.
///
/// Cells with equal rows are one class. The matrix of classes, in the order of orderRows(), is cut into tiles of 8 x
/// 8 bits, bit 8 * row + column; of two tiles that mirror each other the one below the diagonal counts. Tile (R, C),
/// C <= R, is number R * (R + 1) / 2 + C; it is all zero, or full, or stored. Bits of classes that there are not do
/// not count.
struct Layout {
    static constexpr uint64_t kMixedAt = 16;  ///< bit per tile: stored  [64-bit words]
    uint64_t full_at = 0;                     ///< bit per tile: all ones  [64-bit words]
    uint64_t tiles_at = 0;                    ///< the stored tiles  [64 bits each]
    uint64_t rank_at = 0;                     ///< per word of `mixed`: ones before it  [32 bits each]
    uint64_t class_at = 0;                    ///< per cell: its class  [16 bits each]
    uint64_t first_at =
        0;  ///< per class: where its cells begin in the list of cells; then their number  [16 bits each]
    uint64_t cells_at = 0;  ///< list of cells: class by class, ascending in each  [16 bits each]
    uint64_t end = 0;       ///< [bytes]
    uint32_t side = 0;      ///< tiles in a row of the whole matrix
    uint32_t words = 0;     ///< of `mixed`

    /// @pre cells, classes <= kMostOrderedRows
    Layout(uint32_t cells, uint32_t classes, uint32_t stored);
};

/// Where row R of tiles begins.
constexpr uint32_t rowOfTiles(uint32_t row) { return row * (row + 1) / 2; }

/// The arrays, where they lie.
struct Parts {
    PlacedNumbers<uint64_t> mixed, full, tiles;
    PlacedNumbers<uint32_t> rank;
    PlacedNumbers<uint16_t> class_of, first, cell_at;

    uint64_t tile(uint32_t number) const {
        const uint32_t word = number / 64, bit = number % 64;
        const uint64_t stored = mixed[word];
        if (stored >> bit & 1)
            return tiles[rank[word] + static_cast<uint32_t>(std::popcount(stored & ((uint64_t{1} << bit) - 1)))];
        return full[word] >> bit & 1 ? ~uint64_t{0} : 0;
    }
};

}  // namespace tiled_rows

/// A look at the tiled form of a matrix that is symmetric and has a diagonal of ones. It has no memory of its own: the
/// bytes must outlive it. Any number of threads may ask at once.
class VisibleRows {
public:
    VisibleRows() = default;
    /// Looks at every number, so that no question can lead outside of the bytes. O(bytes).
    /// @param bytes  as tiledRows() wrote them, at any address
    /// @param file   what errors call them
    /// @param at     their place in it
    /// Errors (kInput): one line with the file, what is wrong, and at which byte.
    static Result<VisibleRows> open(std::span<const char> bytes, std::string_view file, uint64_t at = 0);

    uint32_t cells() const { return cells_; }
    /// How many different rows there are.
    uint32_t classes() const { return classes_; }
    size_t bytes() const { return bytes_; }

    /// O(1).
    /// @pre a, b < cells()
    bool sees(uint32_t a, uint32_t b) const;
    /// Writes a cell's row: bit i % 64 of word i / 64 is whether it sees cell i. O(cells / 64 + classes / 8 + what it
    /// sees).
    /// @pre  cell < cells()
    /// @param out  [size: (cells() + 63) / 64]
    void row(uint32_t cell, std::span<uint64_t> out) const;

    const tiled_rows::Parts& parts() const { return parts_; }

private:
    void spread(uint32_t column, uint64_t bits, uint64_t* out) const;

    uint32_t cells_ = 0, classes_ = 0, side_ = 0;
    size_t bytes_ = 0;
    tiled_rows::Parts parts_;
};

/// The tiled form of a matrix: the same bytes for the same matrix, on every machine.
/// Errors (kUsage): the matrix is not square, not symmetric, has a zero on its diagonal, or more rows than
/// kMostOrderedRows.
Result<Array<char>> tiledRows(const BitMatrix& visible, Memory* memory = defaultMemory());

}  // namespace sightline
