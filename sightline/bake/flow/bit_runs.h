// Words of bits as bytes and back: runs of zeros as a number.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "sightline/base/bytes.h"

namespace sightline::bake {

/// Runs of words: how many are zero, how many are not, and these.
inline void putBits(ByteWriter& out, std::span<const uint64_t> words) {
    for (size_t w = 0; w < words.size();) {
        size_t zeros = w, end;
        while (zeros < words.size() && words[zeros] == 0) ++zeros;
        for (end = zeros; end < words.size() && words[end] != 0;) ++end;
        out.put(static_cast<uint32_t>(zeros - w));
        out.put(static_cast<uint32_t>(end - zeros));
        for (w = zeros; w < end; ++w) out.put(words[w]);
    }
}

/// @param words    zero before
/// @param columns  bits behind them are zero
/// @returns false if the bytes are no such words
inline bool takeBits(ByteCursor& in, std::span<uint64_t> words, size_t columns) {
    for (size_t w = 0; w < words.size();) {
        const size_t zeros = in.take<uint32_t>(), ones = in.take<uint32_t>();
        if (zeros + ones == 0 || zeros > words.size() - w || ones > words.size() - w - zeros || in.left() < 8 * ones)
            return false;
        w += zeros;
        for (size_t end = w + ones; w < end; ++w) words[w] = in.take<uint64_t>();
    }
    return columns % 64 == 0 || words.empty() || words.back() >> columns % 64 == 0;
}

}  // namespace sightline::bake
