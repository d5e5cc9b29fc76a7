// Rows of visibility: their bytes on disk and in memory and what an answer costs, beside the run-length lump.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <filesystem>
#include <numeric>

#include <fmt/core.h>

#include "bench/cases.h"
#include "bench/stopwatch.h"
#include "sightline/base/random.h"
#include "sightline/tools/import/quake/map_source.h"
#include "sightline/tools/import/quake/prt.h"
#include "sightline/tools/import/quake/quake_visibility.h"
#include "sightline/visfile/visibility_file.h"

namespace sightline::bench {
using namespace tools;
namespace {

/// Cells that see one another, and the leaves that a lump counts.
struct Pvs {
    std::string name;
    BitMatrix visible;                   ///< [cells x cells]
    std::vector<uint32_t> cell_of_leaf;  ///< leaf 0 is solid, as in maps
};

/// The rows of the lump's leaves: leaf i + 1 is bit i. All leaves of a cell have one row.
BitMatrix leafRows(const Pvs& pvs) {
    const size_t leaves = pvs.cell_of_leaf.size() - 1;
    BitMatrix rows(leaves, leaves);
    for (size_t a = 0; a < leaves; ++a)
        for (size_t b = 0; b < leaves; ++b)
            if (pvs.visible.at(pvs.cell_of_leaf[a + 1], pvs.cell_of_leaf[b + 1])) rows.set(a, b);
    return rows;
}

/// The row that begins at `at`, as engines unpack it: a zero byte is followed by how many there are.
void unpackRow(const std::vector<unsigned char>& lump, size_t at, std::span<unsigned char> out) {
    for (size_t i = 0; i < out.size();) {
        if (lump[at] != 0) {
            out[i++] = lump[at++];
            continue;
        }
        for (unsigned zeros = lump[at + 1]; zeros > 0 && i < out.size(); --zeros) out[i++] = 0;
        at += 2;
    }
}

/// One bit of that row, which has to be walked up to it.
bool bitOfRow(const std::vector<unsigned char>& lump, size_t at, size_t bit) {
    for (size_t i = 0;; at += lump[at] == 0 ? 2 : 1) {
        if (lump[at] != 0) {
            if (i++ == bit / 8) return lump[at] >> bit % 8 & 1;
        } else if ((i += lump[at + 1]) > bit / 8) {
            return false;
        }
    }
}

struct Question {
    uint32_t a = 0, b = 0;
};

void measurePvs(const Pvs& pvs, int repeat, Table& table) {
    const Rows row{table, pvs.name};
    const uint32_t cells = static_cast<uint32_t>(pvs.visible.rows());
    const auto leaves = static_cast<uint32_t>(pvs.cell_of_leaf.size() - 1);
    const QuakeVisibilityLump lump = packQuakeVisibility(QuakeFormat::kQuake, leafRows(pvs));
    const VisibilityContent content{pvs.visible, pvs.cell_of_leaf, pvs.name};
    Array<char> packed, in_place;
    const double write_packed =
        millisecondsOf([&] { packed = std::move(*visibilityFile(content, VisibilityForm::kPacked)); });
    const double write_in_place =
        millisecondsOf([&] { in_place = std::move(*visibilityFile(content, VisibilityForm::kInPlace)); });
    const double open_packed = millisecondsOf([&] { (void)VisibilityFile::open(packed, pvs.name).ok(); });
    const double open_in_place = millisecondsOf([&] { (void)VisibilityFile::open(in_place, pvs.name).ok(); });
    const Result<VisibilityFile> file = VisibilityFile::open(in_place, pvs.name);
    const VisibleRows& rows = file->rows();

    const double lump_bytes = static_cast<double>(lump.bytes.size());
    const auto count = [](size_t bytes) { return static_cast<double>(bytes); };
    row("on disk, packed", count(packed.size()), "bytes", "run-length lump", lump_bytes,
        fmt::format("{} cells, {} different rows, {} leaves", cells, rows.classes(), leaves));
    row("on disk, to be used in place", count(in_place.size()), "bytes", "run-length lump", lump_bytes);
    row("resident, rows and leaves", count(file->residentBytes()), "bytes", "run-length lump", lump_bytes);
    row("resident, rows alone", count(rows.bytes()), "bytes", "run-length lump", lump_bytes);

    Random random(1);
    std::vector<Question> asked(20000);
    for (Question& q : asked)
        q = {static_cast<uint32_t>(1 + random.below(leaves)), static_cast<uint32_t>(1 + random.below(leaves))};
    std::vector<uint64_t> of_cells((cells + 63) / 64);
    std::vector<unsigned char> of_leaves((leaves + 7) / 8);
    uint64_t sum = 0, lump_sum = 0;
    const std::vector<double> times =
        threadTimes({[&] {
                         for (size_t i = 0; i < 2000; ++i) {
                             rows.row(file->cellOfLeaf(asked[i].a), of_cells);
                             sum += of_cells[0];
                         }
                     },
                     [&] {
                         for (size_t i = 0; i < 2000; ++i) {
                             unpackRow(lump.bytes, static_cast<size_t>(lump.row_offsets[asked[i].a - 1]), of_leaves);
                             sum += of_leaves[0];
                         }
                     },
                     [&] {
                         sum = 0;
                         for (const Question& q : asked) sum += rows.sees(file->cellOfLeaf(q.a), file->cellOfLeaf(q.b));
                     },
                     [&] {
                         lump_sum = 0;
                         for (const Question& q : asked)
                             lump_sum += bitOfRow(lump.bytes, static_cast<size_t>(lump.row_offsets[q.a - 1]), q.b - 1);
                     }},
                    repeat);
    if (sum != lump_sum) table.faults.push_back(pvs.name + ": the rows and the lump do not give the same answers");
    const double pairs = static_cast<double>(asked.size());
    row("a row of cells", times[0] / 2000, "us", "a row of leaves from the lump", times[1] / 2000);
    row("a pair of leaves", 1e3 * times[2] / pairs, "ns", "a pair from the lump", 1e3 * times[3] / pairs);
    row("writing, packed", write_packed, "ms", "writing, to be used in place", write_in_place);
    row("opening, packed", open_packed, "ms", "opening in place", open_in_place);
}

/// The PVS that a compiled map has, cells as its portal file beside it says; of each pair the two must agree.
/// @returns false if a file is not there
bool takeMap(const std::string& folder, const std::string& name, Pvs& pvs) {
    const std::string bsp = folder + name + ".vis.bsp", prt = folder + name + ".prt";
    const Result<CellGraph> graph = readPrt(prt);
    const Result<QuakeMapFile> map = readQuakeMap(bsp);
    if (!graph || !map) return false;
    const Result<QuakeVisibility> visibility = readQuakeVisibility(*map, bsp);
    if (!visibility) return false;
    pvs.name = name;
    pvs.cell_of_leaf = graph->cell_of_leaf;
    pvs.visible = BitMatrix(graph->cells, graph->cells);
    const auto sees = [&](size_t a, size_t b) { return visibility->seen.at(a - 1, b - 1); };
    std::vector<uint32_t> leaf_of(graph->cells, 0);
    for (uint32_t leaf = 1; leaf < pvs.cell_of_leaf.size(); ++leaf) leaf_of[pvs.cell_of_leaf[leaf]] = leaf;
    for (uint32_t a = 0; a < graph->cells; ++a)
        for (uint32_t b = 0; b <= a; ++b)
            if (a == b || (sees(leaf_of[a], leaf_of[b]) && sees(leaf_of[b], leaf_of[a]))) {
                pvs.visible.set(a, b);
                pvs.visible.set(b, a);
            }
    return true;
}

/// Rooms in a grid, four cells each, numbered row by row: a room sees along its row and its column up to the first wall without
/// a door, and of the rooms at its corners some.
Pvs gridOfRooms(uint32_t side) {
    constexpr uint32_t kCellsOfRoom = 4;
    Random random(1);
    Pvs pvs;
    pvs.name = fmt::format("{0} x {0} rooms", side);
    const uint32_t cells = side * side * kCellsOfRoom;
    pvs.visible = BitMatrix(cells, cells);
    const auto join = [&](uint32_t room, uint32_t other, bool all) {
        for (uint32_t i = 0; i < kCellsOfRoom; ++i)
            for (uint32_t k = 0; k < kCellsOfRoom; ++k)
                if (all || random.below(3) == 0) {
                    pvs.visible.set(kCellsOfRoom * room + i, kCellsOfRoom * other + k);
                    pvs.visible.set(kCellsOfRoom * other + k, kCellsOfRoom * room + i);
                }
    };
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x) {
            join(y * side + x, y * side + x, true);
            for (uint32_t u = x + 1; u < side && random.below(5) != 0; ++u)
                join(y * side + x, y * side + u, u == x + 1);
            for (uint32_t v = y + 1; v < side && random.below(5) != 0; ++v)
                join(y * side + x, v * side + x, v == y + 1);
            if (x + 1 < side && y + 1 < side) join(y * side + x, (y + 1) * side + x + 1, false);
        }
    pvs.cell_of_leaf.push_back(CellGraph::kNoCell);
    for (uint32_t leaf = 0; leaf < 2 * cells; ++leaf) pvs.cell_of_leaf.push_back(leaf / 2);
    return pvs;
}

}  // namespace

Table benchRows(const Options& options) {
    Table table{"rows", {}};
    const int repeat = options.repeat ? options.repeat : 15;
    for (const char* name : {"lq_e4m1", "lq_e2m2", "lqdm3", "lq_e1m5"}) {
        Pvs pvs;
        if (takeMap("../shared/maps/", name, pvs)) measurePvs(pvs, repeat, table);
    }
    for (const uint32_t side : {16u, 32u}) measurePvs(gridOfRooms(side), repeat, table);
    return table;
}

}  // namespace sightline::bench
