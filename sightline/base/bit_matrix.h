// A matrix of bits, row by row in words.
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sightline {

/// Each row begins with a word of its own; bits behind the last column are zero, and whoever writes words keeps them so.
class BitMatrix {
public:
    BitMatrix() = default;
    /// All zero.
    BitMatrix(size_t rows, size_t columns)
        : rows_(rows), columns_(columns), words_((columns + 63) / 64), bits_(rows * words_) {}

    size_t rows() const { return rows_; }
    size_t columns() const { return columns_; }
    size_t wordsPerRow() const { return words_; }

    std::span<uint64_t> row(size_t r) { return {bits_.data() + r * words_, words_}; }
    std::span<const uint64_t> row(size_t r) const { return {bits_.data() + r * words_, words_}; }

    bool at(size_t r, size_t c) const { return bits_[r * words_ + c / 64] >> (c % 64) & 1; }
    void set(size_t r, size_t c) { bits_[r * words_ + c / 64] |= uint64_t(1) << (c % 64); }
    void clear(size_t r, size_t c) { bits_[r * words_ + c / 64] &= ~(uint64_t(1) << (c % 64)); }

    /// How many bits are one.
    uint64_t count() const {
        uint64_t ones = 0;
        for (const uint64_t word : bits_) ones += static_cast<uint64_t>(std::popcount(word));
        return ones;
    }

    bool operator==(const BitMatrix&) const = default;

private:
    size_t rows_ = 0, columns_ = 0, words_ = 0;
    std::vector<uint64_t> bits_;
};

}  // namespace sightline
