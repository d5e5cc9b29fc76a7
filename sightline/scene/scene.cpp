// A scene as plain data: what an importer fills and what a world, a renderer or a witness reads.
// SPDX-License-Identifier: MIT
#include "sightline/scene/scene.h"

namespace sightline {

uint64_t drawnTriangles(const Scene& scene) {
    uint64_t count = 0;
    for (const SceneObject& object : scene.objects) count += scene.meshes[object.mesh].triangles();
    return count;
}

Box3d worldBounds(const Scene& scene) {
    Box3d bounds;
    for (const SceneObject& object : scene.objects)
        bounds.grow(transformBox(scene.meshes[object.mesh].bounds, object.transform));
    return bounds;
}

}  // namespace sightline
