// The sections of a report's page, each a piece of HTML.
// SPDX-License-Identifier: MIT
#include "sightline/report/page_sections.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "sightline/report/page_parts.h"
#include "sightline/report/plan.h"

namespace sightline {
namespace {

std::string planLegend(const CullRun& run) {
    std::string legend;
    for (int i = 0; i < kPlanColours; ++i)
        if (i == 0 || run.stages >> (i - 1) & 1)
            legend += fmt::format("<span><i class=\"stage-{}\"></i>{}</span>", i, kPlanNames[i]);
    return "<div class=\"legend\">" + legend + "<span><i class=\"in-view\"></i>in view</span></div>";
}

std::string figureOf(const char* id, const char* alt, const std::string& caption, const char* css = "") {
    return fmt::format("<figure class=\"{}\"><img id=\"{}\" alt=\"{}\"><figcaption>{}</figcaption></figure>", css, id,
                       alt, caption);
}

/// The values of the frame that change with it.
std::string facts(const CullRun& run) {
    const bool verified = sumVerification(run).has_value();
    const auto fact = [](const char* id, const char* name) {
        return fmt::format("<div><dt>{}</dt><dd id=\"{}\"></dd></div>", name, id);
    };
    return "<dl class=\"facts\">" + fact("at-kept", "objects kept") +
           (verified ? fact("at-exact", "exactly visible") : "") + fact("at-triangles", "triangles submitted") +
           fact("at-query", "query, µs") + "</dl>";
}

std::string samplesPerPixel(const Verification& sum) {
    if (sum.least_supersampling == sum.most_supersampling)
        return fmt::format("{0}×{0} a pixel", sum.most_supersampling);
    return fmt::format("{0}×{0} to {1}×{1} a pixel", sum.least_supersampling, sum.most_supersampling);
}

/// The looks of the picture; those of the occlusion buffer and of the windows only where they were drawn.
std::string looks(bool buffer, bool windows) {
    std::string text = R"html(<fieldset class="switch"><legend class="unseen">What the picture shows</legend>
<label><input type="radio" name="look" value="shaded" checked><span>As seen</span></label>
<label><input type="radio" name="look" value="culled"><span>Culled objects drawn through</span></label>
<label><input type="radio" name="look" value="objects"><span>One colour an object</span></label>)html";
    if (buffer)
        text += "\n<label><input type=\"radio\" name=\"look\" value=\"buffer\"><span>Occlusion buffer</span></label>";
    if (windows) text += "\n<label><input type=\"radio\" name=\"look\" value=\"windows\"><span>Windows</span></label>";
    return text + "</fieldset>";
}

}  // namespace

RunMeans meansOf(const CullRun& run) {
    RunMeans means;
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
    means.median_query = medianOf(times);
    return means;
}

std::string card(const std::string& id, const std::string& heading, const std::string& body) {
    if (body.empty()) return "";
    return fmt::format(
        "<section class=\"card\" id=\"{0}\" aria-labelledby=\"h-{0}\"><h2 id=\"h-{0}\">{1}</h2>{2}</section>\n", id,
        heading, body);
}

std::string verdictBox(const CullRun& run) {
    const auto sum = sumVerification(run);
    if (!sum)
        return "<div class=\"verdict\"><strong>Not verified</strong><span>Run it with <code>--verify</code> to let "
               "two witnesses judge every cull.</span></div>";
    const bool sound = sum->false_culls == 0;
    return fmt::format(
        "<div class=\"verdict {}\" role=\"status\"><strong>{} of {} culled objects {} visible</strong>"
        "<span>proof by {} rays and {} id-buffer samples over {} frames</span></div>",
        sound ? "good" : "bad", number(sum->false_culls), number(sum->culled), sum->false_culls == 1 ? "was" : "were",
        number(sum->rays), number(sum->id_samples), run.frames.size());
}

std::string interruptedBox(const CullRun& run) {
    if (!run.interrupted) return "";
    return fmt::format(
        "<div class=\"verdict note\" role=\"status\"><strong>The run was interrupted</strong><span>{} of {} frames "
        "were finished; all numbers here are of these.</span></div>",
        run.frames.size(), run.frames_wanted > run.frames.size() ? number(run.frames_wanted) : std::string("more"));
}

