// Certificates of a run: written by cull, checked by check; lies are found, and a cull stands only if whom it names suffice.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <functional>

#include "sightline/base/random.h"
#include "tests/cli/tool.h"

namespace sightline {
namespace {

using nlohmann::json;

class Check : public Tool {
protected:
    /// A walk of which some frames are answered by certificates.
    json walk(const std::string& scene, int frames) const {
        succeed("cull " + scene + " --path walk --seed 1 --remember --certificates --json run.json --frames " +
                std::to_string(frames));
        return json::parse(read(path("run.json")));
    }

    /// What the check says of a run after a change. Returns the exit code.
    int checkOf(json run, const std::string& scene, const std::function<void(json&)>& change, json& said) const {
        change(run);
        write("changed.json", run.dump());
        const Outcome outcome = this->run("check changed.json " + scene + " --json said.json");
        said = json::parse(read(path("said.json")));
        return outcome.exit_code;
    }
};

uint64_t hiddenOf(const json& run) {
    uint64_t count = 0;
    for (const json& frame : run["frames"])
        for (const json& row : frame["certificates"]) count += row["hidden"].size();
    return count;
}

TEST_F(Check, ProvesWhatWasCulledByThemAlone) {
    for (const std::string scene : {"building:1:1", "city:1:300"}) {
        const json run = walk(scene, 40);
        const uint64_t hidden = hiddenOf(run);
        EXPECT_GT(hidden, 50u) << scene;
        const Outcome outcome = succeed("check run.json " + scene + " --json said.json");
        EXPECT_NE(outcome.out.find("not shown             0"), std::string::npos) << outcome.out;
        const json said = json::parse(read(path("said.json")));
        EXPECT_EQ(said["schema"], "sightline.check/1");
        EXPECT_EQ(said["frames"], 40);
        EXPECT_EQ(said["proved"], hidden);
        EXPECT_EQ(said["undecided"], 0);
        EXPECT_TRUE(said["not_shown"].empty());
    }
}

// Whom a certificate names is exchanged, left out, or something visible is said to be hidden.
TEST_F(Check, BelievesNoLie) {
    const std::string scene = "building:1:1";
    const json run = walk(scene, 8);
    std::vector<size_t> with;  // frames
    for (size_t i = 0; i < run["frames"].size(); ++i)
        if (!run["frames"][i]["certificates"].empty()) with.push_back(i);
    ASSERT_FALSE(with.empty());
    json said;
    const auto nobody = [](json& changed) {
        for (json& frame : changed["frames"])
            for (json& row : frame["certificates"]) row["hiders"] = json::array();
    };
    EXPECT_EQ(checkOf(run, scene, nobody, said), 1);
    EXPECT_GT(said["not_shown"].size(), hiddenOf(run) / 4);
    for (const json& cull : said["not_shown"]) EXPECT_EQ(cull["visible"], false) << cull;

    Random random(5);
    const auto others = [&](json& changed) {
        for (json& frame : changed["frames"])
            for (json& row : frame["certificates"])
                for (json& hider : row["hiders"]) hider = random.below(run["scene"]["instances"].get<uint64_t>());
        for (json& frame : changed["frames"])
            for (json& row : frame["certificates"]) {
                std::vector<uint64_t> hiders = row["hiders"];
                std::sort(hiders.begin(), hiders.end());
                hiders.erase(std::unique(hiders.begin(), hiders.end()), hiders.end());
                row["hiders"] = hiders;
            }
    };
    EXPECT_EQ(checkOf(run, scene, others, said), 1);
    EXPECT_GT(said["not_shown"].size(), hiddenOf(run) / 4);

    const size_t frame = with[with.size() / 2];
    const auto seen = [&](json& changed) {
        // In this scene a key is an object's place.
        changed["frames"][frame]["certificates"][0]["hidden"] = changed["frames"][frame]["visible"];
    };
    EXPECT_EQ(checkOf(run, scene, seen, said), 1);
    size_t visible = 0;
    for (const json& cull : said["not_shown"]) {
        EXPECT_EQ(cull["frame"], frame);
        visible += cull["visible"] == true;
    }
    EXPECT_GT(visible, 0u);
}

TEST_F(Check, ErrorsAreOneLineAndAnExitCode) {
    succeed("cull city:1:50 --frames 2 --json plain.json");
    succeed("cull city:1:50 --frames 2 --path walk --remember --certificates --json run.json");
    expectError("check plain.json city:1:50", 3, "plain.json: holds no certificates");
    expectError("check run.json city:2:50", 3, "run.json: scene.hash: of another scene than city:2:50");
    expectError("check none.json city:1:50", 3, "none.json");
    expectError("check run.json city:1:50 --json run.json", 2, "run.json");
    expectError("check run.json city:1:50 --json none/a.json", 4, "none/a.json");
    json run = json::parse(read(path("run.json")));
    run["frames"][1]["camera"]["target"] = run["frames"][1]["camera"]["eye"];
    write("blind.json", run.dump());
    expectError("check blind.json city:1:50", 3, "blind.json: frames[1].camera: no view");
    expectError("cull city:1:50 --certificates --json a.json", 2, "--remember");
    expectError("cull city:1:50 --propose", 2, "--remember");
    expectError("cull city:1:50 --taught", 2, "--remember");
    expectError("cull city:1:50 --remember --taught --stereo 0.06", 2, "two eyes");
    expectError("cull city:1:50 --remember --propose --stereo 0.06", 2, "two eyes");
    expectError("cull city:1:50 --remember --certificates", 2, "--json or --report");
    expectError("cull city:1:50 --remember --certificates --stereo 0.06 --json a.json", 2, "two eyes");
    expectError("cull city:1:50 --remember --certificates --lod-error 1 --json a.json", 2, "levels of detail");
}

}  // namespace
}  // namespace sightline
