// Assimp's materials as Sightline's: what may hide, and from which sides.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include <assimp/scene.h>

#include "apps/import/texture_alpha.h"
#include "sightline/import/scene_kind.h"
#include "sightline/import/scene_stream.h"

namespace sightline::import {

/// Sends each material when it is first used.
class Materials {
public:
    Materials(const aiScene& scene, SidesRule sides, std::string folder, SceneStreamWriter& out);

    /// The index, in the stream, of a mesh's material. A mesh with vertex colours that are not opaque has a material of its own.
    uint32_t of(const aiMesh& mesh);

private:
    Material convert(const aiMaterial& material);

    const aiScene& scene_;
    SidesRule sides_;
    TextureAlpha textures_;
    SceneStreamWriter& out_;
    std::map<std::pair<unsigned, bool>, uint32_t> sent_;
};

}  // namespace sightline::import
