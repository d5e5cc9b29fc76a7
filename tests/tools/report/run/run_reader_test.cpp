// What cull's JSON holds reads back; what it should not hold is told by its place.
// SPDX-License-Identifier: MIT
#include "sightline/geom/setting_rows.h"
#include "sightline/tools/report/run/run_reader.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sightline/tools/report/page/cull_page.h"
#include "sightline/tools/report/pictures/film.h"
#include "sightline/tools/report/run/compare_runs.h"
#include "tests/tools/report/page/page_data.h"
#include "tests/tools/report/run/made_run.h"

namespace sightline {
using namespace tools;
namespace {

using nlohmann::json;

TEST(RunReader, ReadsBackWhatWasWritten) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene, 3);
    run.interrupted = true;
    run.frames_wanted = 9;
    run.settings.occlusion_size = 96;
    run.frames[1].stats.nodes_visited = 77;
    run.frames[1].thread = 3;
    run.frames[1].frustum_alone = {2, 6};
    run.scene_hash = "00c0ffee00c0ffee";
    run.frames[1].certificates = {{{}, {1}}, {{0}, {1}}};
    run.frames[2].verification->kept_unseen = {0};
    run.frames[2].verification->rows.push_back({1, 3, 1.5, 2.5, "rays"});
    run.frames[2].verification->false_culls = 1;
    run.stereo = 0.065;
    run.settings.hysteresis = 0.25;
    for (FrameResult& frame : run.frames) frame.eyes.assign(frame.visible.size(), 2);
    run.frames[0].camera.view = lookAt({1, 2, 3}, {4, 5, -6}, {0, 1, 0});
    run.frames[0].camera.projection = perspective(1.0, 1.5, 0.1);
    const Result<RunFile> read = parseRun(cullJson(run, scene), "run.json");
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read->run.scene, run.scene);
    EXPECT_EQ(read->run.objects, run.objects);
    EXPECT_EQ(read->run.frames_wanted, 9u);
    EXPECT_EQ(read->run.settings.occlusion_size, 96u);
    EXPECT_TRUE(read->run.interrupted);
    ASSERT_EQ(read->run.frames.size(), 3u);
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(read->run.frames[i].visible, run.frames[i].visible);
        for (int stage = 0; stage < kStageCount; ++stage)
            EXPECT_EQ(read->run.frames[i].stages[stage].culled, run.frames[i].stages[stage].culled);
        EXPECT_EQ(read->run.frames[i].query_microseconds, run.frames[i].query_microseconds);
        EXPECT_EQ(read->run.frames[i].verification->exactly_visible, 2u);
    }
    EXPECT_EQ(read->run.scene_hash, run.scene_hash);
    EXPECT_TRUE(read->run.frames[0].certificates.empty());
    ASSERT_EQ(read->run.frames[1].certificates.size(), 2u);
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(read->run.frames[1].certificates[i].hiders, run.frames[1].certificates[i].hiders);
        EXPECT_EQ(read->run.frames[1].certificates[i].hidden, run.frames[1].certificates[i].hidden);
    }
    EXPECT_FALSE(read->run.frames[0].frustum_alone);
    ASSERT_TRUE(read->run.frames[1].frustum_alone);
    EXPECT_EQ(read->run.frames[1].frustum_alone->objects, 2u);
    EXPECT_EQ(read->run.frames[1].frustum_alone->triangles, 6u);
    EXPECT_EQ(read->run.stereo, 0.065);
    EXPECT_EQ(read->run.settings.hysteresis, 0.25);
    EXPECT_EQ(read->run.frames[1].eyes, run.frames[1].eyes);
    EXPECT_EQ(read->run.frames[0].camera.view, run.frames[0].camera.view);
    EXPECT_EQ(read->run.frames[1].stats.nodes_visited, 77u);
    EXPECT_EQ(read->run.frames[1].thread, 3u);
    ASSERT_EQ(read->names.size(), 3u);
    EXPECT_EQ(read->labelOf(7), "wall");
    EXPECT_EQ(read->labelOf(12), "object 12");
    EXPECT_EQ(read->names[read->run.frames[2].verification->kept_unseen.at(0)].key, 7u);
    EXPECT_EQ(read->names[read->run.frames[2].verification->rows.at(0).object].key, 3u);
    EXPECT_EQ(sumVerification(read->run)->false_culls, 1u);
}

