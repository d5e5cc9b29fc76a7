// The memory where no other is given: the program's new and delete.
// SPDX-License-Identifier: MIT
#include "sightline/base/memory.h"

namespace sightline {

namespace {

class NewDelete final : public Memory {
public:
    // No conditional operators: Clang 14 runs both branches of one that holds two deletes.
    void* allocate(size_t bytes, size_t alignment) override {
        if (alignment > __STDCPP_DEFAULT_NEW_ALIGNMENT__) return ::operator new(bytes, std::align_val_t(alignment));
        return ::operator new(bytes);
    }
    void deallocate(void* place, size_t, size_t alignment) override {
        if (alignment > __STDCPP_DEFAULT_NEW_ALIGNMENT__) return ::operator delete(place, std::align_val_t(alignment));
        ::operator delete(place);
    }
};

}  // namespace

Memory* defaultMemory() {
    // Never destroyed: what is made in it may end later than the program's other statics.
    alignas(NewDelete) static char place[sizeof(NewDelete)];
    static Memory* const memory = new (place) NewDelete;
    return memory;
}

}  // namespace sightline
