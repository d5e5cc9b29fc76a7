// A triangle surface, ready to be measured against others: a tree and a table of its triangles.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sightline/geom/mesh_view.h"
#include "sightline/prepare/lod/triangle_tree.h"

namespace sightline {

/// The points of a mesh's triangles, and nothing else of it: vertices that no triangle names do not count, nor do
/// windings, normals or colours. Of a mesh with a triangle that is not finite it is known that it is so, and no more.
/// Plain reading from any number of threads.
class DistanceSurface {
public:
    /// O(n log n); about 400 bytes a triangle.
    /// @param mesh  is not kept
    explicit DistanceSurface(const MeshView& mesh);

    bool finite() const { return finite_; }
    size_t triangles() const { return corners_.size(); }
    size_t places() const { return places_; }
    const Box3d& box() const { return box_; }

    const TriangleCorners& corners(uint32_t triangle) const { return corners_[triangle]; }
    /// The corners' numbers among the places: the same where the positions are.
    const std::array<uint32_t, 3>& placesOf(uint32_t triangle) const { return vertices_[triangle]; }
    const TriangleTree& tree() const { return tree_; }

    /// Whether one of the triangles has exactly these corners, in any order.
    bool holds(const TriangleCorners& corners) const;

private:
    size_t slotOf(const TriangleCorners& sorted) const;

    bool finite_ = true;
    size_t places_ = 0;
    Box3d box_;
    std::vector<TriangleCorners> corners_;
    std::vector<std::array<uint32_t, 3>> vertices_;
    std::vector<uint32_t> slots_;  ///< triangles by the hash of their corners; a power of two, and never full
    TriangleTree tree_;
};

}  // namespace sightline
