// Makes the records of clusters, from runs of triangles that are given.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "sightline/geom/facing_clusters.h"
#include "sightline/geom/mesh_view.h"
#include "sightline/math/box.h"

namespace sightline {

/// Which records to make, and where the eyes are supposed to be.
struct FacingSettings {
    bool turned = true;  ///< TurnedBox: 60 bytes a cluster
    bool cones = true;   ///< FacingCone: 28 bytes
    uint32_t mask_steps =
        0;                   ///< TriangleMasks: 6 * steps * steps bits a triangle  [limit: <= TriangleMasks::kMaxSteps]
    double eye_space = 3.0;  ///< eyes are in the mesh's box, made larger by this factor around its centre
    /// Eyes are in each cluster's own box, made larger by the factor, instead: of use where they come close.
    bool near_eyes = false;
};

/// The box of eyes for a box of triangles. One without an extent along an axis has the largest one's there.
Box3d eyeSpace(const Box3d& triangles, double factor);

/// The records of given clusters. O(triangles * records).
/// @param triangles  by their place in mesh.indices / 3; a permutation, or a part of one
/// @param sizes      of the clusters, in that order; their sum is triangles.size()
FacingClusters describeClusters(const MeshView& mesh, std::span<const uint32_t> triangles,
                                std::span<const uint32_t> sizes, const FacingSettings& settings = {},
                                Memory* memory = defaultMemory());

/// Nodes over clusters, next to one another as they are in their order, wherever a node is likely to save more than its own test
/// costs: one over k clusters or nodes does if it culls with a probability of more than 1 / k. Pairs first.
FacingTree makeFacingTree(const FacingClusters& clusters, const MeshView& mesh, const FacingSettings& settings = {},
                          Memory* memory = defaultMemory());

}  // namespace sightline
