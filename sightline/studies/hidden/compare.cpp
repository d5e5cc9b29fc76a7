// Whether two images of the same polygons agree, and what explains the samples where they do not.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline::studies {
namespace {

double distanceToOutline(const ScreenPolygon& polygon, const glm::dvec2& point) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < polygon.count; ++i) {
        const glm::dvec2 &a = polygon.points[i], &b = polygon.points[i + 1 < polygon.count ? i + 1 : 0];
        const glm::dvec2 ab = b - a;
        const double length = glm::dot(ab, ab);
        const double t = length > 0 ? std::clamp(glm::dot(point - a, ab) / length, 0.0, 1.0) : 0.0;
        least = std::min(least, glm::length(a + t * ab - point));
    }
    return least;
}

}  // namespace

Agreement compareImages(const DrawList& list, const View& view, const HiddenImage& expected, const HiddenImage& found,
                        const AgreementBands& bands) {
    Projector projector(view, {view.width, view.height, 0, 1, {}}, bands.projector);
    const std::vector<ScreenPolygon> polygons = projectAll(list, projector);
    std::vector<uint32_t> polygon_of(list.surfaces(), HiddenImage::kNone);
    for (uint32_t i = 0; i < polygons.size(); ++i) polygon_of[polygons[i].surface] = i;
    const auto polygonOf = [&](uint32_t surface) {
        const uint32_t i = surface < polygon_of.size() ? polygon_of[surface] : HiddenImage::kNone;
        return i == HiddenImage::kNone ? nullptr : &polygons[i];
    };
    Agreement result;
    result.samples = expected.surface.size();
    for (size_t at = 0; at < expected.surface.size(); ++at) {
        const uint32_t surfaces[2] = {expected.surface[at], found.surface[at]};
        if (surfaces[0] == surfaces[1]) continue;
        const bool both = surfaces[0] != HiddenImage::kNone && surfaces[1] != HiddenImage::kNone;
        if (bands.by_id && both && list.idOf(surfaces[0]) == list.idOf(surfaces[1])) continue;
        ++result.differing;
        const uint32_t row = static_cast<uint32_t>(at / expected.width),
                       sample = static_cast<uint32_t>(at % expected.width);
        const ScreenPolygon* shown[2] = {polygonOf(surfaces[0]), polygonOf(surfaces[1])};
        bool at_edge = false;
        for (const ScreenPolygon* polygon : shown)
            at_edge |= polygon && distanceToOutline(*polygon, {sample + 0.5, row + 0.5}) <= bands.edge;
        if (at_edge) {
            ++result.at_edges;
            continue;
        }
        if (shown[0] && shown[1]) {
            const double a = shown[0]->depth.at(row, sample), b = shown[1]->depth.at(row, sample);
            if (std::abs(a - b) <= bands.tie * std::max(std::abs(a), std::abs(b))) {
                ++result.ties;
                continue;
            }
        }
        if (result.wrong++ == 0) {
            result.row = row;
            result.sample = sample;
            result.expected = surfaces[0];
            result.found = surfaces[1];
        }
    }
    return result;
}

}  // namespace sightline::studies
