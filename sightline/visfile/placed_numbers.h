// Numbers that lie in a file's bytes, read where they are.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>

namespace sightline {

/// Little-endian numbers at any address, on every machine. The bytes must outlive it.
template <class T>
class PlacedNumbers {
public:
    PlacedNumbers() = default;
    /// @param bytes  a multiple of sizeof(T)
    explicit PlacedNumbers(std::span<const char> bytes) : bytes_(bytes.data()), count_(bytes.size() / sizeof(T)) {}

    size_t size() const { return count_; }
    /// @pre i < size()
    T operator[](size_t i) const {
        T value;
        std::memcpy(&value, bytes_ + i * sizeof(T), sizeof value);
        if constexpr (std::endian::native == std::endian::big) {
            char* first = reinterpret_cast<char*>(&value);
            std::reverse(first, first + sizeof value);
        }
        return value;
    }

private:
    const char* bytes_ = nullptr;
    size_t count_ = 0;
};

}  // namespace sightline
