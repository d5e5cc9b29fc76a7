// Made scenes on the command line: what each is there to show, shows.
// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "tests/cli/tool.h"

namespace sightline {
namespace {

using nlohmann::json;

class MadeScenes : public Tool {
protected:
    json drawn(const std::string& name, const std::string& options) const {
        const Outcome outcome = run("render made:" + name + " --size 320x180 " + options + " --json -");
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        return outcome.exit_code == 0 ? json::parse(outcome.out) : json();
    }
    /// Samples that the painter shows wrongly; of any other method there may be none.
    uint64_t wrongByThePainter(const std::string& name, const std::string& key) const {
        uint64_t wrong = 0;
        size_t methods = 0;
        const json out = drawn(name, "--method all --painter-key " + key);
        for (const json& method : out["methods"]) {
            ++methods;
            const uint64_t here = method["agreement"]["wrong"];
            if (method["name"] == "painter") wrong = here;
            else EXPECT_EQ(here, 0u) << name << " " << method["name"];
        }
        EXPECT_EQ(methods, 7u) << name;
        return wrong;
    }
};

TEST_F(MadeScenes, FoolThePainterAndNoExactMethod) {
    for (const char* key : {"centre", "farthest"})
        for (const char* name : {"cycle", "crossing"})
            EXPECT_GT(wrongByThePainter(name, key), 0u) << name << " " << key;
    EXPECT_GT(wrongByThePainter("near", "centre"), 0u);
    EXPECT_EQ(wrongByThePainter("near", "farthest"), 0u);
    for (const char* name : {"coplanar", "walls"}) EXPECT_EQ(wrongByThePainter(name, "farthest"), 0u) << name;
    wrongByThePainter("eye", "farthest");
}

TEST_F(MadeScenes, WallsAreEightDeepAtEachPixel) {
    const json out = drawn("walls", "--method painter");
    const json& generated = out["methods"][0]["per_sample"]["generated"];
    EXPECT_EQ(generated["mean"], 8.0) << generated;
    EXPECT_EQ(generated["maximum"], 8u) << generated;
}

TEST_F(MadeScenes, CoplanarFacesTie) {
    const json out = drawn("coplanar", "--method raycast");
    EXPECT_GT(out["methods"][0]["agreement"]["ties"], 0u);
}

TEST_F(MadeScenes, AreScenesLikeAnyOther) {
    const Outcome info = run("info made:eye --json -");
    ASSERT_EQ(info.exit_code, 0) << info.err;
    EXPECT_EQ(json::parse(info.out)["objects"], 5u);
    const Outcome cull = run("cull made:walls --verify --size 160x90 --json -");
    ASSERT_EQ(cull.exit_code, 0) << cull.err;
    EXPECT_EQ(json::parse(cull.out)["frames"][0]["visible"], json::array({7}));
}

TEST_F(MadeScenes, NamesThatDoNotExistAreListedAgainstThoseThatDo) {
    for (const char* verb : {"render", "cull", "info"}) {
        expectError(std::string(verb) + " made:circle", 2, "cycle, crossing, coplanar, near, walls, eye");
        expectError(std::string(verb) + " made:", 2, "cycle, crossing, coplanar, near, walls, eye");
    }
}

}  // namespace
}  // namespace sightline
