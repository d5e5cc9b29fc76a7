// All that is prepared of one mesh for a world, as plain data: so that a file can hold it.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/base/array.h"
#include "sightline/geom/draw_clusters.h"
#include "sightline/geom/lod_chain.h"
#include "sightline/geom/occluder.h"

namespace sightline {

struct PreparedMesh {
    Occluder occluder;               ///< for World::addOccluder(); without clusters: nothing of the mesh hides
    Array<InnerOccluder> inner;      ///< simpler ones for it, finest first
    Occluder shape;                  ///< for World::addShape()
    bool has_shape = false;          ///< of its own
    bool occluder_is_shape = false;  ///< the occluder serves for both
    DrawClusters clusters;           ///< for World::addClusters(); none: the mesh is drawn whole
    LodChain lods;                   ///< LodChain::levels for World::addLods(); without levels: there are none

    explicit PreparedMesh(Memory* memory = defaultMemory())
        : occluder(memory), inner(memory), shape(memory), clusters(memory), lods(memory) {}
};

}  // namespace sightline
