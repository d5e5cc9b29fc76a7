#!/usr/bin/env python3
# Relinked programs have the changed sources, the tree stays as it was, and tools/mutate tells which tests fail.
# SPDX-License-Identifier: MIT
import json
import pathlib
import subprocess
import sys
import tempfile
import time

TOOLS = pathlib.Path(__file__).resolve().parent.parent.parent / "tools"
sys.path.insert(0, str(TOOLS))
from relink import Relinker, RelinkError, replace_once  # noqa: E402

# A library whose first two sources are a unity group, and a program that behaves as a test program of GoogleTest does.
FILES = {
    "CMakeLists.txt": """cmake_minimum_required(VERSION 3.20)
project(fake LANGUAGES CXX)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
add_library(fake STATIC lib/one.cpp lib/two.cpp lib/three.cpp)
set_source_files_properties(lib/one.cpp lib/two.cpp PROPERTIES UNITY_GROUP 0)
set_target_properties(fake PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
target_include_directories(fake PUBLIC ${PROJECT_SOURCE_DIR})
add_executable(sightline_fake_test main.cpp)
target_link_libraries(sightline_fake_test PRIVATE fake)
add_executable(other other.cpp)
""",
    "lib/near.h": "#pragma once\ninline int near() { return 1; }\n",
    "lib/all.h": "#pragma once\nint one();\nint two();\nint three();\n",
    "lib/one.cpp": '#include "near.h"\n#include "lib/all.h"\nint one() { return near(); }\n',
    "lib/two.cpp": '#include "lib/all.h"\nint two() {\n#ifdef ALL\n    return 22;\n#else\n    return 2;\n#endif\n}\n',
    "lib/three.cpp": '#include "lib/near.h"\n#include "lib/all.h"\nint three() { return 2 + near(); }\n',
    "other.cpp": "int main() { return 0; }\n",
    "main.cpp": r"""#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include "lib/all.h"
int main(int count, char** args) {
    if (count == 1) { std::printf("%d %d %d\n", one(), two(), three()); return 0; }
    const bool right[3] = {one() == 1, two() == 2, false};
    const char* const names[3] = {"One", "Two", "AlwaysFails"};
    std::string tests;
    for (int i = 0; i < 3; ++i) {
        std::printf("[ RUN      ] Fake.%s\n", names[i]);
        std::fflush(stdout);
        if (two() == 99) std::abort();
        while (two() == 98) {}
        if (!right[i]) std::printf("[  FAILED  ] Fake.%s (0 ms)\n", names[i]);
        tests += std::string(i ? "," : "") + "{\"name\":\"" + names[i] + "\",\"classname\":\"Fake\"" +
                 (right[i] ? "}" : ",\"failures\":[{}]}");
    }
    for (int i = 1; i < count; ++i)
        if (std::strncmp(args[i], "--gtest_output=json:", 20) == 0)
            if (std::FILE* file = std::fopen(args[i] + 20, "w")) {
                std::fprintf(file, "{\"testsuites\":[{\"testsuite\":[%s]}]}", tests.c_str());
                std::fclose(file);
            }
    return 1;
}
""",
}

TABLE = """
[[mutation]]
name = "seen"
file = "lib/two.cpp"
old = "return 2;"
new = "return 3;"
rule = "two is two"
tests = ["fake"]

[[mutation]]
name = "unseen"
file = "lib/three.cpp"
old = "2 + near()"
new = "3 + near()"
rule = "three is three"
tests = ["fake/Fake.*"]

[[mutation]]
name = "crash"
file = "lib/two.cpp"
old = "return 2;"
new = "return 99;"
rule = "two is two"
tests = ["fake"]

[[mutation]]
name = "endless"
file = "lib/two.cpp"
old = "return 2;"
new = "return 98;"
rule = "two is two"
tests = ["fake"]

[[mutation]]
name = "broken"
file = "lib/two.cpp"
old = "return 2;"
new = "return ;;2"
rule = "it compiles"
tests = ["fake"]
"""

PROGRAM = "sightline_fake_test"


def state(folder):
    """Names, times and bytes of all files; Ninja's dry runs must not write its logs either."""
    return {path: (path.stat().st_mtime_ns, path.read_bytes()) for path in sorted(folder.rglob("*")) if path.is_file()}


def answer(program):
    return subprocess.run([str(program)], capture_output=True, text=True, check=True).stdout.strip()


def error_of(call, *args):
    try:
        call(*args)
    except RelinkError as error:
        return str(error)
    raise AssertionError("no error")


