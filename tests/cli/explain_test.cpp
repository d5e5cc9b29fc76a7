// The verb explain as a user sees it: sentences, lists, pictures, the schema, and what it refuses.
// SPDX-License-Identifier: MIT
#include "tests/cli/tool.h"

namespace sightline {
namespace {

class ExplainVerb : public Tool {
protected:
    json answersOf(const std::string& arguments) const {
        const json all = answer("explain " + arguments + "");
        EXPECT_EQ(all["schema"], "sightline.explain/1");
        return all["answers"];
    }

    void expectNarrow(const std::string& text) const {
        std::stringstream lines(text);
        for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
    }
};

TEST_F(ExplainVerb, TellsWhatStandsBeforeWhat) {
    const Outcome hidden = succeed("explain made:walls --object 'red wall'");
    EXPECT_NE(hidden.out.find("culled by occlusion: object 0 'red wall' lies behind 'grey wall'"), std::string::npos)
        << hidden.out;
    expectNarrow(hidden.out);
    const Outcome kept = run("explain made:walls --object 7");
    EXPECT_NE(kept.out.find("kept: object 7 'grey wall'"), std::string::npos) << kept.out;
    EXPECT_NE(kept.out.find("is seen: "), std::string::npos) << kept.out;
    expectNarrow(kept.out);
    EXPECT_EQ(run("explain made:walls --object 'RED w'").out, hidden.out) << "a part that is its own names it, too";
    EXPECT_EQ(run("explain made:walls --object 0").out, hidden.out);
}

TEST_F(ExplainVerb, SaysWhoseFrameItIs) {
    for (const auto& [words, said] : std::initializer_list<std::pair<std::string, std::string>>{
             {"made:walls --object 7", "the only frame of the scene's own cameras: the eye at ("},
             {"made:walls --at 640,360", "the only frame of the scene's own cameras: the eye at ("},
             {"city:1:50 --frames 3 --frame 1 --object 7",
              "frame 1 (0 to 2) of a walk along the streets: the eye at ("},
             {"city:1:50 --frame 15 --object 7", "frame 15 (0 to 15) of a tour: the eye at ("},
             {"city:1:50 --path orbit --object 7", "frame 0 (0 to 15) of --path orbit: the eye at ("}}) {
        const Outcome outcome = succeed("explain --rays 1000 " + words);
        EXPECT_TRUE(outcome.out.starts_with(said)) << outcome.out;
        expectNarrow(outcome.out);
    }
    write("one.json", R"({"frames": [{"eye": [0, 1.5, 0], "target": [0, 1.5, -4]}]})");
    const std::string said = succeed("explain city:1:50 --cameras one.json --rays 1000 --object 7").out;
    EXPECT_TRUE(said.starts_with("the only frame of one.json: the eye at (0, 1.5, 0), looking along (")) << said;
    EXPECT_NE(said.find("0, -1)"), std::string::npos) << said;
}

TEST_F(ExplainVerb, LetsWitnessesLookForWhatIsCulled) {
    const json culled = answersOf("made:walls --object 3 --rays 1000")[0];
    EXPECT_EQ(culled["witness"]["seen"], false);
    EXPECT_GE(culled["witness"]["rays"], 1000);
    EXPECT_EQ(culled["witness"]["proved_hidden"], true);
    EXPECT_EQ(culled["witness"]["by_named"], true) << "the wall that is named hides it alone";
    EXPECT_GE(culled["witness"]["hiders"].size(), 1u);
    EXPECT_FALSE(answersOf("made:walls --object 3 --rays 1000 --no-proofs")[0]["witness"].contains("proved_hidden"));
    EXPECT_NE(run("explain made:walls --object 3").out.find("rays meets it, and no sample"), std::string::npos);
    // What may be visible and was left out as asked is not called false.
    const json left_out = answersOf("made:walls --object 7 --distance 0.001 --rays 1000")[0];
    EXPECT_EQ(left_out["verdict"], "too far");
    EXPECT_FALSE(left_out.contains("witness"));
}

TEST_F(ExplainVerb, WritesTheSchema) {
    const json answers = answersOf("made:walls --object 3");
    ASSERT_EQ(answers.size(), 1u);
    const json& answer = answers[0];
    EXPECT_EQ(answer["key"], 3);
    EXPECT_EQ(answer["frame"], 0);
    EXPECT_EQ(answer["name"], "green wall");
    EXPECT_EQ(answer["verdict"], "occluded");
    EXPECT_EQ(answer["stage"], "occlusion");
    ASSERT_EQ(answer["occlusion"]["occluders"].size(), 1u);
    EXPECT_EQ(answer["occlusion"]["occluders"][0]["key"], 7);
    EXPECT_EQ(answer["occlusion"]["occluders"][0]["share"], 1.0);
    EXPECT_EQ(answer["occlusion"]["sufficient"], true);
    EXPECT_EQ(answer["occlusion"]["without"], "occluded") << "six walls more stand before it";
    EXPECT_EQ(answer["occlusion"]["others"][0]["name"], "cyan wall");
    const json kept = answersOf("made:walls --object 7")[0];
    EXPECT_EQ(kept["verdict"], "visible");
    EXPECT_TRUE(kept["stage"].is_null());
    EXPECT_EQ(kept["kept"]["because"], "open pixel");
    EXPECT_EQ(kept["witness"]["seen"], true);
    const json city = answersOf("city:1:300 --frames 3 --object 7 --frame all");
    EXPECT_EQ(city.size(), 3u);
    for (size_t i = 0; i < city.size(); ++i) EXPECT_EQ(city[i]["frame"], i);
}

TEST_F(ExplainVerb, SaysWhatCullSays) {
    const Outcome culled = run("cull city:1:400 --frames 2 --json -");
    const json visible = json::parse(culled.out)["frames"][1]["visible"];
    for (int key = 0; key < 400; key += 23) {
        const json answer =
            answersOf("city:1:400 --frames 2 --frame 1 --rays 1000 --no-proofs --object " + std::to_string(key))[0];
        const bool kept = std::find(visible.begin(), visible.end(), json(key)) != visible.end();
        EXPECT_EQ(answer["verdict"] == "visible", kept) << key;
    }
}

TEST_F(ExplainVerb, AnswersForEachOfTwoEyes) {
    const json both = answersOf("made:walls --object 3 --stereo 0.06");
    ASSERT_EQ(both.size(), 2u);
    EXPECT_EQ(both[0]["eye"], "left");
    EXPECT_EQ(both[1]["eye"], "right");
    const Outcome text = run("explain made:walls --object 3 --stereo 0.06");
    EXPECT_NE(text.out.find("left eye: "), std::string::npos) << text.out;
    EXPECT_NE(text.out.find("right eye: "), std::string::npos) << text.out;
    expectNarrow(text.out);
    // So far apart that each sees past the walls what the other does not.
    const Outcome culled = run("cull city:1:400 --frames 2 --stereo 8 --json -");
    const json frame = json::parse(culled.out)["frames"][1];
    for (size_t i = 0; i < frame["visible"].size(); i += 14) {
        const json answers = answersOf("city:1:400 --frames 2 --frame 1 --rays 1000 --no-proofs --stereo 8 --object " +
                                       std::to_string(frame["visible"][i].get<int>()));
        const int eyes = frame["eyes"][i];
        EXPECT_EQ(answers[0]["verdict"] == "visible", (eyes & 1) != 0) << frame["visible"][i];
        EXPECT_EQ(answers[1]["verdict"] == "visible", (eyes & 2) != 0) << frame["visible"][i];
    }
    EXPECT_EQ(answersOf("city:1:50 --frames 3 --object 7 --frame all --stereo 2").size(), 6u);
}

TEST_F(ExplainVerb, LooksThroughAPixel) {
    const json answers = answersOf("made:walls --at 640,360");
    ASSERT_EQ(answers.size(), 8u);
    for (size_t i = 0; i < answers.size(); ++i) EXPECT_EQ(answers[i]["key"], 7 - i) << "front to back";
    const Outcome outcome = run("explain made:walls --at 640,360");
    EXPECT_NE(outcome.out.find("behind it, at pixel (640, 360):"), std::string::npos) << outcome.out;
    expectNarrow(outcome.out);
    EXPECT_NE(run("explain made:eye --at 0,0").out.find("pixel (0, 0)"), std::string::npos);
}

// A window pane before a room: the reference renderer draws no blended surface, and yet it is there.
TEST_F(ExplainVerb, TellsWhatShinesThroughAtAPixel) {
    const std::string house = SIGHTLINE_SHARED_DIR "/scenes/bsi-duplex.glb";
    if (!std::filesystem::exists(house)) GTEST_SKIP() << "the shared scenes are not there: " << house;
    const std::string words = "explain '" + house + "' --frames 12 --frame 4 --rays 20000 --at 640,360 ";
    const json answers = answer(words)["answers"];
    ASSERT_FALSE(answers.empty());
    EXPECT_EQ(answers[0]["key"], 281) << "a pane of glass";
    EXPECT_EQ(answers[0]["verdict"], "visible");
    const Outcome told = succeed(words + "-o pane.png");
    EXPECT_NE(told.out.find("what is in front shines through"), std::string::npos) << told.out;
    EXPECT_TRUE(std::filesystem::exists(path("pane.png")));
    const Outcome sky = succeed("explain made:cycle --at 0,0 -o none.png");
    EXPECT_NE(sky.out.find("pixel (0, 0): nothing, so that no picture is written"), std::string::npos) << sky.out;
}

TEST_F(ExplainVerb, TellsOfAWholePath) {
    const Outcome outcome = succeed("explain city:1:1000 --frames 4 --top 3 --json path.json");
    expectNarrow(outcome.out);
    for (const char* part : {"Who hides most", "Which pay best", "hid nothing", "Never kept", "together"})
        EXPECT_NE(outcome.out.find(part), std::string::npos) << part;
    const json path = json::parse(read(this->path("path.json")));
    EXPECT_EQ(path["schema"], "sightline.explain/1");
    double hidden = 0;
    for (const json& row : path["occluders"]) hidden += row["hidden"].get<double>();
    const json run_json = json::parse(run("cull city:1:1000 --frames 4 --json -").out);
    double culled = 0;
    for (const json& frame : run_json["frames"]) culled += frame["stages"][1]["culled"].get<double>();
    EXPECT_NEAR(hidden, culled, 1e-3) << "credits add up to what was culled";
    for (const json& row : path["never_kept"])
        for (const json& frame : run_json["frames"])
            EXPECT_EQ(std::find(frame["visible"].begin(), frame["visible"].end(), row["key"]), frame["visible"].end());
    EXPECT_EQ(run("explain city:1:1000 --frames 4 --top 3 --threads 3").out, outcome.out);
    const std::string first = std::to_string(path["never_kept"][0]["key"].get<uint64_t>());
    EXPECT_NE(outcome.out.find(" triangles  " + std::string(6 - first.size(), ' ') + first), std::string::npos)
        << "rows have keys\n"
        << outcome.out;
    const std::string named = succeed("explain building:1:1 --frames 2 --top 3").out;
    expectNarrow(named);
    EXPECT_NE(named.find(" 'Floor 0/"), std::string::npos) << named;
}

TEST_F(ExplainVerb, DrawsTheFrame) {
    const Outcome outcome = succeed("explain made:walls --object 'blue wall' --size 320x180 -o why.png");
    EXPECT_EQ(read(path("why.png")).substr(1, 3), "PNG");
    expectError("explain made:walls --object 1 -o /nowhere/why.png", 4, "/nowhere/why.png");
}

TEST_F(ExplainVerb, DrawsTheShadowsOfWhoHides) {
    const Outcome outcome = succeed(
        "explain made:walls --object 'blue wall' --size 320x180 --rays 1000 --outside side.png --json why.json");
    EXPECT_EQ(read(path("side.png")).substr(1, 3), "PNG");
    const json shadows = json::parse(read(path("why.json")))["answers"][0]["shadows"];
    ASSERT_EQ(shadows.size(), 1u);
    EXPECT_GT(shadows[0]["key"], 1) << "a wall before it";
    EXPECT_EQ(shadows[0]["outline"].size(), 4u);
    const Outcome kept = succeed("explain made:walls --object 7 --rays 1000 --outside none.png");
    EXPECT_NE(kept.out.find("none.png: not written: occlusion did not cull the object"), std::string::npos) << kept.out;
    EXPECT_FALSE(std::filesystem::exists(path("none.png")));
    expectError("explain made:walls --object 1 --frame all --outside a.png", 2, "--outside");
    expectError("explain made:walls --object 1 -o a.png --outside a.png", 2, "--outside");
    expectError("explain made:walls --object 1 --outside /nowhere/why.png", 4, "/nowhere/why.png");
    expectError("explain made:walls --object 1 --outside -", 2, "--outside -: a picture needs a file");
    expectError("explain made:walls --remember", 2, "--remember needs an --object or a pixel");
}

// What a query that remembers answers, and by which certificates.
TEST_F(ExplainVerb, SaysWhatARememberingQuerySays) {
    const std::string walk = "building:1:1 --path walk --frames 40 --remember ";
    const json run_json = answer("cull " + walk);
    const json& frames = run_json["frames"];
    size_t certificates = 0, kept_all_the_same = 0;
    for (int key = 5; key < 220; key += 40) {
        const json answers = answersOf(walk + "--frame all --object " + std::to_string(key));
        ASSERT_EQ(answers.size(), frames.size());
        for (size_t i = 0; i < answers.size(); ++i) {
            const json& visible = frames[i]["visible"];
            const bool kept = std::find(visible.begin(), visible.end(), json(key)) != visible.end();
            EXPECT_EQ(answers[i]["verdict"] == "visible" || answers[i].contains("kept_all_the_same"), kept)
                << "object " << key << " frame " << i;
            certificates += answers[i].contains("certificate");
            kept_all_the_same += answers[i].contains("kept_all_the_same");
            if (!answers[i].contains("certificate") || certificates % 16 != 1) continue;
            const std::string words =
                "explain " + walk + "--rays 1000 --object " + std::to_string(key) + " --frame " + std::to_string(i);
            const Outcome told = succeed(words);
            expectNarrow(told.out);
            EXPECT_NE(told.out.find("certificate"), std::string::npos) << told.out;
            EXPECT_GE(answer(words)["answers"][0]["shadows"].size(), 1u) << words;
        }
    }
    EXPECT_GT(certificates, 10u);
    RecordProperty("kept_all_the_same", static_cast<int>(kept_all_the_same));
    expectError("explain " + walk + "--object 5 --stereo 0.06", 2, "--remember: not for two eyes");
}

TEST_F(ExplainVerb, RefusesWhatItCannotAnswer) {
    expectError("explain made:walls --object wall", 2, "8 objects are called so: 0 'red wall', 1 'blue wall'");
    expectError("explain made:walls --object door", 2, "--object door");
    expectError("explain made:walls --object ''", 2, "--object");
    expectError("explain made:walls --object 99", 2, "99");
    expectError("explain made:walls --object 1 --frame 7", 2, "--frame 7: the path has 1 frame, from 0");
    expectError("explain city:1:50 --frames 3 --object 1 --frame 7", 2, "--frame 7: the path has 3 frames, from 0");
    expectError("explain made:walls --object 1 --frame soon", 2, "soon");
    expectError("explain made:walls --frame 0", 2, "--frame");
    expectError("explain made:walls --at 5", 2, "--at 5");
    expectError("explain made:walls --at 5,720", 2, "--at 5,720");
    expectError("explain made:walls --at 5,5 --object 1", 2, "--at");
    expectError("explain made:walls --at 5,5 --frame all", 2, "--at");
    expectError("explain made:walls -o a.png", 2, "-o");
    expectError("explain made:walls --object 1 --frame all -o a.png", 2, "-o");
    expectError("explain made:walls --top 0", 2, "--top");
}

// What was left out as asked may be seen: that is no false cull.
TEST_F(ExplainVerb, CallsNothingFalseThatWasLeftOutAsAsked) {
    const Outcome late = succeed(
        "explain building:1:1 --path walk --frames 1 --budget 0.01 --hard-budget --cost-object 1000 "
        "--rays 1000 --object 771");
    EXPECT_NE(late.out.find("culled by lod: the budget has no time"), std::string::npos) << late.out;
    EXPECT_EQ(late.out.find("false cull"), std::string::npos) << late.out;
    succeed("bake building:1:1 -o house.vis");
    const Outcome deep = succeed(
        "explain building:1:1 --path walk --frames 1 --visibility house.vis --portal-depth 1 "
        "--rays 20000 --object 386");
    EXPECT_NE(deep.out.find("culled by portals"), std::string::npos) << deep.out;
    EXPECT_EQ(deep.out.find("false cull"), std::string::npos) << deep.out;
}

TEST_F(ExplainVerb, NamesDoubts) {
    const json off = answersOf("made:walls --object 0 --skip occlusion --rays 1000")[0];
    EXPECT_EQ(off["kept"]["because"], "stage off");
    EXPECT_EQ(off["kept"]["stage"], "occlusion");
    EXPECT_EQ(off["witness"]["seen"], false);
    EXPECT_EQ(off["witness"]["proved_hidden"], true);
}

TEST_F(ExplainVerb, ReportsTellOfTheirSlowestAndLoosestFrames) {
    const Outcome outcome = succeed("cull city:1:2000 --frames 3 --verify --rays 20000 --size 320x180 --report out");
    const std::string page = read(path("out/index.html"));
    EXPECT_NE(page.find("Slowest: "), std::string::npos);
    EXPECT_NE(page.find("Loosest: "), std::string::npos);
}

}  // namespace
}  // namespace sightline
