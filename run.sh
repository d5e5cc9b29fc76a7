#!/usr/bin/env bash
# Sets up, builds and runs the sightline tool: without arguments the main job, with arguments that verb.
# SPDX-License-Identifier: MIT
#
# ./run.sh              culls a flight through a city of 100,000 objects, verifies it, and writes out/index.html
# ./run.sh VERB ARGS    runs the verb; only the tool writes to standard output
#
# What a verb does not need is not built for it: `bench`, `view`, the verbs of sightline-lab and the reader of foreign formats
# are built when they are first asked for.
set -euo pipefail

root=${BASH_SOURCE[0]%/*}
[ "$root" != "${BASH_SOURCE[0]}" ] || root=.
root=$(cd -- "$root" && pwd)
build=$root/build/release
tool=$build/bin/sightline

say() { printf 'sightline: %s\n' "$*" >&2; }

# True if each program is there and nothing that it may be made of has changed since it was built.
fresh() {
    local program
    for program in "$@"; do [ -f "$build/.built-$program" ] && [ -x "$build/bin/$program" ] || return 1; done
    # The oldest of the marks is what sources are held against.
    local oldest=$build/.built-$1
    for program in "$@"; do [ "$build/.built-$program" -nt "$oldest" ] || oldest=$build/.built-$program; done
    [ -z "$(cd "$root" && find CMakeLists.txt CMakePresets.json cmake sightline apps bench bindings \
        -newer "$oldest" -print -quit 2>/dev/null)" ]
}

# False if an IFC file is named, and what reads it is not there.
ifc_is_there() { [ -z "$ifc" ] || [ -f "$build/bin/ifc/web-ifc/web-ifc-node.wasm" ]; }

# Paths in the arguments are the caller's: nothing here changes the working directory.
prepare() {
    fresh "$@" && ifc_is_there && return
    "$root/tools/setup" ${ifc:+--ifc}
    mkdir -p "$build"
    # Two runs at once build one after the other. The lock must not outlive this block in the tool itself.
    exec {lock}>"$build/.lock"
    flock "$lock"
    if [ ! -f "$build/build.ninja" ]; then
        say "configuring build/release"
        (cd "$root" && cmake --preset release) >&2
    fi
    local mark program
    mark=$(mktemp "$build/.mark-XXXXXX")  # as old as what ninja is about to read
    if ! ninja -C "$build" -n "$@" 2>/dev/null | grep -q 'no work to do'; then
        say "building $*; the first time this takes minutes"
        ninja -C "$build" "$@" >&2
    fi
    for program in "$@"; do touch -r "$mark" "$build/.built-$program"; done
    rm -f "$mark"
    exec {lock}>&-
}

programs=(sightline) ifc=
for word in "$@"; do
    case $word in
        bench) programs+=(sightline-bench) ;;
        view) programs+=(sightline-view) ;;
        render|sight|replay|check|judge|export|calibrate|profile|advise|report|config) programs+=(sightline-lab) ;;
        *.glb|*.gltf|*.bsp|*.map|*.prt|*.pak|*.pk3|*.vis|*.json|*.toml|*.frame|*.png) ;;
        *.*) if [ -f "$word" ]; then programs+=(sightline-import); fi
             case $word in *.[iI][fF][cC]|*.[iI][fF][cC][zZ][iI][pP]) ifc=yes ;; esac ;;
    esac
done
# The case `bench ablate` builds the tool itself, once without each mechanism.
if [ "${1-} ${2-}" = 'bench ablate' ]; then prepare sightline; exec "$root/bench/ablate" "${@:3}"; fi
prepare "${programs[@]}"
if [ $# -gt 0 ]; then exec "$tool" "$@"; fi

say "culling a flight through a city of 100,000 objects, and proving every cull"
"$tool" cull city:1:100000 --frames 16 --size 960x540 --verify --rays 200000 --report "$root/out"
say "the report: $root/out/index.html"
