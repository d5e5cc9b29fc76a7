// The assertion that every folder uses, and the hook through which an engine hears of it.
// SPDX-License-Identifier: MIT
#pragma once

namespace sightline {

/// Called with the failed expression and its place; must not return to the caller's code path
/// expecting repair: the program stops afterwards.
using AssertHook = void (*)(const char* expression, const char* file, int line);

/// Installs a hook that is called before the program stops; null restores the default, which
/// prints one line to standard error. Not thread-safe: install it at start-up.
void setAssertHook(AssertHook hook);

[[noreturn]] void assertFailed(const char* expression, const char* file, int line);

}  // namespace sightline

/// Holds in every build: a broken invariant stops the program instead of hiding something visible.
#define SIGHTLINE_ASSERT(expression) \
    ((expression) ? (void)0 : ::sightline::assertFailed(#expression, __FILE__, __LINE__))

/// A precondition or an invariant that is checked in debug builds alone, so that it may stand in hot code. Elsewhere the
/// expression is compiled and never evaluated: it must have no side effect.
#ifdef SIGHTLINE_DEBUG_ASSERTS
#define SIGHTLINE_DEBUG_ASSERT(expression) SIGHTLINE_ASSERT(expression)
#else
#define SIGHTLINE_DEBUG_ASSERT(expression) ((void)sizeof(!(expression)))
#endif
