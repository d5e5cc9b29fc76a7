// Writes down which tests start threads: ./test.sh --full preloads it, and gives the thread sanitizer these tests alone.
// SPDX-License-Identifier: MIT
//
// A process that runs one test of GoogleTest's, and every process below it, appends the test's name to the file that
// SIGHTLINE_THREAD_LOG names when it first starts a thread.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// Programs that a test starts have no name of their own, and inherit its.
__attribute__((constructor)) static void findTest(void) {
    static const char kFilter[] = "--gtest_filter=";
    char words[4096];
    FILE* const from = fopen("/proc/self/cmdline", "rb");
    if (!from) return;
    const size_t size = fread(words, 1, sizeof words - 1, from);
    fclose(from);
    words[size] = '\0';
    for (size_t at = 0; at < size; at += strlen(words + at) + 1)
        if (strncmp(words + at, kFilter, sizeof kFilter - 1) == 0)
            setenv("SIGHTLINE_TEST", words + at + sizeof kFilter - 1, 1);
}

// Whether code of ours starts a thread, itself or by std::thread, and not a library for its own work: Embree, Mesa.
static bool isOurs(const void* from) {
    Dl_info caller;
    if (dladdr(from, &caller) == 0 || !caller.dli_fname) return true;
    return !strstr(caller.dli_fname, "/lib/") || strstr(caller.dli_fname, "libstdc++");
}

static void note(void) {
    static bool noted = false;
    const char *const test = getenv("SIGHTLINE_TEST"), *const log = getenv("SIGHTLINE_THREAD_LOG");
    if (__atomic_exchange_n(&noted, true, __ATOMIC_RELAXED) || !test || !log) return;
    char line[512];
    const int size = snprintf(line, sizeof line, "%s\n", test);
    const int file = open(log, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0644);
    if (file < 0) return;
    if (size > 0 && write(file, line, (size_t)size) != size) perror(log);
    close(file);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*), void* argument) {
    int (*create)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
    *(void**)&create = dlsym(RTLD_NEXT, "pthread_create");
    if (isOurs(__builtin_return_address(0))) note();
    return create(thread, attributes, run, argument);
}
