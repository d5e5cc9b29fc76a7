// Lines of the world over a drawing of it: what lies behind a surface is faint, or not there.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <glm/glm.hpp>

#include "sightline/geom/view.h"
#include "sightline/math/box.h"
#include "sightline/tools/report/pictures/png.h"

namespace sightline::tools {

/// Which part of a line in clip space lies in the picture and not before the near plane: two places between 0 at `a` and 1 at `b`.
std::optional<glm::dvec2> partInView(const glm::dvec4& a, const glm::dvec4& b);

struct LineStyle {
    Rgb colour{0};
    double width = 1;    ///< [pixels]
    double opacity = 1;  ///< where nothing is nearer  [0 to 1]
    double behind = 0;   ///< the same where a surface is nearer  [0 to 1]
};

/// Lines and dots on a grid of samples, several to a pixel, so that edges are smooth. Later ones lie on top; none shows another of the
/// same drawing through itself.
class WorldLines {
public:
    /// @param width, height  of the grid  [samples]
    /// @param nearness       ZBufferImage::depth of what is drawn, rows from below  [size: width * height]
    WorldLines(const View& view, uint32_t width, uint32_t height, std::span<const double> nearness);

    void line(const glm::dvec3& from, const glm::dvec3& to, const LineStyle& style);
    /// A disc as wide as the style's lines.
    void dot(const glm::dvec3& at, const LineStyle& style);

    /// Where a point is in the picture, from its left and its top, in parts of its sides; none outside of it.
    std::optional<glm::dvec2> placeOf(const glm::dvec3& point) const;

    /// The picture under the lines: its sides are a whole part of the grid's.
    Image<Rgb> over(const Image<Rgb>& picture) const;

private:
    glm::dvec3 sampleOf(const glm::dvec3& point, const glm::dvec4& clip) const;
    void mark(int64_t x, int64_t y, double nearness, const LineStyle& style);
    double samplesIn(const LineStyle& style) const { return style.width * kPerPixel; }

    static constexpr uint32_t kPerPixel = 2;  // samples, as PictureMaker has them

    View view_;
    glm::dmat4 clip_;
    std::span<const double> nearness_;
    Image<glm::u8vec4> layer_;  // rows from below
};

/// The twelve edges of a box.
void drawBox(WorldLines& lines, const Box3d& box, const glm::dmat4& transform, const LineStyle& style);
/// The edges of what an image holds, from its near plane on, and a dot where the eye is.
/// @param reach  how deep, if the far plane is not nearer  [world units]
void drawFrustum(WorldLines& lines, const View& view, double reach);

}  // namespace sightline::tools
