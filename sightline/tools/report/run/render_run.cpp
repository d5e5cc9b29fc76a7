// What hidden-surface methods made of one frame, beside one another, as plain data, and its JSON form.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/render_run.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "sightline/studies/hidden/project/scan.h"
#include "sightline/studies/hidden/zbuffer/zbuffer_method.h"
#include "sightline/tools/report/readable.h"
#include "sightline/tools/report/run/camera_json.h"
#include "sightline/tools/scene/json_text.h"

namespace sightline::tools {
using namespace studies;
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kPainterKeys[] = {"centre", "farthest"};
constexpr std::string_view kFreeSamples[] = {"check", "segments", "bits"};
constexpr std::string_view kRayTracers[] = {"bvh", "embree"};
constexpr std::string_view kClippings[] = {"guard-band", "frustum", "clipless"};
constexpr std::string_view kComparisons[] = {"never",   "less",          "less-equal", "equal",
                                             "greater", "greater-equal", "not-equal",  "always"};

template <class T>
std::string_view nameIn(std::span<const std::string_view> names, T value) {
    return names[static_cast<size_t>(value)];
}

double median(std::vector<uint64_t>& nanoseconds) {
    std::sort(nanoseconds.begin(), nanoseconds.end());
    const size_t n = nanoseconds.size();
    return 0.5e-6 * static_cast<double>(nanoseconds[n / 2] + nanoseconds[(n - 1) / 2]);
}

/// By the names of the options that it is asked for with.
Json settingsJson(const RenderRun& run) {
    const RenderSettings& settings = run.settings;
    const DepthSettings& depth = settings.depth;
    const bool clockwise = settings.projector.front_face == FrontFace::kClockwise;
    return {{"threads", settings.threads},
            {"repeat", run.repeat},
            {"painter_key", nameIn(kPainterKeys, settings.painter_key)},
            {"free_samples", nameIn(kFreeSamples, settings.free_samples)},
            {"rays", nameIn(kRayTracers, settings.ray_tracer)},
            {"clipping", nameIn(kClippings, settings.projector.clipping)},
            {"front", clockwise ? "cw" : "ccw"},
            {"back_faces", settings.projector.cull_back_faces ? "drop" : "draw"},
            {"depth_format", nameIn(kDepthFormatNames, depth.format)},
            {"depth_comparison", depth.comparison ? nameIn(kComparisons, *depth.comparison) : "nearer"},
            {"depth_write", depth.write},
            {"polygon_offset", {depth.offset_factor, depth.offset_units}},
            {"early_z", depth.early_test},
            {"hierarchical_z", depth.hierarchy},
            {"fast_clear", depth.fast_clear},
            {"depth_compression", depth.compression},
            {"heat", nameIn(kHeatNames, run.heat)},
            {"shading", nameIn(kShadingNames, run.shading)},
            {"shadows", run.shadows}};
}

Json methodJson(const MethodResult& result) {
    Json out;
    out["name"] = result.name();
    out["milliseconds"] = result.milliseconds;
    out["prepare_milliseconds"] = result.prepare_milliseconds;
    for (const CounterName& counter : counterNames())
        out["counters"][std::string(counter.name)] = counter.value(result.image.counters);
    out["agreement"] = {{"with", "plain z-buffer in double"},      {"samples", result.agreement.samples},
                        {"differing", result.agreement.differing}, {"at_edges", result.agreement.at_edges},
                        {"ties", result.agreement.ties},           {"wrong", result.agreement.wrong},
                        {"edge_band", result.bands.edge},          {"tie_band", result.bands.tie}};
    for (int heat = 0; heat < kHeats; ++heat) {
        const std::vector<uint16_t>& counts = countsOf(result.image, static_cast<Heat>(heat));
        if (counts.empty()) continue;
        const CountStatistics statistics = statisticsOf(counts);
        out["counting_run"][std::string(kHeatNames[heat])] = fragmentsOf(result.counted, static_cast<Heat>(heat));
        out["per_sample"][std::string(kHeatNames[heat])] = {
            {"mean", statistics.mean}, {"maximum", statistics.maximum}, {"histogram", statistics.histogram}};
    }
    return out;
}

}  // namespace

const std::vector<uint16_t>& countsOf(const HiddenImage& image, Heat heat) {
    const std::vector<uint16_t>* const counts[kHeats] = {&image.generated, &image.tested, &image.passed, &image.shaded};
    return *counts[static_cast<int>(heat)];
}

uint64_t fragmentsOf(const HiddenCounters& counters, Heat heat) {
    const uint64_t all[kHeats] = {counters.generated, counters.tested, counters.passed, counters.shaded};
    return all[static_cast<int>(heat)];
}

