// Shadows of one sun: depth as the sun sees it, in maps that fit what an image shows.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/shade/shadow_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "sightline/math/box.h"
#include "sightline/studies/hidden/zbuffer/zbuffer.h"

namespace sightline::studies {
namespace {

constexpr uint32_t kBandRows = 64;
/// Boxes of points by the octave of their distance, a quarter each: fine enough to end ranges at.
constexpr int kBins = 512, kBinsPerOctave = 4, kFirstOctave = -64;

struct Bins {
    Box3d box[kBins];
    double farthest[kBins] = {};

    void add(const glm::dvec3& place, double distance) {
        const double octave = std::log2(std::max(distance, 1e-18)) - kFirstOctave;
        const int bin = std::clamp(static_cast<int>(octave * kBinsPerOctave), 0, kBins - 1);
        box[bin].grow(place);
        farthest[bin] = std::max(farthest[bin], distance);
    }
    void add(const Bins& other) {
        for (int i = 0; i < kBins; ++i) {
            box[i].grow(other.box[i]);
            farthest[i] = std::max(farthest[i], other.farthest[i]);
        }
    }
};

/// Boxes of the casters across the sun's rays, relative to the eye. Empty for those that are not finite.
std::vector<Box3d> castersBoxes(std::span<const DrawItem> casters, const glm::dmat3& to_sun_space,
                                const glm::dvec3& eye) {
    std::map<const glm::vec3*, Box3d> meshes;  // items share meshes
    std::vector<Box3d> boxes;
    boxes.reserve(casters.size());
    for (const DrawItem& item : casters) {
        const auto [found, added] = meshes.try_emplace(item.mesh.positions.data());
        if (added)
            for (const glm::vec3& p : item.mesh.positions) found->second.grow(glm::dvec3(p));
        glm::dmat4 placed(to_sun_space * glm::dmat3(item.transform));
        placed[3] = glm::dvec4(to_sun_space * (glm::dvec3(item.transform[3]) - eye), 1.0);
        const Box3d box = transformBox(found->second, placed);
        boxes.push_back(box.finite() ? box : Box3d());
    }
    return boxes;
}

}  // namespace

SurfacePoint SurfacePoints::at(uint32_t row, uint32_t sample, uint32_t surface) const {
    const DrawList::Place place = list_.placeOf(surface);
    const DrawItem& item = list_.items()[place.item];
    // The difference of the large translations comes first: what follows is relative to the eye.
    const glm::dmat3 turn(item.transform);
    const glm::dvec3 shift = glm::dvec3(item.transform[3]) - eye_;
    glm::dvec3 corners[3];
    for (int k = 0; k < 3; ++k) {
        const uint32_t index = item.mesh.indices[size_t{3} * place.triangle + static_cast<size_t>(k)];
        corners[k] = turn * glm::dvec3(item.mesh.positions[index]) + shift;
    }
    const Unprojection::Line line = unprojection_.lineOfSight(sample, row);
    const glm::dvec3 origin = to_world_ * line.origin, direction = to_world_ * line.direction;
    const glm::dvec3 across = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double area = glm::dot(across, across), facing = glm::dot(across, direction);

    SurfacePoint point;
    point.item = place.item;
    point.triangle = place.triangle;
    point.weights = glm::dvec3(1, 0, 0);
    if (area > 0 && facing != 0) {
        const glm::dvec3 met = origin + glm::dot(across, corners[0] - origin) / facing * direction;
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 &b = corners[(k + 1) % 3], &c = corners[(k + 2) % 3];
            point.weights[k] = glm::max(0.0, glm::dot(across, glm::cross(c - b, met - b)) / area);
        }
        const double sum = point.weights.x + point.weights.y + point.weights.z;
        point.weights = sum > 0 ? point.weights / sum : glm::dvec3(1, 0, 0);
        // A mirroring transform has turned the winding about.
        point.from_behind = (facing > 0) != (glm::determinant(turn) < 0);
        point.normal = across * ((facing > 0 ? -1.0 : 1.0) / std::sqrt(area));
    }
    for (int k = 0; k < 3; ++k) point.position += point.weights[k] * corners[k];
    return point;
}

ShadowMap::ShadowMap(std::span<const DrawItem> casters, const SurfacePoints& points, const HiddenImage& image,
                     const ShadowSettings& settings) {
    const glm::dvec3 side = std::abs(settings.sun.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(side, settings.sun)), y = glm::cross(settings.sun, x);
    to_sun_space_ = glm::transpose(glm::dmat3(x, y, settings.sun));
    fit(points, image, settings);
    draw(casters, points.eye(), settings);
}

