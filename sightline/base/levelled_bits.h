// Bits with levels above them that tell which words hold any: ranges are asked, and walked, without the words between.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "sightline/base/array.h"
#include "sightline/base/paged.h"

namespace sightline {

/// Bit i of level 0 is the bit itself; of a level above, whether word i of the level below is not zero. The functions
/// are for any three arrays of words.
namespace bit_levels {

inline constexpr int kLevels = 3;

inline uint32_t wordsOf(uint32_t bits) { return (bits + 63) / 64; }

/// Whether any bit from `first` to before `end` is set.
template <class Words>
bool any(const Words (&levels)[kLevels], uint32_t first, uint32_t end) {
    for (int level = 0; first < end; ++level) {
        const Words& words = levels[level];
        const uint32_t low = first / 64, high = (end - 1) / 64;
        const uint64_t head = ~uint64_t{0} << first % 64, tail = ~uint64_t{0} >> (63 - (end - 1) % 64);
        if (low == high) return (words[low] & head & tail) != 0;
        if ((words[low] & head) || (words[high] & tail)) return true;
        first = low + 1;
        end = high;
        if (level + 1 < kLevels) continue;
        while (first < end && words[first] == 0) ++first;
        return first < end;
    }
    return false;
}

/// The first word of a level from `from` on that is not zero, or `end`.
template <class Words>
uint32_t nextWord(const Words (&levels)[kLevels], int level, uint32_t from, uint32_t end) {
    if (from >= end) return end;
    if (level + 1 == kLevels) {
        while (from < end && levels[level][from] == 0) ++from;
        return from;
    }
    uint32_t above = from / 64;
    uint64_t bits = levels[level + 1][above] & (~uint64_t{0} << from % 64);
    if (!bits) {
        const uint32_t end_above = wordsOf(end);
        above = nextWord(levels, level + 1, above + 1, end_above);
        if (above == end_above) return end;
        bits = levels[level + 1][above];
    }
    return std::min(end, 64 * above + static_cast<uint32_t>(std::countr_zero(bits)));
}

/// Calls visit(word, its bits) for each word with bits from `first` to before `end`, of which it gets no others.
template <class Words, class Visit>
void forEachWord(const Words (&levels)[kLevels], uint32_t first, uint32_t end, Visit&& visit) {
    if (first >= end) return;
    const uint32_t low = first / 64, behind = wordsOf(end);
    for (uint32_t word = nextWord(levels, 0, low, behind); word < behind;
         word = nextWord(levels, 0, word + 1, behind)) {
        uint64_t bits = levels[0][word];
        if (word == low) bits &= ~uint64_t{0} << first % 64;
        if (word + 1 == behind) bits &= ~uint64_t{0} >> (63 - (end - 1) % 64);
        if (bits) visit(word, bits);
    }
}

}  // namespace bit_levels

/// A set of numbers that is emptied in as many steps as it holds.
class LevelledBits {
public:
    explicit LevelledBits(Memory* memory = defaultMemory())
        : levels_{Array<uint64_t>(memory), Array<uint64_t>(memory), Array<uint64_t>(memory)} {}

    /// Empties it, and makes room for numbers below `size`.
    void clear(uint32_t size) {
        for (uint32_t word = next(0); word < levels_[0].size(); word = next(word + 1)) levels_[0][word] = 0;
        for (int level = 1; level < bit_levels::kLevels; ++level)
            std::fill(levels_[level].begin(), levels_[level].end(), uint64_t{0});
        for (Array<uint64_t>& words : levels_) {
            size = bit_levels::wordsOf(size);
            if (words.size() < size) words.resize(size, 0);
        }
    }
    /// False if it was there.
    bool insert(uint32_t i) {
        uint64_t& word = levels_[0][i / 64];
        const uint64_t bit = uint64_t{1} << i % 64;
        if (word & bit) return false;
        if (word == 0) {
            levels_[1][i / 4096] |= uint64_t{1} << i / 64 % 64;
            levels_[2][i / 262144] |= uint64_t{1} << i / 4096 % 64;
        }
        word |= bit;
        return true;
    }
    bool has(uint32_t i) const { return levels_[0][i / 64] >> i % 64 & 1; }
    uint64_t word(uint32_t i) const { return levels_[0][i]; }
    /// The first word from `from` on that is not zero, or `end`.
    uint32_t nextWord(uint32_t from, uint32_t end) const { return bit_levels::nextWord(levels_, 0, from, end); }
    /// @pre end <= the size
    bool any(uint32_t first, uint32_t end) const { return bit_levels::any(levels_, first, end); }
    template <class Visit>
    void forEachWord(uint32_t first, uint32_t end, Visit&& visit) const {
        bit_levels::forEachWord(levels_, first, end, visit);
    }

private:
    uint32_t next(uint32_t from) const {
        return bit_levels::nextWord(levels_, 0, from, static_cast<uint32_t>(levels_[0].size()));
    }

    Array<uint64_t> levels_[bit_levels::kLevels];
};

/// The same in pages that copies share.
class PagedBits {
public:
    explicit PagedBits(Memory* memory = defaultMemory()) : levels_{Words(memory), Words(memory), Words(memory)} {}

    /// @pre no smaller than it is: clear() first
    void resize(uint32_t size) {
        for (Words& words : levels_) {
            size = bit_levels::wordsOf(size);
            words.resize(size);
        }
    }
    void clear() {
        for (Words& words : levels_) words.clear();
    }
    void set(uint32_t i, bool value) {
        if (has(i) == value) return;
        for (Words& words : levels_) {
            uint64_t& word = words.change(i / 64);
            const bool before = word != 0;
            word ^= uint64_t{1} << i % 64;
            if (before == (word != 0)) return;
            i /= 64;
        }
    }
    bool has(uint32_t i) const { return levels_[0][i / 64] >> i % 64 & 1; }
    uint64_t word(uint32_t i) const { return levels_[0][i]; }
    uint32_t nextWord(uint32_t from, uint32_t end) const { return bit_levels::nextWord(levels_, 0, from, end); }
    bool any(uint32_t first, uint32_t end) const { return bit_levels::any(levels_, first, end); }
    template <class Visit>
    void forEachWord(uint32_t first, uint32_t end, Visit&& visit) const {
        bit_levels::forEachWord(levels_, first, end, visit);
    }
    /// As it is now, for reading. O(pages).
    PagedBits share() { return PagedBits(levels_[0].share(), levels_[1].share(), levels_[2].share()); }

private:
    using Words = Paged<uint64_t, 64>;
    PagedBits(Words&& a, Words&& b, Words&& c) : levels_{std::move(a), std::move(b), std::move(c)} {}

    Words levels_[bit_levels::kLevels];
};

}  // namespace sightline
