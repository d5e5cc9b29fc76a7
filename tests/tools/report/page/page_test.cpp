// The page of a cull holds its run, its pictures and its objects, and survives odd names.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/page/cull_page.h"

#include <set>

#include <gtest/gtest.h>

#include "sightline/tools/report/page/page.h"
#include "sightline/tools/report/page/page_table.h"
#include "sightline/tools/report/pictures/film.h"
#include "tests/tools/report/page/page_data.h"
#include "tests/tools/report/run/made_run.h"

namespace sightline {
using namespace tools;
namespace {

bool contains(const std::string& text, const std::string& word) { return text.find(word) != std::string::npos; }

TEST(Page, IsOneFileWithItsStyleAndScripts) {
    const std::string page = pageWith("{}");
    EXPECT_EQ(page.find("<!DOCTYPE html>"), 0u);
    for (const char* word :
         {"src=\"http", "src=\"/", "@import", "<link", "<!--style-->", "<!--scripts-->", "<!--data-->"})
        EXPECT_FALSE(contains(page, word)) << word;
    for (const char* word : {"prefers-color-scheme: dark", "function cullPage()", "frameToOpen"})
        EXPECT_TRUE(contains(page, word)) << word;
    EXPECT_EQ(page.substr(page.size() - 8), "</html>\n");
}

TEST(Page, NoNameEndsTheScriptThatHoldsIt) {
    // <!--<script> makes the browser pass over the next </script>: the page would end within its data.
    for (const char* name : {"</script><script>alert(1)</script>", "<!--<script>", "<b>&amp;\"'\\"}) {
        const nlohmann::json data = {{"name", name}};
        const std::string page = pageWith(data.dump());
        EXPECT_EQ(dataOf(page), data);
        EXPECT_EQ(page.find(name), std::string::npos);
    }
}

TEST(Page, HoldsTheRunWithoutItsSets) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene, 3);
    run.frames[1].notes = {"a note"};
    const auto data = dataOf(reportPage(scene, run));
    EXPECT_EQ(data["page"], "cull");
    EXPECT_EQ(data["run"]["schema"], "sightline.cull/1");
    EXPECT_EQ(data["run"]["scene"]["file"], "a <made> \"scene\".glb");
    EXPECT_EQ(data["run"]["verification"]["culled"], 3);
    ASSERT_EQ(data["run"]["frames"].size(), 3u);
    const auto& frame = data["run"]["frames"][1];
    EXPECT_EQ(frame["kept"], 2);
    EXPECT_FALSE(frame.contains("visible"));
    EXPECT_EQ(frame["notes"][0], "a note");
    EXPECT_EQ(frame["verification"]["exactly_visible"], 2);
    EXPECT_EQ(frame["stages"][1]["culled"], 1);
}

TEST(Page, HoldsItsPictures) {
    const Scene scene = madeScene();
    const auto film = dataOf(reportPage(scene, madeRun(scene, 3)))["film"];
    ASSERT_EQ(film["shots"].size(), 3u);
    for (const char* id : {"shaded", "objects", "culled", "heat-all", "heat-kept", "plan", "section"})
        EXPECT_EQ(film["shots"][0]["images"][id].get<std::string>().substr(0, 11), "data:image/") << id;
    EXPECT_FALSE(film["shots"][0]["images"].contains("buffer"));
    EXPECT_GT(film["shots"][0]["variety"], 1);
}

TEST(Page, TellsABlankWallFromAPictureThatManyObjectsShare) {
    Image<Rgb> wall(16, 16, Rgb(120)), shared(16, 16);
    wall.at(3, 3) = Rgb(125);  // light, and no other object
    for (uint32_t i = 0; i < 256; ++i) shared.pixels[i] = Rgb(static_cast<uint8_t>(i / 64 * 60), 0, 0);
    EXPECT_EQ(varietyOf(wall), 1);
    EXPECT_NEAR(varietyOf(shared), 4, 1e-9);
}

TEST(Page, ShowsTheOcclusionBufferWhereItIsDrawn) {
    const Scene scene = madeScene();
    PageSettings settings;
    settings.buffer = [](size_t frame) { return Image<Rgb>(8, 8, Rgb(static_cast<uint8_t>(frame))); };
    std::set<std::string> saved;
    settings.save = [&](const std::string& name, const std::string&) { saved.insert(name); };
    const auto data = dataOf(reportPage(scene, madeRun(scene, 2), settings));
    EXPECT_EQ(data["film"]["shots"][1]["images"]["buffer"].get<std::string>().substr(0, 11), "data:image/");
    EXPECT_EQ(saved.count("frames/buffer-0001.png"), 1u);
}

