// Mesa's software GL as a subject: more pixels, more vertices, more bytes or more calls, and no more of the rest.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "apps/gl/context.h"
#include "sightline/studies/hidden/draw_item.h"
#include "sightline/tools/profile/frame_load.h"

namespace sightline {

/// What the GL says of a frame; a driver may have no counter of a kind.
struct GlStatistics {
    std::optional<uint64_t> vertices;   ///< that vertex shaders were run for
    std::optional<uint64_t> triangles;  ///< that went into clipping
    std::optional<uint64_t> fragments;  ///< that fragment shaders were run for
    uint64_t samples_passed = 0;
};

struct LoadedGlSettings {
    bool stream = false;  ///< upload the vertices of what is drawn each frame, not its transforms alone
};

/// Draws items as a program does that has one draw call an object: meshes lie in one buffer, the transforms of what is
/// drawn are uploaded each frame, and depth is tested. The image is nobody's but the GL's, so nothing waits for a display.
///
///   cpu        asks, computes the transforms and submits again, calls that draw nothing     [whole times]
///   bus        glBufferSubData of the same bytes again                                      [any share of them]
///   fill       the same calls into an image of so many times the pixels
///   transform  each call draws so many instances, all but the first of which lie outside    [whole times]
class LoadedGl : public tools::LoadedRenderer {
public:
    /// Context must outlive it; the items' meshes need not.
    /// @param items  all that may ever be drawn; DrawItem::id tells them apart
    /// Errors: of the GL.
    static Result<LoadedGl> create(const GlContext& context, std::span<const studies::DrawItem> items,
                                   const LoadedGlSettings& settings = {});

    LoadedGl(LoadedGl&&) noexcept;
    LoadedGl& operator=(LoadedGl&&) noexcept;
    ~LoadedGl() override;

    /// Items with an id that it was not made with are not drawn. What goes wrong in the GL is kept for status().
    tools::FrameTimes draw(const View& view, const tools::SubmitFrame& submit, const tools::StageLoads& loads) override;
    bool drawsAnything() const override { return false; }

    /// The same frame once more, counted.
    GlStatistics count(const View& view, const tools::SubmitFrame& submit, const tools::StageLoads& loads = {});
    uint64_t bytes() const;  ///< that the last frame uploaded
    /// The first that went wrong.
    Status status() const;

private:
    struct State;
    explicit LoadedGl(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace sightline
