// The pipeline of a query: its stages, coarse to fine, and what each does at which moment.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/frame/frame.h"
#include "sightline/frame/stopwatch.h"
#include "sightline/frame/traversal_state.h"
#include "sightline/stages/stage_memory.h"

namespace sightline::detail {

/// What a stage says of a node or an object whose turn has come.
struct TurnAnswer {
    bool culled = false;
    bool settled = false;             ///< kept, and not to be asked by further stages
    bool drawn = false;               ///< culled, and drawn all the same
    Stage stage = Stage::kOcclusion;  ///< that culled it
    Look look = Look::kBox;           ///< that decided
};

/// A step of the pipeline: a stage, or a part of one. It works at one or more of these moments; the others are null.
/// Each moment may only narrow what the moments before it have left. It keeps what it is in doubt about.
struct PipelineStep {
    /// Answers that it has a part in.
    enum class In : uint8_t { kAll, kDrawn, kProved };

    Stage stage;
    In in = In::kAll;
    /// Once a frame, before the descent: chooses what the view fixes, and narrows the frame's candidates.
    void (*choose)(Frame& frame, StageMemory& memory) = nullptr;
    /// Eight boxes, the children of a node that is opened. Returns a bit for each that it culls.
    /// @param live  a bit for each child that is left
    uint32_t (*by_box)(const Frame& frame, TraversalState& state, Group& group, uint32_t live) = nullptr;
    /// The same, once they have rectangles in the image: where the traversal is in order.
    uint32_t (*by_rect)(const Frame& frame, TraversalState& state, Group& group, uint32_t live) = nullptr;
    /// A node or an object, when it is the nearest of all that wait. What a step settles is kept.
    TurnAnswer (*in_turn)(const Frame& frame, TraversalState& state, const Pending& entry) = nullptr;
    /// An object that was kept, when all occluders are drawn that were found.
    TurnAnswer (*at_end)(const Frame& frame, TraversalState& state, const SecondLook& kept) = nullptr;
    /// The whole answer, of all parts of the image together.
    void (*of_answer)(const Frame& frame, StageMemory& memory, AnswerView& answer) = nullptr;
};

void choosePvs(Frame& frame, StageMemory& memory);
void choosePortals(Frame& frame, StageMemory& memory);
uint32_t cutToWindows(const Frame& frame, TraversalState& state, Group& group, uint32_t live);
uint32_t cullOutside(const Frame& frame, TraversalState& state, Group& group, uint32_t live);
uint32_t cullOffScreen(const Frame& frame, TraversalState& state, Group& group, uint32_t live);
uint32_t cullFar(const Frame& frame, TraversalState& state, Group& group, uint32_t live);
uint32_t cullSmall(const Frame& frame, TraversalState& state, Group& group, uint32_t live);
void chooseVolumes(Frame& frame, StageMemory& memory);
uint32_t cullInVolumes(const Frame& frame, TraversalState& state, Group& group, uint32_t live);
TurnAnswer cullProposed(const Frame& frame, TraversalState& state, const Pending& entry);
TurnAnswer keepUnasked(const Frame& frame, TraversalState& state, const Pending& entry);
TurnAnswer cullProved(const Frame& frame, TraversalState& state, const Pending& entry);
TurnAnswer cullHidden(const Frame& frame, TraversalState& state, const Pending& entry);
TurnAnswer cullByFaces(const Frame& frame, TraversalState& state, const Pending& entry);
TurnAnswer cullByTriangles(const Frame& frame, TraversalState& state, const SecondLook& kept);
void chooseLods(const Frame& frame, StageMemory& memory, AnswerView& answer);
void cullClusters(const Frame& frame, StageMemory& memory, AnswerView& answer);

/// The pipeline. A new stage is a row here, its file, and its name in geom/stage.h.
inline constexpr PipelineStep kPipeline[] = {
    {.stage = Stage::kPvs, .choose = choosePvs},
    {.stage = Stage::kPortals, .choose = choosePortals, .by_rect = cutToWindows},
    {.stage = Stage::kFrustum, .by_box = cullOutside, .by_rect = cullOffScreen},
    {.stage = Stage::kDistance, .by_box = cullFar},
    {.stage = Stage::kContribution, .by_box = cullSmall},
    {.stage = Stage::kVolumes, .choose = chooseVolumes, .by_box = cullInVolumes},
    {.stage = Stage::kOcclusion, .in_turn = cullProposed},
    {.stage = Stage::kOcclusion, .in_turn = keepUnasked},
    {.stage = Stage::kOcclusion, .in = PipelineStep::In::kProved, .in_turn = cullProved},
    {.stage = Stage::kOcclusion, .in = PipelineStep::In::kDrawn, .in_turn = cullHidden},
    {.stage = Stage::kOcclusion, .in = PipelineStep::In::kDrawn, .in_turn = cullByFaces, .at_end = cullByTriangles},
    {.stage = Stage::kLod, .of_answer = chooseLods},
    {.stage = Stage::kClusters, .of_answer = cullClusters},
};

/// Takes up a view: each stage in use chooses what the view fixes for it.
/// @param nanoseconds  receives what each needed, by Stage; null: no time is taken
inline void chooseStages(Frame& frame, StageMemory& memory, uint64_t* nanoseconds = nullptr) {
    for (const PipelineStep& row : kPipeline) {
        if (!row.choose) continue;
        if (!nanoseconds) {
            row.choose(frame, memory);
            continue;
        }
        const Stopwatch watch;
        row.choose(frame, memory);
        nanoseconds[static_cast<int>(row.stage)] = watch.nanoseconds();
    }
}

}  // namespace sightline::detail
