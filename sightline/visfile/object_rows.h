// The section of cell-to-object visibility: which objects are seen from the cells of a row.
// SPDX-License-Identifier: MIT
//
// Seth Teller, Carlo Sequin. Visibility Preprocessing for Interactive Walkthroughs. 1991.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "sightline/base/bit_matrix.h"
#include "sightline/base/array.h"
#include "sightline/base/result.h"
#include "sightline/visfile/placed_parts.h"
#include "sightline/visfile/section_file.h"

namespace sightline {

namespace visibility_file {

/// rows, kinds of equal rows: 4 bytes each; objects, words: 8 bytes each; per row its kind (4), with zero up to a
/// multiple of 8; per kind a bit for each word of 64 objects that is not zero, and where its words end (8); the words.
inline constexpr uint32_t kObjectRows = section_file::tagOf("orow");

}  // namespace visibility_file

/// @param visible  [rows x objects]; of each row only the words that are not zero are written, equal rows once
Array<char> objectRowsSection(const BitMatrix& visible, Memory* memory = defaultMemory());

/// Rows where they lie.
class PlacedObjectRows {
public:
    PlacedObjectRows() = default;
    /// @param rows     of cells, in the file
    /// @param objects  in the file
    /// @param file     what errors call the bytes
    /// @param at       their place in it
    /// Errors (kInput): one line with the file, what is wrong, and at which byte.
    static Result<PlacedObjectRows> open(std::span<const char> bytes, uint32_t rows, uint64_t objects,
                                         std::string_view file, uint64_t at = 0);

    uint32_t rows() const { return static_cast<uint32_t>(kind_of_.size()); }
    uint32_t kinds() const { return static_cast<uint32_t>(ends_.size()); }
    /// A bit for each object, by PlacedObjects' index. O(objects / 64).
    /// @pre row < rows()
    /// @param out  [size: (objects + 63) / 64]
    void row(uint32_t row, std::span<uint64_t> out) const;

private:
    uint64_t marks_per_kind_ = 0;
    PlacedNumbers<uint32_t> kind_of_;
    PlacedNumbers<uint64_t> marks_, ends_, words_;
};

}  // namespace sightline
