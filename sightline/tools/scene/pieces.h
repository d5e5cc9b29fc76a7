// Reads tables of materials and pieces: what the procedural scenes are furnished with, as text that a person can edit.
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

#include "sightline/base/result.h"
#include "sightline/tools/scene/scene.h"
#include "sightline/tools/scene/solids.h"

namespace sightline::tools {

struct Pieces {
    std::vector<Material> materials;  ///< in the table's order
    std::vector<Mesh> meshes;         ///< in the table's order
};

/// Each line is a statement; `#` begins a comment; a line that begins with a number goes on with the line before.
/// In a material's name `_` stands for a space.
///
///     material NAME RED GREEN BLUE [OPACITY] [mask|blend] [two_sided]
///     piece NAME                                               the shapes below are its own; none: made by code
///     box MATERIAL  X Y Z  X Y Z                               least and greatest corner
///     prism MATERIAL up|across|along  LOW HIGH  A B  A B ...   an outline: up (z, x), across (z, y), along (x, y)
///     turned MATERIAL SIDES  X Y Z  RADIUS Y  RADIUS Y ...     about the vertical through a point, from below
///     quad MATERIAL  X Y Z  X Y Z  X Y Z  X Y Z                counter-clockwise is front
///     triangle MATERIAL  X Y Z  X Y Z  X Y Z
///     copies x|y|z  A B ...  SHAPES  end                       the shapes moved by each of the lengths
///     fifths  SHAPES  end                                      the shapes turned about the vertical, five times
///
/// Errors name the line and the fault.
Result<Pieces> readPieces(std::string_view table);

/// The same of a table that is part of the program, and hence without faults.
Pieces builtInPieces(std::string_view table);

/// Gives a piece that the table has by name alone its shape.
void putShape(Mesh& piece, const city::MeshBuilder& shape);

extern const std::string_view kBuildingPieces, kCityPieces, kTerrainPieces;

}  // namespace sightline::tools
