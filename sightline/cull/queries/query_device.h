// What a graphics interface must offer to OcclusionQueries: draw items, ask how many samples of boxes would be drawn, tell.
// SPDX-License-Identifier: MIT
//
// Hewlett-Packard. Occlusion Culling on the VISUALIZE fx (GL_HP_occlusion_test). 1998.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/math/box.h"

namespace sightline {

/// Asks about boxes. All calls of a frame draw into one image, which the caller has cleared, and are worked off in order: a
/// question sees the depths of what was drawn before it.
class QuestionDevice {
public:
    /// Counts the samples of boxes that pass the depth test, one box's beside the other's, and writes neither colour nor
    /// depth. A sample at the depth that is there already passes. Faces that are turned away may be left out: no box
    /// reaches the near plane. Boxes are not cut by View::sections.
    /// @param question  what the answer is asked for with; numbers are small and are used again
    virtual void ask(uint32_t question, std::span<const Box3d> boxes) = 0;

    /// Whether answer() would not wait.
    virtual bool hasAnswer(uint32_t question) = 0;

    /// The samples that passed; a device that knows only whether any did says the largest number. Waits. Each question is
    /// answered once.
    virtual uint64_t answer(uint32_t question) = 0;

protected:
    ~QuestionDevice() = default;
};

/// The caller's graphics interface.
class QueryDevice : public QuestionDevice {
public:
    /// Draws items as they look, with the depth test, and with their depths written.
    /// @param items  numbers of the caller's; good until the call returns
    virtual void draw(std::span<const uint32_t> items) = 0;

protected:
    ~QueryDevice() = default;
};

}  // namespace sightline
