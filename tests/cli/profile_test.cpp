// The verbs profile and advise: their words, their schemas, and what their counters must say.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <set>

#include "tests/cli/tool.h"

namespace sightline {
namespace {

constexpr const char* kSmall = " --frames 1 --seed 1 --size 160x90 --repeat 1";

class Profile : public Tool {
protected:
    /// By what the rows are called.
    static std::map<std::string, json> rowsOf(const json& run) {
        std::map<std::string, json> rows;
        for (const json& row : run["ablation"]) rows[row["stages"].get<std::string>()] = row;
        return rows;
    }
};

TEST_F(Profile, WritesItsSchema) {
    const Outcome outcome =
        succeed("profile city:1:300 --time-limit 1 --json p.json" + std::string(kSmall) + " --no-config");
    const json run = json::parse(read(path("p.json")));
    EXPECT_EQ(run["schema"], "sightline.profile/1");
    EXPECT_EQ(run["scene"]["objects"], 300);
    EXPECT_EQ(run["renderer"], "reference");
    EXPECT_EQ(run["frames"], 1);
    EXPECT_EQ(run["threads"], 1);
    const std::set<std::string> verdicts = {"limited", "mixed", "undecided"};
    EXPECT_TRUE(verdicts.count(run["bottleneck"]["verdict"])) << run["bottleneck"];
    ASSERT_EQ(run["bottleneck"]["stages"].size(), 4u);
    const char* const stages[] = {"fill", "transform", "bus", "cpu"};
    for (size_t i = 0; i < 4; ++i) EXPECT_EQ(run["bottleneck"]["stages"][i]["name"], stages[i]);
    EXPECT_GT(run["bottleneck"]["path_milliseconds"], 0);
    EXPECT_EQ(run["bottleneck"]["gpu_milliseconds"], 0.0);  // there is none
    for (const char* cost : {"object_ns", "triangle_ns", "vertex_ns", "pixel_ns", "cluster_test_ns"})
        EXPECT_GE(run["costs"][cost], 0) << cost;
    for (const char* words :
         {"sensitivity", "confidence", "a covered pixel", "without occlusion", "geometry", "rasterizer", "bus"})
        EXPECT_NE(outcome.out.find(words), std::string::npos) << words << "\n" << outcome.out;
    EXPECT_NE(outcome.out.find(run["bottleneck"]["words"].get<std::string>()), std::string::npos);
    // Cluster building reads its costs.
    const json cull = answer("cull building:1:1 --use frustum,clusters --calibration p.json" + std::string(kSmall));
    EXPECT_EQ(cull["cluster_test"].get<double>(),
              run["costs"]["cluster_test_ns"].get<double>() / run["costs"]["triangle_dropped_ns"].get<double>());
}

// Counters are the same on every machine, and no stage adds to what is drawn.
TEST_F(Profile, LeavingAStageOutDrawsNoLess) {
    const std::string words = "profile city:1:2000 --path walk --time-limit 0.1" + std::string(kSmall);
    const std::map<std::string, json> rows = rowsOf(answer(words)), again = rowsOf(answer(words));
    const std::set<std::string> names = {"as asked", "without frustum", "without occlusion", "with volumes",
                                         "no stage"};
    for (const auto& [name, row] : rows) {
        EXPECT_TRUE(names.count(name)) << name;
        for (const char* counter : {"objects", "triangles", "triangles_drawn", "fragments", "bytes"}) {
            EXPECT_EQ(row[counter], again.at(name)[counter]) << name << ", " << counter;
            EXPECT_LE(row[counter], rows.at("no stage")[counter]) << name << ", " << counter;
        }
        if (name != "with volumes") {
            for (const char* counter : {"objects", "triangles", "bytes"})
                EXPECT_GE(row[counter], rows.at("as asked")[counter]) << name << ", " << counter;
        }
        EXPECT_GT(row["frame_milliseconds"], 0);
    }
    EXPECT_EQ(rows.size(), names.size());
    EXPECT_EQ(rows.at("no stage")["objects"], 2000);
    EXPECT_EQ(rows.at("without occlusion")["in_use"], true);
    EXPECT_EQ(rows.at("with volumes")["in_use"], false);
    EXPECT_GT(rows.at("without occlusion")["benefits"]["geometry"], 0.1);
    EXPECT_GT(rows.at("without frustum")["benefits"]["geometry"], 0.1);
    EXPECT_EQ(rows.at("without occlusion")["benefits"]["words"], "geometry, rasterizer, bus");
}

TEST_F(Profile, StreamingCarriesMeshes) {
    const std::string words = "profile city:1:300 --time-limit 0.1" + std::string(kSmall);
    const json plain = answer(words + " --use frustum"), stream = answer(words + " --use frustum --stream");
    EXPECT_EQ(plain["ablation"][0]["bytes"].get<double>(), 64 * plain["ablation"][0]["objects"].get<double>());
    EXPECT_GT(stream["ablation"][0]["bytes"], plain["ablation"][0]["bytes"]);
    EXPECT_EQ(stream["ablation"][0]["objects"], plain["ablation"][0]["objects"]);
    EXPECT_EQ(stream["stream"], true);
}

TEST_F(Profile, LooksAtFourFramesOfAPathThatNobodyAskedFor) {
    const std::string words = "profile city:1:50 --time-limit 0.1 --size 64x36 --repeat 1";
    EXPECT_EQ(answer(words)["frames"], 4);
    EXPECT_EQ(answer(words + " --frames 3")["frames"], 3);
}

TEST_F(Profile, DrawsByTheGlWhereThereIsOne) {
    const Outcome outcome = run("profile city:1:100 --renderer gl --time-limit 1 --json -" + std::string(kSmall));
    if (outcome.exit_code == 2) {
        EXPECT_NE(outcome.err.find("this build has no GL"), std::string::npos) << outcome.err;
        return;
    }
    if (outcome.exit_code == 3) {
        EXPECT_NE(outcome.err.find("OpenGL"), std::string::npos) << outcome.err;
        return;
    }
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const json run = json::parse(outcome.out);
    EXPECT_EQ(run["renderer"], "gl");
    EXPECT_NE(run["driver"].get<std::string>(), "");
    EXPECT_GT(run["driver_counts"]["samples_passed"], 0);
    EXPECT_GT(run["driver_counts"]["gpu_busy"], 0);
    EXPECT_LE(run["driver_counts"]["gpu_busy"], 1.001);
}

TEST_F(Profile, WrongArgumentsAreRefused) {
    expectError("profile", 2, "SCENE");
    expectError("profile city:1:10 --renderer vulkan", 2, "--renderer");
    expectError("profile city:1:10 --time-limit 0", 2, "--time-limit");
    expectError("profile city:1:10 --time-limit soon", 2, "--time-limit");
    expectError("profile city:1:10 --repeat 0", 2, "--repeat");
    expectError("profile city:1:10 --rays 5", 2, "--rays");
    expectError("profile city:1:10 --stream=2", 2, "takes no value");
    expectError("profile no-such.glb", 3, "no-such.glb");
    expectError("profile city:1:10 --json no-such-folder/p.json", 4, "no-such-folder");
    write(
        "c.json",
        R"({"frames": [{"view": [0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0], "projection": [0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0]}]})");
    EXPECT_EQ(run("profile city:1:10 --cameras c.json").exit_code, 3);
    expectError("profile city:1:10 --cameras c.json --json c.json", 2, "c.json");
    expectError("advise", 2, "SCENE");
    expectError("advise city:1:10 --renderer gl", 2, "--renderer");
    expectError("advise city:1:10 --json no-such-folder/a.json", 4, "no-such-folder");
    expectError("advise no-such.glb", 3, "no-such.glb");
}

TEST_F(Profile, AdvisesInTenLines) {
    const Outcome outcome = succeed("advise building:1:1 --json a.json" + std::string(kSmall));
    EXPECT_LE(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 10) << outcome.out;
    EXPECT_EQ(outcome.out.rfind("measured: 1 frame at 160x90", 0), 0u) << outcome.out;
    const json run = json::parse(read(path("a.json")));
    EXPECT_EQ(run["schema"], "sightline.advise/1");
    std::set<std::string> kinds, whats;
    for (const json& row : run["advice"]) {
        kinds.insert(row["kind"]);
        whats.insert(row["what"]);
        EXPECT_TRUE(row["saves_milliseconds"].is_number());
        EXPECT_GE(row["spread_milliseconds"], 0);
    }
    EXPECT_TRUE(kinds.count("bake")) << run;  // its cells are marked
    for (const char* stage : {"frustum", "occlusion", "volumes"}) EXPECT_TRUE(whats.count(stage)) << stage;
    EXPECT_GT(run["frame_milliseconds"], 0);
}

TEST_F(Profile, AdviceSaysWhatItDidNotTry) {
    const json run = answer("advise made:walls" + std::string(kSmall));
    std::string all;
    for (const json& row : run["not_tried"]) all += row.get<std::string>() + "\n";
    for (const char* what : {"clusters: ", "split: ", "merge: "})
        EXPECT_NE(all.find(what), std::string::npos) << what << all;
}

}  // namespace
}  // namespace sightline
