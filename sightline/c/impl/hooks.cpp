// The hooks of the C interface: how they are copied, shared and heard.
// SPDX-License-Identifier: MIT
#include <cstdio>

#include "sightline/base/assert.h"
#include "sightline/base/thread_pool.h"
#include "sightline/c/impl/handles.h"

namespace sightline::c {

/// Not in the hooks' own memory: a query may hold them for longer than the world that brought them.
SharedHooks shareHooks(const slHooks* from) { return std::make_shared<Hooks>(from ? *from : slHooks{}); }

SharedHooks shareHooks(const slLog& log) {
    slHooks hooks{};
    hooks.log = log;
    return shareHooks(&hooks);
}

slStatus fail(const slLog& log, slStatus status, const char* call, const char* what) {
    char sentence[320];
    std::snprintf(sentence, sizeof sentence, "%s: %s", call, what);
    if (log.say) log.say(log.user, status, sentence);
    else std::fprintf(stderr, "sightline: %s\n", sentence);
    return status;
}

slStatus fail(const slLog& log, slStatus status, const char* call) {
    return fail(log, status, call, slStatusWords(status));
}

slStatus checkHooks(const slHooks* hooks, const char* call) {
    if (!hooks || !hooks->allocator.allocate == !hooks->allocator.release) return SL_OK;
    return fail(hooks->log, SL_BAD_ARGUMENT, call, "an allocator has both functions or neither");
}

}  // namespace sightline::c

using namespace sightline;

const char* slStatusWords(slStatus status) {
    switch (status) {
        case SL_OK:
            return "it is done";
        case SL_NO_ROOM:
            return "an array is too short";
        case SL_BAD_ARGUMENT:
            return "a null pointer, an index beyond its array, or a value outside of its limits";
        case SL_NO_DEFAULTS:
            return "a def, view or settings did not begin as slDefault...()";
        case SL_STALE_ID:
            return "an id is null, or of something that was removed";
        case SL_BAD_FILE:
            return "the bytes are no visibility file, or a damaged one";
        case SL_NO_MEMORY:
            return "there is not enough memory";
        case SL_STOPPED:
            return "its caller ended it";
    }
    return "there is no such status";
}

uint32_t slVersion(void) { return SL_VERSION; }

slLog slSilence(void) {
    return {[](void*, slStatus, const char*) {}, nullptr};
}

void slSetAssertHook(void (*hook)(const char* expression, const char* file, int line)) { setAssertHook(hook); }

struct slThreadPool {
    c::SharedHooks hooks;
    uint32_t workers;
    ThreadPool pool{workers};
};

slStatus slCreateThreadPool(uint32_t workers, slThreadPool** pool_out) {
    if (!pool_out) return c::fail({}, SL_BAD_ARGUMENT, "slCreateThreadPool", "pool_out is null");
    if (workers < 1 || workers > 1024)
        return c::fail({}, SL_BAD_ARGUMENT, "slCreateThreadPool", "workers must be 1 to 1024");
    *pool_out = c::makeHandle<slThreadPool>(c::shareHooks(nullptr), workers);
    return SL_OK;
}

void slDestroyThreadPool(slThreadPool* pool) { c::destroyHandle(pool); }

slJobs slJobsOf(slThreadPool* pool) {
    if (!pool) return {};
    const auto run = [](void* user, uint32_t count, slTask* task, void* context) {
        static_cast<slThreadPool*>(user)->pool.run(count, task, context);
    };
    return {run, pool};
}
