// Makes an occluder from a mesh: its hiding triangles, bit for bit, in pairs and clusters.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/occluder.h"

#include <algorithm>

#include "sightline/prepare/clusters.h"
#include "sightline/prepare/quads.h"

namespace sightline {

Occluder prepareOccluder(const MeshView& mesh, std::span<const uint8_t> hides, std::span<const uint8_t> double_sided,
                         const OccluderSettings& settings) {
    const OccluderSource source{mesh, hides, double_sided};
    Patchwork patchwork = weld({&source, 1});
    pairTriangles(patchwork);
    const Runs runs = sortIntoRuns(patchwork, true, std::clamp(settings.own_polygons, 3u, OccluderCluster::kMaxOwn));
    Occluder out;
    addClusters(out, patchwork, runs, 0, runs.runs.size());
    return out;
}

}  // namespace sightline
