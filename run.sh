#!/usr/bin/env bash
# Sets up, builds and runs the sightline tool: without arguments the main job, with arguments that verb.
# SPDX-License-Identifier: MIT
#
# ./run.sh              culls a flight through a city of 100,000 objects, verifies it, and writes out/index.html
# ./run.sh VERB ARGS    runs the verb; only the tool writes to standard output
set -euo pipefail

root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
build=$root/build/release
tool=$build/bin/sightline

say() { printf 'sightline: %s\n' "$*" >&2; }

# Paths in the arguments are the caller's: nothing here changes the working directory.
prepare() {
    "$root/tools/setup"
    mkdir -p "$build"
    # Two runs at once build one after the other. The lock must not outlive this block in the tool itself.
    exec {lock}>"$build/.lock"
    flock "$lock"
    if [ ! -f "$build/build.ninja" ]; then
        say "configuring build/release"
        (cd "$root" && cmake --preset release) >&2
    fi
    if ! ninja -C "$build" -n "$@" 2>/dev/null | grep -q 'no work to do'; then
        say "building build/release"
        ninja -C "$build" "$@" >&2
    fi
    exec {lock}>&-
}

# The verbs `bench` and `view` are programs of their own, which take a minute more.
programs=(sightline)
case " $* " in *" bench "*) programs+=(sightline-bench) ;; esac
case " $* " in *" view "*) programs+=(sightline-view) ;; esac
prepare "${programs[@]}"
if [ $# -gt 0 ]; then exec "$tool" "$@"; fi

say "culling a flight through a city of 100,000 objects, and proving every cull"
"$tool" cull city:1:100000 --frames 32 --verify --report "$root/out"
say "the report: $root/out/index.html"
