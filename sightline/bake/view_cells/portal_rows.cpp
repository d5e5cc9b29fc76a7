// Light from each view cell through portals, and what it comes to of the objects of the cell's row.
// SPDX-License-Identifier: MIT
#include "sightline/bake/view_cells/portal_rows.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "sightline/bake/flow/bake_state.h"
#include "sightline/bake/flow/bit_runs.h"
#include "sightline/bake/flow/region_flow.h"
#include "sightline/bake/objects/object_cells.h"
#include "sightline/bake/objects/scene_hash.h"
#include "sightline/base/bytes.h"
#include "sightline/base/random.h"
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

/// How one cell's flow ended, and what it found hidden.
struct Narrowed {
    RegionFlow::End end = RegionFlow::End::kDone;
    std::vector<uint32_t> hidden;  // columns of the row
};

Array<char> bytesOf(const Narrowed& found, size_t columns) {
    BitMatrix bits(1, columns);
    for (const uint32_t column : found.hidden) bits.set(0, column);
    Array<char> bytes;
    ByteWriter out(bytes);
    out.put(static_cast<uint8_t>(found.end));
    putBits(out, bits.row(0));
    return bytes;
}

std::optional<Narrowed> narrowedOf(std::span<const char> bytes, size_t columns) {
    ByteCursor in(bytes);
    const auto end = in.take<uint8_t>();
    BitMatrix bits(1, columns);
    if (end > static_cast<uint8_t>(RegionFlow::End::kStopped) || !takeBits(in, bits.row(0), columns) || in.left() > 0)
        return std::nullopt;
    Narrowed out{static_cast<RegionFlow::End>(end), {}};
    for (uint32_t column = 0; column < columns; ++column)
        if (bits.at(0, column)) out.hidden.push_back(column);
    return out;
}

/// All that the flows depend on besides a cell and its row.
uint64_t questionOf(const Scene& scene, const CellSpace& space, std::span<const uint32_t> object_of,
                    const std::vector<bool>& moves) {
    uint64_t question = mixSeed(mixSeed(kRowsVersion, hashOf(scene)), hashOf(space.graph));
    for (const uint32_t object : object_of) question = mixSeed(question, object);
    for (const bool one : moves) question = mixSeed(question, one);
    return question;
}

uint64_t questionOf(uint64_t all, const Box3d& region, std::span<const uint64_t> row) {
    for (const uint64_t word : row) all = mixSeed(all, word);
    return askedWith(all, {{region.min.x, region.min.y, region.min.z, region.max.x, region.max.y, region.max.z}});
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
    std::vector<Narrowed> found(count);
    std::vector<uint64_t> questions(count, 0);  // of those that the journal does not answer
    const uint64_t all = settings.journal ? questionOf(scene, space, object_of, settings.moves) : 0;
    constexpr uint32_t kTogether = 16, kTasks = 16;  // cells of a task, and tasks between two questions whether to stop
    const uint32_t tasks = (count + kTogether - 1) / kTogether;
    const auto stops = [&] { return settings.stop && settings.stop(); };
    for (uint32_t begin = 0; begin < tasks && !stops(); begin += kTasks) {
        runJobs(settings.jobs, std::min(kTasks, tasks - begin), [&](uint32_t task) {
            RegionFlow flow(space);
            const uint32_t first = (begin + task) * kTogether;
            for (uint32_t leaf = std::max(first, 1u); leaf < std::min(count, first + kTogether); ++leaf) {
                if (boxes[leaf].empty()) continue;
                if (settings.journal) {
                    questions[leaf] = questionOf(all, boxes[leaf], rows.row(leaf));
                    if (const auto answer = settings.journal->find(questions[leaf]))
                        if (std::optional<Narrowed> left = narrowedOf(*answer, rows.columns())) {
                            found[leaf] = std::move(*left);
                            questions[leaf] = 0;
                            continue;
                        }
                }
                found[leaf].end = findHidden(flow, boxes[leaf], pieces, rows, leaf, found[leaf].hidden);
            }
        });
        if (settings.journal) {
            const uint32_t end = std::min(count, (begin + kTasks) * kTogether);
            for (uint32_t leaf = begin * kTogether; leaf < end; ++leaf)
                if (questions[leaf]) settings.journal->add(questions[leaf], bytesOf(found[leaf], rows.columns()));
            settings.journal->keep(stops());
        }
        if (settings.progress) settings.progress(std::min(1.0, double(begin + kTasks) / static_cast<double>(tasks)));
    }
    for (uint32_t leaf = 0; leaf < count; ++leaf) {
        for (const uint32_t column : found[leaf].hidden) rows.clear(leaf, column);
        counts.hidden += found[leaf].hidden.size();
        counts.over_budget += found[leaf].end == RegionFlow::End::kOverBudget;
        counts.out_of_bounds += found[leaf].end == RegionFlow::End::kOutOfBounds;
    }
    return counts;
}

}  // namespace sightline::bake
