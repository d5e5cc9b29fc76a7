// Rows of a visibility matrix by classes of equal ones, and an order of classes in which neighbours differ little.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/base/bit_matrix.h"
#include "sightline/base/array.h"

namespace sightline {

/// Rows are numbered with 16 bits.
inline constexpr size_t kMostOrderedRows = 65535;

struct RowOrder {
    Array<uint16_t> cell_at;  ///< every row's number, class by class, ascending within each  [size: rows]
    Array<uint16_t> first;    ///< per class its first place in cell_at, and the number of rows  [size: classes + 1]

    explicit RowOrder(Memory* memory = defaultMemory()) : cell_at(memory), first(memory) {}
    size_t classes() const { return first.size() - 1; }
};

/// Classes in the order of a greedy walk: from that of row 0, always on to the class that differs in the fewest bits
/// from the one before, of several the one with the smallest row. What is seen alike comes to lie together, whatever
/// the rows' numbers are, so that the matrix falls apart into blocks of zeros, blocks of ones, and little else.
///
/// O(classes^2 * words), of which most is spared by the numbers of ones; of more than 4096 classes not yet placed
/// only the first 4096 are looked at.
/// @param rows  at most kMostOrderedRows
RowOrder orderRows(const BitMatrix& rows, Memory* memory = defaultMemory());

}  // namespace sightline
