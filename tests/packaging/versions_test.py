#!/usr/bin/env python3
# What the packagers' files say of the project is what the project says: version, options, the files that they name.
# SPDX-License-Identifier: MIT
import json
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).parents[2]
PORT = ROOT / "packaging" / "vcpkg" / "sightline"
BUILD = (ROOT / "CMakeLists.txt").read_text()


class VcpkgPort(unittest.TestCase):
    def setUp(self):
        self.manifest = json.loads((PORT / "vcpkg.json").read_text())
        self.portfile = (PORT / "portfile.cmake").read_text()

    def test_version_and_licence(self):
        self.assertEqual(self.manifest["version"], re.search(r"project\(sightline VERSION ([\d.]+)", BUILD)[1])
        self.assertIn(self.manifest["license"], (ROOT / "LICENSE").read_text())
        usage = (PORT / "usage").read_text()
        self.assertIn(".".join(self.manifest["version"].split(".")[:2]), usage)

    def test_options_exist(self):
        options = re.findall(r"-D(SIGHTLINE_\w+)=", self.portfile)
        self.assertTrue(options)
        for option in options:
            self.assertIn(f"option({option} ", BUILD)

    def test_targets_exist(self):
        for target in re.findall(r"sightline::(\w+)", (PORT / "usage").read_text()):
            self.assertRegex(BUILD, rf"sightline_(library|shared)\({target}\b")


if __name__ == "__main__":
    unittest.main()
