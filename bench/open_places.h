// Places of an image where something may be seen past what lies before it: beside outlines, seams and corners.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "bench/occlusion_scenes.h"
#include "sightline/base/random.h"
#include "sightline/tools/truth/rays.h"
#include "sightline/tools/truth/sight.h"

namespace sightline::bench {
using namespace tools;

/// The edges of a scene's batches, each once, with what meets there.
class SceneEdges {
public:
    struct Edge {
        glm::vec3 a{0.0f}, b{0.0f};
        glm::dvec4 plane[2];     ///< of the first two triangles: positive before them
        uint32_t triangles = 0;  ///< that have it
        bool seam = false;       ///< of different batches

        /// Whether it may bound the image of what is drawn, or parts of it that were drawn apart.
        bool mayShow(const glm::dvec3& eye) const {
            const auto before = [&](const glm::dvec4& p) { return glm::dot(glm::dvec3(p), eye) + p.w > 0; };
            if (triangles == 1) return before(plane[0]);
            return triangles > 2 || seam || before(plane[0]) != before(plane[1]);
        }
    };
    explicit SceneEdges(const OcclusionScene& scene);
    const std::vector<Edge>& edges() const { return edges_; }

private:
    std::vector<Edge> edges_;
};

/// Cells of the image that something may meet.
struct PlaceRect {
    uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< inclusive
    bool empty = true;
};

/// Points on edges that no other surface hides, as they appear.
class OpenPlaces {
public:
    OpenPlaces() = default;
    OpenPlaces(const SceneEdges& edges, const RayScene& rays, const SightLines& sight, const View& view, uint32_t about,
               uint64_t seed);

    PlaceRect rectOf(const View& view, const Box3f& box) const;

    /// A place beside an edge within some cells, from a billionth of a pixel to a third of one from it; false if none
    /// was found there.
    /// @param place  clip x, y over w
    bool pick(const PlaceRect& rect, Random& random, glm::dvec2& place) const;

    size_t size() const { return places_.size(); }

private:
    static constexpr uint32_t kCell = 4;  ///< [pixels]

    struct Place {
        glm::dvec2 at{0.0};      ///< clip x, y over w
        glm::dvec2 beside{0.0};  ///< one pixel, across the edge
    };
    uint32_t cellOf(const glm::dvec2& place) const;

    glm::dvec2 size_{0.0};  ///< of the image [pixels]
    uint32_t columns_ = 0, rows_ = 0;
    std::vector<uint32_t> first_;  ///< per cell, into places_  [size: cells + 1]
    std::vector<Place> places_;    ///< by their cells
};

}  // namespace sightline::bench
