// The reference z-buffer as a subject: more pixels, more vertices, more bytes or more queries, and no more of the rest.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sightline/studies/hidden/zbuffer/zbuffer_method.h"
#include "sightline/tools/profile/frame_load.h"

namespace sightline::tools {

struct LoadedReferenceSettings {
    uint32_t threads = 1;  ///< that draw
    bool stream = false;   ///< carry the meshes of what is drawn each frame, not its transforms alone
};

/// Its stages take turns: what to draw is asked for, its bytes are copied, it is projected, it is filled.
///
///   cpu        asks and makes the list again                                            [whole times]
///   bus        copies the transforms again, and the meshes if they are streamed         [any share of them]
///   fill       draws the same list with so many times the pixels, in the same shape
///   transform  draws the list again with a 256th of the pixels: all vertices, facing
///              tests, clipping and setup, hardly a fragment                             [whole times]
///
/// What is left over, and so in no stage, is the setup of triangles so small that a 256th of the pixels misses them.
class LoadedReference : public LoadedRenderer {
public:
    explicit LoadedReference(const LoadedReferenceSettings& settings = {}) : settings_(settings) {}

    FrameTimes draw(const View& view, const SubmitFrame& submit, const StageLoads& loads) override;
    bool drawsAnything() const override { return true; }

    uint64_t bytes() const { return bytes_; }  ///< that the last frame carried
    /// What the last frame drew, without what only loaded it.
    const studies::HiddenCounters& counters() const { return counters_; }

private:
    void carry(std::span<const studies::DrawItem> items, double times);

    LoadedReferenceSettings settings_;
    studies::ZBufferMemory memory_, small_memory_;
    studies::HiddenCounters counters_;
    std::vector<std::byte> staging_;
    uint64_t bytes_ = 0;
};

/// Bytes that a frame carries of a list: a matrix of floats per item and, if they are streamed, its mesh.
uint64_t carriedBytes(std::span<const studies::DrawItem> items, bool stream);

/// A view with so many times the pixels, in the same shape as far as whole pixels can.
View withPixels(View view, double times);

/// Fragments that a list has in a view: what scan conversion finds, hidden or not.
uint64_t countFragments(std::span<const studies::DrawItem> items, const View& view, uint32_t threads);

}  // namespace sightline::tools
