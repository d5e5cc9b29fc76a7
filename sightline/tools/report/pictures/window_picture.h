// The windows through which cells are seen, over the picture that they are of.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/tools/report/pictures/png.h"

namespace sightline::tools {

/// A part of the image that a cell is seen through.
struct CellWindow {
    uint32_t cell = 0;
    std::vector<glm::dvec2> outline;  ///< convex  [viewport pixels from the left and the top]
};

/// The picture, pale, with the outlines of exact windows in a colour for each cell, and those of boxes thin and dark.
/// @param scale  picture pixels in a viewport pixel
Image<Rgb> windowPicture(const Image<Rgb>& picture, const glm::dvec2& scale, std::span<const CellWindow> exact,
                         std::span<const CellWindow> boxes);

/// "12 cells through 17 windows; boxes reach 14 cells, and 1.4 times the area."
std::string windowText(std::span<const CellWindow> exact, std::span<const CellWindow> boxes);

}  // namespace sightline::tools
