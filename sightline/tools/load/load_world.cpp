// Carries a scene into a world: one object per drawn instance, one prepared occluder per mesh.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/load_world.h"

#include <algorithm>

#include "sightline/prepare/facing/draw_clusters.h"
#include "sightline/tools/load/mesh_lods.h"

namespace sightline::tools {
namespace {

constexpr size_t kClustered = 128;  // triangles: below that a mesh is drawn whole
constexpr size_t kDense = 200;      // triangles: below that a simpler occluder is no cheaper

/// What a mesh hides with, and what it is asked about.
struct Forms {
    OccluderId occluder, shape;
    ClustersId clusters;
    LodsId lods;
};

/// The occluder holds the triangles whose material hides, the shape all; one record serves both where they are equal.
Forms formsOf(const Scene& scene, const Mesh& mesh, const LoadSettings& settings, World& world) {
    Forms forms;
    if (settings.lods) forms.lods = world.addLods(lodLevels(mesh));
    if (mesh.deforms) return forms;
    std::vector<uint8_t> hides(mesh.triangles(), 0), double_sided(mesh.triangles(), 0);
    for (const Primitive& primitive : mesh.primitives) {
        const Material& material = scene.materials[primitive.material];
        for (uint32_t t = 0; t < primitive.triangle_count; ++t) {
            hides[primitive.first_triangle + t] = material.hides();
            double_sided[primitive.first_triangle + t] = material.double_sided;
        }
    }
    const MeshView view{mesh.positions, mesh.indices};
    const size_t hiding = static_cast<size_t>(std::count(hides.begin(), hides.end(), 1));
    if (hiding > 0) {
        const Occluder occluder = prepareOccluder(view, hides, double_sided, settings.occluders);
        std::vector<InnerOccluder> inner;
        if (settings.inner && hiding >= kDense)
            inner = prepareInner(view, hides, double_sided, settings.occluders, settings.inner_occluders);
        if (occluder.triangleCount() > 0) forms.occluder = world.addOccluder(occluder, inner);
    }
    if (hiding == hides.size()) forms.shape = forms.occluder;
    else forms.shape = world.addShape(prepareOccluder(view, {}, double_sided));
    if (settings.clusters && mesh.triangles() >= kClustered) {
        std::vector<MeshPart> parts;
        for (const Primitive& primitive : mesh.primitives)
            parts.push_back({primitive.first_triangle, primitive.triangle_count,
                             scene.materials[primitive.material].double_sided,
                             scene.materials[primitive.material].hides()});
        forms.clusters = world.addClusters(prepareDrawClusters(view, parts, settings.draw_clusters));
    }
    return forms;
}

}  // namespace

LoadSettings loadSettings(bool volumes, double occluder_error, bool clusters, double cluster_test) {
    LoadSettings settings;
    settings.volumes = volumes;
    settings.inner = occluder_error > 0;
    settings.clusters = clusters;
    settings.draw_clusters.cost.test = cluster_test;
    return settings;
}

LoadSettings loadSettings(const QuerySettings& settings, double cluster_test) {
    LoadSettings load =
        loadSettings((settings.stages & stageBit(Stage::kVolumes)) != 0 || settings.proofs, settings.occluder_error,
                     (settings.stages & stageBit(Stage::kClusters)) != 0, cluster_test);
    load.lods = (settings.stages & stageBit(Stage::kLod)) != 0;
    return load;
}

LoadedWorld loadWorld(const Scene& scene, const std::function<void(size_t, size_t)>& progress,
                      const LoadSettings& settings) {
    WorldDef world;
    world.volumes = settings.volumes;
    LoadedWorld loaded{World::create(world), {}};
    std::vector<Forms> forms(scene.meshes.size());
    for (size_t i = 0; i < scene.meshes.size(); ++i) {
        forms[i] = formsOf(scene, scene.meshes[i], settings, loaded.world);
        if (progress && (i % 64 == 63 || i + 1 == scene.meshes.size())) progress(i + 1, scene.meshes.size());
    }
    loaded.ids.reserve(scene.objects.size());
    for (const SceneObject& object : scene.objects) {
        ObjectDef def;
        def.bounds = scene.meshes[object.mesh].bounds;
        def.transform = object.transform;
        def.key = object.key;
        def.occluder = forms[object.mesh].occluder;
        def.shape = forms[object.mesh].shape;
        def.clusters = forms[object.mesh].clusters;
        def.lods = forms[object.mesh].lods;
        loaded.ids.push_back(loaded.world.add(def));
    }
    return loaded;
}

}  // namespace sightline::tools
