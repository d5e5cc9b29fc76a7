// Plain numbers as bytes and back, little-endian on every machine; and a hash of bytes.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "sightline/base/array.h"

namespace sightline {

/// Appends numbers to an array of bytes.
class ByteWriter {
public:
    explicit ByteWriter(Array<char>& out) : out_(out) {}

    template <class T>
    void put(T value) {
        static_assert(std::is_arithmetic_v<T>);
        char bytes[sizeof(T)];
        std::memcpy(bytes, &value, sizeof value);
        if constexpr (std::endian::native == std::endian::big) std::reverse(bytes, bytes + sizeof bytes);
        out_.insert(out_.end(), bytes, bytes + sizeof bytes);
    }

private:
    Array<char>& out_;
};

/// Takes numbers from bytes, and knows where it is. Whoever takes has looked at left() before: past the end there is
/// only zero.
class ByteCursor {
public:
    ByteCursor() = default;
    /// @param first  the place of the first byte, as at() tells it
    explicit ByteCursor(std::span<const char> bytes, uint64_t first = 0) : bytes_(bytes), first_(first) {}

    uint64_t at() const { return first_ + place_; }
    uint64_t left() const { return bytes_.size() - place_; }

    template <class T>
    T take() {
        static_assert(std::is_arithmetic_v<T> && !std::is_same_v<T, bool>);
        if (left() < sizeof(T)) {
            place_ = bytes_.size();
            return T(0);
        }
        char bytes[sizeof(T)];
        std::memcpy(bytes, bytes_.data() + place_, sizeof bytes);
        if constexpr (std::endian::native == std::endian::big) std::reverse(bytes, bytes + sizeof bytes);
        place_ += sizeof bytes;
        T value;
        std::memcpy(&value, bytes, sizeof value);
        return value;
    }

private:
    std::span<const char> bytes_;
    uint64_t first_ = 0;
    size_t place_ = 0;
};

/// A hash that finds damage, not malice. The same on every machine; eight bytes a step.
inline uint64_t contentHash(std::span<const char> bytes) {
    uint64_t hash = 0x9e3779b97f4a7c15ull ^ bytes.size();
    ByteCursor cursor(bytes);
    const auto mix = [&](uint64_t word) {
        hash = (hash ^ word) * 0xd6e8feb86659fd93ull;
        hash ^= hash >> 32;
    };
    while (cursor.left() >= 8) mix(cursor.take<uint64_t>());
    while (cursor.left() > 0) mix(cursor.take<uint8_t>());
    return hash;
}

}  // namespace sightline
