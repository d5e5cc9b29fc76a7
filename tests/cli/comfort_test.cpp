// What makes the command line pleasant: quiet, logs, colours, the nearest word, watching, full outputs.
// SPDX-License-Identifier: MIT
#include <filesystem>

#include <nlohmann/json.hpp>

#include "tests/cli/process.h"

namespace sightline {
namespace {

using Comfort = Tool;
using Words = std::vector<std::string>;

/// One triangle as glTF, with its buffer in a file beside it.
void writeTriangle(const std::filesystem::path& directory, const std::string& uri) {
    const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    std::ofstream(directory / "triangle one.bin", std::ios::binary)
        .write(reinterpret_cast<const char*>(positions), sizeof positions);
    std::ofstream(directory / "scene.gltf") << R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": ")"
                                            << uri << "\"}]}";
}

TEST_F(Comfort, QuietLeavesErrorsAndWhatWasAskedFor) {
    for (const char* command :
         {"cull city:1:50 --frames 2 --size 64x36 -q", "--quiet cull city:1:50 --frames 2 --size 64x36"}) {
        const Outcome outcome = run(command);
        EXPECT_EQ(outcome.exit_code, 0) << command;
        EXPECT_EQ(outcome.out + outcome.err, "") << command;
    }
    const Outcome asked = run("cull city:1:50 --frames 2 --size 64x36 --quiet --json -");
    EXPECT_EQ(nlohmann::json::parse(asked.out)["frames"].size(), 2u);
    EXPECT_EQ(asked.err, "");
    for (const char* question : {"info city:1:50 --quiet", "explain city:1:50 --frames 1 --object 3 --quiet"}) {
        const Outcome answer = run(question);
        EXPECT_EQ(answer.exit_code, 0) << question;
        EXPECT_NE(answer.out, "") << question;
        EXPECT_EQ(answer.err, "") << question;
    }
    expectError("cull nothing.glb --quiet", 3, "nothing.glb");
}

TEST_F(Comfort, LogHasTheCommandTheSummaryAndTheEnd) {
    ASSERT_EQ(run("cull city:1:50 --frames 2 --size 64x36 --quiet --log log").exit_code, 0);
    ASSERT_EQ(run("--log log cull nothing.glb").exit_code, 3);
    const std::string log = read(path("log"));
    for (const char* word :
         {"begin sightline 0.", "sightline cull city:1:50 --frames 2", "culling: 2 frames", "visible ", "exit code 0",
          "sightline --log log cull nothing.glb", "sightline: nothing.glb", "exit code 3"})
        EXPECT_NE(log.find(word), std::string::npos) << word << " in\n" << log;
    std::istringstream lines(log);
    for (std::string line; std::getline(lines, line);) EXPECT_EQ(line.substr(0, 2) + line.substr(10, 1), "20T") << line;
    expectError("cull city:1:50 --log no/such/log", 4, "no/such/log");
    write("model.obj", "v 0 0 0\n");
    expectError("cull city:1:50 --log model.obj", 4, "model.obj");
    EXPECT_EQ(read(path("model.obj")), "v 0 0 0\n");
}

TEST_F(Comfort, ColoursAreForTerminalsAlone) {
    const Words verify = {"verify", "city:1:50", "--frames", "1", "--size", "64x36", "--rays", "1000"};
    const auto with = [&](Words more) {
        more.insert(more.begin(), verify.begin(), verify.end());
        return more;
    };
    constexpr const char* kGreen = "\033[32msound";
    ::setenv("TERM", "xterm", 1);
    ::unsetenv("NO_COLOR");
    EXPECT_NE(Process::onTerminal(directory_, verify).find(kGreen), std::string::npos);
    EXPECT_EQ(Process::onTerminal(directory_, with({"--color", "never"})).find(kGreen), std::string::npos);
    ::setenv("NO_COLOR", "1", 1);
    EXPECT_EQ(Process::onTerminal(directory_, verify).find(kGreen), std::string::npos);
    ::unsetenv("NO_COLOR");
    ::setenv("TERM", "dumb", 1);
    EXPECT_EQ(Process::onTerminal(directory_, verify).find(kGreen), std::string::npos);
    const std::string piped = "verify city:1:50 --frames 1 --size 64x36 --rays 1000";
    EXPECT_EQ(run(piped).out.find('\033'), std::string::npos);
    EXPECT_NE(run(piped + " --color always --log log").out.find(kGreen), std::string::npos);
    EXPECT_EQ(read(path("log")).find('\033'), std::string::npos);
}

TEST_F(Comfort, SlipsAreToldWhatIsNearest) {
    expectError("cul city:1:10", 2, "did you mean cull?");
    expectError("evrify city:1:10", 2, "did you mean verify?");
    expectError("cull city:1:10 --farmes 3", 2, "did you mean --frames?");
    expectError("help rendr", 2, "did you mean render?");
    EXPECT_EQ(run("xyzzy").err.find("did you mean"), std::string::npos);
}

TEST_F(Comfort, HelpHasHeadingsAndExamples) {
    const std::string help = run("help cull").out;
    EXPECT_EQ(help, run("cull --help").out);
    size_t at = 0;
    for (const char* heading :
         {"\nInput:\n", "\nCameras:\n", "\nCulling:\n", "\nOutput:\n", "\nGeneral:\n", "\nExamples:\n"}) {
        const size_t found = help.find(heading, at);
        ASSERT_NE(found, std::string::npos) << heading << help;
        at = found;
    }
    const std::string tool = run("help").out;
    EXPECT_EQ(tool, run("--help").out);
    for (const char* scene : {"building:SEED:FLOORS", "terrain:SEED:SIZE", "several files", ".obj", "130"})
        EXPECT_NE(tool.find(scene), std::string::npos) << scene;
}

TEST_F(Comfort, FullAndClosedOutputsExitWithFour) {
    for (const char* command :
         {"info city:1:50 >/dev/full", "help >/dev/full", "man >/dev/full", "info city:1:50 >&-",
          "cull city:1:50 --frames 2 --size 64x36 -q --json - >/dev/full",
          "verify city:1:50 --frames 500 --size 16x16 --rays 10 --json j | head -c 1 >/dev/null"}) {
        const std::string line = "cd '" + directory_.string() + "' && bash -c 'set -o pipefail; \"$0\" " + command +
                                 "' '" SIGHTLINE_TOOL "' 2>.said";
        const int status = std::system(line.c_str());
        EXPECT_EQ(WEXITSTATUS(status), 4) << command;
        const std::string said = read(path(".said"));
        // A reader who has seen enough is no fault to speak of.
        const bool left = std::string(command).find(" | ") != std::string::npos;
        EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), left ? 0 : 1) << command << "\n" << said;
        EXPECT_EQ(said.find("standard output") == std::string::npos, left) << said;
    }
}

