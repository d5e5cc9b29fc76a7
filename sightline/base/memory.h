// The allocator hook: worlds, snapshots, occluders and queries take their memory from one source, which a user may give.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>

namespace sightline {

/// Where memory comes from. It must outlive all that was made in it, and be thread-safe if that is used by several
/// threads.
class Memory {
public:
    virtual ~Memory() = default;
    /// @param bytes      [> 0]
    /// @param alignment  [a power of two]
    /// @returns never null
    virtual void* allocate(size_t bytes, size_t alignment) = 0;
    /// @param place  of allocate(), with the same size and alignment
    virtual void deallocate(void* place, size_t bytes, size_t alignment) = 0;
};

/// The source where no other is given: the program's new and delete.
Memory* defaultMemory();

/// Memory as the standard library's containers take it.
template <class T>
struct MemoryAllocator {
    using value_type = T;

    Memory* memory = defaultMemory();

    MemoryAllocator() = default;
    MemoryAllocator(Memory* from) : memory(from) {}
    template <class Other>
    MemoryAllocator(const MemoryAllocator<Other>& other) : memory(other.memory) {}
    T* allocate(size_t count) { return static_cast<T*>(memory->allocate(count * sizeof(T), alignof(T))); }
    void deallocate(T* place, size_t count) { memory->deallocate(place, count * sizeof(T), alignof(T)); }
    bool operator==(const MemoryAllocator&) const = default;
};

/// Gives an object back to the memory that it came from.
template <class T>
struct Release {
    Memory* memory = nullptr;

    void operator()(T* object) const {
        Memory* from = memory;
        object->~T();
        from->deallocate(object, sizeof(T), alignof(T));
    }
};

template <class T>
using Owned = std::unique_ptr<T, Release<T>>;

template <class T, class... Arguments>
Owned<T> makeOwned(Memory* memory, Arguments&&... arguments) {
    void* place = memory->allocate(sizeof(T), alignof(T));
    return Owned<T>(new (place) T(std::forward<Arguments>(arguments)...), Release<T>{memory});
}

template <class T, class... Arguments>
std::shared_ptr<T> makeShared(Memory* memory, Arguments&&... arguments) {
    return std::allocate_shared<T>(MemoryAllocator<T>(memory), std::forward<Arguments>(arguments)...);
}

}  // namespace sightline
