// The triangles of a sheet in the coordinates of its plane, so that those near a piece of it are found.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/bake/marked/flat_pieces.h"
#include "sightline/bake/marked/opaque_walls.h"
#include "sightline/bake/soup/soup_walls.h"

namespace sightline::bake {

/// A triangle in the frame of its sheet.
struct SheetTriangle {
    FlatPiece piece;  ///< counter-clockwise as seen from the tip of the sheet's normal, grown
    glm::dvec2 min, max;
    uint32_t triangle = 0;  ///< of SoupWalls::triangles
    uint8_t sides = 0;      ///< 1: hides from where the normal points, 2: from behind, 3: from both
    double rounding = 0;    ///< WallTriangle::rounding
};

class FlatSheet {
public:
    FlatSheet() = default;
    /// Triangles become larger by a third of their rounding.
    FlatSheet(const SoupWalls& walls, const WallSheet& sheet);

    const FlatFrame& frame() const { return frame_; }
    /// From left to right.
    const std::vector<SheetTriangle>& triangles() const { return triangles_; }
    /// The triangles that meet a piece: [0] those that hide from where the sheet's normal points, [1] from behind.
    void gather(const FlatPiece& piece, std::vector<const SheetTriangle*> near[2]) const;

private:
    FlatFrame frame_{glm::dvec3(0), glm::dvec3(0, 0, 1)};
    std::vector<SheetTriangle> triangles_;
    std::vector<double> right_;  // per triangle: the farthest right of it and of all before
};

}  // namespace sightline::bake
