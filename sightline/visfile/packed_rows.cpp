// Codes the tiled form of visibility rows bit by bit, and back.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/packed_rows.h"

#include <algorithm>
#include <utility>

#include "sightline/base/bytes.h"
#include "sightline/visfile/bit_coder.h"
#include "sightline/visfile/row_order.h"
#include "sightline/visfile/section_file.h"

namespace sightline {

using namespace tiled_rows;

namespace {

enum Kind : uint8_t { kEmpty, kFull, kStored };

/// Codes tiles row by row; the same steps put bits and take them, so that both know the same of what came before.
template <class Coder>
class TileCoder {
public:
    TileCoder(Coder& coder, uint32_t classes, Memory* memory)
        : coder_(coder),
          classes_(classes),
          kinds_((classes + 7) / 8 + 2, kEmpty, memory),
          above_kinds_(kinds_),
          tiles_((classes + 7) / 8 + 2, 0, memory),
          above_(tiles_) {}

    /// @param kinds  of the tiles of row `row`, to be put or to be set  [size: row + 1]
    /// @param tiles  likewise
    void codeRow(uint32_t row, std::span<Kind> kinds, std::span<uint64_t> tiles) {
        std::swap(kinds_, above_kinds_);
        std::swap(tiles_, above_);
        for (uint32_t column = 0; column <= row; ++column) {
            const uint32_t left = column > 0 ? kinds_[column] : 0;
            const uint32_t around =
                left + 3 * above_kinds_[column + 1] + 9 * above_kinds_[column] + 27 * above_kinds_[column + 2];
            Kind kind = kinds[column];
            if (coder_.code(stored_[around], kind == kStored)) kind = kStored;
            else kind = coder_.code(full_[around], kind == kFull) ? kFull : kEmpty;
            kinds[column] = kinds_[column + 1] = kind;
            tiles_[column + 1] = kind == kFull ? ~uint64_t{0} : 0;
        }
        for (uint32_t column = 0; column <= row; ++column) {
            if (kinds[column] == kStored) codeTile(row, column, tiles[column]);
            tiles[column] = tiles_[column + 1];
        }
    }

private:
    void codeTile(uint32_t row, uint32_t column, uint64_t truth) {
        // The tile and its neighbours lie one place farther right, so that there is always one on the left.
        uint64_t& tile = tiles_[column + 1];
        const uint64_t left = tiles_[column], right = tiles_[column + 2];
        const uint32_t high = std::min(8u, classes_ - 8 * row);
        const auto wide = [&](uint64_t before, uint64_t here, uint64_t behind, uint32_t i) {
            return static_cast<uint32_t>((before >> 8 * i >> 7 & 1) | (here >> 8 * i & 0xff) << 1 |
                                         (behind >> 8 * i & 1) << 9);
        };
        uint32_t above = wide(above_[column], above_[column + 1], above_[column + 2], 7);
        for (uint32_t i = 0; i < high; ++i) {
            uint32_t line = static_cast<uint32_t>((left >> 8 * i >> 7 & 1) | (left >> 8 * i >> 6 & 1) << 1);
            const uint32_t count = row == column ? i : 8;
            for (uint32_t j = 0; j < count; ++j) {
                const uint32_t around = (above >> j & 7) | line << 3;
                const bool bit = coder_.code(bit_[around], truth >> (8 * i + j) & 1);
                line = (line << 1 | bit) & 3;
                tile |= uint64_t{bit} << (8 * i + j);
            }
            if (row == column) tile |= uint64_t{1} << 9 * i;
            above = wide(left, tile, right, i);
        }
        if (row != column) return;
        for (uint32_t i = 0; i < high; ++i)
            for (uint32_t j = 0; j < i; ++j) tile |= (tile >> (8 * i + j) & 1) << (8 * j + i);
    }

    Coder& coder_;
    uint32_t classes_;
    Array<Kind> kinds_, above_kinds_;  ///< [0] and those behind the diagonal: none
    Array<uint64_t> tiles_, above_;    ///< as far as they are known
    BitModel stored_[81], full_[81], bit_[32];
};

/// Codes the list of cells: where classes begin, and each cell by its step from the one before.
template <class Coder>
class ListCoder {
public:
    explicit ListCoder(Coder& coder) : coder_(coder) {}

    /// @returns the cell; perhaps far out of range, if it is taken from what was never put
    int32_t code(bool& begins, int32_t cell) {
        begins = coder_.code(begins_[began_], begins);
        const int32_t step = cell - last_;
        last_ += begins ? unfoldSign(step_.code(coder_, foldSign(step)))
                        : static_cast<int32_t>(up_.code(coder_, static_cast<uint32_t>(step) - 1)) + 1;
        began_ = begins;
        return last_;
    }

private:
    Coder& coder_;
    int32_t last_ = 0;
    bool began_ = true;
    BitModel begins_[2];
    NumberModel step_, up_;
};

constexpr uint64_t kRowHeadBytes = 8;

/// The arrays of a tiled form while it is unpacked.
struct Unpacked {
    Array<uint64_t> mixed, full, tiles;
    Array<uint32_t> rank;
    Array<uint16_t> class_of, first, cell_at;

