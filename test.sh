#!/usr/bin/env bash
# Sets up, builds build/release and passes all tests; --full adds the format, the fuzzers, the sanitizers, ARM, Windows and the packages.
# SPDX-License-Identifier: MIT
set -euo pipefail

cd -- "$(dirname -- "${BASH_SOURCE[0]}")"
full=
case "${1:-}" in
    '') ;;
    --full) full=1 ;;
    *) echo "usage: ./test.sh [--full]" >&2; exit 2 ;;
esac

step() { printf '\n== %s\n' "$*"; }

# Configures and builds a preset.
build() {
    [ -f "build/$1/build.ninja" ] || cmake --preset "$1"
    cmake --build --preset "$1"
}

if [ -n "$full" ]; then tools/setup --full; else tools/setup --tests; fi

if [ -n "$full" ]; then
    step "format"
    tools/format --check

    step "clang without a warning"
    tools/check_clang

    step "fuzzers, half a minute each"
    build fuzz
    tests/fuzz/run 30
fi

step "release"
build release
if [ -n "$full" ]; then
    # Which tests start threads is written down on the way.
    rm -f build/release/threads.txt
    export SIGHTLINE_THREAD_LOG=$PWD/build/release/threads.txt
    LD_PRELOAD=$PWD/build/release/tests/libsightline_thread_log.so \
        ctest --preset release --output-log build/release/test.log
else
    ctest --preset release --output-log build/release/test.log
fi

if [ -n "$full" ]; then
    step "asan"
    build asan
    ctest --preset asan --output-log build/asan/test.log

    step "tsan, of the tests that start threads"
    build tsan
    ctest --preset tsan --output-log build/tsan/test.log -R "^($(sort -u build/release/threads.txt | paste -sd '|'))( |\$)"

    step "64-bit ARM and Windows, by emulators"
    tools/try_foreign || [ $? -eq 77 ]

    step "packages, in a bare Debian"
    tools/try_packages || [ $? -eq 77 ]
fi
