// Writes runs of polygons as an occluder's clusters, with the edges and rings of those that hang together.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/geom/occluder.h"
#include "sightline/prepare/occluder/runs.h"
#include "sightline/prepare/occluder/side_pairs.h"

namespace sightline {

/// A polygon's side by the cluster's numbers of its vertices.
struct LocalSide : PatchSide {
    uint8_t member;  ///< the polygon's number in the cluster
};

/// Makes one cluster after the other; keeps what they would otherwise allocate again and again.
class ClusterWriter {
public:
    /// Both must outlive the writer.
    ClusterWriter(const Patchwork& patchwork, const Runs& runs, bool rings);

    /// Adds a run as a cluster. O(its polygons and their neighbours).
    void add(Occluder& out, const Runs::Run& run);

private:
    uint8_t localOf(uint32_t vertex);
    void addPolygons(Occluder& out);
    void addRing();
    void addEdges(Occluder& out);
    void addVertices(Occluder& out);

    const Patchwork& patchwork_;
    const Runs& runs_;
    std::vector<uint32_t> first_around_, around_;  ///< per vertex: polygons that have it; none without rings
    std::vector<uint32_t> met_;                    ///< per vertex: the cluster that met it last
    std::vector<uint8_t> local_;                   ///< per vertex: its number there
    std::vector<uint32_t> met_polygon_;            ///< per polygon: the cluster that met it last
    std::vector<uint32_t> touched_;                ///< per vertex: the cluster whose own polygons have it
    std::vector<uint32_t> touching_;               ///< those vertices
    uint32_t mark_ = 0;
    std::vector<uint32_t> vertices_;  ///< of the cluster
    std::vector<uint32_t> members_;   ///< its polygons, its own first
    std::vector<LocalSide> sides_;
    std::vector<PatchSide> shared_;
    std::vector<SidePair> pairs_;
};

}  // namespace sightline
