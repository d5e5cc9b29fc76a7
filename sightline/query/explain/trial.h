// What becomes of one object in a world of some of a snapshot's objects: the world is built, and looked at.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/query/explain/verdict.h"
#include "sightline/query/recorded_traversal.h"

namespace sightline::detail {

/// Where an item of a snapshot stands in its hierarchy, or TraversalRecord::kNowhere: its bounds cannot be trusted.
uint32_t hierarchyPlace(const SnapshotState& state, uint32_t item);

/// What a traversal makes of an object's own box.
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

/// A traversal that stops when the object is decided. If the image is in strips, it is that of a strip that keeps the
/// object, or else that of the whole image. Keeps its scratch memory from trial to trial.
struct Trial : RecordedTraversal {
    using RecordedTraversal::RecordedTraversal;

    const Candidates* candidates = nullptr;  ///< what the stages of cells leave of the world; null: everything
    std::span<const uint32_t> shown;         ///< SizeLimits::shown
    TraversalRecord::Cull cull;              ///< that the object was part of, if it was culled

    /// @param item  of the world; within View::layers
    /// @returns kVisible, or by which stage it is culled
    Verdict run(const SnapshotState& world, const View& view, const QuerySettings& settings, uint32_t item);

private:
    Verdict runPart(const SnapshotState& world, const View& view, const QuerySettings& settings, const ImagePart& part);
};

}  // namespace sightline::detail
