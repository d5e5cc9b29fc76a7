// Bits that can be counted up to any place at once, and found by their number.
// SPDX-License-Identifier: MIT
//
// Guy Jacobson. Space-efficient Static Trees and Graphs. 1989 (rank and select).
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

#include "sightline/base/array.h"

namespace sightline {

class RankedBits {
public:
    explicit RankedBits(Memory* memory = defaultMemory()) : words_(memory), before_(memory) {}
    /// @param words  bit i is bit i % 64 of word i / 64
    RankedBits(std::span<const uint64_t> words, Memory* memory)
        : words_(words.begin(), words.end(), memory), before_(memory) {
        before_.reserve(words_.size() + 1);
        uint32_t sum = 0;
        for (const uint64_t word : words_) {
            before_.push_back(sum);
            sum += static_cast<uint32_t>(std::popcount(word));
        }
        before_.push_back(sum);
    }

    bool has(uint32_t i) const { return words_[i / 64] >> i % 64 & 1; }
    /// How many are set.
    uint32_t count() const { return before_.empty() ? 0 : before_.back(); }
    /// How many before i are set.
    /// @param i  up to the number of bits
    uint32_t rank(uint32_t i) const {
        const uint32_t whole = before_[i / 64];
        return i % 64 == 0 ? whole : whole + static_cast<uint32_t>(std::popcount(words_[i / 64] << (64 - i % 64)));
    }
    /// The bit before which `number` are set. O(log bits).
    /// @pre number < count()
    uint32_t select(uint32_t number) const {
        const auto after = std::upper_bound(before_.begin(), before_.end(), number);
        const auto word = static_cast<uint32_t>(after - before_.begin() - 1);
        uint64_t left = words_[word];
        for (uint32_t skip = number - before_[word]; skip > 0; --skip) left &= left - 1;
        return 64 * word + static_cast<uint32_t>(std::countr_zero(left));
    }

private:
    Array<uint64_t> words_;
    Array<uint32_t> before_;  ///< per word: bits set before it
};

}  // namespace sightline
