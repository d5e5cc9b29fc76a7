// The page of two runs beside one another.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "sightline/report/compare_runs.h"
#include "sightline/report/film_files.h"
#include "sightline/report/page_assets.h"
#include "sightline/report/page_parts.h"
#include "sightline/report/page_sections.h"
#include "sightline/report/png.h"

namespace sightline {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kBudget = size_t{8} << 20;  // of the pictures of each run [bytes]
constexpr size_t kMostRows = 300;            // of objects that differ

/// Pictures of both runs for the pairs that both have some of.
struct Pictures {
    Film a, b;
    std::vector<size_t> pairs;  // that have pictures
};

Pictures picturesOf(const RunComparison& comparison, const RunFile& a, const RunFile& b) {
    std::vector<size_t> frames_a, frames_b;
    for (const FramePair& pair : comparison.pairs) frames_a.push_back(pair.a);
    const std::vector<std::string> ids = {"shaded", "plan", "heat-kept"};
    Pictures out;
    out.a = filmBeside(a, ids, frames_a, kBudget);
    for (size_t i = 0; i < comparison.pairs.size(); ++i)
        for (const Shot& shot : out.a.shots)
            if (shot.frame == comparison.pairs[i].a) {
                out.pairs.push_back(i);
                frames_b.push_back(comparison.pairs[i].b);
            }
    std::vector<size_t> ascending = frames_b;
    std::sort(ascending.begin(), ascending.end());
    out.b = filmBeside(b, ids, ascending, kBudget);
    return out;
}

std::vector<Chart> chartsOf(const RunComparison& comparison, const CullRun& a, const CullRun& b) {
    Chart time{"time-chart", "Time of the query in each frame", "µs", {{"A", "one", {}}, {"B", "two", {}}}};
    Chart ratio{"ratio-chart", "Time of B over time of A", "times A’s", {{"B over A", "ink", {}}}};
    Chart kept{"kept-chart", "Objects kept in each frame", "objects", {{"A", "one", {}}, {"B", "two", {}}}};
    Chart apart{"apart-chart",
                "Objects that only one of them kept",
                "objects",
                {{"only A", "one", {}, true}, {"only B", "two", {}, true}}};
    for (const FramePair& pair : comparison.pairs) {
        const FrameResult &in_a = a.frames[pair.a], &in_b = b.frames[pair.b];
        time.series[0].values.push_back(in_a.query_microseconds);
        time.series[1].values.push_back(in_b.query_microseconds);
        ratio.series[0].values.push_back(pair.ratio);
        kept.series[0].values.push_back(static_cast<double>(in_a.visible.size()));
        kept.series[1].values.push_back(static_cast<double>(in_b.visible.size()));
        apart.series[0].values.push_back(static_cast<double>(pair.only_a.size()));
        apart.series[1].values.push_back(static_cast<double>(pair.only_b.size()));
    }
    return {time, ratio, kept, apart};
}

std::string over(const std::optional<double>& value) {
    return value && std::isfinite(*value) ? fmt::format("{:.3f}×", *value) : std::string("–");
}

std::string sides(const RunComparison& c, const RunFile& a, const RunFile& b) {
    std::string rows;
    const auto row = [&](const char* what, const std::string& in_a, const std::string& in_b) {
        rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td></tr>", what, in_a, in_b);
    };
    const auto both = [&](const char* what, const auto& of) { row(what, of(a.run), of(b.run)); };
    row("file", escapeHtml(a.file), escapeHtml(b.file));
    both("scene", [](const CullRun& run) { return escapeHtml(run.scene); });
    both("objects", [](const CullRun& run) { return number(run.objects); });
    both("triangles", [](const CullRun& run) { return number(run.triangles); });
    both("frames",
         [](const CullRun& run) { return number(run.frames.size()) + (run.interrupted ? ", interrupted" : ""); });
    row("frames without a partner", number(c.unpaired_a), number(c.unpaired_b));
    both("viewport", [](const CullRun& run) { return fmt::format("{} × {}", run.width, run.height); });
    both("image shift, pixels", [](const CullRun& run) { return fmt::format("{}", run.jitter); });
    both("occlusion buffer, longer side at most", [](const CullRun& run) { return number(run.occlusion_size); });
    both("queries a frame", [](const CullRun& run) { return fmt::format("{}", run.repeat); });
    row("query, median µs", readable(c.median_a), readable(c.median_b));
    const double pairs = std::max<double>(1, static_cast<double>(c.pairs.size()));
    row("objects kept a frame", readable(double(c.kept_a) / pairs), readable(double(c.kept_b) / pairs));
    row("triangles a frame", readable(double(c.triangles_a) / pairs), readable(double(c.triangles_b) / pairs));
    row("over-estimate", over(c.over_estimate_a), over(c.over_estimate_b));
    row("false culls", number(c.false_a), number(c.false_b));
    return "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Both runs\"><table class=\"counts "
           "wide sides\"><thead><tr><td></td><th scope=\"col\"><i class=\"one swatch\"></i>A</th><th "
           "scope=\"col\"><i class=\"two swatch\"></i>B</th></tr></thead><tbody>" +
           rows + "</tbody></table></div>";
}

std::string differenceTable(const RunComparison& c) {
    if (c.differences.empty()) return "";
    std::string rows;
    for (size_t i = 0; i < std::min(c.differences.size(), kMostRows); ++i) {
        const RunComparison::Difference& row = c.differences[i];
        rows += fmt::format(
            "<tr><th scope=\"row\">{}</th><td class=\"path\">{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
            row.name.empty() ? fmt::format("object {}", row.id & ~(1ull << 63)) : escapeHtml(row.name),
            row.path == row.name ? "" : escapeHtml(row.path), row.id & ~(1ull << 63), row.only_a, row.only_b);
    }
    std::string rest;
    if (c.differences.size() > kMostRows)
        rest = fmt::format("<p class=\"soft\">and {} more, in the JSON</p>", number(c.differences.size() - kMostRows));
    return "<div class=\"scroll tall\" tabindex=\"0\" role=\"region\" aria-label=\"Objects that differ\"><table "
           "class=\"counts wide\"><thead><tr><th scope=\"col\">object</th><th scope=\"col\">path</th><th "
           "scope=\"col\">key</th><th scope=\"col\">frames, only A</th><th scope=\"col\">frames, only B</th></tr>"
           "</thead><tbody>" +
           rows + "</tbody></table></div>" + rest;
}

std::string player(const RunComparison& c, const Pictures& pictures) {
    std::string body = fmt::format(
        R"html(<div class="player"><button type="button" id="play" aria-pressed="false">Play</button>
<button type="button" id="back" aria-label="One frame back">‹</button>
<button type="button" id="forth" aria-label="One frame on">›</button>
<input type="range" id="frame" aria-label="Frame" min="0" max="{}" value="0" step="1">
<output id="at" for="frame"></output></div>)html",
        c.pairs.size() - 1);
    const auto figures = [&](const char* id, const char* what) {
        const auto has = [&](const Film& film) {
            return std::any_of(film.shots.begin(), film.shots.end(), [&](const Shot& shot) {
                return std::any_of(shot.images.begin(), shot.images.end(),
                                   [&](const FilmImage& image) { return image.id == id; });
            });
        };
        if (!has(pictures.a) && !has(pictures.b)) return;
        body += "<div class=\"pair\">";
        for (const char side : {'a', 'b'})
            if (has(side == 'a' ? pictures.a : pictures.b))
                body += fmt::format(
                    "<figure class=\"{}\"><img id=\"{}-{}\" alt=\"{} of run {}\"><figcaption>{}: {}</figcaption>"
                    "</figure>",
                    std::string(id) == "plan" ? "plan" : "", id, side, what, side == 'a' ? 'A' : 'B',
                    side == 'a' ? 'A' : 'B', what);
        body += "</div>";
    };
    figures("shaded", "what the camera sees");
    figures("heat-kept", "surfaces drawn for a pixel, with culling");
    figures("plan", "from above, by what culled each object");
    if (!pictures.a.shots.empty()) body += "<p class=\"soft\" id=\"stale\" hidden></p>";
    return body;
}

