// A recording of what one frame asked of its occlusion buffer: occluders, places, calls and answers.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/base/array.h"
#include "sightline/base/result.h"
#include "sightline/buffer/tile_log.h"
#include "sightline/geom/occluder.h"
#include "sightline/geom/view.h"
#include "sightline/world/world.h"

namespace sightline {

/// What a frame did to its occlusion buffer, complete enough to be done again without the world: to measure drawing and
/// asking apart, and to hold instruction sets to one another call by call. OcclusionReplay does it again.
struct OcclusionRecording {
    /// An object that hid something.
    struct Instance {
        uint32_t occluder = 0;  ///< index into `occluders`
        glm::dmat4 transform{1.0};
    };
    /// A cluster that was drawn.
    struct Draw {
        uint32_t instance = 0;  ///< index into `instances`
        uint32_t cluster = 0;   ///< of the instance's occluder
    };

    View view;                  ///< matrices, viewport and jitter, on which the buffer depends; all else as in View()
    QuerySettings settings;     ///< occlusion_size, masked, close_gaps; all else as in QuerySettings()
    Array<Occluder> occluders;  ///< each once, and of it the clusters that were drawn; their bounds are the whole one's
    Array<Instance> instances;
    Array<Draw> draws;  ///< in order
    TileLog asked;  ///< the order of draws and tests, and the tests with the answers that they were given; their tiles
                    ///< are counted row by row, screen.width / 8 in a row

    explicit OcclusionRecording(Memory* memory = defaultMemory())
        : occluders(memory), instances(memory), draws(memory), asked(memory) {}
};

/// Records what Query::visible(now, view, settings) does. Costs a query, and a copy of the occluders that it draws.
/// Errors (kUsage): the view is not usable, or has no occlusion stage.
Result<OcclusionRecording> recordOcclusion(const Snapshot& now, const View& view, const QuerySettings& settings = {},
                                           Memory* memory = defaultMemory());

}  // namespace sightline
