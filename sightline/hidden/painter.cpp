// The painter's algorithm: draw far to near, each polygon over what is there.
// SPDX-License-Identifier: MIT
#include "sightline/hidden/painter.h"

#include <algorithm>
#include <limits>

#include "sightline/hidden/fill.h"
#include "sightline/hidden/scan.h"

namespace sightline {
namespace {

struct Key {
    double nearness = 0;
    uint32_t polygon = 0;
};

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
    std::vector<Key> keys(polygons.size());
    for (uint32_t i = 0; i < keys.size(); ++i) keys[i] = {nearnessOf(polygons[i], input.settings.painter_key), i};
    std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
        return a.nearness != b.nearness ? a.nearness < b.nearness : a.polygon > b.polygon;
    });
    const int32_t width = static_cast<int32_t>(image.width), height = static_cast<int32_t>(image.height);
    for (const Key& key : keys) {
        const ScreenPolygon& polygon = polygons[key.polygon];
        scanPolygon(polygon.outline(), 0, height, width, [&](int32_t row, int32_t begin, int32_t end) {
            fillSpan(image, row, begin, end, polygon.surface);
        });
    }
}

}  // namespace sightline