    explicit Unpacked(Memory* memory)
        : mixed(memory), full(memory), tiles(memory), rank(memory), class_of(memory), first(memory), cell_at(memory) {}
};

/// @returns false if it is no list of `cells` cells in `classes` classes
bool takeList(BitDecoder& decoder, uint32_t cells, uint32_t classes, Unpacked& out) {
    ListCoder<BitDecoder> list(decoder);
    out.class_of.resize(cells);
    for (uint32_t i = 0; i < cells; ++i) {
        bool begins = false;
        const int32_t cell = list.code(begins, 0);
        if (cell < 0 || cell >= static_cast<int32_t>(cells) || (i == 0 && !begins) || decoder.pastEnd()) return false;
        if (begins) out.first.push_back(static_cast<uint16_t>(i));
        out.class_of[static_cast<uint32_t>(cell)] = static_cast<uint16_t>(out.first.size() - 1);
        out.cell_at.push_back(static_cast<uint16_t>(cell));
    }
    out.first.push_back(static_cast<uint16_t>(cells));
    return out.first.size() == size_t{classes} + 1;
}

/// @returns false if more was taken than there is
bool takeTiles(BitDecoder& decoder, uint32_t classes, Unpacked& out) {
    Memory* memory = out.mixed.memory();
    const uint32_t side = (classes + 7) / 8;
    TileCoder<BitDecoder> coder(decoder, classes, memory);
    Array<Kind> kinds(side, kEmpty, memory);
    Array<uint64_t> tiles(side, 0, memory);
    for (uint32_t row = 0, number = 0; row < side; ++row) {
        coder.codeRow(row, std::span(kinds).first(row + 1), std::span(tiles).first(row + 1));
        if (decoder.pastEnd()) return false;
        for (uint32_t column = 0; column <= row; ++column, ++number) {
            if (number % 64 == 0) {
                out.rank.push_back(static_cast<uint32_t>(out.tiles.size()));
                out.mixed.push_back(0);
                out.full.push_back(0);
            }
            if (kinds[column] == kEmpty) continue;
            (kinds[column] == kFull ? out.full : out.mixed).back() |= uint64_t{1} << number % 64;
            if (kinds[column] == kStored) out.tiles.push_back(tiles[column]);
        }
    }
    return true;
}

}  // namespace

Array<char> packedRows(const VisibleRows& rows, Memory* memory) {
    Array<char> bytes(memory);
    ByteWriter head(bytes);
    head.put(rows.cells());
    head.put(rows.classes());
    BitEncoder encoder(bytes);
    const Parts& parts = rows.parts();
    ListCoder<BitEncoder> list(encoder);
    for (uint32_t of = 0; of < rows.classes(); ++of)
        for (uint32_t i = parts.first[of]; i < parts.first[of + 1]; ++i) {
            bool begins = i == parts.first[of];
            list.code(begins, parts.cell_at[i]);
        }
    const uint32_t side = (rows.classes() + 7) / 8;
    TileCoder<BitEncoder> coder(encoder, rows.classes(), memory);
    Array<Kind> kinds(side, kEmpty, memory);
    Array<uint64_t> tiles(side, 0, memory);
    for (uint32_t row = 0, number = 0; row < side; ++row) {
        for (uint32_t column = 0; column <= row; ++column, ++number) {
            const uint64_t bit = uint64_t{1} << number % 64;
            kinds[column] = parts.mixed[number / 64] & bit ? kStored : parts.full[number / 64] & bit ? kFull : kEmpty;
            tiles[column] = parts.tile(number);
        }
        coder.codeRow(row, std::span(kinds).first(row + 1), std::span(tiles).first(row + 1));
    }
    encoder.finish();
    return bytes;
}

Result<Array<char>> unpackedRows(std::span<const char> bytes, std::string_view file, uint64_t at, Memory* memory) {
    if (bytes.size() < kRowHeadBytes) return faultAt(file, "packed rows that end within their head", at + bytes.size());
    ByteCursor head(bytes);
    const uint32_t cells = head.take<uint32_t>(), classes = head.take<uint32_t>();
    if (cells > kMostOrderedRows) return faultAt(file, "more cells than there may be", at);
    if (classes > cells) return faultAt(file, "more classes than cells", at + 4);
    Unpacked out(memory);
    BitDecoder decoder(bytes.subspan(kRowHeadBytes));
    if (!takeList(decoder, cells, classes, out)) return faultAt(file, "packed rows with a wrong list of cells", at);
    if (!takeTiles(decoder, classes, out) || !decoder.atEnd())
        return faultAt(file, "packed rows that do not end with their bytes", at + bytes.size());
    Array<char> tiled(memory);
    ByteWriter to(tiled);
    for (const uint32_t value : {cells, classes, static_cast<uint32_t>(out.tiles.size()), 0u}) to.put(value);
    const auto put = [&](const auto& values) {
        for (const auto value : values) to.put(value);
    };
    put(out.mixed), put(out.full), put(out.tiles), put(out.rank), put(out.class_of), put(out.first), put(out.cell_at);
    return tiled;
}

}  // namespace sightline
