// The page of `render --report`: every method's image, what it cost, and where it is wrong.
// SPDX-License-Identifier: MIT
#include "sightline/report/render_page.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "sightline/report/chart.h"
#include "sightline/report/page_parts.h"
#include "sightline/report/picture.h"
#include "sightline/report/render_cost.h"

namespace sightline {
namespace {

constexpr uint32_t kPictureSide = 800;  // [pixels]

/// What a reader should know of a method before its numbers.
constexpr std::string_view kAbout[kHiddenMethods] = {
    "Far to near by one depth a polygon. Wrong wherever that is not enough.",
    "Far to near in an order that is proved pair by pair; what has no order is cut.",
    "Far to near in the order of a BSP tree, each over what is there.",
    "Near to far in the same order, each sample written once.",
    "The screen is quartered until each window is simple.",
    "A depth at each sample.",
    "A ray through each sample, through a tree of boxes.",
};

std::string_view nameOf(HiddenMethod method) { return kHiddenMethodNames[static_cast<int>(method)]; }

std::string imageTag(const Image<Rgb>& image, const std::string& what) {
    return fmt::format("<img alt=\"{}\" src=\"{}\">", escapeHtml(what),
                       dataUri(encodePng(reduced(image, kPictureSide))));
}

std::string linked(const std::string& image, const std::string& method) {
    return fmt::format("<a href=\"{}.png\" title=\"{}.png, in full size\">{}</a>", method, method, image);
}

std::string agreementText(const Agreement& agreement) {
    if (agreement.differing == 0) return "the same surface at every sample";
    return fmt::format("differs at {} samples ({}): {} at edges, {} ties, <b>{} wrong</b>", number(agreement.differing),
                       percent(double(agreement.differing), double(agreement.samples)), number(agreement.at_edges),
                       number(agreement.ties), number(agreement.wrong));
}

std::string verdict(const RenderRun& run) {
    uint64_t wrong = 0;
    size_t exact = 0;
    std::string apart;
    for (const MethodResult& result : run.methods) {
        if (const std::string why = whyInexact(run, result); !why.empty())
            apart = fmt::format("{} samples of {} show a surface that is not the nearest: {}",
                                number(result.agreement.wrong), result.name(), why);
        if (!isExact(run, result)) continue;
        ++exact;
        wrong += result.agreement.wrong;
    }
    std::string text =
        "compared with a plain z-buffer in double, sample by sample; differences on edges and between surfaces at one "
        "depth are counted apart";
    std::string what = exact == 1 ? "The method agrees" : fmt::format("All {} exact methods agree", exact);
    if (wrong > 0)
        what = fmt::format("{} samples of exact methods show a surface that is not the nearest", number(wrong));
    if (exact == 0) {
        if (apart.empty()) return "";
        what = apart;
    } else if (!apart.empty()) {
        text = apart + ", so that it is not counted among the exact methods; " + text;
    }
    return fmt::format("<div class=\"verdict{}\" role=\"status\"><strong>{}</strong><span>{}</span></div>",
                       exact == 0   ? ""
                       : wrong == 0 ? " good"
                                    : " bad",
                       what, text);
}

std::string tiles(const RenderRun& run) {
    std::string out = "<div class=\"tiles\">";
    out += tile(number(run.polygons_in_view),
                fmt::format("polygons to draw, of {} triangles in view", number(run.triangles_in_view)));
    const MethodResult* fastest = nullptr;
    for (const MethodResult& result : run.methods)
        if (isExact(run, result) && (!fastest || result.milliseconds < fastest->milliseconds)) fastest = &result;
    if (fastest)
        out += tile(fmt::format("{} ms", readable(fastest->milliseconds)),
                    fmt::format("{}, the fastest exact method here{}", fastest->name(),
                                fastest->prepare_milliseconds > 0
                                    ? ", after " + readable(fastest->prepare_milliseconds) + " ms of preparation"
                                    : ""));
    const MethodResult* painter = run.find(HiddenMethod::kPainter);
    if (painter && !painter->image.generated.empty())
        out += tile(fmt::format("{:.2f}", statisticsOf(painter->image.generated).mean),
                    "fragments a pixel: the depth complexity");
    if (painter) out += tile(number(painter->agreement.wrong), "samples that the painter's algorithm gets wrong");
    return out + "</div>";
}

/// The largest value that heat maps of all methods share.
double commonScale(const RenderRun& run) {
    double scale = 8;
    for (const MethodResult& result : run.methods) scale = std::max(scale, heatScale(countsOf(result.image, run.heat)));
    return scale;
}

std::string gallery(const RenderList& scene, const View& view, const RenderRun& run, const PictureSettings& settings,
                    const TakePicture& take) {
    const double scale = commonScale(run);
    std::string out =
        "<section class=\"card\" aria-labelledby=\"h-images\"><h2 id=\"h-images\">The image by each "
        "method</h2><div class=\"gallery\">";
    const HiddenImage* drawn = nullptr;
    Image<Rgb> picture;
    for (const MethodResult& result : run.methods) {
        if (!drawn || drawn->surface != result.image.surface)
            picture = shadedPicture(scene, view, result.image, settings);
        drawn = &result.image;
        if (take) take(result, picture);
        const std::vector<uint16_t>& counts = countsOf(result.image, run.heat);
        const std::string name(result.name());
        const std::string image = imageTag(picture, "The scene drawn by " + name);
        out += fmt::format("<figure><h3>{} <span class=\"tag {}\">{}</span></h3>{}", name,
                           result.agreement.agrees() ? "good" : "bad",
                           result.agreement.agrees() ? "agrees" : number(result.agreement.wrong) + " wrong",
                           take ? linked(image, name) : image);
        if (!counts.empty())
            out += "<div class=\"heat\">" +
                   imageTag(heatMap(countPicture(result.image, counts), scale), "Heat map of " + name) + "</div>";
        out += fmt::format("<figcaption>{} <b>{} ms</b>", kAbout[static_cast<int>(result.method)],
                           readable(result.milliseconds));
        if (result.prepare_milliseconds > 0)
            out += fmt::format(" after {} ms of preparation", readable(result.prepare_milliseconds));
        out += fmt::format("; {}.</figcaption></figure>", agreementText(result.agreement));
    }
    out += "</div>";
    if (!run.methods.empty() && !countsOf(run.methods[0].image, run.heat).empty())
        out += fmt::format("<p class=\"soft\">Below each image, fragments {} at each pixel, of a counting run.{}</p>",
                           kHeatNames[static_cast<int>(run.heat)], countingNote(run)) +
               heatLegend(scale);
    for (const LeftOut& left : run.left_out)
        out += fmt::format("<p><b>{}</b> was left out: {}.</p>", nameOf(left.method), escapeHtml(left.why));
    return out + "</section>";
}

std::string histogramSvg(const CountStatistics& statistics, const std::string& title) {
    constexpr double kWidth = 640, kHeight = 200, kBottom = 24, kTop = 10;
    const size_t bars = statistics.histogram.size();
    const double wide = kWidth / static_cast<double>(std::max<size_t>(bars, 1));
    const uint64_t most = bars ? *std::max_element(statistics.histogram.begin(), statistics.histogram.end()) : 1;
    std::string out = fmt::format("<svg class=\"chart bars\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">",
                                  kWidth, kHeight, escapeHtml(title));
    const size_t step = std::max<size_t>(1, bars / 16);
    for (size_t i = 0; i < bars; ++i) {
        const bool rest = i + 1 == CountStatistics::kMostBars;
        const double x = static_cast<double>(i) * wide, high = (kHeight - kBottom - kTop) *
                                                               static_cast<double>(statistics.histogram[i]) /
                                                               static_cast<double>(std::max<uint64_t>(most, 1));
        out += fmt::format(
            "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"><title>{}{}: {} pixels</title></rect>",
            x + 0.08 * wide, kHeight - kBottom - high, 0.84 * wide, high, i, rest ? " and more" : "",
            number(statistics.histogram[i]));
        if (i % step == 0)
            out += fmt::format("<text class=\"tick\" x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}{}</text>",
                               x + wide / 2, kHeight - 6, i, rest ? "+" : "");
    }
    return out + "</svg>";
}

/// Depth complexity is a fact of the scene: the painter generates every fragment, hidden or not.
std::string depthComplexity(const RenderRun& run) {
    const MethodResult* result = run.find(HiddenMethod::kPainter);
    if (!result) result = run.methods.empty() ? nullptr : &run.methods.front();
    if (!result || result->image.generated.empty()) return "";
    const HiddenImage& image = result->image;
    const CountStatistics statistics = statisticsOf(image.generated);
    const double scale = heatScale(image.generated);
    return fmt::format(
        R"html(<section class="card" aria-labelledby="h-depth"><h2 id="h-depth">Depth complexity</h2>
<div class="pair"><figure>{}<figcaption>Fragments generated for each pixel by {}, in the counting run: <b>{:.2f}</b> on average,
<b>{}</b> at most</figcaption>{}</figure>
<figure>{}<figcaption>Pixels by their number of fragments</figcaption></figure></div></section>)html",
        imageTag(heatMap(countPicture(image, image.generated), scale), "Heat map of depth complexity"), result->name(),
        statistics.mean, statistics.maximum, heatLegend(scale),
        histogramSvg(statistics, "Pixels by their number of fragments"));
}

/// What the hierarchy spared the z-buffer: fragments found and fragments tested, on one scale.
std::string hierarchy(const RenderRun& run) {
    const MethodResult* result = run.find(HiddenMethod::kZBuffer);
    if (!result || result->image.tested.empty()) return "";
    const HiddenCounters& did = result->image.counters;
    if (did.hierarchy_rejected_polygons + did.hierarchy_rejected_tiles + did.hierarchy_accepted_tiles == 0) return "";
    const HiddenImage& image = result->image;
    const double scale = heatScale(image.generated);
    const auto figure = [&](const std::vector<uint16_t>& counts, const std::string& what, const std::string& text) {
        return fmt::format("<figure>{}<figcaption>{}: <b>{:.2f}</b> a pixel</figcaption></figure>",
                           imageTag(heatMap(countPicture(image, counts), scale), what), text,
                           statisticsOf(counts).mean);
    };
    return fmt::format(
        "<section class=\"card\" aria-labelledby=\"h-hierarchy\"><h2 id=\"h-hierarchy\">What the z-buffer’s "
        "hierarchy spared</h2><div class=\"pair\">{}{}</div>{}<p class=\"soft\">Both of the counting run. What is "
        "missing "
        "on the right was rejected or accepted by whole polygons and tiles.</p></section>",
        figure(image.generated, "Heat map of fragments generated",
               "Generated, those included that the hierarchy rejects unseen"),
        figure(image.tested, "Heat map of fragments tested", "Tested one by one against a depth"), heatLegend(scale));
}

std::string depthTraffic(const RenderRun& run) {
    const MethodResult* result = run.find(HiddenMethod::kZBuffer);
    if (!result || result->image.counters.depth_bytes == 0) return "";
    const auto plain = static_cast<double>(result->image.counters.depth_bytes);
    const auto compressed = static_cast<double>(result->image.counters.depth_bytes_compressed);
    const auto bar = [&](const char* name, double bytes) {
        return fmt::format(
            "<span>{}</span><div class=\"share\"><div style=\"width:{:.3f}%\"></div></div><span>{} kB</span>", name,
            100 * bytes / std::max(plain, compressed), readable(std::round(bytes / 1000)));
    };
    return fmt::format(
        "<section class=\"card\" aria-labelledby=\"h-bytes\"><h2 id=\"h-bytes\">Depth read and written by the "
        "z-buffer</h2><div class=\"costs\">{}{}</div><p>Compressed tile by tile, without loss: <b>{:.2f}</b> : "
        "1.</p></section>",
        bar("plain", plain), bar("compressed", compressed), compressed > 0 ? plain / compressed : 0.0);
}

/// Where the z-buffer's format cannot tell surfaces apart, and what other formats would make of the frame.
std::string zFighting(const RenderList& scene, const View& view, const RenderRun& run,
                      const PictureSettings& settings) {
    if (run.fights.empty() || run.fight_map.fights.empty()) return "";
    std::string rows;
    for (const FormatFights& fights : run.fights) {
        const bool own = fights.format == run.settings.depth.format;
        rows += fmt::format("<tr><th scope=\"row\">{}{}</th><td>{}</td><td>{}</td></tr>",
                            kDepthFormatNames[static_cast<int>(fights.format)],
                            own ? " <span class=\"tag\">this run</span>" : "", number(fights.fighting),
                            percent(double(fights.fighting), double(fights.overlaid)));
    }
    const Image<Rgb> picture =
        shadedPicture(scene, view, plainZBuffer(scene.list(), view, run.settings.projector), settings);
    return fmt::format(
        R"html(<section class="card" aria-labelledby="h-fights"><h2 id="h-fights">Z-fighting</h2>
<div class="pair"><figure>{}<figcaption>Red: the two nearest surfaces lie apart, but have the same depth in {}
(<b>{}</b> pixels). Blue: they lie at the same place, which no format tells apart (<b>{}</b>).</figcaption></figure>
<div class="scroll"><table class="counts"><thead><tr><th scope="col">format</th><th scope="col">pixels fighting</th>
<th scope="col">of {} with two surfaces</th></tr></thead><tbody>{}</tbody></table></div></div></section>)html",
        imageTag(fightPicture(picture, run.fight_map), "Map of z-fighting"),
        kDepthFormatNames[static_cast<int>(run.settings.depth.format)], number(run.fight_map.fighting),
        number(run.fight_map.coplanar), number(run.fight_map.overlaid), rows);
}

