// An arithmetic coder of bits, and models that learn how likely a bit is.
// SPDX-License-Identifier: MIT
//
// Jorma Rissanen, Glen Langdon. Arithmetic Coding. 1979.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/base/array.h"

namespace sightline {

/// How likely the next bit is to be one, learnt from those before it: their mean while they are few, and then rather
/// the later ones'. Never surer than 511 to 1, so that a byte holds at most some 2,800 bits.
class BitModel {
public:
    /// In parts of 65536.
    uint32_t one() const { return one_; }
    void learn(bool bit) {
        constexpr int32_t kLeast = 65536 / 512;
        const int32_t step = ((bit ? 65536 : 0) - one_) * 2 / (2 * seen_ + 3);
        const int32_t next = one_ + step;
        one_ = next < kLeast ? kLeast : next > 65536 - kLeast ? 65536 - kLeast : next;
        if (seen_ < kMemory) ++seen_;
    }

private:
    static constexpr int32_t kMemory = 250;
    int32_t one_ = 32768, seen_ = 0;
};

/// Between `low` and `high` lies what the bytes are, read as one long number; each bit takes its share of what is left.
class BitRange {
protected:
    uint32_t split(const BitModel& model) const {
        return low_ + static_cast<uint32_t>(uint64_t{high_ - low_} * model.one() >> 16);
    }
    void take(bool bit, uint32_t split) { bit ? high_ = split : low_ = split + 1; }
    bool firstByteIsSure() const { return ((low_ ^ high_) & 0xff000000u) == 0; }
    void shift() {
        low_ <<= 8;
        high_ = high_ << 8 | 0xff;
    }

    uint32_t low_ = 0, high_ = ~0u;
};

/// Appends to bytes.
class BitEncoder : BitRange {
public:
    explicit BitEncoder(Array<char>& out) : out_(out) {}

    /// @returns the bit
    bool code(BitModel& model, bool bit) {
        take(bit, split(model));
        model.learn(bit);
        for (; firstByteIsSure(); shift()) out_.push_back(static_cast<char>(high_ >> 24));
        return bit;
    }
    /// After the last bit.
    void finish() { out_.push_back(static_cast<char>(high_ >> 24)); }

private:
    Array<char>& out_;
};

/// Takes the bits in the order in which they were put, given the same models. Past the end there is only zero.
class BitDecoder : BitRange {
public:
    explicit BitDecoder(std::span<const char> bytes) : bytes_(bytes) {
        for (int i = 0; i < 4; ++i) next();
    }

    /// @param bit  is not looked at
    /// @returns    the bit
    bool code(BitModel& model, bool bit = false) {
        const uint32_t at = split(model);
        bit = value_ <= at;
        take(bit, at);
        model.learn(bit);
        for (; firstByteIsSure(); shift()) next();
        return bit;
    }
    /// More was taken than was ever put.
    bool pastEnd() const { return taken_ > bytes_.size() + 3; }
    /// All that was put has been taken, and nothing else.
    bool atEnd() const { return taken_ == bytes_.size() + 3; }

private:
    void next() {
        value_ = value_ << 8 | (taken_ < bytes_.size() ? static_cast<unsigned char>(bytes_[taken_]) : 0u);
        ++taken_;
    }

    std::span<const char> bytes_;
    uint64_t taken_ = 0;
    uint32_t value_ = 0;
};

/// Whole numbers, small ones cheaper: the number of their bits in unary, then the bits below the first.
class NumberModel {
public:
    static constexpr uint32_t kBits = 18;

    /// @param value  below 2^kBits - 1; a decoder does not look at it
    template <class Coder>
    uint32_t code(Coder& coder, uint32_t value = 0) {
        uint32_t length = 0;
        while (length < kBits - 1 && coder.code(longer_[length], (value + 1) >> (length + 1) != 0)) ++length;
        uint32_t number = 1;
        for (uint32_t i = length; i-- > 0;) number = 2 * number + coder.code(bit_[length][i], (value + 1) >> i & 1);
        return number - 1;
    }

private:
    BitModel longer_[kBits - 1], bit_[kBits][kBits];
};

/// Numbers of either sign as numbers that are not negative.
constexpr uint32_t foldSign(int32_t value) {
    return value < 0 ? 2 * static_cast<uint32_t>(-value) - 1 : 2 * static_cast<uint32_t>(value);
}
constexpr int32_t unfoldSign(uint32_t value) {
    return value % 2 ? -static_cast<int32_t>(value / 2) - 1 : static_cast<int32_t>(value / 2);
}

}  // namespace sightline
