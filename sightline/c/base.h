// What all of the C interface rests on: status codes, plain values, and what a program brings with it.
// SPDX-License-Identifier: MIT
//
// Ids are plain values, and a zeroed id is null. Defs come from slDefault...() and are copied. No call throws, and none
// stops the program because of what it was given: it answers with a status, and says a sentence through slLog. Memory or
// threads that run out end the program, but in a bake.
#ifndef SIGHTLINE_C_BASE_H
#define SIGHTLINE_C_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifndef SL_API
#if defined(_WIN32) && defined(SIGHTLINE_C_SHARED)
#ifdef SIGHTLINE_C_BUILDS
#define SL_API __declspec(dllexport)
#else
#define SL_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define SL_API __attribute__((visibility("default")))
#else
#define SL_API
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** How a call ends. Unless it is SL_OK or SL_NO_ROOM nothing has changed, and outputs are as they were. */
typedef enum slStatus {
    SL_OK = 0,
    SL_NO_ROOM, /**< an array of the caller's is too short: as much as fits was written, the count says what there is */
    SL_BAD_ARGUMENT, /**< a null pointer, an index beyond its array, or a value outside of its limits */
    SL_NO_DEFAULTS,  /**< a def, view or settings that did not begin as slDefault...() */
    SL_STALE_ID,     /**< an id that is null, or of something that was removed */
    SL_BAD_FILE,     /**< bytes that are no visibility file, or a damaged one */
    SL_NO_MEMORY,    /**< of a bake: there is not enough */
    SL_STOPPED       /**< of a bake: its caller ended it */
} slStatus;

/** The same in words: "an id is null, or of something that was removed". */
SL_API const char* slStatusWords(slStatus status);

/** The version of the library that runs, as 10000 * major + 100 * minor + patch. */
SL_API uint32_t slVersion(void);

/** Of the header that a program was compiled with. */
#define SL_VERSION 100

/** An axis-parallel box. It holds nothing if low > high along an axis. [world or object units] */
typedef struct slBox {
    double low[3], high[3];
} slBox;

/** A rectangle of the viewport. [pixels from the left and the top] */
typedef struct slRect {
    double left, top, right, bottom;
} slRect;

/** Where memory comes from. Both functions or neither; without them, from malloc's relatives. */
typedef struct slAllocator {
    /** Never null. alignment: a power of two. */
    void* (*allocate)(void* user, size_t bytes, size_t alignment);
    void (*release)(void* user, void* memory, size_t bytes, size_t alignment);
    void* user;
} slAllocator;

typedef void slTask(void* context, uint32_t index);

/** Threads that a query's strips are offered to. Without `run` the calling thread does them all. */
typedef struct slJobs {
    /** Calls task(context, i) once for each i of [0, count), in any order, on any threads; returns when all have
     * returned. Tasks do not wait for one another. */
    void (*run)(void* user, uint32_t count, slTask* task, void* context);
    void* user;
} slJobs;

/** Who hears of calls that fail and of views that cannot be used. Without `say`: one line on standard error. */
typedef struct slLog {
    void (*say)(void* user, slStatus status, const char* sentence);
    void* user;
} slLog;

/** A log that says nothing. */
SL_API slLog slSilence(void);

/** What a program brings with it; zeroed: nothing. The hooks must outlive what was made with them, and what that made:
 * snapshots of a world. If several threads use these, allocator and log must be thread-safe. */
typedef struct slHooks {
    slAllocator allocator;
    slJobs jobs;
    slLog log;
} slHooks;

/** Called where a broken invariant of the library itself stops the program, before it stops. Null: one line on standard
 * error. Not thread-safe. */
SL_API void slSetAssertHook(void (*hook)(const char* expression, const char* file, int line));

/** A few threads, for programs that have none of their own. */
typedef struct slThreadPool slThreadPool;

/** @param workers  threads that work, the caller's among them [1 to 1024] */
SL_API slStatus slCreateThreadPool(uint32_t workers, slThreadPool** pool_out);
SL_API void slDestroyThreadPool(slThreadPool* pool);
/** The hook that leads to them. */
SL_API slJobs slJobsOf(slThreadPool* pool);

#ifdef __cplusplus
}
#endif
#endif
