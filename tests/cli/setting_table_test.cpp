// Each option of a query's settings takes what its help and its row say, and what is off, or not judged, is told.
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>

#include "sightline/geom/off.h"
#include "sightline/geom/setting_rows.h"
#include "sightline/tools/report/run/cull_run.h"
#include "tests/cli/tool.h"

namespace sightline {
namespace {

/// None where the shared cases are absent.
std::optional<std::string> sharedCase(const std::string& name) {
    const std::string file = SIGHTLINE_SHARED_DIR "/cases/" + name;
    return std::filesystem::exists(file) ? std::optional(file) : std::nullopt;
}

class SettingTable : public CullTool {
protected:
    /// What some options need of others.
    static std::string withNeeds(const std::string& option, const std::string& value) {
        std::string words = "cull city:1:10 --frames 1 --repeat 1 --size 64x36 --" + option + "=" + value;
        if (option == "hysteresis") words += " --distance 50";
        if (option == "budget") words += " --cost-triangle 1";
        return words;
    }
    /// Whether the parser takes a value; it may want other options besides.
    bool takes(const std::string& option, const std::string& value) const {
        const Outcome outcome = run(withNeeds(option, value));
        return outcome.exit_code == 0 || outcome.err.find(" goes with ") != std::string::npos;
    }
};

TEST_F(SettingTable, OptionsTakeTheirDefaultsTheirLimitsAndNothingBeyond) {
    int options = 0, zeros = 0;
    const QuerySettings tool = tools::toolSettings();
    forEachSetting([&](const auto& row) {
        using Value = std::decay_t<decltype(row.standard())>;
        if (!row.option) return;
        ++options;
        const std::string option = row.option;
        if constexpr (std::is_same_v<Value, bool>) {
            std::string words = "cull city:1:10 --frames 1 --repeat 1 --" + option;
            if (option == "hard-budget") words += " --budget 1 --cost-object 1";
            EXPECT_EQ(run(words).exit_code, 0) << option;
        } else if constexpr (std::is_same_v<Value, PortalWindows>) {
            for (const char* name : kWindowNames) EXPECT_TRUE(takes(option, name)) << option << " " << name;
            EXPECT_FALSE(takes(option, "circles"));
        } else {
            const auto text = [](double value) {
                char digits[40];
                std::snprintf(digits, sizeof digits, "%.12g", value);
                return std::string(digits);
            };
            EXPECT_TRUE(takes(option, text(static_cast<double>(tool.*row.member)))) << option << " by default";
            EXPECT_TRUE(takes(option, text(row.least))) << option << " at least";
            EXPECT_FALSE(takes(option, text(row.least - 1))) << option << " below the least";
            EXPECT_FALSE(takes(option, "much")) << option;
            const bool costly = option == "occlusion-size" || option == "occluder-triangles";
            const bool endless = row.most >= 1e300;
            if (!costly) { EXPECT_TRUE(takes(option, endless ? "inf" : text(row.most))) << option << " at most"; }
            if (!endless) { EXPECT_FALSE(takes(option, text(row.most + 1))) << option << " above the most"; }
            // What the help says of 0 holds.
            if (std::string(row.help).find("0: ") == std::string::npos) return;
            ++zeros;
            EXPECT_TRUE(takes(option, "0")) << option << ": " << row.help;
        }
    });
    EXPECT_GT(options, 20);
    EXPECT_GT(zeros, 5);
}

TEST_F(SettingTable, ZeroIsOff) {
    const json plain = cull("city:1:400 --frames 2 --seed 1");
    for (const char* option : {"--distance 0", "--contribution 0", "--contribution 0px", "--close-gaps=0"}) {
        const json off = cull(std::string("city:1:400 --frames 2 --seed 1 ") + option);
        for (size_t frame = 0; frame < 2; ++frame) {
            EXPECT_EQ(off["frames"][frame]["visible"], plain["frames"][frame]["visible"]) << option;
            EXPECT_EQ(off["frames"][frame]["stages"].size(), plain["frames"][frame]["stages"].size()) << option;
        }
    }
}

TEST_F(SettingTable, RunsSayWhichDefaultsAreNotTheLibrarys) {
    const QuerySettings tool = tools::toolSettings(), library;
    const Outcome outcome = run("cull city:1:10 --frames 1");
    const size_t at = outcome.out.find("defaults     unlike the library's: ");
    ASSERT_NE(at, std::string::npos) << outcome.out;
    const std::string line = outcome.out.substr(at, outcome.out.find('\n', at) - at);
    int others = 0;
    forEachSetting([&](const auto& row) {
        if (std::string(row.name) == "stages") return;
        const bool same = tool.*row.member == library.*row.member;
        EXPECT_EQ(line.find(std::string(" ") + row.name + " ") == std::string::npos, same) << row.name << ": " << line;
        others += !same;
    });
    EXPECT_EQ(others, 3);
    // What was asked for is no default.
    const Outcome asked = run("cull city:1:10 --frames 1 --remember --occluder-error 2 --distance 50 --hysteresis 0.1");
    EXPECT_EQ(asked.out.find("unlike the library's"), std::string::npos) << asked.out;
}

TEST_F(SettingTable, WhatIsSwitchedOffIsSaid) {
    // Each with the flag that its run must tell of; none: none at all.
    const struct {
        const char* options;
        uint32_t off;
    } kRuns[] = {
        {"--frames 3", 0},
        {"--frames 3 --remember", 0},
        {"--frames 3 --bins 4", 0},
        {"--frames 3 --bins 4 --skip frustum", offBit(Off::kBinsByStages)},
        {"--frames 3 --remember --skip frustum", offBit(Off::kCertificatesByStages)},
        {"--frames 3 --lod-error 4", offBit(Off::kOccludersByLods)},
        {"--frames 3 --stereo 0.06 --use frustum,occlusion,clusters", offBit(Off::kClustersByTwoEyes)},
        {"--remember --path walk --frames 40 --bins 2 --close-gaps",
         offBit(Off::kBinsByCertificates) | offBit(Off::kGapsByCertificates)},
    };
    for (const auto& [options, off] : kRuns) {
        const Outcome outcome = run("cull building:1:2 --seed 1 " + std::string(options));
        EXPECT_EQ(outcome.exit_code, 0) << options << outcome.err;
        for (const OffRow& row : kOffRows)
            EXPECT_EQ(outcome.out.find(std::string("switched off ") + row.words) != std::string::npos,
                      (off & offBit(row.off)) != 0)
                << options << ": " << row.name << "\n"
                << outcome.out;
    }
    // Options that do nothing are notes, each with its reason.
    const struct {
        const char *options, *note;
    } kNotes[] = {
        {"--masked --skip occlusion", "--masked has no effect: the stage occlusion is off"},
        {"--no-second-look --second-look-polygons 5", "--second-look-polygons has no effect: --no-second-look"},
        {"--lod-fade 3", "--lod-fade has no effect: no levels of detail are chosen; see --lod-error and --budget"},
        {"--cost-pixel 3", "--cost-pixel has no effect: there is no budget; see --budget"},
        {"--remember --threads 3", "--threads: with --remember frames are culled in order, by one thread"},
    };
    for (const auto& [options, note] : kNotes) {
        const Outcome outcome = run("cull city:1:10 --frames 1 " + std::string(options));
        EXPECT_EQ(outcome.exit_code, 0) << options;
        EXPECT_NE(outcome.err.find(note), std::string::npos) << options << ": " << outcome.err;
    }
    expectError("cull city:1:10 --windows boxes", 2, "--windows goes with --visibility");
    EXPECT_EQ(run("cull city:1:10 --frames 1 --masked").err.find("has no effect"), std::string::npos);
}

TEST_F(SettingTable, NothingCulledIsNoVerdict) {
    const std::string scene = "city:1:10 --frames 2 --seed 1 --skip frustum,occlusion --rays 1000";
    const Outcome judged = run("cull " + scene + " --verify");
    EXPECT_EQ(judged.exit_code, 0);
    EXPECT_NE(judged.out.find("verified     nothing: no object was culled, so there was nothing to judge"),
              std::string::npos)
        << judged.out;
    EXPECT_EQ(judged.out.find("0 of 0"), std::string::npos) << judged.out;
    const Outcome verdicts = run("verify " + scene);
    EXPECT_NE(verdicts.out.find("frame    0: nothing culled, "), std::string::npos) << verdicts.out;
    EXPECT_EQ(verdicts.out.find("sound"), std::string::npos) << verdicts.out;
    // Several frames: what is counted is culls, not objects.
    const Outcome walk = run("cull city:1:10 --frames 3 --seed 1 --verify --rays 1000");
    EXPECT_NE(walk.out.find(" culls of 10 objects over 3 frames were visible"), std::string::npos) << walk.out;
}

TEST_F(SettingTable, InstancesAreCountedAsTheyAreProved) {
    const auto scene = sharedCase("instances-not-counted/row.gltf"),
               camera = sharedCase("instances-not-counted/cam.json");
    if (!scene || !camera) GTEST_SKIP() << "without the shared cases";
    const std::string words = "cull '" + *scene + "' --cameras '" + *camera + "' --verify --rays 1000";
    const Outcome outcome = run(words);
    for (const char* line :
         {": 1 object drawn as 50 instances, 600 triangles; 1 frame", "49 culled    98.000 %",
          "1 instance  2.000 %; culls below are of instances", "verified     0 of 49 culled instances were visible",
          "proved       49 of 49 culled instances hidden"})
        EXPECT_NE(outcome.out.find(line), std::string::npos) << line << "\n" << outcome.out;
    ASSERT_EQ(run(words + " --json run.json").exit_code, 0);
    const json run = json::parse(read(path("run.json")));
    EXPECT_EQ(run["frames"][0]["instances"], 1);
    EXPECT_EQ(run["verification"]["culled_instances"], 49);
    uint64_t culled = 0;
    for (const json& stage : run["frames"][0]["stages"]) culled += stage["instances"].get<uint64_t>();
    EXPECT_EQ(culled, 49u);
}

TEST_F(SettingTable, FacesThatLookAwayHaveTheirOwnReason) {
    const auto scene = sharedCase("faces-away/two.gltf"), camera = sharedCase("faces-away/cam.json");
    if (!scene || !camera) GTEST_SKIP() << "without the shared cases";
    const std::string words = " '" + *scene + "' --cameras '" + *camera + "'";
    const Outcome why = run("explain" + words + " --object 'shows its back'");
    EXPECT_EQ(why.out.find("frustum"), std::string::npos) << why.out;
    EXPECT_NE(why.out.find("culled by facing: object 1 'shows its back' has faces in the view that all look away"),
              std::string::npos)
        << why.out;
    for (const char* how : {"", " --bins 3", " --remember", " --stereo 0.01"}) {
        const Outcome culled = run("cull" + words + how);
        EXPECT_NE(culled.out.find("facing                1 culled    50.000 %  their faces in the view look away"),
                  std::string::npos)
            << how << culled.out;
        EXPECT_NE(culled.out.find("frustum               0 culled"), std::string::npos) << how << culled.out;
    }
    expectError("cull" + words + " --use facing", 2, "\"facing\" is counted, not chosen");
}

}  // namespace
}  // namespace sightline
