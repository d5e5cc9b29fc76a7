#!/usr/bin/env python3
# Holds the C interface to its stored layout: functions, structs and enumerators, as C99 and as C++ read them.
# SPDX-License-Identifier: MIT
"""abi_test.py --cc CC --cxx CXX --nm NM --library LIBSIGHTLINE.so [--update]

Fails unless
  - the header alone compiles as strict C99 and as C++;
  - the shared library exports the functions that the headers declare, and nothing else;
  - sizes, offsets, enumerators and functions are those of abi.txt, or --update writes them there.
Below version 1.0 a minor version may change the interface: its change then stands in abi.txt, for all to see.
"""
import argparse
import difflib
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
HEADERS = sorted((ROOT / "sightline" / "c").rglob("*.h"))
TOP = {"sightline": '#include "sightline/c/sightline.h"\n', "bake": '#include "sightline/c/bake/bake.h"\n'}


def public_text():
    """What the public headers say, without comments and directives. Those of the implementation include C++."""
    texts = [path.read_text() for path in HEADERS]
    text = "\n".join(t for t in texts if 'extern "C"' in t)
    text = re.sub(r"/\*.*?\*/|//[^\n]*", "", text, flags=re.S)
    return re.sub(r"^\s*#.*$", "", text, flags=re.M)


def fields(body):
    for declaration in filter(None, (d.strip() for d in body.split(";"))):
        pointer = re.search(r"\(\*(\w+)\)", declaration)
        if pointer:
            yield pointer[1]
            continue
        for declarator in declaration.split(","):
            yield re.search(r"(\w+)\s*(?:\[\w+\]\s*)*$", declarator)[1]


def functions(text):
    return sorted(re.findall(r"SL_API [^;]*?\b(sl\w+)\(", text))


def signatures(text):
    return sorted(" ".join(s.split()) for s in re.findall(r"SL_API ([^;]*);", text))


def layout(text, cc, folder):
    """Compiles and runs a program that prints it."""
    lines = []
    for body, name in re.findall(r"typedef struct \w+ \{(.*?)\} (\w+);", text, flags=re.S):
        lines.append(f'printf("struct {name} %zu\\n", sizeof({name}));')
        lines += [f'printf("  {f} %zu\\n", offsetof({name}, {f}));' for f in fields(body)]
    for body in re.findall(r"enum \w* ?\{(.*?)\}", text, flags=re.S):
        names = [e.split("=")[0].strip() for e in body.split(",")]
        lines += [f'printf("enum {n} %d\\n", (int){n});' for n in names if n]
    source = folder / "layout.c"
    headers = "".join(top for name, top in TOP.items() if (ROOT / top.split('"')[1]).exists())
    source.write_text("#include <stddef.h>\n#include <stdio.h>\n" + headers +
                      "int main(void) {\n" + "\n".join(lines) + "\nreturn 0;\n}\n")
    program = folder / "layout"
    subprocess.run([cc, "-std=c99", "-I", ROOT, source, "-o", program], check=True)
    return subprocess.run([program], check=True, capture_output=True, text=True).stdout.splitlines()


def compile_alone(arguments, folder):
    for top in TOP.values():
        if not (ROOT / top.split('"')[1]).exists():
            continue
        for compiler, ending, flags in ((arguments.cc, "c", ["-std=c99", "-Wstrict-prototypes"]),
                                        (arguments.cxx, "cpp", ["-std=c++11"])):
            source = folder / f"alone.{ending}"
            source.write_text(top + "int main(void) { return 0; }\n")
            subprocess.run([compiler, *flags, "-Wall", "-Wextra", "-pedantic", "-Werror", "-fsyntax-only", "-I", ROOT,
                            source], check=True)


def exported(nm, library):
    out = subprocess.run([nm, "-D", "--defined-only", library], check=True, capture_output=True, text=True).stdout
    return sorted(line.split()[-1].split("@")[0] for line in out.splitlines() if line.split()[-2] in "TWVBDR")


def main():
    parser = argparse.ArgumentParser()
    for option in ("--cc", "--cxx", "--nm"):
        parser.add_argument(option, required=True)
    parser.add_argument("--library", required=True, action="append")
    parser.add_argument("--update", action="store_true")
    arguments = parser.parse_args()
    text = public_text()
    with tempfile.TemporaryDirectory() as made:
        folder = pathlib.Path(made)
        compile_alone(arguments, folder)
        found = layout(text, arguments.cc, folder) + signatures(text)
    declared, names = functions(text), sorted(sum((exported(arguments.nm, l) for l in arguments.library), []))
    if declared != names:
        print("declared and not exported:", *sorted(set(declared) - set(names)))
        print("exported and not declared:", *sorted(set(names) - set(declared)))
        return 1
    stored = HERE / "abi.txt"
    if arguments.update:
        stored.write_text("\n".join(found) + "\n")
    before = stored.read_text().splitlines()
    for line in difflib.unified_diff(before, found, "abi.txt", "the headers", lineterm=""):
        print(line)
    return 0 if before == found else 1


if __name__ == "__main__":
    sys.exit(main())
