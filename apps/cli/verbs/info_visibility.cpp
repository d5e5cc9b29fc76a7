// Tells what a visibility file holds.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/info_visibility.h"

#include <algorithm>
#include <bit>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/cli/verbs/common.h"
#include "sightline/tools/scene/json_text.h"
#include "sightline/tools/scene/one_line.h"
#include "sightline/tools/scene/text_file.h"
#include "sightline/visfile/visibility_file.h"

namespace sightline::cli {
using namespace tools;
namespace {

using Json = nlohmann::ordered_json;

/// Pairs are ordered: a cell and one that it sees, itself included.
struct VisibilityFacts {
    uint64_t cell_pairs = 0, leaf_pairs = 0, leaves_with_cells = 0;
};

VisibilityFacts countPairs(const VisibilityFile& file) {
    const VisibleRows& rows = file.rows();
    std::vector<uint64_t> leaves_of(rows.cells(), 0), row((rows.cells() + 63) / 64);
    VisibilityFacts facts;
    for (uint32_t leaf = 0; leaf < file.leaves(); ++leaf)
        if (const uint32_t cell = file.cellOfLeaf(leaf); cell != CellGraph::kNoCell) {
            ++leaves_of[cell];
            ++facts.leaves_with_cells;
        }
    for (uint32_t cell = 0; cell < rows.cells(); ++cell) {
        rows.row(cell, row);
        uint64_t leaves = 0;
        for (size_t word = 0; word < row.size(); ++word)
            for (uint64_t bits = row[word]; bits != 0; bits &= bits - 1) {
                leaves += leaves_of[64 * word + static_cast<size_t>(std::countr_zero(bits))];
                ++facts.cell_pairs;
            }
        facts.leaf_pairs += leaves_of[cell] * leaves;
    }
    return facts;
}

/// Counts of cells as places and of what lies in them.
struct PlaceFacts {
    uint64_t cells = 0, portals = 0, doors = 0, objects = 0, places = 0, everywhere = 0, walls = 0, object_pairs = 0;
    const char* cells_are = "";
    bool outside = false;
};

PlaceFacts countPlaces(const VisibilityFile& file) {
    PlaceFacts facts;
    if (!file.hasCells()) return facts;
    facts.cells = file.cells().cells();
    facts.portals = file.portals().portals();
    facts.doors = file.portals().doors();
    facts.cells_are = file.cells().hasRegions() ? "regions" : "leaves of a tree";
    facts.outside = file.cells().outside() != CellGraph::kNoCell;
    const PlacedObjects& objects = file.objects();
    facts.objects = objects.size();
    for (size_t i = 0; i < objects.size(); ++i) {
        facts.places += objects.cells(i).size();
        facts.everywhere += objects.seenFromEverywhere(i);
        facts.walls += objects.isWall(i);
    }
    std::vector<uint64_t> row((objects.size() + 63) / 64);
    for (uint32_t i = 0; file.hasObjectRows() && i < file.rows().cells(); ++i) {
        file.objectRow(i, row);
        for (const uint64_t word : row) facts.object_pairs += static_cast<uint64_t>(std::popcount(word));
    }
    return facts;
}

struct PreparedFacts {
    size_t meshes = 0, inner = 0, clusters = 0, levels = 0;
    uint64_t triangles = 0;  // of occluders
};

PreparedFacts countPrepared(const PreparedMeshes& prepared) {
    PreparedFacts facts;
    facts.meshes = prepared.meshes.size();
    for (const PreparedMesh& mesh : prepared.meshes) {
        facts.triangles += mesh.occluder.triangleCount();
        facts.inner += mesh.inner.size();
        facts.clusters += mesh.clusters.count();
        facts.levels += mesh.lods.levels.size();
    }
    return facts;
}

}  // namespace

bool isVisibilityFile(const std::string& file) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) return false;  // a pipe would have us wait
    char first[sizeof section_file::kMagic] = {};
    std::ifstream in(file, std::ios::binary);
    in.read(first, sizeof first);
    return in && std::equal(std::begin(first), std::end(first), section_file::kMagic);
}

