// Cuts a matrix of visibility into tiles of bits.
// SPDX-License-Identifier: MIT
#include <bit>

#include "sightline/base/bytes.h"
#include "sightline/visfile/row_order.h"
#include "sightline/visfile/visible_rows.h"

namespace sightline {

using namespace tiled_rows;

namespace {

Status checkMatrix(const BitMatrix& visible) {
    const auto wrong = [](const char* what) { return Error{Error::Kind::kUsage, what}; };
    const size_t n = visible.rows();
    if (n > kMostOrderedRows) return wrong("a matrix of visibility of more than 65535 cells");
    if (n != visible.columns()) return wrong("a matrix of visibility that is not square");
    for (size_t i = 0; i < n; ++i) {
        if (!visible.at(i, i)) return wrong("a matrix of visibility in which a cell does not see itself");
        const std::span<const uint64_t> row = visible.row(i);
        for (size_t word = 0; word < row.size(); ++word)
            for (uint64_t bits = row[word]; bits != 0; bits &= bits - 1)
                if (!visible.at(64 * word + static_cast<size_t>(std::countr_zero(bits)), i))
                    return wrong("a matrix of visibility that is not symmetric");
    }
    return success();
}

/// The matrix of classes: row and column i are those of the first cell of class i.
BitMatrix classMatrix(const BitMatrix& visible, const RowOrder& order) {
    constexpr uint16_t kNone = 65535;
    const size_t classes = order.classes();
    Array<uint16_t> class_at(visible.rows(), kNone, order.first.memory());
    for (size_t of = 0; of < classes; ++of) class_at[order.cell_at[order.first[of]]] = static_cast<uint16_t>(of);
    BitMatrix matrix(classes, classes);
    for (size_t of = 0; of < classes; ++of) {
        const std::span<const uint64_t> row = visible.row(order.cell_at[order.first[of]]);
        for (size_t word = 0; word < row.size(); ++word)
            for (uint64_t bits = row[word]; bits != 0; bits &= bits - 1) {
                const uint16_t column = class_at[64 * word + static_cast<size_t>(std::countr_zero(bits))];
                if (column != kNone) matrix.set(of, column);
            }
    }
    return matrix;
}

/// @param real  set to the bits of classes that there are
uint64_t tileOf(const BitMatrix& matrix, size_t row, size_t column, uint64_t& real) {
    uint64_t tile = 0;
    real = 0;
    const size_t n = matrix.rows(), wide = n - 8 * column;
    const uint64_t whole = wide >= 8 ? 0xff : (1u << wide) - 1;
    for (size_t i = 0; i < 8 && 8 * row + i < n; ++i) {
        tile |= (matrix.row(8 * row + i)[column / 8] >> column % 8 * 8 & 0xff) << 8 * i;
        real |= whole << 8 * i;
    }
    return tile;
}

}  // namespace

Result<Array<char>> tiledRows(const BitMatrix& visible, Memory* memory) {
    if (const Status status = checkMatrix(visible); !status) return status.error();
    const RowOrder order = orderRows(visible, memory);
    const auto cells = static_cast<uint32_t>(visible.rows()), classes = static_cast<uint32_t>(order.classes());
    const Layout shape(cells, classes, 0);
    Array<uint64_t> mixed(shape.words, 0, memory), full(shape.words, 0, memory), tiles(memory);
    Array<uint32_t> rank(memory);
    const BitMatrix matrix = classMatrix(visible, order);
    for (uint32_t row = 0, number = 0; row < shape.side; ++row)
        for (uint32_t column = 0; column <= row; ++column, ++number) {
            if (number % 64 == 0) rank.push_back(static_cast<uint32_t>(tiles.size()));
            uint64_t real = 0;
            const uint64_t tile = tileOf(matrix, row, column, real);
            if (tile == 0) continue;
            (tile == real ? full : mixed)[number / 64] |= uint64_t{1} << number % 64;
            if (tile != real) tiles.push_back(tile);
        }
    Array<uint16_t> class_of(cells, 0, memory);
    for (uint32_t of = 0; of < classes; ++of)
        for (uint32_t i = order.first[of]; i < order.first[of + 1]; ++i)
            class_of[order.cell_at[i]] = static_cast<uint16_t>(of);

    Array<char> bytes(memory);
    ByteWriter out(bytes);
    for (const uint32_t value : {cells, classes, static_cast<uint32_t>(tiles.size()), 0u}) out.put(value);
    const auto put = [&](const auto& values) {
        for (const auto value : values) out.put(value);
    };
    put(mixed), put(full), put(tiles), put(rank), put(class_of), put(order.first), put(order.cell_at);
    return bytes;
}

}  // namespace sightline