/// Lays out the maps: each just holds the image's points between two distances from the eye.
void ShadowMap::fit(const SurfacePoints& points, const HiddenImage& image, const ShadowSettings& settings) {
    std::vector<Bins> bands((image.height + kBandRows - 1) / kBandRows);
    shareOut(settings.share, bands.size(), [&](size_t band) {
        const uint32_t first = static_cast<uint32_t>(band) * kBandRows;
        for (uint32_t row = first; row < std::min(first + kBandRows, image.height); ++row)
            for (uint32_t i = 0; i < image.width; ++i) {
                const uint32_t surface = image.surface[size_t{row} * image.width + i];
                if (surface == HiddenImage::kNone) continue;
                const glm::dvec3 position = points.at(row, i, surface).position;
                bands[band].add(acrossSun(position), glm::length(position));
            }
    });
    Bins bins;
    for (const Bins& band : bands) bins.add(band);
    int first = 0, end = kBins;
    while (first < end && bins.box[first].empty()) ++first;
    while (end > first && bins.box[end - 1].empty()) --end;
    for (uint32_t k = 0; k < settings.maps && first < end; ++k) {
        // The ranges left share the octaves left.
        const int left = static_cast<int>(settings.maps - k);
        const int last = first + (end - first + left - 1) / left;
        Box3d box;
        Map map;
        for (; first < last; ++first) {
            box.grow(bins.box[first]);
            map.farthest = std::max(map.farthest, bins.farthest[first]);
        }
        if (box.empty()) continue;
        const double longer = std::max({box.size().x, box.size().y, 1e-9 * (1 + map.farthest)});
        map.texel = longer / std::max(1.0, settings.size - 4.0);
        map.corner = glm::dvec2(box.min) - 2.0 * map.texel;
        map.width = static_cast<uint32_t>(std::ceil(box.size().x / map.texel)) + 4;
        map.height = static_cast<uint32_t>(std::ceil(box.size().y / map.texel)) + 4;
        map.lowest = box.min.z;
        maps_.push_back(std::move(map));
    }
}

void ShadowMap::draw(std::span<const DrawItem> casters, const glm::dvec3& eye, const ShadowSettings& settings) {
    const std::vector<Box3d> boxes = castersBoxes(casters, to_sun_space_, eye);
    size_t most = 0;
    for (const DrawItem& item : casters) most = std::max(most, item.mesh.triangles());
    const std::vector<uint8_t> both_sides(most, 1);
    shareOut(settings.share, maps_.size(), [&](size_t k) {
        Map& map = maps_[k];
        const glm::dvec2 size = map.texel * glm::dvec2(map.width, map.height);
        std::vector<DrawItem> chosen;
        double highest = map.lowest;
        for (size_t i = 0; i < casters.size(); ++i) {
            const Box3d& box = boxes[i];
            if (box.empty() || box.max.z < map.lowest || box.max.x < map.corner.x || box.max.y < map.corner.y ||
                box.min.x > map.corner.x + size.x || box.min.y > map.corner.y + size.y)
                continue;
            highest = std::max(highest, box.max.z);
            chosen.push_back(casters[i]);
            chosen.back().double_sided = std::span(both_sides).first(casters[i].mesh.triangles());
            chosen.back().id = 0;
        }
        // A parallel view down the sun's rays, from above the highest caster.
        const double room = map.texel + 1e-6 * (1 + highest - map.lowest);
        View view;
        view.width = map.width;
        view.height = map.height;
        const glm::dvec3 above(map.corner + 0.5 * size, highest + 2 * room);
        const glm::dvec3 from = glm::transpose(to_sun_space_) * above + eye;
        view.view = glm::dmat4(to_sun_space_);
        view.view[3] = glm::dvec4(-(to_sun_space_ * from), 1.0);
        view.projection = orthographic(size.y, size.x / size.y, room, above.z - map.lowest + 4 * room);
        ZBufferSettings pass;
        pass.want_generated = false;
        map.depth = renderZBuffer(chosen, view, pass).depth;
        for (double& depth : map.depth) depth += above.z;
    });
}

const ShadowMap::Map* ShadowMap::mapFor(const SurfacePoint& point) const {
    const double distance = glm::length(point.position);
    for (const Map& map : maps_)
        if (distance <= map.farthest * (1 + 1e-9)) return &map;
    return nullptr;
}

double ShadowMap::texelFor(const SurfacePoint& point) const {
    const Map* const map = mapFor(point);
    return map ? map->texel : 0;
}

double ShadowMap::reach(const SurfacePoint& point) const {
    const Map* const found = mapFor(point);
    if (!found) return 1;
    const Map& map = *found;
    const glm::dvec3 place = acrossSun(point.position), normal = acrossSun(point.normal);
    // How the receiver's plane rises along the map. One that the sun grazes would rise without end.
    constexpr double kSteepest = 12;
    glm::dvec2 slope(0.0);
    if (std::abs(normal.z) > 1e-9) slope = -glm::dvec2(normal) / normal.z;
    const double steep = glm::length(slope);
    if (steep > kSteepest) slope *= kSteepest / steep;
    const double bias = map.texel * (1 + std::min(steep, kSteepest));
    const glm::dvec2 at = (glm::dvec2(place) - map.corner) / map.texel - 0.5, low = glm::floor(at), part = at - low;
    double lit = 0;
    int lit_taps = 0;
    for (int tap = 0; tap < 4; ++tap) {
        const glm::dvec2 texel = low + glm::dvec2(tap & 1, tap >> 1);
        if (texel.x >= 0 && texel.y >= 0 && texel.x < map.width && texel.y < map.height) {
            const size_t there = static_cast<size_t>(texel.y) * map.width + static_cast<size_t>(texel.x);
            const double own = place.z + map.texel * glm::dot(slope, texel - at);
            if (map.depth[there] > own + bias) continue;
        }
        ++lit_taps;
        lit += (tap & 1 ? part.x : 1 - part.x) * (tap >> 1 ? part.y : 1 - part.y);
    }
    return lit_taps == 4 ? 1 : lit;
}

}  // namespace sightline::studies