std::string statTiles(const CullRun& run, const RunMeans& means) {
    std::string out = "<div class=\"tiles\">";
    out += tile(readable(std::round(means.visible)),
                fmt::format("objects kept a frame, {} of the scene", percent(means.visible, double(run.objects))));
    out += tile(percent(means.triangles, double(run.triangles)), "of the scene’s triangles submitted");
    out += tile(fmt::format("{} µs", readable(std::round(means.median_query))), "a query, median over the frames");
    if (const auto sum = sumVerification(run))
        out += tile(fmt::format("{:.2f}×", sum->overEstimate()), "reported ÷ exactly visible objects");
    return out + "</div>";
}

std::string filmSection(const CullRun& run, const Film& film) {
    if (run.frames.empty()) return "";
    std::string body = fmt::format(
        R"html(<div class="player"><button type="button" id="play" aria-pressed="false">Play</button>
<button type="button" id="back" aria-label="One frame back">‹</button>
<button type="button" id="forth" aria-label="One frame on">›</button>
<input type="range" id="frame" aria-label="Frame" min="0" max="{}" value="0" step="1">
<output id="at" for="frame"></output></div>)html",
        run.frames.size() - 1);
    if (film.shots.empty()) return card("film", "Frame by frame", body + facts(run));
    const auto has = [&](const char* id) {
        return std::any_of(film.shots[0].images.begin(), film.shots[0].images.end(),
                           [&](const FilmImage& image) { return image.id == id; });
    };
    std::string picture = has("culled") ? looks(has("buffer"), has("windows")) : "";
    picture += fmt::format(
        "<figure><div class=\"screen\" style=\"aspect-ratio:{}/{}\"><img id=\"shaded\" alt=\"The scene as the camera "
        "sees it\">",
        film.width, film.height);
    if (has("objects"))
        picture += "<img id=\"objects\" hidden alt=\"The same picture, each object in a colour of its own\">";
    if (has("culled"))
        picture += "<img id=\"culled\" hidden alt=\"What was culled within the view, drawn through what hides it\">";
    if (has("buffer"))
        picture +=
            "<img id=\"buffer\" hidden alt=\"What the occlusion buffer claims: light is near, dark is far, blue is "
            "open\">";
    if (has("windows"))
        picture += "<img id=\"windows\" hidden alt=\"The windows through which cells are seen, over the picture\">";
    picture += "<span id=\"stale\" hidden></span></div><figcaption><span id=\"same\"></span>";
    if (has("buffer"))
        picture += fmt::format(
            "<span id=\"buffer-text\" hidden>What each pixel of the occlusion buffer hides, once all was drawn: what "
            "is "
            "farther than its grey, from light for the nearest claim to dark for the farthest. Blue hides nothing. The "
            "buffer’s longer side has at most {} pixels.</span>",
            run.occlusion_size);
    if (has("windows")) picture += "<span id=\"windows-text\" hidden></span>";
    picture += "</figcaption></figure>";
    std::string plans;
    if (has("plan"))
        plans += figureOf("plan", "The scene from above, objects coloured by what culled them",
                          "<span id=\"plan-text\"></span>", "plan");
    if (has("section"))
        plans += figureOf("section", "The scene from the side, objects coloured by what culled them",
                          "<span id=\"section-text\"></span>", "plan");
    if (!plans.empty()) plans = "<div class=\"plans\">" + plans + planLegend(run) + "</div>";
    body += "<div class=\"stage\"><div>" + picture + facts(run) + "</div>" + plans + "</div>";
    return card("film", "Frame by frame", body);
}

std::string depthSection(const Film& film) {
    if (film.shots.empty()) return "";
    const auto& images = film.shots[0].images;
    if (std::none_of(images.begin(), images.end(), [](const FilmImage& i) { return i.id == "heat-all"; })) return "";
    const bool measured = film.heat_scale > 0;  // not if the pictures were read from files
    return card(
        "depth", "Depth complexity: surfaces drawn for a pixel",
        "<div class=\"pair\">" +
            figureOf("heat-all", "Heat map of surfaces drawn for each pixel without culling",
                     measured ? "Without culling: <b id=\"depth-all\"></b> a pixel on average" : "Without culling") +
            figureOf("heat-kept", "Heat map of surfaces drawn for each pixel with culling",
                     measured ? "With culling: <b id=\"depth-kept\"></b> a pixel on average" : "With culling") +
            "</div>" + (measured ? heatLegend(film.heat_scale) : ""));
}

