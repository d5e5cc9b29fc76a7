// Carries a scene into a world: one object per drawn instance, one prepared occluder per mesh.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "sightline/geom/prepared_mesh.h"
#include "sightline/geom/query_settings.h"
#include "sightline/prepare/facing/draw_clusters.h"
#include "sightline/prepare/inner/inner.h"
#include "sightline/tools/scene/scene.h"
#include "sightline/world/world.h"

namespace sightline::tools {

struct LoadedWorld {
    World world;
    std::vector<ObjectId> ids;  ///< [size: scene.objects; the same order]
};

struct LoadSettings {
    bool volumes = true;         ///< WorldDef::volumes
    OccluderSettings occluders;  ///< how each mesh is prepared
    bool inner = false;          ///< prepare simpler occluders for dense meshes, too: prepareInner()
    InnerSettings inner_occluders;
    bool clusters = false;  ///< prepare clusters of meshes of some size, too: prepareDrawClusters()
    DrawClusterSettings draw_clusters;
    bool lods = false;  ///< tell the world the levels that meshes have, and what they take to draw: addMeshLods()
    /// What was prepared of meshes before, of which what is asked for above is taken. Null, or no mesh: it is prepared now.
    std::span<const PreparedMesh* const> prepared;  ///< [size: Scene::meshes, or 0]
};

/// What a world needs of a mesh, but for its levels of detail.
PreparedMesh prepareMesh(const Scene& scene, const Mesh& mesh, const LoadSettings& settings);

/// What queries with these settings need.
/// @param cluster_test  of Stage::kClusters: what a test costs, in triangles: FacingCost::test
LoadSettings loadSettings(const QuerySettings& settings, double cluster_test = FacingCost().test);

/// The same, piece by piece.
/// @param occluder_error  QuerySettings::occluder_error of the queries to come; 0: no simpler occluders are prepared
/// @param clusters        prepare them, for a test that costs so many triangles: FacingCost::test
LoadSettings loadSettings(bool volumes, double occluder_error, bool clusters = false,
                          double cluster_test = FacingCost().test);

/// Deforming meshes, materials that do not hide, and objects that the file may move, show or hide give no occluder triangles.
/// @param progress  called with (done, total) meshes now and then; may be empty
LoadedWorld loadWorld(const Scene& scene, const std::function<void(size_t, size_t)>& progress = {},
                      const LoadSettings& settings = {});

}  // namespace sightline::tools
