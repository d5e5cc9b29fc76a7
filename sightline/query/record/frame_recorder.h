// Records what a query was asked and what it answered.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/query/query.h"
#include "sightline/query/record/frame_recording.h"

namespace sightline {

/// Records a query's last answer, with the certificates that it culled by; of visibleStereo() the left eye's. O(objects
/// of the snapshot), a copy of what the recorded ones hide with, and one more query.
/// Errors (kUsage): the view was not usable.
Result<FrameRecording> recordFrame(const Query& answered, Memory* memory = defaultMemory());

/// Records the answer of a query that knows nothing from before.
Result<FrameRecording> recordFrame(const Snapshot& now, const View& view, const QuerySettings& settings = {},
                                   Memory* memory = defaultMemory());

}  // namespace sightline
