// Memory that counts what is taken from it.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "sightline/base/memory.h"

namespace sightline::test {

class CountingMemory final : public Memory {
public:
    std::atomic<uint64_t> allocations{0};
    std::atomic<size_t> bytes{0}, most{0};  ///< in use now, and at the most so far where one thread asks

    void* allocate(size_t size, size_t alignment) override {
        ++allocations;
        most = std::max<size_t>(most, bytes += size);
        return defaultMemory()->allocate(size, alignment);
    }
    void deallocate(void* place, size_t size, size_t alignment) override {
        bytes -= size;
        defaultMemory()->deallocate(place, size, alignment);
    }
};

}  // namespace sightline::test
