#!/usr/bin/env python3
# Holds tools/check_layers to its promise: made trees with one violation each must fail and name file and line.
# SPDX-License-Identifier: MIT
import pathlib
import subprocess
import tempfile
import unittest

CHECKER = pathlib.Path(__file__).resolve().parents[2] / "tools" / "check_layers"
HEAD = "// Holds what a test needs.\n"


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
            "sightline/query/query.cpp": HEAD + '#include "sightline/cull/frustum.h"\n#include <vector>\n',
            "sightline/cull/frustum.h": HEAD + '#include <sightline/math/box.h>\n',
            "bench/bench.cpp": HEAD + '#include "bench/bench.h"\n#include "sightline/tools/truth/verify.h"\n',
            "apps/cli/main.cpp": HEAD + '#include "apps/cli/verbs/options.h"\n',
        })
        self.assertEqual(code, 0, output)

    def test_fails_on_cycles_of_units(self):
        files = {
            "sightline/base/a.h": HEAD + '#include "sightline/base/a-inl.h"\n',
            "sightline/base/a.cpp": HEAD + '#include "sightline/base/a.h"\n#include "sightline/base/b.h"\n',
            "sightline/base/b.h": HEAD + '#include "sightline/base/c.h"\n',
            "sightline/base/c.h": HEAD,
            "sightline/base/a-inl.h": HEAD + '#include "sightline/base/a.h"\n',
        }
        self.assertEqual(check(files)[0], 0)
        files["sightline/base/c.h"] += '#include "sightline/base/a-inl.h"\n'
        self.assertFails(files, "sightline/base/c.h:2:",
                         "sightline/base/a -> sightline/base/b -> sightline/base/c -> sightline/base/a")

    def test_fails_on_types_defined_twice(self):
        for one, other in (("struct Side {", "enum class Side : uint8_t { kLeft };"), ("class Side final : Base {", "union Side {"),
                           ("using Side = int;", "template <class T> struct Side {"), ("struct alignas(16) Side {", "struct Side")):
            self.assertFails({
                "sightline/base/a.h": HEAD + f"namespace sightline {{\n{one}\n}}  // namespace sightline\n",
                "bench/a.h": HEAD + f"namespace sightline {{\nnamespace detail {{\n{other}\n",
            }, "sightline/base/a.h:3: Side is defined at bench/a.h:4 too")

    def test_lets_types_of_one_name_stand_apart(self):
        code, output = check({
            "sightline/base/a.h": HEAD + "namespace sightline {\nclass Side;\nstruct Side {\n    struct Part {};\n};\nstruct Part {};\n"
                                         "}  // namespace sightline\n",
            "sightline/base/b.h": HEAD + "namespace sightline {\nstruct Side;\nnamespace {\nstruct Side {\n}  // namespace\n"
                                         "}  // namespace sightline\nnamespace sightline::gltf {\nstruct Side {\n",
            "sightline/base/b.cpp": HEAD + "struct Side {\n",
        })
        self.assertEqual(code, 0, output)

    def test_fails_on_first_lines_that_say_nothing(self):
        for first in ("", "#pragma once\n", "// SPDX-License-Identifier: MIT\n", "// Two lines for\n// one sentence.\n",
                      "// A sentence. SPDX-License-Identifier: MIT\n"):
            self.assertFails({"sightline/base/a.h": first}, "sightline/base/a.h:1:", "not a sentence")
            self.assertFails({"sightline/base/a.h": HEAD, "tests/base/a.cpp": first}, "tests/base/a.cpp:1:")

    def test_names_file_and_line_of_a_way_down(self):
        self.assertFails({"sightline/base/a.h": '// one\n#include "sightline/math/box.h"\n'},
                         "sightline/base/a.h:2:", "must not include sightline/math/")

    def test_fails_when_run_includes_hidden_or_scene(self):
        for other in ("studies/hidden/zbuffer/zbuffer.h", "tools/scene/scene.h", "tools/import/gltf/gltf.h", "bake/bake.h"):
            self.assertFails({"sightline/query/a.cpp": f"#include <sightline/{other}>\n"}, "sightline/query/a.cpp:1:")

    def test_fails_when_a_witness_includes_what_it_judges(self):
        for other in ("cull/frustum.h", "buffer/tiles.h", "query/query.h"):
            self.assertFails({"sightline/tools/truth/a.cpp": f'#  include "sightline/{other}"\n'}, "sightline/tools/truth/a.cpp:1:")

    def test_fails_on_a_folder_outside_the_table(self):
        self.assertFails({"sightline/misc/a.h": ""}, "sightline/misc/a.h:1:", "not in the table")
        self.assertFails({"sightline/a.h": ""}, "sightline/a.h:1:", "not in the table")
        self.assertFails({"apps/a.cpp": '#include "sightline/misc/a.h"\n'}, "apps/a.cpp:1:")

    def test_lets_users_alone_include_the_one_header(self):
        one = {"sightline/sightline.h": HEAD + '#include "sightline/query/query.h"\n',
               "apps/a.cpp": HEAD + "#include <sightline/sightline.h>\n"}
        self.assertEqual(check(one)[0], 0)
        self.assertFails(one | {"sightline/query/a.cpp": HEAD + '#include "sightline/sightline.h"\n'}, "sightline/query/a.cpp:2:")
        self.assertFails({"sightline/sightline.h": HEAD + '#include "sightline/bsp/bsp.h"\n'}, "sightline/sightline.h:2:")

    def test_fails_on_relative_and_outward_includes(self):
        self.assertFails({"sightline/math/a.h": '#include "box.h"\n'}, "sightline/math/a.h:1:")
        self.assertFails({"sightline/math/a.h": '#include "apps/cli/verbs/options.h"\n'}, "sightline/math/a.h:1:")

    def test_keeps_mpi_in_its_folder(self):
        self.assertFails({"sightline/bake/a.cpp": "#include <mpi.h>\n"}, "sightline/bake/a.cpp:1:")

    def test_fails_on_an_empty_tree(self):
        self.assertFails({"README.md": ""}, "no C++ files")


if __name__ == "__main__":
    unittest.main()
