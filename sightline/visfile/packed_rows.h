// The tiled form of visibility rows as few bytes: for the disk, to be unpacked before it answers.
// SPDX-License-Identifier: MIT
//
// Glen Langdon, Jorma Rissanen. Compression of Black-White Images with Arithmetic Coding. 1981.
#pragma once

#include <span>
#include <string_view>

#include "sightline/base/array.h"
#include "sightline/base/result.h"
#include "sightline/visfile/visible_rows.h"

namespace sightline {

/// The bytes: numbers of cells and of classes, of 4 bytes each; then, as coded bits, the list of cells by their
/// steps, and row by row of tiles first what each tile is, by its four neighbours that are known, and then the bits
/// of the stored ones, by the bits around them. A tile on the diagonal is coded below it alone.
Array<char> packedRows(const VisibleRows& rows, Memory* memory = defaultMemory());

/// The tiled form again, byte for byte. Whatever the bytes are, it ends: after at most some 2,800 steps for each of
/// them. What it gives back is still to be opened by VisibleRows::open().
/// @param file  what errors call the bytes
/// @param at    their place in it
/// Errors (kInput): one line with the file, what is wrong, and at which byte.
Result<Array<char>> unpackedRows(std::span<const char> bytes, std::string_view file, uint64_t at = 0,
                                 Memory* memory = defaultMemory());

}  // namespace sightline
