#!/usr/bin/env python3
# The maker of the pages of figures writes what the tables say, and refuses malformed rows by file and line.
# SPDX-License-Identifier: MIT
import pathlib
import subprocess
import sys
import tempfile

MAKER = pathlib.Path(__file__).resolve().parent.parent.parent / "tools" / "performance"

HEADER = "date,commit,machine,scene,seed,what,value,unit,baseline,command\n"
FIRST = "2026-01-02,0123abc,big,hall,7,query,1234.50,us,,./run.sh cull SCENE --seed SEED\n"
ROWS = HEADER + FIRST + """2026-01-02,0123abc,big,hall,7,kept,20,objects,,./run.sh cull SCENE --seed SEED
2026-01-03,4567def,big,yard,7,query,90,us,,./run.sh cull SCENE --seed SEED
2026-01-03,4567def,big,hall,,ratio,0.5,,"a list, flat",./run.sh bench walks
2026-01-03,4567def,big,yard,,ratio,0.25,,"a list, flat",tools/tried
"""
TEMPLATE = """# Page
{{machines}}

{{table a.csv | query | kept}}

{{table a.csv | ratio}}

There are {{sum a.csv | query | kept}} of them.
"""
PAGE = """# Page
| machine | meaning |
|---|---|
| big | Two, cores |

- `./run.sh cull SCENE --seed 7` (big; 2026-01-02, 2026-01-03; 0123abc, 4567def)

|  | query [µs] | kept [objects] |
|---|---|---|
| hall | 1,234.50 | 20 |
| yard | 90 | – |

|  | ratio | command | machine, date, commit |
|---|---|---|---|
| hall | 0.5 | `./run.sh bench walks` | big; 2026-01-03; 4567def |
| yard | 0.25 | `tools/tried` | big; 2026-01-03; 4567def |

There are 1,344.50 of them.
"""
# What stands in place of the first row, and what is said of it.
MALFORMED = [
    ("2026-01-02,0123abc,big,hall,7,query,5,us,,a,b\n", "a.csv:2: 11 fields instead of 10"),
    (FIRST.replace("1234.50", '"1,234"'), 'a.csv:2: the value "1,234" is no plain number'),
    (FIRST.replace("1234.50", "1e3"), 'a.csv:2: the value "1e3" is no plain number'),
    (FIRST.replace("2026-01-02", "2026-13-02"), 'a.csv:2: the date "2026-13-02" is none'),
    (FIRST.replace("0123abc", "today"), 'a.csv:2: the commit "today" is no hash'),
    (FIRST.replace("big", "small"), 'a.csv:2: the machine "small" has no row in machines.csv'),
    (FIRST.replace("hall", ""), "a.csv:2: the column scene is empty"),
    (FIRST.replace("cull", "guess"), "a.csv:2: the repository has no longer the verb guess"),
    (FIRST.replace("cull SCENE", "bench runs"), "a.csv:2: the repository has no longer the case runs of bench"),
    (FIRST.replace("./run.sh cull", "tools/lost"), "a.csv:2: the repository has no longer tools/lost"),
    (FIRST + FIRST, "a.csv:3: results/a.csv:2 measures the same: a new figure replaces the old one"),
    (FIRST.replace("hall", '"hall'), "a.csv:"),
]

with tempfile.TemporaryDirectory() as made:
    root = pathlib.Path(made)
    results, page = root / "bench" / "results", root / "docs" / "page.md"
    for folder in (results, root / "docs", root / "tools", root / "apps" / "cli" / "verbs"):
        folder.mkdir(parents=True)
    for name in ("run.sh", "tools/tried", "apps/cli/verbs/cull.cpp", "apps/cli/verbs/bench.cpp"):
        (root / name).write_text("")
    (root / "bench" / "bench.cpp").write_text('    {"walks", benchWalks},\n')
    (results / "machines.csv").write_text('machine,meaning\nbig,"Two, cores"\n')
    (results / "page.md.in").write_text(TEMPLATE)
    (results / "a.csv").write_text(ROWS)

    def run(*options):
        return subprocess.run([sys.executable, MAKER, *options, root], capture_output=True, text=True)

    def check(code, told):
        found = run("--check")
        output = found.stdout + found.stderr
        assert found.returncode == code and told in output and output.count("\n") == (code != 0), (told, found)

    check(1, "docs/page.md: it differs from bench/results")
    assert not page.exists()
    assert run().returncode == 0
    assert page.read_text() == PAGE, page.read_text()
    check(0, "")

    (results / "a.csv").write_text(ROWS.replace("1234.50", "1234.75"))
    check(1, "docs/page.md: it differs from bench/results")
    assert page.read_text() == PAGE
    assert run().returncode == 0
    assert page.read_text() == PAGE.replace("1,234.50", "1,234.75").replace("1,344.50", "1,344.75"), page.read_text()

    for row, told in MALFORMED:
        (results / "a.csv").write_text(ROWS.replace(FIRST, row))
        check(2, "bench/results/" + told)
    (results / "a.csv").write_text(ROWS.replace("unit,", ""))
    check(2, "bench/results/a.csv:1: the header is not that of this file")

    (results / "a.csv").write_text(ROWS)
    for wrong, told in (("{{table b.csv | query}}", 'there is no file "b.csv"'), ("{{sum a.csv | speed}}", 'a.csv has no row with "speed"'),
                        ("{{chart a.csv}}", '"{{chart a.csv}}" is no directive')):
        (results / "page.md.in").write_text(TEMPLATE + wrong + "\n")
        check(2, "bench/results/page.md.in:9: " + told)
