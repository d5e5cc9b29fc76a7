// The handles of worlds, and of what enters them.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/c/impl/handles.h"
#include "sightline/c/world.h"
#include "sightline/geom/draw_clusters.h"
#include "sightline/geom/occluder.h"
#include "sightline/visfile/visibility_file.h"
#include "sightline/world/world.h"

struct slOccluder {
    sightline::c::SharedHooks hooks;
    sightline::Occluder occluder;
};

struct slClusters {
    sightline::c::SharedHooks hooks;
    sightline::DrawClusters clusters;
};

struct slVisibility {
    sightline::c::SharedHooks hooks;
    sightline::VisibilityFile file;
};

struct slWorld {
    sightline::c::SharedHooks hooks;
    sightline::World world;
    uint32_t occluders = 0, clusters = 0, lods = 0;  ///< the last id that was given out

    const slLog& log() const { return hooks->log(); }
};

struct slSnapshot {
    sightline::c::SharedHooks hooks;
    sightline::Snapshot snapshot;
};

namespace sightline::c {

/// Of a call whose world, or another pointer, is null.
inline slStatus failNull(const slWorld* world, const char* call) {
    return fail(world ? world->log() : slLog{}, SL_BAD_ARGUMENT, call, "a pointer is null");
}

}  // namespace sightline::c