CountStatistics statisticsOf(std::span<const uint16_t> counts) {
    CountStatistics out;
    uint64_t sum = 0;
    for (const uint16_t count : counts) {
        sum += count;
        out.maximum = std::max<uint32_t>(out.maximum, count);
        const size_t bar = std::min<size_t>(count, CountStatistics::kMostBars - 1);
        if (bar >= out.histogram.size()) out.histogram.resize(bar + 1, 0);
        ++out.histogram[bar];
    }
    if (!counts.empty()) out.mean = static_cast<double>(sum) / static_cast<double>(counts.size());
    return out;
}

std::span<const CounterName> counterNames() {
    using C = HiddenCounters;
    static constexpr CounterName kNames[] = {
        {"triangles", "triangles", [](const C& c) { return c.geometry.triangles; }},
        {"rejected", "triangles rejected", [](const C& c) { return c.geometry.rejected; }},
        {"back_facing", "back faces", [](const C& c) { return c.geometry.back_facing; }},
        {"accepted", "accepted whole", [](const C& c) { return c.geometry.accepted; }},
        {"clipped", "clipped", [](const C& c) { return c.geometry.clipped; }},
        {"produced", "polygons to draw", [](const C& c) { return c.geometry.produced; }},
        {"generated", "fragments generated", [](const C& c) { return c.generated; }},
        {"tested", "fragments tested", [](const C& c) { return c.tested; }},
        {"passed", "fragments passed", [](const C& c) { return c.passed; }},
        {"shaded", "fragments shaded", [](const C& c) { return c.shaded; }},
        {"comparisons", "pairs compared", [](const C& c) { return c.comparisons; }},
        {"swaps", "swaps", [](const C& c) { return c.swaps; }},
        {"splits", "splits", [](const C& c) { return c.splits; }},
        {"nodes", "nodes visited", [](const C& c) { return c.nodes; }},
        {"skipped_subtrees", "subtrees skipped", [](const C& c) { return c.skipped_subtrees; }},
        {"windows", "windows", [](const C& c) { return c.windows; }},
        {"rays", "rays", [](const C& c) { return c.rays; }},
        {"hierarchy_rejected_polygons", "polygons rejected by hierarchical z",
         [](const C& c) { return c.hierarchy_rejected_polygons; }},
        {"hierarchy_rejected_tiles", "tiles rejected by hierarchical z",
         [](const C& c) { return c.hierarchy_rejected_tiles; }},
        {"hierarchy_accepted_tiles", "tiles accepted by hierarchical z",
         [](const C& c) { return c.hierarchy_accepted_tiles; }},
        {"depth_bytes", "depth bytes, plain", [](const C& c) { return c.depth_bytes; }},
        {"depth_bytes_compressed", "depth bytes, compressed", [](const C& c) { return c.depth_bytes_compressed; }},
    };
    return kNames;
}

HiddenImage plainZBuffer(const DrawList& list, const View& view, const ProjectorSettings& settings) {
    HiddenImage image;
    image.width = view.width;
    image.height = view.height;
    image.surface.assign(size_t{view.width} * view.height, HiddenImage::kNone);
    if (!isUsable(view)) return image;
    std::vector<double> nearest(image.surface.size(), -std::numeric_limits<double>::infinity());
    const auto width = static_cast<int32_t>(view.width), height = static_cast<int32_t>(view.height);
    Projector projector(view, {view.width, view.height, 0, 1, {}}, settings);
    ScreenPolygon polygon;
    for (size_t i = 0; i < list.items().size(); ++i) {
        const DrawItem& item = list.items()[i];
        projector.begin(item);
        for (uint32_t t = 0; t < item.mesh.triangles(); ++t) {
            if (!item.writes_depth.empty() && item.writes_depth[t] == 0) continue;
            if (!projector.project(t, polygon)) continue;
            const uint32_t surface = list.firstSurface(i) + t;
            scanPolygon(polygon.outline(), 0, height, width, [&](int32_t row, int32_t begin, int32_t end) {
                for (int32_t k = begin; k < end; ++k) {
                    const size_t at = static_cast<size_t>(row) * view.width + static_cast<size_t>(k);
                    const double nearness = polygon.depth.at(row, k);
                    if (nearness <= nearest[at]) continue;
                    nearest[at] = nearness;
                    image.surface[at] = surface;
                }
            });
        }
    }
    image.counters.geometry = projector.counters();
    return image;
}

const MethodResult* RenderRun::find(HiddenMethod method) const {
    for (const MethodResult& result : methods)
        if (result.method == method) return &result;
    return nullptr;
}

bool isExact(const RenderRun& run, const MethodResult& result) {
    return result.method != HiddenMethod::kPainter && whyInexact(run, result).empty();
}

std::string whyInexact(const RenderRun& run, const MethodResult& result) {
    const DepthSettings& depth = run.settings.depth;
    if (result.method != HiddenMethod::kZBuffer || result.agreement.agrees()) return {};
    if (depth.comparison || !depth.write || depth.offset_factor != 0 || depth.offset_units != 0)
        return "its depth comparison, write or offset asks for other surfaces than the nearest";
    if (depth.format == DepthFormat::kReversedFloat) return {};
    return fmt::format("{} is too coarse for them", nameIn(kDepthFormatNames, depth.format));
}