Status infoOfVisibility(const std::string& file, const std::string& json) {
    const Result<std::string> bytes = readTextFile(file);
    if (!bytes) return bytes.error();
    const Result<VisibilityFile> opened = VisibilityFile::open(*bytes, file);
    if (!opened) return opened.error();
    const VisibleRows& rows = opened->rows();
    const VisibilityFacts facts = countPairs(*opened);
    const PlaceFacts places = countPlaces(*opened);
    const Result<PreparedMeshes> prepared = opened->hasPrepared() ? opened->prepared(file) : PreparedMeshes();
    if (!prepared) return prepared.error();
    const PreparedFacts made = countPrepared(*prepared);
    const bool packed = !SectionFile::open(*bytes, file)->find(visibility_file::kPackedRows).empty();
    const std::string map(opened->mapName());
    const std::string hash = fmt::format("{:016x}", opened->mapHash());
    if (json != "-") {
        const auto row = [](const char* name, uint64_t count, const std::string& more = "") {
            fmt::print("  {:<20}{:>14}{}{}\n", name, grouped(count), more.empty() ? "" : "  ", more);
        };
        fmt::print("{}\n", oneLine(file));
        fmt::print("  format              visibility file, {}\n", packed ? "packed" : "in place");
        fmt::print("  map                 {} (hash {})\n", map.empty() ? "-" : oneLine(map), hash);
        if (rows.cells() == 0) fmt::print("  rows of visibility            none\n");
        else row("cells", rows.cells(), grouped(rows.classes()) + " different rows");
        if (opened->leaves() > 0) row("leaves", opened->leaves(), grouped(facts.leaves_with_cells) + " in cells");
        if (rows.cells() > 0) row("visible cell pairs", facts.cell_pairs);
        if (opened->leaves() > 0) row("visible leaf pairs", facts.leaf_pairs);
        if (opened->hasCells()) {
            row("cells as places", places.cells,
                std::string(places.cells_are) + (places.outside ? ", and the outside" : ""));
            row("portals", places.portals, grouped(places.doors) + " doors");
        }
        if (opened->hasObjects())
            row("objects", places.objects,
                fmt::format("in {} places; {} seen from everywhere, {} walls", grouped(places.places),
                            grouped(places.everywhere), grouped(places.walls)));
        if (opened->hasObjectRows()) row("visible objects", places.object_pairs, "pairs of rows and objects");
        if (opened->hasViewCells()) row("view cells", opened->viewRows().rows(), "with a row of objects each");
        if (made.meshes > 0)
            row("prepared meshes", made.meshes,
                fmt::format("{} triangles that hide, {} simpler occluders, {} clusters, {} levels of detail",
                            grouped(made.triangles), grouped(made.inner), grouped(made.clusters),
                            grouped(made.levels)));
        row("bytes", bytes->size(), grouped(opened->residentBytes()) + " resident");
    }
    if (json.empty()) return success();
    Json out = {{"schema", "sightline.visibility/1"},
                {"file", file},
                {"form", packed ? "packed" : "in place"},
                {"map", map},
                {"map_hash", hash},
                {"cells", rows.cells()},
                {"different_rows", rows.classes()},
                {"leafs", opened->leaves()},
                {"leafs_in_cells", facts.leaves_with_cells},
                {"visible_cell_pairs", facts.cell_pairs},
                {"visible_leaf_pairs", facts.leaf_pairs},
                {"bytes", bytes->size()},
                {"resident_bytes", opened->residentBytes()}};
    if (opened->hasCells()) {
        out["places"] = {
            {"cells", places.cells},     {"cells_are", places.cells_are},
            {"outside", places.outside}, {"portals", places.portals},
            {"doors", places.doors},     {"view_cells", opened->hasViewCells() ? opened->viewRows().rows() : 0}};
        if (opened->hasObjects())
            out["objects"] = {{"count", places.objects},
                              {"places", places.places},
                              {"everywhere", places.everywhere},
                              {"walls", places.walls}};
        if (opened->hasObjectRows()) out["visible_object_pairs"] = places.object_pairs;
        if (made.meshes > 0)
            out["prepared"] = {{"meshes", made.meshes},
                               {"occluder_triangles", made.triangles},
                               {"inner_occluders", made.inner},
                               {"clusters", made.clusters},
                               {"levels", made.levels}};
    }
    return writeText(json, jsonText(out, 1) + "\n");
}

}  // namespace sightline::cli