/// Another value than the row's, within its limits.
template <class Value>
void change(const SettingRow<Value>& row, QuerySettings& settings) {
    const double most = std::min(row.most, 64.0), least = row.least;
    Value& value = settings.*row.member;
    value = value == static_cast<Value>(least) ? static_cast<Value>((least + most) / 2) : static_cast<Value>(least);
}
void change(const SettingRow<bool>& row, QuerySettings& settings) { settings.*row.member = !(settings.*row.member); }

TEST(RunReader, ReadsBackEverySetting) {
    const Scene scene = madeScene();
    CullRun changed = madeRun(scene);
    const QuerySettings before = changed.settings;
    forEachSetting([&](const auto& row) { change(row, changed.settings); });
    changed.settings.stages = kAllStages & ~stageBit(Stage::kVolumes);
    const Result<RunFile> read = parseRun(cullJson(changed, scene), "run.json");
    ASSERT_TRUE(read.ok()) << read.error().message;
    forEachSetting([&](const auto& row) {
        EXPECT_NE(changed.settings.*row.member, before.*row.member) << row.name;
        EXPECT_EQ(read->run.settings.*row.member, changed.settings.*row.member) << row.name;
    });
}

TEST(RunReader, ReadsWindowsBesideTheVisibilityFileWhereRunsHadThem) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene);
    run.visibility.file = "house.vis";
    json old = json::parse(cullJson(run, scene));
    old.erase("windows");
    old.erase("portal_depth");
    old["visibility"]["windows"] = "polygons";
    old["visibility"]["portal_depth"] = 3;
    const Result<RunFile> read = parseRun(old.dump(), "old.json");
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read->run.settings.windows, PortalWindows::kPolygons);
    EXPECT_EQ(read->run.settings.portal_depth, 3u);
}

TEST(RunReader, ReadsFilesOfTheFirstRelease) {
    const Scene scene = madeScene();
    json old = json::parse(cullJson(madeRun(scene), scene));
    old.erase("objects");
    old.erase("jitter");
    old["scene"].erase("instances");
    for (json& frame : old["frames"]) {
        for (const char* name : {"nodes_visited", "seam_pixels", "thread", "begin_microseconds", "end_microseconds"})
            frame.erase(name);
        frame["verification"].erase("kept_unseen");
    }
    const Result<RunFile> read = parseRun(old.dump(), "old.json");
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read->names.size(), 2u);
    EXPECT_EQ(read->labelOf(7), "object 7");
}

/// The message for the JSON after a change.
std::string faultOf(const std::function<void(json&)>& change) {
    const Scene scene = madeScene();
    json run = json::parse(cullJson(madeRun(scene), scene));
    change(run);
    const Result<RunFile> read = parseRun(run.dump(), "run.json");
    return read.ok() ? "" : read.error().message;
}

