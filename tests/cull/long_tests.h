// How many random cases a test of bounds makes.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdlib>

#include "tests/support/random.h"

namespace sightline::test {

/// SIGHTLINE_TEST_PAIRS, or SIGHTLINE_LONG_TESTS=1 for ten million, or what takes a few seconds.
inline int pairsToMake(int shorter) {
    if (const char* wanted = std::getenv("SIGHTLINE_TEST_PAIRS")) return std::max(std::atoi(wanted), 1000);
    return static_cast<int>(casesToMake(static_cast<size_t>(shorter)));
}

}  // namespace sightline::test
