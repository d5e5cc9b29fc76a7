// A tree of boxes over triangles that finds the one nearest to a point.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sightline/math/box.h"
#include "sightline/prepare/lod/near_triangle.h"

namespace sightline {

/// A triangle and how far it is from a point.
struct NearTriangle {
    double squared = 0;  ///< distance from a point of the triangle, so never less than the least one but for rounding
    uint32_t triangle = 0;
};

/// Halved at the median of the middles along the longest side of their box, down to two triangles. Made once, asked
/// by any number of threads.
class TriangleTree {
public:
    /// O(n log n); deterministic.
    /// @param triangles  of finite corners; a copy is kept
    explicit TriangleTree(std::span<const TriangleCorners> triangles);

    /// The nearest triangle, if it is nearer than the best one known so far, else that.
    /// @param enough  any triangle will do whose squared distance is no more
    NearTriangle nearest(const glm::dvec3& point, NearTriangle best, double enough = 0) const;

    /// A distance that no triangle is nearer than, but for 2^-47 of the largest coordinate. Proved for each triangle by
    /// a plane between it and the point, so that it does not rest on how well nearestPoint() does.
    /// @param known  some distance that one of them is within
    double leastDistance(const glm::dvec3& point, double known) const;

private:
    struct Node {
        Box3d box;
        uint32_t first = 0;  ///< of two children one after the other, or of the triangles of a leaf
        uint32_t count = 0;  ///< triangles; 0: it has children
    };

    /// Calls atLeaf(node) for leaves whose boxes are nearer than `squared`, nearer children first. It may lower that.
    template <class AtLeaf>
    void visit(const glm::dvec3& point, const double& squared, AtLeaf atLeaf) const;

    std::vector<Node> nodes_;  ///< the root first; none if there are no triangles
    std::vector<TriangleCorners> triangles_;
    std::vector<uint32_t> number_;  ///< of each of these in the list given
};

}  // namespace sightline
