// Sets of numbers that grow together.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace sightline::tools {

/// Each number begins in a set of its own; a set is known by its least member.
class JoinedSets {
public:
    explicit JoinedSets(size_t size) : parents_(size) { std::iota(parents_.begin(), parents_.end(), 0u); }

    uint32_t find(uint32_t i) {
        while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
        return i;
    }
    void join(uint32_t a, uint32_t b) {
        const uint32_t root_a = find(a), root_b = find(b);
        parents_[std::max(root_a, root_b)] = std::min(root_a, root_b);
    }

private:
    std::vector<uint32_t> parents_;
};

}  // namespace sightline::tools
