// Cuts meshes into pieces, each an object of its own: where one mesh is most of a scene, objects alone cull little.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

#include "sightline/base/result.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// Along what a mesh is cut.
struct Split {
    enum class Along : uint8_t {
        kNothing,
        kParts,      ///< triangles that share corners, by position, stay together
        kMaterials,  ///< triangles of one material stay together
        kGrid,       ///< triangles whose centres lie in one cube of a grid over the mesh stay together
    };

    static constexpr uint32_t kMostCubes = 1024;

    Along along = Along::kNothing;
    uint32_t cubes = 0;  ///< of the grid, along the longest side of a mesh's box  [1 to kMostCubes]
};

/// "parts", "materials" or "grid:N". Errors: Error::Kind::kUsage.
Result<Split> readSplit(std::string_view text);

/// The same triangles with the same materials in the same places; pieces are in the order of their first triangles, and
/// keep the order of theirs. Objects are numbered anew, from 0. A piece is called "part 3", "cube 0 4 1" or as its
/// material, below a node of its object's name. What deforms, what shuts a portal and what would be one piece stays whole.
Scene splitScene(Scene scene, const Split& split);

}  // namespace sightline::tools
