// The verb `bench`, which is a program of its own: its arguments, completions and help, and the proof of the occlusion scenes.
// SPDX-License-Identifier: MIT
#include "tests/cli/tool.h"

namespace sightline {
namespace {

class BenchVerb : public Tool {};

TEST_F(BenchVerb, WrongArgumentsExitWithTwo) {
    expectError("bench nothing", 2, "nothing");
    expectError("bench frustum --verify", 2, "--verify goes with the case occlusion");
    expectError("bench occlusion --rays-per-box 4", 2, "--rays-per-box goes with --verify");
    expectError("bench occlusion --verify --repeat 2", 2, "--verify excludes --repeat");
    expectError("bench occlusion --verify --only moon", 2, "no scene \"moon\"");
    expectError("bench occlusion --verify --size 12", 2, "--size 12");
    expectError("bench occlusion --verify=1", 2, "takes no value");
}

TEST_F(BenchVerb, HelpsAndCompletes) {
    const Outcome help = succeed("bench --help");
    EXPECT_NE(help.out.find("--json"), std::string::npos);
    EXPECT_EQ(succeed("completions --words bench fru").out, "frustum\n");
}

TEST_F(BenchVerb, EndsReadersOfForeignFilesInTime) {
    std::string text;
    for (int i = 0; i < 300000; ++i) text.append("v ").append(std::to_string(i)).append(" 0 0\n");
    write("large.obj", text + "f 1 2 3\n");
#ifdef SIGHTLINE_HAS_ASSIMP
    expectError("bench frustum --scene large.obj --import-time 0.001", 3, "took longer");
#endif
}

TEST_F(BenchVerb, ProvesTheOcclusionScenes) {
    const json rows = answer(
        "bench occlusion --verify --only indoor --size 160x96 --jitters 1 --rays-per-box 2 --first-cameras 1")["rows"];
    size_t targets = 0;
    for (const json& row : rows) {
        const std::string what = row["what"];
        if (what.rfind("false culls", 0) == 0) {
            EXPECT_EQ(row["value"], 0);
            EXPECT_GT(row["baseline_value"], 1000);
        }
        if (what.rfind("answers that differ", 0) != 0) continue;
        EXPECT_EQ(row["value"], 0);
        EXPECT_EQ(row["note"], rows.back()["note"]);
        ++targets;
    }
    EXPECT_GE(targets, 1u);
}

}  // namespace
}  // namespace sightline
