// Counting by key and the JSON that others rely on.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/cull_run.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sightline/base/random.h"
#include "tests/tools/report/run/made_run.h"

namespace sightline {
using namespace tools;
namespace {

using nlohmann::json;

TEST(CullRun, KeepsAKeyIfAnyOfItsObjectsIsVisible) {
    const Scene scene = madeScene();
    const CullRun run = madeRun(scene);
    EXPECT_EQ(run.objects, 3u);
    EXPECT_EQ(run.instances, 4u);
    const FrameResult& frame = run.frames[0];
    EXPECT_EQ(frame.visible, (std::vector<uint64_t>{5, 7}));
    EXPECT_EQ(frame.objects_visible, 2u);
    EXPECT_EQ(frame.triangles, 4u);
    const StageRow& frustum = frame.stages[static_cast<int>(Stage::kFrustum)];
    EXPECT_EQ(frustum.tested, 3u);
    EXPECT_EQ(frustum.culled, 0u);
    const StageRow& occlusion = frame.stages[static_cast<int>(Stage::kOcclusion)];
    EXPECT_EQ(occlusion.tested, 3u);
    EXPECT_EQ(occlusion.culled, 1u);
}

TEST(CullRun, CountsACulledKeyOnceAndForItsFinestStage) {
    const Scene scene = madeScene();
    FrameResult frame;
    frame.reasons = {0, 0, 1, 2};
    countByKey(scene, orderByKey(scene), kAllStages, frame);
    EXPECT_EQ(frame.visible, (std::vector<uint64_t>{3, 7}));
    EXPECT_EQ(frame.stages[0].culled, 0u);
    EXPECT_EQ(frame.stages[1].culled, 1u);
}

TEST(CullRun, VisibleAndCulledAddUpForAnyReasons) {
    Scene scene = madeScene();
    Random random(11);
    for (int round = 0; round < 200; ++round) {
        scene.objects.resize(1 + random.below(30));
        FrameResult frame;
        for (SceneObject& object : scene.objects) {
            object.key = random.below(12);
            object.mesh = static_cast<uint32_t>(random.below(2));
            frame.reasons.push_back(static_cast<uint8_t>(random.below(1 + kStageCount)));
        }
        const auto order = orderByKey(scene);
        countByKey(scene, order, kAllStages, frame);
        uint64_t culled = 0;
        for (const StageRow& stage : frame.stages) culled += stage.culled;
        EXPECT_EQ(frame.visible.size() + culled, countKeys(scene, order)) << "round " << round;
        EXPECT_TRUE(std::is_sorted(frame.visible.begin(), frame.visible.end())) << "round " << round;
    }
}

TEST(CullRun, JsonHasTheFieldsOfTheSchema) {
    const Scene scene = madeScene();
    const CullRun run = madeRun(scene);
    const json out = json::parse(cullJson(run, scene));
    EXPECT_EQ(out["schema"], "sightline.cull/1");
    EXPECT_EQ(out["scene"]["file"], run.scene);
    EXPECT_EQ(out["scene"]["objects"], 3);
    EXPECT_EQ(out["scene"]["triangles"], 8);
    EXPECT_EQ(out["width"], 64);
    EXPECT_EQ(out["height"], 36);
    ASSERT_EQ(out["frames"].size(), 2u);
    const json& frame = out["frames"][1];
    EXPECT_EQ(frame["camera"]["eye"], json::parse("[0.01, 0.0, 6.0]"));
    for (const char* name : {"eye", "target", "up", "fov_y_degrees", "near", "far"})
        EXPECT_TRUE(frame["camera"].contains(name)) << name;
    EXPECT_TRUE(frame["camera"]["far"].is_null());
    EXPECT_EQ(frame["visible"], json::parse("[5, 7]"));
    ASSERT_EQ(frame["stages"].size(), 3u);
    EXPECT_EQ(frame["stages"][2]["name"], "facing");
    EXPECT_EQ(frame["stages"][1]["instances"], 1);
    EXPECT_EQ(frame["instances"], frame["visible"].size());
    EXPECT_EQ(frame["stages"][0]["name"], "frustum");
    EXPECT_EQ(frame["stages"][1]["name"], "occlusion");
    EXPECT_EQ(frame["stages"][1]["tested"], 3);
    EXPECT_EQ(frame["stages"][1]["culled"], 1);
    EXPECT_EQ(frame["stages"][0]["microseconds"], 2.5);
    EXPECT_EQ(frame["triangles"], 4);
    EXPECT_EQ(frame["query_microseconds"], 11.5);
    EXPECT_EQ(out["verification"]["false_culls"], 0);
    EXPECT_EQ(out["verification"]["samples"], 2000);
    EXPECT_EQ(out["verification"]["exactly_visible"], 4);
    EXPECT_EQ(out["verification"]["reported"], 4);
}

TEST(CullRun, JsonHasNoVerificationThatWasNotAskedFor) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene);
    for (FrameResult& frame : run.frames) frame.verification.reset();
    const json out = json::parse(cullJson(run, scene));
    EXPECT_FALSE(out.contains("verification"));
}

