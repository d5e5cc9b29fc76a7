// The page needs no network, tells the verdict, and survives odd names.
// SPDX-License-Identifier: MIT
#include "sightline/report/page.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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
    EXPECT_TRUE(contains(reportPage(scene, run), "0 of 2 culled objects was visible"));
    run.frames[1].verification->false_culls = 1;
    run.frames[1].verification->rows.push_back({1, 3, 1, 2, "rays"});
    EXPECT_TRUE(contains(reportPage(scene, run), "verdict bad"));
    for (FrameResult& frame : run.frames) frame.verification.reset();
    const std::string page = reportPage(scene, run);
    EXPECT_TRUE(contains(page, "Not verified"));
    EXPECT_FALSE(contains(page, "verdict good"));
}

TEST(Page, HoldsItsDataAsJson) {
    const Scene scene = madeScene();
    const std::string page = reportPage(scene, madeRun(scene, 3));
    const std::string open = "<script type=\"application/json\" id=\"data\">";
    const size_t begin = page.find(open) + open.size();
    const auto data = nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
    EXPECT_EQ(data["frames"], 3);
    ASSERT_EQ(data["pictures"].size(), 3u);
    for (const char* id : {"shaded", "heat-all", "heat-kept", "plan"}) {
        EXPECT_EQ(data["pictures"][0]["images"][id].get<std::string>().substr(0, 22), "data:image/png;base64,") << id;
        EXPECT_TRUE(contains(page, "id=\"" + std::string(id) + "\"")) << id;
    }
    for (const auto& [id, text] : data["pictures"][0]["texts"].items())
        EXPECT_TRUE(contains(page, "id=\"" + id + "\"")) << id;
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
