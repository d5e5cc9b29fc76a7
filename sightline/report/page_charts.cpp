// The charts of a report's page, and the two frames that stand out.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "sightline/report/page_parts.h"
#include "sightline/report/page_sections.h"

namespace sightline {
namespace {

constexpr size_t kMostNames = 12;  // of kept objects that nobody saw

double overEstimateOf(const FrameResult& frame) {
    if (!frame.verification) return std::nan("");
    const auto seen = static_cast<double>(frame.verification->exactly_visible);
    const auto kept = static_cast<double>(frame.visible.size());
    return seen > 0 ? kept / seen : std::nan("");
}

/// A measure of all frames and what it is called.
struct Measure {
    const char* name;
    double (*of)(const FrameResult&);
};

constexpr Measure kMeasures[] = {
    {"tree nodes visited", [](const FrameResult& f) { return double(f.nodes_visited); }},
    {"occluder triangles rasterized", [](const FrameResult& f) { return double(f.occluder_triangles); }},
    {"seam pixels resolved", [](const FrameResult& f) { return double(f.seam_pixels); }},
    {"objects kept", [](const FrameResult& f) { return double(f.visible.size()); }},
    {"triangles submitted", [](const FrameResult& f) { return double(f.triangles); }},
};

/// "2.3×", or how it stands to a median of nothing.
std::string times(double value, double median) {
    if (median > 0) return fmt::format("{:.3g}×", value / median);
    return value > 0 ? "where the median is 0" : "1×";
}

std::string measureTable(const CullRun& run, const FrameResult& frame) {
    std::string rows;
    for (const Measure& measure : kMeasures) {
        std::vector<double> all;
        for (const FrameResult& other : run.frames) all.push_back(measure.of(other));
        if (std::all_of(all.begin(), all.end(), [](double value) { return value == 0; })) continue;
        const double median = medianOf(all), value = measure.of(frame);
        rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td></tr>", measure.name,
                            readable(value), readable(median), times(value, median));
    }
    return "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Against the median\"><table "
           "class=\"counts\"><thead><tr><td></td><th scope=\"col\">this frame</th><th scope=\"col\">median</th><th "
           "scope=\"col\">ratio</th></tr></thead><tbody>" +
           rows + "</tbody></table></div>";
}

/// What the query said of the frame itself, where runs carry that.
template <class Frame>
std::string notesOf(const Frame& frame) {
    std::string out;
    if constexpr (requires { frame.notes.begin(); })
        for (const auto& note : frame.notes) out += "<li>" + escapeHtml(note) + "</li>";
    return out.empty() ? out : "<ul>" + out + "</ul>";
}

std::string keptUnseen(const FrameResult& frame, const std::function<std::string(uint32_t)>& label) {
    if (!frame.verification || frame.verification->kept_unseen.empty()) return "";
    const std::vector<uint32_t>& unseen = frame.verification->kept_unseen;
    std::string out;
    for (size_t i = 0; i < std::min(unseen.size(), kMostNames); ++i)
        out += "<li>" + escapeHtml(label(unseen[i])) + "</li>";
    if (unseen.size() > kMostNames) out += fmt::format("<li>and {} more</li>", number(unseen.size() - kMostNames));
    return fmt::format("<p>Kept, though no witness saw {}:</p><ul class=\"names\">{}</ul>",
                       unseen.size() == 1 ? "it" : "them", out);
}

std::string goTo(size_t frame) {
    return fmt::format("<button type=\"button\" class=\"go\" data-frame=\"{0}\">Show frame {0}</button>", frame);
}

}  // namespace

std::vector<Chart> runCharts(const CullRun& run) {
    Chart time{"time-chart", "Time of each stage in each frame", "µs", {}};
    Chart kept{"kept-chart", "Objects kept and exactly visible in each frame", "objects", {{"kept", "one", {}}}};
    Chart triangles{"triangle-chart", "Triangles submitted in each frame", "triangles", {{"submitted", "one", {}}}};
    Chart loose{"loose-chart", "Objects kept for each exactly visible one", "kept for one that is visible", {}};
    for (int stage = 0; stage < kStageCount; ++stage)
        if (run.stages >> stage & 1)
            time.series.push_back({kStageNames[stage], fmt::format("stage-{}", stage + 1), {}, true});
    time.series.push_back({"whole query", "ink", {}});
    ChartSeries exact{"exactly visible", "two", {}}, ratio{"over-estimate", "two", {}};
    for (const FrameResult& frame : run.frames) {
        size_t place = 0;
        for (int stage = 0; stage < kStageCount; ++stage)
            if (run.stages >> stage & 1) time.series[place++].values.push_back(frame.stages[stage].microseconds);
        time.series[place].values.push_back(frame.query_microseconds);
        kept.series[0].values.push_back(static_cast<double>(frame.visible.size()));
        triangles.series[0].values.push_back(static_cast<double>(frame.triangles));
        exact.values.push_back(frame.verification ? double(frame.verification->exactly_visible) : std::nan(""));
        ratio.values.push_back(overEstimateOf(frame));
    }
    std::vector<Chart> charts = {time, kept, triangles};
    if (sumVerification(run)) {
        charts[1].series.push_back(exact);
        loose.series.push_back(ratio);
        charts.push_back(loose);
    }
    return charts;
}

