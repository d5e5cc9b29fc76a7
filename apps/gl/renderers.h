// The independent renderer: which surface Mesa sees at each pixel, and a flat-shaded picture to time our z-buffer against.
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "apps/gl/context.h"
#include "sightline/geom/view.h"
#include "sightline/studies/hidden/image.h"

namespace sightline {

namespace studies {
class DrawList;
}  // namespace studies
using namespace studies;

/// Holds a list's meshes in the GL and draws views of them. What is drawn is what `studies/hidden/` draws: triangles that write
/// depth, without the back faces of single-sided ones. Vertices are transformed in double and rounded to float in clip
/// space; the GL then clips in float, snaps to 1/256 of a pixel and keeps a 32-bit float depth, reversed. Triangles with
/// a position that is not finite are left out.
class GlIdRenderer {
public:
    /// Context and list must outlive it. Meshes that several items share are uploaded once.
    static Result<GlIdRenderer> create(const GlContext& context, const DrawList& list);

    GlIdRenderer(GlIdRenderer&&) noexcept;
    GlIdRenderer& operator=(GlIdRenderer&&) noexcept;
    ~GlIdRenderer();

    /// Draws and waits until it is done. Errors: viewport too large, no memory.
    Status draw(const View& view);
    /// What was drawn last, numbered as the list numbers its surfaces. Row 0 is the bottom row.
    Result<HiddenImage> read() const;

private:
    struct State;
    explicit GlIdRenderer(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

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
