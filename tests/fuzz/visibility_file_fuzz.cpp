// Whatever the bytes are, a visibility file is opened with answers that fit each other, or refused with one line.
// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "../visfile/file_check.h"
#include "../visfile/seal.h"

namespace {

void look(const sightline::Array<char>& bytes) {
    bool opened = false;
    const std::string fault = sightline::test::faultOfReading(bytes, opened);
    if (fault.empty()) return;
    std::fprintf(stderr, "%s\n", fault.c_str());
    std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    sightline::Array<char> bytes(data, data + size);
    look(bytes);
    sightline::test::seal(bytes);
    look(bytes);
    return 0;
}