std::string dataOf(const RunComparison& c, const Pictures& pictures, const std::vector<Chart>& charts) {
    Json data;
    data["frames"] = c.pairs.size();
    data["labels"] = Json::array();
    for (const FramePair& pair : c.pairs)
        data["labels"].push_back(
            fmt::format("frame {} of A, {} of B: B takes {:.3g} times as long", pair.a, pair.b, pair.ratio));
    data["charts"] = Json::object();
    for (const Chart& chart : charts)
        for (const ChartSeries& series : chart.series)
            data["charts"][chart.id].push_back(
                {{"name", series.name}, {"unit", chart.unit}, {"values", series.values}});
    data["rows"] = Json::array();
    data["pictures"] = Json::array();
    for (const size_t i : pictures.pairs) {
        Json images;
        const auto take = [&](const Film& film, size_t frame, const char* side) {
            for (const Shot& shot : film.shots)
                if (shot.frame == frame)
                    for (const FilmImage& image : shot.images) images[image.id + side] = dataUri(image.bytes);
        };
        take(pictures.a, c.pairs[i].a, "-a");
        take(pictures.b, c.pairs[i].b, "-b");
        data["pictures"].push_back({{"frame", i}, {"images", std::move(images)}});
    }
    return embedded(data.dump(-1, ' ', true, Json::error_handler_t::replace));
}

}  // namespace

