// Where a depth format cannot tell the two nearest surfaces apart, so that the order of drawing decides.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/zbuffer/z_fighting.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sightline/studies/hidden/project/scan.h"
#include "sightline/studies/hidden/zbuffer/zbuffer_method.h"

namespace sightline::studies {
namespace {

constexpr double kNothing = -std::numeric_limits<double>::infinity();

struct TwoNearest {
    double first = kNothing, second = kNothing;

    void add(double nearness) {
        second = std::max(second, std::min(first, nearness));
        first = std::max(first, nearness);
    }
};

double distanceOf(const DepthCodec& codec, double nearness) {
    return codec.range.orthographic ? -nearness : 1 / nearness;
}

}  // namespace

ZFightingMap findZFighting(const DrawList& list, const View& view, DepthFormat format,
                           const ProjectorSettings& settings) {
    ZFightingMap map;
    map.width = view.width;
    map.height = view.height;
    const size_t samples = size_t{view.width} * view.height;
    map.fights.assign(samples, Fight::kNone);
    map.gap_in_steps.assign(samples, std::numeric_limits<float>::infinity());
    if (!isUsable(view)) return map;

    std::vector<TwoNearest> nearest(samples);
    Projector projector(view, {view.width, view.height, 0, 1, {}}, settings);
    for (const ScreenPolygon& polygon : projectAll(list, projector))
        scanPolygon(polygon.outline(), 0, static_cast<int32_t>(view.height), static_cast<int32_t>(view.width),
                    [&](int32_t row, int32_t begin, int32_t end) {
                        TwoNearest* line = nearest.data() + static_cast<size_t>(row) * view.width;
                        for (int32_t i = begin; i < end; ++i) line[i].add(polygon.depth.at(row, i));
                    });

    const DepthCodec codec = depthCodecFor(list, view, format);
    for (size_t at = 0; at < samples; ++at) {
        const auto [first, second] = nearest[at];
        if (second == kNothing) continue;
        ++map.overlaid;
        const double gap = std::abs(distanceOf(codec, second) - distanceOf(codec, first));
        map.gap_in_steps[at] = static_cast<float>(gap / codec.stepAt(distanceOf(codec, first)));
        if (first - second <= ZFightingMap::kCoplanarBand * std::abs(first)) {
            map.fights[at] = Fight::kCoplanar;
            ++map.coplanar;
        } else if (codec.encode(first) == codec.encode(second)) {
            map.fights[at] = Fight::kFormat;
            ++map.fighting;
        }
    }
    return map;
}

}  // namespace sightline::studies
