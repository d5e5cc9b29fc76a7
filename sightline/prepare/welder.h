// Gives equal positions the same number.
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace sightline {

/// Numbers positions in the order in which they come. Equal ones have one number, whatever the sign of a zero; nothing
/// is welded by tolerance. What is not a number equals nothing. O(1) each.
class Welder {
public:
    /// @param positions  the numbered ones, added to; empty, and nobody else's while this lives
    explicit Welder(std::vector<glm::vec3>& positions) : positions_(positions), slots_(1024, kFree) {}

    uint32_t number(const glm::vec3& given) {
        const glm::vec3 p = given + glm::vec3(0.0f);  // a negative zero becomes zero: equal positions have equal bits
        if (4 * positions_.size() > 3 * slots_.size()) grow();
        size_t at = slotOf(p);
        for (; slots_[at] != kFree; at = (at + 1) & (slots_.size() - 1))
            if (positions_[slots_[at]] == p) return slots_[at];
        slots_[at] = static_cast<uint32_t>(positions_.size());
        positions_.push_back(p);
        return slots_[at];
    }

private:
    static constexpr uint32_t kFree = ~uint32_t{0};

    size_t slotOf(const glm::vec3& p) const {
        uint64_t hash = 0x9e3779b97f4a7c15ull;
        for (float c : {p.x, p.y, p.z}) {
            hash = (hash ^ std::bit_cast<uint32_t>(c)) * 0xd6e8feb86659fd93ull;
            hash ^= hash >> 32;
        }
        return hash & (slots_.size() - 1);
    }

    void grow() {
        slots_.assign(2 * slots_.size(), kFree);
        for (uint32_t i = 0; i < positions_.size(); ++i) {
            size_t at = slotOf(positions_[i]);
            while (slots_[at] != kFree) at = (at + 1) & (slots_.size() - 1);
            slots_[at] = i;
        }
    }

    std::vector<glm::vec3>& positions_;
    std::vector<uint32_t> slots_;
};

}  // namespace sightline
