// The descent over the world's tree: front to back, or in any order where nothing is hidden; each node through the stages.
// SPDX-License-Identifier: MIT
//
// Ned Greene, Michael Kass, Gavin Miller. Hierarchical Z-Buffer Visibility. 1993.
#pragma once

#include "sightline/frame/frame.h"
#include "sightline/frame/traversal_state.h"
#include "sightline/query/traversal_record.h"

namespace sightline::detail {

/// Answers one part of a frame's image: writes `state.visible`, `culled` and `stats`.
///
/// In a strip of the image all that lies beside it is passed over. What the stages before occlusion decide about a node
/// does not depend on the strip. Objects without bounds are the whole image's alone.
/// @param timed  take the time of each stage
void traverse(const Frame& frame, TraversalState& state, const ImagePart& part, bool timed);

/// The same, and writes down each step.
void traverse(const Frame& frame, TraversalState& state, const ImagePart& part, TraversalRecord& record);

}  // namespace sightline::detail
