"""Sightline for Conan 2: the libraries that a game links, from this tree. `conan create packaging/conan -s compiler.cppstd=20 --build=missing`.

sightline::run (C++), sightline::c and sightline::shared (C, as an archive and as libsightline), sightline::bsp, sightline::studies.
SPDX-License-Identifier: MIT
"""
import os
import re

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load, rmdir

required_conan_version = ">=2.0"


class SightlineConan(ConanFile):
    name = "sightline"
    license = "MIT"
    description = "What can be seen, from any view of any 3D world: conservative visibility culling"
    topics = ("culling", "visibility", "occlusion", "frustum", "rendering")
    settings = "os", "arch", "compiler", "build_type"

    @property
    def _root(self):
        return os.path.join(self.recipe_folder, os.pardir, os.pardir)

    def set_version(self):
        self.version = re.search(r"project\(sightline VERSION ([\d.]+)", load(self, os.path.join(self._root, "CMakeLists.txt")))[1]

    def export_sources(self):
        for pattern in ("CMakeLists.txt", "LICENSE", "README.md", "CHANGELOG.md", "cmake/*", "sightline/*", "docs/*.md", "examples/*"):
            copy(self, pattern, self._root, self.export_sources_folder)

    def requirements(self):
        self.requires("glm/[>=0.9.9]", transitive_headers=True)
        self.requires("highway/[>=1.0.3 <2]")

    def validate(self):
        check_min_cppstd(self, 20)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["SIGHTLINE_TOOLS"] = False
        toolchain.cache_variables["SIGHTLINE_TESTS"] = False
        toolchain.generate()
        dependencies = CMakeDeps(self)
        dependencies.set_property("highway", "cmake_file_name", "hwy")
        dependencies.set_property("highway", "cmake_target_name", "hwy::hwy")
        dependencies.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        # Conan writes files of its own, by what package_info() says.
        rmdir(self, os.path.join(self.package_folder, "lib", "cmake"))
        rmdir(self, os.path.join(self.package_folder, "lib", "pkgconfig"))
        rmdir(self, os.path.join(self.package_folder, "share"))

    def package_info(self):
        self.cpp_info.set_property("cmake_file_name", "sightline")
        needs = {"run": ["glm::glm", "highway::highway"], "c": ["run"], "shared": [], "bsp": ["run"], "studies": ["bsp"]}
        for name, required in needs.items():
            component = self.cpp_info.components[name]
            component.libs = ["sightline" if name == "shared" else f"sightline_{name}"]
            component.requires = required
            component.set_property("cmake_target_name", f"sightline::{name}")
            component.set_property("pkg_config_name", {"run": "sightline", "shared": "sightline-c"}.get(name, f"sightline-{name}-archive"))
            if self.settings.os in ("Linux", "FreeBSD"):
                component.system_libs = ["m", "pthread"] if name in ("c", "studies") else ["m"]
