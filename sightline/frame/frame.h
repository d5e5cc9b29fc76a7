// What a view fixes for one answer, computed once: its planes, its screen, its limits, and what is left of the world.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "sightline/base/assert.h"
#include "sightline/buffer/screen.h"
#include "sightline/buffer/tiles.h"
#include "sightline/cull/occluder_volumes.h"
#include "sightline/frame/candidates.h"
#include "sightline/frame/place_range.h"
#include "sightline/frame/size_limits.h"
#include "sightline/geom/frustum.h"
#include "sightline/geom/view.h"
#include "sightline/geom/view_limits.h"
#include "sightline/lod/lod_choice.h"
#include "sightline/world/world.h"
#include "sightline/world/world_state.h"

namespace sightline::detail {

/// Read by all stages and by every part of the image; written while the view is taken up alone.
struct Frame {
    Snapshot snapshot;                     ///< null if the world holds only some of a snapshot's objects
    const SnapshotState* world = nullptr;  ///< its state; null: there is none
    View view;
    QuerySettings settings;
    uint32_t stages = 0;  ///< bits of Stage: those in use
    uint32_t off = 0;     ///< bits of Off: what the view and the settings switch off whatever the answer is
    ViewProblem problem = ViewProblem::kNone;
    bool usable = false;      ///< the view has no problem; else nothing can be proved hidden: all is kept
    bool every_layer = true;  ///< no object is outside the view's layers
    uint64_t objects = 0;     ///< within the view's layers
    Frustum frustum;
    ViewLimits limits;
    Screen screen;
    SizeLimits sizes;
    LodMeasure lods;                          ///< with Stage::kLod
    const Candidates* candidates = nullptr;   ///< what the stages of cells leave; null: everything
    std::span<const OccluderVolume> volumes;  ///< that Stage::kVolumes has chosen
    std::span<const uint32_t> volume_owners;  ///< per volume: the place of the object that it belongs to

    /// Takes up a view.
    /// @param shown  SizeLimits::shown
    void begin(const Snapshot& now, const View& from, const QuerySettings& how, std::span<const uint32_t> shown = {}) {
        snapshot = now;
        begin(now ? &now.state() : nullptr, from, how, shown);
    }
    /// @param now  outlives the answer
    void begin(const SnapshotState* now, const View& from, const QuerySettings& how,
               std::span<const uint32_t> shown = {});
    /// Takes the candidates that the stages of cells leave. Those of these stages that decide nothing are then not in
    /// use.
    void narrowTo(const Candidates* left);

    bool uses(Stage stage) const { return stages & stageBit(stage); }
    bool isInLayers(uint32_t place) const {
        SIGHTLINE_DEBUG_ASSERT(world && place < world->placed.size());
        return world->placed[place].layers & view.layers;
    }
    /// How many objects of a range of places are within the view's layers, and candidates.
    uint64_t countObjects(const PlaceRange& places) const;
    /// Whether another level than the finest may be drawn of the object at a place, one in which neither its occluder
    /// nor its shape hold.
    bool mayBeCoarse(uint32_t place) const {
        SIGHTLINE_DEBUG_ASSERT(world && place < world->placed.size());
        return uses(Stage::kLod) && world->placed[place].coarser.index != 0 && errsLittle(place);
    }
    /// The bounds of the object at a place, as the hierarchy has them.
    Box3d boundsAt(uint32_t place) const;
    bool isCandidate(uint32_t place) const { return !candidates || candidates->admits(place); }
    /// Bit per slot of a node below which there is a candidate.
    uint32_t candidateSlots(const BvhNode& node) const;
    /// Where the descent begins, if not at the root.
    std::span<const NodeSlots> starts() const {
        return candidates ? candidates->nodes() : std::span<const NodeSlots>();
    }
    /// The part of an object's rectangle in which its cells are seen. If it is empty, its right edge is left of its
    /// left one, or its top is below its bottom.
    PixelRect inWindow(uint32_t place, PixelRect rect) const;
    /// The whole buffer, in columns of tiles.
    uint32_t columns() const { return screen.width / 8; }

private:
    void noteOff();
    bool errsLittle(uint32_t place) const;
};

/// Planes of the view's limits stand behind the frustum's: from this bit on.
inline constexpr uint32_t kLimitBit = 6;
/// All planes that Stage::kFrustum asks, as bits.
uint32_t allPlanes(const Frame& frame);

/// How many parts a frame's image is answered in: QuerySettings::bins, or 1 where there is nothing to share out.
uint32_t partCount(const Frame& frame);

}  // namespace sightline::detail
