// What makes the command line pleasant: quiet, colours, progress, the nearest word, help, full outputs.
// SPDX-License-Identifier: MIT
#include <iterator>

#include "apps/cli/shell/progress.h"
#include "tests/cli/process.h"
#include "tests/support/random.h"

namespace sightline {
namespace {

using Comfort = Tool;

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

TEST_F(Comfort, ColoursAreForTerminalsAlone) {
    if (!Process::hasTerminals()) GTEST_SKIP() << "there are no terminals: /dev/pts is not mounted";
    const std::vector<std::string> verify = {"verify", "city:1:50", "--frames", "1",
                                             "--size", "64x36",     "--rays",   "1000"};
    constexpr const char* kGreen = "\033[32msound";
    ::setenv("TERM", "xterm", 1);
    ::unsetenv("NO_COLOR");
    EXPECT_NE(Process::onTerminal(directory_, verify).find(kGreen), std::string::npos);
    EXPECT_EQ(run("verify city:1:50 --frames 1 --size 64x36 --rays 1000").out.find('\033'), std::string::npos);
    ::setenv("NO_COLOR", "1", 1);
    EXPECT_EQ(Process::onTerminal(directory_, verify).find(kGreen), std::string::npos);
    ::unsetenv("NO_COLOR");
    ::setenv("TERM", "dumb", 1);
    EXPECT_EQ(Process::onTerminal(directory_, verify).find(kGreen), std::string::npos);
}

TEST_F(Comfort, LongWorkShowsABarOnATerminalAndLinesWhenPiped) {
    if (!Process::hasTerminals()) GTEST_SKIP() << "there are no terminals: /dev/pts is not mounted";
    const std::string frames = std::to_string(test::rounds(60, 8));
    const std::string words = "verify city:1:3000 --frames " + frames + " --size 320x180 --rays 300000 --no-proofs";
    const Outcome piped = run(words);
    EXPECT_NE(piped.err.find("verifying: "), std::string::npos) << piped.err;
    EXPECT_NE(piped.err.find(" of " + frames + " frames, "), std::string::npos) << piped.err;
    EXPECT_EQ(piped.err.find('\r'), std::string::npos) << piped.err;
    std::istringstream in(words);
    const std::vector<std::string> parted(std::istream_iterator<std::string>(in), {});
    const std::string shown = Process::onTerminal(directory_, parted);
    EXPECT_NE(shown.find("\r\033[Kverifying "), std::string::npos) << shown;
    EXPECT_NE(shown.find(" left"), std::string::npos) << shown;
}

TEST_F(Comfort, WorkThatShowsNoProgressIsHeardOf) {
    // Cameras that come late through a pipe: no step is counted meanwhile.
    write("path.json", R"({"frames": [{"eye": [1, 2, 3], "target": [0, 0, 0]}]})");
    const std::string late = "( sleep 6; cat path.json ) | '" SIGHTLINE_TOOL
                             "' cull city:1:100 --size 64x64 --repeat 1 --cameras /dev/stdin ";
    const auto heard = [&](const std::string& options) {
        const std::string command = "cd '" + directory_.string() + "' && " + late + options + " >out.txt 2>err.txt";
        EXPECT_EQ(std::system(command.c_str()), 0);
        return read(path("err.txt"));
    };
    const std::string said = heard("");
    EXPECT_NE(said.find("cull: "), std::string::npos) << said;
    EXPECT_NE(said.find(" s so far\n"), std::string::npos) << said;
    EXPECT_EQ(heard("--quiet"), "");
}

TEST_F(Comfort, TheTimeLeftIsThatOfWhatThisRunHasDone) {
    using cli::progressText;
    EXPECT_EQ(progressText(0, 0, 100, "parts", 9), "0 of 100 parts, just begun");
    EXPECT_EQ(progressText(0, 25, 100, "parts", 10), "25 of 100 parts, 30 s left");
    // An earlier run had done sixty.
    EXPECT_EQ(progressText(60, 60, 100, "parts", 0.001), "60 of 100 parts, just begun");
    EXPECT_EQ(progressText(60, 60, 100, "parts", 50), "60 of 100 parts, just begun");
    EXPECT_EQ(progressText(60, 70, 100, "parts", 50), "70 of 100 parts, 2 min 30 s left");
    EXPECT_EQ(progressText(60, 100, 100, "parts", 50), "100 of 100 parts, 0 s left");
    EXPECT_EQ(progressText(100, 100, 100, "parts", 0), "100 of 100 parts, 0 s left");
}

TEST_F(Comfort, SlipsAreToldWhatIsNearest) {
    expectError("cul city:1:10", 2, "did you mean cull?");
    expectError("evrify city:1:10", 2, "did you mean verify?");
    expectError("cull city:1:10 --farmes 3", 2, "did you mean --frames?");
    expectError("help rendr", 2, "did you mean render?");
    expectError("render city:1:10 --method z-buffer", 2, "did you mean zbuffer?");
    expectError("cull city:1:10 --skip oclusion", 2, "did you mean occlusion?");
    EXPECT_EQ(run("cull city:1:10 --path xyz").err.find("did you mean"), std::string::npos);
    EXPECT_EQ(run("xyzzy").err.find("did you mean"), std::string::npos);
}

TEST_F(Comfort, AnOptionWhoseValueMayBeLeftOutNeedsNone) {
    succeed("cull made:walls --close-gaps");
    succeed("cull made:walls --close-gaps --size 320x180");
    expectError("cull made:walls --json ''", 2, "--json: its value is empty");
}

TEST_F(Comfort, OptionsOfOtherVerbsAreToldWhose) {
    expectError("cull city:1:10 --object 3", 2, "--object; it belongs to explain (see");
    expectError("info city:1:10 --report out", 2, "--report; it belongs to cull, bake, vis, render (see");
    expectError("cull city:1:10 -o x.json", 2, "-o; it belongs to explain, bake, vis, render, ");
}

TEST_F(Comfort, ScenesAreNoVerbs) {
    write("a model.glb", "");
    expectError("'a model.glb'", 2, "sightline cull 'a model.glb', or sightline info 'a model.glb'");
    expectError("city:1:10", 2, "for a scene: sightline cull city:1:10, or ");
    expectError("cull city", 2, "city: not a procedural scene (there are city:SEED:OBJECTS, ");
    expectError("cull made", 2, "made:NAME");
    expectError("vis city:1:10", 2, "city:1:10: vis takes maps");
    write("city", "");
    expectError("cull city", 3, "city: ");
}

TEST_F(Comfort, PagesSayWhereTheyAre) {
    for (const char* command : {"cull city:1:50 --frames 1 --size 64x36 --report page",
                                "render city:1:50 --size 64x36 --report page", "bake building:1:1 --report page"})
        EXPECT_NE(run(command).out.find("report       page/index.html\n"), std::string::npos) << command;
}

TEST_F(Comfort, RunsWithoutACommonCameraAreNotCompared) {
    succeed("cull city:1:50 --frames 1 --size 64x36 --json a.json");
    succeed("cull city:1:50 --frames 1 --seed 9 --size 64x36 --json b.json");
    const Outcome compared = run("report --compare a.json b.json --fail-if-slower 2");
    EXPECT_EQ(compared.exit_code, 1) << "a gate that compares nothing does not open";
    EXPECT_NE(compared.out.find("there is nothing to compare"), std::string::npos) << compared.out;
    EXPECT_EQ(compared.out.find("query "), std::string::npos) << compared.out;
}

TEST_F(Comfort, MissingFilesAndDirectoriesAreNamed) {
    expectError("cull city:1:10 --cameras no.json", 3, "no.json: no such file");
    expectError("cull city:1:10 --visibility no.vis", 3, "no.vis: no such file");
    expectError("report nosuch", 3, "nosuch: no such file");
    write("model.glb", "glTF\2\0\0\0");
    succeed("bake building:1:1 -o house.vis");
    expectError("cull house.vis", 3, "house.vis: is a visibility file, not a scene: give it with --visibility");
    expectError("report model.glb", 3, "model.glb: is no run: `sightline cull --json FILE` writes one");
    expectError("cull city:1:10 --frames 1 --json no/way/x.json", 4,
                "no/way/x.json: cannot be written: there is no directory no/way");
}

TEST_F(Comfort, CountsAreWords) {
    const std::string one = succeed("cull city:1:1 --frames 1 --size 16x16").out;
    EXPECT_NE(one.find("1 object, "), std::string::npos) << one;
    EXPECT_NE(one.find("; 1 frame of 16x16"), std::string::npos) << one;
    const std::string judged = succeed("verify city:1:50 --frames 1 --size 64x36 --rays 1000").out;
    EXPECT_NE(judged.find("exactly visible, over 1 frame\n"), std::string::npos) << judged;
    const std::string drawn = succeed("render city:1:50 --frames 2 --frame 1 --size 64x36").out;
    EXPECT_NE(drawn.find("; frame 1 (0 to 1), 64x36: "), std::string::npos) << drawn;
}

TEST_F(Comfort, ValuesThatMeanNothingAreRefused) {
    expectError("cull city:1:10 --repeat many", 2, "--repeat: many is not a number");
    expectError("render city:1:10 --frame all", 2, "--frame: all is not a number");
    expectError("cull city:1:10 --frames 2 --frames 3", 2, "--frames is given more than once");
    expectError("cull city:1:10 --section 0,0,0,1", 2, "A, B and C are all 0");
    expectError("bake city:1:10 --time-limit -1", 2, "--time-limit: -1 is no number of seconds above 0");
    expectError("cull city:1:10 --use frustum,portals", 2, "--use portals: goes with --visibility");
    expectError("cull city:1:10 --repeat 0", 2, "--repeat: Value 0 not in range");
    expectError("cull city:1:10 --cameras ''", 2, "--cameras: its value is empty");
    expectError("cull city:1:10 --report ''", 2, "--report: its value is empty");
    expectError("cull city:1:10 --seed -1", 2, "--seed: -1 is below 0");
    expectError("render city:1:10 -o picture.JPG", 2, "picture.JPG: pictures are written as PNG");
    expectError("render city:1:10 --ids ids.bmp", 2, "--ids: ids.bmp: pictures are written as PNG");
    EXPECT_FALSE(std::filesystem::exists(path("picture.JPG")));
    EXPECT_EQ(run("render city:1:10 --size 16x16 -o picture.PNG --quiet").exit_code, 0);
}

TEST_F(Comfort, ObjectsAndMapsAreToldWhatIsNearest) {
    const std::string scene = "explain building:1:1 --size 160x90 --frames 1 ";
    expectError(scene + "--object 'Noth wall'", 2, "; did you mean North wall?");
    expectError(scene + "--object xyzzyxyzzy", 2, "has no object of that key, name or path");
    const std::string map = "{\n\"classname\" \"worldspawn\"\n{\n( 0 0 0 ) ( 0 1 0 ) ( 1 0 0 ) T 0 0 0 1 1\n}\n}\n";
    write("house.map", map);
    write("house.txt", map);
    for (const char* file : {"house.map", "house.txt"})
        expectError(std::string("cull ") + file, 3, "is the source of a game map, which vis and bake read");
    write("not.json", "{\"classname\": \"worldspawn\"}");
    expectError("cull not.json", 3, "is JSON, but not glTF");
}

TEST_F(Comfort, HelpHasHeadingsAndExamples) {
    const std::string help = run("help cull").out;
    EXPECT_EQ(help, run("cull --help").out);
    size_t at = 0;
    for (const char* heading : {"\nArguments:\n", "\nInput:\n", "\nCameras:\n", "\nCulling:\n", "\nOutput:\n",
                                "\nGeneral:\n", "\nExamples:\n"}) {
        const size_t found = help.find(heading, at);
        ASSERT_NE(found, std::string::npos) << heading << help;
        at = found;
    }
    const std::string tool = run("help").out;
    EXPECT_EQ(tool, run("--help").out);
    for (const char* scene : {"building:SEED:FLOORS", "terrain:SEED:SIZE", "several files", ".obj", "130"})
        EXPECT_NE(tool.find(scene), std::string::npos) << scene;
}

/// A slow machine is told how far the frames are, which is no complaint.
std::string withoutProgress(const std::string& said) {
    std::istringstream lines(said);
    std::string left;
    for (std::string line; std::getline(lines, line);)
        if (!line.starts_with("preparing: ") && !line.starts_with("culling: ") && !line.starts_with("verifying: "))
            left += line + '\n';
    return left;
}

TEST_F(Comfort, FullAndClosedOutputsExitWithFour) {
    for (const char* command :
         {"info city:1:50 >/dev/full", "help >/dev/full", "completions zsh >/dev/full", "info city:1:50 >&-",
          "cull city:1:50 --frames 2 --size 64x36 -q --json - >/dev/full",
          "verify city:1:50 --frames 500 --size 16x16 --rays 10 --json j | head -c 1 >/dev/null"}) {
        const std::string line = "cd '" + directory_.string() + "' && bash -c 'set -o pipefail; \"$0\" " + command +
                                 "' '" SIGHTLINE_TOOL "' 2>.said";
        const int status = std::system(line.c_str());
        EXPECT_EQ(WEXITSTATUS(status), 4) << command;
        const std::string said = withoutProgress(read(path(".said")));
        // A reader who has seen enough is no fault to speak of.
        const bool left = std::string(command).find(" | ") != std::string::npos;
        EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), left ? 0 : 1) << command << "\n" << said;
        EXPECT_EQ(said.find("standard output") == std::string::npos, left) << said;
    }
}

