// A run as a timeline that chrome://tracing and Perfetto open: Chrome's trace event format.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/trace_json.h"
#include "sightline/tools/scene/json_text.h"

#include <algorithm>
#include <set>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace sightline::tools {
namespace {

using Json = nlohmann::ordered_json;

Json slice(const std::string& name, const char* category, uint32_t thread, double begin, double length) {
    return {{"name", name},  {"cat", category}, {"ph", "X"},    {"pid", 1},
            {"tid", thread}, {"ts", begin},     {"dur", length}};
}

Json named(const char* what, uint32_t thread, const std::string& name) {
    return {{"name", what}, {"ph", "M"}, {"pid", 1}, {"tid", thread}, {"args", {{"name", name}}}};
}

Json counter(const std::string& name, double at, Json values) {
    return {{"name", name}, {"ph", "C"}, {"pid", 1}, {"tid", 0}, {"ts", at}, {"args", std::move(values)}};
}

/// The frame, its query at the end of it, and the stages within the query.
void addFrame(const CullRun& run, size_t index, double begin, double end, Json& events) {
    const FrameResult& frame = run.frames[index];
    Json whole = slice(fmt::format("frame {}", index), "frame", frame.thread, begin, end - begin);
    whole["args"] = {{"kept", frame.visible.size()},
                     {"triangles", frame.triangles},
                     {"occluder_triangles", frame.stats.occluder_triangles},
                     {"nodes_visited", frame.stats.nodes_visited},
                     {"seam_pixels", frame.stats.seam_pixels},
                     {"repeats", run.repeat}};
    events.push_back(std::move(whole));
    const double length = std::min(frame.query_microseconds, end - begin);
    Json query = slice("query", "query", frame.thread, begin, length);
    query["args"] = {{"median_microseconds", frame.query_microseconds}};
    events.push_back(std::move(query));
    double sum = 0;
    for (const StageRow& row : frame.stages) sum += row.microseconds;
    const double scale = sum > length ? length / sum : 1;
    double at = begin;
    for (const Stage stage : kStageOrder) {
        if (!(run.settings.stages & stageBit(stage))) continue;
        const StageRow& row = frame.stages[static_cast<int>(stage)];
        Json part = slice(kStageNames[static_cast<int>(stage)], "stage", frame.thread, at, row.microseconds * scale);
        part["args"] = {
            {"microseconds", row.microseconds}, {"tested", row.tested}, {"culled", row.culled}, {"doubt", row.doubt}};
        events.push_back(std::move(part));
        at += row.microseconds * scale;
    }
}

}  // namespace

std::string traceJson(const CullRun& run) {
    Json events = Json::array();
    events.push_back(named("process_name", 0, "sightline cull " + run.scene));
    std::set<uint32_t> threads;
    for (const FrameResult& frame : run.frames) threads.insert(frame.thread);
    for (const uint32_t thread : threads)
        events.push_back(named("thread_name", thread, fmt::format("thread {}", thread)));
    double next = 0;  // where no clock was kept, one frame follows the other
    for (size_t i = 0; i < run.frames.size(); ++i) {
        const FrameResult& frame = run.frames[i];
        const bool timed = frame.end_microseconds > frame.begin_microseconds;
        const double begin = timed ? frame.begin_microseconds : next;
        const double end = timed ? frame.end_microseconds : begin + frame.query_microseconds;
        next = std::max(next, end);
        addFrame(run, i, begin, end, events);
        Json kept = {{"kept", frame.visible.size()}};
        if (frame.verification) kept["exactly visible"] = frame.verification->exactly_visible;
        events.push_back(counter("objects", begin, std::move(kept)));
        events.push_back(counter("triangles", begin, {{"submitted", frame.triangles}}));
    }
    std::string text = "{\"displayTimeUnit\": \"ms\", \"traceEvents\": [";
    for (size_t i = 0; i < events.size(); ++i) text += (i ? ",\n" : "\n") + jsonText(events[i]);
    return text + "]}\n";
}

}  // namespace sightline::tools