std::string chartSection(const CullRun& run, const std::vector<Chart>& charts) {
    if (run.frames.empty()) return "";
    const auto part = [](const Chart& chart, const std::string& heading, const std::string& note) {
        return card(chart.id.substr(0, chart.id.find('-')), heading,
                    chartHtml(chart) + chartLegend(chart) + (note.empty() ? "" : "<p class=\"soft\">" + note + "</p>"));
    };
    double submitted = 0;
    for (const FrameResult& frame : run.frames)
        submitted += static_cast<double>(frame.triangles) / static_cast<double>(run.frames.size());
    const std::string share = fmt::format(
        "<div class=\"share\" role=\"img\" aria-label=\"{0} of the triangles\"><div "
        "style=\"width:{1:.4f}%\"></div></div>"
        "{2} of {3} triangles a frame: {0}",
        percent(submitted, double(run.triangles)), run.triangles ? 100 * submitted / double(run.triangles) : 0.0,
        readable(std::round(submitted)), number(run.triangles));
    std::string out =
        part(charts[0], "What each stage cost, µs a frame",
             fmt::format("One thread, {}. The stages are timed in a run of their own.",
                         run.repeat == 1 ? std::string("one run") : fmt::format("median of {} runs", run.repeat)));
    out += "<div class=\"pair cards\">" + part(charts[1], "Objects kept", "") +
           part(charts[2], "Triangles submitted against triangles in the scene", share) + "</div>";
    if (charts.size() > 3) out += part(charts[3], "Over-estimate: objects kept for each exactly visible one", "");
    return out;
}

std::string explainedSection(const CullRun& run, const std::function<std::string(uint32_t)>& label) {
    if (run.frames.size() < 2) return "";
    size_t slow = 0, loose = run.frames.size();
    std::vector<double> queries, ratios;
    for (size_t i = 0; i < run.frames.size(); ++i) {
        queries.push_back(run.frames[i].query_microseconds);
        if (queries[i] > queries[slow]) slow = i;
        const double ratio = overEstimateOf(run.frames[i]);
        if (!std::isfinite(ratio)) continue;
        ratios.push_back(ratio);
        if (loose == run.frames.size() || ratio > overEstimateOf(run.frames[loose])) loose = i;
    }
    const FrameResult& slowest = run.frames[slow];
    std::string out =
        card("slowest", fmt::format("The slowest: frame {}", slow),
             fmt::format("<p><b>{} µs</b>, {} the median.{}</p>{}{}{}", readable(slowest.query_microseconds),
                         times(slowest.query_microseconds, medianOf(queries)),
                         slowest.budget_spent ? " It spent its work budget: some visible occluders were left out." : "",
                         notesOf(slowest), measureTable(run, slowest), goTo(slow)));
    if (loose < run.frames.size()) {
        const FrameResult& frame = run.frames[loose];
        uint64_t doubt = 0;
        for (const StageRow& row : frame.stages) doubt += row.doubt;
        out += card("loosest", fmt::format("The loosest: frame {}", loose),
                    fmt::format("<p><b>{} kept for {} exactly visible</b>: {:.2f}×, where the median is {:.2f}×. {} "
                                "object{} kept in doubt.</p>{}{}{}",
                                number(frame.visible.size()), number(frame.verification->exactly_visible),
                                overEstimateOf(frame), medianOf(ratios), number(doubt), doubt == 1 ? " was" : "s were",
                                loose == slow ? "" : notesOf(frame), keptUnseen(frame, label), goTo(loose)));
    }
    return "<div class=\"pair cards\">" + out + "</div>";
}

}  // namespace sightline
