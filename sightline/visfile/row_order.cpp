// Classes of equal rows, and a greedy walk through them.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/row_order.h"

#include <algorithm>
#include <bit>
#include <numeric>

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/visfile/row_order.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// In how many bits two rows differ.
/// @param words  a multiple of 8
uint32_t differingBits(const uint64_t* HWY_RESTRICT a, const uint64_t* HWY_RESTRICT b, size_t words) {
    const hn::CappedTag<uint64_t, 8> d;
    auto bits = hn::Zero(d);
    for (size_t i = 0; i < words; i += hn::Lanes(d))
        bits = hn::Add(bits, hn::PopulationCount(hn::Xor(hn::LoadU(d, a + i), hn::LoadU(d, b + i))));
    return static_cast<uint32_t>(hn::GetLane(hn::SumOfLanes(d, bits)));
}

/// Which of the rows `left` differs the least from row `here`: the first of several.
/// @param rows  each `words` long, a multiple of 8
/// @param ones  per row
/// @returns     its place in `left`
size_t nearestKernel(const uint64_t* HWY_RESTRICT rows, size_t words, const uint32_t* HWY_RESTRICT ones, uint16_t here,
                     const uint16_t* HWY_RESTRICT left, size_t count) {
    size_t nearest = 0;
    uint32_t least = ~0u;
    for (size_t i = 0; i < count; ++i) {
        const uint32_t a = ones[here], b = ones[left[i]];
        if ((a > b ? a - b : b - a) >= least) continue;
        const uint32_t bits = differingBits(rows + here * words, rows + left[i] * words, words);
        if (bits >= least) continue;
        least = bits;
        nearest = i;
    }
    return nearest;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {
namespace {

HWY_EXPORT(nearestKernel);

constexpr size_t kMostCandidates = 4096;

struct Classes {
    Array<uint16_t> sorted;  ///< rows, equal ones side by side
    Array<uint32_t> begin;   ///< per class: its first in sorted; then all; classes by their smallest rows
    Array<uint32_t> end;
};

Classes classesOf(const BitMatrix& rows, Memory* memory) {
    Classes classes{Array<uint16_t>(rows.rows(), memory), Array<uint32_t>(memory), Array<uint32_t>(memory)};
    std::iota(classes.sorted.begin(), classes.sorted.end(), uint16_t{0});
    const auto compare = [&](uint16_t a, uint16_t b) {
        const std::span<const uint64_t> x = rows.row(a), y = rows.row(b);
        const auto [at, other] = std::mismatch(x.begin(), x.end(), y.begin());
        return at == x.end() ? 0 : *at < *other ? -1 : 1;
    };
    std::sort(classes.sorted.begin(), classes.sorted.end(), [&](uint16_t a, uint16_t b) {
        const int order = compare(a, b);
        return order != 0 ? order < 0 : a < b;
    });
    struct Range {
        uint32_t begin = 0, end = 0;
    };
    Array<Range> ranges(memory);
    for (uint32_t i = 0; i < rows.rows(); ++i) {
        if (i == 0 || compare(classes.sorted[i - 1], classes.sorted[i]) != 0) ranges.push_back({i, i});
        ranges.back().end = i + 1;
    }
    std::sort(ranges.begin(), ranges.end(),
              [&](const Range& a, const Range& b) { return classes.sorted[a.begin] < classes.sorted[b.begin]; });
    for (const Range& range : ranges) {
        classes.begin.push_back(range.begin);
        classes.end.push_back(range.end);
    }
    return classes;
}

/// The classes' numbers in the order of the walk.
Array<uint16_t> walk(const BitMatrix& rows, const Classes& classes, Memory* memory) {
    const size_t count = classes.begin.size(), words = (rows.wordsPerRow() + 7) / 8 * 8;
    Array<uint64_t> row_of(count * words, 0, memory);  // a row of each class, side by side
    Array<uint32_t> ones(count, 0, memory);
    for (size_t of = 0; of < count; ++of) {
        const std::span<const uint64_t> row = rows.row(classes.sorted[classes.begin[of]]);
        std::copy(row.begin(), row.end(), row_of.begin() + static_cast<std::ptrdiff_t>(of * words));
        for (const uint64_t word : row) ones[of] += static_cast<uint32_t>(std::popcount(word));
    }
    Array<uint16_t> path(memory), left(count, memory);
    std::iota(left.begin(), left.end(), uint16_t{0});
    for (size_t nearest = 0; !left.empty();) {
        const uint16_t here = left[nearest];
        path.push_back(here);
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(nearest));
        nearest = HWY_DYNAMIC_DISPATCH(nearestKernel)(row_of.data(), words, ones.data(), here, left.data(),
                                                      std::min(left.size(), kMostCandidates));
    }
    return path;
}

}  // namespace

RowOrder orderRows(const BitMatrix& rows, Memory* memory) {
    const Classes classes = classesOf(rows, memory);
    RowOrder order(memory);
    for (const uint16_t of : walk(rows, classes, memory)) {
        order.first.push_back(static_cast<uint16_t>(order.cell_at.size()));
        order.cell_at.insert(order.cell_at.end(), classes.sorted.begin() + classes.begin[of],
                             classes.sorted.begin() + classes.end[of]);
    }
    order.first.push_back(static_cast<uint16_t>(order.cell_at.size()));
    return order;
}

}  // namespace sightline
#endif  // HWY_ONCE
