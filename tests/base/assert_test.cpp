// A broken invariant stops the program, after an engine's hook has heard of it.
// SPDX-License-Identifier: MIT
#include "sightline/base/assert.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace sightline {
namespace {

#if GTEST_HAS_DEATH_TEST
TEST(AssertDeathTest, StopsTheProgramOnceTheHookHasHeard) {
    const int two = 2;
    SIGHTLINE_ASSERT(two == 2);
    EXPECT_DEATH(SIGHTLINE_ASSERT(two == 3), "assert_test.cpp:.*: assertion failed: two == 3");
    const auto hook = [](const char* expression, const char*, int line) {
        std::fprintf(stderr, "heard of %s in line %d\n", expression, line);
    };
    EXPECT_DEATH(
        {
            setAssertHook(hook);
            SIGHTLINE_ASSERT(two == 4);
        },
        "heard of two == 4 in line .*");
    EXPECT_DEATH(
        {
            setAssertHook(hook);
            setAssertHook(nullptr);
            SIGHTLINE_ASSERT(two == 5);
        },
        "assertion failed: two == 5");
}

TEST(AssertDeathTest, DebugAssertionsGoThroughTheSameHook) {
#ifdef SIGHTLINE_DEBUG_ASSERTS
    const int two = 2;
    SIGHTLINE_DEBUG_ASSERT(two == 2);
    EXPECT_DEATH(SIGHTLINE_DEBUG_ASSERT(two == 3), "assert_test.cpp:.*: assertion failed: two == 3");
    const auto hook = [](const char* expression, const char*, int line) {
        std::fprintf(stderr, "heard of %s in line %d\n", expression, line);
    };
    EXPECT_DEATH(
        {
            setAssertHook(hook);
            SIGHTLINE_DEBUG_ASSERT(two == 4);
        },
        "heard of two == 4 in line .*");
#else
    GTEST_SKIP() << "this build has no debug assertions";
#endif
}
#endif

TEST(Assert, DebugAssertionsAreEvaluatedInDebugBuildsAlone) {
    int evaluated = 0;
    const auto holds = [&] { return ++evaluated > 0; };
    SIGHTLINE_DEBUG_ASSERT(holds());
#ifdef SIGHTLINE_DEBUG_ASSERTS
    EXPECT_EQ(evaluated, 1);
#else
    EXPECT_EQ(evaluated, 0);
#endif
}

}  // namespace
}  // namespace sightline
