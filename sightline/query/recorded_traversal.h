// A traversal that writes down what it does, with all that it needs.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/frame/frame.h"
#include "sightline/frame/traversal_state.h"
#include "sightline/query/traversal.h"
#include "sightline/stages/pipeline.h"

namespace sightline::detail {

/// Keeps its scratch memory from answer to answer; each answer stands by itself, as with QuerySettings::stateless.
struct RecordedTraversal {
    explicit RecordedTraversal(Memory* memory) : stages(memory), state(memory), record(memory) {}

    Frame frame;
    StageMemory stages;
    TraversalState state;
    TraversalRecord record;

    /// The whole image of a snapshot, through all stages.
    void run(const Snapshot& now, const View& view, const QuerySettings& settings) {
        frame.begin(now, view, settings);
        frame.settings.stateless = true;
        chooseStages(frame, stages);
        traverse(frame, state, {}, record);
    }
    /// A part of the image of some world, of which the stages of cells have left the given candidates.
    /// @param candidates  null: everything
    void run(const SnapshotState& world, const View& view, const QuerySettings& settings, const Candidates* candidates,
             std::span<const uint32_t> shown, const ImagePart& part) {
        frame.snapshot = Snapshot();
        frame.begin(&world, view, settings, shown);
        frame.settings.stateless = true;
        frame.narrowTo(candidates);
        chooseVolumes(frame, stages);
        traverse(frame, state, part, record);
    }
};

}  // namespace sightline::detail