TEST_F(Comfort, ProceduralScenesAreNamedWhereSomethingLikeOneIsAsked) {
    for (const char* name : {"town:1:5", "house:3", "forest:1:100:2"})
        expectError("cull " + std::string(name), 3,
                    std::string(name) + ": no such file; procedural scenes are city:SEED:OBJECTS");
    expectError("cull dir/a:b.glb", 3, "no such file");
}

// A program that is not built is told of, not missed.
TEST_F(Comfort, HelpOfAVerbThatIsNotBuiltSaysWhatItIs) {
    std::filesystem::create_directories(path("alone"));
    std::filesystem::copy_file(SIGHTLINE_TOOL, path("alone/sightline"));
    const auto shell = [&](const std::string& words, const std::string& expected, int code) {
        const int status = std::system(("cd '" + path("") + "' && alone/sightline " + words + " >out 2>err").c_str());
        EXPECT_EQ(WEXITSTATUS(status), code) << words;
        EXPECT_NE(read(path("out")).find(expected), std::string::npos) << words << read(path("out"));
        EXPECT_EQ(read(path("err")).empty(), code == 0) << words;
    };
    for (const char* verb : {"view", "bench", "render", "judge"})
        for (const std::string ask : {"help ", ""})
            shell(ask + verb + (ask.empty() ? " --help" : ""), "`./run.sh help " + std::string(verb) + "` builds it",
                  0);
    shell("view made:walls", "", 2);
}

TEST_F(Comfort, HelpOfCullSetsApartWhatIsOftenUsed) {
    const std::string help = succeed("help cull").out;
    const size_t often = help.find("Often used:"), input = help.find("Input:");
    ASSERT_LT(often, input);
    for (const char* option :
         {"--cameras", "--eye", "--frames", "--verify", "--list", "--report", "--json", "--remember"}) {
        const size_t at = help.find(std::string("  ") + option + " ");
        EXPECT_TRUE(often < at && at < input) << option;
        EXPECT_EQ(help.find(std::string("\n  ") + option + " ", at + 1), std::string::npos)
            << option << " is there twice";
    }
    for (const char* verb : {"vis", "bake", "cull", "explain"})
        EXPECT_EQ(succeed("help " + std::string(verb)).out.find("UINT"), std::string::npos) << verb;
}

}  // namespace
}  // namespace sightline
