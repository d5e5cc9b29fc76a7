// The stage of clusters on the command line: what it leaves is counted, proved and explained.
// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "tests/cli/tool.h"

namespace sightline {
namespace {

using nlohmann::json;

class ClusterOptions : public Tool {
protected:
    json cull(const std::string& arguments) const {
        const Outcome outcome =
            run("cull building:1:2 --frames 3 --seed 1 --size 320x180 --repeat 1 --json - " + arguments);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        return json::parse(outcome.out);
    }
};

TEST_F(ClusterOptions, SubmitLessAndAreProved) {
    const json whole = cull(""), left = cull("--use frustum,occlusion,clusters --verify --rays 20000");
    EXPECT_EQ(left["verification"]["false_culls"], 0);
    uint64_t drawn = 0, all = 0;
    for (size_t i = 0; i < 3; ++i) {
        const json &before = whole["frames"][i], &after = left["frames"][i];
        EXPECT_FALSE(before.contains("clusters"));
        const json& clusters = after["clusters"];
        drawn += clusters["drawn"].get<uint64_t>();
        all += clusters["whole"].get<uint64_t>();
        EXPECT_LE(clusters["draws"], clusters["tested"]);
        EXPECT_LE(after["triangles"], before["triangles"]);
        EXPECT_EQ(after["stages"].back()["name"], "clusters");
    }
    EXPECT_GT(drawn, 0u);
    EXPECT_LT(drawn, all);
}

TEST_F(ClusterOptions, AreToldOf) {
    const Outcome told = run("cull building:1:2 --frames 2 --seed 1 --use frustum,occlusion,clusters");
    EXPECT_EQ(told.exit_code, 0) << told.err;
    EXPECT_NE(told.out.find("seen from the back"), std::string::npos) << told.out;
}

}  // namespace
}  // namespace sightline
