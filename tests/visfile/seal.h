// Gives a changed file the hash of what it holds, so that readers look further.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/base/bytes.h"
#include "sightline/visfile/section_file.h"

namespace sightline::test {

inline void seal(Array<char>& bytes) {
    using namespace section_file;
    if (bytes.size() < kHashedAt) return;
    const uint64_t hash = contentHash(std::span<const char>(bytes).subspan(kHashedAt));
    for (size_t i = 0; i < 8; ++i) bytes[kHashAt + i] = static_cast<char>(hash >> 8 * i);
}

}  // namespace sightline::test
