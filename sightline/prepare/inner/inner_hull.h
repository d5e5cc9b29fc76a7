// Makes the surface of a solid simpler so that what it holds only shrinks: sides collapse inward, by exact predicates.
// SPDX-License-Identifier: MIT
//
// Pedro Sander, Xianfeng Gu, Steven Gortler, Hugues Hoppe, John Snyder. Silhouette Clipping. 2000 (progressive hulls).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sightline/prepare/inner/solids.h"
#include "sightline/prepare/inner/triangle_grid.h"

namespace sightline {

/// A solid on its way to fewer triangles.
///
/// Why it only shrinks. Let w(q) be how often the surface winds around a point q: 1 inside and 0 outside of the solid
/// as it was given. A step moves one or two vertices, a and b, to a place v, and with them the triangles f that have
/// them as corners. The surface before, less the surface after, is the sum of the outsides of the tetrahedra (v, f):
/// their other faces cancel in pairs, or are those of the surface after. A step is taken only if
///
///   1. v lies on or behind each of these f, so that each tetrahedron takes 1 away from w in its inside or is flat;
///   2. no triangle of the surface meets the inside of a tetrahedron, so that w is the same all over it, and, since it
///      is so just behind f, 1 or more; tetrahedra overlap at most behind triangles that lie in each other.
///
/// Both are decided exactly. So w is never negative and never greater than it was, the new triangles lie in tetrahedra
/// where w was 1 or more, and by induction all that is ever made lies inside of the solid as it was given or on its
/// surface. A ray that comes from outside of it and meets a triangle of this hull has met the solid's surface from the
/// front before, or meets it there.
class InnerHull {
public:
    /// @param solid  of the list of triangles
    InnerHull(std::span<const glm::vec3> positions, std::span<const SolidTriangle> triangles, const Solid& solid);

    /// Collapses sides, those first that cost least, until there are no more than so many triangles or the surface
    /// would lie farther inside than `worst`, about. May be called again with other limits.  [world units of the
    /// positions]
    void simplify(uint32_t most_triangles, float worst);

    std::span<const glm::vec3> positions() const { return positions_; }
    std::vector<SolidTriangle> triangles() const;
    uint32_t triangleCount() const { return living_; }
    float error() const { return error_; }  ///< how far inside the surface may lie, about

private:
    struct Candidate {
        float cost;
        uint32_t a, b;
        uint32_t version;                               ///< of a and b together
        bool operator<(const Candidate& other) const {  // std heaps keep the largest at the front
            return cost != other.cost ? cost > other.cost : a != other.a ? a > other.a : b > other.b;
        }
    };
    /// What a collapse would make.
    struct Step {
        glm::vec3 to{0.0f};
        float depth = 0;  ///< how far the surface moves
    };

    const glm::vec3& corner(uint32_t triangle, int k) const { return positions_[triangles_[triangle].vertex[k]]; }
    Box3f boxOf(uint32_t triangle) const;
    void rebuildGrid();
    void gatherStar(uint32_t a, uint32_t b);
    bool isLinked(uint32_t a, uint32_t b);
    bool tryPlace(uint32_t a, uint32_t b, const glm::vec3& to, Step& best) const;
    bool plan(uint32_t a, uint32_t b, Step& step);
    glm::dvec3 pushInside(glm::dvec3 place) const;
    bool leastLoss(glm::dvec3& place) const;
    bool isClear(const glm::vec3& to);
    void apply(uint32_t a, uint32_t b, const Step& step);
    void offer(uint32_t a, uint32_t b);
    void offerAround(uint32_t vertex);

    std::vector<glm::vec3> positions_;
    std::vector<SolidTriangle> triangles_;
    std::vector<uint8_t> alive_;
    std::vector<std::vector<uint32_t>> around_;  ///< per vertex: living triangles
    std::vector<uint32_t> version_;              ///< per vertex: counts the changes around it
    std::vector<float> errors_;                  ///< per vertex
    std::vector<Candidate> heap_;
    std::unique_ptr<TriangleGrid> grid_;
    uint32_t living_ = 0, grid_living_ = 0;
    float error_ = 0, rounding_ = 0;
    std::vector<uint32_t> star_;      ///< of the step at hand: triangles
    std::vector<glm::dvec4> planes_;  ///< and their planes
    std::vector<double> areas_;       ///< and twice their areas
    std::vector<uint32_t> met_;       ///< per triangle: the test that met it last
    uint32_t test_ = 0;
    std::vector<uint32_t> marked_;  ///< per vertex
    uint32_t mark_ = 0;
};

}  // namespace sightline
