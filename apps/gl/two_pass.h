// Culling on the GPU in two passes: what was visible is drawn first, and its depths, as a pyramid, decide about the rest.
// SPDX-License-Identifier: MIT
//
// Ulrich Haar, Sebastian Aaltonen. GPU-Driven Rendering Pipelines. 2015.
// Ned Greene, Michael Kass, Gavin Miller. Hierarchical Z-Buffer Visibility. 1993.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "apps/gl/context.h"
#include "sightline/geom/view.h"
#include "sightline/math/box.h"
#include "sightline/studies/hidden/draw_item.h"

namespace sightline {

/// What is culled by itself: an item, or a run of its triangles.
struct GlCullPart {
    uint32_t item = 0;
    uint32_t first_triangle = 0, triangle_count = 0;
};

/// Items cut into runs of triangles that follow one another in their meshes.
/// @param most_triangles  of a run; 0: each item is one part
std::vector<GlCullPart> makeCullParts(std::span<const studies::DrawItem> items, uint32_t most_triangles = 0);

/// All decisions are made by compute shaders, and all draw calls are indirect: the CPU sends the view and nothing else,
/// unless items have moved. (In a parallel view it looks for the farthest vertex, which depth is made to reach.)
///
///   early   parts that were visible in the last frame and touch the frustum are drawn
///   reduce  a pyramid of the depths of that: each level has the farthest depth of two by two texels of the one before
///   late    each part that touches the frustum is held against the pyramid where its box may show, nearest point first;
///           what is not hidden and was not drawn is drawn now. What is hidden will not be drawn early in the next frame
///
/// The promise. A part that is not drawn lies outside the frustum, or all samples that its box may show keep something
/// nearer than the box: so the image is, sample for sample, that of all items. This holds for this image's samples alone,
/// not for every point of the scene as the stages of Query promise; and where no depth inside of a triangle is nearer than
/// all of its corners (BoxPadding). Nothing is believed of the frame before: it only says
/// what to draw first. A box that reaches the near plane is drawn. Images may have any size: the levels of the pyramid
/// are powers of two, filled up with what hides nothing less.
class GlTwoPass {
public:
    static constexpr uint32_t kNone = ~0u;

    /// Context must outlive it; items and their meshes too, for transforms are read again by moved().
    /// @param parts  makeCullParts() of the items; triangles that write no depth are not drawn  [limit: 2 million]
    /// Errors: of the GL, or a part that its item has not.
    static Result<GlTwoPass> create(const GlContext& context, std::span<const studies::DrawItem> items,
                                    std::span<const GlCullPart> parts);

    GlTwoPass(GlTwoPass&&) noexcept;
    GlTwoPass& operator=(GlTwoPass&&) noexcept;
    ~GlTwoPass();

    /// Items that have another transform now. One that mirrors must go on mirroring, and the other way round.
    void moved(std::span<const uint32_t> items);

    /// Draws a frame and waits until it is done. Errors: viewport too large, no memory.
    Status draw(const View& view);
    /// Draws all parts, for comparison, and forgets what was visible.
    Status drawAll(const View& view);

    /// What was drawn in the early pass and in the late one, of the last draw().  [size: parts each]
    struct Drawn {
        std::vector<uint32_t> early, late;
    };
    Result<Drawn> readDrawn() const;
    /// The item at each pixel, or kNone. Row 0 is the bottom row.
    Result<std::vector<uint32_t>> readItems() const;
    /// The bits of each pixel's depth: floats, 1 at the near plane.
    Result<std::vector<uint32_t>> readDepths() const;

private:
    struct State;
    explicit GlTwoPass(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace sightline
