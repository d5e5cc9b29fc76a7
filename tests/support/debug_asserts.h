// Expects debug assertions to fail, in builds that have them.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <gtest/gtest.h>

namespace sightline::test {

/// Calls run() in a process of its own, where a debug assertion must fail whose text matches. Skips the test in builds
/// without debug assertions.
template <class Run>
void expectDebugAssert([[maybe_unused]] const std::string& text, [[maybe_unused]] const Run& run) {
#if defined(SIGHTLINE_DEBUG_ASSERTS) && GTEST_HAS_DEATH_TEST
    EXPECT_DEATH(run(), "assertion failed: .*" + text);
#else
    GTEST_SKIP() << "this build has no debug assertions";
#endif
}

}  // namespace sightline::test
