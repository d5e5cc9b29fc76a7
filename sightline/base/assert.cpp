// The assertion that every folder uses, and the hook through which an engine hears of it.
// SPDX-License-Identifier: MIT
#include "sightline/base/assert.h"

#include <cstdio>
#include <cstdlib>

namespace sightline {
namespace {
AssertHook g_hook = nullptr;
}

void setAssertHook(AssertHook hook) { g_hook = hook; }

void assertFailed(const char* expression, const char* file, int line) {
    if (g_hook) g_hook(expression, file, line);
    else std::fprintf(stderr, "%s:%d: assertion failed: %s\n", file, line, expression);
    std::abort();
}

}  // namespace sightline
