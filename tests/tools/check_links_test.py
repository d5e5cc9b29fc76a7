#!/usr/bin/env python3
# The checker of links finds what is broken, and only that.
# SPDX-License-Identifier: MIT
import pathlib
import subprocess
import sys
import tempfile

CHECKER = pathlib.Path(__file__).resolve().parent.parent.parent / "tools" / "check_links"

TEXT = """# A page, with `code`

Good: [self](#a-page-with-code), [other](folder/other.md#second-one), [twice](folder/other.md#same-1), ![picture](p.png), [web](https://example.org/nothing).
Not links: `[code](nowhere.md)`
    [block](nowhere.md)
Bad: [file](nothing.md), [heading](folder/other.md#third)
and [own](#nowhere), ![picture](q.png)
"""
OTHER = "# Other\n\n## Second one\n\n## Same\n\n## Same\n\n[back](../page.md)\n"

with tempfile.TemporaryDirectory() as made:
    root = pathlib.Path(made)
    (root / "folder").mkdir()
    (root / "page.md").write_text(TEXT)
    (root / "folder" / "other.md").write_text(OTHER)
    (root / "p.png").write_bytes(b"")
    run = subprocess.run([sys.executable, CHECKER, root], capture_output=True, text=True)
    told = [line.split(": ")[1] for line in run.stdout.splitlines() if ": " in line]
    assert run.returncode == 1, run.stdout
    assert told == ["nothing.md", "folder/other.md#third", "#nowhere", "q.png"], run.stdout
    (root / "page.md").write_text(TEXT.split("Bad:")[0])
    run = subprocess.run([sys.executable, CHECKER, root], capture_output=True, text=True)
    assert run.returncode == 0 and run.stdout == "2 files, 0 broken links\n", run.stdout
