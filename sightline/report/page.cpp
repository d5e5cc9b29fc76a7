// The report: one HTML page that needs no network and shows what was culled, by what, at which cost, and the proof.
// SPDX-License-Identifier: MIT
#include "sightline/report/page.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>

#include <fmt/core.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sightline/report/chart.h"
#include "sightline/report/page_assets.h"
#include "sightline/report/page_parts.h"
#include "sightline/report/picture.h"
#include "sightline/report/plan.h"

namespace sightline {
namespace {

using Json = nlohmann::ordered_json;

constexpr uint32_t kPlanSide = 480;  // [pixels]

double mean(const Image<float>& image) {
    double sum = 0;
    for (const float value : image.pixels) sum += value;
    return image.pixels.empty() ? 0 : sum / static_cast<double>(image.pixels.size());
}

/// One frame as it is shown in the player.
struct Shot {
    size_t frame = 0;
    PictureMaker::Frame drawn;
    Image<glm::u8vec4> plan;
};

View pictureView(const CullRun& run, const FrameResult& frame, const PageSettings& settings) {
    const double scale =
        std::min({double(settings.picture_width) / run.width, double(settings.picture_limit) / run.height});
    View view = makeView(frame.camera, run.width, run.height);  // the projection keeps the frame's aspect
    view.width = std::max(1u, static_cast<uint32_t>(std::lround(run.width * scale)));
    view.height = std::max(1u, static_cast<uint32_t>(std::lround(run.height * scale)));
    return view;
}

std::vector<Shot> drawShots(const Scene& scene, const CullRun& run, const PageSettings& settings) {
    const std::vector<size_t> chosen = pictureFrames(run, settings.most_pictures);
    const PictureMaker maker(scene);
    std::vector<View> views;
    std::vector<std::span<const uint8_t>> reasons;
    for (const size_t frame : chosen) {
        views.push_back(pictureView(run, run.frames[frame], settings));
        reasons.push_back(run.frames[frame].reasons);
    }
    const PlanArea area = planArea(maker.bounds(), reasons, views);
    std::vector<Shot> shots(chosen.size());
    std::atomic<size_t> done{0};
    const auto draw = [&](size_t i) {
        shots[i].frame = chosen[i];
        shots[i].drawn = maker.draw(views[i], reasons[i]);
        shots[i].plan = drawPlan(maker.bounds(), reasons[i], views[i], area, kPlanSide);
        if (settings.progress) settings.progress(++done, shots.size());
    };
    if (settings.for_each) settings.for_each(shots.size(), draw);
    else
        for (size_t i = 0; i < shots.size(); ++i) draw(i);
    return shots;
}

/// The value that both heat maps of all shots show brightest: one pixel in 500 may lie above it.
double heatScale(const std::vector<Shot>& shots) {
    std::vector<float> values;
    for (const Shot& shot : shots)
        values.insert(values.end(), shot.drawn.all.pixels.begin(), shot.drawn.all.pixels.end());
    if (values.empty()) return 1;
    const auto place = values.begin() + static_cast<ptrdiff_t>((values.size() - 1) * 499 / 500);
    std::nth_element(values.begin(), place, values.end());
    return std::max(2.0, std::ceil(static_cast<double>(*place)));
}

/// The texts that change with the frame, by the id of their element.
Json shotTexts(const Shot& shot, const CullRun& run) {
    const FrameResult& frame = run.frames[shot.frame];
    Json texts;
    texts["at"] = fmt::format("frame {} of {}", shot.frame, run.frames.size());
    texts["kept"] = fmt::format("{} of {} objects kept", number(frame.visible.size()), number(run.objects));
    if (frame.verification)
        texts["kept"] = texts["kept"].get<std::string>() +
                        fmt::format(", {} exactly visible", number(frame.verification->exactly_visible));
    texts["depth-all"] = fmt::format("{:.2f}", mean(shot.drawn.all));
    texts["depth-kept"] = fmt::format("{:.2f}", mean(shot.drawn.kept));
    texts["same"] = shot.drawn.same ? "The picture with culling is the same, sample by sample."
                                    : "The picture with culling differs.";
    for (int stage = 0; stage < kStageCount; ++stage) {
        if (!(run.stages >> stage & 1)) continue;
        const StageRow& row = frame.stages[stage];
        texts[fmt::format("tested-{}", stage)] = number(row.tested);
        texts[fmt::format("culled-{}", stage)] = number(row.culled);
        texts[fmt::format("doubt-{}", stage)] = number(row.doubt);
        texts[fmt::format("time-{}", stage)] = fmt::format("{:.1f}", row.microseconds);
    }
    texts["query-time"] = fmt::format("{:.1f}", frame.query_microseconds);
    texts["query-culled"] = number(run.objects - frame.visible.size());
    return texts;
}

Json pageData(const std::vector<Shot>& shots, const CullRun& run, double scale) {
    Json data;
    data["frames"] = run.frames.size();
    data["pictures"] = Json::array();
    for (const Shot& shot : shots) {
        Json entry;
        entry["frame"] = shot.frame;
        entry["images"] = {{"shaded", dataUri(encodePng(shot.drawn.shaded))},
                           {"heat-all", dataUri(encodePng(heatMap(shot.drawn.all, scale)))},
                           {"heat-kept", dataUri(encodePng(heatMap(shot.drawn.kept, scale)))},
                           {"plan", dataUri(encodePng(shot.plan))}};
        entry["texts"] = shotTexts(shot, run);
        data["pictures"].push_back(std::move(entry));
    }
    return data;
}

std::string verdict(const CullRun& run) {
    const auto sum = sumVerification(run);
    if (!sum)
        return "<div class=\"verdict\"><strong>Not verified</strong><span>Run it with <code>--verify</code> to let "
               "two witnesses judge every cull.</span></div>";
    const bool sound = sum->false_culls == 0;
    return fmt::format(
        "<div class=\"verdict {}\" role=\"status\"><strong>{} of {} culled objects {} visible</strong>"
        "<span>proof by {} rays and {} id-buffer samples over {} frames</span></div>",
        sound ? "good" : "bad", number(sum->false_culls), number(sum->culled),
        sum->false_culls == 1 || sound ? "was" : "were", number(sum->rays), number(sum->id_samples), run.frames.size());
}

struct Means {
    double visible = 0, triangles = 0, median_query = 0;
    StageRow stages[kStageCount];  // sums, not means
};

Means meansOf(const CullRun& run) {
    Means means;
    std::vector<double> times;
    const auto frames = static_cast<double>(run.frames.size());
    for (const FrameResult& frame : run.frames) {
        means.visible += static_cast<double>(frame.visible.size()) / frames;
        means.triangles += static_cast<double>(frame.triangles) / frames;
        times.push_back(frame.query_microseconds);
        for (int stage = 0; stage < kStageCount; ++stage) {
            means.stages[stage].tested += frame.stages[stage].tested;
            means.stages[stage].culled += frame.stages[stage].culled;
            means.stages[stage].doubt += frame.stages[stage].doubt;
            means.stages[stage].microseconds += frame.stages[stage].microseconds;
        }
    }
    std::sort(times.begin(), times.end());
    if (!times.empty()) means.median_query = 0.5 * (times[times.size() / 2] + times[(times.size() - 1) / 2]);
    return means;
}

std::string tiles(const CullRun& run, const Means& means) {
    std::string out = "<div class=\"tiles\">";
    out += tile(readable(std::round(means.visible)),
                fmt::format("objects kept a frame, {} of the scene", percent(means.visible, double(run.objects))));
    out += tile(percent(means.triangles, double(run.triangles)), "of the scene's triangles submitted");
    out += tile(fmt::format("{} µs", readable(std::round(means.median_query))), "a query, median over the frames");
    if (const auto sum = sumVerification(run))
        out += tile(fmt::format("{:.2f}×", sum->overEstimate()), "reported ÷ exactly visible objects");
    return out + "</div>";
}

std::string player(const CullRun& run, const Json& first, size_t pictures, double scale) {
    const auto image = [&](const char* id) { return first["images"][id].get<std::string>(); };
    std::string legend;
    for (int i = 0; i < kPlanColours; ++i) {
        if (i > 0 && !(run.stages >> (i - 1) & 1)) continue;
        const glm::u8vec4 c = kPlanPalette[i];
        legend +=
            fmt::format("<span><i style=\"background:rgb({},{},{})\"></i>{}</span>", c.x, c.y, c.z, kPlanNames[i]);
    }
    return fmt::format(
        R"html(<section class="card" aria-labelledby="h-frames"><h2 id="h-frames">Frame by frame</h2>
<div class="player"><button type="button" id="play">Play</button>
<label for="frame" class="soft">Frame</label><input type="range" id="frame" min="0" max="{}" value="0" step="1">
<output id="at" for="frame"></output></div>
<div class="stage"><figure><img id="shaded" alt="The scene as the camera sees it" src="{}">
<figcaption><b id="kept"></b>. <span id="same"></span></figcaption></figure>
<figure class="plan"><img id="plan" alt="The scene from above, objects coloured by what culled them" src="{}">
<figcaption>From above, around the cameras; this view in red.<div class="legend">{}</div></figcaption></figure></div>
</section>
<section class="card" aria-labelledby="h-heat"><h2 id="h-heat">Depth complexity: surfaces drawn for a pixel</h2>
<div class="pair"><figure><img id="heat-all" alt="Heat map of surfaces drawn for each pixel without culling" src="{}">
<figcaption>Without culling: <b id="depth-all"></b> a pixel on average</figcaption></figure>
<figure><img id="heat-kept" alt="Heat map of surfaces drawn for each pixel with culling" src="{}">
<figcaption>With culling: <b id="depth-kept"></b> a pixel on average</figcaption></figure></div>
{}</section>)html",
        pictures - 1, image("shaded"), image("plan"), legend, image("heat-all"), image("heat-kept"), heatLegend(scale));
}

std::string stageTable(const CullRun& run, const Means& means) {
    const auto frames = static_cast<double>(run.frames.size());
    std::string rows;
    for (int stage = 0; stage < kStageCount; ++stage) {
        if (!(run.stages >> stage & 1)) continue;
        const StageRow& sum = means.stages[stage];
        const auto average = [&](uint64_t value) { return readable(std::round(double(value) / frames)); };
        rows += fmt::format(
            "<tr><td>{}</td><td id=\"tested-{}\"></td><td id=\"culled-{}\"></td><td id=\"doubt-{}\"></td>"
            "<td id=\"time-{}\"></td><td class=\"apart\">{}</td><td>{}</td><td>{}</td><td>{:.1f}</td></tr>",
            kStageNames[stage], stage, stage, stage, stage, average(sum.tested), average(sum.culled),
            average(sum.doubt), sum.microseconds / frames);
    }
    return fmt::format(
        R"html(<section class="card" aria-labelledby="h-stages"><h2 id="h-stages">What each stage did</h2>
<div class="scroll"><table><thead><tr><th></th><th colspan="4" scope="colgroup">this frame</th>
<th colspan="4" scope="colgroup" class="apart">mean over the frames</th></tr>
<tr><th scope="col">stage</th><th scope="col">tested</th><th scope="col">culled</th><th scope="col">in doubt</th>
<th scope="col">µs</th><th scope="col" class="apart">tested</th><th scope="col">culled</th>
<th scope="col">in doubt</th><th scope="col">µs</th></tr></thead>
<tbody>{}<tr><td>whole query</td><td>{}</td><td id="query-culled"></td><td></td><td id="query-time"></td>
<td class="apart">{}</td><td>{}</td><td></td><td>{:.1f}</td></tr></tbody></table></div>
<p class="soft">An object in doubt is kept. The stages are timed in a run of their own, the whole query without that;
in place of its mean the median stands.</p>
<h2>Triangles submitted against triangles in the scene</h2>
<div class="share" role="img" aria-label="{} of the triangles"><div style="width:{:.4f}%"></div></div>
<p>{} of {} triangles a frame: {}</p></section>)html",
        rows, number(run.objects), number(run.objects), readable(std::round(double(run.objects) - means.visible)),
        means.median_query, percent(means.triangles, double(run.triangles)),
        run.triangles ? 100 * means.triangles / double(run.triangles) : 0.0, readable(std::round(means.triangles)),
        number(run.triangles), percent(means.triangles, double(run.triangles)));
}

