// Baked visibility on the command line: bakes are used, proved and explained, and wrong ones refused.
// SPDX-License-Identifier: MIT
#include "tests/cli/tool.h"

namespace sightline {
namespace {

class Visibility : public CullTool {
protected:
    void bake(const std::string& scene, const std::string& file) const {
        const Outcome outcome = succeed("bake " + scene + " -o " + file);
    }
    static uint64_t keptOf(const json& run) {
        uint64_t kept = 0;
        for (const json& frame : run["frames"]) kept += frame["visible"].size();
        return kept;
    }
};

TEST_F(Visibility, CullsWhatCellsHideAndIsProved) {
    bake("building:2:2", "house.vis");
    const std::string arguments =
        "building:2:2 --path scatter --frames 6 --seed 3 --verify --rays 20000 --skip occlusion";
    const json plain = cull(arguments);
    EXPECT_FALSE(plain.contains("visibility"));
    EXPECT_FALSE(plain["frames"][0].contains("cells"));
    EXPECT_EQ(plain["frames"][0]["stages"][0]["name"], "frustum");
    uint64_t before = keptOf(plain);
    for (const char* windows : {"boxes", "octagons", "polygons"}) {
        const json run = cull(arguments + " --visibility house.vis --windows " + windows);
        EXPECT_EQ(run["verification"]["false_culls"], 0) << windows;
        EXPECT_EQ(run["windows"], windows);
        EXPECT_GT(culledBy(run, "pvs") + culledBy(run, "portals"), 0u);
        EXPECT_LE(keptOf(run), before) << windows;
        before = keptOf(run);
        for (const json& frame : run["frames"]) {
            uint64_t sum = frame["visible"].size();
            for (const json& stage : frame["stages"]) sum += stage["culled"].get<uint64_t>();
            EXPECT_EQ(sum, run["scene"]["objects"].get<uint64_t>());
        }
    }
    EXPECT_LT(2 * before, keptOf(plain));
    const json row = cull(arguments + " --visibility house.vis --skip portals");
    EXPECT_EQ(row["verification"]["false_culls"], 0);
    EXPECT_GE(keptOf(row), before);
    EXPECT_EQ(culledBy(row, "portals"), 0u);
}

TEST_F(Visibility, ALimitedDepthIsNotHeldToBeProved) {
    bake("building:2:1", "house.vis");
    const std::string arguments =
        "building:2:1 --path scatter --frames 6 --seed 3 --verify --rays 20000 --visibility house.vis";
    const json all = cull(arguments), near = cull(arguments + " --portal-depth 1");
    EXPECT_EQ(near["portal_depth"], 1);
    EXPECT_EQ(near["verification"]["false_culls"], 0);
    EXPECT_LE(keptOf(near), keptOf(all));
    uint64_t too_deep = 0;
    for (const json& frame : near["frames"]) too_deep += frame["cells"]["too_deep"].get<uint64_t>();
    EXPECT_GT(too_deep, 0u);
    EXPECT_TRUE(near.contains("changes"));
}

TEST_F(Visibility, ReportsShowTheWindows) {
    bake("building:2:1", "house.vis");
    const Outcome outcome =
        succeed("cull building:2:1 --frames 2 --seed 3 --size 320x180 --repeat 1 --visibility house.vis --report out");
    EXPECT_TRUE(std::filesystem::exists(path("out/frames/windows-0000.png")));
    EXPECT_NE(read(path("out/index.html")).find("\"windows\":\"data:image/"), std::string::npos);
    const Outcome again = succeed("report out/cull.json -o again");
}

TEST_F(Visibility, ExplainNamesTheStage) {
    bake("building:2:2", "house.vis");
    const json run_of = cull("building:2:2 --frames 1 --seed 3 --visibility house.vis --skip occlusion");
    const Outcome outcome =
        succeed("explain building:2:2 --frames 1 --seed 3 --visibility house.vis --object 0 --json - --rays 2000");
    const json answer = json::parse(outcome.out)["answers"][0];
    if (answer["stage"] == "pvs" || answer["stage"] == "portals") {
        EXPECT_FALSE(answer["cells"]["eye"].empty());
        EXPECT_FALSE(answer["cells"]["object"][0]["name"].get<std::string>().empty());
    }
    const auto& visible = run_of["frames"][0]["visible"];
    const bool kept = std::find(visible.begin(), visible.end(), 0) != visible.end();
    if (!kept) { EXPECT_FALSE(answer["stage"].is_null()) << outcome.out; }
    EXPECT_FALSE(answer["text"].get<std::string>().empty());
}

TEST_F(Visibility, WrongFilesAndOptionsAreRefused) {
    bake("building:2:1", "house.vis");
    expectError("cull building:3:1 --frames 1 --visibility house.vis", 3, "another scene");
    expectError("cull city:1:10 --frames 1 --visibility house.vis", 3, "another scene");
    expectError("cull building:2:1 --frames 1 --visibility nothing.vis", 3, "nothing.vis");
    std::string bytes = read(path("house.vis"));
    bytes[bytes.size() / 2] ^= 1;
    write("broken.vis", bytes);
    expectError("verify building:2:1 --frames 1 --visibility broken.vis", 3, "broken.vis");
    expectError("cull building:2:1 --frames 1 --visibility house.vis --door 'no such door=0'", 2, "no such door");
    for (const char* door : {"a", "a=", "=1", "a=2", "a=-1", "a=nan"})
        expectError(std::string("cull building:2:1 --frames 1 --visibility house.vis --door '") + door + "'", 2,
                    "--door");
    expectError("cull building:2:1 --frames 1 --door a=1", 2, "--visibility");
    expectError("cull building:2:1 --frames 1 --portal-depth 2", 2, "--visibility");
    expectError("cull building:2:1 --frames 1 --visibility house.vis --windows round", 2, "--windows");
    expectError("cull building:2:1 --frames 1 --visibility house.vis --json house.vis", 2, "house.vis");
}

}  // namespace
}  // namespace sightline
