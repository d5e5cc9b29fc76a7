// Of a .bsp: faces with their outlines, textures, and the models that they belong to.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/tools/import/quake/quake_lumps.h"

namespace sightline::tools::quake {

/// Fills textures, faces, points, indices and models, and the tree's bounds.
void readFaces(Bytes bytes, const Directory& directory, QuakeMapFile& map);

/// Quake 3's, which have points of their own in place of edges, and shaders.
void readQuake3Faces(Bytes bytes, const Directory& directory, QuakeMapFile& map);

}  // namespace sightline::tools::quake
