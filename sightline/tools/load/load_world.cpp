// Carries a scene into a world: one object per drawn instance, one prepared occluder per mesh.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/load_world.h"

#include <algorithm>
#include <utility>

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

/// Takes what is asked for to a world.
Forms addForms(const PreparedMesh& prepared, const LoadSettings& settings, World& world) {
    Forms forms;
    if (!prepared.occluder.clusters.empty())
        forms.occluder = world.addOccluder(
            prepared.occluder, settings.inner ? std::span(prepared.inner) : std::span<const InnerOccluder>());
    if (prepared.occluder_is_shape) forms.shape = forms.occluder;
    else if (prepared.has_shape) forms.shape = world.addShape(prepared.shape);
    if (settings.clusters && prepared.clusters.count() > 0) forms.clusters = world.addClusters(prepared.clusters);
    return forms;
}

}  // namespace

/// The occluder holds the triangles whose material hides, the shape all; one record serves both where they are equal.
PreparedMesh prepareMesh(const Scene& scene, const Mesh& mesh, const LoadSettings& settings) {
    PreparedMesh out;
    if (mesh.deforms) return out;
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
        out.occluder = prepareOccluder(view, hides, double_sided, settings.occluders);
        if (settings.inner && hiding >= kDense)
            for (InnerOccluder& inner :
                 prepareInner(view, hides, double_sided, settings.occluders, settings.inner_occluders))
                out.inner.push_back(std::move(inner));
    }
    out.occluder_is_shape = hiding == hides.size();
    out.has_shape = !out.occluder_is_shape;
    if (out.has_shape) out.shape = prepareOccluder(view, {}, double_sided);
    if (settings.clusters && mesh.triangles() >= kClustered) {
        std::vector<MeshPart> parts;
        for (const Primitive& primitive : mesh.primitives)
            parts.push_back({primitive.first_triangle, primitive.triangle_count,
                             scene.materials[primitive.material].double_sided,
                             scene.materials[primitive.material].hides()});
        out.clusters = prepareDrawClusters(view, parts, settings.draw_clusters);
    }
    return out;
}

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
        const Mesh& mesh = scene.meshes[i];
        const PreparedMesh* before = settings.prepared.empty() ? nullptr : settings.prepared[i];
        forms[i] = addForms(before ? *before : prepareMesh(scene, mesh, settings), settings, loaded.world);
        if (settings.lods) forms[i].lods = loaded.world.addLods(lodLevels(mesh));
        if (progress && (i % 64 == 63 || i + 1 == scene.meshes.size())) progress(i + 1, scene.meshes.size());
    }
    loaded.ids.reserve(scene.objects.size());
    for (const SceneObject& object : scene.objects) {
        ObjectDef def;
        def.bounds = scene.meshes[object.mesh].bounds;
        def.transform = object.transform;
        def.key = object.key;
        if (!(object.changes & (SceneObject::kAnimated | SceneObject::kUnknown)))
            def.occluder = forms[object.mesh].occluder;
        def.shape = forms[object.mesh].shape;
        def.clusters = forms[object.mesh].clusters;
        def.lods = forms[object.mesh].lods;
        loaded.ids.push_back(loaded.world.add(def));
    }
    return loaded;
}

}  // namespace sightline::tools
