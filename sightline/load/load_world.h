// Carries a scene into a world: one object per drawn instance, one prepared occluder per mesh.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "sightline/run/world.h"
#include "sightline/scene/scene.h"

namespace sightline {

struct LoadedWorld {
    World world;
    std::vector<ObjectId> ids;  ///< [size: scene.objects; the same order]
};

/// Deforming meshes and materials that do not hide give no occluder triangles.
/// @param progress  called with (done, total) meshes now and then; may be empty
/// @param volumes   WorldDef::volumes
LoadedWorld loadWorld(const Scene& scene, const std::function<void(size_t, size_t)>& progress = {},
                      bool volumes = false);

}  // namespace sightline
