// The independent renderer's flat-shaded picture: what our z-buffer is timed against.
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "apps/gl/context.h"
#include "sightline/geom/view.h"

namespace sightline {

namespace studies {
class DrawList;
}  // namespace studies
using namespace studies;

/// Draws a list as a GL program that wants to be fast does: all items in one vertex buffer, uploaded once and placed in
/// the world beforehand; one draw call for single-sided and one for double-sided triangles; the light of a triangle is
/// one dot product with the sun, taken at the one corner that speaks for it; the fragment shader hands it on.
class GlFlatRenderer {
public:
    /// Context must outlive it; the list need not.
    /// @param colours  per surface: red, green, blue, alpha, low byte first  [size: surfaces, or empty: from the item's id]
    static Result<GlFlatRenderer> create(const GlContext& context, const DrawList& list,
                                         std::span<const uint32_t> colours = {});

    GlFlatRenderer(GlFlatRenderer&&) noexcept;
    GlFlatRenderer& operator=(GlFlatRenderer&&) noexcept;
    ~GlFlatRenderer();

    /// Clears colour and depth, draws, and waits until it is done. Errors: viewport too large, no memory.
    Status draw(const View& view);
    /// What was drawn last, as colours are given to create(). Row 0 is the bottom row.  [size: width * height]
    Result<std::vector<uint32_t>> read() const;

private:
    struct State;
    explicit GlFlatRenderer(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace sightline
