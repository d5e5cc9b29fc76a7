// Classes are the equal rows, and the walk goes on to the nearest class each time.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/row_order.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/targets.h"
#include "tests/visfile/made_rows.h"

namespace sightline::test {
namespace {

size_t differing(const BitMatrix& rows, size_t a, size_t b) {
    size_t bits = 0;
    for (size_t i = 0; i < rows.columns(); ++i) bits += rows.at(a, i) != rows.at(b, i);
    return bits;
}

TEST(RowOrder, HoldsEachRowOnceAndEqualOnesTogether) {
    for (const MadeRows& made : manyRows()) {
        SCOPED_TRACE(made.name);
        const RowOrder order = orderRows(made.matrix);
        ASSERT_EQ(order.cell_at.size(), made.matrix.rows());
        std::vector<uint16_t> sorted(order.cell_at.begin(), order.cell_at.end());
        std::sort(sorted.begin(), sorted.end());
        for (size_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], i);
        ASSERT_EQ(order.first.front(), 0);
        ASSERT_EQ(order.first.back(), made.matrix.rows());
        std::vector<size_t> class_of(made.matrix.rows());
        for (size_t of = 0; of < order.classes(); ++of) {
            ASSERT_LT(order.first[of], order.first[of + 1]);
            for (size_t i = order.first[of]; i < order.first[of + 1]; ++i) {
                class_of[order.cell_at[i]] = of;
                ASSERT_TRUE(i == order.first[of] || order.cell_at[i - 1] < order.cell_at[i]);
            }
        }
        for (size_t a = 0; a < made.matrix.rows(); ++a)
            for (size_t b = 0; b < a; ++b)
                ASSERT_EQ(class_of[a] == class_of[b], differing(made.matrix, a, b) == 0) << a << " and " << b;
    }
}

TEST(RowOrder, GoesOnToTheNearestClass) {
    for (const MadeRows& made : manyRows()) {
        if (made.matrix.rows() == 0 || made.matrix.rows() > 70) continue;
        SCOPED_TRACE(made.name);
        const RowOrder order = orderRows(made.matrix);
        EXPECT_EQ(order.cell_at[0], 0);
        const auto rowOf = [&](size_t of) { return order.cell_at[order.first[of]]; };
        for (size_t of = 0; of + 1 < order.classes(); ++of) {
            const size_t here = rowOf(of), next = rowOf(of + 1), step = differing(made.matrix, here, next);
            for (size_t other = of + 2; other < order.classes(); ++other) {
                const size_t far = differing(made.matrix, here, rowOf(other));
                ASSERT_GE(far, step);
                ASSERT_TRUE(far > step || rowOf(other) > next);
            }
        }
    }
}

TEST(RowOrder, IsTheSameOnEveryInstructionSet) {
    std::vector<MadeRows> made = manyRows();
    made.push_back({"1100 nearly grouped", groupedRows(1100, 90, 0.002, 8)});
    for (const MadeRows& rows : made) {
        const RowOrder wanted = orderRows(rows.matrix);
        const int targets = forEachTarget([&](const std::string& target) {
            const RowOrder order = orderRows(rows.matrix);
            EXPECT_EQ(order.cell_at, wanted.cell_at) << rows.name << " on " << target;
            EXPECT_EQ(order.first, wanted.first) << rows.name << " on " << target;
        });
        EXPECT_GE(targets, 1);
    }
}

}  // namespace
}  // namespace sightline::test
