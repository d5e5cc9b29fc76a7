// The command line is a contract: verbs, exit codes, schemas, and who writes where.
// SPDX-License-Identifier: MIT
#include "tests/cli/tool.h"

namespace sightline {
namespace {

/// Takes the times out: everything else must be the same from run to run.
json timeless(json run) {
    for (json& frame : run["frames"]) {
        for (const char* name : {"query_microseconds", "begin_microseconds", "end_microseconds", "thread"})
            frame.erase(name);
        for (json& stage : frame["stages"]) stage.erase("microseconds");
    }
    return run;
}

class Cli : public Tool {
protected:
    json cull(const std::string& arguments) const { return answer("cull " + arguments); }
};

TEST_F(Cli, HelpAndVersionSucceed) {
    EXPECT_EQ(run("--help").exit_code, 0);
    EXPECT_NE(run("--version").out.find("sightline 0."), std::string::npos);
    for (const char* verb : {"cull", "verify", "render", "replay", "info"}) {
        EXPECT_NE(run("--help").out.find(verb), std::string::npos) << verb;
        const Outcome help = run(std::string(verb) + " --help");
        EXPECT_EQ(help.exit_code, 0) << verb;
        EXPECT_NE(help.out.find("--json"), std::string::npos) << verb;
    }
}

TEST_F(Cli, WrongArgumentsExitWithTwo) {
    EXPECT_EQ(run("").exit_code, 2);
    expectError("fly city:1:10", 2, "fly");
    expectError("cull", 2, "SCENE");
    expectError("cull city:1:10 --wrong", 2, "--wrong");
    expectError("cull city:1:10 --use frustum,magic", 2, "magic");
    expectError("cull city:1:10 --skip magic", 2, "magic");
    expectError("cull city:1:10 --frames 0", 2, "--frames");
    expectError("cull city:1:10 --frames -4", 2, "--frames");
    expectError("cull city:1:10 --threads many", 2, "--threads");
    expectError("cull city:1:10 --cameras a.json --frames 3", 2, "--cameras");
    expectError("cull city:1:10 --cameras a.json --path walk", 2, "--cameras excludes --path");
    expectError("cull city:1:10 --path fly", 2, "--path");
    expectError("cull city:1:10 --frames 3 --fps 30", 2, "--fps goes with --path walk");
    expectError("verify city:1:10 --path scatter --speed 2", 2, "--speed goes with --path walk");
    expectError("cull city:1:10 --path walk --fps 0", 2, "--fps");
    expectError("cull city:1:10 --path walk --fps nan", 2, "--fps");
    expectError("cull city:1:10 --path walk --speed nan", 2, "--speed");
    for (const char* size : {"12", "0x5", "5x0", "x", "axb", "10x10x10", "99999x10", "-1x5", "10x"})
        expectError("cull city:1:10 --size=" + std::string(size), 2, "--size");
    for (const char* city : {"city:", "city:1", "city:1:", "city:1:0", "city:x:5", "city:1:5:6", "city:1:99999999999"})
        expectError("cull " + std::string(city), 2, city);
}

TEST_F(Cli, FlagsTakeNoValue) {
    for (const char* word :
         {"cull city:1:10 --no-faces=3", "cull city:1:10 --masked=false", "cull city:1:10 --verify=1",
          "verify city:1:10 --no-second-look=0", "info city:1:10 --objects=2", "report a.json --compare=1 --quiet=2",
          "replay a.rec --quiet=1", "--help=1", "--version=1", "cull --help=1"})
        expectError(word, 2, "takes no value");
    EXPECT_EQ(run("cull city:1:10 --frames=1 --size=32x18 --masked --repeat=1").exit_code, 0);
    expectError("cull city:1:10 --stereo 0", 2, "--stereo: 0 is not a distance between the eyes");
    expectError("cull city:1:10 --stereo wide", 2, "--stereo");
    expectError("cull city:1:10 --occluder-error nan", 2, "--occluder-error: not a number");
}

TEST_F(Cli, CullWritesTheSchemaToStandardOutputAlone) {
    const Outcome outcome = succeed("cull city:1:300 --frames 3 --size 320x180 --verify --rays 20000 --json -");
    const json out = json::parse(outcome.out);  // fails if anything else is on standard output
    EXPECT_EQ(out["schema"], "sightline.cull/1");
    EXPECT_EQ(out["scene"]["file"], "city:1:300");
    EXPECT_EQ(out["scene"]["objects"], 300);
    EXPECT_EQ(out["width"], 320);
    EXPECT_EQ(out["height"], 180);
    ASSERT_EQ(out["frames"].size(), 3u);
    uint64_t reported = 0;
    for (const json& frame : out["frames"]) {
        uint64_t culled = 0;
        for (const json& stage : frame["stages"]) culled += stage["culled"].get<uint64_t>();
        EXPECT_EQ(frame["visible"].size() + culled, 300u);
        EXPECT_TRUE(std::is_sorted(frame["visible"].begin(), frame["visible"].end()));
        EXPECT_TRUE(frame["camera"]["far"].is_null() || frame["camera"]["far"].is_number());
        EXPECT_LE(frame["triangles"], out["scene"]["triangles"]);
        reported += frame["visible"].size();
    }
    EXPECT_EQ(out["verification"]["false_culls"], 0);
    EXPECT_EQ(out["verification"]["reported"], reported);
    EXPECT_GE(out["verification"]["samples"], 1);
    EXPECT_LE(out["verification"]["exactly_visible"], reported);
    // Every object of every frame is decided: what is culled is hidden, what is kept is seen or could have been culled.
    const json& proofs = out["verification"]["proofs"];
    EXPECT_EQ(proofs["culled_hidden"], out["verification"]["culled"]);
    EXPECT_EQ(proofs["culled_undecided"], 0);
    EXPECT_EQ(proofs["kept_undecided"], 0);
    EXPECT_EQ(out["verification"]["exactly_visible"].get<int>() + proofs["kept_hidden"].get<int>(), reported);
    EXPECT_NE(outcome.err.find("verified"), std::string::npos);  // the summary went there
}

TEST_F(Cli, ThreadsDoNotChangeTheAnswer) {
    const std::string common = "city:1:2000 --frames 6 --size 320x180 --repeat 1 --threads ";
    const json one = timeless(cull(common + "1"));
    EXPECT_EQ(one, timeless(cull(common + "2")));
    EXPECT_EQ(one, timeless(cull(common + "7")));
}

TEST_F(Cli, ThreadsShareAQueryAndDoNotChangeItsAnswer) {
    const std::string common = "city:1:2000 --frames 4 --size 320x180 --repeat 1 --threads 1 --bins 4 ";
    const json one = timeless(cull(common));
    EXPECT_EQ(one["bins"], 4);
    EXPECT_EQ(one, timeless(cull(common + "--query-threads 2")));
    EXPECT_EQ(one, timeless(cull(common + "--query-threads 5")));
    const std::string eyes = "city:1:500 --frames 2 --size 320x180 --repeat 1 --stereo 0.06 ";
    EXPECT_EQ(timeless(cull(eyes)), timeless(cull(eyes + "--query-threads 2")));
    expectError("cull city:1:10 --query-threads 2", 2, "--bins");
    expectError("cull city:1:10 --bins 0", 2, "--bins");
    expectError("verify city:1:10 --bins 17", 2, "--bins");
}

TEST_F(Cli, StagesNarrow) {
    const std::string common = "city:1:2000 --frames 2 --size 320x180 --repeat 1 ";
    const json none = cull(common + "--skip frustum,occlusion");
    const json frustum = cull(common + "--use frustum");
    const json all = cull(common);
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(none["frames"][i]["visible"].size(), 2000u);
        ASSERT_EQ(frustum["frames"][i]["stages"].size(), 1u);
        const auto wide = frustum["frames"][i]["visible"].get<std::vector<uint64_t>>();
        const auto narrow = all["frames"][i]["visible"].get<std::vector<uint64_t>>();
        EXPECT_LT(wide.size(), 2000u);
        EXPECT_LT(narrow.size(), wide.size());
        EXPECT_TRUE(std::includes(wide.begin(), wide.end(), narrow.begin(), narrow.end()));
    }
}

// The smaller the buffer, the more of its pixels meet an edge.
TEST_F(Cli, TheOcclusionBuffersSizeIsAskedForAndNamed) {
    const std::string common = "city:1:2000 --frames 2 --size 640x360 --repeat 1 --jitter 0 --no-second-look ";
    const json small = cull(common + "--occlusion-size 64"), usual = cull(common);
    EXPECT_EQ(small["occlusion_size"], 64);
    EXPECT_EQ(usual["occlusion_size"], 384);
    for (size_t i = 0; i < 2; ++i)
        EXPECT_GT(small["frames"][i]["visible"].size(), usual["frames"][i]["visible"].size());
    EXPECT_EQ(run("verify city:1:2000 --frames 1 --size 64x36 --rays 5000 --occlusion-size 8").exit_code, 0);
    EXPECT_EQ(run("explain city:1:200 --frames 1 --size 64x36 --object 7 --occlusion-size 8").exit_code, 0);
    for (const char* size : {"0", "8193", "-1", "many", "1.5"})
        expectError("cull city:1:10 --occlusion-size " + std::string(size), 2, "--occlusion-size");
}

TEST_F(Cli, CamerasOfOneRunReplayInAnother) {
    const json first = cull("city:1:500 --frames 2 --seed 9 --size 200x100 --repeat 1");
    json path;
    for (const json& frame : first["frames"]) path["frames"].push_back(frame["camera"]);
    write("path.json", path.dump());
    const json second = cull("city:1:500 --cameras path.json --size 200x100 --repeat 1");
    EXPECT_EQ(timeless(first)["frames"], timeless(second)["frames"]);
}

TEST_F(Cli, WithoutFramesATourOfSixteen) {
    EXPECT_EQ(cull("city:1:50 --size 64x36 --repeat 1")["frames"].size(), 16u);
    EXPECT_EQ(timeless(cull("city:1:50 --size 64x36 --repeat 1")),
              timeless(cull("city:1:50 --size 64x36 --repeat 1 --path tour --frames 16 --seed 1")));
}

TEST_F(Cli, FramesOfACityWalkItsStreets) {
    const json streets = cull("city:1:50 --frames 3 --size 64x36 --repeat 1");
    const json larger = cull("city:1:400 --frames 3 --size 64x36 --repeat 1");
    for (size_t i = 0; i < 3; ++i) EXPECT_EQ(streets["frames"][i]["camera"], larger["frames"][i]["camera"]);
    const json seeded = cull("city:1:50 --frames 3 --seed 1 --size 64x36 --repeat 1");
    EXPECT_NE(streets["frames"][0]["camera"], seeded["frames"][0]["camera"]);
}

TEST_F(Cli, VerifyTellsTheOverEstimate) {
    const Outcome outcome = succeed("verify city:1:200 --frames 2 --size 160x90 --rays 20000 --json result.json");
    EXPECT_NE(outcome.out.find("frame    1: sound"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("over-estimate"), std::string::npos);
    const json out = json::parse(read(path("result.json")));
    EXPECT_GE(out["verification"]["over_estimate"], 1.0);
    EXPECT_EQ(out["frames"][0]["verification"]["false_culls"], 0);
}

TEST_F(Cli, OccluderTrianglesAreABudget) {
    const std::string common = "cull city:1:500 --frames 2 --size 160x90 --repeat 1 --json - -q --occluder-triangles ";
    const Outcome none = succeed(common + "0"), all = run(common + "1000000");
    const auto little = nlohmann::json::parse(none.out), much = nlohmann::json::parse(all.out);
    EXPECT_EQ(little["occluder_triangles_limit"], 0);
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(little["frames"][i]["occluder_triangles"], 0);
        EXPECT_TRUE(little["frames"][i]["budget_spent"].get<bool>());
        EXPECT_FALSE(much["frames"][i]["budget_spent"].get<bool>());
        EXPECT_GT(little["frames"][i]["visible"].size(), much["frames"][i]["visible"].size());
    }
    expectError("cull city:1:50 --occluder-triangles -1", 2, "occluder-triangles");
}

TEST_F(Cli, InfoCounts) {
    const json out = answer("info city:1:100");
    EXPECT_EQ(out["schema"], "sightline.info/1");
    EXPECT_EQ(out["objects"], 100);
    EXPECT_LE(out["triangles"]["occluding"], out["triangles"]["drawn"]);
    EXPECT_LT(out["bounds"]["min"][0], out["bounds"]["max"][0]);
    EXPECT_NE(run("info city:1:100").out.find("100"), std::string::npos);
}

}  // namespace
}  // namespace sightline
