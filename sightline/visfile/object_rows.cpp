// Writes, opens and spreads rows of objects.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/object_rows.h"

#include <algorithm>
#include <bit>
#include <map>
#include <vector>

#include "sightline/base/bytes.h"

namespace sightline {
namespace {

constexpr uint64_t kObjectRowHeadBytes = 24;

}  // namespace

Array<char> objectRowsSection(const BitMatrix& visible, Memory* memory) {
    const auto less = [&](size_t a, size_t b) {
        return std::ranges::lexicographical_compare(visible.row(a), visible.row(b));
    };
    std::map<size_t, uint32_t, decltype(less)> known(less);
    std::vector<size_t> first;
    std::vector<uint32_t> kind_of;
    for (size_t row = 0; row < visible.rows(); ++row) {
        const auto [found, fresh] = known.emplace(row, static_cast<uint32_t>(first.size()));
        if (fresh) first.push_back(row);
        kind_of.push_back(found->second);
    }
    std::vector<uint64_t> marks, ends, words;
    for (const size_t row : first) {
        const size_t begin = marks.size();
        marks.resize(begin + (visible.wordsPerRow() + 63) / 64);
        for (size_t i = 0; i < visible.wordsPerRow(); ++i)
            if (const uint64_t word = visible.row(row)[i]; word != 0) {
                marks[begin + i / 64] |= uint64_t{1} << i % 64;
                words.push_back(word);
            }
        ends.push_back(words.size());
    }
    Array<char> bytes(memory);
    ByteWriter out(bytes);
    out.put(static_cast<uint32_t>(visible.rows()));
    out.put(static_cast<uint32_t>(first.size()));
    out.put(uint64_t{visible.columns()});
    out.put(uint64_t{words.size()});
    for (const uint32_t kind : kind_of) out.put(kind);
    bytes.resize((bytes.size() + 7) / 8 * 8);
    for (const auto* part : {&marks, &ends, &words})
        for (const uint64_t number : *part) out.put(number);
    return bytes;
}

Result<PlacedObjectRows> PlacedObjectRows::open(std::span<const char> bytes, uint32_t rows, uint64_t objects,
                                                std::string_view file, uint64_t at) {
    if (bytes.size() < kObjectRowHeadBytes) return faultAt(file, "rows of objects that end within their head", at);
    ByteCursor head(bytes);
    if (head.take<uint32_t>() != rows) return faultAt(file, "not a row of objects for each row of cells", at);
    const uint32_t kinds = head.take<uint32_t>();
    if (kinds > rows) return faultAt(file, "more kinds of rows than rows", at + 4);
    if (head.take<uint64_t>() != objects) return faultAt(file, "rows of more or fewer objects than there are", at + 8);
    const uint64_t stored = head.take<uint64_t>();
    const uint64_t in_row = objects / 64 + (objects % 64 != 0);
    PlacedParts parts(bytes.subspan(kObjectRowHeadBytes));
    PlacedObjectRows out;
    out.marks_per_kind_ = in_row / 64 + (in_row % 64 != 0);
    out.kind_of_ = parts.take<uint32_t>(rows);
    const std::span<const char> gap = parts.take((8 - parts.at() % 8) % 8, 1);
    out.marks_ = parts.take<uint64_t>(kinds * out.marks_per_kind_);  // objects lie in memory: no overflow
    out.ends_ = parts.take<uint64_t>(kinds);
    out.words_ = parts.take<uint64_t>(stored);
    if (!parts.fits()) return faultAt(file, "rows of objects that are not as long as they say", at);
    for (const char zero : gap)
        if (zero != 0) return faultAt(file, "a mark that is not known", at);
    for (uint32_t row = 0; row < rows; ++row)
        if (out.kind_of_[row] >= kinds)
            return faultAt(file, "a row of a kind that there is not", at + kObjectRowHeadBytes + 4 * uint64_t{row});
    uint64_t word = 0;
    for (uint32_t kind = 0; kind < kinds; ++kind) {
        for (uint64_t m = 0; m < out.marks_per_kind_; ++m) {
            const uint64_t marks = out.marks_[kind * out.marks_per_kind_ + m];
            if (m + 1 == out.marks_per_kind_ && in_row % 64 != 0 && marks >> in_row % 64 != 0)
                return faultAt(file, "words behind the last object", at);
            word += static_cast<uint64_t>(std::popcount(marks));
            const bool has_last = m + 1 == out.marks_per_kind_ && marks >> (in_row - 1) % 64 != 0;
            if (has_last && objects % 64 != 0 && word <= stored && out.words_[word - 1] >> objects % 64 != 0)
                return faultAt(file, "a row that sees behind the last object", at);
        }
        if (out.ends_[kind] != word) return faultAt(file, "a wrong count of words", at);
    }
    if (word != stored) return faultAt(file, "words of no row", at + 16);
    return out;
}

void PlacedObjectRows::row(uint32_t row, std::span<uint64_t> out) const {
    std::fill(out.begin(), out.end(), 0);
    const uint64_t kind = kind_of_[row];
    uint64_t word = kind == 0 ? 0 : ends_[kind - 1];
    for (uint64_t m = 0; m < marks_per_kind_; ++m)
        for (uint64_t marks = marks_[kind * marks_per_kind_ + m]; marks != 0; marks &= marks - 1)
            out[64 * m + static_cast<uint64_t>(std::countr_zero(marks))] = words_[word++];
}

}  // namespace sightline
