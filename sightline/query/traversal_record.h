// What a traversal did, step by step, for those who ask why.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/buffer/tile_log.h"
#include "sightline/frame/traversal_state.h"

namespace sightline::detail {

/// Places are the hierarchy's.
struct TraversalRecord {
    static constexpr uint32_t kNowhere = ~0u;

    /// A cluster that was rasterized.
    struct Draw {
        uint32_t instance = 0;  ///< index into TraversalState::instances
        uint32_t cluster = 0;
        uint32_t triangles = 0;
        BoxAnswer box;
    };
    /// Objects that were culled together, and what they were taken for.
    struct Cull {
        PlaceRange places;
        Stage stage = Stage::kFrustum;
        bool off_screen = false;    ///< the rectangle misses the buffer; no plane decided
        PixelRect rect;             ///< by the occlusion stage: what was hidden
        uint32_t hider = kNowhere;  ///< by a volume: the place of the object that hides it
        Look look = Look::kBox;     ///< that decided
        bool boxed = true;          ///< the rectangle is that of the box; else its box has none
    };
    /// The rectangle of the object at `stop_at`, where it was kept.
    struct Kept {
        PixelRect rect;
        bool testable = false;   ///< the occlusion stage could look at it
        Look look = Look::kBox;  ///< the last that was tried
    };

    Array<Draw> draws;
    Array<Cull> culls;
    Array<uint32_t> owners;       ///< per TraversalState::instances: the object's place
    uint32_t stop_at = kNowhere;  ///< the traversal ends once the occlusion stage has decided on this place
    bool stopped = false;         ///< it did, and the depth tiles are as they were then
    Kept kept;
    TileLog* log = nullptr;  ///< takes down each call of the depth tiles in its order, if there is one

    explicit TraversalRecord(Memory* memory) : draws(memory), culls(memory), owners(memory) {}

    void clear() {
        draws.clear();
        culls.clear();
        owners.clear();
        stopped = false;
        if (log) log->clear();
    }
};

}  // namespace sightline::detail
