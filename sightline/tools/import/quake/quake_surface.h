// What of a map's faces is drawn, and what hides what is behind it for certain.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/tools/import/quake/quake_bsp.h"

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

}  // namespace sightline::tools
