// Which cell each leaf of a map belongs to, for the file: in place, and packed.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "sightline/base/array.h"
#include "sightline/base/result.h"

namespace sightline {

/// How a leaf without a cell is written: numbers of cells have 16 bits.
inline constexpr uint16_t kNoCellInFile = 65535;

/// Numbers of 16 bits, little-endian.
/// @param cell_of_leaf  each CellGraph::kNoCell or below kNoCellInFile
Array<char> leafCells(std::span<const uint32_t> cell_of_leaf, Memory* memory = defaultMemory());

/// The same as few bytes: the number of leaves in 4 bytes, and as coded bits each leaf by those before it: most
/// belong to the same cell as the last, or to the first one that no leaf belonged to yet.
Array<char> packedLeafCells(std::span<const uint32_t> cell_of_leaf, Memory* memory = defaultMemory());

/// What leafCells() gave. What the numbers are is still to be looked at.
/// @param file  what errors call the bytes
/// @param at    their place in it
/// Errors (kInput): one line with the file, what is wrong, and at which byte.
Result<Array<char>> unpackedLeafCells(std::span<const char> bytes, std::string_view file, uint64_t at = 0,
                                      Memory* memory = defaultMemory());

}  // namespace sightline
