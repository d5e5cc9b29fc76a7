// Gives the pixels that a cluster may touch, tile by tile, and how near it may be there.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/buffer/draw/frame.h"
#include "sightline/buffer/tiles.h"

namespace sightline {

/// Takes the pixels of a cluster, tile by tile. A tile may come more than once.
struct OutlineSink {
    virtual ~OutlineSink() = default;
    /// @param mask     pixels that the cluster may touch, not 0
    /// @param nearness nothing of it is nearer there
    /// @returns false to end
    virtual bool take(uint32_t tile, uint64_t mask, float nearness) = 0;
};

/// Which tiles of a cluster are given.
enum class OutlineOf : uint8_t {
    kAll,    ///< all that matter
    kOpen,   ///< those alone that do not claim to be nearer than all of it; a corner that is open comes first
    kBacks,  ///< all that matter, of polygons that surely look away and are not drawn from behind
};

/// What was found of a cluster.
struct Outline {
    bool known = true;     ///< false: it may be anywhere in the image
    bool in_view = false;  ///< a corner of a polygon that may face the eye is in the image
    bool ended = false;    ///< by the sink
};

/// The pixels that a cluster's polygons may touch; but with kBacks, those that are turned away left out. It is cut before the near plane.
///
/// Its outline is drawn as by drawCluster(), but outward: the pixels that open edges touch, and those inside. In a tile the nearness is that
/// of the nearest plane among the groups that may meet it.
/// @param frame  objectFrame() of the object
/// @param shape  all that may be drawn of the object
Outline forOutline(DepthTiles& tiles, const ObjectFrame& frame, const Occluder& shape, uint32_t cluster,
                   OutlineOf which, OutlineSink& sink);

}  // namespace sightline