std::string charts(const CullRun& run) {
    Chart kept{"kept-chart", "Objects kept in each frame", "objects", {{"kept", "one", {}}}};
    Chart time{"time-chart", "Time of the query in each frame", "µs", {{"query", "one", {}}}};
    std::vector<double> exact;
    for (const FrameResult& frame : run.frames) {
        kept.series[0].values.push_back(static_cast<double>(frame.visible.size()));
        time.series[0].values.push_back(frame.query_microseconds);
        if (frame.verification) exact.push_back(static_cast<double>(frame.verification->exactly_visible));
    }
    std::string legend = "<span><i class=\"one\"></i>kept</span>";
    if (exact.size() == run.frames.size()) {
        kept.series.push_back({"exactly visible", "two", exact});
        legend += "<span><i class=\"two\"></i>exactly visible, as the witnesses saw it</span>";
    }
    return fmt::format(
        R"html(<div class="pair"><section class="card" aria-labelledby="h-kept"><h2 id="h-kept">Objects kept</h2>{}
<div class="legend">{}</div></section>
<section class="card" aria-labelledby="h-time"><h2 id="h-time">Query, µs</h2>{}
<div class="legend"><span><i class="one"></i>one thread, {}</span></div></section></div>)html",
        chartSvg(kept), legend, chartSvg(time),
        run.repeat == 1 ? std::string("one run") : fmt::format("median of {} runs", run.repeat));
}

