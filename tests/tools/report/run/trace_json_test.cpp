// The timeline holds every frame on its thread, with its stages nested, and counters.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/trace_json.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/tools/report/run/made_run.h"

namespace sightline {
using namespace tools;
namespace {

using nlohmann::json;

std::vector<json> eventsOf(const json& trace, const std::string& phase, const std::string& category = "") {
    std::vector<json> found;
    for (const json& event : trace["traceEvents"])
        if (event["ph"] == phase && (category.empty() || event["cat"] == category)) found.push_back(event);
    return found;
}

CullRun timedRun() {
    CullRun run = madeRun(madeScene(), 3);
    for (size_t i = 0; i < run.frames.size(); ++i) {
        FrameResult& frame = run.frames[i];
        frame.thread = static_cast<uint32_t>(i % 2);
        frame.begin_microseconds = 100.0 * static_cast<double>(i);
        frame.end_microseconds = frame.begin_microseconds + 60;
        frame.stages[static_cast<int>(Stage::kOcclusion)].microseconds = 5;
    }
    return run;
}

TEST(TraceJson, HasATrackForEachThreadAndASliceForEachFrame) {
    const json trace = json::parse(traceJson(timedRun()));
    EXPECT_EQ(trace["displayTimeUnit"], "ms");
    const auto frames = eventsOf(trace, "X", "frame");
    ASSERT_EQ(frames.size(), 3u);
    EXPECT_EQ(frames[1]["tid"], 1);
    EXPECT_EQ(frames[1]["ts"], 100);
    EXPECT_EQ(frames[1]["dur"], 60);
    EXPECT_EQ(frames[1]["args"]["kept"], 2);
    size_t tracks = 0;
    for (const json& event : eventsOf(trace, "M")) tracks += event["name"] == "thread_name";
    EXPECT_EQ(tracks, 2u);
}

TEST(TraceJson, NestsStagesInTheirQueryAndQueriesInTheirFrame) {
    CullRun run = timedRun();
    run.frames[2].stages[static_cast<int>(Stage::kFrustum)].microseconds =
        1000;  // timed apart, and slower than the query
    const json trace = json::parse(traceJson(run));
    const auto frames = eventsOf(trace, "X", "frame"), queries = eventsOf(trace, "X", "query"),
               stages = eventsOf(trace, "X", "stage");
    ASSERT_EQ(queries.size(), 3u);
    ASSERT_EQ(stages.size(), 6u);
    const auto end = [](const json& event) { return event["ts"].get<double>() + event["dur"].get<double>(); };
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_GE(queries[i]["ts"], frames[i]["ts"]);
        EXPECT_LE(end(queries[i]), end(frames[i]));
        EXPECT_GE(stages[2 * i]["ts"], queries[i]["ts"]);
        EXPECT_NEAR(end(stages[2 * i]), stages[2 * i + 1]["ts"].get<double>(), 1e-9);
        EXPECT_LE(end(stages[2 * i + 1]), end(queries[i]) + 1e-9);
    }
    EXPECT_EQ(stages[4]["args"]["microseconds"], 1000);
}

TEST(TraceJson, CountsObjectsAndTriangles) {
    const auto counters = eventsOf(json::parse(traceJson(timedRun())), "C");
    ASSERT_EQ(counters.size(), 6u);
    EXPECT_EQ(counters[0]["name"], "objects");
    EXPECT_EQ(counters[0]["args"], json::parse(R"({"kept": 2, "exactly visible": 2})"));
    EXPECT_EQ(counters[1]["args"]["submitted"], 4);
}

TEST(TraceJson, PutsFramesWithoutAClockOneAfterTheOther) {
    const auto frames = eventsOf(json::parse(traceJson(madeRun(madeScene(), 4))), "X", "frame");
    for (size_t i = 1; i < frames.size(); ++i)
        EXPECT_GE(frames[i]["ts"].get<double>(),
                  frames[i - 1]["ts"].get<double>() + frames[i - 1]["dur"].get<double>());
    EXPECT_EQ(json::parse(traceJson(CullRun()))["traceEvents"].size(), 1u);
}

}  // namespace
}  // namespace sightline