std::string whyImpractical(const RenderRun& run, HiddenMethod method) {
    const auto beyond = [](uint64_t count, uint64_t most, std::string_view what) {
        if (count <= most) return std::string();
        return fmt::format("{} {} in view; practical up to {}", readable(static_cast<double>(count)), what,
                           readable(static_cast<double>(most)));
    };
    switch (method) {
        case HiddenMethod::kNewell:
            return beyond(run.polygons_in_view, 250'000, "polygons");
        case HiddenMethod::kWarnock:
            return beyond(run.polygons_in_view, 1'000'000, "polygons");
        case HiddenMethod::kBspBackToFront:
        case HiddenMethod::kBspFrontToBack:
            return beyond(run.triangles_in_view, 1'000'000, "triangles");
        default:
            return {};
    }
}

MethodResult drawMethod(const RenderList& scene, const View& view, RenderSettings settings, HiddenMethod method,
                        int repeat) {
    MethodResult result;
    result.method = settings.method = method;
    const bool counts = settings.want_counts;
    settings.want_counts = false;
    std::vector<uint64_t> drawing, preparing;
    ZBufferMemory memory;
    settings.zbuffer_memory = &memory;
    for (int i = 0; i < repeat; ++i) {
        result.image = render(scene.list(), view, settings);
        drawing.push_back(result.image.counters.nanoseconds);
        preparing.push_back(result.image.counters.prepare_nanoseconds);
    }
    result.milliseconds = median(drawing);
    result.prepare_milliseconds = median(preparing);
    if (!counts) return result;
    // Counting at each sample may cost shortcuts, so that the totals stay those of the runs that were timed. But for
    // its bytes: only where depths are kept compressed are those counted.
    settings.want_counts = settings.depth.compression = true;
    const HiddenCounters totals = result.image.counters;
    result.image = render(scene.list(), view, settings);
    HiddenCounters& counters = result.image.counters;
    result.counted = counters;
    const uint64_t plain = counters.depth_bytes, compressed = counters.depth_bytes_compressed;
    counters = totals;
    counters.depth_bytes = plain;
    counters.depth_bytes_compressed = compressed;
    return result;
}

void judge(const RenderList& scene, const View& view, const HiddenImage& reference, const RenderSettings& settings,
           MethodResult& result) {
    result.bands.projector = settings.projector;
    // Depths in single precision tell surfaces apart that differ by more than 2^-22 of their nearness. What a coarser
    // format confuses is wrong.
    if (result.method == HiddenMethod::kZBuffer) result.bands.tie = 0x1p-22;
    // Embree meets triangles in float: edges are known to some thousandths of a pixel, depths to single precision.
    if (result.method == HiddenMethod::kRaycast && settings.ray_tracer == RayTracer::kEmbree) {
        result.bands.edge = 1e-2;
        result.bands.tie = 1e-5;
    }
    result.agreement = compareImages(scene.list(), view, reference, result.image, result.bands);
}

void findFights(const RenderList& scene, const View& view, const ShareWork& share, RenderRun& run) {
    run.fights.resize(kDepthFormats);
    shareOut(share, kDepthFormats, [&](size_t i) {
        const auto format = static_cast<DepthFormat>(i);
        ZFightingMap map = findZFighting(scene.list(), view, format, run.settings.projector);
        run.fights[i] = {format, map.overlaid, map.fighting, map.coplanar};
        if (format == run.settings.depth.format) run.fight_map = std::move(map);
    });
}

std::string renderJson(const RenderRun& run) {
    Json out;
    out["schema"] = "sightline.render/1";
    out["scene"] = {{"file", run.scene},
                    {"objects", run.objects},
                    {"triangles", run.triangles},
                    {"objects_in_view", run.objects_in_view},
                    {"triangles_in_view", run.triangles_in_view},
                    {"polygons_in_view", run.polygons_in_view}};
    out["width"] = run.width;
    out["height"] = run.height;
    out["frame"] = run.frame;
    out["camera"] = cameraJson(run.camera);
    out["settings"] = settingsJson(run);
    out["methods"] = Json::array();
    for (const MethodResult& result : run.methods) out["methods"].push_back(methodJson(result));
    out["left_out"] = Json::array();
    for (const LeftOut& left : run.left_out)
        out["left_out"].push_back({{"name", kHiddenMethodNames[static_cast<int>(left.method)]}, {"why", left.why}});
    for (const FormatFights& fights : run.fights)
        out["z_fighting"].push_back({{"format", nameIn(kDepthFormatNames, fights.format)},
                                     {"overlaid", fights.overlaid},
                                     {"fighting", fights.fighting},
                                     {"coplanar", fights.coplanar}});
    return jsonText(out, 1) + "\n";
}

}  // namespace sightline::tools
