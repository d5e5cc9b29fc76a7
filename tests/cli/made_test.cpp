// Made scenes on the command line: what each is there to show, shows.
// SPDX-License-Identifier: MIT
#include "tests/cli/tool.h"

namespace sightline {
namespace {

class MadeScenes : public Tool {
protected:
    json drawn(const std::string& name, const std::string& options) const {
        return answer("render made:" + name + " --size 320x180 " + options);
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
    EXPECT_EQ(answer("info made:eye")["objects"], 5u);
    EXPECT_EQ(answer("cull made:walls --verify --size 160x90")["frames"][0]["visible"], json::array({7}));
}

TEST_F(MadeScenes, NamesThatDoNotExistAreListedAgainstThoseThatDo) {
    for (const char* verb : {"render", "cull", "info"}) {
        expectError(std::string(verb) + " made:circle", 2, "cycle, crossing, coplanar, near, walls, eye");
        expectError(std::string(verb) + " made:", 2, "cycle, crossing, coplanar, near, walls, eye");
    }
}

}  // namespace
}  // namespace sightline
