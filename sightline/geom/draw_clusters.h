// What a renderer draws a mesh by: clusters of its triangles, in an order of their own, that can be culled one by one.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/base/memory.h"
#include "sightline/geom/facing_clusters.h"

namespace sightline {

/// Clusters of one mesh in object space, each a run of triangles of one part (a material, say). Those of single-sided parts
/// come first, and are culled where they are seen from their backs, too. Plain data; prepareDrawClusters() makes it.
///
/// Not for what is skinned, morphed, or moved by a shader: positions are the mesh's own.
struct DrawClusters {
    static constexpr size_t kPadding = 8;
    /// Rows of `bounds`: a number of each cluster after the other.
    enum BoundsRow { kMin = 0, kMax = 3, kBoundsRows = 6 };

    /// By their place in the mesh's index buffer / 3, cluster by cluster: a renderer's index buffer in this order is what
    /// ranges of triangles are of.
    Array<uint32_t> triangles;
    Array<uint32_t> first;  ///< per cluster and one more: its first place in `triangles`
    Array<uint32_t> part;   ///< per cluster
    size_t stride = 0;      ///< of the rows: clusters rounded up to kPadding; the padding is as the last cluster
    Array<float> bounds;    ///< [size: kBoundsRows * stride]
    FacingClusters facing;  ///< of the first clusters: those of single-sided parts

    explicit DrawClusters(Memory* memory = defaultMemory())
        : triangles(memory), first(memory), part(memory), bounds(memory), facing(memory) {}

    size_t count() const { return part.size(); }
    const float* row(int row) const { return bounds.data() + static_cast<size_t>(row) * stride; }
};

}  // namespace sightline
