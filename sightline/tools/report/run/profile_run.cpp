// What limits a scene's frames, what its parts cost, and what each stage of the query is worth there.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/profile_run.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "sightline/tools/report/readable.h"
#include "sightline/tools/scene/json_text.h"

namespace sightline::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kWorthAWord = 0.01;  // as a share
constexpr const char* kVerdictNames[] = {"undecided", "limited", "mixed"};
constexpr const char* kDoubtNames[] = {"none", "noise", "elsewhere", "waits", "quantised"};

const char* stageName(Stage stage) { return kStageNames[static_cast<int>(stage)]; }

double shareMore(double more, double less) {
    return less > 0 ? more / less - 1 : more > 0 ? std::numeric_limits<double>::infinity() : 0;
}

/// "12 %", "3.4 times" of what grows by more than it is.
std::string growthWords(double share) {
    if (std::abs(share) < kWorthAWord) return "-";
    if (std::isinf(share)) return "all";
    if (share < 1) return fmt::format("{:.0f} %", 100 * share);
    return fmt::format("{} x", readable(1 + share, 3));
}

std::string milliseconds(double seconds) { return fmt::format("{:.3f}", 1e3 * seconds); }

/// What the sum of shares says of the frame.
std::string sumWords(const Bottleneck& found) {
    const double sum = found.judgement.sum;
    if (sum > 1.15) return fmt::format("the shares add up to {:.0f} %: stages overlap", 100 * sum);
    if (sum < 0.85) return fmt::format("{:.0f} % of the frame is in none of the four", 100 * (1 - sum));
    return "the stages work one after the other, and are the whole frame";
}

std::string roundWords(const Bottleneck& found) {
    std::string words = fmt::format("confidence {:.0f} %, {}", 100 * found.confidence, counted(found.rounds, "round"));
    if (found.frames_a_sample > 1) words += fmt::format(" of {} frames a measurement", found.frames_a_sample);
    if (found.out_of_time) words += ", ended by the time limit";
    else if (!found.settled) words += ", ended by the limit of rounds";
    return words;
}

void printBottleneck(const ProfileRun& run, std::string& text) {
    const Bottleneck& found = run.bottleneck;
    text += fmt::format("{}\n", verdictWords(found));
    text += fmt::format("  {}\n  {}\n", roundWords(found), sumWords(found));
    text += fmt::format("  a path takes {} ms", milliseconds(found.frame));
    text += fmt::format(", the process computes {} ms meanwhile", milliseconds(found.cpu));
    if (run.driver_counts) text += fmt::format(", the GL is busy for {:.0f} %", 100 * run.driver_counts->gpu_busy);
    if (found.waiting > 0.2) text += fmt::format(", and {:.0f} % is waiting", 100 * found.waiting);
    text += "\n\nload        twice of it [ms]   sensitivity   share of the frame\n";
    for (int i = 0; i < kFrameStages; ++i) {
        const Sensitivity& stage = found.stages[static_cast<size_t>(i)];
        text += fmt::format("{:<11} {:>16} {:>13.2f} {:>12.1f} % +- {:.1f}\n", kFrameStageNames[i],
                            milliseconds(stage.seconds), stage.exponent, 100 * stage.share, 100 * stage.spread);
    }
}

void printCosts(const ProfileRun& run, std::string& text) {
    const DrawCosts& costs = run.costs;
    text += fmt::format(
        "\ncosts of {} [ns]: an object {}, a triangle {}, a vertex {}, a covered pixel {}, "
        "a pixel of the image {}, a frame {}\n"
        "  fitted to {} frames of parts of the scene; half of them are within {:.1f} %\n"
        "  a cluster's test {:.2f}, a back face dropped {}, drawn {}\n",
        run.renderer, readable(costs.object), readable(costs.triangle, 3), readable(costs.vertex, 3),
        readable(costs.pixel, 3), readable(costs.sample, 3), readable(costs.frame), costs.samples, 100 * costs.error,
        run.facing.test, readable(run.facing.dropped, 3), readable(run.facing.drawn, 3));
}