TEST(CullRun, JsonListsOnlyStagesInUse) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene);
    run.settings.stages = stageBit(Stage::kFrustum);
    const json out = json::parse(cullJson(run, scene));
    ASSERT_EQ(out["frames"][0]["stages"].size(), 1u);
    EXPECT_EQ(out["frames"][0]["stages"][0]["name"], "frustum");
}

TEST(CullRun, JsonOfMatricesAndParallelViewsReadsBack) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene);
    CameraFrame& camera = run.frames[0].camera;
    camera.view = lookAt({1, 2, 3}, {4, 5, -6}, {0, 1, 0});
    camera.projection = perspective(1.0, 1.5, 0.1);
    run.frames[1].camera.orthographic_height = 12;
    run.frames[1].camera.z_far = 50;
    const json out = json::parse(cullJson(run, scene));
    EXPECT_EQ(out["frames"][0]["camera"]["view"].size(), 16u);
    EXPECT_NEAR(out["frames"][0]["camera"]["eye"][2].get<double>(), 3, 1e-12);
    EXPECT_NEAR(out["frames"][0]["camera"]["fov_y_degrees"].get<double>(), 57.29577951308232, 1e-9);
    EXPECT_EQ(out["frames"][1]["camera"]["orthographic_height"], 12);
    EXPECT_EQ(out["frames"][1]["camera"]["far"], 50);
}

TEST(CullRun, JsonMendsNamesThatAreNotUtf8) {
    Scene scene = madeScene();
    scene.objects[1].name = "bad \xff name";
    CullRun run = madeRun(scene);
    run.scene = "\xfe.glb";
    run.frames[0].verification->rows.push_back({1, 3, 1.5, 2.5, "rays"});
    const json out = json::parse(cullJson(run, scene));
    EXPECT_EQ(out["frames"][0]["verification"]["list"][0]["key"], 3);
}

TEST(CullRun, JsonNamesTheKeysThatItSpeaksOf) {
    Scene scene = madeScene();
    scene.nodes = {{"Level 1", SceneNode::kNone}, {"Kitchen", 0}};
    scene.objects[0].node = 1;
    CullRun run = madeRun(scene);
    json out = json::parse(cullJson(run, scene));
    ASSERT_EQ(out["objects"].size(), 2u);  // 5 and 7; 3 was never kept
    EXPECT_EQ(out["objects"][0]["key"], 5);
    EXPECT_EQ(out["objects"][1], json::parse(R"({"key": 7, "name": "wall", "path": "Level 1/Kitchen/wall"})"));
    run.frames[1].verification->rows.push_back({1, 3, 1.5, 2.5, "rays"});
    out = json::parse(cullJson(run, scene));
    ASSERT_EQ(out["objects"].size(), 3u);
    EXPECT_EQ(out["objects"][0]["key"], 3);
}

TEST(CullRun, JsonTellsWhatWasKeptUnseen) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene);
    run.frames[0].reasons = {0, 0, 0, 0};
    run.frames[0].verification->kept_unseen = {1, 2};  // of key 5, object 3 was seen
    EXPECT_EQ(keysKeptUnseen(run.frames[0], scene), std::vector<uint64_t>{3});
    const json out = json::parse(cullJson(run, scene));
    EXPECT_EQ(out["frames"][0]["verification"]["kept_unseen"], json::parse("[3]"));
    EXPECT_EQ(out["frames"][1]["verification"]["kept_unseen"], json::array());
}

TEST(CullRun, JsonTellsAnInterruptedRun) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene);
    EXPECT_FALSE(json::parse(cullJson(run, scene)).contains("interrupted"));
    run.interrupted = true;
    run.frames_wanted = 64;
    const json out = json::parse(cullJson(run, scene));
    EXPECT_EQ(out["interrupted"], true);
    EXPECT_EQ(out["frames_wanted"], 64);
    EXPECT_EQ(out["frames"].size(), 2u);
}

TEST(CullRun, JsonTellsTheFilesOfAScene) {
    Scene scene = madeScene();
    scene.files = {{"a.glb", 0}};
    EXPECT_FALSE(json::parse(cullJson(madeRun(scene), scene))["scene"].contains("files"));
    scene.files.push_back({"b.glb", 100});
    const json out = json::parse(cullJson(madeRun(scene), scene));
    EXPECT_EQ(out["scene"]["files"][1], json::parse(R"({"file": "b.glb", "first_key": 100})"));
}

TEST(CullRun, MedianOfAnEvenNumberLiesBetweenTheTwoInTheMiddle) {
    EXPECT_DOUBLE_EQ(medianOf({}), 0);
    EXPECT_DOUBLE_EQ(medianOf({9, 1, 5}), 5);
    EXPECT_DOUBLE_EQ(medianOf({9, 1, 5, 2}), 3.5);
}

TEST(CullRun, OverEstimateOfNothingIsOne) {
    EXPECT_EQ(Verification().overEstimate(), 1.0);
    Verification sum;
    sum.reported = 3;
    sum.exactly_visible = 2;
    EXPECT_EQ(sum.overEstimate(), 1.5);
}

}  // namespace
}  // namespace sightline
