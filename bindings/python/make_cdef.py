#!/usr/bin/env python3
# Writes what cffi must know of the C interface, from its headers.
# SPDX-License-Identifier: MIT
"""make_cdef.py HEADERS OUT: HEADERS is the folder sightline/c, OUT the file _cdef.py of the package."""
import pathlib
import re
import sys

# In the order in which one needs the other.
ORDER = ["base", "view", "world", "prepared", "query", "explain", "sight", "ways", "shadows", "buffer"]


def main():
    headers, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    text = "\n".join((headers / f"{name}.h").read_text() for name in ORDER)
    text = re.sub(r"/\*.*?\*/|//[^\n]*", "", text, flags=re.S)
    numbers = re.findall(r"^#define SL_\w+ \d+\s*$", text, flags=re.M)
    text = re.sub(r"#ifdef __cplusplus.*?#endif", "", text, flags=re.S)
    text = re.sub(r"^\s*#.*$", "", text, flags=re.M).replace("SL_API ", "")
    text = "\n".join(line.strip() for line in (*numbers, *text.splitlines()) if line.strip())
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(f'# Made by make_cdef.py from the headers of the C interface.\nTEXT = """\n{text}\n"""\n')


main()
