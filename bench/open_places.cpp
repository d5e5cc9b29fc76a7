// Places of an image where something may be seen past what lies before it: beside outlines, seams and corners.
// SPDX-License-Identifier: MIT
#include "bench/open_places.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sightline::bench {
using namespace tools;
namespace {

bool before(const glm::vec3& a, const glm::vec3& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

/// One side of one triangle, its ends in order.
struct Side {
    glm::vec3 a, b;
    uint32_t batch, triangle;

    bool sameEdge(const Side& other) const { return a == other.a && b == other.b; }
};

std::vector<Side> sidesOf(const OcclusionScene& scene) {
    std::vector<Side> sides;
    sides.reserve(3 * scene.triangles());
    for (uint32_t batch = 0; batch < scene.batches.size(); ++batch) {
        const OccluderBatch& from = scene.batches[batch];
        for (size_t i = 0; i < from.indices.size(); ++i) {
            const size_t next = i % 3 == 2 ? i - 2 : i + 1;
            glm::vec3 a = from.positions[from.indices[i]], b = from.positions[from.indices[next]];
            if (before(b, a)) std::swap(a, b);
            sides.push_back({a, b, batch, static_cast<uint32_t>(i / 3)});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
        if (s.a != t.a) return before(s.a, t.a);
        if (s.b != t.b) return before(s.b, t.b);
        return s.batch != t.batch ? s.batch < t.batch : s.triangle < t.triangle;
    });
    return sides;
}

glm::dvec4 planeOf(const OcclusionScene& scene, const Side& side) {
    const OccluderBatch& batch = scene.batches[side.batch];
    glm::dvec3 p[3];
    for (size_t k = 0; k < 3; ++k) p[k] = batch.positions[batch.indices[3 * size_t{side.triangle} + k]];
    const glm::dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
    return {normal, -glm::dot(normal, p[0])};
}

}  // namespace

SceneEdges::SceneEdges(const OcclusionScene& scene) {
    const std::vector<Side> sides = sidesOf(scene);
    for (size_t i = 0; i < sides.size();) {
        size_t end = i;
        while (end < sides.size() && sides[end].sameEdge(sides[i])) ++end;
        Edge& edge = edges_.emplace_back();
        edge.a = sides[i].a;
        edge.b = sides[i].b;
        edge.triangles = static_cast<uint32_t>(end - i);
        edge.seam = sides[end - 1].batch != sides[i].batch;
        for (size_t k = 0; k < std::min<size_t>(2, end - i); ++k) edge.plane[k] = planeOf(scene, sides[i + k]);
        i = end;
    }
}

OpenPlaces::OpenPlaces(const SceneEdges& edges, const RayScene& rays, const SightLines& sight, const View& view,
                       uint32_t about, uint64_t seed)
    : size_(view.width, view.height),
      columns_((view.width + kCell - 1) / kCell),
      rows_((view.height + kCell - 1) / kCell) {
    const glm::dvec3 eye = sight.eye();
    std::vector<const SceneEdges::Edge*> wanted;
    for (const SceneEdges::Edge& edge : edges.edges()) {
        Box3d box;
        box.grow(glm::dvec3(edge.a));
        box.grow(glm::dvec3(edge.b));
        if (edge.mayShow(eye) && sight.touches(box)) wanted.push_back(&edge);
    }
    std::vector<std::pair<uint32_t, Place>> found;
    Random random(mixSeed(seed, wanted.size()));
    RaySighting sighting;
    const auto tryPoint = [&](const SceneEdges::Edge& edge) {
        const glm::dvec3 a = glm::dvec3(edge.a) - eye, along = glm::dvec3(edge.b) - glm::dvec3(edge.a);
        // A quarter at corners: where panels meet, more than two of them do.
        const double t = random.below(4) == 0 ? double(random.below(2)) : random.uniform();
        const glm::dvec3 point = a + t * along;
        Place place;
        glm::dvec2 other;
        if (!sight.project(point, place.at) || !sight.project(point + (t > 0.5 ? -1e-4 : 1e-4) * along, other))
            return false;
        const SightRay ray = sight.rayThrough(place.at);
        const double depth = glm::dot(point - ray.origin, ray.direction);
        rays.look(ray, eye, sighting);
        if (sighting.t < depth - 1e-4 * std::abs(depth) - sighting.rounding) return false;
        const glm::dvec2 run = (other - place.at) * size_;
        if (!(glm::length(run) > 0)) return false;
        const glm::dvec2 across = glm::dvec2(-run.y, run.x) / glm::length(run);
        place.beside = 2.0 * across / size_;
        found.emplace_back(cellOf(place.at), place);
        return true;
    };
    // First all of them, then again those of which something is seen: most edges of a large scene are hidden.
    for (int round = 0; round < 2 && !wanted.empty(); ++round) {
        const double each = 0.5 * double(about) / double(wanted.size());
        std::vector<const SceneEdges::Edge*> seen;
        for (const SceneEdges::Edge* edge : wanted) {
            const int tries = static_cast<int>(std::min(each, 1000.0) + random.uniform());
            bool any = false;
            for (int i = 0; i < tries; ++i) any |= tryPoint(*edge);
            if (any) seen.push_back(edge);
        }
        wanted.swap(seen);
    }
    first_.assign(size_t{columns_} * rows_ + 1, 0);
    for (const auto& [cell, place] : found) ++first_[cell + 1];
    for (size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
    places_.resize(found.size());
    std::vector<uint32_t> at(first_.begin(), first_.end() - 1);
    for (const auto& [cell, place] : found) places_[at[cell]++] = place;
}

uint32_t OpenPlaces::cellOf(const glm::dvec2& place) const {
    const glm::dvec2 pixel = (0.5 + 0.5 * place) * size_ / double(kCell);
    const uint32_t x = static_cast<uint32_t>(std::clamp(pixel.x, 0.0, columns_ - 1.0));
    const uint32_t y = static_cast<uint32_t>(std::clamp(pixel.y, 0.0, rows_ - 1.0));
    return y * columns_ + x;
}

PlaceRect OpenPlaces::rectOf(const View& view, const Box3f& box) const {
    PlaceRect rect;
    if (places_.empty()) return rect;
    const glm::dmat4 m = view.projection * view.view;
    glm::dvec2 low(1e300), high(-1e300);
    for (int k = 0; k < 8; ++k) {
        const glm::dvec4 corner(k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y,
                                k & 4 ? box.max.z : box.min.z, 1.0);
        const glm::dvec4 clip = m * corner;
        // What reaches behind the eye may be anywhere.
        const bool ahead = clip.w > 0;
        low = glm::min(low, ahead ? glm::dvec2(clip) / clip.w : glm::dvec2(-1.0));
        high = glm::max(high, ahead ? glm::dvec2(clip) / clip.w : glm::dvec2(1.0));
    }
    rect.empty = low.x > 1 || low.y > 1 || high.x < -1 || high.y < -1;
    const uint32_t from = cellOf(low), to = cellOf(high);
    rect.x0 = from % columns_, rect.y0 = from / columns_;
    rect.x1 = to % columns_, rect.y1 = to / columns_;
    return rect;
}

bool OpenPlaces::pick(const PlaceRect& rect, Random& random, glm::dvec2& place) const {
    static constexpr std::array kDistances = {1e-9, 1e-7, 1e-5, 1e-4, 1e-3, 5e-3, 2e-2, 5e-2, 0.3};  // [pixels]
    if (rect.empty) return false;
    for (int k = 0; k < 16; ++k) {
        const uint32_t x = rect.x0 + static_cast<uint32_t>(random.below(rect.x1 - rect.x0 + 1));
        const uint32_t y = rect.y0 + static_cast<uint32_t>(random.below(rect.y1 - rect.y0 + 1));
        const uint32_t cell = y * columns_ + x, count = first_[cell + 1] - first_[cell];
        if (count == 0) continue;
        const Place& chosen = places_[first_[cell] + random.below(count)];
        const double distance = kDistances[random.below(kDistances.size())] * (random.below(2) ? 1.0 : -1.0);
        place = chosen.at + distance * chosen.beside;
        if (std::abs(place.x) < 1 && std::abs(place.y) < 1) return true;
    }
    return false;
}

}  // namespace sightline::bench
