// Of a .bsp: the leaves, and the tree of the world.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/tools/import/quake/quake_lumps.h"

namespace sightline::tools::quake {

/// Fills contents, cluster_of_leaf, faces_of_leaf, leaf_faces and, of Quake and Half-Life, row_offsets; needs faces.
void readLeaves(Bytes bytes, const Directory& directory, QuakeMapFile& map);

/// Fills the tree's nodes: those below the world's root, parents before children; needs contents.
void readTree(Bytes bytes, const Directory& directory, QuakeMapFile& map);

}  // namespace sightline::tools::quake
