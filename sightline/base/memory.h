// The allocator hook: worlds, snapshots, occluders and queries take their memory from one source, which a user may give.
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <memory_resource>
#include <new>
#include <utility>
#include <vector>

namespace sightline {

/// Where memory comes from. It must outlive all that was made in it, and be thread-safe if that is used by several
/// threads; it may not return null.
using Memory = std::pmr::memory_resource;

/// The source where no other is given: the program's new and delete, unless std::pmr::set_default_resource() says so.
inline Memory* defaultMemory() { return std::pmr::get_default_resource(); }

/// An array in a given memory. Copying its elements leaves it there.
template <class T>
using Array = std::pmr::vector<T>;

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
    return std::allocate_shared<T>(std::pmr::polymorphic_allocator<T>(memory), std::forward<Arguments>(arguments)...);
}

}  // namespace sightline
