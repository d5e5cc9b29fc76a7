// Memory that counts what is taken from it.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory_resource>

namespace sightline::test {

class CountingMemory final : public std::pmr::memory_resource {
public:
    std::atomic<uint64_t> allocations{0};
    std::atomic<size_t> bytes{0}, most{0};  ///< in use now, and at the most so far where one thread asks

private:
    void* do_allocate(size_t size, size_t alignment) override {
        ++allocations;
        most = std::max<size_t>(most, bytes += size);
        return std::pmr::new_delete_resource()->allocate(size, alignment);
    }
    void do_deallocate(void* place, size_t size, size_t alignment) override {
        bytes -= size;
        std::pmr::new_delete_resource()->deallocate(place, size, alignment);
    }
    bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }
};

}  // namespace sightline::test
