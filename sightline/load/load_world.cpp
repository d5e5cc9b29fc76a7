// Carries a scene into a world: one object per drawn instance, one prepared occluder per mesh.
// SPDX-License-Identifier: MIT
#include "sightline/load/load_world.h"

#include "sightline/prepare/occluder.h"

namespace sightline {
namespace {

/// The occluder of a mesh: the triangles whose material hides.
Occluder occluderOf(const Scene& scene, const Mesh& mesh) {
    if (mesh.deforms) return Occluder();
    std::vector<uint8_t> hides(mesh.triangles(), 0), double_sided(mesh.triangles(), 0);
    for (const Primitive& primitive : mesh.primitives) {
        const Material& material = scene.materials[primitive.material];
        for (uint32_t t = 0; t < primitive.triangle_count; ++t) {
            hides[primitive.first_triangle + t] = material.hides();
            double_sided[primitive.first_triangle + t] = material.double_sided;
        }
    }
    return prepareOccluder({mesh.positions, mesh.indices}, hides, double_sided);
}

}  // namespace

LoadedWorld loadWorld(const Scene& scene, const std::function<void(size_t, size_t)>& progress, bool volumes) {
    WorldDef world;
    world.volumes = volumes;
    LoadedWorld loaded{World::create(world), {}};
    std::vector<OccluderId> occluders(scene.meshes.size());
    for (size_t i = 0; i < scene.meshes.size(); ++i) {
        const Occluder occluder = occluderOf(scene, scene.meshes[i]);
        if (occluder.triangleCount() > 0) occluders[i] = loaded.world.addOccluder(occluder);
        if (progress && (i % 64 == 63 || i + 1 == scene.meshes.size())) progress(i + 1, scene.meshes.size());
    }
    loaded.ids.reserve(scene.objects.size());
    for (const SceneObject& object : scene.objects) {
        ObjectDef def;
        def.bounds = scene.meshes[object.mesh].bounds;
        def.transform = object.transform;
        def.key = object.key;
        def.occluder = occluders[object.mesh];
        loaded.ids.push_back(loaded.world.add(def));
    }
    return loaded;
}

}  // namespace sightline
