// Portal files of the Quake family (.prt): the convex cells of a compiled map, and the holes between them.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sightline/base/result.h"
#include "sightline/cells/cells.h"

namespace sightline::tools {

/// What a portal file says besides its graph.
struct PrtNotes {
    const char* kind = "";             ///< "PRT1", "PRT2" or "PRT1-AM"
    uint32_t leaves = 0;               ///< of the map, without the solid leaf 0
    std::vector<uint32_t> flat_lines;  ///< lines whose portal has no area, so that it is left out
};

/// Reads PRT1, PRT2 and PRT1-AM; a cell is what the file calls a cluster, in PRT1 a leaf. The family's z up becomes
/// y up: (x, y, z) is read as (x, z, -y), units stay. CellGraph::cell_of_leaf counts leaves as the `.bsp` does: leaf 0
/// is solid and has no cell, and the file's leaf i is leaf i + 1. Portals stand in the file's order. Quake 2's files
/// say PRT1 as well, and there the `.bsp` alone knows which leaves a cluster has.
///
/// Errors (kInput) are one line with the name and the line's number: what is no such file, a count that the file is too
/// short for, a cell or leaf that is not there, a portal from a cell into itself or with fewer than three points,
/// numbers that are not finite or beyond 1e9, a leaf that has two cells, what stands behind the end.
///
/// @param notes  filled if it is not null
Result<CellGraph> parsePrt(std::span<const unsigned char> bytes, const std::string& name, PrtNotes* notes = nullptr);

/// The same of a file on disk.
Result<CellGraph> readPrt(const std::string& file, PrtNotes* notes = nullptr);

}  // namespace sightline::tools
