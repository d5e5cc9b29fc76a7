// Back faces by the cluster: many clusters' volumes and cones at once, trees of them, and masks of single triangles.
// SPDX-License-Identifier: MIT
//
// Andreas Johannsen, Michael Carter. Clustered Backface Culling. 1998.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/geom/facing_clusters.h"
#include "sightline/geom/facing_eye.h"

namespace sightline {

/// Tests of a cluster. A cluster is back-facing if any of them says so.
enum FacingTests : uint32_t {
    kVolumeTest = 1,  ///< CullingVolume
    kTurnedTest = 2,  ///< TurnedBox; does nothing if the clusters have none
    kConeTest = 4,    ///< FacingCone; does nothing if the clusters have none
    kAllFacingTests = 7,
};

/// Sets bit i % 8 of back[i / 8] for each cluster of which every triangle is surely seen from its back or edge-on, and
/// returns how many there are. The same on every instruction set. Where clockwise is front, only kVolumeTest finds any.
/// @param tests  bits of FacingTests
/// @param back   [size: >= ceil(count / 16) * 2]
size_t findBackClusters(const FacingClusters& clusters, const FacingEye& eye, uint32_t tests, std::span<uint8_t> back);

/// The same for clusters of which every triangle is surely seen from its front: their triangles need no test.
size_t findFrontClusters(const FacingClusters& clusters, const FacingEye& eye, std::span<uint8_t> front);

/// As findBackClusters() with kVolumeTest, through a tree: clusters below a node that decides are not tested. Returns
/// how many volumes were tested.
size_t walkFacingTree(const FacingTree& tree, const FacingClusters& clusters, const FacingEye& eye,
                      std::span<uint8_t> back);

/// Triangles to draw, in the order of FacingClusters::triangles.
struct TriangleRange {
    uint32_t first = 0, count = 0;
};

/// Writes the triangles of all other clusters, in runs. Returns how many runs there are.
/// @param back    of findBackClusters()
/// @param gap     runs with as many triangles or fewer between them are joined, for fewer draws  [0: only neighbours]
/// @param ranges  [size: >= clusters.count() / 2 + 1]
size_t remainingRanges(const FacingClusters& clusters, std::span<const uint8_t> back, uint32_t gap,
                       std::span<TriangleRange> ranges);

/// The bits of a cluster's triangles that are seen from their backs, (size + 63) / 64 words; null if nothing is known: no
/// masks, an eye in the box around the cluster, or clockwise fronts.
const uint64_t* backTriangles(const FacingClusters& clusters, size_t cluster, const FacingEye& eye);

}  // namespace sightline
