// Classes of equal rows, and a greedy walk through them.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/row_order.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace sightline {
namespace {

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

uint32_t onesOf(std::span<const uint64_t> row) {
    uint32_t ones = 0;
    for (const uint64_t word : row) ones += static_cast<uint32_t>(std::popcount(word));
    return ones;
}

/// In how many bits two rows differ; at least `enough` if that is reached.
uint32_t distance(std::span<const uint64_t> a, std::span<const uint64_t> b, uint32_t enough) {
    uint32_t bits = 0;
    for (size_t word = 0; word < a.size() && bits < enough;) {
        const size_t end = std::min(a.size(), word + 8);
        for (; word < end; ++word) bits += static_cast<uint32_t>(std::popcount(a[word] ^ b[word]));
    }
    return bits;
}

/// The classes' numbers in the order of the walk.
Array<uint16_t> walk(const BitMatrix& rows, const Classes& classes, Memory* memory) {
    const size_t count = classes.begin.size();
    Array<uint16_t> path(memory), left(count, memory);
    Array<uint32_t> ones(memory);
    const auto rowOf = [&](uint16_t of) { return rows.row(classes.sorted[classes.begin[of]]); };
    for (size_t i = 0; i < count; ++i) ones.push_back(onesOf(rowOf(static_cast<uint16_t>(i))));
    std::iota(left.begin(), left.end(), uint16_t{0});
    for (size_t nearest = 0; !left.empty();) {
        const uint16_t here = left[nearest];
        path.push_back(here);
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(nearest));
        nearest = 0;
        uint32_t least = ~0u;
        for (size_t i = 0; i < std::min(left.size(), kMostCandidates); ++i) {
            const uint32_t a = ones[here], b = ones[left[i]];
            if (std::max(a, b) - std::min(a, b) >= least) continue;
            const uint32_t bits = distance(rowOf(here), rowOf(left[i]), least);
            if (bits >= least) continue;
            least = bits;
            nearest = i;
        }
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
