// Advice in ten lines at most: what matters first, and nothing that was not measured.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/advice.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace sightline {
using namespace tools;
using nlohmann::json;
namespace {

Advice advice(Advice::Kind kind, const std::string& what, bool done, double saves, double spread = 0.05) {
    Advice out;
    out.kind = kind;
    out.what = what;
    out.how = "--words " + what;
    out.done = done;
    out.saves = saves;
    out.spread = spread;
    return out;
}

AdviceRun madeAdvice() {
    AdviceRun run;
    run.scene = "s.glb";
    run.width = 320;
    run.height = 180;
    run.frames = 4;
    run.rounds = 5;
    run.frame_milliseconds = 10;
    run.query_microseconds = 200;
    run.bottleneck = findBottleneck([](const StageLoads& loads) {
        return FrameTimes{9e-3 * loads.fill + 1e-3, 9e-3, 0.0};
    });
    run.advice = {advice(Advice::Kind::kStage, "occlusion", true, 15),
                  advice(Advice::Kind::kStage, "frustum", true, 0.02),
                  advice(Advice::Kind::kStage, "portals", true, -2),
                  advice(Advice::Kind::kStage, "volumes", false, -3),
                  advice(Advice::Kind::kBake, "its cells, marked", false, 4),
                  advice(Advice::Kind::kMerge, "100 objects into 9", false, 0.5, 0.4)};
    run.not_tried = {"split: no large mesh"};
    return run;
}

TEST(Advice, MattersByItsSpreadAndByTheFrame) {
    EXPECT_TRUE(matters(advice(Advice::Kind::kBake, "", false, 0.2, 0.09), 10));
    EXPECT_FALSE(matters(advice(Advice::Kind::kBake, "", false, 0.2, 0.11), 10));
    EXPECT_FALSE(matters(advice(Advice::Kind::kBake, "", false, 0.09, 0.001), 10));
    EXPECT_TRUE(matters(advice(Advice::Kind::kBake, "", false, -1, 0.1), 10));
}

TEST(Advice, SaysWhatToDo) {
    const std::string text = adviceText(madeAdvice());
    const char* const lines[] = {"measured: 4 frames at 320x180",
                                 "limited by fill",
                                 "keep occlusion: without it a frame takes 15 ms more, 2.5 times as long",
                                 "bake its cells, marked (--words its cells, marked): saves 4 ms a frame, 40 %",
                                 "leave off volumes: it would cost 3 ms a frame, 30 %",
                                 "turn off portals (--words portals): saves 2 ms a frame, 20 %",
                                 "no difference to speak of: frustum",
                                 "not tried: split: no large mesh"};
    size_t at = 0;
    for (const char* line : lines) {
        const size_t found = text.find(line);
        ASSERT_NE(found, std::string::npos) << line << "\n" << text;
        EXPECT_GE(found, at) << line << "\n" << text;
        at = found;
    }
    EXPECT_NE(text.find("100 objects into 9 (-0.5 +- 0.4 ms)"), std::string::npos) << text;
}

TEST(Advice, TenLinesAreEnough) {
    AdviceRun run = madeAdvice();
    for (int i = 0; i < 20; ++i)
        run.advice.push_back(advice(Advice::Kind::kStage, "stage " + std::to_string(i), i % 2 == 0, i - 10.5));
    const std::string text = adviceText(run);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 10);
    EXPECT_NE(text.find("keep occlusion"), std::string::npos) << "the largest is first";
    EXPECT_NE(text.find("smaller ones:"), std::string::npos) << text;
}

TEST(Advice, JsonHasTheSchema) {
    const json out = json::parse(adviceJson(madeAdvice()));
    EXPECT_EQ(out["schema"], "sightline.advise/1");
    ASSERT_EQ(out["advice"].size(), 6u);
    EXPECT_EQ(out["advice"][0]["advice"], "keep occlusion");
    EXPECT_EQ(out["advice"][0]["matters"], true);
    EXPECT_EQ(out["advice"][0]["in_use"], true);
    EXPECT_EQ(out["advice"][0]["saves_milliseconds"], 15);
    EXPECT_EQ(out["advice"][1]["kind"], "bake");
    EXPECT_EQ(out["advice"][5]["matters"], false);
    EXPECT_EQ(out["not_tried"], json{"split: no large mesh"});
    EXPECT_EQ(out["limits"], "limited by fill");
}

}  // namespace
}  // namespace sightline
