// OpenGL's occlusion queries as OcclusionQueries wants them: items drawn with their numbers, boxes asked about.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "apps/gl/context.h"
#include "sightline/cull/queries/query_device.h"
#include "sightline/geom/view.h"
#include "sightline/studies/hidden/draw_item.h"

namespace sightline {

enum class GlQueryKind : uint8_t {
    kSamples,  ///< GL_SAMPLES_PASSED: how many
    kAny,      ///< GL_ANY_SAMPLES_PASSED: whether any; an answer is 0 or the largest number
};

/// Draws items by their numbers into an image of these numbers. Depth is a reversed float, of which only RasterRounding's
/// positions need padding. Vertices are transformed in float, from the middle of their mesh.
class GlQueryDevice : public QueryDevice {
public:
    static constexpr uint32_t kNone = ~0u;

    /// Context must outlive it; the items' meshes need not, but for the transforms, which are read again in each frame.
    /// @param items  by the numbers that draw() is given. Triangles that write no depth are not drawn
    static Result<GlQueryDevice> create(const GlContext& context, std::span<const studies::DrawItem> items,
                                        GlQueryKind kind = GlQueryKind::kSamples);

    GlQueryDevice(GlQueryDevice&&) noexcept;
    GlQueryDevice& operator=(GlQueryDevice&&) noexcept;
    virtual ~GlQueryDevice();

    /// Clears the image. Errors: viewport too large, no memory.
    Status beginFrame(const View& view);
    /// Waits until all is drawn. Errors: whatever went wrong in the GL since the frame began.
    Status endFrame();

    void draw(std::span<const uint32_t> items) override;
    void ask(uint32_t question, std::span<const Box3d> boxes) override;
    bool hasAnswer(uint32_t question) override;
    uint64_t answer(uint32_t question) override;

    /// The item at each pixel, or kNone. Row 0 is the bottom row.
    Result<std::vector<uint32_t>> readItems() const;
    /// The bits of each pixel's depth: floats, 1 at the near plane.
    Result<std::vector<uint32_t>> readDepths() const;

private:
    struct State;
    explicit GlQueryDevice(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace sightline