void printAblation(const ProfileRun& run, std::string& text) {
    text += fmt::format("\n{:<21} {:>9} {:>11} {:>10} {:>12} {:>11} {:>9} {:>9} {:>10}\n", "stages", "objects",
                        "triangles", "drawn", "fragments", "shaded", "KiB", "query us", "frame ms");
    for (const AblationRow& row : run.ablation)
        text += fmt::format("{:<21} {:>9} {:>11} {:>10} {:>12} {:>11} {:>9} {:>9} {:>10}\n", row.name(),
                            readable(std::round(row.objects)), readable(std::round(row.triangles)),
                            readable(std::round(row.drawn)), readable(std::round(row.fragments)),
                            readable(std::round(row.shaded)), readable(row.bytes / 1024),
                            readable(row.query_microseconds), readable(row.frame_milliseconds));
    text += fmt::format("\n{:<21} {:>9} {:>11} {:>10}   {}\n", "without it, more", "geometry", "rasterizer", "bus",
                        "it saves a frame of the reference renderer [ms]");
    for (const StageBenefit& benefit : benefitsOf(run.ablation))
        text += fmt::format("{:<21} {:>9} {:>11} {:>10}   {} +- {}{}\n", stageName(benefit.stage),
                            growthWords(benefit.geometry), growthWords(benefit.rasterizer), growthWords(benefit.bus),
                            readable(benefit.milliseconds), readable(benefit.spread, 2),
                            benefit.in_use ? "" : ", if it were on");
}

Json bottleneckJson(const Bottleneck& found) {
    Json out;
    out["verdict"] = kVerdictNames[static_cast<int>(found.verdict())];
    out["words"] = verdictWords(found);
    out["doubt"] = kDoubtNames[static_cast<int>(found.doubt)];
    out["confidence"] = found.confidence;
    out["limits"] = Json::array();
    if (found.verdict() != LimitVerdict::kUndecided)
        for (size_t i = 0; i < kFrameStages; ++i)
            if (found.judgement.limits[i]) out["limits"].push_back(kFrameStageNames[i]);
    out["stages"] = Json::array();
    for (size_t i = 0; i < kFrameStages; ++i) {
        const Sensitivity& stage = found.stages[i];
        out["stages"].push_back({{"name", kFrameStageNames[i]},
                                 {"sensitivity", stage.exponent},
                                 {"share", stage.share},
                                 {"spread", stage.spread},
                                 {"proportion", found.judgement.proportions[i]},
                                 {"loaded_milliseconds", 1e3 * stage.seconds}});
    }
    out["sum_of_shares"] = found.judgement.sum;
    out["path_milliseconds"] = 1e3 * found.frame;
    out["cpu_milliseconds"] = 1e3 * found.cpu;
    out["gpu_milliseconds"] = found.gpu ? Json(1e3 * *found.gpu) : Json(nullptr);
    out["waiting"] = found.waiting;
    out["rounds"] = found.rounds;
    out["settled"] = found.settled;
    out["out_of_time"] = found.out_of_time;
    return out;
}

Json costsJson(const ProfileRun& run) {
    const DrawCosts& costs = run.costs;
    return {{"object_ns", costs.object},
            {"triangle_ns", costs.triangle},
            {"vertex_ns", costs.vertex},
            {"pixel_ns", costs.pixel},
            {"image_pixel_ns", costs.sample},
            {"frame_ns", costs.frame},
            {"error", costs.error},
            {"samples", costs.samples},
            {"cluster_test_ns", run.facing.test},
            {"triangle_dropped_ns", run.facing.dropped},
            {"triangle_drawn_ns", run.facing.drawn}};
}

