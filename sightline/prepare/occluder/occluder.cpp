// Makes occluders from meshes: their hiding triangles in pairs, in clusters that hang together, with edges.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/occluder/occluder.h"

#include <algorithm>

#include "sightline/prepare/occluder/clusters.h"
#include "sightline/prepare/occluder/junctions.h"
#include "sightline/prepare/occluder/merge.h"
#include "sightline/prepare/occluder/orient.h"
#include "sightline/prepare/occluder/quads.h"
#include "sightline/geom/make_plane_mesh.h"

namespace sightline {
namespace {

constexpr uint32_t kRoomForRing = 40;  // vertices

/// The sources' polygons, and the clusters that they become.
struct Prepared {
    Patchwork patchwork;
    Runs runs;
};

Prepared prepare(std::span<const OccluderSource> sources, const OccluderSettings& settings, bool by_mesh) {
    Prepared out;
    out.patchwork = weld(sources);
    orientDoubleSided(out.patchwork);
    pairTriangles(out.patchwork);
    if (settings.merge) mergeCoplanar(out.patchwork, by_mesh);
    if (settings.junctions) findJunctions(out.patchwork);
    RunLimits limits;
    limits.by_mesh = by_mesh;
    limits.reach_across = settings.rings;
    limits.most_joined = std::clamp(settings.own_polygons, 3u, OccluderCluster::kMaxOwn);
    limits.most_folded = std::clamp(settings.folded_polygons, 3u, limits.most_joined);
    limits.most_loose = OccluderCluster::kMaxLoose;
    limits.most_vertices = OccluderCluster::kMaxVertices - (settings.rings ? kRoomForRing : 0);
    out.runs = sortIntoRuns(out.patchwork, limits);
    return out;
}

}  // namespace

Occluder prepareOccluder(const MeshView& mesh, std::span<const uint8_t> hides, std::span<const uint8_t> double_sided,
                         const OccluderSettings& settings) {
    const OccluderSource source{mesh, hides, double_sided};
    return prepareJoined({&source, 1}, settings);
}

std::vector<Occluder> prepareOccluders(std::span<const OccluderSource> sources, const OccluderSettings& settings) {
    const Prepared prepared = prepare(sources, settings, true);
    std::vector<Occluder> out(sources.size());
    ClusterWriter writer(prepared.patchwork, prepared.runs, settings.rings);
    for (const Runs::Run& run : prepared.runs.runs)
        writer.add(out[prepared.patchwork.polygons[prepared.runs.order[run.first]].mesh], run);
    for (Occluder& of_mesh : out) makePlaneMesh(of_mesh);
    return out;
}

Occluder prepareJoined(std::span<const OccluderSource> sources, const OccluderSettings& settings) {
    const Prepared prepared = prepare(sources, settings, false);
    Occluder out;
    ClusterWriter writer(prepared.patchwork, prepared.runs, settings.rings);
    for (const Runs::Run& run : prepared.runs.runs) writer.add(out, run);
    makePlaneMesh(out);
    return out;
}

}  // namespace sightline
