// Reads what of a material decides visibility: sidedness, alpha, transmission, and its base colour.
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "sightline/tools/import/gltf/gltf_text.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools::gltf {

struct Materials {
    std::vector<Material> list;  ///< never empty
    uint32_t first = 0;          ///< where glTF's material 0 is; 1 if the default material stands before it
    size_t count = 0;            ///< glTF's own
};

/// The default material comes first if a primitive names none.
Materials readMaterials(const JsonText& json);

}  // namespace sightline::tools::gltf
