// What would change a scene's frames, and by how much: as it was measured, in ten lines, and as JSON.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/advice.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "sightline/tools/report/readable.h"
#include "sightline/tools/scene/json_text.h"

namespace sightline::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kMostLines = 10;
/// What was measured, what limits, smaller changes, what makes no difference, what was not tried.
constexpr size_t kOtherLines = 5;
constexpr const char* kKindNames[] = {"stage", "bake", "split", "merge"};

/// What to do about a stage: it is kept or turned on if it saves, and else turned off or left off.
std::string deedOf(const Advice& advice) {
    const bool good = advice.saves > 0;
    std::string deed;
    switch (advice.kind) {
        case Advice::Kind::kStage:
            deed = std::string(advice.done ? good ? "keep " : "turn off " : good ? "turn on " : "leave off ");
            break;
        case Advice::Kind::kBake:
            deed = good ? "bake " : "do not bake ";
            break;
        case Advice::Kind::kSplit:
            deed = good ? "split " : "do not split ";
            break;
        case Advice::Kind::kMerge:
            deed = good ? "merge " : "do not merge ";
            break;
    }
    return deed + advice.what;
}

std::string adviceLine(const Advice& advice, double frame) {
    const bool kept = advice.done && advice.saves > 0, off = advice.done && advice.saves < 0;
    std::string line = deedOf(advice);
    if (!advice.how.empty() && !kept && (advice.saves > 0 || off)) line += " (" + advice.how + ")";
    const double by = std::abs(advice.saves);
    if (kept) {
        line += fmt::format(": without it a frame takes {} ms more, {} times as long", readable(by, 3),
                            readable(1 + by / frame, 2));
        if (!advice.helps.empty()) line += fmt::format("; it spares {}", advice.helps);
    } else if (advice.saves > 0 || off) {
        line += fmt::format(": saves {} ms a frame, {:.0f} %", readable(by, 3), 100 * by / frame);
    } else {
        line += fmt::format(": it would cost {} ms a frame, {:.0f} %", readable(by, 3), 100 * by / frame);
    }
    return line + fmt::format(" (+- {})", readable(advice.spread, 2));
}

/// Those that matter, the largest first, as far as there are lines; then the others.
std::vector<const Advice*> ranked(const AdviceRun& run, size_t& shown) {
    std::vector<const Advice*> order;
    for (const Advice& advice : run.advice) order.push_back(&advice);
    const auto weight = [&](const Advice* advice) {
        return matters(*advice, run.frame_milliseconds) ? std::abs(advice->saves) : -1;
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](const Advice* a, const Advice* b) { return weight(a) > weight(b); });
    shown = static_cast<size_t>(std::count_if(run.advice.begin(), run.advice.end(), [&](const Advice& advice) {
        return matters(advice, run.frame_milliseconds);
    }));
    shown = std::min(shown, kMostLines - kOtherLines);
    return order;
}

}  // namespace

bool matters(const Advice& advice, double frame_milliseconds) {
    return std::abs(advice.saves) > std::max(2 * advice.spread, 0.01 * frame_milliseconds);
}

std::string adviceText(const AdviceRun& run) {
    std::string text = fmt::format(
        "measured: {} at {}x{}, the reference renderer on {}, medians of {}: {} ms a frame, {} of it the "
        "query\n",
        counted(run.frames, "frame"), run.width, run.height, counted(run.threads, "thread"), run.rounds,
        readable(run.frame_milliseconds), readable(1e-3 * run.query_microseconds, 3));
    text += fmt::format("{} (confidence {:.0f} %)\n", verdictWords(run.bottleneck), 100 * run.bottleneck.confidence);
    size_t shown = 0;
    const std::vector<const Advice*> order = ranked(run, shown);
    for (size_t i = 0; i < shown; ++i) text += fmt::format("{}\n", adviceLine(*order[i], run.frame_milliseconds));
    std::string smaller, none;
    for (size_t i = shown; i < order.size(); ++i) {
        std::string& rest = matters(*order[i], run.frame_milliseconds) ? smaller : none;
        rest +=
            fmt::format("{}{} ({}{} +- {} ms)", rest.empty() ? "" : ", ", order[i]->what,
                        order[i]->saves > 0 ? "" : "+", readable(-order[i]->saves, 2), readable(order[i]->spread, 2));
    }
    if (!smaller.empty()) text += fmt::format("smaller ones: {}\n", smaller);
    if (!none.empty()) text += fmt::format("no difference to speak of: {}\n", none);
    std::string not_tried;
    for (const std::string& what : run.not_tried) not_tried += (not_tried.empty() ? "" : "; ") + what;
    if (!not_tried.empty()) text += fmt::format("not tried: {}\n", not_tried);
    return text;
}

std::string adviceJson(const AdviceRun& run) {
    Json out;
    out["schema"] = "sightline.advise/1";
    out["scene"] = {{"file", run.scene}, {"objects", run.objects}, {"triangles", run.triangles}};
    out["machine"] = run.machine;
    out["width"] = run.width;
    out["height"] = run.height;
    out["frames"] = run.frames;
    out["threads"] = run.threads;
    out["rounds"] = run.rounds;
    out["frame_milliseconds"] = run.frame_milliseconds;
    out["query_microseconds"] = run.query_microseconds;
    out["limits"] = verdictWords(run.bottleneck);
    out["confidence"] = run.bottleneck.confidence;
    out["advice"] = Json::array();
    size_t shown = 0;
    for (const Advice* advice : ranked(run, shown)) {
        Json row = {{"kind", kKindNames[static_cast<int>(advice->kind)]},
                    {"what", advice->what},
                    {"advice", deedOf(*advice)},
                    {"matters", matters(*advice, run.frame_milliseconds)},
                    {"in_use", advice->done},
                    {"saves_milliseconds", advice->saves},
                    {"spread_milliseconds", advice->spread}};
        if (!advice->how.empty()) row["how"] = advice->how;
        if (!advice->helps.empty()) row["benefits"] = advice->helps;
        out["advice"].push_back(std::move(row));
    }
    out["not_tried"] = run.not_tried;
    return jsonText(out, 1) + "\n";
}

}  // namespace sightline::tools
