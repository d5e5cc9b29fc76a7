// The last stage of a query: of kept objects only the clusters that face the eye, lie in the view and are not hidden.
// SPDX-License-Identifier: MIT
//
// Andreas Johannsen, Michael Carter. Clustered Backface Culling. 1998.
// Ulrich Haar, Sebastian Aaltonen. GPU-Driven Rendering Pipelines. 2015.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/run/bins.h"
#include "sightline/run/explain.h"
#include "sightline/run/query.h"

namespace sightline::detail {

/// What it needs stays from answer to answer.
class ClusterStage {
public:
    explicit ClusterStage(Memory* memory) : ranges_(memory), culled_(memory), left_(memory) {}

    /// Looks at the clusters of what a walk has kept, takes objects of which nothing is left out of its answer, and
    /// counts. Does nothing unless the view uses the stage and some object has clusters.
    ///
    /// Clusters are hidden by what the walk drew. That is sound as the second look is: along each ray the nearest
    /// point of all that is drawn has nothing in front of it, so that its cluster is kept, and hides what others hid. Of a
    /// view in bins no cluster is asked whether it is hidden.
    void run(const SnapshotState* now, const View& view, BinnedWalk& walk);

    std::span<const DrawRange> ranges() const { return ranges_; }
    /// What it found of one object's clusters, after run() of the same walk; nothing of one without.
    ClustersReason look(const SnapshotState& now, uint32_t row, const View& view, BinnedWalk& walk);
    /// Notes what it culled among an answer's reasons.
    void reasons(const SnapshotState& now, std::span<uint8_t> reasons) const;

private:
    /// A walk's buffer; null: nothing is asked whether it is hidden.
    struct Buffer {
        const Screen* screen = nullptr;
        DepthTiles* tiles = nullptr;
    };
    static Buffer bufferOf(BinnedWalk& walk);
    bool select(const DrawClusters& clusters, const ObjectRecord& object, const View& view, const Buffer& buffer,
                uint32_t visible, QueryStats& stats);
    void findFacing(const DrawClusters& clusters, const ObjectRecord& object, const View& view, const Screen* screen,
                    QueryStats& stats);
    void findSeen(const DrawClusters& clusters, const View& view, const Screen* screen, DepthTiles* tiles,
                  QueryStats& stats);
    void addRanges(const DrawClusters& clusters, uint32_t gap, uint32_t visible, QueryStats& stats);

    Array<DrawRange> ranges_;
    Array<uint32_t> culled_;  ///< rows
    Array<uint8_t> left_;     ///< a bit per cluster of the object at hand
};

}  // namespace sightline::detail
