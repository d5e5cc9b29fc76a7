// Names and files that nobody means well with: the terminal obeys none, nothing is lost, nothing waits for ever.
// SPDX-License-Identifier: MIT
#include "tests/cli/tool.h"

namespace sightline {
namespace {

/// A triangle in each node; `next` says which nodes are in which.
std::string sceneOf(const std::vector<std::string>& names, bool nested = false) {
    json out = json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "meshes": [{"primitives": [{"attributes":
        {"POSITION": 0}}]}], "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
        "min": [0, 0, 0], "max": [1, 1, 0]}], "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{
        "byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
    json nodes = json::array(), roots = json::array();
    for (size_t i = 0; i < names.size(); ++i) {
        json node = {{"name", names[i]}, {"mesh", 0}, {"translation", {0.01, 0, 0.01}}};
        if (nested && i + 1 < names.size()) node["children"] = {i + 1};
        if (!nested || i == 0) roots.push_back(i);
        nodes.push_back(node);
    }
    out["nodes"] = nodes;
    out["scenes"] = {{{"nodes", roots}}};
    return out.dump();
}

const char* const kCommand =
    "a\x1b[2Jb\x1b]0;title\x07\nfalse line\xc2\x9b"
    "31m\xe2\x80\xae"
    "c";

/// Only line ends are left of what a terminal obeys.
bool isHarmless(const std::string& text) {
    for (const char c : text)
        if (c != '\n' && (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)) return false;
    return text.find("\xc2\x9b") == std::string::npos && text.find("\xe2\x80\xae") == std::string::npos;
}

class StrangeInput : public Tool {
protected:
    /// No name commands the terminal or begins a line.
    void expectHarmless(const std::string& arguments) const {
        const Outcome outcome = run(arguments);
        EXPECT_TRUE(isHarmless(outcome.out)) << arguments << "\n" << outcome.out;
        EXPECT_TRUE(isHarmless(outcome.err)) << arguments << "\n" << outcome.err;
        for (const std::string& text : {outcome.out, outcome.err})
            EXPECT_EQ(text.find("\nfalse line"), std::string::npos) << arguments;
    }
};

TEST_F(StrangeInput, NoNameCommandsTheTerminal) {
    write("a.gltf", sceneOf({kCommand, kCommand, "b"}));
    write("c\x1b[2J\nd.gltf", sceneOf({"b"}));
    for (const char* scene : {"a.gltf", "c*d.gltf"})
        for (const char* verb :
             {"info", "cull --frames 2 --size 32x32", "explain --frames 2 --size 32x32",
              "explain --object 0 --size 32x32", "explain --object 0 --frame all --size 32x32",
              "explain --at 16,16 --size 32x32", "explain --object a --size 32x32", "render --frames 2 --size 32x32"})
            expectHarmless(std::string(verb) + " " + scene);
    json runs[2];
    for (int i = 0; i < 2; ++i) {
        ASSERT_EQ(run("cull a.gltf --cameras cameras.json --json -").exit_code, 3);
        ASSERT_EQ(run("cull a.gltf --frames 2 --size 32x32 --json run.json").exit_code, 0);
        runs[i] = json::parse(read(path("run.json")));
        runs[i]["scene"]["file"] = kCommand;
    }
    runs[1]["frames"][0]["visible"] = runs[1]["frames"][0]["visible"].empty() ? json{0} : json::array();
    write("x.json", runs[0].dump());
    write("y.json", runs[1].dump());
    expectHarmless("report x.json");
    expectHarmless("report --compare x.json y.json");
}

