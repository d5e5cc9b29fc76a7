// Light from each view cell through portals, and what it comes to of the objects of the cell's row.
// SPDX-License-Identifier: MIT
#include "sightline/bake/view_cells/portal_rows.h"

#include <algorithm>

#include "sightline/bake/flow/region_flow.h"
#include "sightline/bake/objects/object_cells.h"
#include "sightline/math/box.h"

namespace sightline::bake {
using namespace tools;
namespace {

/// What lies of the rows' objects in the cells of a space.
struct PiecesInCells {
    struct Piece {
        uint32_t column;
        Box3d box;
    };
    std::vector<std::vector<Piece>> in_cell;
    std::vector<uint32_t> columns;  // of objects that are in cells

    PiecesInCells(const Scene& scene, const CellSpace& space, std::span<const uint32_t> object_of,
                  const ObjectCellSettings& placing)
        : in_cell(space.graph.cells) {
        constexpr uint32_t kNone = ~0u;
        std::vector<uint32_t> column_of(scene.objects.size(), kNone);
        for (uint32_t column = 0; column < object_of.size(); ++column) column_of[object_of[column]] = column;
        const ObjectCells objects = cellsOfObjects(scene, space, placing);
        const ObjectPlaces& places = objects.places;
        for (uint32_t place = 0; place < places.size(); ++place) {
            const uint32_t column = column_of[objects.object_of[place]];
            if (column == kNone || places.everywhere[place]) continue;
            columns.push_back(column);
            for (uint64_t at = places.first_cell[place]; at < places.first_cell[place + 1]; ++at)
                in_cell[places.cells[at]].push_back({column, objects.pieces[at]});
        }
    }
};

/// Lists the columns of a row that no way leads to; none if the flow did not end by itself.
RegionFlow::End findHidden(RegionFlow& flow, const Box3d& region, const PiecesInCells& pieces, const BitMatrix& rows,
                           size_t row, std::vector<uint32_t>& hidden) {
    std::vector<uint8_t> seen(rows.columns(), 1);  // or not asked for
    size_t left = 0;
    for (const uint32_t column : pieces.columns)
        if (rows.at(row, column)) {
            seen[column] = 0;
            ++left;
        }
    const RegionFlow::End end = flow.from(region, [&](uint32_t cell, const Penumbra* through) {
        for (const PiecesInCells::Piece& piece : pieces.in_cell[cell])
            if (!seen[piece.column] && (!through || through->touches(piece.box))) {
                seen[piece.column] = 1;
                --left;
            }
        return left > 0;
    });
    if (end != RegionFlow::End::kDone) return end;
    for (const uint32_t column : pieces.columns)
        if (!seen[column]) hidden.push_back(column);
    return end;
}

}  // namespace

PortalRowCounts narrowRows(const LeafTree& tree, const CellSpace& space, const Scene& scene,
                           std::span<const uint32_t> object_of, const PortalRowSettings& settings, BitMatrix& rows) {
    PortalRowCounts counts;
    if (!space.ofTree() || space.graph.portals.empty()) return counts;
    ObjectCellSettings placing;
    placing.moves = settings.moves;
    placing.jobs = settings.jobs;
    const PiecesInCells pieces(scene, space, object_of, placing);
    const std::vector<Box3d> boxes = leafBoxes(tree);
    const auto count = static_cast<uint32_t>(boxes.size());
    std::vector<std::vector<uint32_t>> hidden(count);
    std::vector<RegionFlow::End> ends(count, RegionFlow::End::kDone);
    constexpr uint32_t kTogether = 16, kTasks = 16;  // cells of a task, and tasks between two questions whether to stop
    const uint32_t tasks = (count + kTogether - 1) / kTogether;
    for (uint32_t begin = 0; begin < tasks && !(settings.stop && settings.stop()); begin += kTasks) {
        runJobs(settings.jobs, std::min(kTasks, tasks - begin), [&](uint32_t task) {
            RegionFlow flow(space);
            const uint32_t first = (begin + task) * kTogether;
            for (uint32_t leaf = std::max(first, 1u); leaf < std::min(count, first + kTogether); ++leaf)
                if (!boxes[leaf].empty()) ends[leaf] = findHidden(flow, boxes[leaf], pieces, rows, leaf, hidden[leaf]);
        });
        if (settings.progress) settings.progress(std::min(1.0, double(begin + kTasks) / static_cast<double>(tasks)));
    }
    for (uint32_t leaf = 0; leaf < count; ++leaf) {
        for (const uint32_t column : hidden[leaf]) rows.clear(leaf, column);
        counts.hidden += hidden[leaf].size();
        counts.over_budget += ends[leaf] == RegionFlow::End::kOverBudget;
        counts.out_of_bounds += ends[leaf] == RegionFlow::End::kOutOfBounds;
    }
    return counts;
}

}  // namespace sightline::bake
