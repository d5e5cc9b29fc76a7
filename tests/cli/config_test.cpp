// Configuration files: what is read, what comes before what, and what a file that was only found may not say.
// SPDX-License-Identifier: MIT
#include <map>
#include <sstream>

#include "apps/cli/shell/other_verbs.h"
#include "tests/cli/tool.h"

namespace sightline {
namespace {

class Config : public Tool {
protected:
    void SetUp() override {
        Tool::SetUp();
        ::setenv("XDG_CONFIG_HOME", path("home").c_str(), 1);
        std::filesystem::create_directories(path("home/sightline"));
    }
    size_t frames(const std::string& arguments) const {
        const Outcome outcome = succeed("cull city:1:50 --size 64x36 --quiet --json - " + arguments);
        return outcome.exit_code == 0 ? nlohmann::json::parse(outcome.out)["frames"].size() : 0;
    }
};

TEST_F(Config, TheCommandLineComesFirstThenTheVerbThenTheTop) {
    write("c.toml", "frames = 3\n[cull]\nframes = 4\n[verify]\nframes = 9\n");
    EXPECT_EQ(frames("--config c.toml"), 4u);
    EXPECT_EQ(frames("--config c.toml --frames 5"), 5u);
    write("c.toml", "frames = 3\n[verify]\nframes = 9\n");
    EXPECT_EQ(frames("--config c.toml"), 3u);
}

TEST_F(Config, OneFileIsReadThatIsNamedOrHereOrAtHome) {
    EXPECT_EQ(frames(""), 16u);
    write("home/sightline/config.toml", "frames = 2");
    EXPECT_EQ(frames(""), 2u);
    write("sightline.toml", "frames = 3");
    EXPECT_EQ(frames(""), 3u);
    write("c.toml", "seed = 2");
    EXPECT_EQ(frames("--config c.toml"), 16u);
    EXPECT_EQ(frames("--no-config"), 16u);
    const Outcome told = run("info city:1:50");
    EXPECT_NE(told.err.find("./sightline.toml"), std::string::npos);
    expectError("cull city:1:50 --config c.toml --no-config", 2, "--no-config");
    expectError("cull city:1:50 --config absent.toml", 3, "absent.toml");
}

TEST_F(Config, CamerasOfTheCommandLineRuleOutFramesOfTheFile) {
    write("path.json", R"({"frames": [{"eye": [0, 2, 10], "target": [0, 2, 0]}]})");
    write("c.toml", "frames = 3\nseed = 4\nunit = \"mm\"\n");
    EXPECT_EQ(frames("--config c.toml --cameras path.json"), 1u);
    write("c.toml", "cameras = \"path.json\"\n");
    EXPECT_EQ(frames("--config c.toml --frames 3"), 3u);
    EXPECT_EQ(frames("--config c.toml"), 1u);
}

TEST_F(Config, FaultsNameTheFileAndTheLine) {
    const std::pair<const char*, const char*> faults[] = {
        {"frames = 3\nframse = 3", "c.toml:2: no verb has option \"framse\" that a file may set; did you mean frame"},
        {"[cul]\n", "c.toml:1: there is no verb \"cul\""},
        {"[info]\nframes = 3\n", "c.toml:2: \"info\" has no option \"frames\""},
        {"\nframes = 0", "c.toml:2: \"frames\""},
        {"frames = many", "c.toml:1: "},
        {"frames = true", "c.toml:1: \"frames\" is no switch"},
        {"frames = [1, 2]", "c.toml:1: \"frames\" takes one value"},
        {"frames = 2020-01-01", "c.toml:1: \"frames\" takes a text in quotes, or a number"},
        {"use = [[1]]", "c.toml:1: \"use\" takes a list of texts or numbers"},
        {"[cull]\nverify = 1", "c.toml:2: \"verify\" is either true or false"},
        {"cull.verify = 1", "c.toml:1: \"verify\" is either true or false"},
        {"size = \"x", "c.toml:1: "},
        {"frames 3", "c.toml:1: "},
        {"frames = 3\n\nframes = 4", "c.toml:3: "},
        {"seed = 1\nseed = \"\x01\"", "c.toml:2: "},
        {"[cull]\n[[info]]", "c.toml:2: no verb has option \"info\""},
        {"config = \"other.toml\"", "c.toml:1: no verb has option \"config\""},
        {"SCENE = \"a.glb\"", "c.toml:1: no verb has option \"SCENE\""},
    };
    for (const auto& [text, fault] : faults) {
        write("c.toml", text);
        const Outcome outcome = run("cull city:1:50 --config c.toml");
        EXPECT_EQ(outcome.exit_code, 3) << text << outcome.err;
        EXPECT_EQ(outcome.errorLines(), 1u) << outcome.err;
        std::string said = outcome.err;
        if (const size_t colon = said.find("\": "); colon != std::string::npos) said.erase(colon + 1, 1);
        EXPECT_NE(said.find(fault), std::string::npos) << text << "\n" << outcome.err;
    }
}

TEST_F(Config, AFileThatWasOnlyFoundHereWritesNothing) {
    const Outcome all = run("config --no-config");
    size_t refused = 0;
    std::string section;
    std::istringstream lines(all.out);
    for (std::string line; std::getline(lines, line);) {
        if (line.substr(0, 1) == "[") section = line;
        const bool writes = line.find("= \"FILE") != std::string::npos || line.find("= \"DIR") != std::string::npos;
        if (line.find("# ") != 0 || line.find(" = ") == std::string::npos) continue;
        const std::string key = line.substr(2, line.find(" = ") - 2);
        // Every option whose help says that it writes must be among those that are refused.
        const bool takes_text = line.find(" = \"") != std::string::npos;
        if (!writes && takes_text) {
            EXPECT_EQ(line.find("  # write "), std::string::npos) << section << " " << line;
            EXPECT_EQ(line.find("  # draw "), std::string::npos) << section << " " << line;
        }
        if (!writes) continue;
        write("sightline.toml", section + "\n" + key + " = \"written\"\n");
        const Outcome outcome = run("cull city:1:50 --frames 1 --size 64x36 --quiet");
        EXPECT_EQ(outcome.exit_code, 3) << key;
        EXPECT_NE(outcome.err.find("sightline.toml:2: \"" + key + "\" names what is written"), std::string::npos);
        EXPECT_FALSE(std::filesystem::exists(path("written")));
        ++refused;
    }
    EXPECT_GE(refused, 8u) << all.out;
    write("sightline.toml", "[cull]\njson = \"written\"\n");
    EXPECT_EQ(run("cull city:1:50 --frames 1 --size 64x36 --config sightline.toml").exit_code, 0);
    EXPECT_TRUE(std::filesystem::exists(path("written")));
}

TEST_F(Config, WhatIsPrintedCanBeReadAgain) {
    write("c.toml", "size = \"64x36\"\nuse = [\"frustum\", 'occlusion']  # both\nrepeat = 2\n[cull]\nverify = true\n");
    const Outcome first = succeed("config cull --config c.toml");
    for (const char* line : {"size = \"64x36\"", "use = [ \"frustum\", \"occlusion\" ]", "repeat = 2", "verify = true"})
        EXPECT_NE(first.out.find(line), std::string::npos) << line << " in\n" << first.out;
    write("d.toml", first.out);
    EXPECT_EQ(run("cull city:1:50 --frames 1 --config d.toml").exit_code, 0);
    write("pattern.toml", run("config --no-config").out);
    EXPECT_EQ(run("cull city:1:50 --frames 1 --size 64x36 --config pattern.toml").exit_code, 0);
}

/// A program knows the options of verbs that another program has: a file may set them, and a slip is told its owner.
TEST_F(Config, OptionsOfOtherProgramsAreKnown) {
    size_t count = 0;
    for (const cli::OtherVerb& other : cli::otherVerbs()) {
        if (other.program != "sightline-lab" || other.name == "config") continue;
        std::map<std::string, bool> here, there;
        for (const cli::OtherOption& option : cli::optionsOf(other)) here[std::string(option.name)] = option.written;
        std::istringstream lines(succeed("config --no-config " + std::string(other.name)).out);
        for (std::string line; std::getline(lines, line);) {
            const size_t equals = line.find(" = ");
            if (line.find("# ") != 0 || equals == std::string::npos) continue;
            const std::string value = line.substr(equals, line.find("  # ") - equals);
            there[line.substr(2, equals - 2)] =
                value.find("FILE") != std::string::npos || value.find("DIR") != std::string::npos;
        }
        EXPECT_EQ(here, there) << other.name;
        count += here.size();
    }
    EXPECT_GE(count, 100u);
    write("c.toml", "method = \"warnock\"\n[profile]\nrenderer = \"gl\"\n[view]\nobject = 3\n");
    EXPECT_EQ(frames("--config c.toml --frames 2"), 2u);
    write("c.toml", "[profile]\nrendrer = \"gl\"\n");
    expectError("cull city:1:10 --config c.toml", 3, "did you mean renderer");
    expectError("cull city:1:10 --depth-format float32", 2, "it belongs to render");
}

}  // namespace
}  // namespace sightline
