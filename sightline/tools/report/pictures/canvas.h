// Lines, discs and convex polygons with smooth edges, drawn over a picture.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <utility>

#include <glm/glm.hpp>

#include "sightline/tools/report/pictures/png.h"

namespace sightline::tools {

/// A picture to be drawn on. Places are in pixels from the upper left corner; the middle of the first pixel is (0.5, 0.5). What lies
/// outside of the picture, or is not finite, is left out.
class Canvas {
public:
    Canvas(uint32_t width, uint32_t height, Rgb paper) : image_(width, height, paper) {}
    explicit Canvas(Image<Rgb> picture) : image_(std::move(picture)) {}

    const Image<Rgb>& image() const { return image_; }

    /// @param width    [pixels]
    /// @param opacity  [0 to 1]
    void line(const glm::dvec2& from, const glm::dvec2& to, double width, Rgb colour, double opacity = 1);
    /// @param radius  [pixels]
    void disc(const glm::dvec2& middle, double radius, Rgb colour, double opacity = 1);
    /// @param outline  convex, either way round; with fewer than three points, or no area, nothing is drawn
    void fill(std::span<const glm::dvec2> outline, Rgb colour, double opacity = 1);

private:
    template <class Distance>
    void blend(const glm::dvec2& low, const glm::dvec2& high, Rgb colour, double opacity, const Distance& distance);

    Image<Rgb> image_;
};

/// The corners of the smallest convex polygon around some points, counter-clockwise where y points up; fewer than three if all lie on
/// a line. Sorts the points.
///
/// A. M. Andrew. Another Efficient Algorithm for Convex Hulls in Two Dimensions. 1979.
std::vector<glm::dvec2> convexHull(std::vector<glm::dvec2> points);

/// Leaves of a convex outline what is on one side of a line: line.x * x + line.y * y + line.z >= 0.
void cutOutline(std::vector<glm::dvec2>& outline, const glm::dvec3& line);

}  // namespace sightline::tools
