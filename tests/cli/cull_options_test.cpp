// Distance, contribution, section planes and clusters on the command line: what they cost is told, and they are proved.
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "tests/cli/tool.h"

namespace sightline {
namespace {

using SizeOptions = CullTool;
using SectionOptions = CullTool;
using ClusterOptions = CullTool;
using LodOptions = CullTool;
using MemoryOptions = CullTool;

using PathOptions = CullTool;

TEST_F(PathOptions, TourWalkOrbitOverviewAndScatter) {
    const auto cameras = [&](const std::string& arguments) {
        json out = json::array();
        const json run = cull(arguments);
        for (const json& frame : run["frames"]) out.push_back(frame["camera"]);
        return out;
    };
    const json tour = cameras("city:1:400 --frames 6 --seed 1");
    EXPECT_EQ(cameras("city:1:400 --path tour --frames 6"), tour);
    EXPECT_NE(cameras("city:1:400 --path tour --frames 6 --seed 2"), tour);
    EXPECT_NE(cameras("city:1:400 --frames 6"), tour) << "a city is walked along its streets";
    const json overview = cameras("city:1:400 --path overview");
    ASSERT_EQ(overview.size(), 1u);
    EXPECT_EQ(overview[0], tour[0]);
    for (const char* path : {"scatter", "orbit"})
        EXPECT_EQ(cameras("city:1:400 --frames 6 --path " + std::string(path)).size(), 6u);
    const json walk = cameras("city:1:400 --path walk --frames 6 --fps 10 --speed 2");
    for (size_t i = 1; i < walk.size(); ++i) {
        double squared = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double step = walk[i]["eye"][axis].get<double>() - walk[i - 1]["eye"][axis].get<double>();
            squared += step * step;
        }
        EXPECT_GT(squared, 0.0);
        EXPECT_LT(squared, 0.2 * 0.2 + 1e-9);
    }
    EXPECT_EQ(cull("city:1:400 --path walk --verify --rays 1000 --frames 10 --fps 2")["verification"]["false_culls"],
              0);
}

TEST_F(PathOptions, OneCameraByItsEye) {
    const std::string scene = "building:1:2";
    const json one = cull(scene + " --eye 3,1.6,-2 --look 3,1.6,-9 --verify --rays 1000");
    ASSERT_EQ(one["frames"].size(), 1u);
    EXPECT_EQ(one["frames"][0]["camera"]["eye"], json({3, 1.6, -2}));
    EXPECT_EQ(one["frames"][0]["camera"]["target"], json({3, 1.6, -9}));
    EXPECT_EQ(one["verification"]["false_culls"], 0);
    // It looks at the middle, straight up and down, too; and says where the scene is to who looks away.
    EXPECT_GT(cull(scene + " --eye 30,20,40")["frames"][0]["visible"].size(), 0u);
    const Outcome listed = run("cull " + scene + " --eye=-1,40,-1 --look=-1,0,-1 --list");
    EXPECT_EQ(listed.exit_code, 0);
    EXPECT_NE(listed.out.find("visible in the frame: frames, key, path\n"), std::string::npos) << listed.out;
    const Outcome away = run("cull " + scene + " --eye 0,500,0 --look 0,900,0");
    EXPECT_NE(away.err.find("1 of 1 frames sees nothing; the scene lies from "), std::string::npos) << away.err;
    expectError("cull " + scene + " --look 1,2,3", 2, "--look goes with --eye");
    expectError("cull " + scene + " --eye 1,2", 2, "--eye 1,2: not X,Y,Z of a point");
    for (const char* other : {"--path walk", "--frames 3", "--seed 4", "--cameras a.json"})
        expectError("cull " + scene + " --eye 1,2,3 " + other, 2,
                    "--eye excludes --cameras, --path, --frames and --seed");
}

TEST_F(PathOptions, ARunsFileIsItsCameras) {
    for (const char* path : {"--path scatter --frames 5", "--path walk --frames 8", "--eye 3,1.6,-2"}) {
        const json run = cull(std::string("building:1:2 ") + path);
        write("run.json", run.dump());
        const json again = cull("building:1:2 --cameras run.json");
        ASSERT_EQ(again["frames"].size(), run["frames"].size());
        for (size_t i = 0; i < run["frames"].size(); ++i) {
            EXPECT_EQ(again["frames"][i]["camera"], run["frames"][i]["camera"]) << path << ", frame " << i;
            EXPECT_EQ(again["frames"][i]["visible"], run["frames"][i]["visible"]) << path << ", frame " << i;
        }
    }
}

TEST_F(SizeOptions, AreOffUnlessAsked) {
    const json run = cull("city:1:400 --frames 2 --seed 1");
    for (const json& row : run["frames"][0]["stages"]) {
        EXPECT_NE(row["name"], "distance");
        EXPECT_NE(row["name"], "contribution");
    }
    EXPECT_FALSE(run.contains("changes"));
    EXPECT_FALSE(run["frames"][0].contains("changed_pixels"));
}

TEST_F(SizeOptions, AreCountedApartWithThePixelsThatTheyCost) {
    const json plain = cull("city:1:2000 --frames 3 --seed 1");
    const json run = cull("city:1:2000 --frames 3 --seed 1 --contribution 3px");
    EXPECT_EQ(run["contribution"], 3.0);
    EXPECT_GT(culledBy(run, "contribution"), 0u);
    uint64_t changed = 0;
    for (size_t i = 0; i < 3; ++i) {
        const json& frame = run["frames"][i];
        changed += frame["changed_pixels"].get<uint64_t>();
        uint64_t sum = frame["visible"].size();
        for (const json& row : frame["stages"]) sum += row["culled"].get<uint64_t>();
        EXPECT_EQ(sum, run["scene"]["objects"].get<uint64_t>());
        EXPECT_LE(frame["visible"].size(), plain["frames"][i]["visible"].size());
    }
    EXPECT_EQ(run["changes"]["changed_pixels"], changed);
    EXPECT_EQ(run["changes"]["pixels"], 3 * 320 * 180);
    EXPECT_GT(changed, 0u);
    EXPECT_LT(changed, 3u * 320 * 180 / 10);
    const json far = cull("city:1:2000 --frames 3 --seed 1 --distance 50");
    EXPECT_GT(culledBy(far, "distance"), 0u);
    EXPECT_GT(far["changes"]["changed_pixels"].get<uint64_t>(), 0u);
}

TEST_F(SizeOptions, ProofHoldsTheOtherStagesAndDoesNotCallTheseWrong) {
    const json run = cull("city:1:2000 --frames 3 --seed 1 --distance 120 --contribution 4 --verify --rays 20000");
    EXPECT_GT(culledBy(run, "contribution") + culledBy(run, "distance"), 0u);
    EXPECT_GT(culledBy(run, "occlusion"), 0u);
    EXPECT_EQ(run["verification"]["false_culls"], 0);
    EXPECT_GT(run["verification"]["lossy_seen"].get<uint64_t>(), 0u) << "what they left out was to be seen";
}

TEST_F(SizeOptions, ProofTellsThePixelsToo) {
    const std::string arguments =
        " city:1:400 --frames 2 --seed 1 --contribution 4px --size 320x180 --rays 2000 --json -";
    const Outcome culled = run("cull" + arguments + " --repeat 1 --verify"), judged = run("verify" + arguments);
    ASSERT_EQ(judged.exit_code, 0) << judged.err;
    EXPECT_EQ(json::parse(judged.out)["changes"], json::parse(culled.out)["changes"]);
    EXPECT_NE(judged.err.find("changed "), std::string::npos) << judged.err;
}

TEST_F(SizeOptions, AreTheSameForAnyNumberOfThreads) {
    const std::string arguments = "city:1:1000 --frames 6 --seed 2 --contribution 2px --distance 300 --threads ";
    const json one = cull(arguments + "1"), three = cull(arguments + "3");
    for (size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(one["frames"][i]["visible"], three["frames"][i]["visible"]) << i;
        EXPECT_EQ(one["frames"][i]["changed_pixels"], three["frames"][i]["changed_pixels"]) << i;
    }
}

TEST_F(SizeOptions, HysteresisKeepsWhatTheFrameBeforeShowed) {
    // Backwards along a street: things become smaller.
    json camera_path = {{"frames", json::array()}};
    const json forwards = cull("city:1:1000 --frames 24");
    for (size_t i = 24; i-- > 0;) camera_path["frames"].push_back(forwards["frames"][i]["camera"]);
    write("back.json", camera_path.dump());
    const std::string arguments = "city:1:1000 --cameras back.json --contribution 6px --threads ";
    const json plain = cull(arguments + "2"), kept = cull(arguments + "2 --hysteresis 0.9");
    EXPECT_EQ(kept["hysteresis"], 0.9);
    EXPECT_EQ(kept["frames"][0]["visible"], plain["frames"][0]["visible"]) << "there is none before the first";
    size_t more = 0;
    for (size_t i = 1; i < 24; ++i) {
        const auto before = plain["frames"][i - 1]["visible"].get<std::vector<uint64_t>>();
        const auto less = plain["frames"][i]["visible"].get<std::vector<uint64_t>>();
        // What is drawn besides may hide some that were seen past its place.
        for (const uint64_t key : kept["frames"][i]["visible"].get<std::vector<uint64_t>>()) {
            if (std::binary_search(less.begin(), less.end(), key)) continue;
            ++more;
            EXPECT_TRUE(std::binary_search(before.begin(), before.end(), key)) << "frame " << i << ", object " << key;
        }
    }
    EXPECT_GT(more, 10u);
    const json other = cull(arguments + "1 --hysteresis 0.9");
    for (size_t i = 0; i < 24; ++i) EXPECT_EQ(other["frames"][i]["visible"], kept["frames"][i]["visible"]) << i;
    expectError("cull city:1:10 --hysteresis 0.1", 2, "--hysteresis");
    expectError("cull city:1:10 --distance 5 --hysteresis 1.5", 2, "--hysteresis");
}

// docs/tour.md, "A walk, as a game asks".
TEST_F(MemoryOptions, AnswerMostOfTheToursWalkWithoutDrawing) {
    const json run = answer("cull building:1:1 --path walk --frames 200 --seed 2 --remember");
    size_t undrawn = 0;
    for (const json& frame : run["frames"])
        undrawn += !frame.contains("occluder_triangles") || frame["occluder_triangles"] == 0;
    EXPECT_EQ(undrawn, 191u);
}

TEST_F(MemoryOptions, AQueryThatRemembersIsJudgedInOrder) {
    const std::string walk = "city:1:400 --path walk --frames 60 --seed 3 ";
    const json alone = cull(walk), kept = cull(walk + "--remember --verify --rays 2000 --threads 2"),
               again = cull(walk + "--remember --threads 1");
    EXPECT_EQ(alone["stateless"], true);
    EXPECT_EQ(kept["stateless"], false);
    EXPECT_EQ(kept["repeat"], 1);
    EXPECT_EQ(kept["verification"]["false_culls"], 0);
    uint64_t proved = 0, unasked = 0;
    for (size_t i = 0; i < 60; ++i) {
        EXPECT_EQ(kept["frames"][i]["visible"], again["frames"][i]["visible"]) << i;
        proved += kept["frames"][i].value("proved", 0u);
        unasked += kept["frames"][i].value("unasked", 0u);
        EXPECT_EQ(alone["frames"][i].value("proved", 0u), 0u);
    }
    EXPECT_GT(proved, 60u);
    EXPECT_GT(unasked, 60u);
    EXPECT_NE(succeed("cull " + walk + "--remember --size 320x180").out.find("without drawing"), std::string::npos);
    expectError("cull city:1:10 --frames 2 --remember --repeat 3", 2, "--repeat");
}

TEST_F(MemoryOptions, WhatAnImageDoesNotShowIsProposedAndProved) {
    const std::string walk = "building:1:1 --path walk --frames 60 --seed 3 --remember ";
    const json plain = cull(walk), proposed = cull(walk + "--propose --verify --rays 2000");
    EXPECT_EQ(proposed["verification"]["false_culls"], 0);
    size_t kept = 0, left = 0;
    for (size_t i = 0; i < 60; ++i) {
        kept += plain["frames"][i]["visible"].size();
        left += proposed["frames"][i]["visible"].size();
    }
    EXPECT_LT(left, kept);
    EXPECT_EQ(proposed["frames"][0]["visible"], plain["frames"][0]["visible"]) << "nothing was proposed yet";
}

TEST_F(MemoryOptions, AQueryIsTaughtByAnotherAndItsCullsAreProved) {
    const std::string walk = "building:1:1 --path walk --frames 60 --seed 3 --remember ";
    const json plain = cull(walk), taught = cull(walk + "--taught --verify --rays 2000");
    EXPECT_EQ(taught["verification"]["false_culls"], 0);
    const auto drawn = [](const json& run) {
        uint64_t frames = 0;
        for (const json& frame : run["frames"]) frames += frame.value("occluder_triangles", 0u) > 0;
        return frames;
    };
    EXPECT_LT(drawn(taught), drawn(plain));
    EXPECT_EQ(taught["frames"][0]["visible"], plain["frames"][0]["visible"]) << "nothing was taught yet";
}

TEST_F(LodOptions, LevelsSaveTrianglesAndTellThePixelsThatTheyChange) {
    const std::string arguments = "terrain:1:64 --path scatter --frames 3 --seed 1";
    const json plain = cull(arguments), run = cull(arguments + " --lod-error 2 --verify --rays 5000");
    EXPECT_EQ(run["lod_error"], 2.0);
    EXPECT_EQ(run["verification"]["false_culls"], 0);
    uint64_t saved = 0, changed = 0;
    for (size_t i = 0; i < 3; ++i) {
        const json& frame = run["frames"][i];
        ASSERT_TRUE(frame.contains("changed_pixels"));
        ASSERT_EQ(frame["lods"].size(), frame["visible"].size());
        changed += frame["changed_pixels"].get<uint64_t>();
        if (!frame.contains("lod_finest")) continue;
        EXPECT_LE(frame["lod_triangles"], frame["lod_finest"]);
        saved += frame["lod_finest"].get<uint64_t>() - frame["lod_triangles"].get<uint64_t>();
        EXPECT_EQ(culledBy(run, "lod"), 0u);
    }
    EXPECT_GT(saved, 0u);
    EXPECT_LT(changed, 3u * 320 * 180 / 10);
    const Outcome told = succeed("cull " + arguments + " --lod-error 2 --size 320x180 --repeat 1");
    EXPECT_NE(told.out.find("levels  "), std::string::npos) << told.out;
    EXPECT_NE(told.out.find("they err by 2 px at most"), std::string::npos) << told.out;
    EXPECT_FALSE(plain["frames"][0].contains("lod_triangles"));
}

TEST_F(LodOptions, ABudgetIsKeptAndWhatItLeavesOutIsNoFalseCull) {
    const json run = cull(
        "terrain:1:64 --path scatter --frames 3 --seed 1 --budget 0.001 --hard-budget --cost-triangle 1 --cost-object "
        "100 --verify --rays 5000");
    EXPECT_EQ(run["verification"]["false_culls"], 0);
    EXPECT_GT(culledBy(run, "lod"), 0u);
    for (const json& frame : run["frames"])
        if (frame.contains("lod_cost")) { EXPECT_LE(frame["lod_cost"], 1000); }
}

TEST_F(LodOptions, VerticesAndPixelsCostWhatIsSaid) {
    const std::string arguments =
        "terrain:1:64 --path scatter --frames 3 --seed 1 --budget 0.02 --cost-triangle 1 --cost-object 100";
    const auto triangles = [&](const std::string& more) {
        const json run = cull(arguments + more);
        uint64_t sum = 0;
        for (const json& frame : run["frames"])
            if (frame.contains("lod_triangles")) sum += frame["lod_triangles"].get<uint64_t>();
        return sum;
    };
    const uint64_t plain = triangles("");
    EXPECT_GT(plain, 0u);
    EXPECT_LT(triangles(" --cost-vertex 20"), plain) << "dearer levels are coarser";
    // What covers many pixels costs the same at all levels: then the finest is drawn where it is no dearer than the pixels.
    EXPECT_NE(triangles(" --cost-pixel 0.05"), plain);
    expectError("cull terrain:1:64 --lod-error 1 --cost-vertex -1", 2, "--cost-vertex");
    expectError("cull terrain:1:64 --lod-error 1 --cost-pixel -1", 2, "--cost-pixel");
}

TEST_F(LodOptions, FadesAreTakenAndLimited) {
    const std::string arguments = "terrain:1:64 --path scatter --frames 3 --seed 1 --lod-error 2 --lod-fade ";
    EXPECT_EQ(cull(arguments + "0")["frames"].size(), 3u);
    EXPECT_EQ(cull(arguments + "12")["frames"].size(), 3u);
    expectError("cull " + arguments + "-1", 2, "--lod-fade");
}

TEST_F(LodOptions, SayWhatTheyMiss) {
    expectError("cull city:1:10 --budget 5", 2, "--cost-triangle");
    expectError("cull city:1:10 --hard-budget", 2, "--budget");
    expectError("cull city:1:10 --use lod", 2, "--lod-error");
    expectError("cull city:1:10 --lod-error -1", 2, "--lod-error");
}

TEST_F(SizeOptions, ExplainNamesThem) {
    const Outcome small = succeed("explain city:1:400 --frames 1 --seed 1 --object 3 --contribution 5000 --json -");
    const Outcome far = succeed("explain city:1:400 --frames 1 --seed 1 --object 3 --distance 0.0001 --skip frustum");
    EXPECT_NE(far.out.find("culled by distance"), std::string::npos) << far.out;
    const Outcome tiny =
        run("explain city:1:400 --frames 1 --seed 1 --object 3 --contribution 16000 --use contribution --json -");
    EXPECT_NE(tiny.out.find("contribution"), std::string::npos) << tiny.out;
}

TEST_F(SizeOptions, WrongValuesExitWithTwo) {
    for (const char* value : {"-1px", "px", "nan", "inf", "99999", "2em", "''"})
        expectError("cull city:1:10 --contribution=" + std::string(value), 2, "--contribution");
    for (const char* value : {"-5", "nan", "far", "''"})
        expectError("cull city:1:10 --distance=" + std::string(value), 2, "--distance");
    expectError("cull city:1:10 --use frustum,contribution", 2, "--contribution");
    expectError("cull city:1:10 --use distance", 2, "--distance");
}

TEST_F(SectionOptions, CutTheSceneAndAreProved) {
    const std::string arguments = "city:1:1000 --frames 3 --seed 1 --verify --rays 20000";
    const json whole = cull(arguments);
    EXPECT_FALSE(whole.contains("sections"));
    const json cut = cull(arguments + " --section=0,-1,0,6 --section -1,0,0.5,80");
    EXPECT_EQ(cut["sections"], json::parse("[[0.0,-1.0,0.0,6.0],[-1.0,0.0,0.5,80.0]]"));
    EXPECT_EQ(cut["verification"]["false_culls"], 0);
    EXPECT_GT(cut["verification"]["exactly_visible"].get<uint64_t>(), 0u);
    bool differs = false;
    for (size_t i = 0; i < 3; ++i) differs |= whole["frames"][i]["visible"] != cut["frames"][i]["visible"];
    EXPECT_TRUE(differs);
}

TEST_F(SectionOptions, ExplainNamesThem) {
    const Outcome gone = succeed("explain city:1:400 --frames 1 --seed 1 --object 3 --section 0,1,0,-100000");
    EXPECT_NE(gone.out.find("section 1"), std::string::npos) << gone.out;
}

TEST_F(SectionOptions, WrongValuesExitWithTwo) {
    for (const char* value : {"1,0,0", "1,0,0,0,0", "0,0,0,1", "a,b,c,d", "1,0,nan,0", "1,0,inf,0", "''", ",,,"})
        expectError("cull city:1:10 --section=" + std::string(value), 2, "--section");
    std::string nine = "cull city:1:10";
    for (int i = 0; i < 9; ++i) nine += " --section=1,0,0,1";
    expectError(nine, 2, "--section");
}

TEST_F(ClusterOptions, SubmitLessAndAreProved) {
    const json whole = cull("building:1:2 --frames 3 --seed 1"),
               left = cull("building:1:2 --frames 3 --seed 1 --use frustum,occlusion,clusters --verify --rays 20000");
    EXPECT_EQ(left["verification"]["false_culls"], 0);
    uint64_t drawn = 0, all = 0;
    for (size_t i = 0; i < 3; ++i) {
        const json &before = whole["frames"][i], &after = left["frames"][i];
        EXPECT_FALSE(before.contains("clusters"));
        const json& clusters = after["clusters"];
        drawn += clusters["drawn"].get<uint64_t>();
        all += clusters["whole"].get<uint64_t>();
        EXPECT_LE(clusters["draws"], clusters["tested"]);
        EXPECT_LE(after["triangles"], before["triangles"]);
        EXPECT_EQ(after["stages"].back()["name"], "clusters");
    }
    EXPECT_GT(drawn, 0u);
    EXPECT_LT(drawn, all);
}

TEST_F(ClusterOptions, AreToldOf) {
    const Outcome told = succeed("cull building:1:2 --frames 2 --seed 1 --use frustum,occlusion,clusters");
    EXPECT_NE(told.out.find("visible"), std::string::npos) << told.out;
    EXPECT_NE(told.out.find("seen from the back"), std::string::npos) << told.out;
}

}  // namespace
}  // namespace sightline
