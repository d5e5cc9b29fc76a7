// Whatever the bytes are, a bake goes on from them or refuses them with one line.
// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "tests/bake/state_check.h"

namespace {

void look(std::span<const char> bytes) {
    const std::string fault = sightline::test::bakeStateFault(bytes);
    if (fault.empty()) return;
    std::fprintf(stderr, "%s\n", fault.c_str());
    std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    const std::span<const char> bytes(reinterpret_cast<const char*>(data), size);
    look(bytes);
    look(sightline::test::sealedState(bytes));
    return 0;
}
