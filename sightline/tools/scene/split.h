// Cuts meshes into pieces, each an object of its own: where one mesh is most of a scene, objects alone cull little.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

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

/// A scene whose objects are parts of another's, and of which of them.
struct CutScene {
    Scene scene;
    std::vector<uint64_t> keys;                       ///< of the objects before the cut
    std::vector<uint32_t> object_of;                  ///< by object: its index before
    std::vector<std::vector<uint32_t>> triangles_of;  ///< by mesh: their numbers before, ascending; empty: as it was
};

/// A scene as it is.
CutScene uncut(Scene scene);

/// The same triangles with the same materials in the same places; pieces are in the order of their first triangles, and
/// keep the order of theirs. Objects are numbered anew, from 0. A piece is called "part 3", "cube 0 4 1" or as its
/// material, below a node of its object's name. What deforms, what shuts a portal and what would be one piece stays whole.
/// Levels of detail that a file names are of whole objects: they go.
CutScene cutScene(Scene scene, const Split& split);

/// The scene of cutScene(), for those who need not know where its pieces come from.
Scene splitScene(Scene scene, const Split& split);

/// Triangles of the objects before a cut, as triangles of its objects.
/// @param of_wholes  by object before: numbers, ascending  [size: keys]
/// @return           by object: numbers in its mesh, ascending
std::vector<std::vector<uint32_t>> inPieces(const CutScene& cut, const std::vector<std::vector<uint32_t>>& of_wholes);

/// Leaves out triangles: of a mesh those that are listed for each object of it, and objects that have nothing else. What
/// shuts a portal stays.
/// @param without  by object: numbers of triangles of its mesh, ascending  [size: objects]
/// @return         how many drawn triangles went
uint64_t leaveOut(CutScene& cut, const std::vector<std::vector<uint32_t>>& without);

}  // namespace sightline::tools
