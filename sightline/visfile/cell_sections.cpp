// Writes and opens cells as places.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/cell_sections.h"

#include <cmath>

#include "sightline/base/bytes.h"

namespace sightline {

using namespace visibility_file;

namespace {

constexpr uint32_t kNoCell = CellGraph::kNoCell;
constexpr uint64_t kCellHeadBytes = 24;

bool isUnit(const glm::dvec4& plane) {
    return std::isfinite(plane.w) && std::abs(glm::length(glm::dvec3(plane)) - 1) < 1e-6;
}

glm::dvec4 planeAt(const PlacedNumbers<double>& numbers, size_t i) {
    return {numbers[4 * i], numbers[4 * i + 1], numbers[4 * i + 2], numbers[4 * i + 3]};
}

Box3d boxAt(const PlacedNumbers<double>& numbers, size_t i) {
    return {{numbers[6 * i], numbers[6 * i + 1], numbers[6 * i + 2]},
            {numbers[6 * i + 3], numbers[6 * i + 4], numbers[6 * i + 5]}};
}

/// Finite, and of a box that holds something.
bool isBox(const Box3d& box) { return box.finite() && !box.empty(); }

Error wrong(const char* what) { return {Error::Kind::kUsage, what}; }

Status checkSpace(const CellSpace& space, uint32_t rows) {
    const uint32_t cells = space.graph.cells;
    if (!space.row_of_cell.empty() && space.row_of_cell.size() != cells) return wrong("not a row for each cell");
    for (const uint32_t row : space.row_of_cell)
        if (row >= rows && row != kNoCell) return wrong("a cell with a row that there is not");
    for (const uint32_t cell : space.graph.cell_of_leaf)
        if (cell >= cells && cell != kNoCell) return wrong("a leaf of a cell that there is not");
    if (!space.names.empty() && space.names.size() != cells) return wrong("not a name for each cell");
    if (!(std::isfinite(space.tolerance) && space.tolerance >= 0)) return wrong("a tolerance that is none");
    if (space.outside != kNoCell && (space.outside >= cells || space.ofTree()))
        return wrong("an outside that is no cell");
    if (space.ofTree()) return success();
    if (space.regions.size() != cells) return wrong("not a region for each cell");
    for (uint32_t i = 0; i < cells; ++i) {
        if (i == space.outside) continue;
        const CellRegion& region = space.regions[i];
        if (uint64_t{region.first_plane} + region.plane_count > space.planes.size())
            return wrong("a region with planes that there are not");
        if (!isBox(region.bounds)) return wrong("a region without bounds");
        for (const glm::dvec4& plane : space.planesOf(region))
            if (!isUnit(plane)) return wrong("a plane of a region whose normal has not length 1");
    }
    return success();
}

Array<char> regionsOf(const CellSpace& space, Memory* memory) {
    Array<char> bytes(memory);
    ByteWriter out(bytes);
    uint32_t end = 0;
    const auto planesOf = [&](uint32_t cell) {
        return cell == space.outside ? std::span<const glm::dvec4>() : space.planesOf(space.regions[cell]);
    };
    for (uint32_t i = 0; i < space.graph.cells; ++i) out.put(end += static_cast<uint32_t>(planesOf(i).size()));
    for (uint32_t i = 0; i < space.graph.cells; ++i) {
        const Box3d box = i == space.outside ? Box3d{glm::dvec3(0), glm::dvec3(0)} : space.regions[i].bounds;
        for (const glm::dvec3& corner : {box.min, box.max})
            for (int axis = 0; axis < 3; ++axis) out.put(corner[axis]);
    }
    for (uint32_t i = 0; i < space.graph.cells; ++i)
        for (const glm::dvec4& plane : planesOf(i))
            for (int k = 0; k < 4; ++k) out.put(plane[k]);
    return bytes;
}

}  // namespace

Status addCellSections(const CellSpace& space, uint32_t rows, SectionWriter& writer, Memory* memory) {
    if (Status status = checkSpace(space, rows); !status) return status;
    Array<char> bytes(memory);
    ByteWriter out(bytes);
    out.put(space.graph.cells);
    out.put(space.outside);
    out.put(static_cast<uint32_t>(space.graph.cell_of_leaf.size()));
    out.put(static_cast<uint32_t>(space.row_of_cell.size()));
    out.put(space.tolerance);
    for (const uint32_t row : space.row_of_cell) out.put(row);
    for (const uint32_t cell : space.graph.cell_of_leaf) out.put(cell);
    writer.add(kCells, std::move(bytes));
    uint64_t letters = 0;
    for (const std::string& name : space.names) letters += name.size();
    if (letters > ~0u) return wrong("names of cells that are too long");
    if (letters > 0) {
        Array<char> names(memory);
        ByteWriter ends(names);
        uint32_t end = 0;
        for (const std::string& name : space.names) ends.put(end += static_cast<uint32_t>(name.size()));
        for (const std::string& name : space.names) names.insert(names.end(), name.begin(), name.end());
        writer.add(kCellNames, std::move(names));
    }
    if (!space.ofTree()) writer.add(kRegions, regionsOf(space, memory));
    return success();
}

Result<PlacedCells> PlacedCells::open(const SectionFile& sections, uint32_t rows, std::string_view file) {
    const std::span<const char> bytes = sections.find(kCells), names = sections.find(kCellNames),
                                regions = sections.find(kRegions);
    const uint64_t at = sections.placeOf(bytes);
    if (bytes.size() < kCellHeadBytes) return faultAt(file, "cells that end within their head", at + bytes.size());
    PlacedCells out;
    ByteCursor head(bytes);
    out.cells_ = head.take<uint32_t>();
    out.outside_ = head.take<uint32_t>();
    const uint32_t leaves = head.take<uint32_t>(), with_rows = head.take<uint32_t>();
    out.tolerance_ = head.take<double>();
    if (out.outside_ != kNoCell && out.outside_ >= out.cells_)
        return faultAt(file, "an outside that is no cell", at + 4);
    if (with_rows != 0 && with_rows != out.cells_) return faultAt(file, "not a row for each cell", at + 12);
    if (!(std::isfinite(out.tolerance_) && out.tolerance_ >= 0)) return faultAt(file, "a tolerance that is none", at);
    PlacedParts parts(bytes.subspan(kCellHeadBytes));
    out.row_of_cell_ = parts.take<uint32_t>(with_rows);
    out.cell_of_leaf_ = parts.take<uint32_t>(leaves);
    if (!parts.fits()) return faultAt(file, "cells that are not as long as they say", at);
    for (uint32_t i = 0; i < with_rows; ++i)
        if (const uint32_t row = out.row_of_cell_[i]; row >= rows && row != kNoCell)
            return faultAt(file, "a cell with a row that there is not", at + kCellHeadBytes + 4 * uint64_t{i});
    for (uint32_t i = 0; i < leaves; ++i)
        if (const uint32_t cell = out.cell_of_leaf_[i]; cell >= out.cells_ && cell != kNoCell)
            return faultAt(file, "a leaf of a cell that there is not",
                           at + kCellHeadBytes + 4 * (uint64_t{with_rows} + i));
    if (!names.empty()) {
        PlacedParts texts(names);
        out.names_.ends = texts.take<uint32_t>(out.cells_);
        if (texts.failed()) return faultAt(file, "not a name for each cell", sections.placeOf(names));
        out.names_.bytes = names.subspan(texts.at());
        if (!out.names_.fit()) return faultAt(file, "names that are not as long as they say", sections.placeOf(names));
    }
    out.has_regions_ = !regions.empty();
    PlacedParts shapes(regions);
    const uint64_t regions_at = sections.placeOf(regions);
    if (!out.has_regions_) return out;
    out.plane_ends_ = shapes.take<uint32_t>(out.cells_);
    out.bounds_ = shapes.take<double>(6 * uint64_t{out.cells_});
    if (shapes.failed()) return faultAt(file, "not a region for each cell", regions_at);
    uint32_t end = 0;
    for (uint32_t i = 0; i < out.cells_; ++i) {
        if (out.plane_ends_[i] < end)
            return faultAt(file, "a region that ends before it begins", regions_at + 4 * uint64_t{i});
        end = out.plane_ends_[i];
        if (!isBox(boxAt(out.bounds_, i))) return faultAt(file, "a region without bounds", regions_at);
    }
    out.planes_ = shapes.take<double>(4 * uint64_t{end});
    if (!shapes.fits()) return faultAt(file, "regions that are not as long as they say", regions_at);
    for (uint32_t i = 0; i < end; ++i)
        if (!isUnit(planeAt(out.planes_, i)))
            return faultAt(file, "a plane of a region whose normal has not length 1", regions_at);
    return out;
}

void PlacedCells::copyTo(CellSpace& space) const {
    space.graph.cells = cells_;
    space.outside = outside_;
    space.tolerance = tolerance_;
    space.row_of_cell.resize(row_of_cell_.size());
    for (size_t i = 0; i < row_of_cell_.size(); ++i) space.row_of_cell[i] = row_of_cell_[i];
    space.graph.cell_of_leaf.resize(cell_of_leaf_.size());
    for (size_t i = 0; i < cell_of_leaf_.size(); ++i) space.graph.cell_of_leaf[i] = cell_of_leaf_[i];
    for (size_t i = 0; i < names_.ends.size(); ++i) space.names.emplace_back(names_[i]);
    if (!has_regions_) return;
    for (uint32_t i = 0; i < cells_; ++i) {
        CellRegion region;
        region.first_plane = i == 0 ? 0 : plane_ends_[i - 1];
        region.plane_count = plane_ends_[i] - region.first_plane;
        if (i != outside_) region.bounds = boxAt(bounds_, i);
        space.regions.push_back(region);
    }
    for (size_t i = 0; 4 * i < planes_.size(); ++i) space.planes.push_back(planeAt(planes_, i));
}

}  // namespace sightline