def check_relinks(root, build, scratch):
    relinker = Relinker(build, scratch)
    relinker.check_built([PROGRAM])
    read = lambda name: (root / name).read_text()  # noqa: E731

    def changed(name, changes, defines=()):
        out = scratch / name / "program"
        assert relinker.link(PROGRAM, relinker.compile(changes, name, [PROGRAM], defines), out)
        return answer(out)

    two = replace_once(read("lib/two.cpp"), "return 2;", "return 7;", "two")
    assert changed("group", {"lib/two.cpp": two}) == "1 7 3"
    assert changed("alone", {"lib/three.cpp": read("lib/three.cpp").replace("2 +", "5 +")}) == "1 2 6"
    assert changed("defines", {"lib/two.cpp": read("lib/two.cpp")}, ["ALL"]) == "1 22 3"
    # A header: both objects that read it, also the one that reads it by a name beside its own.
    near = replace_once(read("lib/near.h"), "return 1;", "return 4;", "near")
    one = read("lib/one.cpp").replace('"near.h"', '"lib/near.h"')
    assert changed("header", {"lib/near.h": near, "lib/one.cpp": one}) == "4 2 6"
    assert changed("both", {"lib/two.cpp": two, "lib/one.cpp": read("lib/one.cpp").replace("near()", "near() + 8")}) == "9 7 3"

    assert "occurs 0 times" in error_of(replace_once, "a b", "c", "d", "x")
    assert "occurs 2 times" in error_of(replace_once, "a a", "a", "d", "x")
    assert "no object" in error_of(relinker.compile, {"other.cpp": ""}, "none", [PROGRAM])
    assert "does not compile" in error_of(relinker.compile, {"lib/two.cpp": "int two( {"}, "wrong", [PROGRAM])
    assert "does not link" in error_of(relinker.link, PROGRAM, relinker.compile({"lib/two.cpp": ""}, "lacks", [PROGRAM]),
                                       scratch / "lacks" / "program")
    assert not relinker.link("other", {"nothing.o": "x"}, scratch / "other")


def check_mutate(build, scratch):
    table, report = scratch / "table.toml", scratch / "report.json"
    table.write_text(TABLE)
    command = [sys.executable, "-B", str(TOOLS / "mutate"), "--build", str(build), "--scratch", str(scratch), "--table", str(table),
               "--json", str(report), "--limit", "3"]
    run = subprocess.run(command + ["seen", "unseen", "crash", "endless"], capture_output=True, text=True)
    assert run.returncode == 1, run.stdout + run.stderr
    results = {result["mutation"]: result for result in json.loads(report.read_text())}
    assert results["seen"]["failed"] == ["Fake.Two"], results
    assert not results["unseen"]["caught"], results
    assert results["crash"]["ends"] == ["crash (SIGABRT) in Fake.One"], results
    assert results["endless"]["ends"] == ["time limit of 3 s in Fake.One"], results
    assert "does not count: Fake.AlwaysFails" in run.stdout, run.stdout
    assert "3 of 4 mutations are caught; not: unseen" in run.stdout, run.stdout
    run = subprocess.run(command + ["seen", "crash"], capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr
    run = subprocess.run(command + ["broken", "seen"], capture_output=True, text=True)
    assert run.returncode == 2 and "does not compile" in run.stdout and "1 could not be run" in run.stdout, run.stdout
    run = subprocess.run(command + ["--tests", "nothing", "seen"], capture_output=True, text=True)
    assert run.returncode == 2 and "no family matches" in run.stdout, run.stdout
    table.write_text(TABLE.replace("2 + near()", "2 * near()"))
    run = subprocess.run(command, capture_output=True, text=True)
    assert run.returncode == 2 and "unseen: lib/three.cpp: the text to replace occurs 0 times" in run.stdout, run.stdout


def main():
    with tempfile.TemporaryDirectory() as made:
        root = pathlib.Path(made).resolve() / "project"
        for name, text in FILES.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        build, scratch = root / "build", root.parent / "scratch"
        subprocess.run(["cmake", "-G", "Ninja", "-S", str(root), "-B", str(build)], check=True, capture_output=True)
        assert "unknown target" in error_of(Relinker(build, scratch).check_built, ["nowhere"])
        assert "not built" in error_of(Relinker(build, scratch).check_built, [PROGRAM])
        subprocess.run(["ninja", "-C", str(build)], check=True, capture_output=True)
        assert answer(build / PROGRAM) == "1 2 3"
        scratch.mkdir()
        before = state(root)
        check_relinks(root, build, scratch)
        check_mutate(build, scratch)
        assert state(root) == before
        assert answer(build / PROGRAM) == "1 2 3"
        time.sleep(0.01)
        (root / "lib/all.h").touch()
        assert "older than its sources" in error_of(Relinker(build, scratch).check_built, [PROGRAM])


main()
