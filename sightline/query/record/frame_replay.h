// Asks a recorded frame again, compares the answers, and takes the time.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "sightline/query/query.h"
#include "sightline/query/record/frame_recording.h"

namespace sightline {

/// A world of a recording's objects, and a query that answers for it as it did when the frame was recorded: the same on
/// every machine and with every instruction set. Making it costs what adding the objects and their occluders costs.
class FrameReplay {
public:
    struct Answer {
        QueryStats stats;
        uint32_t differences = 0;  ///< objects that are answered otherwise than FrameRecording::again has it
        uint32_t different = 0;    ///< the first of them

        bool same() const { return differences == 0; }
    };

    /// @param recording  parseRecording() has read it, or recordFrame() made it; it outlives the replay
    explicit FrameReplay(const FrameRecording& recording, Memory* memory = defaultMemory());

    /// Asks as a query that knows nothing from before.
    Answer run();

    /// The last answer, per object of the recording.  [size: FrameRecording::objects]
    std::span<const uint8_t> reasons() const { return reasons_; }
    /// The recorded objects, in their order.
    const Snapshot& snapshot() const { return now_; }
    /// The recording's, so that an answer depends on nothing but the frame.
    const QuerySettings& settings() const { return settings_; }

private:
    const FrameRecording& recording_;
    QuerySettings settings_;
    World world_;
    Snapshot now_;
    Query query_;
    Array<uint8_t> reasons_;
};

}  // namespace sightline
