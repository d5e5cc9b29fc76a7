// What must hold of any bytes that are opened as a visibility file: for the tests and the fuzzer.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sightline/cells/portal_graph.h"
#include "sightline/visfile/visibility_file.h"
#include "tests/visfile/prepared_check.h"

namespace sightline::test {

/// Empty, or what is wrong with view cells: a child or an object that there is not.
inline std::string faultOfViews(const VisibilityFile& file) {
    if (!file.hasViewCells()) return {};
    if (!file.hasObjects()) return "view cells without objects";
    const LeafTree tree = file.viewTree();
    if (file.viewRows().rows() != tree.contents.size()) return "not a row for each view cell";
    for (size_t i = 0; i < tree.nodes.size(); ++i)
        for (const uint32_t child : tree.nodes[i].child)
            if ((child & LeafTreeNode::kLeaf) != 0 ? (child ^ LeafTreeNode::kLeaf) >= tree.contents.size()
                                                   : child <= i || child >= tree.nodes.size())
                return "a child of view cells that there is not";
    const size_t objects = file.objects().size();
    std::vector<uint64_t> seen((objects + 63) / 64);
    for (uint32_t row = 0; row < file.viewRows().rows(); ++row) {
        file.viewRows().row(row, seen);
        if (objects % 64 != 0 && seen.back() >> objects % 64 != 0) return "an object behind the last, from a view cell";
    }
    return {};
}

/// Empty, or what is wrong with cells as places: a number of what there is not, what is not finite.
inline std::string faultOfPlaces(const VisibilityFile& file) {
    if (!file.hasCells())
        return file.hasObjects() || file.hasObjectRows() || file.hasPrepared() ? "objects without cells" : "";
    const CellSpace space = file.cellSpace();
    const uint32_t cells = space.graph.cells, none = CellGraph::kNoCell;
    for (const uint32_t row : space.row_of_cell)
        if (row >= file.rows().cells() && row != none) return "a cell with a row that there is not";
    if (!space.row_of_cell.empty() && space.row_of_cell.size() != cells) return "cells with and without rows";
    if (space.outside >= cells && space.outside != none) return "an outside that is no cell";
    if (!space.names.empty() && space.names.size() != cells) return "not a name for each cell";
    if (space.ofTree()) {
        if (space.graph.cell_of_leaf.size() != space.tree.contents.size()) return "not a cell for each leaf";
        for (const uint32_t cell : space.graph.cell_of_leaf)
            if (cell >= cells && cell != none) return "a leaf of a cell that there is not";
        for (size_t i = 0; i < space.tree.nodes.size(); ++i)
            for (const uint32_t child : space.tree.nodes[i].child)
                if ((child & LeafTreeNode::kLeaf) != 0 ? (child ^ LeafTreeNode::kLeaf) >= space.tree.contents.size()
                                                       : child <= i || child >= space.tree.nodes.size())
                    return "a child that there is not";
    } else {
        if (space.regions.size() != cells) return "not a region for each cell";
        for (const CellRegion& region : space.regions)
            if (region.first_plane + region.plane_count > space.planes.size()) return "planes that there are not";
        for (const glm::dvec4& plane : space.planes)
            if (!(std::abs(glm::length(glm::dvec3(plane)) - 1) < 1e-5)) return "a plane without a unit normal";
    }
    for (const CellPortal& portal : space.graph.portals) {
        if (portal.cells[0] >= cells || portal.cells[1] >= cells) return "a portal of a cell that there is not";
        if (uint64_t{portal.first} + portal.count > space.graph.points.size()) return "points that there are not";
        if (portal.door >= space.doors.size() && portal.door != CellPortal::kNone) return "a door that there is not";
    }
    for (const glm::dvec3& point : space.graph.points)
        if (!std::isfinite(point.x + point.y + point.z)) return "a point that is not finite";
    const PortalGraph graph(space);
    Array<uint32_t> met;
    for (const Box3d& box : {Box3d{glm::dvec3(0), glm::dvec3(1)}, Box3d{glm::dvec3(0.5), glm::dvec3(0.5)}}) {
        graph.cellsOf(box, met);
        graph.cellsAround({&box.min, 1}, 0.1, met);
        for (const uint32_t cell : met)
            if (cell >= cells) return "a body in a cell that there is not";
    }
    const PlacedObjects& objects = file.objects();
    for (size_t i = 0; i < objects.size(); ++i) {
        const auto [begin, end] = objects.find(objects.key(i));
        if (i < begin || i >= end) return "an object that is not found";
        const PlacedNumbers<uint32_t> in = objects.cells(i);
        if (in.size() == 0 && !objects.seenFromEverywhere(i)) return "an object in no cell";
        for (size_t k = 0; k < in.size(); ++k)
            if (in[k] >= cells) return "an object in a cell that there is not";
        if (!objects.bounds(i).finite()) return "an object without bounds";
    }
    std::vector<uint64_t> seen((objects.size() + 63) / 64);
    for (uint32_t row = 0; file.hasObjectRows() && row < file.rows().cells(); ++row) {
        file.objectRow(row, seen);
        if (objects.size() % 64 != 0 && seen.back() >> objects.size() % 64 != 0) return "an object behind the last";
    }
    if (file.hasPrepared()) {
        const std::string fault = faultOfPrepared(file.prepared("a/map.see"), objects.size());
        if (!fault.empty()) return fault;
    }
    return faultOfViews(file);
}

/// Empty, or what is wrong with the answers: a pair that is not as its rows say, a leaf of no cell that there is.
inline std::string faultOfAnswers(const VisibilityFile& file) {
    const VisibleRows& rows = file.rows();
    const uint32_t cells = rows.cells(), step = 1 + cells / 200;
    std::vector<uint64_t> row((cells + 63) / 64);
    for (uint32_t a = 0; a < cells; a += step) {
        rows.row(a, row);
        if (!rows.sees(a, a)) return "a cell that does not see itself";
        for (uint32_t b = 0; b < cells; b += step) {
            const bool in_row = row[b / 64] >> b % 64 & 1;
            if (rows.sees(a, b) != in_row || rows.sees(b, a) != in_row) return "a pair that is not as its row says";
        }
    }
    for (uint32_t i = 0; i < file.leaves(); ++i)
        if (file.cellOfLeaf(i) >= cells && file.cellOfLeaf(i) != CellGraph::kNoCell) return "a leaf of no cell";
    return faultOfPlaces(file);
}

/// Empty, or what is wrong with how the bytes are read: they are opened, and then all answers fit each other, or are refused
/// with one line.
/// @param opened  set to whether they are
inline std::string faultOfReading(std::span<const char> bytes, bool& opened) {
    const Result<VisibilityFile> file = VisibilityFile::open(bytes, "a/map.see");
    opened = file.ok();
    if (opened) return faultOfAnswers(*file);
    const std::string& line = file.error().message;
    if (line.rfind("a/map.see: ", 0) == 0 && line.find('\n') == std::string::npos) return {};
    return "not one line that begins with the file: " + line;
}

}  // namespace sightline::test
