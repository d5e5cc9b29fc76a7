// What the reader of foreign formats may take: memory, time, and no longer than who asked for it.
// SPDX-License-Identifier: MIT
#include "apps/import/limits.h"

#include <algorithm>
#include <csignal>
#include <new>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "sightline/tools/import/foreign/scene_stream.h"

namespace sightline::import {
using namespace tools;
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif
#else
constexpr bool kSanitized = false;
#endif

void limit(decltype(RLIMIT_AS) what, rlim_t most) {
    rlimit now{};
    if (getrlimit(what, &now) != 0) return;
    if (now.rlim_max != RLIM_INFINITY) most = std::min(most, now.rlim_max);
    now.rlim_cur = most;
    now.rlim_max = most;
    setrlimit(what, &now);
}

}  // namespace

void setLimits(const Limits& limits) {
    if (limits.parent != 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (getppid() != limits.parent) _exit(1);  // it ended before we could ask
    }
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_FSIZE, 0);
    if (limits.memory != 0 && !kSanitized) limit(RLIMIT_AS, limits.memory);
    if (limits.seconds != 0) limit(RLIMIT_CPU, limits.seconds + 1);
    std::set_new_handler([] { _exit(kImportOutOfMemory); });
}

}  // namespace sightline::import