std::string stageSection(const CullRun& run, const RunMeans& means) {
    const auto frames = static_cast<double>(std::max<size_t>(run.frames.size(), 1));
    std::string rows;
    int place = 0;
    for (int stage = 0; stage < kStageCount; ++stage) {
        if (!(run.stages >> stage & 1)) continue;
        const StageRow& sum = means.stages[stage];
        const auto average = [&](uint64_t value) { return readable(std::round(double(value) / frames)); };
        rows += fmt::format(
            "<tr><th scope=\"row\"><i class=\"stage-{}\"></i>{}</th><td id=\"tested-{}\"></td><td "
            "id=\"culled-{}\"></td>"
            "<td id=\"doubt-{}\"></td><td id=\"time-{}\"></td><td class=\"apart\">{}</td><td>{}</td><td>{}</td>"
            "<td>{:.1f}</td></tr>",
            stage + 1, kStageNames[stage], place, place, place, place, average(sum.tested), average(sum.culled),
            average(sum.doubt), sum.microseconds / frames);
        ++place;
    }
    const std::string body = fmt::format(
        R"html(<div class="scroll" tabindex="0" role="region" aria-label="What each stage did"><table><thead>
<tr><td></td><th colspan="4" scope="colgroup" id="this-frame">this frame</th>
<th colspan="4" scope="colgroup" class="apart">mean over the frames</th></tr>
<tr><th scope="col">stage</th><th scope="col">tested</th><th scope="col">culled</th><th scope="col">in doubt</th>
<th scope="col">µs</th><th scope="col" class="apart">tested</th><th scope="col">culled</th>
<th scope="col">in doubt</th><th scope="col">µs</th></tr></thead>
<tbody>{}<tr><th scope="row">whole query</th><td>{}</td><td id="query-culled"></td><td></td><td id="query-time"></td>
<td class="apart">{}</td><td>{}</td><td></td><td>{:.1f}</td></tr></tbody></table></div>
<p class="soft">An object in doubt is kept. The stages are timed in a run of their own, the whole query without that;
in place of its mean the median stands.</p>)html",
        rows, number(run.objects), number(run.objects), readable(std::round(double(run.objects) - means.visible)),
        means.median_query);
    return card("stages", "What each stage did", body);
}

std::string tableSection(const ObjectTable& table) {
    if (table.rows.empty()) return "";
    const bool triangles =
        std::any_of(table.rows.begin(), table.rows.end(), [](const auto& row) { return row.triangles > 0; });
    const bool paths =
        std::any_of(table.rows.begin(), table.rows.end(), [](const auto& row) { return row.path != row.name; });
    std::string note;
    if (table.left_out > 0)
        note = fmt::format(
            "<p class=\"soft\">{} of {} objects: those kept in most frames, and the largest of the "
            "others.</p>",
            number(table.rows.size()), number(table.rows.size() + table.left_out));
    return card("objects", "Objects",
                fmt::format(R"html({}<div class="player"><label for="search">Name, path or key</label>
<input type="search" id="search" autocomplete="off" spellcheck="false"><label class="tick-box">
<input type="checkbox" id="only-kept">kept in this frame</label><output id="found" for="search"></output></div>
<div class="scroll" tabindex="0" role="region" aria-label="Objects"><table class="objects"><thead><tr>
<th scope="col">object</th>{}<th scope="col"><button type="button" class="sort" data-by="0">key</button></th>
{}<th scope="col"><button type="button" class="sort" data-by="4">frames kept</button></th>
<th scope="col">in frame <span id="table-frame"></span></th></tr></thead><tbody id="rows"></tbody></table></div>
<p><button type="button" id="more">Show more</button></p>)html",
                            note, paths ? "<th scope=\"col\" id=\"paths\">path</th>" : "",

                            triangles ? "<th scope=\"col\"><button type=\"button\" class=\"sort\" "
                                        "data-by=\"3\">triangles</button></th>"
                                      : ""));
}

std::string howSection(const CullRun& run, const std::string& pictured) {
    const auto row = [](const std::string& term, const std::string& text) {
        return fmt::format("<dt>{}</dt><dd>{}</dd>", term, text);
    };
    std::string out = "<dl>";
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
    if (!pictured.empty()) out += row("Pictures", pictured);
    out += row("Numbers",
               "in <code>cull.json</code> beside this page; a timeline for Perfetto in "
               "<code>trace.json</code>");
    return card("how", "How it was verified", out + "</dl>");
}

}  // namespace sightline
