// What a renderer draws a mesh by: clusters of its triangles, in an order of their own, that can be culled one by one.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/base/array.h"
#include "sightline/geom/facing_clusters.h"
#include "sightline/math/box.h"

namespace sightline {

/// Clusters next to one another that bound a solid: they have backs for eyes outside of it.
struct ClosedClusters {
    uint32_t first = 0, count = 0;
    Box3f box;  ///< of the solid
};

/// Clusters of one mesh in object space, each a run of triangles of one part (a material, say). Those of single-sided parts
/// come first; then double-sided ones that bound solids, of which an eye outside of the solids never sees the inner side: these
/// may be culled where they are seen from their backs. Plain data; prepareDrawClusters() makes it.
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
    FacingClusters facing;  ///< of the first clusters: those that have backs
    /// Clusters among these, the last ones, that bound solids: one after the other, solid by solid.
    Array<ClosedClusters> closed;

    explicit DrawClusters(Memory* memory = defaultMemory())
        : triangles(memory), first(memory), part(memory), bounds(memory), facing(memory), closed(memory) {}

    size_t count() const { return part.size(); }
    const float* row(int row) const { return bounds.data() + static_cast<size_t>(row) * stride; }
};

}  // namespace sightline
