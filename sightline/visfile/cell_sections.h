// The sections of cells as places: how many there are, their names, and their convex regions.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

#include "sightline/base/result.h"
#include "sightline/cells/cell_space.h"
#include "sightline/visfile/placed_parts.h"
#include "sightline/visfile/section_file.h"

namespace sightline {

namespace visibility_file {

/// cells, outside, leaves, rows: 4 bytes each, the last the number of cells or 0; tolerance (8); per cell its row; per
/// leaf its cell.
inline constexpr uint32_t kCells = section_file::tagOf("cell");
/// Per cell where its name ends (4 bytes); the names. Instead of empty ones there is no section.
inline constexpr uint32_t kCellNames = section_file::tagOf("name");
/// Per cell where its planes end (4 bytes), its bounds (48); the planes (32 each). There is this or a tree.
inline constexpr uint32_t kRegions = section_file::tagOf("regn");

}  // namespace visibility_file

/// Adds the sections to a file.
/// Errors (kUsage): what a reader would refuse.
Status addCellSections(const CellSpace& space, uint32_t rows, SectionWriter& writer, Memory* memory = defaultMemory());

/// These sections where they lie.
class PlacedCells {
public:
    /// @param rows  of visibility, in the file
    /// @param file  what errors call the bytes
    /// Errors (kInput): one line with the file, what is wrong, and at which byte.
    static Result<PlacedCells> open(const SectionFile& sections, uint32_t rows, std::string_view file);

    uint32_t cells() const { return cells_; }
    uint32_t leaves() const { return static_cast<uint32_t>(cell_of_leaf_.size()); }
    /// CellGraph::kNoCell: none.
    /// @pre leaf < leaves()
    uint32_t cellOfLeaf(uint32_t leaf) const { return cell_of_leaf_[leaf]; }
    uint32_t outside() const { return outside_; }
    double tolerance() const { return tolerance_; }
    bool hasNames() const { return names_.ends.size() > 0; }
    bool hasRegions() const { return has_regions_; }
    /// All but portals, doors and the tree.
    void copyTo(CellSpace& space) const;

private:
    uint32_t cells_ = 0, outside_ = CellGraph::kNoCell;
    double tolerance_ = 0;
    bool has_regions_ = false;
    PlacedNumbers<uint32_t> row_of_cell_, cell_of_leaf_, plane_ends_;
    PlacedNumbers<double> bounds_, planes_;
    PlacedNames names_;
};

}  // namespace sightline
