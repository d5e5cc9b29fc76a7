// The world from above and from the side, each object in the colour of what culled it, with the camera's frustum.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "sightline/geom/view.h"
#include "sightline/math/box.h"
#include "sightline/tools/report/pictures/png.h"

namespace sightline::tools {

/// Where a drawing lies in the world: which axes it shows, and how much of them.
struct PlanArea {
    int across = 0;                ///< the world axis that runs to the right: 0 x, 2 z
    int down = 2;                  ///< the one that runs down the picture, or up it
    bool upward = false;           ///< `down` runs up: a section
    double left = 0, top = 0;      ///< the upper left corner: smallest `across`; smallest `down`, or largest if upward
    double width = 1, height = 1;  ///< [world units]
    int through() const { return 3 - across - down; }  ///< the axis that is looked along
    /// Where a point of the world lies in a picture of this size.  [pixels from the upper left corner]
    glm::dvec2 at(const glm::dvec3& point, double width_pixels, double height_pixels) const {
        const double v = upward ? top - point[down] : point[down] - top;
        return {(point[across] - left) * width_pixels / width, v * height_pixels / height};
    }
};

/// What of the axis looked along is drawn in full colour; the rest is pale.
struct PlanBand {
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
    bool whole() const { return !(low > -1e300) && !(high < 1e300); }
};

/// A square from above around everything that was visible in any of the frames, and the eyes, with some air.
PlanArea planArea(std::span<const Box3d> bounds, std::span<const std::span<const uint8_t>> reasons,
                  std::span<const View> views);

/// From above, around a box, with some air: at most four times as high as wide or as wide as high.
PlanArea planAreaAround(const Box3d& box);

/// From the side: along the world axis that is nearest to the view's direction, as wide as the plan, 2.4 times as wide
/// as high; heights are drawn larger by a whole factor where the world is flat, and the drawing is wider where it is
/// high.
PlanArea sectionArea(std::span<const Box3d> bounds, std::span<const uint8_t> reasons, const View& view,
                     const PlanArea& plan);

/// How many times larger heights are drawn than widths.
double sectionStretch(const PlanArea& area);

/// From the floor below the eye to the ceiling above it: boxes that are flat, large, and above or below the eye. Open
/// where there is none, as in the open air.
PlanBand storeyOf(std::span<const Box3d> bounds, const glm::dvec3& eye);

/// A slice as thick as a twentieth of the section's width, around the eye.
PlanBand sliceOf(const PlanArea& section, const glm::dvec3& eye);

/// Colours: visible, then one per stage; further stages share the last. Blue, two violets, grey, green, ochre, pink,
/// orange and dark brown: all but the violets are told apart by eyes that lack any one of the receptors.
inline constexpr int kPlanColours = 11;
extern const glm::u8vec4 kPlanPalette[kPlanColours];

/// Draws the boxes of the objects, larger ones below smaller ones, flat ones and those outside the band pale;
/// transparent where there is nothing.
/// @param reasons  per object: 0 visible, else 1 + Stage  [size: bounds]
Image<glm::u8vec4> drawPlan(std::span<const Box3d> bounds, std::span<const uint8_t> reasons, const View& view,
                            const PlanArea& area, const PlanBand& band, uint32_t width_pixels);

/// A line of the world that is drawn on a plan or a section.
struct PlanLine {
    glm::dvec3 from{0.0}, to{0.0};
};

/// @param area    of the drawing
/// @param radius  0: one pixel wide, 1: three
void drawOnPlan(Image<glm::u8vec4>& image, const PlanArea& area, std::span<const PlanLine> lines,
                const glm::u8vec4& colour, int radius);

}  // namespace sightline::tools
