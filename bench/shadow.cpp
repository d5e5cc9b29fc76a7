// Shadow casters of a low sun over a city: how many a shadow map has to draw, and that its picture stays the same.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "bench/cases.h"
#include "bench/stopwatch.h"
#include "sightline/query/shadow_query.h"
#include "sightline/studies/hidden/render.h"
#include "sightline/studies/hidden/shade/shadow_map.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/report/pictures/render_list.h"
#include "sightline/tools/scene/city/city.h"

namespace sightline::bench {
using namespace studies;
using namespace tools;
namespace {

constexpr uint64_t kSeed = 1;
constexpr uint32_t kObjects = 10000, kFrames = 8, kWidth = 640, kHeight = 360, kMap = 1024;

/// Sums over the frames of a path.
struct Sums {
    double kept = 0, in_light = 0, by_mask = 0, beside = 0, behind = 0, in_shadow = 0, objects = 0;
    double time = 0;  ///< [microseconds, the thread's own]
    double darkened = 0, changed = 0, points = 0;
};

glm::dvec3 sunAt(double elevation_degrees, double azimuth_degrees) {
    const double up = glm::radians(elevation_degrees), around = glm::radians(azimuth_degrees);
    return {std::cos(up) * std::cos(around), std::sin(up), std::cos(up) * std::sin(around)};
}

/// Compares the sun's reach at every pixel, from maps of all casters and of those that were kept.
void compareImages(const Scene& scene, const View& view, const glm::dvec3& sun, const std::vector<uint8_t>& kept,
                   Sums& sums) {
    const RenderList drawn(scene, view);
    const HiddenImage image = render(drawn.list(), view, {});
    const SurfacePoints points(drawn.list(), view);
    ShadowSettings settings;
    settings.sun = sun;
    settings.size = kMap;
    const ShadowMap all(drawn.casters(), points, image, settings);
    std::vector<DrawItem> some;
    for (const DrawItem& item : drawn.casters())
        if (kept[item.id]) some.push_back(item);
    const ShadowMap less(some, points, image, settings);
    for (uint32_t row = 0; row < view.height; ++row)
        for (uint32_t i = 0; i < view.width; ++i) {
            const uint32_t surface = image.surface[size_t{row} * view.width + i];
            if (surface == HiddenImage::kNone) continue;
            const SurfacePoint point = points.at(row, i, surface);
            const double a = all.reach(point), b = less.reach(point);
            ++sums.points;
            sums.darkened += a < 1;
            sums.changed += a != b;
        }
}

/// The side of the coarsest texel that a reference map of the frame has: what it looks up lies so far from the ray.
double coarsestTexel(const Scene& scene, const View& view, const glm::dvec3& sun) {
    const RenderList drawn(scene, view);
    const HiddenImage image = render(drawn.list(), view, {});
    const SurfacePoints points(drawn.list(), view);
    ShadowSettings settings;
    settings.sun = sun;
    settings.size = kMap;
    const ShadowMap map({}, points, image, settings);
    double texel = 0;
    for (uint32_t row = 0; row < view.height; row += 8)
        for (uint32_t i = 0; i < view.width; i += 8) {
            const uint32_t surface = image.surface[size_t{row} * view.width + i];
            if (surface != HiddenImage::kNone) texel = std::max(texel, map.texelFor(points.at(row, i, surface)));
        }
    return texel;
}

Sums measure(const Scene& scene, const Snapshot& now, const CameraPath& path, double elevation, int repeat) {
    Sums sums;
    Query query;
    ShadowQuery shadows;
    for (size_t frame = 0; frame < path.frames.size(); ++frame) {
        const View view = makeView(path.frames[frame], kWidth, kHeight);
        const glm::dvec3 sun = sunAt(elevation, 30.0 + 45.0 * static_cast<double>(frame));
        Light light{.direction = -sun};
        CasterSettings settings;
        const double texel = coarsestTexel(scene, view, sun);
        settings.filter = 2.0 * texel;
        settings.bias = 16.0 * texel;
        const auto receivers = query.visible(now, view).objects;
        settings.occlusion = false;
        sums.by_mask += static_cast<double>(shadows.casters(now, view, receivers, light, settings).casters.size());
        settings.occlusion = true;
        CasterSet set;
        sums.time += threadTimes({[&] { set = shadows.casters(now, view, receivers, light, settings); }}, repeat)[0];
        sums.kept += static_cast<double>(set.casters.size());
        sums.in_light += static_cast<double>(set.stats.in_light);
        sums.beside += static_cast<double>(set.stats.beside);
        sums.behind += static_cast<double>(set.stats.behind);
        sums.in_shadow += static_cast<double>(set.stats.in_shadow);
        sums.objects += static_cast<double>(now.objectCount());
        std::vector<uint8_t> kept(scene.objects.size(), 0);
        for (const Visible& caster : set.casters) kept[caster.id.index - 1] = 1;  // objects enter in their order
        compareImages(scene, view, sun, kept, sums);
    }
    return sums;
}

}  // namespace

Table benchShadow(const Options& options) {
    Table table{"shadow", {}};
    const Scene city = options.scene ? Scene() : makeCity(kSeed, kObjects);
    const Scene& scene = options.scene ? *options.scene : city;
    LoadedWorld loaded = loadWorld(scene, {}, loadSettings(false, 0));
    const Snapshot now = loaded.world.commit();
    const CameraPath path = options.scene ? seededCameras(scene, kFrames, kSeed) : cityStreetPath(kSeed, kFrames);
    const double n = static_cast<double>(std::max<size_t>(path.frames.size(), 1));
    for (const double elevation : {10.0, 20.0, 45.0}) {
        const Sums sums = measure(scene, now, path, elevation, options.repeat ? options.repeat : 5);
        const std::string where = fmt::format("{}, sun {:.0f} degrees high", scene.name, elevation);
        const char* const light = "in the light's frustum";
        const Rows row{table, where};
        row("casters kept", sums.kept / n, "objects", light, sums.in_light / n);
        row("casters kept by the mask alone", sums.by_mask / n, "objects", light, sums.in_light / n);
        row("beside all receivers", sums.beside / n, "objects", light, sums.in_light / n);
        row("behind all receivers", sums.behind / n, "objects", light, sums.in_light / n);
        row("in the shadow of others", sums.in_shadow / n, "objects", light, sums.in_light / n);
        row("time", sums.time / n, "us", "", 0);
        row("pixels lit otherwise", sums.changed, "pixels", "in shadow", sums.darkened);
        if (sums.changed > 0)
            table.faults.push_back(fmt::format("bench shadow: {}: {:.0f} of {:.0f} pixels are lit otherwise", where,
                                               sums.changed, sums.points));
    }
    return table;
}

}  // namespace sightline::bench
