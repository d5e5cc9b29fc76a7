// Portal images: what they save and how true they are, at their sample points and between them.
// SPDX-License-Identifier: MIT
//
// Daniel Aliaga, Anselmo Lastra. Architectural Walkthroughs Using Portal Textures. 1997.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "bench/cases.h"
#include "bench/image_study.h"
#include "bench/stopwatch.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/city/city.h"

namespace sightline::bench {
using namespace tools;
using namespace images;
namespace {

constexpr uint64_t kSeed = 1;
constexpr size_t kDoorways = 3;
constexpr double kExact = 99;  // stands for an infinite ratio of signal to noise

double capped(double decibels) { return std::min(decibels, kExact); }

void addMode(const Rows& row, const char* where, const ModeFigures& figures, int mode, double target) {
    if (figures.texels == 0) return;
    row(fmt::format("{}, {}: PSNR", where, kShowModeNames[mode]), capped(figures.on_screen.psnr()), "dB", "target",
        target,
        fmt::format("worst eye {:.1f}; texel by texel {:.1f}; {:.2f} % holes", capped(figures.worst),
                    capped(figures.on_raster.psnr()),
                    100 * static_cast<double>(figures.holes) / static_cast<double>(figures.texels)));
}

void addTimes(const Rows& row, const StudyFigures& figures) {
    const double geometry = medianOf(figures.geometry_times);
    for (int mode = 0; mode < kShowModes; ++mode) {
        std::vector<double> times = figures.on_arc[mode].times;
        times.insert(times.end(), figures.anywhere[mode].times.begin(), figures.anywhere[mode].times.end());
        if (times.empty()) continue;
        std::sort(times.begin(), times.end());
        row(fmt::format("{}: to show", kShowModeNames[mode]), medianOf(times), "us", "drawing what is beyond", geometry,
            fmt::format("{:.0f} to {:.0f}; drawn it takes {:.0f} to {:.0f}", times.front(), times.back(),
                        *std::min_element(figures.geometry_times.begin(), figures.geometry_times.end()),
                        *std::max_element(figures.geometry_times.begin(), figures.geometry_times.end())));
    }
}

double correlation(const std::vector<DisplacementPoint>& points) {
    double x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    for (const DisplacementPoint& point : points) {
        x += point.predicted, y += point.measured;
        xx += point.predicted * point.predicted, yy += point.measured * point.measured;
        xy += point.predicted * point.measured;
    }
    const auto n = static_cast<double>(points.size());
    const double spread = (n * xx - x * x) * (n * yy - y * y);
    return spread > 0 ? (n * xy - x * y) / std::sqrt(spread) : 0;
}

void addPrediction(const Rows& row, const StudyFigures& figures, Table& table) {
    size_t above = 0;
    double tightest = 0;
    for (const DisplacementPoint& point : figures.points) {
        above += point.measured > point.predicted;
        tightest = std::max(tightest, point.measured / point.predicted);
        row("nearest: displacement measured", point.measured, "pixels", "predicted", point.predicted,
            fmt::format("texel by texel {:.1f} dB", capped(point.psnr)));
    }
    row("correlation of predicted and measured", correlation(figures.points), "", "none", 0,
        fmt::format("{} eyes; measured is {:.2f} of predicted at most", figures.points.size(), tightest));
    if (above > 0)
        table.faults.push_back(fmt::format("images: {}: {} displacements exceed their bounds", row.where, above));
}

void addBake(const Rows& row, const StudyFigures& figures) {
    const PortalBakeReport& bake = figures.bake;
    const auto each = static_cast<double>(figures.doorways);
    const auto add = [&](const char* what, size_t count, size_t bytes, double seconds) {
        row(fmt::format("bake of a doorway: {}", what), seconds / each, "s", "", 0,
            fmt::format("{:.0f} of them, {:.1f} MB", static_cast<double>(count) / each,
                        1e-6 * static_cast<double>(bytes) / each));
    };
    add("images", bake.images, bake.image_bytes, bake.image_seconds);
    add("references with depth", bake.references, bake.reference_bytes, bake.reference_seconds);
    add("layered images", bake.layered, bake.layered_bytes, bake.layered_seconds);
}

void addFigures(const std::string& where, const StudyFigures& figures, Table& table) {
    const Rows row{table, where};
    if (figures.doorways == 0 || figures.eyes == 0) {
        table.faults.push_back("images: " + where + ": no doorway could be baked");
        return;
    }
    const auto eyes = static_cast<double>(figures.eyes);
    row("triangles with the far side as an image", figures.with_image / eyes, "triangles", "frustum alone",
        figures.in_frustum / eyes,
        fmt::format("{:.1f}x fewer; {} eyes before {} doorways", figures.in_frustum / figures.with_image, figures.eyes,
                    figures.doorways));
    for (int mode = 0; mode < kShowModes; ++mode) addMode(row, "at samples", figures.at_samples[mode], mode, 45);
    for (int mode = 0; mode < kShowModes; ++mode) addMode(row, "between, on the arc", figures.on_arc[mode], mode, 35);
    for (int mode = 0; mode < kShowModes; ++mode) addMode(row, "anywhere before", figures.anywhere[mode], mode, 35);
    addTimes(row, figures);
    addBake(row, figures);
    addPrediction(row, figures, table);
    row("warped: frames that keep their picture", static_cast<double>(figures.reused), "frames", "all",
        static_cast<double>(figures.frames), fmt::format("predicted {:.2f} pixels at most", figures.reuse_error));
}

void study(const std::string& where, const DrawnScene& drawn, const std::vector<StudiedDoorway>& doorways,
           const Options& options, Table& table) {
    StudyFigures figures;
    for (size_t i = 0; i < doorways.size(); ++i) {
        studyDoorway(drawn, doorways[i], kSeed + i, figures);
        if (options.progress) options.progress(i + 1, doorways.size());
    }
    addFigures(where, figures, table);
}

}  // namespace

Table benchImages(const Options& options) {
    Table table{"images", {}};
    if (options.scene) {
        const DrawnScene drawn(*options.scene);
        const std::vector<StudiedDoorway> doorways = doorwaysOf(*options.scene, kSeed, kDoorways);
        if (!doorways.empty()) study(options.scene->name + ", doorways", drawn, doorways, options, table);
        else study(options.scene->name + ", ahead", drawn, aheadIn(drawn, kSeed, 1), options, table);
        return table;
    }
    const Scene building = makeBuilding(kSeed, 10), city = makeCity(kSeed, 3000);
    study("building:1:10, doorways", DrawnScene(building), doorwaysOf(building, kSeed, kDoorways), options, table);
    study("city:1:3000, cut in two", DrawnScene(city), {cutThrough(city)}, options, table);
    return table;
}

}  // namespace sightline::bench