std::string comparePage(const RunComparison& c, const RunFile& a, const RunFile& b) {
    const Pictures pictures = picturesOf(c, a, b);
    const std::vector<Chart> charts = chartsOf(c, a.run, b.run);
    std::string verdict;
    for (const std::string& sentence : c.verdict) verdict += "<span>" + escapeHtml(sentence) + "</span>";
    std::string page = pageHead("Comparison of " + sceneTitle(a.run.scene));
    page += fmt::format(
        "<header class=\"page\"><h1>Two runs of {}</h1><p class=\"soft\"><b>A</b> {}, <b>B</b> {}; {} frames have the "
        "same camera in both</p><div class=\"verdict {}\" role=\"status\"><strong>{}</strong>{}</div></header><main>",
        sceneTitle(a.run.scene), escapeHtml(a.file), escapeHtml(b.file), c.pairs.size(), c.ok ? "good" : "bad",
        c.ok ? "B passes: no new false culls" : "B fails", verdict);
    page += "<div class=\"tiles\">" +
            tile(fmt::format("{:.3g}×", c.ratio),
                 fmt::format("time of B over A, median; {:.3g} to {:.3g} in the middle eight tenths", c.ratio_low,
                             c.ratio_high)) +
            tile(number(c.only_a), "times an object only A kept") +
            tile(number(c.only_b), "times an object only B kept") +
            tile(number(c.new_false), "false culls of B that A has not") + "</div>";
    if (!c.pairs.empty()) {
        page += card("film", "Frame by frame", player(c, pictures));
        const auto part = [](const Chart& chart, const char* heading) {
            return card(chart.id.substr(0, chart.id.find('-')), heading, chartHtml(chart) + chartLegend(chart));
        };
        page += "<div class=\"pair cards\">" + part(charts[0], "Query, µs") +
                part(charts[1], "Time of B over time of A") + part(charts[2], "Objects kept") +
                part(charts[3], "Objects that only one kept") + "</div>";
    }
    page += card("sides", "Both runs", sides(c, a, b)) + card("differ", "Objects that differ", differenceTable(c));
    return page + "</main><footer>Made by Sightline.</footer><script type=\"application/json\" id=\"data\">" +
           dataOf(c, pictures, charts) + "</script><script>" + kPageScript + "</script></body></html>\n";
}

}  // namespace sightline
