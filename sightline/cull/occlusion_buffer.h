// The occlusion buffer alone, for programs with a scene tree of their own: draw what hides, ask what is hidden.
// SPDX-License-Identifier: MIT
//
// Hansong Zhang, Dinesh Manocha, Tom Hudson, Kenneth Hoff. Visibility Culling Using Hierarchical Occlusion Maps. 1997.
#pragma once

#include <cstdint>
#include <deque>
#include <span>

#include <glm/glm.hpp>

#include "sightline/base/memory.h"
#include "sightline/buffer/ask/occludee.h"
#include "sightline/buffer/screen.h"
#include "sightline/buffer/tiles.h"
#include "sightline/geom/occluder.h"
#include "sightline/geom/view.h"
#include "sightline/math/box.h"

namespace sightline {

/// What a Query does with its buffer, call by call. For each frame: begin(), then draw() and ask() in any order, best the
/// nearest things first; what is drawn hides from then on.
///
/// Conservative: what it calls occluded has no visible point in exact projection, at any resolution of the image and
/// under any shift of it up to View::jitter. The same on every instruction set. One thread uses it at a time. It
/// allocates only in frames that draw more than those before.
class OcclusionBuffer {
public:
    /// @param size    the buffer's longer side; what it hides is hidden at every resolution, a larger one hides more
    ///                [pixels, 1 to 8192]
    /// @param memory  outlives the buffer
    explicit OcclusionBuffer(uint32_t size = 384, Memory* memory = defaultMemory());

    /// Empties the buffer for a view. Unless the answer is kNone the view cannot be used: then nothing is drawn, and all
    /// may be visible.
    ViewProblem begin(const View& view);

    /// Draws an occluder of prepareOccluder(), which must stay as it is until the next begin(). Clusters that are hidden
    /// already are left out. O(clusters + pixels).
    /// @param transform  object to world
    /// @returns triangles that were drawn
    uint32_t draw(const Occluder& occluder, const glm::dmat4& transform = glm::dmat4(1.0));

    /// What is to be said of a box in world space: kVisible if it may be seen, and where it touches the near plane, holds
    /// the eye or is not finite.
    Sight ask(const Box3d& box);
    /// The same of many, eight at a time.
    /// @param answers  [size: that of boxes]
    void ask(std::span<const Box3d> boxes, std::span<Sight> answers);
    /// The same of a box that lies in an object: tighter than its box in world space where the object is turned.
    Sight ask(const Box3f& box, const glm::dmat4& transform);

    /// Of the buffer, in whole tiles of 8 by 8  [pixels]; 0 before the first begin()
    uint32_t width() const { return tiles_.width; }
    uint32_t height() const { return tiles_.height; }

    /// The buffer as an image, as readDepthImage() has it.
    /// @param nearness  [size: width() * height()]
    /// @param covered   [size: that, or 0]
    void depthImage(std::span<float> nearness, std::span<uint8_t> covered = {});

private:
    const glm::dmat4& keep(const glm::dmat4& transform);

    const uint32_t size_;
    bool usable_ = false;
    Screen screen_;
    DepthTiles tiles_;
    std::deque<glm::dmat4, MemoryAllocator<glm::dmat4>>
        transforms_;  ///< of what is drawn: the tiles look at them until begin()
    size_t transforms_used_ = 0;
};

}  // namespace sightline
