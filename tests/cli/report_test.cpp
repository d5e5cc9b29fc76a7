// The verb report: shows runs from their files, compares two, and tells bad files in one line.
// SPDX-License-Identifier: MIT
#include "tests/cli/tool.h"

namespace sightline {
namespace {

class Report : public Tool {
protected:
    void cull(const std::string& arguments) const {
        const Outcome outcome = succeed("cull city:1:200 --frames 3 --size 160x90 --repeat 1 " + arguments);
    }
};

TEST_F(Report, LiesBesideItsNumbersPicturesAndTimeline) {
    cull("--report out --trace run.trace.json");
    EXPECT_EQ(json::parse(read(path("out/cull.json")))["schema"], "sightline.cull/1");
    EXPECT_EQ(json::parse(read(path("out/trace.json"))), json::parse(read(path("run.trace.json"))));
    for (const char* what : {"frame", "culled", "outside", "plan", "section", "heat-all", "heat-kept"})
        for (const char* frame : {"0000", "0002"})
            EXPECT_EQ(read(path("out/frames/" + std::string(what) + "-" + frame + ".png")).substr(1, 3), "PNG") << what;
    EXPECT_EQ(read(path("out/frames/overview.png")).substr(1, 3), "PNG");
    write("out/frames/frame-0099.png", "of an earlier run");
    write("out/frames/outside-0099.png", "of an earlier run");
    write("out/frames/mine.txt", "the user's");
    cull("--report out");
    EXPECT_FALSE(std::filesystem::exists(path("out/frames/frame-0099.png")));
    EXPECT_FALSE(std::filesystem::exists(path("out/frames/outside-0099.png")));
    EXPECT_TRUE(std::filesystem::exists(path("out/frames/mine.txt")));
}

TEST_F(Report, TellsWhatTheFrustumAloneWouldLeave) {
    for (const std::string more : {"", "--stereo 0.065 "}) {
        cull(more + "--json all.json");
        cull(more + "--use frustum --json frustum.json");
        const json all = json::parse(read(path("all.json"))), frustum = json::parse(read(path("frustum.json")));
        size_t kept = 0, in_frustum = 0;
        for (size_t i = 0; i < 3; ++i) {
            const json &frame = all["frames"][i], &alone = frustum["frames"][i];
            EXPECT_EQ(frame["frustum_alone"]["objects"], alone["visible"].size()) << more;
            EXPECT_EQ(frame["frustum_alone"]["triangles"], alone["triangles"]) << more;
            kept += frame["visible"].size();
            in_frustum += alone["visible"].size();
        }
        EXPECT_LT(kept, in_frustum) << more << "occlusion culls something";
    }
}

TEST_F(Report, ShowsARunFromItsFileAndFromItsDirectory) {
    cull("--report deep/out --json alone.json");
    EXPECT_NE(read(path("deep/out/index.html")).find("city:1:200"), std::string::npos);
    const Outcome directory = succeed("report deep/out -o again");
    EXPECT_NE(directory.out.find("city:1:200: 200 objects"), std::string::npos) << directory.out;
    const std::string page = read(path("again/index.html"));
    EXPECT_NE(page.find("data:image/png"), std::string::npos);
    EXPECT_NE(page.find("\"overview\":{"), std::string::npos);
    EXPECT_NE(page.find("\"outside\":\"data:image/png"), std::string::npos);
    const Outcome file = succeed("report alone.json -o bare");
    EXPECT_EQ(read(path("bare/index.html")).find("data:image"), std::string::npos);
    EXPECT_EQ(run("report deep/out alone.json").exit_code, 0);
}

TEST_F(Report, ComparesTwoRuns) {
    cull("--json a.json");
    cull("--skip occlusion --report b");
    const Outcome outcome = succeed("report --compare a.json b -o both --json -");
    const json out = json::parse(outcome.out);
    EXPECT_EQ(out["schema"], "sightline.compare/1");
    EXPECT_EQ(out["paired"], 3);
    EXPECT_EQ(out["kept"]["only_a"], 0);
    EXPECT_GT(out["kept"]["only_b"], 0);
    EXPECT_EQ(json::parse(read(path("both/compare.json"))), out);
    EXPECT_NE(read(path("both/index.html")).find("\"page\":\"compare\""), std::string::npos);
    EXPECT_NE(outcome.err.find("B keeps"), std::string::npos);
    EXPECT_NE(run("report --compare a.json a.json").out.find("the same objects"), std::string::npos);
}

TEST_F(Report, FailsIfBIsSlowerOrWrong) {
    cull("--verify --rays 1000 --json a.json");
    json slow = json::parse(read(path("a.json")));
    for (json& frame : slow["frames"]) frame["query_microseconds"] = 1 + 3 * frame["query_microseconds"].get<double>();
    write("slow.json", slow.dump());
    EXPECT_EQ(run("report --compare a.json slow.json").exit_code, 0);
    EXPECT_EQ(run("report --compare a.json slow.json --fail-if-slower 1.5").exit_code, 1);
    EXPECT_EQ(run("report --compare slow.json a.json --fail-if-slower 1.5").exit_code, 0);
    json wrong = json::parse(read(path("a.json")));
    json& verification = wrong["frames"][1]["verification"];
    verification["false_culls"] = 1;
    verification["list"] = json::parse(R"([{"key": 7, "name": "x", "pixel": [1, 2], "witness": "rays"}])");
    write("wrong.json", wrong.dump());
    EXPECT_EQ(run("report --compare a.json wrong.json").exit_code, 1);
    EXPECT_EQ(run("report --compare wrong.json wrong.json").exit_code, 0);
}

TEST_F(Report, TellsBadFilesInOneLine) {
    write("broken.json", "{\"schema\": ");
    write("other.json", "{\"schema\": \"sightline.info/1\"}");
    cull("--json a.json");
    expectError("report missing.json", 3, "missing.json");
    expectError("report broken.json", 3, "broken.json: not JSON");
    expectError("report other.json", 3, "other.json: schema");
    expectError("report .", 3, "cull.json");
    expectError("report --compare a.json", 2, "--compare");
    expectError("report a.json --fail-if-slower 2", 2, "--fail-if-slower");
    expectError("report a.json a.json -o out", 2, "-o");
    expectError("report a.json -o a.json", 4, "a.json");
    expectError("cull city:1:20 --frames 1 --trace /nowhere/t.json", 4, "/nowhere/t.json");
}

}  // namespace
}  // namespace sightline
