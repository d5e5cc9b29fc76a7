// Ctrl-C leaves what is finished: real signals to the real tool.
// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include "tests/cli/process.h"

namespace sightline {
namespace {

class Interruption : public Tool {
protected:
    std::vector<std::string> words(const std::string& text) const {
        std::istringstream in(text);
        std::vector<std::string> all;
        for (std::string word; in >> word;) all.push_back(word);
        return all;
    }
    /// True once standard error says so: a piped progress bar begins after half a second.
    bool said(const std::string& what) const {
        return eventually([&] { return read(path(".err")).find(what) != std::string::npos; });
    }
    static json timeless(json frame) {
        for (const char* name : {"query_microseconds", "begin_microseconds", "end_microseconds", "thread"})
            frame.erase(name);
        for (json& stage : frame["stages"]) stage.erase("microseconds");
        return frame;
    }
};

TEST_F(Interruption, FinishedFramesAreThePathsFirst) {
    constexpr size_t kFrames = 40000;
    json frames;
    for (size_t i = 0; i < kFrames; ++i) {
        const double x = 0.001 * static_cast<double>(i);
        frames.push_back({{"eye", {x, 2.0, 10.0}}, {"target", {x + 1.0, 2.0, 0.01 * static_cast<double>(i % 700)}}});
    }
    write("path.json", json{{"frames", frames}}.dump());
    for (const int signal : {SIGINT, SIGTERM}) {
        const std::string scene = "cull city:1:3000 --size 320x180 --repeat 1 --threads 3 --json result.json ";
        Process tool(directory_, words(scene + "--cameras path.json"));
        ASSERT_TRUE(said("of 40000 frames"));
        tool.send(signal);
        EXPECT_EQ(tool.join(), 130);
        const std::string said = read(path(".err"));
        EXPECT_NE(said.find(" of 40000 frames: what is finished was written"), std::string::npos) << said;
        const json part = json::parse(read(path("result.json")));
        const size_t finished = part["frames"].size();
        ASSERT_GT(finished, 0u);
        ASSERT_LT(finished, kFrames);
        const std::vector<json> first(frames.begin(), frames.begin() + static_cast<ptrdiff_t>(finished));
        write("first.json", json{{"frames", first}}.dump());
        ASSERT_EQ(run(scene + "--quiet --cameras first.json").exit_code, 0);
        const json whole = json::parse(read(path("result.json")));
        ASSERT_EQ(whole["frames"].size(), finished);
        for (size_t i = 0; i < finished; ++i) ASSERT_EQ(timeless(part["frames"][i]), timeless(whole["frames"][i])) << i;
    }
}

TEST_F(Interruption, FramesWithoutVerdictAreCounted) {
    Process tool(directory_, words("verify city:1:3000 --frames 400 --size 320x180 --rays 1000000 --json v.json"));
    ASSERT_TRUE(said("verifying: "));
    std::this_thread::sleep_for(std::chrono::seconds(1));  // some are judged meanwhile; any number will do
    tool.send(SIGINT);
    EXPECT_EQ(tool.join(), 130);
    const json out = json::parse(read(path("v.json")));
    ASSERT_EQ(out["frames"].size(), 400u);
    size_t judged = 0;
    for (const json& frame : out["frames"]) {
        if (!frame.contains("verification")) break;
        ++judged;
    }
    for (size_t i = judged; i < 400; ++i) EXPECT_FALSE(out["frames"][i].contains("verification")) << i;
    ASSERT_LT(judged, 400u);
    const std::string said = read(path(".err"));
    EXPECT_NE(said.find("of 400 frames, " + std::to_string(judged) + " of them verified"), std::string::npos) << said;
    if (judged > 0) {
        EXPECT_NE(read(path(".out")).find("unverified   " + std::to_string(400 - judged) + " of 400 frames"),
                  std::string::npos);
    }
}

TEST_F(Interruption, AFramesProofEndsWithinItself) {
    // Plates in one plane that lean a little: each is seen, and has to be held against most of the others.
    std::string plates;
    constexpr int kPlates = 6000;
    for (int i = 0; i < kPlates; ++i) {
        const double size = 1 + 1e-4 * i, lean = 1e-7 * (i % 97);
        plates += fmt::format(
            "o plate{}\nv {:.7f} {:.7f} {:.9f}\nv {:.7f} {:.7f} {:.9f}\nv {:.7f} {:.7f} {:.9f}\nf -3 -2 -1\n", i, -size,
            -size, -lean, size, -size, lean, 0.0, size, 0.0);
    }
    write("plates.obj", plates);
    for (const int signal : {SIGINT, SIGTERM}) {
        std::filesystem::remove(path(".err"));  // of the first signal's
        Process tool(directory_, words("verify plates.obj --eye 0.3,0.2,4 --look 0,0,0 --size 64x64 --rays 100"));
        ASSERT_TRUE(said("verifying: 0 of 1 frames"));  // although no frame is done
        tool.send(signal);
        EXPECT_EQ(tool.join(), 130);
        const std::string said = read(path(".err"));
        EXPECT_NE(said.find("interrupted after 1 of 1 frames, 0 of them verified"), std::string::npos) << said;
    }
}

TEST_F(Interruption, ABakesFirstBoundEndsWithinItself) {
    // Rooms side by side, open to one another: a line passes nearly all of their doors.
    constexpr int kSide = 70;
    std::string doors;
    int count = 0;
    const auto addDoor = [&](int a, int b, double x, double y, bool along) {
        const auto at = [&](double u, double z) {
            return along ? fmt::format("({} {} {}) ", x, y + u, z) : fmt::format("({} {} {}) ", x + u, y, z);
        };
        const std::string low = at(63, 0), high = at(1, 64);  // both ways round: normals lead from a to b
        doors += fmt::format("4 {} {} {}{}{}{}\n", a, b, at(1, 0), along ? low : high, at(63, 64), along ? high : low);
        ++count;
    };
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            if (x + 1 < kSide) addDoor(y * kSide + x, y * kSide + x + 1, 64 * (x + 1), 64 * y, true);
            if (y + 1 < kSide) addDoor(y * kSide + x, (y + 1) * kSide + x, 64 * x, 64 * (y + 1), false);
        }
    write("hall.prt", fmt::format("PRT1\n{}\n{}\n{}", kSide * kSide, count, doors));
    Process tool(directory_, words("vis hall.prt --threads 1 -o hall.see"));
    ASSERT_TRUE(said("visibility, base: "));
    tool.send(SIGTERM);
    EXPECT_EQ(tool.join(), 130);
    EXPECT_FALSE(std::filesystem::exists(path("hall.see")));
    EXPECT_NE(read(path(".err")).find("interrupted after a part of the bake"), std::string::npos) << read(path(".err"));
    // The limit ends it as well, and then all is visible that is not known to be hidden.
    const json figures = answer("vis hall.prt --threads 1 --time-limit 0.01");
    EXPECT_EQ(figures["stopped"], true);
    EXPECT_EQ(figures["visible_leaf_pairs"], uint64_t{kSide * kSide} * (kSide * kSide));
}

TEST_F(Interruption, BeforeTheFramesNothingIsWritten) {
    Process tool(directory_, words("cull city:1:10000000 --frames 1000 --json result.json "));
    ASSERT_TRUE(eventually([&] { return tool.hears(SIGINT); }));
    tool.send(SIGINT);
    EXPECT_EQ(tool.join(), 130);
    EXPECT_FALSE(std::filesystem::exists(path("result.json")));
    EXPECT_NE(read(path(".err")).find("interrupted"), std::string::npos);
}

TEST_F(Interruption, WhatIsIgnoredStaysIgnored) {
    // A shell's job in the background does not hear the terminal's Ctrl-C.
    const std::string command = "cd '" + directory_.string() +
                                "' && trap '' INT && { '" SIGHTLINE_TOOL
                                "' cull city:1:3000 --frames 300 --json r.json >/dev/null & pid=$!; "
                                "sleep 0.3; kill -INT $pid; wait $pid; }";
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_EQ(json::parse(read(path("r.json")))["frames"].size(), 300u);
}

TEST_F(Interruption, FewerThreadsWhereMemoryIsShort) {
    // The address space reaches for the frames of one thread, but not for a thousand threads' stacks.
    const std::string command = "cd '" + directory_.string() +
                                "' && ulimit -v 400000 && '" SIGHTLINE_TOOL
                                "' cull city:1:2000 --frames 40 --size 320x180 --threads 1000 --json r.json >/dev/null";
    if (std::system("ulimit -v 400000 && '" SIGHTLINE_TOOL "' --version >/dev/null 2>&1") != 0)
        GTEST_SKIP() << "this build needs more address space than that";
    ASSERT_EQ(std::system(command.c_str()), 0);
    EXPECT_EQ(json::parse(read(path("r.json")))["frames"].size(), 40u);
}

}  // namespace
}  // namespace sightline