Json ablationJson(const ProfileRun& run) {
    Json out = Json::array();
    const std::vector<StageBenefit> benefits = benefitsOf(run.ablation);
    size_t next = 0;
    for (const AblationRow& row : run.ablation) {
        Json json = {{"stages", row.name()},
                     {"objects", row.objects},
                     {"triangles", row.triangles},
                     {"triangles_drawn", row.drawn},
                     {"fragments", row.fragments},
                     {"shaded", row.shaded},
                     {"bytes", row.bytes},
                     {"query_microseconds", row.query_microseconds},
                     {"frame_milliseconds", row.frame_milliseconds},
                     {"frame_spread_milliseconds", row.frame_spread}};
        if (row.change == AblationRow::Change::kWith || row.change == AblationRow::Change::kWithout) {
            const StageBenefit& benefit = benefits[next++];
            const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); };
            json["stage"] = stageName(benefit.stage);
            json["in_use"] = benefit.in_use;
            json["benefits"] = {{"geometry", number(benefit.geometry)},
                                {"rasterizer", number(benefit.rasterizer)},
                                {"bus", number(benefit.bus)},
                                {"words", benefit.words()}};
            json["saves_milliseconds"] = benefit.milliseconds;
            json["saves_spread_milliseconds"] = benefit.spread;
        }
        out.push_back(std::move(json));
    }
    return out;
}

}  // namespace

std::string AblationRow::name() const {
    switch (change) {
        case Change::kNothing:
            return "as asked";
        case Change::kWithout:
            return std::string("without ") + stageName(stage);
        case Change::kWith:
            return std::string("with ") + stageName(stage);
        case Change::kNone:
            break;
    }
    return "no stage";
}

std::string StageBenefit::words() const {
    std::string words;
    const std::pair<const char*, double> all[] = {{"geometry", geometry}, {"rasterizer", rasterizer}, {"bus", bus}};
    for (const auto& [name, share] : all)
        if (share >= kWorthAWord) words += (words.empty() ? "" : ", ") + std::string(name);
    return words.empty() ? "nothing" : words;
}

std::vector<StageBenefit> benefitsOf(const std::vector<AblationRow>& rows) {
    std::vector<StageBenefit> out;
    for (const AblationRow& row : rows) {
        if (row.change != AblationRow::Change::kWithout && row.change != AblationRow::Change::kWith) continue;
        const bool in_use = row.change == AblationRow::Change::kWithout;
        const AblationRow &with = in_use ? rows.front() : row, &without = in_use ? row : rows.front();
        out.push_back({row.stage, in_use, shareMore(without.triangles, with.triangles),
                       shareMore(without.fragments, with.fragments), shareMore(without.bytes, with.bytes),
                       with.query_microseconds - without.query_microseconds,
                       without.frame_milliseconds - with.frame_milliseconds,
                       std::hypot(without.frame_spread, with.frame_spread)});
    }
    return out;
}

std::string profileText(const ProfileRun& run) {
    std::string text = fmt::format(
        "{}: {}, {}, {} at {}x{}, drawn by {}\n", run.scene, counted(run.objects, "object"),
        counted(run.triangles, "triangle"), counted(run.frames, "camera"), run.width, run.height,
        run.driver.empty() ? fmt::format("the reference renderer on {}", counted(run.threads, "thread")) : run.driver);
    printBottleneck(run, text);
    printCosts(run, text);
    printAblation(run, text);
    return text;
}

std::string profileJson(const ProfileRun& run) {
    Json out;
    out["schema"] = "sightline.profile/1";
    out["scene"] = {{"file", run.scene}, {"objects", run.objects}, {"triangles", run.triangles}};
    out["renderer"] = run.renderer;
    if (!run.driver.empty()) out["driver"] = run.driver;
    out["machine"] = run.machine;
    out["width"] = run.width;
    out["height"] = run.height;
    out["frames"] = run.frames;
    out["threads"] = run.threads;
    out["stream"] = run.stream;
    out["bottleneck"] = bottleneckJson(run.bottleneck);
    out["costs"] = costsJson(run);
    if (run.driver_counts) {
        const DriverCounts& counts = *run.driver_counts;
        const auto number = [](const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); };
        out["driver_counts"] = {{"gpu_busy", counts.gpu_busy},
                                {"vertices", number(counts.vertices)},
                                {"triangles", number(counts.triangles)},
                                {"fragments", number(counts.fragments)},
                                {"samples_passed", counts.samples_passed}};
    }
    out["ablation"] = ablationJson(run);
    return jsonText(out, 1) + "\n";
}

}  // namespace sightline::tools