TEST(RunReader, NamesThePlaceOfAFault) {
    EXPECT_EQ(faultOf([](json&) {}), "");
    EXPECT_EQ(faultOf([](json& run) { run["schema"] = "other/1"; }), "run.json: schema: not sightline.cull/1");
    EXPECT_EQ(faultOf([](json& run) { run.erase("frames"); }), "run.json: frames: missing");
    EXPECT_EQ(faultOf([](json& run) { run["frames"][1]["query_microseconds"] = 1e308; }),
              "run.json: frames[1].query_microseconds: too large");
    EXPECT_EQ(faultOf([](json& run) { run["frames"][0]["visible"] = {uint64_t{1} << 63}; }),
              "run.json: frames[0].visible[0]: not between 0 and 9223372036854775807");
    const auto certificate = [](const json& hiders, const json& hidden) {
        return faultOf([&](json& run) {
            run["frames"][1]["certificates"] = {{{"hiders", hiders}, {"hidden", hidden}}};
        });
    };
    EXPECT_EQ(certificate({0, 1}, {1}), "");
    EXPECT_EQ(certificate({1, 1}, {1}), "run.json: frames[1].certificates[0].hiders[1]: objects do not ascend");
    EXPECT_NE(certificate({0}, {1000}).find("frames[1].certificates[0].hidden[0]: not between 0 and "),
              std::string::npos);
    EXPECT_EQ(certificate(nullptr, {1}), "run.json: frames[1].certificates[0].hiders: not an array");
    EXPECT_EQ(parseRun(R"({"a": 1e999})", "run.json").error().message,
              "run.json: not JSON: number overflow parsing '1e999'");
    EXPECT_EQ(parseRun("glTF", "model.glb").error().message,
              "model.glb: is no run: `sightline cull --json FILE` writes one");
    EXPECT_EQ(faultOf([](json& run) { run["frames"][1]["eyes"] = {1, 2, 3, 1, 2, 3, 1, 2, 3}; }),
              "run.json: frames[1].eyes: not one for each that is visible");
    EXPECT_EQ(faultOf([](json& run) { run["hysteresis"] = -1; }), "run.json: hysteresis: negative");
    EXPECT_EQ(faultOf([](json& run) { run["frames"][1]["visible"][0] = -1; }),
              "run.json: frames[1].visible[0]: not a whole number");
    EXPECT_EQ(faultOf([](json& run) {
                  run["frames"][1]["visible"] = {7, 5};
              }),
              "run.json: frames[1].visible[1]: keys do not ascend");
    EXPECT_EQ(faultOf([](json& run) {
                  run["frames"][0]["visible"] = {1, 2, 3, 4};
              }),
              "run.json: frames[0].visible: more than the scene has");
    EXPECT_EQ(faultOf([](json& run) { run["frames"][0]["stages"][1]["name"] = "magic"; }),
              "run.json: frames[0].stages[1].name: there is no such stage");
    EXPECT_EQ(faultOf([](json& run) { run["frames"][0]["stages"][1]["name"] = "frustum"; }),
              "run.json: frames[0].stages[1].name: named twice");
    EXPECT_EQ(faultOf([](json& run) { run["frames"][1]["stages"].erase(0); }),
              "run.json: frames[1].stages: other stages than frame 0");
    EXPECT_EQ(faultOf([](json& run) { run["frames"][0]["query_microseconds"] = -3; }),
              "run.json: frames[0].query_microseconds: negative");
    EXPECT_EQ(faultOf([](json& run) {
                  run["frames"][0]["camera"]["eye"] = {1, 2};
              }),
              "run.json: frames[0].camera.eye: not 3 numbers");
    EXPECT_EQ(faultOf([](json& run) { run["objects"][0]["name"] = 5; }), "run.json: objects[0].name: not a string");
    EXPECT_EQ(faultOf([](json& run) { run["width"] = 0; }), "run.json: width: not between 1 and 1048576");
    EXPECT_EQ(faultOf([](json& run) { run["frames"][0]["verification"]["false_culls"] = 2; }),
              "run.json: frames[0].verification.false_culls: more than are listed");
    for (const char* text : {"", "{", "[1,2", "null", "7", "{\"schema\": \"sightline.cull/1\"}", "[[[[[[[["}) {
        const Result<RunFile> read = parseRun(text, "run.json");
        ASSERT_FALSE(read.ok()) << text;
        EXPECT_EQ(read.error().message.substr(0, 10), "run.json: ") << text;
        EXPECT_EQ(read.error().message.find('\n'), std::string::npos) << text;
    }
}

TEST(RunReader, TakesDeepNestingWithoutAStackOverflow) {
    EXPECT_FALSE(parseRun(std::string(2000000, '['), "deep.json").ok());
}

TEST(RunReader, ReplaysTheCorpusOfTheFuzzer) {
    const std::filesystem::path corpus = std::filesystem::path(SIGHTLINE_FUZZ_CORPUS) / "run";
    size_t files = 0, good = 0;
    for (const auto& entry : std::filesystem::directory_iterator(corpus)) {
        std::stringstream text;
        text << std::ifstream(entry.path(), std::ios::binary).rdbuf();
        const Result<RunFile> read = parseRun(text.str(), "run.json");
        ++files;
        if (!read.ok()) continue;
        ++good;
        EXPECT_FALSE(runPage(read->run, read->names, Film()).empty());
        EXPECT_TRUE(compareRuns(*read, *read).ok);
    }
    EXPECT_GE(files, 6u);
    EXPECT_GE(good, 3u);
}

TEST(RunReader, APageIsMadeOfAFile) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene, 3);
    run.frames[2].verification->kept_unseen = {0};
    run.frames[2].verification->exactly_visible = 1;
    const Result<RunFile> read = parseRun(cullJson(run, scene), "run.json");
    ASSERT_TRUE(read.ok());
    const nlohmann::json data = dataOf(runPage(read->run, read->names, Film()));
    EXPECT_EQ(data["loosest"]["frame"], 2);
    EXPECT_EQ(data["loosest"]["names"][0], "wall");
    EXPECT_EQ(data["whole"], false);
    EXPECT_TRUE(data["film"]["shots"].empty());
}

}  // namespace
}  // namespace sightline
