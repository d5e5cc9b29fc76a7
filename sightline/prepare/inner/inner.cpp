// Makes simpler occluders for dense meshes: they lie inside of the solids that the mesh bounds, and so hide no more.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/inner/inner.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sightline/prepare/inner/inner_hull.h"
#include "sightline/prepare/occluder/orient.h"
#include "sightline/prepare/occluder/patchwork.h"

namespace sightline {
namespace {

constexpr uint32_t kFewest = 4;  // triangles of a solid: a tetrahedron

/// Triangles that are no part of a solid and have corners in common.
struct OpenPart {
    std::vector<uint32_t> triangles;
    Box3f box;
};

struct Level {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    std::vector<uint8_t> double_sided;

    size_t triangles() const { return double_sided.size(); }
    void add(std::span<const glm::vec3> from, const SolidTriangle& triangle, bool both) {
        for (uint32_t vertex : triangle.vertex) {
            indices.push_back(static_cast<uint32_t>(positions.size()));
            positions.push_back(from[vertex]);
        }
        double_sided.push_back(both);
    }
};

class LevelMaker {
public:
    LevelMaker(Patchwork patchwork, const InnerSettings& settings)
        : patchwork_(std::move(patchwork)), settings_(settings) {
        for (const PatchPolygon& polygon : patchwork_.polygons)
            triangles_.push_back({{polygon.vertex[0], polygon.vertex[1], polygon.vertex[2]}});
        for (const glm::vec3& position : patchwork_.positions) box_.grow(position);
        findHulls();
        if (!hulls_.empty()) findOpenParts();
    }

    bool hasSolids() const { return !hulls_.empty(); }
    size_t triangles() const { return triangles_.size(); }
    float diagonal() const { return glm::length(box_.size()); }
    const Box3f& outside() const { return outside_; }

    /// All that is larger than the error, the solids made simpler by as much. Errors must rise from call to call.
    Level make(float error) {
        Level level;
        for (Hull& hull : hulls_) {
            if (hull.diagonal <= error) continue;
            hull.hull.simplify(kFewest, error);
            for (const SolidTriangle& triangle : hull.hull.triangles())
                level.add(hull.hull.positions(), triangle, false);
        }
        for (const OpenPart& part : open_) {
            if (glm::length(part.box.size()) <= error) continue;
            for (uint32_t t : part.triangles)
                level.add(patchwork_.positions, triangles_[t], patchwork_.polygons[t].double_sided);
        }
        return level;
    }

private:
    struct Hull {
        InnerHull hull;
        float diagonal;
    };

    Box3f boxOf(std::span<const uint32_t> triangles) const {
        Box3f box;
        for (uint32_t t : triangles)
            for (uint32_t vertex : triangles_[t].vertex) box.grow(patchwork_.positions[vertex]);
        return box;
    }

    void findHulls() {
        taken_.assign(triangles_.size(), 0);
        takeSolids(triangles_, false);
        if (std::none_of(patchwork_.polygons.begin(), patchwork_.polygons.end(),
                         [](const PatchPolygon& p) { return p.double_sided; }))
            return;
        // What is drawn on both sides bounds a solid also if it is given inside out.
        std::vector<SolidTriangle> turned = triangles_;
        for (SolidTriangle& triangle : turned) std::swap(triangle.vertex[1], triangle.vertex[2]);
        takeSolids(turned, true);
    }

    void takeSolids(std::span<const SolidTriangle> triangles, bool turned) {
        for (const Solid& solid : findSolids(patchwork_.positions, triangles)) {
            if (solid.triangles.size() < settings_.least_triangles) continue;
            if (turned && std::any_of(solid.triangles.begin(), solid.triangles.end(),
                                      [&](uint32_t t) { return taken_[t] || !patchwork_.polygons[t].double_sided; }))
                continue;
            for (uint32_t t : solid.triangles) taken_[t] = 1;
            const Box3f box = boxOf(solid.triangles);
            outside_.grow(box);
            hulls_.push_back({InnerHull(patchwork_.positions, triangles, solid), glm::length(box.size())});
        }
    }

    void findOpenParts() {
        std::vector<uint32_t> parent(patchwork_.positions.size());
        std::iota(parent.begin(), parent.end(), 0u);
        const auto root = [&](uint32_t i) {
            while (parent[i] != i) i = parent[i] = parent[parent[i]];
            return i;
        };
        for (uint32_t t = 0; t < triangles_.size(); ++t) {
            if (taken_[t]) continue;
            for (int k = 1; k < 3; ++k) {
                const uint32_t a = root(triangles_[t].vertex[0]), b = root(triangles_[t].vertex[k]);
                parent[std::max(a, b)] = std::min(a, b);
            }
        }
        std::vector<uint32_t> part_of(patchwork_.positions.size(), ~uint32_t{0});
        for (uint32_t t = 0; t < triangles_.size(); ++t) {
            if (taken_[t]) continue;
            uint32_t& part = part_of[root(triangles_[t].vertex[0])];
            if (part == ~uint32_t{0}) {
                part = static_cast<uint32_t>(open_.size());
                open_.emplace_back();
            }
            open_[part].triangles.push_back(t);
        }
        for (OpenPart& part : open_) part.box = boxOf(part.triangles);
    }

    Patchwork patchwork_;
    const InnerSettings& settings_;
    std::vector<SolidTriangle> triangles_;
    std::vector<uint8_t> taken_;  ///< per triangle: part of a solid that is made simpler
    std::vector<Hull> hulls_;
    std::vector<OpenPart> open_;
    Box3f box_, outside_;
};

}  // namespace

std::vector<InnerOccluder> prepareInner(const MeshView& mesh, std::span<const uint8_t> hides,
                                        std::span<const uint8_t> double_sided, const OccluderSettings& settings,
                                        const InnerSettings& inner) {
    const OccluderSource source{mesh, hides, double_sided};
    Patchwork patchwork = weld({&source, 1});
    orientDoubleSided(patchwork);
    LevelMaker maker(std::move(patchwork), inner);
    std::vector<InnerOccluder> out;
    if (!maker.hasSolids()) return out;
    size_t last = maker.triangles();
    float error = inner.first_error * maker.diagonal();
    for (uint32_t i = 0; i < inner.levels; ++i, error *= 2) {
        Level level = maker.make(error);
        if (static_cast<double>(level.triangles()) > double{inner.least_gain} * static_cast<double>(last)) continue;
        last = level.triangles();
        InnerOccluder& made = out.emplace_back();
        made.occluder = prepareOccluder({level.positions, level.indices}, {}, level.double_sided, settings);
        made.outside = maker.outside();
        made.error = error;
    }
    return out;
}

}  // namespace sightline
