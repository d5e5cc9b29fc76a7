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
    for (const char* id : {"shaded", "objects", "culled", "outside", "heat-all", "heat-kept", "plan", "section"})
        EXPECT_EQ(film["shots"][0]["images"][id].get<std::string>().substr(0, 11), "data:image/") << id;
    EXPECT_FALSE(film["shots"][0]["images"].contains("buffer"));
    EXPECT_GT(film["shots"][0]["variety"], 1);
}

TEST(Page, HoldsTheWholeSceneAndWhereEachEyeIsInIt) {
    const Scene scene = madeScene();
    PageSettings settings;
    settings.most_pictures = 2;
    const auto film = dataOf(reportPage(scene, madeRun(scene, 5), settings))["film"];
    EXPECT_EQ(film["overview"]["image"].get<std::string>().substr(0, 11), "data:image/");
    ASSERT_EQ(film["overview"]["eyes"].size(), 5u) << "of frames without pictures, too";
    for (const auto& eye : film["overview"]["eyes"]) {
        ASSERT_EQ(eye.size(), 2u);
        for (const auto& part : eye) EXPECT_TRUE(part >= 0.0 && part <= 1.0);
    }
    EXPECT_FALSE(dataOf(reportPage(scene, madeRun(scene, 0)))["film"].contains("overview"));
}

TEST(Page, DrawsWallsCellsAndPortalsOnItsPlans) {
    Scene scene = madeScene();
    const CullRun run = madeRun(scene, 1);
    const auto planOf = [&](const PageSettings& settings) {
        const auto shot = dataOf(reportPage(scene, run, settings))["film"]["shots"][0];
        return std::pair(shot["images"]["plan"].get<std::string>(), shot["plan"].get<std::string>());
    };
    const auto plain = planOf({});
    EXPECT_TRUE(contains(plain.second, "cut at the height of the eye"));
    EXPECT_FALSE(contains(plain.second, "portals"));
    ScenePortal portal;
    portal.polygon = {{-2, -1, -1}, {2, -1, -1}, {2, 1, -1}, {-2, 1, -1}};
    scene.portals = {portal};
    const auto marked = planOf({});
    EXPECT_NE(marked.first, plain.first);
    EXPECT_TRUE(contains(marked.second, "portals"));
    CellSpace space;  // of a visibility file: it counts
    space.graph.cells = 2;
    const glm::dvec3 outline[] = {{-3, -1, 1}, {3, -1, 1}, {3, 1, 1}, {-3, 1, 1}};
    ASSERT_TRUE(space.graph.addPortal(0, 1, outline));
    PageSettings settings;
    settings.cells = &space;
    EXPECT_NE(planOf(settings).first, marked.first);
    scene.portals.clear();
    scene.meshes[0].indices.resize(3);  // half a wall of the same bounds
    scene.meshes[0].primitives[0].triangle_count = 1;
    EXPECT_NE(planOf({}).first, plain.first);
}

TEST(Page, BoundsAndCleansNames) {
    std::string name("a\0b\x1b[2J\n\xe2\x80\xae", 11);
    name += std::string(100000, 'n');
    Scene scene = madeScene();
    scene.objects[0].name = name;
    const auto table = dataOf(reportPage(scene, madeRun(scene)))["table"];
    const auto read = objectTable({{5, name, name}}, madeRun(scene));
    for (const std::string& text : {table["rows"][1][1].get<std::string>(), table["rows"][1][2].get<std::string>(),
                                    read.rows[0].name, read.rows[0].path}) {
        EXPECT_LE(text.size(), kLongestPath);
        EXPECT_GT(text.size(), 1000u);
        for (const char c : text) EXPECT_GE(static_cast<unsigned char>(c), 0x20);
    }
    scene.objects[0].name = std::string("a\0b\x1b[2J\n\xe2\x80\xae", 11);
    EXPECT_EQ(dataOf(reportPage(scene, madeRun(scene)))["table"]["rows"][1][1], "a b [2J  ");
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
    for (const char* what : {"frame", "culled", "outside", "plan", "section", "heat-all", "heat-kept"})
        EXPECT_TRUE(names.count("frames/" + std::string(what) + "-0001.png")) << what;
    EXPECT_EQ(names.count("frames/overview.png"), 1u);
    EXPECT_EQ(names.size(), 15u);
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