TEST_F(Comfort, WatchRunsAgainWhenAFileChangesThatTheSceneLeadsTo) {
    writeTriangle(directory_, "triangle%20one.bin");
    Process tool(directory_, {"info", "scene.gltf", "--json", "result.json", "--watch"});
    const auto result = [&] { return std::filesystem::exists(path("result.json")); };
    const auto watching = [&](long times) {
        return eventually([&] {
            const std::string said = read(path(".err"));
            long count = 0;
            for (size_t at = 0; (at = said.find("watching ", at)) != std::string::npos; ++at) ++count;
            return count >= times;
        });
    };
    ASSERT_TRUE(watching(1)) << read(path(".err"));
    ASSERT_TRUE(result());
    std::filesystem::remove(path("result.json"));
    // Written aside and renamed, as editors do.
    const float larger[] = {0, 0, 0, 2, 0, 0, 0, 2, 0};
    write("aside", std::string(reinterpret_cast<const char*>(larger), sizeof larger));
    std::filesystem::rename(path("aside"), path("triangle one.bin"));
    ASSERT_TRUE(eventually(result)) << read(path(".err"));
    ASSERT_TRUE(watching(2));
    // A run that fails says so, and the watch goes on.
    write("scene.gltf", "{");
    ASSERT_TRUE(eventually([&] { return read(path(".err")).find("sightline: scene.gltf") != std::string::npos; }));
    ASSERT_TRUE(watching(3));
    std::filesystem::remove(path("result.json"));
    writeTriangle(directory_, "triangle%20one.bin");
    ASSERT_TRUE(eventually(result));
    ASSERT_TRUE(watching(4));
    tool.send(SIGINT);
    EXPECT_EQ(tool.join(), 0);
}

TEST_F(Comfort, WatchPassesAnInterruptionOn) {
    write("path.json", R"({"frames": [{"eye": [0, 2, 10], "target": [0, 2, 0]}]})");
    Process tool(directory_, {"cull", "city:1:10000000", "--cameras", "path.json", "--log", "log", "--watch"});
    ASSERT_TRUE(eventually([&] { return read(path("log")).find("begin ") != std::string::npos; }));
    tool.send(SIGINT);
    EXPECT_EQ(tool.join(), 130);
}

TEST_F(Comfort, WatchNeedsAFile) {
    expectError("cull city:1:10 --watch", 2, "--watch");
    expectError("bench rasterize --watch", 2, "--watch");
}

}  // namespace
}  // namespace sightline
