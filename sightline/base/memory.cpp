// The memory where no other is given: the program's new and delete.
// SPDX-License-Identifier: MIT
#include "sightline/base/memory.h"

namespace sightline {

namespace {

class NewDelete final : public Memory {
public:
    void* allocate(size_t bytes, size_t alignment) override {
        return alignment > __STDCPP_DEFAULT_NEW_ALIGNMENT__ ? ::operator new(bytes, std::align_val_t(alignment))
                                                            : ::operator new(bytes);
    }
    void deallocate(void* place, size_t, size_t alignment) override {
        alignment > __STDCPP_DEFAULT_NEW_ALIGNMENT__ ? ::operator delete(place, std::align_val_t(alignment))
                                                     : ::operator delete(place);
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
