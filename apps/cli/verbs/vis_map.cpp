// Reads a map of any kind, and makes cells of its leaves.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/vis_map.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/common.h"
#include "sightline/bake/brushes/brush_tree.h"
#include "sightline/base/bytes.h"
#include "sightline/bsp/merge_cells.h"
#include "sightline/bsp/open_groups.h"
#include "sightline/bsp/tree_portals.h"
#include "sightline/tools/import/quake/map_source.h"
#include "sightline/tools/import/quake/prt.h"
#include "sightline/tools/import/quake/quake_map.h"
#include "sightline/tools/import/quake/quake_scene.h"
#include "sightline/tools/scene/one_line.h"
#include "sightline/tools/scene/procedural.h"
#include "sightline/tools/scene/text_file.h"

namespace sightline::cli {
using namespace bake;
using namespace tools;
namespace {

namespace fs = std::filesystem;

/// The file of the same name with another end, if there is one.
std::string beside(const std::string& name, const char* end) {
    const fs::path other = fs::path(name).replace_extension(end);
    std::error_code error;
    return fs::is_regular_file(other, error) ? other.string() : "";
}

uint64_t hashOfBytes(std::span<const unsigned char> bytes) {
    return contentHash({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

Status readMap(const std::string& name, VisMap& out) {
    Result<MapBytes> file = readMapBytes(name);
    if (!file) return file.error();
    Result<QuakeMapFile> map = parseQuakeBsp(file->bytes, file->name);
    if (!map) return map.error();
    out.map = std::move(*map);
    out.map_name = file->name;
    out.map_bytes = std::move(file->bytes);
    out.content_hash = hashOfBytes(out.map_bytes);
    return success();
}

/// Numbers by what they stand for, from 0 in the order of their coming.
class Numbers {
public:
    uint32_t of(uint64_t key) {
        const auto [found, fresh] = known_.emplace(key, count_);
        count_ += fresh;
        return found->second;
    }
    uint32_t ofNobody() { return count_++; }
    uint32_t count() const { return count_; }

private:
    std::map<uint64_t, uint32_t> known_;
    uint32_t count_ = 0;
};

/// Cells of leaves that have the same key; leaves without one stay alone.
template <class KeyOfLeaf>
CellGraph mergeLeaves(const CellGraph& graph, KeyOfLeaf&& key_of_leaf) {
    Numbers numbers;
    std::vector<uint32_t> number(graph.cells, CellGraph::kNoCell);
    for (uint32_t leaf = 0; leaf < graph.cell_of_leaf.size(); ++leaf) {
        const uint32_t cell = graph.cell_of_leaf[leaf];
        if (cell == CellGraph::kNoCell) continue;
        const std::optional<uint64_t> key = key_of_leaf(leaf);
        number[cell] = key ? numbers.of(*key) : numbers.ofNobody();
    }
    return joinPortals(mergeCells(graph, number, numbers.count()));
}

/// The clusters of a portal file, if it is one of this map.
Status mergeByPortalFile(const std::string& name, VisMap& out) {
    const Result<CellGraph> portals = readPrt(name);
    if (!portals) return portals.error();
    const std::vector<uint32_t>& cell_of_leaf = portals->cell_of_leaf;
    if (cell_of_leaf.size() != out.map->clusters + size_t(1))
        return Error{Error::Kind::kInput, fmt::format("{}: has {} leaves, and {} has {}", name, cell_of_leaf.size() - 1,
                                                      out.map_name, out.map->clusters)};
    out.graph = mergeLeaves(out.graph, [&](uint32_t leaf) -> std::optional<uint64_t> {
        if (leaf >= cell_of_leaf.size() || cell_of_leaf[leaf] == CellGraph::kNoCell) return std::nullopt;
        return cell_of_leaf[leaf];
    });
    out.cells_are = "clusters of " + name;
    return success();
}

/// Whether leaves share rows of the lump: then these are clusters, as a compiler made them.
bool hasSharedRows(const QuakeMapFile& map) {
    std::vector<int32_t> rows;
    for (const int32_t row : map.row_offsets)
        if (row >= 0) rows.push_back(row);
    const size_t all = rows.size();
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    return all >= 2 && rows.size() > 1 && rows.size() < all;
}

void mergeByRows(VisMap& out) {
    const QuakeMapFile& map = *out.map;
    out.graph = mergeLeaves(out.graph, [&](uint32_t leaf) -> std::optional<uint64_t> {
        const uint32_t cluster = map.cluster_of_leaf[leaf];
        if (cluster == QuakeMapFile::kNoCluster || map.row_offsets[cluster] < 0) return std::nullopt;
        return static_cast<uint64_t>(map.row_offsets[cluster]);
    });
    out.cells_are = "leaves that share a row of the file";
}

void mergeByFileClusters(VisMap& out) {
    const QuakeMapFile& map = *out.map;
    out.graph = mergeLeaves(out.graph, [&](uint32_t leaf) -> std::optional<uint64_t> {
        const uint32_t cluster = map.cluster_of_leaf[leaf];
        if (cluster == QuakeMapFile::kNoCluster) return std::nullopt;
        return cluster;
    });
    out.cells_are = "clusters of the file";
}

void mergeOpen(const LeafTree& tree, VisMap& out) {
    const OpenGroups groups = groupOpenCells(tree, out.graph);
    out.graph = joinPortals(mergeCells(out.graph, groups.group_of_cell, groups.groups));
    out.cells_are = "groups of leaves that are open to one another";
}

Status findCells(const VisMapChoice& choice, VisMap& out) {
    const QuakeMapFile& map = *out.map;
    TreePortalSettings settings;
    settings.contents_stop = choice.water_is_opaque;
    TreePortalCounts counts;
    out.graph = cellsOfTree(map.tree, settings, &counts);
    if (choice.keep_leaves) out.leaf_graph = out.graph;
    out.tolerance = counts.tolerance;
    out.tree = map.tree;
    out.contents_stop = settings.contents_stop;
    if (choice.cells == VisCells::kLeaves) {
        out.cells_are = "leaves";
        return success();
    }
    if (choice.cells == VisCells::kGroups) {
        mergeOpen(map.tree, out);
        return success();
    }
    const std::string prt = portalFileOf(choice);
    const bool by_clusters = map.format == QuakeFormat::kQuake2 || map.format == QuakeFormat::kQuake3;
    if (!prt.empty() && !by_clusters) return mergeByPortalFile(prt, out);
    if (by_clusters && map.clusters > 0) mergeByFileClusters(out);
    else if (hasSharedRows(map)) mergeByRows(out);
    else mergeOpen(map.tree, out);
    return success();
}

Result<VisMap> loadPortalFile(const VisMapChoice& choice) {
    VisMap out;
    PrtNotes notes;
    Result<CellGraph> graph = readPrt(choice.name, &notes);
    if (!graph) return graph.error();
    if (!notes.flat_lines.empty())
        note(fmt::format("{}: line {}: a portal without an area, of {} in all: they are left out", choice.name,
                         notes.flat_lines[0], notes.flat_lines.size()));
    out.graph = std::move(*graph);
    out.cells_are = "clusters of the file";
    const std::string bsp = !choice.bsp.empty() ? choice.bsp : choice.needs_bsp ? beside(choice.name, ".bsp") : "";
    if (choice.needs_bsp && bsp.empty())
        return Error{Error::Kind::kUsage, choice.name +
                                              ": no .bsp lies beside it to write rows into: name one with --bsp, or an "
                                              "output that does not end in .bsp"};
    if (bsp.empty()) return out;
    if (Status read = readMap(bsp, out); !read) return read.error();
    const bool by_clusters = out.map->format == QuakeFormat::kQuake2 || out.map->format == QuakeFormat::kQuake3;
    if (!by_clusters && out.graph.cell_of_leaf.size() != out.map->clusters + size_t(1))
        return Error{Error::Kind::kInput, fmt::format("{}: has {} leaves, and {} has {}", choice.name,
                                                      out.graph.cell_of_leaf.size() - 1, bsp, out.map->clusters)};
    return out;
}

/// `_farplanedist` of the worldspawn, as q3map2 takes it; 0: none that is a distance.
double farPlaneOf(const QuakeMap& map) {
    if (map.entities.empty()) return 0;
    const std::string_view value = map.valueOf(map.entities[0], "_farplanedist");
    double distance = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), distance);
    return error == std::errc() && std::isfinite(distance) && distance > 0 ? distance : 0;
}

/// The source of a map, by our own tree of its brushes.
Result<VisMap> loadSource(const VisMapChoice& choice) {
    Result<std::string> text = readTextFile(choice.name);
    if (!text) return text.error();
    const Result<QuakeMap> source =
        parseQuakeMap({reinterpret_cast<const unsigned char*>(text->data()), text->size()}, choice.name);
    if (!source) return source.error();
    if (source->brushes.empty())
        return Error{Error::Kind::kInput,
                     choice.name + ": has no brushes: there is nothing that could hide or be seen"};
    VisMap out;
    out.content_hash = contentHash(*text);
    out.farthest = farPlaneOf(*source);
    MapMaterials materials;
    const Result<BrushRules> rules = brushRulesOf(choice.rules, materials);
    if (!rules) return rules.error();
    for (const std::string& pattern : rules->solid)
        if (std::none_of(source->textures.begin(), source->textures.end(), [&](const std::string& name) {
                return matches(nameOfTexture(name), patternOfTextures(pattern));
            }))
            return usageError(
                fmt::format("--solid {}: {} has no texture of such a name", oneLine(pattern, 80), choice.name));
    BrushTree brushes = treeOfBrushes(*source, {.rules = *rules});
    noteUnknown(choice.name, brushes.roles);
    MapCells cells = cellsInside(*source, brushes);
    out.graph = std::move(cells.graph);
    out.leaks = std::move(cells.leaks);
    if (choice.keep_leaves) out.leaf_graph = out.graph;
    out.tolerance = brushes.tolerance;
    out.tree = std::move(brushes.tree);
    out.cells_are = "of the brushes";
    out.roles = std::move(brushes.roles);
    out.source = std::move(*text);
    return out;
}

}  // namespace

std::string mapKind(const std::string& name) { return lower(fs::path(splitMapName(name).file).extension().string()); }

Result<VisMap> loadVisMap(const VisMapChoice& choice) {
    const std::string kind = mapKind(choice.name);
    const bool is_prt = kind == ".prt", is_source = kind == ".map";
    if (is_prt && choice.cells != VisCells::kClusters)
        return usageError("--cells needs a .bsp: a .prt has no cells but its own");
    if (is_prt && !choice.prt.empty()) return usageError("--prt goes with a .bsp");
    if (is_prt && choice.water_is_opaque)
        return usageError("--opaque-water needs a .bsp: the portals of a .prt say what is seen through");
    if (is_source && choice.cells != VisCells::kClusters)
        return usageError("--cells needs a .bsp: a .map has the cells of its brushes");
    if (is_source && !choice.prt.empty()) return usageError("--prt goes with a .bsp");
    if (is_source && choice.water_is_opaque) return usageError("--opaque-water needs a .bsp");
    if (is_source && choice.needs_bsp)
        return usageError(
            "a .map has no lump to write: name an output that does not end in .bsp, or give the compiled map");
    if (!is_source && choice.rules.given()) return usageError("--game, --shaders and --solid go with a .map");
    if (!is_prt && !choice.bsp.empty()) return usageError("--bsp goes with a .prt");
    if (isProcedural(choice.name))
        return usageError(choice.name + ": vis takes maps; for the cells of a scene that is made: sightline bake");
    VisMap out;
    if (is_prt || is_source) {
        Result<VisMap> map = is_prt ? loadPortalFile(choice) : loadSource(choice);
        if (!map) return map;
        out = std::move(*map);
        if (is_prt) {
            const Result<std::string> text = readTextFile(choice.name);
            if (!text) return text.error();
            out.content_hash = contentHash(*text);
        }
    } else {
        if (Status read = readMap(choice.name, out); !read) return read.error();
        if (Status found = findCells(choice, out); !found) return found.error();
    }
    if (out.map)
        if (const Result<QuakeMap> entities = quakeEntities(*out.map, out.map_name))
            out.farthest = farPlaneOf(*entities);
    for (const uint32_t cell : out.graph.cell_of_leaf) out.leaves += cell != CellGraph::kNoCell;
    return out;
}

std::string portalFileOf(const VisMapChoice& choice) {
    if (!choice.prt.empty()) return choice.prt;
    const bool is_map = mapKind(choice.name) == ".bsp" && choice.cells == VisCells::kClusters;
    return is_map ? beside(splitMapName(choice.name).file, ".prt") : "";
}

CellBoxes facesOf(const VisMap& map) {
    const QuakeMapFile& file = *map.map;
    std::vector<std::vector<uint32_t>> cells(file.faces.size());
    for (size_t leaf = 0; leaf < map.graph.cell_of_leaf.size() && leaf < file.faces_of_leaf.size(); ++leaf) {
        const uint32_t cell = map.graph.cell_of_leaf[leaf];
        if (cell == CellGraph::kNoCell) continue;
        const QuakeLeafFaces& run = file.faces_of_leaf[leaf];
        for (uint32_t i = run.first; i < run.first + run.count; ++i) cells[file.leaf_faces[i]].push_back(cell);
    }
    CellBoxes boxes;
    for (size_t face = 0; face < file.faces.size(); ++face) {
        std::sort(cells[face].begin(), cells[face].end());
        cells[face].erase(std::unique(cells[face].begin(), cells[face].end()), cells[face].end());
        Box3d box;
        const QuakeFace& points = file.faces[face];
        for (uint32_t k = 0; k < points.point_count; ++k) box.grow(glm::dvec3(file.points[points.first_point + k]));
        // Faces of things that move are in no leaf, and drawn with the things.
        if (!cells[face].empty()) boxes.add(box, cells[face]);
    }
    return boxes;
}

uint64_t leafPairs(const VisMap& map, const BitMatrix& cells) {
    std::vector<uint64_t> leaves(cells.rows(), 0);
    for (const uint32_t cell : map.graph.cell_of_leaf)
        if (cell != CellGraph::kNoCell) ++leaves[cell];
    uint64_t pairs = 0;
    for (size_t a = 0; a < cells.rows(); ++a) {
        uint64_t seen = 0;
        const std::span<const uint64_t> row = cells.row(a);
        for (size_t w = 0; w < row.size(); ++w)
            for (uint64_t left = row[w]; left; left &= left - 1)
                seen += leaves[w * 64 + static_cast<size_t>(std::countr_zero(left))];
        pairs += leaves[a] * seen;
    }
    return pairs;
}

}  // namespace sightline::cli
