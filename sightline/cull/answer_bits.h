// Answers as bits, eight to a byte: counted, with the bits behind the last answer cleared.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "sightline/base/assert.h"

namespace sightline::detail {

/// Bytes of answers to `count` questions that are asked sixteen at a time.
inline size_t answerBytes(size_t count) { return (count + 15) / 16 * 2; }

/// How many bits of a word are set. Not every processor has an instruction for it, and a call costs more than this.
inline uint64_t countBits(uint64_t word) {
    word -= word >> 1 & 0x5555555555555555u;
    word = (word & 0x3333333333333333u) + (word >> 2 & 0x3333333333333333u);
    return ((word + (word >> 4)) & 0x0f0f0f0f0f0f0f0fu) * 0x0101010101010101u >> 56;
}

/// Clears the bits behind the last of `count` answers, and returns how many answers are set.
inline size_t finishAnswers(size_t count, std::span<uint8_t> bits) {
    const size_t bytes = answerBytes(count);
    SIGHTLINE_DEBUG_ASSERT(bits.size() >= bytes);
    if (count % 16) {
        const uint32_t kept = (1u << count % 16) - 1;
        bits[bytes - 2] &= static_cast<uint8_t>(kept);
        bits[bytes - 1] &= static_cast<uint8_t>(kept >> 8);
    }
    uint64_t found = 0;
    for (size_t i = 0; i < bytes; i += 8) {
        uint64_t word = 0;
        std::memcpy(&word, bits.data() + i, std::min<size_t>(8, bytes - i));
        found += countBits(word);
    }
    return static_cast<size_t>(found);
}

}  // namespace sightline::detail
