// What becomes of one object in a world of some of a snapshot's objects: the world is built, and looked at.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/run/explain.h"
#include "sightline/run/walk.h"

namespace sightline::detail {

/// Where an item of a snapshot stands in its hierarchy, or WalkRecord::kNowhere: its bounds cannot be trusted.
uint32_t hierarchyPlace(const SnapshotState& state, uint32_t item);

/// What a walk makes of an object's own box.
struct LeafAnswer {
    EyeBoxes boxes;  ///< with its neighbours'
    int slot = 0;    ///< its own
    ScreenAnswer on_screen;
    bool beyond_plane = false;  ///< the frustum stage would cull it by a plane

    const PixelRect& rect() const { return on_screen.rects[slot]; }
    bool doubt() const { return on_screen.doubt >> slot & 1; }
    bool outside() const { return on_screen.outside >> slot & 1; }
};
LeafAnswer askLeaf(const SnapshotState& state, uint32_t place, const View& view, const Screen& screen);

/// A walk that stops where the object is decided; of a view in bins the one that keeps it, else that of the whole view.
/// What it needs stays from trial to trial.
struct Trial {
    explicit Trial(Memory* memory) : walk(memory), record(memory) { walk.record = &record; }

    Walk walk;
    WalkRecord record;
    WalkRecord::Cull cull;  ///< that the object was part of, if it was culled

    /// @param item  of the state; within View::layers
    /// @returns kVisible, or by which stage it is culled
    Verdict run(const SnapshotState& state, const View& view, uint32_t item);

private:
    Verdict runBin(const SnapshotState& state, const View& view, const Bin& bin);
};

}  // namespace sightline::detail
