// The verb `view` without a window: a picture of a frame, and what cannot be.
// SPDX-License-Identifier: MIT
#include "tests/cli/tool.h"

namespace sightline {
namespace {

class ViewVerb : public Tool {
protected:
    /// The picture; empty, and the test skips, where there is no GL.
    std::string picture(const std::string& words) const {
        const Outcome told = run("view " + words + " --headless --screenshot v.png --size 320x180");
        if (told.exit_code == 3 && told.err.find("OpenGL: ") != std::string::npos) return {};
        EXPECT_EQ(told.exit_code, 0) << told.err;
        EXPECT_EQ(told.out, "");
        return read(path("v.png"));
    }
};

TEST_F(ViewVerb, WritesWhatIsSeen) {
    const std::string plain = picture("city:1:200 --frames 6 --frame 2 --no-panels");
    if (plain.empty()) GTEST_SKIP() << "no GL here";
    EXPECT_EQ(plain.substr(1, 3), "PNG");
    const auto differs = [&](const std::string& words, const std::string& from) {
        EXPECT_NE(picture("city:1:200 --frames 6 --no-panels " + words), from) << words;
    };
    EXPECT_EQ(picture("city:1:200 --frames 6 --frame 2 --no-panels"), plain) << "the same again";
    differs("--frame 3", plain);
    differs("--frame 2 --colours objects", plain);
    differs("--frame 2 --x-ray", plain);
    differs("--frame 2 --tree-level 1", plain);
    differs("--frame 2 --section 0,-1,0,1", plain);
    differs("--frame 2 --bsp 0.5", plain);
    differs("--frame 2 --colours levels --lod-error 4", plain);
    const std::string frozen = picture("city:1:200 --frames 6 --frame 2 --no-panels --frozen 0");
    EXPECT_NE(frozen, plain);
    differs("--frame 2 --frozen 0 --culled ghosts", frozen);
    const std::string panels = picture("city:1:200 --frames 6 --frame 2");
    EXPECT_NE(panels, plain);
    EXPECT_EQ(picture("city:1:200 --frames 6 --frame 2"), panels) << "without a window they show no times";
    const std::string chosen = picture("city:1:200 --frames 6 --frame 2 --object 7");
    EXPECT_NE(chosen, panels);
    EXPECT_NE(picture("city:1:200 --frames 6 --frame 2 --object 7 --clusters"), chosen);
    EXPECT_NE(picture("city:1:200 --frames 6 --frame 2 --ways"), panels);
}

TEST_F(ViewVerb, DrawsParallelViews) {
    write("p.json", R"({"orthographic_height": 200, "frames": [{"eye": [0, 300, 1], "target": [0, 0, 0]},
        {"eye": [0, 900, 1], "target": [0, 0, 0], "near": 600, "far": 601}]})");
    const std::string city = picture("city:1:200 --cameras p.json --frame 0 --no-panels");
    if (city.empty()) GTEST_SKIP() << "no GL here";
    EXPECT_NE(city, picture("city:1:200 --cameras p.json --frame 1 --no-panels")) << "which shows nothing";
}

TEST_F(ViewVerb, OpensAVisibilityFile) {
    succeed("bake building:1:1 -o house.vis");
    const std::string words = "building:1:1 --frame 1 --frames 4 --seed 3 --no-panels";  // in a room
    const std::string shut = picture(words + " --visibility house.vis");
    if (shut.empty()) GTEST_SKIP() << "no GL here";
    EXPECT_TRUE(picture(words) == shut) << "what is culled is not seen";
    EXPECT_FALSE(picture(words + " --visibility house.vis --cells") == shut) << "cells have faces";
}

TEST_F(ViewVerb, RefusesWhatCannotBe) {
    const auto refused = [&](const std::string& words, int code, const std::string& part) {
        const Outcome told = run("view " + words);
        EXPECT_EQ(told.exit_code, code) << words << "\n" << told.err;
        EXPECT_NE(told.err.find(part), std::string::npos) << told.err;
        EXPECT_EQ(told.errorLines(), 1u) << told.err;
    };
    refused("city:1:20 --headless", 2, "--headless goes with --screenshot");
    refused("city:1:20 --frames 2 --frame 2 --headless --screenshot v.png", 2, "--frame 2: the path has 2 frames");
    refused("city:1:20 --frames 2 --frozen 7 --headless --screenshot v.png", 2, "--frozen 7: the path has 2 frames");
    refused("city:1:20 --headless --screenshot -", 2, "--screenshot -");
    refused("city:1:20 --headless --screenshot nowhere/else/v.png --size 0x5", 2, "--size");
    refused("none.glb --headless --screenshot v.png", 3, "none.glb");
    refused("city:1:20 --headless --screenshot v.png --colours red", 2, "--colours");
    refused("city:1:20 --headless --screenshot v.png --bsp 2", 2, "--bsp");
    refused("city:1:20 --headless --screenshot v.png --clusters", 2, "--clusters: of which object?");
    refused("city:1:20 --headless --screenshot v.png --cells", 2, "--cells: of which file?");
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    refused("city:1:20 --size 64x64", 3, "no window can be opened here");
}

}  // namespace
}  // namespace sightline
