// What `bake --prepare` puts into the file of a scene's meshes.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "sightline/base/result.h"
#include "sightline/tools/scene/scene.h"
#include "sightline/visfile/prepared_section.h"

namespace sightline::cli {
using namespace tools;

inline const std::vector<std::string> kPrepareWords = {"occluders", "inner", "clusters", "lods"};

/// Prepares each mesh as the tool does when it loads the scene.
/// @param words    of kPrepareWords; occluders and shapes are prepared in any case
/// @param threads  0: one a core
/// @returns with PreparedMeshes::mesh_of_object per object of the scene
PreparedMeshes prepareForFile(const Scene& scene, const std::vector<std::string>& words, uint32_t threads);

}  // namespace sightline::cli
