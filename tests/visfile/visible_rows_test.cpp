// Rows and pairs are what the matrix says, and nothing in the bytes is believed.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/visible_rows.h"

#include <gtest/gtest.h>

#include <cstring>

#include "sightline/visfile/row_order.h"
#include "tests/visfile/made_rows.h"

namespace sightline::test {
namespace {

TEST(VisibleRows, AnswersAsTheMatrixForEveryPairAndRow) {
    for (const MadeRows& made : manyRows()) {
        SCOPED_TRACE(made.name);
        const Result<Array<char>> bytes = tiledRows(made.matrix);
        ASSERT_TRUE(bytes.ok());
        EXPECT_EQ(*tiledRows(made.matrix), *bytes) << "the same matrix, other bytes";
        const Result<VisibleRows> rows = VisibleRows::open(*bytes, "rows");
        ASSERT_TRUE(rows.ok()) << rows.error().message;
        const uint32_t cells = rows->cells();
        ASSERT_EQ(cells, made.matrix.rows());
        EXPECT_EQ(rows->classes(), orderRows(made.matrix).classes());
        EXPECT_EQ(rows->bytes(), bytes->size());
        std::vector<uint64_t> row(made.matrix.wordsPerRow(), ~uint64_t{0});
        for (uint32_t a = 0; a < cells; ++a) {
            for (uint32_t b = 0; b < cells; ++b) ASSERT_EQ(rows->sees(a, b), made.matrix.at(a, b)) << a << ", " << b;
            rows->row(a, row);
            ASSERT_TRUE(std::equal(row.begin(), row.end(), made.matrix.row(a).begin())) << a;
        }
    }
}

TEST(VisibleRows, LieAtAnyAddress) {
    const BitMatrix matrix = groupedRows(90, 8, 0.02, 1);
    const Array<char> bytes = *tiledRows(matrix);
    for (size_t shift = 1; shift < 8; ++shift) {
        std::vector<char> shifted(shift + bytes.size());
        std::memcpy(shifted.data() + shift, bytes.data(), bytes.size());
        const Result<VisibleRows> rows = VisibleRows::open(std::span(shifted).subspan(shift), "rows");
        ASSERT_TRUE(rows.ok());
        for (uint32_t a = 0; a < 90; ++a)
            for (uint32_t b = 0; b < 90; ++b) ASSERT_EQ(rows->sees(a, b), matrix.at(a, b));
    }
}

TEST(VisibleRows, EqualRowsAndWholeBlocksCostNextToNothing) {
    constexpr size_t kCells = 4000;
    BitMatrix rooms(kCells, kCells);
    for (size_t a = 0; a < kCells; ++a)
        for (size_t b = 0; b < kCells; ++b)
            if (a % 50 == b % 50) rooms.set(a, b);
    const Array<char> bytes = *tiledRows(rooms);
    const Result<VisibleRows> opened = VisibleRows::open(bytes, "rows");
    ASSERT_TRUE(opened.ok());
    EXPECT_EQ(opened->classes(), 50u);
    EXPECT_LT(bytes.size(), 5 * kCells);
}

TEST(VisibleRows, AreOfSymmetricMatricesOnly) {
    BitMatrix one_way = onlyThemselves(20);
    one_way.set(3, 17);
    const auto message = [](const BitMatrix& matrix) { return tiledRows(matrix).error().message; };
    EXPECT_EQ(message(one_way), "a matrix of visibility that is not symmetric");
    EXPECT_EQ(message(BitMatrix(3, 3)), "a matrix of visibility in which a cell does not see itself");
    EXPECT_EQ(message(BitMatrix(3, 4)), "a matrix of visibility that is not square");
    EXPECT_EQ(message(BitMatrix(65536, 0)), "a matrix of visibility of more than 65535 cells");
}

template <class T>
void overwrite(Array<char>& bytes, uint64_t at, T value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

TEST(VisibleRows, SayInOneLineWhatIsWrongAndWhere) {
    const BitMatrix matrix = groupedRows(130, 40, 0.05, 2);
    const Array<char> good = *tiledRows(matrix);
    const Result<VisibleRows> rows = VisibleRows::open(good, "rows");
    ASSERT_TRUE(rows.ok());
    const auto stored = static_cast<uint32_t>(rows->parts().tiles.size());
    const tiled_rows::Layout layout(130, rows->classes(), stored);
    ASSERT_EQ(layout.end, good.size());
    const auto expect = [&](const std::string& what, uint64_t at, auto change) {
        Array<char> bytes = good;
        change(bytes);
        const Result<VisibleRows> read = VisibleRows::open(bytes, "a/map.see", 1000);
        ASSERT_FALSE(read.ok()) << what;
        EXPECT_EQ(read.error().message, "a/map.see: " + what + " at byte " + std::to_string(1000 + at));
    };
    expect("rows that end within their head", 15, [](auto& b) { b.resize(15); });
    expect("rows that end within their head", 0, [](auto& b) { b.clear(); });
    expect("more cells than there may be", 0, [](auto& b) { overwrite(b, 0, 65536u); });
    expect("more classes than cells", 4, [](auto& b) { overwrite(b, 4, 131u); });
    expect("a mark that is not known", 12, [](auto& b) { overwrite(b, 12, 1u); });
    expect("rows that are not as long as they say", 0, [](auto& b) { b.pop_back(); });
    expect("rows that are not as long as they say", 0, [](auto& b) { b.push_back(0); });
    expect("rows that are not as long as they say", 0, [](auto& b) { overwrite(b, 8, ~0u); });
    const uint64_t mixed = rows->parts().mixed[0];
    expect("a tile that is full and stored", layout.full_at, [&](auto& b) { overwrite(b, layout.full_at, mixed); });
    expect("tiles behind the last", layout.full_at - 8, [&](auto& b) { b[layout.tiles_at - 1] |= '\x80'; });
    expect("a wrong count of tiles", layout.rank_at + 4, [&](auto& b) { b[layout.rank_at + 4] ^= 1; });
    expect("not the number of tiles that are marked as stored", 8, [&](auto& b) {
        const uint64_t last = layout.full_at - 8, word = rows->parts().mixed[layout.words - 1];
        overwrite(b, last, word & (word - 1));
    });
    expect("a class without cells, or with more than there are", layout.first_at + 2,
           [&](auto& b) { overwrite(b, layout.first_at + 4, uint16_t{0}); });
    expect("a class without cells, or with more than there are", layout.first_at,
           [&](auto& b) { overwrite(b, layout.first_at, uint16_t{1}); });
    expect("a cell that is not of its class", layout.cells_at,
           [&](auto& b) { overwrite(b, layout.cells_at, uint16_t{130}); });
    expect("a cell that is not of its class", layout.cells_at,
           [&](auto& b) { overwrite(b, layout.cells_at, static_cast<uint16_t>(rows->parts().cell_at[100])); });
    Array<char> alike =
        *tiledRows(randomRows(5, 1, 1));  // one class: its list of cells ends the bytes, before it 0 and 5
    alike[alike.size() - 12] = 4;
    EXPECT_EQ(VisibleRows::open(alike, "f").error().message,
              "f: cells without a class at byte " + std::to_string(alike.size() - 12));
    Array<char> alone = *tiledRows(onlyThemselves(20));  // three tiles on the diagonal are stored
    const tiled_rows::Layout small(20, 20, 3);
    ASSERT_EQ(small.end, alone.size());
    alone[small.tiles_at + 1] ^= 1;
    EXPECT_EQ(VisibleRows::open(alone, "f").error().message,
              "f: a tile on the diagonal that is not symmetric and full of ones along it at byte 0");
}

TEST(VisibleRows, SurviveAnyBytes) {
    Random random(7);
    int opened = 0;
    for (int i = 0; i < 20000; ++i) {
        Array<char> bytes = *tiledRows(groupedRows(1 + random.below(60), 6, 0.03, random.next()));
        for (uint64_t k = 0; k <= random.below(3); ++k)
            bytes[random.below(bytes.size())] ^= static_cast<char>(1u << random.below(8));
        const Result<VisibleRows> rows = VisibleRows::open(bytes, "rows");
        if (!rows.ok()) continue;
        ++opened;
        std::vector<uint64_t> row((rows->cells() + 63) / 64);
        for (uint32_t a = 0; a < rows->cells(); ++a) {
            rows->row(a, row);
            ASSERT_TRUE(rows->sees(a, a));
            for (uint32_t b = 0; b < rows->cells(); ++b) {
                ASSERT_EQ(rows->sees(a, b), bool(row[b / 64] >> b % 64 & 1));
                ASSERT_EQ(rows->sees(a, b), rows->sees(b, a));
            }
        }
    }
    EXPECT_GT(opened, 1000);
}

}  // namespace
}  // namespace sightline::test