TEST(Page, ListsObjectsWithTheirStageInEachFrame) {
    const Scene scene = madeScene();
    const auto table = dataOf(reportPage(scene, madeRun(scene)))["table"];
    ASSERT_EQ(table["rows"].size(), 3u);
    EXPECT_EQ(table["rows"][0][0], 5);  // kept as often as 7, and with more triangles
    EXPECT_EQ(table["rows"][1][1], "wall");
    EXPECT_EQ(table["rows"][2][4], 0);
    EXPECT_EQ(table["stages"][0], "007");
}

TEST(Page, TableKeepsItsBounds) {
    const Scene scene = madeScene();
    const NamedObjects few = objectTable(scene, madeRun(scene), 2);
    EXPECT_EQ(few.rows.size(), 2u);
    EXPECT_EQ(few.left_out, 1u);
    EXPECT_EQ(objectTable(scene, madeRun(scene, 10), 5000, 20).rows.size(), 2u);
    const NamedObjects read = objectTable({{5, "a", "p/a"}, {7, "b", "b"}, {9, "c", "c"}}, madeRun(scene));
    EXPECT_EQ(read.rows[2].key, 9u);
    EXPECT_EQ(read.stages[0], "001");
}

TEST(Page, TellsOfInterruption) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene);
    EXPECT_FALSE(dataOf(reportPage(scene, run))["run"].contains("interrupted"));
    run.interrupted = true;
    run.frames_wanted = 64;
    EXPECT_EQ(dataOf(reportPage(scene, run))["run"]["frames_wanted"], 64);
}

TEST(Page, NamesWhatTheLoosestFrameKeptUnseen) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene, 5);
    run.frames[1].verification->exactly_visible = 1;
    run.frames[1].verification->kept_unseen = {3};
    const auto loosest = dataOf(reportPage(scene, run))["loosest"];
    EXPECT_EQ(loosest["frame"], 1);
    EXPECT_EQ(loosest["unseen"], 1);
    EXPECT_EQ(loosest["names"][0], "in view");
    for (FrameResult& frame : run.frames) frame.verification.reset();
    EXPECT_TRUE(dataOf(reportPage(scene, run))["loosest"].is_null());
}

TEST(Page, TellsWhatThePathTells) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene, 2);
    run.frames[0].credits = {{0, 12, 1.5, 30}, {3, 2, 0, 0}};
    const auto data = dataOf(reportPage(scene, run));
    EXPECT_EQ(data["occluders"]["count"], 2);
    EXPECT_EQ(data["occluders"]["most"][0]["name"], "wall");
    EXPECT_EQ(data["occluders"]["paying"][0]["worth"], 2.5);
    EXPECT_EQ(data["occluders"]["idle_triangles"], 2);
    EXPECT_EQ(data["never"]["count"], 2);
    EXPECT_EQ(data["together"]["count"], 0);
}

TEST(Page, GivesItsPicturesAway) {
    const Scene scene = madeScene();
    std::set<std::string> names;
    PageSettings settings;
    settings.save = [&](const std::string& name, const std::string& bytes) {
        EXPECT_EQ(bytes.substr(1, 3), "PNG") << name;
        names.insert(name);
    };
    (void)reportPage(scene, madeRun(scene, 2), settings);
    for (const char* what : {"frame", "culled", "plan", "section", "heat-all", "heat-kept"})
        EXPECT_TRUE(names.count("frames/" + std::string(what) + "-0001.png")) << what;
    EXPECT_EQ(names.size(), 12u);
}

TEST(Page, PicturesAreSpreadAndHoldTheWrongFrames) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene, 64);
    const std::vector<size_t> sound = pictureFrames(run, 16);
    EXPECT_EQ(sound.size(), 16u);
    EXPECT_EQ(sound.front(), 0u);
    EXPECT_EQ(sound.back(), 63u);
    run.frames[37].verification->false_culls = 1;
    const std::vector<size_t> wrong = pictureFrames(run, 4);
    EXPECT_TRUE(std::find(wrong.begin(), wrong.end(), 37u) != wrong.end());
    EXPECT_LE(wrong.size(), 4u);
    EXPECT_EQ(pictureFrames(madeRun(scene, 1), 16), std::vector<size_t>{0});
    EXPECT_TRUE(pictureFrames(madeRun(scene, 0), 16).empty());
}

TEST(Page, IsTheSameForAnyOrderOfWork) {
    const Scene scene = madeScene();
    const CullRun run = madeRun(scene, 3);
    PageSettings backwards;
    backwards.for_each = [](size_t count, const std::function<void(size_t)>& work) {
        for (size_t i = count; i-- > 0;) work(i);
    };
    EXPECT_EQ(reportPage(scene, run), reportPage(scene, run, backwards));
}

}  // namespace
}  // namespace sightline