std::string listed(const std::vector<size_t>& frames) { return fmt::format("{}", fmt::join(frames, ", ")); }

std::string samplesPerPixel(const Verification& sum) {
    if (sum.least_supersampling == sum.most_supersampling)
        return fmt::format("{0}×{0} a pixel", sum.most_supersampling);
    return fmt::format("{0}×{0} to {1}×{1} a pixel", sum.least_supersampling, sum.most_supersampling);
}

std::string howVerified(const CullRun& run, const std::vector<size_t>& pictured) {
    const auto row = [](const std::string& term, const std::string& text) {
        return fmt::format("<dt>{}</dt><dd>{}</dd>", term, text);
    };
    std::string out = "<section class=\"card\" aria-labelledby=\"h-how\"><h2 id=\"h-how\">How it was verified</h2><dl>";
    if (const auto sum = sumVerification(run)) {
        out += row("First witness",
                   fmt::format("{} rays, {} of them aimed at what was culled, the others spread over the frames. "
                               "Single-sided back faces are passed through; masked and blended surfaces are seen and "
                               "passed.",
                               number(sum->rays), number(sum->aimed_rays)));
        out +=
            row("Second witness", fmt::format("an id-buffer of {} samples, {}, drawn by a plain z-buffer that shares "
                                              "no code with the culling.",
                                              number(sum->id_samples), samplesPerPixel(*sum)));
        out +=
            row("Judged", fmt::format("{} times an object was culled in a frame; {} of them were seen by a witness. {} "
                                      "sightings did not hold in exact arithmetic: edges that graze, and surfaces "
                                      "that float cannot tell apart.",
                                      number(sum->culled), number(sum->false_culls), number(sum->unconfirmed)));
        out +=
            row("Over-estimate", fmt::format("{} objects reported, {} seen by a witness: {:.3f}.",
                                             number(sum->reported), number(sum->exactly_visible), sum->overEstimate()));
    } else {
        out += row("Verified", "no; <code>--verify</code> was not given");
    }
    out +=
        row("Image shift", fmt::format("the answers hold for any shift of the image by up to {} pixels", run.jitter));
    if (!run.command.empty()) out += row("Repeat it", "<code>" + escapeHtml(run.command) + "</code>");
    out += row("Pictures", pictured.size() == run.frames.size() ? "every frame"
                                                                : fmt::format("{} of {} frames: {}", pictured.size(),
                                                                              run.frames.size(), listed(pictured)));
    out += row("Numbers", "in <code>cull.json</code> beside this page");
    return out + "</dl></section>";
}

}  // namespace

