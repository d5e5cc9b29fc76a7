// Writes a scene that came from anywhere as glTF 2.0.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "sightline/base/result.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// A file that was written, and what of the scene it does not hold.
struct WrittenGltf {
    std::string bytes;               ///< a GLB
    std::vector<std::string> notes;  ///< a line each
};

/// A node's name, changed if a reader would take it for the mark of a cell or a portal.
std::string unmarkedName(const std::string& name);

/// A GLB with all that a scene has: meshes, materials, names, the tree of nodes, cameras, cells and portals. Read again it gives the
/// same triangles in the same places, in the same order; keys are new. Positions stay as they are, transforms are of double
/// precision. Notes tell of cells without a shape and of meshes that deform, which stand as they are at rest.
/// Errors (kOutput): more than 4 GiB.
/// @param name  of the file, for errors
Result<WrittenGltf> sceneGltf(const Scene& scene, const std::string& name);

}  // namespace sightline::tools
