// Answers from tiles of bits, and what is looked at before the first.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/visible_rows.h"

#include <algorithm>
#include <bit>

#include "sightline/base/bytes.h"
#include "sightline/visfile/row_order.h"
#include "sightline/visfile/section_file.h"

namespace sightline {

using namespace tiled_rows;

Layout::Layout(uint32_t cells, uint32_t classes, uint32_t stored)
    : side((classes + 7) / 8), words((rowOfTiles(side) + 63) / 64) {
    full_at = kMixedAt + 8 * uint64_t{words};
    tiles_at = full_at + 8 * uint64_t{words};
    rank_at = tiles_at + 8 * uint64_t{stored};
    class_at = rank_at + 4 * uint64_t{words};
    first_at = class_at + 2 * uint64_t{cells};
    cells_at = first_at + 2 * (uint64_t{classes} + 1);
    end = cells_at + 2 * uint64_t{cells};
}

namespace {

/// The bits of column `column` of a tile, one after the other.
uint64_t columnOf(uint64_t tile, uint32_t column) {
    return (tile >> column & 0x0101010101010101ull) * 0x0102040810204080ull >> 56;
}

}  // namespace

bool VisibleRows::sees(uint32_t a, uint32_t b) const {
    const uint32_t i = parts_.class_of[a], j = parts_.class_of[b], row = std::max(i, j), column = std::min(i, j);
    return parts_.tile(rowOfTiles(row / 8) + column / 8) >> (8 * (row % 8) + column % 8) & 1;
}

void VisibleRows::spread(uint32_t column, uint64_t bits, uint64_t* out) const {
    if (column + 1 == side_) bits &= 0xffu >> (8 * side_ - classes_);
    for (; bits != 0; bits &= bits + (bits & -bits)) {  // a run of ones a turn: their cells lie side by side
        const uint32_t begin = 8 * column + static_cast<uint32_t>(std::countr_zero(bits));
        const uint32_t end = begin + static_cast<uint32_t>(std::countr_one(bits >> (begin - 8 * column)));
        for (uint32_t i = parts_.first[begin], last = parts_.first[end]; i < last; ++i) {
            const uint32_t cell = parts_.cell_at[i];
            out[cell / 64] |= uint64_t{1} << cell % 64;
        }
    }
}

void VisibleRows::row(uint32_t cell, std::span<uint64_t> out) const {
    std::fill(out.begin(), out.end(), 0);
    const uint32_t of = parts_.class_of[cell], row = of / 8, within = of % 8;
    // To the diagonal along the row of tiles, where most are neither stored nor full;
    const uint32_t begin = rowOfTiles(row), end = begin + row + 1;
    for (uint32_t word = begin / 64; word <= (end - 1) / 64; ++word) {
        const uint64_t mixed = parts_.mixed[word];
        uint64_t some = mixed | parts_.full[word];
        if (word == begin / 64) some &= ~uint64_t{0} << begin % 64;
        if (word == (end - 1) / 64) some &= ~uint64_t{0} >> (63 - (end - 1) % 64);
        for (; some != 0; some &= some - 1) {
            const uint32_t bit = static_cast<uint32_t>(std::countr_zero(some));
            uint64_t bits = 0xff;
            if (mixed >> bit & 1)
                bits = parts_.tiles[parts_.rank[word] +
                                    static_cast<uint32_t>(std::popcount(mixed & ((uint64_t{1} << bit) - 1)))] >>
                           8 * within &
                       0xff;
            spread(64 * word + bit - begin, bits, out.data());
        }
    }
    // and on from it along a column, mirrored.
    for (uint32_t below = row + 1, number = rowOfTiles(below) + row; below < side_; number += ++below)
        if (const uint64_t bits = parts_.tile(number)) spread(below, columnOf(bits, within), out.data());
}

namespace {

/// Whether the first `count` rows and columns mirror each other, with ones on the diagonal.
bool isSymmetric(uint64_t tile, uint32_t count) {
    const uint64_t real = 0xffu >> (8 - count);
    for (uint32_t i = 0; i < count; ++i)
        if (((tile >> 8 * i ^ columnOf(tile, i)) & real) != 0 || (tile >> 9 * i & 1) == 0) return false;
    return true;
}

/// What is wrong with bytes that say they are a tiled form.
struct Fault {
    const char* what = nullptr;
    uint64_t at = 0;
};

Fault faultOfTiles(const Parts& parts, const Layout& layout, uint32_t stored) {
    uint64_t before = 0;
    const uint32_t tiles = rowOfTiles(layout.side);
    for (uint32_t word = 0; word < layout.words; ++word) {
        const uint64_t mixed = parts.mixed[word], full = parts.full[word];
        if (mixed & full) return {"a tile that is full and stored", layout.full_at + 8 * uint64_t{word}};
        if (word + 1 == layout.words && tiles % 64 != 0 && (mixed | full) >> tiles % 64 != 0)
            return {"tiles behind the last", Layout::kMixedAt + 8 * uint64_t{word}};
        if (parts.rank[word] != before) return {"a wrong count of tiles", layout.rank_at + 4 * uint64_t{word}};
        before += static_cast<uint64_t>(std::popcount(mixed));
    }
    return before == stored ? Fault{} : Fault{"not the number of tiles that are marked as stored", 8};
}

Fault faultOfClasses(const Parts& parts, const Layout& layout, uint32_t cells, uint32_t classes) {
    for (uint32_t of = 0; of < classes; ++of) {
        const uint32_t begin = parts.first[of], end = parts.first[of + 1];
        if ((of == 0 && begin != 0) || begin >= end || end > cells)
            return {"a class without cells, or with more than there are", layout.first_at + 2 * uint64_t{of}};
        for (uint32_t i = begin, last = 0; i < end; last = parts.cell_at[i++]) {
            const uint32_t cell = parts.cell_at[i];
            if (cell >= cells || parts.class_of[cell] != of || (i > begin && cell <= last))
                return {"a cell that is not of its class", layout.cells_at + 2 * uint64_t{i}};
        }
    }
    // Each place holds a cell of its class, no class holds one twice: all are there if there are as many.
    if (parts.first[classes] != cells) return {"cells without a class", layout.first_at + 2 * uint64_t{classes}};
    return {};
}

}  // namespace

Result<VisibleRows> VisibleRows::open(std::span<const char> bytes, std::string_view file, uint64_t at) {
    if (bytes.size() < Layout::kMixedAt) return faultAt(file, "rows that end within their head", at + bytes.size());
    ByteCursor head(bytes);
    const uint32_t cells = head.take<uint32_t>(), classes = head.take<uint32_t>(), stored = head.take<uint32_t>();
    if (cells > kMostOrderedRows) return faultAt(file, "more cells than there may be", at);
    if (classes > cells) return faultAt(file, "more classes than cells", at + 4);
    if (head.take<uint32_t>() != 0) return faultAt(file, "a mark that is not known", at + 12);
    const Layout layout(cells, classes, stored);
    if (layout.end != bytes.size()) return faultAt(file, "rows that are not as long as they say", at);
    const auto part = [&](uint64_t begin, uint64_t end) { return bytes.subspan(begin, end - begin); };
    Parts parts;
    parts.mixed = PlacedNumbers<uint64_t>(part(Layout::kMixedAt, layout.full_at));
    parts.full = PlacedNumbers<uint64_t>(part(layout.full_at, layout.tiles_at));
    parts.tiles = PlacedNumbers<uint64_t>(part(layout.tiles_at, layout.rank_at));
    parts.rank = PlacedNumbers<uint32_t>(part(layout.rank_at, layout.class_at));
    parts.class_of = PlacedNumbers<uint16_t>(part(layout.class_at, layout.first_at));
    parts.first = PlacedNumbers<uint16_t>(part(layout.first_at, layout.cells_at));
    parts.cell_at = PlacedNumbers<uint16_t>(part(layout.cells_at, layout.end));
    Fault fault = faultOfTiles(parts, layout, stored);
    if (!fault.what) fault = faultOfClasses(parts, layout, cells, classes);
    if (fault.what) return faultAt(file, fault.what, at + fault.at);
    VisibleRows rows;
    rows.cells_ = cells;
    rows.classes_ = classes;
    rows.side_ = layout.side;
    rows.bytes_ = bytes.size();
    rows.parts_ = parts;
    for (uint32_t row = 0; row < layout.side; ++row)
        if (!isSymmetric(parts.tile(rowOfTiles(row) + row), std::min(8u, classes - 8 * row)))
            return faultAt(file, "a tile on the diagonal that is not symmetric and full of ones along it", at);
    return rows;
}

}  // namespace sightline