TEST_F(StrangeInput, AMillionNamesInPathsAreBounded) {
    // 3000 nested nodes of 400 bytes each: paths in full would be 1.8 GB.
    std::vector<std::string> names;
    for (int i = 0; i < 3000; ++i) names.push_back(std::to_string(i) + std::string(400, 'n'));
    write("deep.gltf", sceneOf(names, true));
    const Outcome outcome = succeed("cull deep.gltf --frames 2 --size 64x64 --json deep.json");
    EXPECT_LT(std::filesystem::file_size(path("deep.json")), 3000u * 5500u);
    const Outcome one = run("explain deep.gltf --object 2999 --size 64x64");
    EXPECT_LT(one.out.size(), 2000u) << "a name of any length has its place in a sentence";
}

TEST_F(StrangeInput, ReplaysNameScenesThatLookLikeOptions) {
    write("--frames.gltf", sceneOf({"b"}));
    ASSERT_EQ(run("cull --frames 2 --size 32x32 --report out -- --frames.gltf").exit_code, 0);
    EXPECT_NE(read(path("out/index.html")).find("sightline cull ./--frames.gltf"), std::string::npos);
}

TEST_F(StrangeInput, NothingIsWrittenOverWhatIsReadOrWritten) {
    write("a.gltf", sceneOf({"b"}));
    const std::string scene = read(path("a.gltf"));
    for (const char* arguments : {"cull a.gltf --frames 2 --json a.gltf", "cull a.gltf --frames 2 --trace ./a.gltf",
                                  "verify a.gltf --frames 2 --json a.gltf", "explain a.gltf --frames 2 --json a.gltf",
                                  "info a.gltf --json a.gltf", "cull a.gltf --frames 2 --json x --trace x",
                                  "cull a.gltf --frames 2 --json r/index.html --report r",
                                  "cull a.gltf --frames 2 --trace r/cull.json --report r",
                                  "explain a.gltf --object 0 --frames 2 --json x -o x"})
        expectError(arguments, 2, "is taken by");
    EXPECT_EQ(read(path("a.gltf")), scene);
    EXPECT_FALSE(std::filesystem::exists(path("x")));
    ASSERT_EQ(run("cull a.gltf --frames 2 --size 32x32 --json r/cull.json --report r").exit_code, 4)
        << "no directory yet";
    ASSERT_EQ(run("cull a.gltf --frames 2 --size 32x32 --report r").exit_code, 0);
    ASSERT_EQ(run("cull a.gltf --frames 2 --size 32x32 --json r/cull.json --report r").exit_code, 0)
        << "the same bytes";
    expectError("report --compare r r --json r/cull.json", 2, "is taken by");
    EXPECT_EQ(run("report r -o r").exit_code, 0);
}

TEST_F(StrangeInput, OnlyPicturesOfItsOwnLeaveAReport) {
    ASSERT_EQ(run("cull made:walls --size 32x32 --report r").exit_code, 0);
    write("r/frames/frame-of-mine.png", "mine");
    write("r/frames/plan-.png", "mine");
    write("r/frames/plan-0099.png", "an earlier run's");
    ASSERT_EQ(run("cull made:walls --size 32x32 --report r").exit_code, 0);
    EXPECT_EQ(read(path("r/frames/frame-of-mine.png")), "mine");
    EXPECT_EQ(read(path("r/frames/plan-.png")), "mine");
    EXPECT_FALSE(std::filesystem::exists(path("r/frames/plan-0099.png")));
}

TEST_F(StrangeInput, AFileThatMayNotGrowIsToldAndLeavesNothing) {
    write("old.json", "old");
    const std::string limited = "cull city:1:2000 --frames 4 --size 64x64 --json old.json";
    const Outcome outcome = Tool::run("--version; ulimit -f 1; '" SIGHTLINE_TOOL "' " + limited);
    EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
    EXPECT_NE(outcome.err.find("old.json: cannot be written"), std::string::npos) << outcome.err;
    EXPECT_EQ(read(path("old.json")), "old");
    const std::filesystem::directory_iterator files(directory_);
    EXPECT_EQ(std::distance(begin(files), end(files)), 1) << "no half file is left beside it";
}

}  // namespace
}  // namespace sightline