/// Where methods show other objects than the plain z-buffer.
std::string differences(const RenderList& scene, const View& view, const RenderRun& run,
                        const PictureSettings& settings) {
    if (std::all_of(run.methods.begin(), run.methods.end(), [](const MethodResult& r) { return r.agreement.agrees(); }))
        return "";
    const HiddenImage reference = plainZBuffer(scene.list(), view, run.settings.projector);
    const Image<Rgb> picture = shadedPicture(scene, view, reference, settings);
    std::string out =
        "<section class=\"card\" aria-labelledby=\"h-wrong\"><h2 id=\"h-wrong\">Where an image is "
        "wrong</h2><div class=\"gallery\">";
    for (const MethodResult& result : run.methods) {
        if (result.agreement.agrees()) continue;
        const std::string name(result.name());
        out += fmt::format("<figure><h3>{}</h3>{}<figcaption>{}</figcaption></figure>", name,
                           imageTag(differencePicture(picture, reference, result.image), "Wrong pixels of " + name),
                           agreementText(result.agreement));
    }
    return out + "</div><p class=\"soft\">Red: another surface than the nearest.</p></section>";
}

std::string howMade(const RenderRun& run) {
    const auto row = [](const std::string& term, const std::string& text) {
        return fmt::format("<dt>{}</dt><dd>{}</dd>", term, text);
    };
    const auto vector = [](const glm::dvec3& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z); };
    std::string out = "<section class=\"card\" aria-labelledby=\"h-how\"><h2 id=\"h-how\">How it was made</h2><dl>";
    out += row("Camera", fmt::format("frame {} of {}: from {} to {}", run.frame, run.frames, vector(run.camera.eye),
                                     vector(run.camera.target)));
    out += row("Samples", "one a pixel, at its centre");
    out += row("Surfaces",
               "single-sided back faces are dropped; masked surfaces are drawn whole; blended and "
               "transmissive ones are not drawn");
    const uint32_t threads = run.settings.threads;
    out += row("Times", fmt::format("{}, on {}; heat maps and depth bytes are of a counting run of its own",
                                    run.repeat == 1 ? "one run" : fmt::format("median of {} runs", run.repeat),
                                    threads == 1 ? "one thread" : fmt::format("up to {} threads", threads)));
    out += row("Reference", "a plain z-buffer in double, one thread");
    if (!run.command.empty()) out += row("Repeat it", "<code>" + escapeHtml(run.command) + "</code>");
    return out + row("Numbers", "in <code>render.json</code> beside this page") + "</dl></section>";
}

}  // namespace

std::string renderPage(const RenderList& scene, const View& view, const RenderRun& run, const PictureSettings& settings,
                       const TakePicture& take) {
    const std::string name = sceneTitle(run.scene);
    std::string page = pageHead(name);
    page += fmt::format(
        "<header class=\"page\"><h1>{}</h1><p class=\"soft\">{} objects, {} triangles; {} × {}, hidden surfaces "
        "removed by {} method{}</p>{}</header><main>",
        name, number(run.objects), number(run.triangles), run.width, run.height, run.methods.size(),
        run.methods.size() == 1 ? "" : "s", verdict(run));
    page += tiles(run) + gallery(scene, view, run, settings, take) + differences(scene, view, run, settings);
    page += "<section class=\"card\" aria-labelledby=\"h-cost\"><h2 id=\"h-cost\">What each method cost</h2>" +
            costBars(run) + costTable(run) + "</section>";
    page += depthComplexity(run) + hierarchy(run) + depthTraffic(run) + zFighting(scene, view, run, settings) +
            howMade(run);
    return page + "</main><footer>Made by Sightline.</footer></body></html>\n";
}

}  // namespace sightline
