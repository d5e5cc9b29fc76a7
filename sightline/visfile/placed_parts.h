// What a section lies in its bytes as, part by part, without running past the end.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "sightline/visfile/placed_numbers.h"

namespace sightline {

/// Takes parts from the front. A part that is not there makes it fail for good, and is empty.
class PlacedParts {
public:
    explicit PlacedParts(std::span<const char> bytes) : bytes_(bytes) {}

    template <class T>
    PlacedNumbers<T> take(uint64_t count) {
        return PlacedNumbers<T>(take(count, sizeof(T)));
    }
    std::span<const char> take(uint64_t count, uint64_t size) {
        if (count > (bytes_.size() - at_) / size) {
            failed_ = true;
            return {};
        }
        const std::span<const char> part = bytes_.subspan(at_, count * size);
        at_ += part.size();
        return part;
    }
    /// All parts were there, and nothing is left.
    bool fits() const { return !failed_ && at_ == bytes_.size(); }
    bool failed() const { return failed_; }
    uint64_t at() const { return at_; }

private:
    std::span<const char> bytes_;
    uint64_t at_ = 0;
    bool failed_ = false;
};

/// Texts one after the other, by where each ends.
struct PlacedNames {
    PlacedNumbers<uint32_t> ends;
    std::span<const char> bytes;

    /// Whether the ends rise up to that of the bytes.
    bool fit() const {
        uint32_t last = 0;
        for (size_t i = 0; i < ends.size(); ++i) {
            if (ends[i] < last) return false;
            last = ends[i];
        }
        return last == bytes.size();
    }
    /// @pre fit(), i < ends.size()
    std::string_view operator[](size_t i) const {
        const uint32_t begin = i == 0 ? 0 : ends[i - 1];
        return {bytes.data() + begin, ends[i] - begin};
    }
};

}  // namespace sightline
