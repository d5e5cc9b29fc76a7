#!/usr/bin/env python3
# Holds tools/check_layers to its promise: made trees with one violation each must fail and name file and line.
# SPDX-License-Identifier: MIT
import pathlib
import subprocess
import tempfile
import unittest

CHECKER = pathlib.Path(__file__).resolve().parents[2] / "tools" / "check_layers"


def check(files):
    """Exit code and output of the checker on a tree of {path: text}."""
    with tempfile.TemporaryDirectory() as root:
        for path, text in files.items():
            file = pathlib.Path(root) / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
        done = subprocess.run([CHECKER, root], capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr


class CheckLayers(unittest.TestCase):
    def assertFails(self, files, *words):
        code, output = check(files)
        self.assertEqual(code, 1, output)
        for word in words:
            self.assertIn(word, output)

    def test_accepts_includes_that_point_up(self):
        code, output = check({
            "sightline/run/query.cpp": '#include "sightline/cull/frustum.h"\n#include <vector>\n',
            "sightline/cull/frustum.h": '#include <sightline/math/box.h>\n',
            "bench/bench.cpp": '#include "bench/bench.h"\n#include "sightline/truth/verify.h"\n',
            "apps/cli/main.cpp": '#include "apps/cli/options.h"\n',
        })
        self.assertEqual(code, 0, output)

    def test_names_file_and_line_of_a_way_down(self):
        self.assertFails({"sightline/base/a.h": '// one\n#include "sightline/math/box.h"\n'},
                         "sightline/base/a.h:2:", "must not include sightline/math/")

    def test_fails_when_run_includes_hidden_or_scene(self):
        for other in ("hidden/zbuffer.h", "scene/scene.h", "import/gltf.h", "bake/bake.h"):
            self.assertFails({"sightline/run/a.cpp": f"#include <sightline/{other}>\n"}, "sightline/run/a.cpp:1:")

    def test_fails_when_a_witness_includes_what_it_judges(self):
        for other in ("cull/frustum.h", "raster/tiles.h", "run/query.h"):
            self.assertFails({"sightline/truth/a.cpp": f'#  include "sightline/{other}"\n'}, "sightline/truth/a.cpp:1:")

    def test_fails_on_a_folder_outside_the_table(self):
        self.assertFails({"sightline/misc/a.h": ""}, "sightline/misc/a.h:1:", "not in the table")
        self.assertFails({"sightline/a.h": ""}, "sightline/a.h:1:", "not in the table")
        self.assertFails({"apps/a.cpp": '#include "sightline/misc/a.h"\n'}, "apps/a.cpp:1:")

    def test_fails_on_relative_and_outward_includes(self):
        self.assertFails({"sightline/math/a.h": '#include "box.h"\n'}, "sightline/math/a.h:1:")
        self.assertFails({"sightline/math/a.h": '#include "apps/cli/options.h"\n'}, "sightline/math/a.h:1:")

    def test_keeps_mpi_in_its_folder(self):
        self.assertFails({"sightline/bake/a.cpp": "#include <mpi.h>\n"}, "sightline/bake/a.cpp:1:")

    def test_fails_on_an_empty_tree(self):
        self.assertFails({"README.md": ""}, "no C++ files")


if __name__ == "__main__":
    unittest.main()
