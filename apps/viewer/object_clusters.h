// The clusters of one object's triangles: their edges, and from where each is seen from its backs alone.
// SPDX-License-Identifier: MIT
//
// Andreas Johannsen, Michael Carter. Clustered Backface Culling. 1998.
#pragma once

#include <cstdint>
#include <vector>

#include "apps/viewer/line_drawer.h"
#include "sightline/geom/draw_clusters.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::viewer {

class ObjectClusters {
public:
    static constexpr size_t kMostTriangles = 20'000;  ///< of an object; a larger one has none here

    /// @param scene  must outlive it
    ObjectClusters(const tools::Scene& scene, uint32_t object);

    uint32_t object() const { return object_; }
    size_t count() const { return clusters_.count(); }
    /// Of these, those that have backs, the first ones: of single-sided triangles, or around a solid.
    size_t withBacks() const { return clusters_.facing.count(); }
    /// How many of these an eye sees from their backs.  O(clusters)
    size_t back(const View& view) const;

    /// The edges of all clusters, each in a colour of its own; of what the view's eye sees from its backs, in grey.
    void addEdges(const View& view, LineDrawer& lines) const;
    /// The culling volume of a cluster: an eye in it sees all of the cluster's triangles from their backs. As much of it as
    /// lies in the object's box, made three times as large; nothing if there is none.
    /// @param cluster  [limit: below withBacks()]
    void addVolume(size_t cluster, LineDrawer& lines) const;

private:
    std::vector<uint8_t> backOf(const View& view) const;

    const tools::Scene& scene_;
    const uint32_t object_;
    DrawClusters clusters_;
};

}  // namespace sightline::viewer
