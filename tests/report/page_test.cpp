// The page needs no network, tells the verdict, and survives odd names.
// SPDX-License-Identifier: MIT
#include "sightline/report/page.h"

#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sightline/report/page_table.h"
#include "tests/report/made_run.h"

namespace sightline {
namespace {

bool contains(const std::string& text, const std::string& word) { return text.find(word) != std::string::npos; }

TEST(Page, NeedsNoNetwork) {
    const Scene scene = madeScene();
    const std::string page = reportPage(scene, madeRun(scene));
    EXPECT_FALSE(contains(page, "http:"));
    EXPECT_FALSE(contains(page, "https:"));
    EXPECT_FALSE(contains(page, "src=\"/"));
    EXPECT_FALSE(contains(page, "@import"));
    EXPECT_FALSE(contains(page, "<link"));
    EXPECT_TRUE(contains(page, "data:image/png;base64,"));
}

TEST(Page, TellsTheVerdict) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene);
    EXPECT_TRUE(contains(reportPage(scene, run), "0 of 2 culled objects were visible"));
    run.frames[1].verification->false_culls = 1;
    run.frames[1].verification->rows.push_back({1, 3, 1, 2, "rays"});
    EXPECT_TRUE(contains(reportPage(scene, run), "verdict bad"));
    for (FrameResult& frame : run.frames) frame.verification.reset();
    const std::string page = reportPage(scene, run);
    EXPECT_TRUE(contains(page, "Not verified"));
    EXPECT_FALSE(contains(page, "verdict good"));
}

nlohmann::json dataOf(const std::string& page) {
    const std::string open = "<script type=\"application/json\" id=\"data\">";
    const size_t begin = page.find(open) + open.size();
    return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

TEST(Page, HoldsItsDataAsJson) {
    const Scene scene = madeScene();
    const std::string page = reportPage(scene, madeRun(scene, 3));
    const auto data = dataOf(page);
    EXPECT_EQ(data["frames"], 3);
    ASSERT_EQ(data["pictures"].size(), 3u);
    for (const char* id : {"shaded", "objects", "culled", "heat-all", "heat-kept", "plan", "section"}) {
        EXPECT_EQ(data["pictures"][0]["images"][id].get<std::string>().substr(0, 11), "data:image/") << id;
        EXPECT_TRUE(contains(page, "id=\"" + std::string(id) + "\"")) << id;
    }
    EXPECT_FALSE(contains(page, "value=\"buffer\"") || contains(page, "id=\"buffer-text\""));
    EXPECT_EQ(data["frame"]["kept"], nlohmann::json::parse("[2, 2, 2]"));
    EXPECT_EQ(data["frame"]["exact"][1], 2);
    EXPECT_EQ(data["frame"]["stages"][1]["culled"][0], 1);
    for (const char* id : {"at", "at-kept", "at-exact", "tested-0", "culled-1", "time-1", "same", "depth-all", "rows"})
        EXPECT_TRUE(contains(page, "id=\"" + std::string(id) + "\"")) << id;
    for (const auto& [id, series] : data["charts"].items()) {
        EXPECT_TRUE(contains(page, "id=\"" + id + "\"")) << id;
        EXPECT_EQ(series[0]["values"].size(), 3u) << id;
    }
}

TEST(Page, ShowsTheOcclusionBufferWhereItIsDrawn) {
    const Scene scene = madeScene();
    PageSettings settings;
    settings.buffer = [](size_t frame) { return Image<Rgb>(8, 8, Rgb(static_cast<uint8_t>(frame))); };
    std::set<std::string> saved;
    settings.save = [&](const std::string& name, const std::string&) { saved.insert(name); };
    const std::string page = reportPage(scene, madeRun(scene, 2), settings);
    EXPECT_TRUE(contains(page, "value=\"buffer\"") && contains(page, "id=\"buffer\""));
    EXPECT_TRUE(contains(page, "id=\"buffer-text\"") && contains(page, "has at most 640 pixels"));
    const auto data = dataOf(page);
    EXPECT_EQ(data["pictures"][1]["images"]["buffer"].get<std::string>().substr(0, 11), "data:image/");
    EXPECT_EQ(saved.count("frames/buffer-0001.png"), 1u);
}

TEST(Page, ListsObjectsWithTheirStageInEachFrame) {
    const Scene scene = madeScene();
    const auto data = dataOf(reportPage(scene, madeRun(scene)));
    ASSERT_EQ(data["rows"].size(), 3u);
    EXPECT_EQ(data["rows"][0][0], 5);  // kept as often as 7, and with more triangles
    EXPECT_EQ(data["rows"][1][1], "wall");
    EXPECT_EQ(data["rows"][2][4], 0);
    EXPECT_EQ(data["row_stages"][0], "007");
}

TEST(Page, TableKeepsItsBounds) {
    const Scene scene = madeScene();
    const ObjectTable few = objectTable(scene, madeRun(scene), 2);
    EXPECT_EQ(few.rows.size(), 2u);
    EXPECT_EQ(few.left_out, 1u);
    EXPECT_EQ(objectTable(scene, madeRun(scene, 10), 5000, 20).rows.size(), 2u);
    const ObjectTable read = objectTable({{5, "a", "p/a"}, {7, "b", "b"}, {9, "c", "c"}}, madeRun(scene));
    EXPECT_EQ(read.rows[2].key, 9u);
    EXPECT_EQ(read.stages[0], "001");
}

TEST(Page, TellsOfInterruption) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene);
    EXPECT_FALSE(contains(reportPage(scene, run), "interrupted"));
    run.interrupted = true;
    run.frames_wanted = 64;
    EXPECT_TRUE(contains(reportPage(scene, run), "2 of 64 frames"));
}

TEST(Page, ExplainsTheSlowestAndTheLoosestFrame) {
    const Scene scene = madeScene();
    CullRun run = madeRun(scene, 5);
    run.frames[3].query_microseconds = 500;
    run.frames[3].nodes_visited = 40;
    for (size_t i : {0, 1, 2, 4}) run.frames[i].nodes_visited = 10;
    run.frames[1].verification->exactly_visible = 1;
    run.frames[1].verification->kept_unseen = {3};
    const std::string page = reportPage(scene, run);
    EXPECT_TRUE(contains(page, "The slowest: frame 3"));
    EXPECT_TRUE(contains(page, "<td>40</td><td>10</td><td>4×</td>"));
    EXPECT_TRUE(contains(page, "The loosest: frame 1"));
    EXPECT_TRUE(contains(page, "<li>in view</li>"));
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

TEST(Page, EscapesTheScenesName) {
    const Scene scene = madeScene();
    const std::string page = reportPage(scene, madeRun(scene));
    EXPECT_FALSE(contains(page, "<made>"));
    EXPECT_TRUE(contains(page, "a &lt;made&gt; &quot;scene&quot;.glb"));
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
