// A profile in words and as JSON, and what its table says each stage is good for.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/profile_run.h"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sightline/tools/report/run/calibration_json.h"

namespace sightline {
using namespace tools;
using nlohmann::json;
namespace {

AblationRow row(AblationRow::Change change, Stage stage, double triangles, double fragments, double bytes,
                double milliseconds) {
    AblationRow out;
    out.change = change;
    out.stage = stage;
    out.objects = bytes / 64;
    out.triangles = triangles;
    out.fragments = fragments;
    out.bytes = bytes;
    out.query_microseconds = 100;
    out.frame_milliseconds = milliseconds;
    out.frame_spread = 0.3;
    return out;
}

ProfileRun madeProfile() {
    ProfileRun run;
    run.scene = "a \"scene\".glb";
    run.renderer = "reference";
    run.machine = "m";
    run.objects = 100;
    run.triangles = 5000;
    run.width = 320;
    run.height = 180;
    run.frames = 2;
    // 60 % fill, 40 % CPU, in series.
    run.bottleneck = findBottleneck([](const StageLoads& loads) {
        return FrameTimes{6e-3 * loads.fill + 4e-3 * loads.cpu, 9e-3, 0.0};
    });
    run.costs = {900, 20, 10, 2, 0.5, 1000, 0.03, 40};
    run.facing = {1.25, 10, 130};
    run.ablation = {row(AblationRow::Change::kNothing, Stage::kFrustum, 1000, 2e6, 6400, 10),
                    row(AblationRow::Change::kWithout, Stage::kFrustum, 4000, 2e6, 12800, 14),
                    row(AblationRow::Change::kWithout, Stage::kOcclusion, 1500, 5e6, 6400, 15),
                    row(AblationRow::Change::kWith, Stage::kVolumes, 1000, 2e6, 6400, 11),
                    row(AblationRow::Change::kNone, Stage::kFrustum, 5000, 6e6, 6400 * 2, 20)};
    return run;
}

TEST(ProfileRun, SaysWhatStagesAreGoodFor) {
    const std::vector<StageBenefit> benefits = benefitsOf(madeProfile().ablation);
    ASSERT_EQ(benefits.size(), 3u);
    EXPECT_EQ(benefits[0].stage, Stage::kFrustum);
    EXPECT_TRUE(benefits[0].in_use);
    EXPECT_EQ(benefits[0].words(), "geometry, bus");
    EXPECT_DOUBLE_EQ(benefits[0].geometry, 3);
    EXPECT_DOUBLE_EQ(benefits[0].milliseconds, 4);
    EXPECT_EQ(benefits[1].words(), "geometry, rasterizer");
    EXPECT_DOUBLE_EQ(benefits[1].rasterizer, 1.5);
    // One that is not in use is held against the run as asked.
    EXPECT_FALSE(benefits[2].in_use);
    EXPECT_EQ(benefits[2].words(), "nothing");
    EXPECT_DOUBLE_EQ(benefits[2].milliseconds, -1);
    EXPECT_NEAR(benefits[2].spread, 0.3 * std::sqrt(2.0), 1e-12);
}

TEST(ProfileRun, NothingKeptIsNoDivisionByZero) {
    std::vector<AblationRow> rows = madeProfile().ablation;
    rows[0].triangles = rows[0].fragments = rows[0].bytes = 0;
    ProfileRun run = madeProfile();
    run.ablation = rows;
    const json out = json::parse(profileJson(run));
    EXPECT_TRUE(out["ablation"][1]["benefits"]["geometry"].is_null());
    EXPECT_EQ(out["ablation"][1]["benefits"]["words"], "geometry, rasterizer, bus");
    EXPECT_NE(profileText(run).find("all"), std::string::npos);
}

TEST(ProfileRun, JsonHasTheSchema) {
    const ProfileRun run = madeProfile();
    const json out = json::parse(profileJson(run));
    EXPECT_EQ(out["schema"], "sightline.profile/1");
    EXPECT_EQ(out["scene"]["file"], run.scene);
    EXPECT_EQ(out["scene"]["objects"], 100);
    EXPECT_EQ(out["bottleneck"]["verdict"], "mixed");
    EXPECT_EQ(out["bottleneck"]["limits"], (json{"fill", "cpu"}));
    EXPECT_EQ(out["bottleneck"]["doubt"], "none");
    ASSERT_EQ(out["bottleneck"]["stages"].size(), 4u);
    EXPECT_NEAR(out["bottleneck"]["stages"][0]["share"].get<double>(), 0.6, 1e-9);
    EXPECT_NEAR(out["bottleneck"]["stages"][0]["sensitivity"].get<double>(), std::log2(1.6), 1e-9);
    EXPECT_EQ(out["bottleneck"]["gpu_milliseconds"], 0.0);
    EXPECT_EQ(out["costs"]["object_ns"], 900);
    EXPECT_EQ(out["costs"]["triangle_ns"], 20);
    EXPECT_EQ(out["costs"]["vertex_ns"], 10);
    EXPECT_EQ(out["costs"]["pixel_ns"], 2);
    ASSERT_EQ(out["ablation"].size(), 5u);
    EXPECT_EQ(out["ablation"][0]["stages"], "as asked");
    EXPECT_FALSE(out["ablation"][0].contains("benefits"));
    EXPECT_EQ(out["ablation"][2]["stages"], "without occlusion");
    EXPECT_EQ(out["ablation"][2]["stage"], "occlusion");
    EXPECT_EQ(out["ablation"][3]["in_use"], false);
    EXPECT_EQ(out["ablation"][4]["stages"], "no stage");
    EXPECT_FALSE(out.contains("driver_counts"));
}

TEST(ProfileRun, CountersThatADriverHasNotAreNull) {
    ProfileRun run = madeProfile();
    run.driver_counts = DriverCounts{0.9, 5000.0, std::nullopt, std::nullopt, 1234};
    const json out = json::parse(profileJson(run));
    EXPECT_EQ(out["driver_counts"]["vertices"], 5000);
    EXPECT_TRUE(out["driver_counts"]["fragments"].is_null());
}

TEST(ProfileRun, ItsCostsAreACalibration) {
    const Result<FacingCosts> read = parseCalibration(profileJson(madeProfile()), "p.json");
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read->test, 1.25);
    EXPECT_EQ(read->dropped, 10);
    EXPECT_EQ(read->drawn, 130);
}

TEST(ProfileRun, TextSaysItInPlainWords) {
    const std::string text = profileText(madeProfile());
    for (const char* words :
         {"100 objects", "mixed: fill 60 %, cpu 40 %", "confidence", "the stages work one after the other",
          "an object 900", "a covered pixel 2", "without occlusion", "with volumes", "no stage", "if it were on"})
        EXPECT_NE(text.find(words), std::string::npos) << words << "\n" << text;
}

}  // namespace
}  // namespace sightline