std::vector<size_t> pictureFrames(const CullRun& run, uint32_t most) {
    const size_t count = std::min<size_t>(most, run.frames.size());
    std::set<size_t> chosen;
    for (size_t i = 0; i < run.frames.size() && chosen.size() < count; ++i)
        if (run.frames[i].verification && run.frames[i].verification->false_culls > 0) chosen.insert(i);
    const size_t free = count - chosen.size();
    for (size_t i = 0; i < free; ++i) chosen.insert(free > 1 ? i * (run.frames.size() - 1) / (free - 1) : 0);
    return {chosen.begin(), chosen.end()};
}

std::string reportPage(const Scene& scene, const CullRun& run, const PageSettings& settings) {
    const std::vector<Shot> shots = drawShots(scene, run, settings);
    const double scale = heatScale(shots);
    const Json data = pageData(shots, run, scale);
    const Means means = meansOf(run);
    std::vector<size_t> pictured;
    for (const Shot& shot : shots) pictured.push_back(shot.frame);

    std::string json = data.dump(-1, ' ', true, Json::error_handler_t::replace);
    for (size_t at = json.find("</"); at != std::string::npos; at = json.find("</", at)) json.replace(at, 2, "<\\/");
    const std::string name = sceneTitle(run.scene);
    std::string page = pageHead(name);
    page += fmt::format(
        R"html(<header class="page"><h1>{}</h1><p class="soft">{} objects, {} triangles; {} frames of {} × {}</p>{}</header>
<main>)html",
        name, number(run.objects), number(run.triangles), run.frames.size(), run.width, run.height, verdict(run));
    page += tiles(run, means);
    if (!shots.empty()) page += player(run, data["pictures"][0], shots.size(), scale);
    page += stageTable(run, means) + charts(run) + howVerified(run, pictured);
    page += "</main><footer>Made by Sightline.</footer><script type=\"application/json\" id=\"data\">" + json +
            "</script><script>" + kPageScript + "</script></body></html>\n";
    return page;
}

}  // namespace sightline
