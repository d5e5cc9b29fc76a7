// Does again what a recorded frame did to its occlusion buffer, compares the answers, and takes the time.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "sightline/cull/occlusion.h"
#include "sightline/query/record/occlusion_recording.h"

namespace sightline {

/// What became of a recording's calls.
struct ReplayAnswer {
    static constexpr uint64_t kNone = ~uint64_t{0};

    uint64_t triangles = 0;      ///< offered to the rasterizer
    uint64_t hidden = 0;         ///< rectangles that the buffer hid
    uint64_t differences = 0;    ///< tests that were answered otherwise than in the recording
    uint64_t different = kNone;  ///< the first of them: index into TileLog::calls
    uint64_t nanoseconds = 0;    ///< of the clear and of all calls

    bool same() const { return differences == 0; }
};

/// The buffer of one recording, and all that its calls need. Allocates while it is made, and in the first replay.
class OcclusionReplay {
public:
    /// @param recording  outlives the replay
    explicit OcclusionReplay(const OcclusionRecording& recording, Memory* memory = defaultMemory());

    /// All calls in their order, into an empty buffer.
    ReplayAnswer run();
    /// The draws alone: what is left of run() without them is the cost of the tests.
    /// @returns nanoseconds
    uint64_t draw();

    /// As the last call of run() or draw() has left it.
    DepthTiles& tiles() { return tiles_; }
    const Screen& screen() const { return screen_; }

private:
    void clearTiles();
    void drawOne(uint64_t index, ReplayAnswer& answer);

    const OcclusionRecording& recording_;
    Screen screen_;
    Array<OccluderInstance> instances_;
    Array<BoxAnswer> boxes_;  ///< per draw
    DepthTiles tiles_;
};

/// What a call asked and was told, in words: "the rectangle (12, 40) to (31, 66) at nearness 0.25: hidden".
/// @param call  index into TileLog::calls, of a test
std::string describeTest(const OcclusionRecording& recording, uint64_t call);

}  // namespace sightline
