// Section planes on the command line: runs, proofs, explanations and results know of them.
// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "tests/cli/tool.h"

namespace sightline {
namespace {

using nlohmann::json;

class SectionOptions : public Tool {
protected:
    json cull(const std::string& arguments) const {
        const Outcome outcome = run("cull " + arguments + " --size 320x180 --repeat 1 --json -");
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        return json::parse(outcome.out);
    }
};

TEST_F(SectionOptions, CutTheSceneAndAreProved) {
    const std::string arguments = "city:1:1000 --frames 3 --seed 1 --verify --rays 20000";
    const json whole = cull(arguments);
    EXPECT_FALSE(whole.contains("sections"));
    const json cut = cull(arguments + " --section=0,-1,0,6 --section -1,0,0.5,80");
    EXPECT_EQ(cut["sections"], json::parse("[[0.0,-1.0,0.0,6.0],[-1.0,0.0,0.5,80.0]]"));
    EXPECT_EQ(cut["verification"]["false_culls"], 0);
    EXPECT_GT(cut["verification"]["exactly_visible"].get<uint64_t>(), 0u);
    bool differs = false;
    for (size_t i = 0; i < 3; ++i) differs |= whole["frames"][i]["visible"] != cut["frames"][i]["visible"];
    EXPECT_TRUE(differs);
}

TEST_F(SectionOptions, ExplainNamesThem) {
    const Outcome gone = run("explain city:1:400 --frames 1 --seed 1 --object 3 --section 0,1,0,-100000");
    EXPECT_EQ(gone.exit_code, 0) << gone.err;
    EXPECT_NE(gone.out.find("section 1"), std::string::npos) << gone.out;
}

TEST_F(SectionOptions, WrongValuesExitWithTwo) {
    for (const char* value : {"1,0,0", "1,0,0,0,0", "0,0,0,1", "a,b,c,d", "1,0,nan,0", "1,0,inf,0", "''", ",,,"})
        expectError("cull city:1:10 --section=" + std::string(value), 2, "--section");
    std::string nine = "cull city:1:10";
    for (int i = 0; i < 9; ++i) nine += " --section=1,0,0,1";
    expectError(nine, 2, "--section");
}

}  // namespace
}  // namespace sightline
