// Prepares the meshes of a scene for a visibility file.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/bake_prepared.h"

#include <algorithm>

#include "apps/cli/shell/progress.h"
#include "apps/cli/verbs/cull_path.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/load/mesh_lods.h"

namespace sightline::cli {
using namespace tools;

PreparedMeshes prepareForFile(const Scene& scene, const std::vector<std::string>& words, uint32_t threads) {
    const auto asked = [&](const char* word) { return std::find(words.begin(), words.end(), word) != words.end(); };
    LoadSettings settings;
    settings.inner = asked("inner");
    settings.clusters = asked("clusters");
    const bool lods = asked("lods");
    PreparedMeshes out;
    out.meshes.resize(scene.meshes.size());
    Progress progress("preparing", "meshes", scene.meshes.size());
    forEach(scene.meshes.size(), threads, [&](size_t i) {
        out.meshes[i] = prepareMesh(scene, scene.meshes[i], settings);
        if (lods) out.meshes[i].lods = lodChainOf(scene.meshes[i]);
        progress.step();
    });
    for (const SceneObject& object : scene.objects) out.mesh_of_object.push_back(object.mesh);
    return out;
}

}  // namespace sightline::cli
