// Calibrations: measured, written, read back, and refused with a reason.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/calibration_json.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "sightline/base/random.h"

namespace sightline {
using namespace tools;
namespace {

TEST(Calibration, IsMeasuredAndReadBack) {
    const FacingCosts costs = measureFacingCosts({.rings = 24, .size = 96, .rounds = 3});
    EXPECT_GT(costs.test, 0);
    EXPECT_GT(costs.dropped, 0);
    EXPECT_GT(costs.drawn, 0);
    EXPECT_GT(costs.testInTriangles(ShadingCost::kCheap), 0);
    const Result<FacingCosts> read = parseCalibration(calibrationJson(costs, "a \"machine\"\n"), "c.json");
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read->test, costs.test);
    EXPECT_EQ(read->dropped, costs.dropped);
    EXPECT_EQ(read->drawn, costs.drawn);
    EXPECT_EQ(read->testInTriangles(ShadingCost::kDear), costs.test / costs.drawn);
}

TEST(Calibration, WhatIsWrongIsNamed) {
    const std::string head = "{\"schema\": \"sightline.calibration/1\", ";
    const std::pair<std::string, const char*> cases[] = {
        {"", "not JSON"},
        {"[1]", "not an object"},
        {"{}", "schema"},
        {"{\"schema\": 3}", "schema"},
        {"{\"schema\": \"sightline.cull/1\"}", "schema"},
        {head + "\"cluster_test_ns\": 1}", "triangle_dropped_ns: missing"},
        {head + "\"cluster_test_ns\": \"1\"}", "cluster_test_ns: not a number"},
        {head + "\"cluster_test_ns\": 0}", "cluster_test_ns: not a number above 0"},
        {head + "\"cluster_test_ns\": -1}", "above 0"},
        {head + "\"cluster_test_ns\": 1e999}", ""},
        {head + "\"cluster_test_ns\": null}", "above 0"},
        {"{\"schema\": \"sightline.profile/1\"}", "costs: missing"},
        {"{\"schema\": \"sightline.profile/1\", \"costs\": [1]}", "costs: missing"},
        {"{\"schema\": \"sightline.profile/1\", \"costs\": {}}", "cluster_test_ns: missing"},
    };
    for (const auto& [text, what] : cases) {
        const Result<FacingCosts> read = parseCalibration(text, "c.json");
        ASSERT_FALSE(read.ok()) << text;
        EXPECT_EQ(read.error().kind, Error::Kind::kInput);
        EXPECT_EQ(read.error().message.substr(0, 7), "c.json:") << read.error().message;
        EXPECT_NE(read.error().message.find(what), std::string::npos) << read.error().message;
    }
}

TEST(Calibration, ReplaysTheCorpusOfTheFuzzer) {
    const std::filesystem::path corpus = std::filesystem::path(SIGHTLINE_FUZZ_CORPUS) / "calibration";
    size_t files = 0, read = 0;
    for (const auto& entry : std::filesystem::directory_iterator(corpus)) {
        std::stringstream text;
        text << std::ifstream(entry.path(), std::ios::binary).rdbuf();
        const Result<FacingCosts> costs = parseCalibration(text.str(), "c.json");
        if (!costs.ok()) { EXPECT_EQ(costs.error().message.substr(0, 8), "c.json: "); }
        read += costs.ok();
        ++files;
    }
    EXPECT_GE(files, 3u);
    EXPECT_GE(read, 1u);
}

TEST(Calibration, AProfileTellsWhatDrawingCosts) {
    const std::string costs = R"("object_ns": 120.5, "triangle_ns": 0, "vertex_ns": 2, "pixel_ns": 0.25)";
    const auto profile = [](const std::string& text) {
        return R"({"schema": "sightline.profile/1", "costs": {)" + text + "}}";
    };
    const Result<std::optional<DrawCost>> read = parseDrawCost(profile(costs), "p.json");
    ASSERT_TRUE(read.ok() && *read);
    EXPECT_EQ((*read)->object, 120.5);
    EXPECT_EQ((*read)->triangle, 0);
    EXPECT_EQ((*read)->vertex, 2);
    EXPECT_EQ((*read)->pixel, 0.25);
    const Result<std::optional<DrawCost>> none = parseDrawCost(calibrationJson({1, 2, 3}, "m"), "c.json");
    ASSERT_TRUE(none.ok());
    EXPECT_FALSE(*none);
    const std::pair<const char*, const char*> wrong[] = {
        {R"("object_ns": -1)", "p.json: object_ns: not a number from 0 on"},
        {R"("object_ns": "1")", "p.json: object_ns: not a number from 0 on"},
        {R"("object_ns": 1)", "p.json: triangle_ns: missing"}};
    for (const auto& [text, message] : wrong)
        EXPECT_EQ(parseDrawCost(profile(text), "p.json").error().message, message);
    EXPECT_EQ(parseDrawCost("[]", "p.json").error().message, "p.json: not an object");
    EXPECT_EQ(parseDrawCost("{", "p.json").error().message, "p.json: not JSON");
}

TEST(Calibration, NoBytesCrashTheReader) {
    const std::string good = calibrationJson({1, 2, 3}, "m");
    Random random(1);
    uint64_t read = 0;
    for (int i = 0; i < 20000; ++i) {
        std::string text = good;
        for (uint64_t k = 1 + random.below(4); k > 0; --k) {
            const size_t at = random.below(text.size());
            switch (random.below(3)) {
                case 0:
                    text[at] = static_cast<char>(random.below(256));
                    break;
                case 1:
                    text.erase(at, random.below(9));
                    break;
                default:
                    text.insert(at, text.substr(random.below(text.size()), random.below(12)));
            }
            if (text.empty()) text = "{";
        }
        const Result<FacingCosts> costs = parseCalibration(text, "c");
        read += costs.ok();
        if (costs.ok()) { EXPECT_GT(costs->test, 0); }
        (void)parseDrawCost(text, "c").ok();
    }
    EXPECT_GT(read, 100u);
}

}  // namespace
}  // namespace sightline
