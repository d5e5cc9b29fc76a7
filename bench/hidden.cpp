// Hidden surfaces as a whole: every method on one view, then each part beside its baseline.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>
#include <vector>

#include "bench/cases.h"
#include "bench/stopwatch.h"
#include "sightline/studies/hidden/render.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/report/pictures/render_list.h"
#include "sightline/tools/scene/city/city.h"

namespace sightline::bench {
using namespace studies;
using namespace tools;
namespace {

constexpr uint32_t kObjects = 2000, kWidth = 1280, kHeight = 720;

/// Every method draws the same view, in turn; the parts that a method keeps from frame to frame are not counted.
void compareMethods(const Scene& scene, const CameraFrame& frame, int repeat, Table& table) {
    const View view = makeView(frame, kWidth, kHeight);
    const RenderList drawn(scene, view);
    std::vector<std::vector<double>> times(kHiddenMethods);
    for (int round = 0; round < repeat; ++round)
        for (int method = 0; method < kHiddenMethods; ++method) {
            RenderSettings settings;
            settings.method = static_cast<HiddenMethod>(method);
            const HiddenImage image = render(drawn.list(), view, settings);
            times[static_cast<size_t>(method)].push_back(static_cast<double>(image.counters.nanoseconds) * 1e-6);
        }
    std::vector<double> medians;
    for (const std::vector<double>& of_method : times) medians.push_back(medianOf(of_method));
    const double zbuffer = medians[static_cast<size_t>(HiddenMethod::kZBuffer)];
    for (size_t method = 0; method < medians.size(); ++method)
        table.rows.push_back({scene.name, std::string(kHiddenMethodNames[method]), medians[method], "ms",
                              "zbuffer, one thread", zbuffer});
}

}  // namespace

Table benchHidden(const Options& options) {
    Table table{"hidden", {}};
    const int repeat = options.repeat ? options.repeat : 5;
    if (options.scene) {
        compareMethods(*options.scene, seededCameras(*options.scene, 1, 1).frames[0], repeat, table);
    } else {
        const Scene city = makeCity(1, kObjects);
        compareMethods(city, cityStreetPath(1, 1).frames[0], repeat, table);
    }
    constexpr Table (*kParts[])(const Options&) = {
        benchClipping, benchOrder, benchBsp, benchDepth,
#ifdef SIGHTLINE_GL
        benchGl,
#endif
    };
    for (const auto part : kParts) {
        const Table rows = part(options);
        table.rows.insert(table.rows.end(), rows.rows.begin(), rows.rows.end());
    }
    return table;
}

}  // namespace sightline::bench
