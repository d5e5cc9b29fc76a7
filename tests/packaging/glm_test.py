#!/usr/bin/env python3
# Which of GLM's macros a program may define: those that change what vectors are, are refused in words, and all others pass.
# SPDX-License-Identifier: MIT
"""glm_test COMPILER ROOT"""
import subprocess
import sys
import tempfile

PROGRAM = """#include <sightline/{header}>
int main() {{ return sizeof(sightline::{name}) == 0; }}
"""
HEADERS = {"sightline.h": "View", "geom/view.h": "View", "math/box.h": "Box3d", "geom/facing_clusters.h": "TurnedBox"}
PASS = [["GLM_FORCE_DEPTH_ZERO_TO_ONE", "GLM_FORCE_LEFT_HANDED", "GLM_FORCE_SWIZZLE", "GLM_FORCE_EXPLICIT_CTOR"],
        ["GLM_FORCE_XYZW_ONLY", "GLM_FORCE_INTRINSICS"]]
REFUSED = [["GLM_FORCE_DEFAULT_ALIGNED_GENTYPES", "GLM_FORCE_INTRINSICS"], ["GLM_FORCE_SIZE_T_LENGTH"]]


def compile_with(macros, header):
    with tempfile.NamedTemporaryFile("w", suffix=".cpp") as file:
        file.write(PROGRAM.format(header=header, name=HEADERS[header]))
        file.flush()
        words = [sys.argv[1], "-std=c++20", "-fsyntax-only", f"-I{sys.argv[2]}", *(f"-D{macro}" for macro in macros), file.name]
        return subprocess.run(words, capture_output=True, text=True, check=False)


faults = []
for macros in PASS:
    done = compile_with(macros, "sightline.h")
    if done.returncode != 0:
        faults.append(f"{macros}: {done.stderr}")
for macros in REFUSED:
    for header in HEADERS:
        done = compile_with(macros, header)
        first = next((line for line in done.stderr.splitlines() if "error" in line), "")
        if done.returncode == 0 or "Sightline takes GLM's" not in first:
            faults.append(f"{macros}, {header}: the first error is {first!r}")
print("\n".join(faults) or f"{len(PASS)} pass, {len(REFUSED)} are refused")
sys.exit(1 if faults else 0)
