#!/usr/bin/env python3
# Each component installs from a build that holds what ./run.sh builds and nothing else: what it lacks is built first.
# SPDX-License-Identifier: MIT
"""install_test BUILD

Beside BUILD, which is whole, a folder is made with its scripts of installation and the files of the target `sightline` alone.
There "building" is to take the files of the targets that are named from BUILD, and no others. Exit code 77: BUILD is not whole.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

PRODUCTS = (".a", ".so", ".py", ".dll", ".lib", "/sightline", "/sightline-lab", "/sightline-bench", "/sightline-view", "/sightline-import")
HELD = {  # by component: files that an installation of it alone has
    "runtime": ["lib/libsightline.so.0.1"],
    "development": ["lib/libsightline_run.a", "lib/libsightline_c.a", "lib/libsightline.so", "lib/libsightline-bake.so",
                    "lib/cmake/sightline/sightline-config.cmake", "include/sightline/sightline.h", "lib/pkgconfig/sightline.pc"],
    "tools": ["bin/sightline"],
    "tools-development": ["lib/libsightline_truth.a", "lib/libsightline_lab_report.a"],
    "python": ["lib/python3/dist-packages/sightline/_cdef.py", "lib/python3/dist-packages/sightline/__init__.py"],
    "documentation": ["share/doc/sightline/CHANGELOG.md"],
}


def ninja(build, *words):
    return subprocess.run(["ninja", "-C", str(build), "-t", *words], check=True, capture_output=True, text=True).stdout.splitlines()


def products(build, target):
    """The files that a name stands for: of a phony one those that it asks for."""
    lines = ninja(build, "query", target)
    if "  input: phony" not in lines:
        return {target} if any(line.startswith("  input: ") for line in lines) else set()
    asked = lines[lines.index("  input: phony") + 1:lines.index("  outputs:")]
    return set().union(*(products(build, name.strip().removeprefix("| ").removeprefix("|| ")) for name in asked))


def take(build, copy, targets):
    """Copies what targets are made of, with the links to it, and what is written beside a script."""
    names = set().union(*(products(build, target) for target in targets), ninja(build, "inputs", *targets))
    for name in names:
        source = build / name.removeprefix(f"{build}/")
        if not source.is_relative_to(build) or ".so" not in name and not f"/{name}".endswith(PRODUCTS):
            continue
        if not source.exists():
            print(f"{source} is not built")
            sys.exit(77)
        links = [file for file in source.parent.glob("*.so*") if file.resolve() == source.resolve()]
        scripts = source.parent.glob("*.py") if source.suffix == ".py" else []
        for file in {source, source.resolve(), *links, *scripts}:
            target = copy / file.relative_to(build)
            target.parent.mkdir(parents=True, exist_ok=True)
            if not target.exists():
                shutil.copy2(file, target, follow_symlinks=False)


def main(build):
    if sys.argv[2:3] == ["--take"]:
        return take(build, pathlib.Path(sys.argv[3]), sys.argv[sys.argv.index("--target") + 1:])
    faults = []
    for component, held in [*HELD.items(), ("", sum(HELD.values(), []))]:
        with tempfile.TemporaryDirectory() as folder:
            copy, prefix = pathlib.Path(folder) / "build", pathlib.Path(folder) / "prefix"
            copy.mkdir()
            take(build, copy, ["sightline"])
            scripts = [*build.glob("**/cmake_install.cmake"), *build.glob("**/CMakeFiles/Export/**/*.cmake"), *build.glob("sightline-config*.cmake")]
            for script in scripts:
                target = copy / script.relative_to(build)
                target.parent.mkdir(parents=True, exist_ok=True)
                text = script.read_text()
                builder = f'"{sys.executable}" -B "{pathlib.Path(__file__).resolve()}" "@" --take "{copy}"'
                text = text.replace(f'/cmake" --build "{build}"', f'/cmake" -E env {builder}')
                target.write_text(text.replace(str(build), str(copy)).replace('"@"', f'"{build}"'))
            command = ["cmake", f"-DCMAKE_INSTALL_PREFIX={prefix}", "-DCMAKE_INSTALL_CONFIG_NAME=Release"]
            command += [f"-DCMAKE_INSTALL_COMPONENT={component}"] if component else []
            done = subprocess.run([*command, "-P", str(copy / "cmake_install.cmake")], capture_output=True, text=True)
            if done.returncode == 77 or "is not built\n" in done.stdout:
                return 77
            missing = [file for file in held if not os.path.lexists(prefix / file)]  # a link alone may lead to another component
            said = "is not built yet: building" in done.stdout
            if done.returncode != 0 or missing or said != (component not in ("tools", "documentation")):
                faults.append(f"{component or 'all'}: exit code {done.returncode}, missing {missing}, said so: {said}\n{done.stderr}")
    print("\n".join(faults) or f"{len(HELD)} components, alone and together")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
