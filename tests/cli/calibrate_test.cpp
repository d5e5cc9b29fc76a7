// The verb calibrate, and what reads its file.
// SPDX-License-Identifier: MIT
#include "tests/cli/tool.h"

namespace sightline {
namespace {

using Calibrate = Tool;

TEST_F(Calibrate, WritesWhatCullReads) {
    const std::string file = "calibration.json";
    const Outcome outcome = succeed("calibrate --json " + file);
    EXPECT_NE(outcome.out.find("a cluster's test"), std::string::npos) << outcome.out;
    const json written = json::parse(read(path(file)));
    EXPECT_EQ(written["schema"], "sightline.calibration/1");
    const std::string cull =
        "cull building:1:1 --frames 1 --seed 1 --size 160x90 --repeat 1 --json - --use frustum,clusters";
    for (const bool dear : {false, true}) {
        const Outcome answer = succeed(cull + " --calibration " + file + (dear ? " --dear-shading" : ""));
        const double expected = written["cluster_test_ns"].get<double>() /
                                written[dear ? "triangle_drawn_ns" : "triangle_dropped_ns"].get<double>();
        EXPECT_EQ(json::parse(answer.out)["cluster_test"].get<double>(), expected);
    }
    const Outcome told = run(cull + " --cluster-test 7.5");
    EXPECT_EQ(json::parse(told.out)["cluster_test"].get<double>(), 7.5);
}

TEST_F(Calibrate, WrongValuesAreRefused) {
    expectError("cull building:1:1 --calibration does-not-exist.json", 3, "does-not-exist.json");
    expectError("cull building:1:1 --dear-shading", 2, "--dear-shading");
    for (const char* value : {"0", "-1", "nan", "inf", "x"})
        expectError("cull building:1:1 --cluster-test=" + std::string(value), 2, "--cluster-test");
    expectError("calibrate --json no-such-folder/c.json", 4, "no-such-folder");
}

}  // namespace
}  // namespace sightline
