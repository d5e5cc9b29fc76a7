// A compiled map as a scene: an object for each of its faces.
// SPDX-License-Identifier: MIT
//
// Pierre Bezier. Procede de definition numerique des courbes et surfaces non mathematiques. 1968.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "sightline/base/result.h"
#include "sightline/tools/import/quake/quake_bsp.h"
#include "sightline/tools/scene/quake_map.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

enum class QuakeSurface : uint8_t {
    kSolid,       ///< opaque, of the world, seen from its front only
    kSeeThrough,  ///< liquid, sky, a fence, glass, a trigger: hides nothing; may be seen from both sides
    kMovable,     ///< of an entity, a door perhaps: drawn, and hides nothing because it may be elsewhere
    kCurved,      ///< Quake 3's patches: engines cut them as finely as they like; hide nothing
    kNotDrawn,
};

/// Quake, Half-Life: a face of the world is solid if neither its texture's name nor its flag says otherwise and the
/// tree is solid close behind it. A texture that the file lacks has no name: engines draw such faces as opaque
/// squares. Quake 2: by the surface's flags. Quake 3: by the flags of a flat surface's shader, whose script is not
/// read. O(points * depth).
QuakeSurface quakeSurface(const QuakeMapFile& map, const QuakeFace& face);

/// Fills a mesh's positions, indices and bounds with biquadratic patches, each as 4 x 4 squares. The bounds hold all
/// control points, and so any finer cut: a Bezier surface lies in the hull of its control points. The mesh deforms:
/// it hides nothing.
/// @param control  row by row  [size: width * height, both odd and at least 3]
void tessellatePatch(std::span<const glm::vec3> control, uint32_t width, uint32_t height, Mesh& mesh);

/// The entities of a compiled map: its text is a `.map` without brushes. Errors as parseQuakeMap's.
Result<QuakeMap> quakeEntities(const QuakeMapFile& map, const std::string& name);

/// An object's key is its face's index, its name the texture's; it hangs in a node for its entity, "worldspawn" or as
/// "func_door *3", and stands where that entity's `origin` says. quakeSurface() tells what hides: see-through faces are
/// AlphaMode::kBlend, those of entities transmissive, patches deform within their control points. Faces that are not
/// drawn are left out. Cameras are the places where players begin, at the height of their eyes.
///
/// Errors (kInput) are one line with the name: entities that cannot be read, an origin that is none, a model that
/// entities show too often, nothing that is drawn.
Result<Scene> quakeScene(const QuakeMapFile& map, const std::string& name);

/// Reads the map by readMapBytes(), and makes a scene of it.
Result<Scene> loadQuakeScene(const std::string& name);

}  // namespace sightline::tools
