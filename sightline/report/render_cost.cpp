// What hidden-surface methods cost, beside one another: bars of time and a table of counters.
// SPDX-License-Identifier: MIT
#include "sightline/report/render_cost.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/core.h>

#include "sightline/report/chart.h"
#include "sightline/report/page_parts.h"

namespace sightline {
namespace {

/// Powers of ten around what methods took, and where a time lies between them.
struct LogScale {
    double low = 0, high = 1;  // exponents

    explicit LogScale(const RenderRun& run) {
        double least = HUGE_VAL, most = 0;
        for (const MethodResult& result : run.methods) {
            least = std::min(least, result.milliseconds);
            most = std::max(most, result.milliseconds + result.prepare_milliseconds);
        }
        if (!(least <= most)) return;
        // The shortest bar is to be seen, too.
        low = std::floor(std::log10(std::max(0.5 * least, 1e-4)));
        high = std::max(low + 1, std::ceil(std::log10(std::max(most, 1e-4))));
    }
    /// [%]
    double at(double milliseconds) const {
        const double part = (std::log10(std::max(milliseconds, 1e-6)) - low) / (high - low);
        return 100 * std::clamp(part, 0.0, 1.0);
    }
};

std::string costText(const MethodResult& result) {
    std::string out = readable(result.milliseconds) + " ms";
    if (result.prepare_milliseconds > 0) out += fmt::format(" + {} to prepare", readable(result.prepare_milliseconds));
    return out;
}

/// True if all methods that count at all count the same, and they are two or more.
bool isCommon(const RenderRun& run, const CounterName& counter, uint64_t& common) {
    size_t methods = 0;
    common = 0;
    for (const MethodResult& result : run.methods) {
        const uint64_t value = counter.value(result.image.counters);
        if (value == 0) continue;
        if (methods++ > 0 && value != common) return false;
        common = value;
    }
    return methods > 1;
}

}  // namespace

std::string_view countingNote(const RenderRun& run) {
    const MethodResult* result = run.find(HiddenMethod::kZBuffer);
    if (!result || result->counted.generated == result->image.counters.generated) return "";
    return " There the z-buffer looks at the fragments that its hierarchy rejects unseen, and counts them as "
           "generated; "
           "in the runs that were timed it never sees them. It also accepts partly covered tiles there, so that fewer "
           "fragments are tested one by one.";
}

std::string costBars(const RenderRun& run) {
    const LogScale scale(run);
    std::string out, ticks;
    bool prepared = false;
    for (const MethodResult& result : run.methods) {
        const double frame = scale.at(result.milliseconds);
        const double both = scale.at(result.milliseconds + result.prepare_milliseconds);
        std::string bars = fmt::format("<div style=\"width:{:.3f}%\"></div>", frame);
        if (result.prepare_milliseconds > 0) {
            prepared = true;
            bars += fmt::format("<div style=\"width:{:.3f}%\"></div>", both - frame);
        }
        out += fmt::format("<span>{}</span><div class=\"share\">{}</div><span>{}</span>", result.name(), bars,
                           costText(result));
    }
    for (double power = scale.low; power <= scale.high; ++power)
        ticks += fmt::format("<span>{}</span>", readable(std::pow(10.0, power)));
    std::string legend = "<div class=\"legend\"><span><i class=\"one\"></i>a frame</span>";
    if (prepared) legend += "<span><i class=\"two\"></i>preparation that can be kept: building a tree</span>";
    return fmt::format(
        "<div class=\"costs\">{}<span></span><div class=\"scale\">{}</div><span>ms</span></div>{}<span>each step of "
        "the scale is ten times the one before</span></div>",
        out, ticks, legend);
}

std::string costTable(const RenderRun& run) {
    std::string head = "<th scope=\"col\"></th>", rows, commons;
    for (const MethodResult& result : run.methods) head += fmt::format("<th scope=\"col\">{}</th>", result.name());
    const auto row = [&](std::string_view title, auto&& cell) {
        rows += fmt::format("<tr><th scope=\"row\">{}</th>", title);
        for (const MethodResult& result : run.methods) rows += "<td>" + cell(result) + "</td>";
        rows += "</tr>";
    };
    const auto counts = [&](std::string_view title, auto&& value) {
        if (std::any_of(run.methods.begin(), run.methods.end(), [&](const MethodResult& r) { return value(r) > 0; }))
            row(title, [&](const MethodResult& r) { return value(r) > 0 ? number(value(r)) : "–"; });
    };
    row("ms a frame", [](const MethodResult& r) { return readable(r.milliseconds); });
    row("ms of preparation", [](const MethodResult& r) { return readable(r.prepare_milliseconds); });
    row("samples differing", [](const MethodResult& r) { return number(r.agreement.differing); });
    row("… at edges", [](const MethodResult& r) { return number(r.agreement.at_edges); });
    row("… ties", [](const MethodResult& r) { return number(r.agreement.ties); });
    row("… wrong", [](const MethodResult& r) { return number(r.agreement.wrong); });
    for (const CounterName& counter : counterNames()) {
        const auto* const heat = std::find(std::begin(kHeatNames), std::end(kHeatNames), counter.name);
        if (uint64_t common = 0; heat == std::end(kHeatNames) && isCommon(run, counter, common)) {
            commons += fmt::format("{}{} {}", commons.empty() ? "" : ", ", number(common), counter.title);
            continue;
        }
        counts(counter.title, [&](const MethodResult& r) { return counter.value(r.image.counters); });
        if (heat == std::end(kHeatNames)) continue;
        const auto counted = [&](const MethodResult& r) {
            return fragmentsOf(r.counted, static_cast<Heat>(heat - std::begin(kHeatNames)));
        };
        if (std::any_of(run.methods.begin(), run.methods.end(), [&](const MethodResult& r) {
                return counted(r) > 0 && counted(r) != counter.value(r.image.counters);
            }))
            counts("… in the counting run", counted);
    }
    std::string out = "<div class=\"scroll\" tabindex=\"0\"><table class=\"counts methods\"><thead><tr>" + head +
                      "</tr></thead><tbody>" + rows + "</tbody></table></div>";
    if (!commons.empty()) out += fmt::format("<p>The same for all methods that count it: {}.</p>", commons);
    return out + fmt::format(
                     "<p class=\"soft\">Times and counters are of the runs that were timed; bytes of depth, heat "
                     "maps and the rows that say so, of a counting run.{}</p>",
                     countingNote(run));
}

}  // namespace sightline
