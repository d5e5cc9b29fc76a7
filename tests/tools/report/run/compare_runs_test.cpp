// Two runs beside one another: pairs by camera, sets, times, false culls, and the verdict.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/compare_runs.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/tools/report/page/page_data.h"
#include "tests/tools/report/run/made_run.h"

namespace sightline {
using namespace tools;
namespace {

using nlohmann::json;

RunFile fileOf(const CullRun& run, const Scene& scene, const std::string& name) {
    Result<RunFile> read = parseRun(cullJson(run, scene), name);
    EXPECT_TRUE(read.ok());
    return std::move(*read);
}

bool says(const RunComparison& comparison, const std::string& word) {
    for (const std::string& sentence : comparison.verdict)
        if (sentence.find(word) != std::string::npos) return true;
    return false;
}

TEST(CompareRuns, ARunEqualsItself) {
    const Scene scene = madeScene();
    const RunFile a = fileOf(madeRun(scene, 5), scene, "a.json");
    const RunComparison same = compareRuns(a, a, 1.0);
    EXPECT_TRUE(same.ok);
    EXPECT_EQ(same.pairs.size(), 5u);
    EXPECT_EQ(same.unpaired_a + same.unpaired_b, 0u);
    EXPECT_EQ(same.only_a + same.only_b, 0u);
    EXPECT_EQ(same.ratio, 1);
    EXPECT_EQ(same.over_estimate_a, same.over_estimate_b);
    EXPECT_TRUE(says(same, "the same objects"));
    EXPECT_TRUE(says(same, "do not tell them apart"));
}

TEST(CompareRuns, PairsFramesByTheirCameras) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene, 5);
    const RunFile a = fileOf(run, scene, "a.json");
    std::swap(run.frames[0], run.frames[4]);
    run.frames.erase(run.frames.begin() + 2);
    run.frames[1].camera.eye.x += 1e-9;
    const RunComparison c = compareRuns(a, fileOf(run, scene, "b.json"));
    ASSERT_EQ(c.pairs.size(), 3u);
    EXPECT_EQ(c.pairs[0].a, 0u);
    EXPECT_EQ(c.pairs[0].b, 3u);
    EXPECT_EQ(c.pairs[2].a, 4u);
    EXPECT_EQ(c.pairs[2].b, 0u);
    EXPECT_EQ(c.unpaired_a, 2u);
    EXPECT_EQ(c.unpaired_b, 1u);
}

TEST(CompareRuns, TellsWhatOnlyOneKept) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene, 4);
    const RunFile a = fileOf(run, scene, "a.json");
    for (size_t i = 1; i < 4; ++i) run.frames[i].visible = {3, 5};
    const RunComparison c = compareRuns(a, fileOf(run, scene, "b.json"));
    EXPECT_EQ(c.only_a, 3u);
    EXPECT_EQ(c.only_b, 3u);
    ASSERT_EQ(c.differences.size(), 2u);
    EXPECT_EQ(c.differences[0].id, 3u);
    EXPECT_EQ(c.differences[0].only_b, 3u);
    EXPECT_EQ(c.differences[1].path, "wall");
    EXPECT_EQ(c.differences[1].only_a, 3u);
    EXPECT_TRUE(c.ok);
}

TEST(CompareRuns, TimesAreRatiosOfPairs) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene, 9);
    const RunFile a = fileOf(run, scene, "a.json");
    for (FrameResult& frame : run.frames) frame.query_microseconds *= 2;
    const RunFile b = fileOf(run, scene, "b.json");
    const RunComparison slower = compareRuns(a, b), faster = compareRuns(b, a);
    EXPECT_EQ(slower.ratio, 2);
    EXPECT_EQ(slower.ratio_high, 2);
    EXPECT_TRUE(says(slower, "slower"));
    EXPECT_EQ(faster.ratio, 0.5);
    EXPECT_TRUE(says(faster, "faster"));
    EXPECT_TRUE(slower.ok);
    EXPECT_FALSE(compareRuns(a, b, 1.9).ok);
    EXPECT_TRUE(compareRuns(a, b, 2.1).ok);
}

TEST(CompareRuns, FailsForFalseCullsThatAreNew) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene, 3);
    const auto wrong = [](FrameResult& frame) {
        frame.verification->false_culls = 1;
        frame.verification->rows.push_back({1, 3, 1.5, 2.5, "rays"});
    };
    const RunFile sound = fileOf(run, scene, "a.json");
    wrong(run.frames[1]);
    const RunFile one = fileOf(run, scene, "b.json");
    wrong(run.frames[2]);
    const RunFile two = fileOf(run, scene, "c.json");
    EXPECT_EQ(compareRuns(sound, one).new_false, 1u);
    EXPECT_FALSE(compareRuns(sound, one).ok);
    EXPECT_TRUE(compareRuns(one, one).ok);
    EXPECT_TRUE(compareRuns(one, sound).ok);
    EXPECT_EQ(compareRuns(one, two).new_false, 1u);
}

TEST(CompareRuns, FollowsPathsWhereKeysHaveMoved) {
    Scene scene = madeScene();
    scene.objects[3].name = "beside";
    const RunFile a = fileOf(madeRun(scene, 3), scene, "a.json");
    for (SceneObject& object : scene.objects) object.key = object.key == 7 ? 5 : object.key == 5 ? 8 : 2;
    const RunComparison c = compareRuns(a, fileOf(madeRun(scene, 3), scene, "b.json"));
    EXPECT_TRUE(c.by_path);
    EXPECT_EQ(c.only_a + c.only_b, 0u) << c.differences.size();
}

TEST(CompareRuns, NothingInCommonIsSaid) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene, 2);
    const RunFile a = fileOf(run, scene, "a.json");
    for (FrameResult& frame : run.frames) frame.camera.eye.y += 3;
    const RunFile b = fileOf(run, scene, "b.json");
    const RunComparison c = compareRuns(a, b, 0.5);
    EXPECT_TRUE(c.pairs.empty());
    EXPECT_TRUE(says(c, "nothing to compare"));
    EXPECT_FALSE(comparePage(c, a, b).empty());
}

TEST(CompareRuns, JsonAndPageHoldTheNumbers) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene, 3);
    const RunFile a = fileOf(run, scene, "a<b>.json");
    run.frames[1].visible = {3, 5};
    const RunFile b = fileOf(run, scene, "b.json");
    const RunComparison c = compareRuns(a, b);
    const json out = json::parse(compareJson(c, a, b));
    EXPECT_EQ(out["schema"], "sightline.compare/1");
    EXPECT_EQ(out["paired"], 3);
    EXPECT_EQ(out["kept"]["only_a"], 1);
    EXPECT_EQ(out["frames"][1]["only_b"], 1);
    EXPECT_EQ(out["objects"][0]["frames_only_b"], 1);
    EXPECT_EQ(out["time"]["ratio"], 1.0);
    EXPECT_TRUE(json::parse(compareJson(c, a, b, 0))["objects"].empty());
    const std::string page = comparePage(c, a, b);
    EXPECT_EQ(page.find("a<b>"), std::string::npos);
    const json data = dataOf(page);
    EXPECT_EQ(data["page"], "compare");
    EXPECT_EQ(data["compare"], out);
    EXPECT_EQ(data["different"], 2);
    EXPECT_EQ(data["runs"][1]["frames"][1]["kept"], 2);
}

}  // namespace
}  // namespace sightline
