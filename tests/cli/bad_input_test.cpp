// Bad input gives an exit code and one line that names the file; outputs that cannot be written are told apart.
// SPDX-License-Identifier: MIT
#include "tests/cli/tool.h"

namespace sightline {
namespace {

namespace fs = std::filesystem;

using BadInput = Tool;

TEST_F(BadInput, UnreadableScenesExitWithThree) {
    write("empty.glb", "");
    write("text.glb", "this is no glb");
    write("cut.glb", std::string("glTF\x02\0\0\0\xff\xff\0\0", 12));
    write("list.gltf", "[1, 2");
    write("nothing.gltf", R"({"asset": {"version": "2.0"}})");
    write("scene.obj", "v 0 0 0");
    fs::create_directories(path("folder.glb"));
    for (const char* file : {"missing.glb", "empty.glb", "text.glb", "cut.glb", "list.gltf", "nothing.gltf",
                             "scene.obj", "folder.glb", "."})
        for (const char* verb : {"cull", "verify", "info"}) expectError(std::string(verb) + " " + file, 3, file);
    expectError("cull ''", 3, "\"\"");
}

TEST_F(BadInput, SceneWithoutPermissionExitsWithThree) {
    if (::geteuid() == 0) GTEST_SKIP() << "the superuser may read everything";
    write("secret.glb", "glTF");
    fs::permissions(path("secret.glb"), fs::perms::none);
    expectError("cull secret.glb", 3, "secret.glb");
}

TEST_F(BadInput, WrongCameraPathsExitWithThree) {
    write("broken.json", "{\"frames\": [");
    write("none.json", "{\"frames\": []}");
    write("same.json", R"({"frames": [{"eye": [1,2,3], "target": [1,2,3]}]})");
    write("word.json", R"({"frames": [{"eye": [1,2,"x"], "target": [0,0,0]}]})");
    for (const char* file : {"missing.json", "broken.json", "none.json", "same.json", "word.json", "."})
        expectError("cull city:1:10 --cameras " + std::string(file), 3, file);
}

TEST_F(BadInput, UnwritableOutputsExitWithFour) {
    write("file", "");
    fs::create_directories(path("folder"));
    const std::string cull = "cull city:1:10 --frames 1 --size 16x16 ";
    expectError(cull + "--json no/such/place.json", 4, "no/such/place.json");
    expectError(cull + "--json folder", 4, "folder");
    expectError(cull + "--report file", 4, "file");
    expectError(cull + "--report file/below", 4, "file/below");
    expectError("verify city:1:10 --frames 1 --size 16x16 --json no/such/place.json", 4, "no/such/place.json");
    const Outcome info = run("info city:1:10 --json no/such/place.json");
    EXPECT_EQ(info.exit_code, 4) << info.err;
}

TEST_F(BadInput, AFailedRunLeavesTheOldFile) {
    write("old.json", "old");
    expectError("cull missing.glb --json old.json", 3, "missing.glb");
    EXPECT_EQ(read(path("old.json")), "old");
}

TEST_F(BadInput, AnErrorStaysOneLineWhateverTheName) {
    expectError("cull \"$(printf 'two\\nlines.glb')\"", 3, "lines.glb");
}

}  // namespace
}  // namespace sightline
