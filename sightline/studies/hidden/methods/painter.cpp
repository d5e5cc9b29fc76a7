// The painter's algorithm: draw far to near, each polygon over what is there.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/methods/painter.h"

#include <algorithm>
#include <limits>

#include "sightline/studies/hidden/methods/fill.h"
#include "sightline/studies/hidden/methods/presort.h"
#include "sightline/studies/hidden/project/scan.h"

namespace sightline::studies {
namespace {

double nearnessAt(const ScreenPolygon& polygon, const glm::dvec2& point) {
    return polygon.depth.at(point.y - 0.5, point.x - 0.5);
}

double nearnessOf(const ScreenPolygon& polygon, PainterKey key) {
    if (key == PainterKey::kCentre) {
        glm::dvec2 sum(0.0);
        for (const glm::dvec2& point : polygon.outline()) sum += point;
        return nearnessAt(polygon, sum / static_cast<double>(polygon.count));
    }
    double farthest = std::numeric_limits<double>::infinity();
    for (const glm::dvec2& point : polygon.outline()) farthest = std::min(farthest, nearnessAt(polygon, point));
    return farthest;
}

}  // namespace

void drawPainter(const HiddenInput& input, HiddenImage& image) {
    Projector projector = input.projector();
    const std::vector<ScreenPolygon> polygons = projectAll(input.list, projector);
    image.counters.geometry = projector.counters();
    // Higher numbers first: the sort keeps the order of equals.
    std::vector<SortEntry> order(polygons.size()), scratch;
    for (uint32_t i = 0; i < order.size(); ++i) {
        const uint32_t polygon = static_cast<uint32_t>(order.size()) - 1 - i;
        order[i] = {sortKey(nearnessOf(polygons[polygon], input.settings.painter_key)), polygon};
    }
    radixSort(order, scratch);
    const int32_t width = static_cast<int32_t>(image.width), height = static_cast<int32_t>(image.height);
    for (const SortEntry& entry : order) {
        const ScreenPolygon& polygon = polygons[entry.value];
        scanPolygon(polygon.outline(), 0, height, width, [&](int32_t row, int32_t begin, int32_t end) {
            fillSpan(image, row, begin, end, polygon.surface);
        });
    }
}

}  // namespace sightline::studies
