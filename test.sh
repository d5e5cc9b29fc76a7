#!/usr/bin/env bash
# Sets up, builds and passes the tests that every change must pass; --full passes all the others, in parts.
# SPDX-License-Identifier: MIT
#
# ./test.sh                     build/release: the tests of the runtime, the bake, the tools and the command line
# ./test.sh --full              all parts, in this order:
#     format      clang-format
#     clang       each source by clang, warnings are errors
#     fuzz        each fuzzer for half a minute
#     release     every test of build/release; writes down which of them start threads
#     asan        tests with the address and undefined-behaviour sanitizers and debug assertions
#     tsan        tests that start threads, with the thread sanitizer
#     foreign     the library for 64-bit ARM and for Windows, by emulators
#     packages    the Debian packages, in a bare Debian 12
#     mutations   twenty wrong lines, each of which the tests must notice
# ./test.sh --full PART...      these parts
# ./test.sh --full --again      all parts, those too that have passed
#
# A part that has passed is not repeated until a file that it looks at changes, so that --full goes on where it was ended.
# build/full.log lists what passed, when, and on which commit.
set -euo pipefail

cd -- "$(dirname -- "${BASH_SOURCE[0]}")"
parts=(format clang fuzz release asan tsan foreign packages mutations)
usage() { echo "usage: ./test.sh [--full [--again] [PART...]], PART: ${parts[*]}" >&2; exit 2; }
step() { printf '\n== %s\n' "$*"; }

# Configures a preset and builds a target of it.
build() {
    [ -f "build/$1/build.ninja" ] || cmake --preset "$1"
    cmake --build --preset "$1" --target "${2:-all}"
}

# Tests that take long and find what others find, too: for part release of --full alone. A pattern.
slow() { grep -v '^#' tests/full_only.txt | paste -sd '|'; }

core() {
    tools/setup --tests
    build release sightline_core_tests
    ctest --preset release --output-log build/release/test.log -LE full -E "^(.*_NOT_BUILT|$(slow))( |\$)"
}

# Exit code 77: this machine lacks what the part needs. It is told, and not written down as passed.
is_skipped() { [ "$1" -eq 77 ] && skipped=1; }

part_format() { tools/format --check; }
part_clang() { tools/check_clang; }
part_fuzz() { build fuzz sightline_fuzzers; tests/fuzz/run 30; }
part_release() {
    build release
    rm -f build/release/threads.txt
    LD_PRELOAD=$PWD/build/release/tests/libsightline_thread_log.so SIGHTLINE_THREAD_LOG=$PWD/build/release/threads.txt \
        ctest --preset release --output-log build/release/test.log
}
part_asan() {
    build asan
    # Walls of large scenes and maps cost a hundred times as much, and are made by the same lines as those of small ones.
    ctest --preset asan --output-log build/asan/test.log -E "^(Real/.*|(Scenes/)?SoupScenes.*|$(slow))( |\$)"
}
part_tsan() {
    [ -s build/release/threads.txt ] || part_release
    build tsan
    # On large scenes and maps the same threads run as on small ones, a hundred times as slowly.
    local small
    small=$(sort -u build/release/threads.txt | grep -vE '^(Real|Scenes)/|^SoupScenes\.' | paste -sd '|')
    ctest --preset tsan --output-log build/tsan/test.log -R "^($small)( |\$)" -E "^($(slow))( |\$)"
}
part_foreign() { tools/try_foreign || is_skipped $?; }
part_packages() { build release; tools/try_packages || is_skipped $?; }
part_mutations() { build release; tools/mutate; }

# What a part looks at: folders and files.
looks_at() {
    local code=(sightline apps bench bindings examples integrations tests cmake CMakeLists.txt CMakePresets.json)
    case $1 in
        format) printf '%s\n' sightline apps bench bindings examples integrations tests tools/format .clang-format ;;
        clang) printf '%s\n' "${code[@]}" tools/check_clang ;;
        fuzz) printf '%s\n' sightline tests/fuzz tests/visfile tests/tools cmake CMakeLists.txt CMakePresets.json ;;
        asan|tsan) printf '%s\n' "${code[@]}" ;;
        foreign) printf '%s\n' sightline bindings examples tests cmake CMakeLists.txt CMakePresets.json tools/try_foreign ;;
        packages) printf '%s\n' sightline apps bench bindings examples docs packaging cmake CMakeLists.txt tools/try_packages ;;
        mutations) printf '%s\n' sightline tests cmake CMakeLists.txt tools/mutate tools/relink.py ;;
        release) echo . ;;
    esac
}

# One number for the contents of all that a part looks at; empty outside of a git checkout.
state_of() {
    git rev-parse --git-dir >/dev/null 2>&1 || return 0
    looks_at "$1" | xargs git ls-files -co --exclude-standard -- | sort -u | while read -r file; do
        [ ! -f "$file" ] || printf '%s\n' "$file"
    done | xargs -d '\n' sha1sum | sha1sum | cut -c1-40
}

run_part() {
    local part=$1 state started=$SECONDS
    state=$(state_of "$part")
    if [ -z "$again" ] && [ -n "$state" ] && grep -q " $part passed .* $state\$" build/full.log 2>/dev/null; then
        step "$part: passed on these files before"
        return
    fi
    step "$part"
    skipped=
    "part_$part"
    if [ -n "$skipped" ]; then
        step "$part: skipped, see above"
        return
    fi
    printf '%s %s passed in %d s on %s, state %s\n' "$(date -u +%FT%TZ)" "$part" $((SECONDS - started)) \
        "$(git describe --always --dirty 2>/dev/null || echo unknown)" "$state" >>build/full.log
}

full= again= chosen=()
for word in "$@"; do
    case $word in
        --full) full=1 ;;
        --again) again=1 ;;
        *) [[ " ${parts[*]} " == *" $word "* ]] || usage; chosen+=("$word") ;;
    esac
done
[ -n "$full" ] || [ $# -eq 0 ] || usage

if [ -z "$full" ]; then
    core
else
    tools/setup --full
    mkdir -p build
    [ ${#chosen[@]} -gt 0 ] || chosen=("${parts[@]}")
    for part in "${chosen[@]}"; do run_part "$part"; done
    step "all of it passed: ${chosen[*]}"
fi
