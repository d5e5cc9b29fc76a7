// Makes one part of a mesh simpler by collapsing edges, and gives its corners vertices of the part again.
// SPDX-License-Identifier: MIT
//
// Michael Garland, Paul Heckbert. Surface Simplification Using Quadric Error Metrics. 1997.
// Jarek Rossignac, Paul Borrel. Multi-Resolution 3D Approximations for Rendering Complex Scenes. 1993 (the sloppy way).
// Arseny Kapoulkine. meshoptimizer 0.18. 2022 (both are its).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sightline/geom/mesh_view.h"

namespace sightline {

/// One part, ready to be made simpler to any degree.
class PartSimplifier {
public:
    /// @param mesh          is read in place as long as this lives; the positions that the part names are finite
    /// @param indices       of the part
    /// @param place         per vertex of the mesh, the same where the positions are
    /// @param lock_borders  open borders stay as they are, because another part goes on there
    PartSimplifier(const MeshView& mesh, std::span<const uint32_t> indices, std::span<const uint32_t> place,
                   bool lock_borders);

    size_t triangles() const { return indices_.size() / 3; }

    /// Collapses edges until so many triangles are left, or until the next one would err by more than `error`, as the
    /// quadrics estimate it. Neither may be reached: the surface's connectivity is kept.
    /// @param error  [object space units]
    /// @return  indices of places of the part, three of a triangle; see writeCorners()
    std::vector<uint32_t> collapse(size_t triangles, double error) const;

    /// Merges what lies in the same cell of a grid, which keeps neither connectivity nor borders.
    std::vector<uint32_t> merge(size_t triangles) const;

    /// Appends triangles by vertices of the mesh. Where the part has several vertices in one place, a corner gets the
    /// one whose own triangles lie most like the new one: by their normals, and by the way from the place to their
    /// middles.
    void writeCorners(std::span<const uint32_t> triangles, std::vector<uint32_t>& out) const;

private:
    /// A vertex of the part, and how the triangles around it lie.
    struct Copy {
        uint32_t vertex;
        uint32_t next;  ///< of the same place; kNone: it is the last
        glm::dvec3 normal{0.0}, way{0.0};
    };
    static constexpr uint32_t kNone = ~uint32_t{0};

    Copy* copyOf(uint32_t local, uint32_t vertex);  ///< null: the place has too many
    glm::dvec3 positionOf(uint32_t local) const;

    MeshView mesh_;
    bool lock_borders_;
    double extent_ = 0;              ///< of the part along its longest axis
    double scale_ = 0;               ///< of the simplifier's errors, in extents
    std::vector<glm::vec3> places_;  ///< of the part's triangles, in extents from the middle of their box
    std::vector<uint32_t> indices_;  ///< of these; triangles that name one twice are left out
    std::vector<uint32_t> first_;    ///< per place, of copies_
    std::vector<Copy> copies_;
};

}  // namespace sightline
