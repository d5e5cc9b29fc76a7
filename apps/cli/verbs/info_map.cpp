// What `info` tells of maps: counts, and how convex the cells are.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/info_map.h"

#include <filesystem>
#include <fstream>
#include <string_view>

#include <fmt/core.h>

#include "apps/cli/verbs/common.h"
#include "sightline/tools/import/quake/map_source.h"
#include "sightline/tools/import/quake/prt.h"
#include "sightline/tools/import/quake/quake_scene.h"
#include "sightline/tools/import/quake/quake_visibility.h"
#include "sightline/tools/import/scene_kind.h"
#include "sightline/tools/report/readable.h"
#include "sightline/tools/scene/one_line.h"

namespace sightline::cli {
using namespace tools;
namespace {

using Json = nlohmann::ordered_json;

void row(std::string& text, const char* name, uint64_t count, const std::string& more = "") {
    text += fmt::format("  {:<20}{:>14}{}{}\n", name, grouped(count), more.empty() ? "" : "  ", more);
}

uint64_t countOf(const LeafTree& tree, LeafContents contents) {
    uint64_t out = 0;
    for (const LeafContents leaf : tree.contents) out += leaf == contents;
    return out;
}

}  // namespace

std::optional<MapReport> reportMap(const std::string& name) {
    const Result<SceneKind> kind = fileKind(name);
    if (!kind || !kind->format || (kind->suffix != "bsp" && kind->suffix != "pk3" && kind->suffix != "pak"))
        return std::nullopt;
    const Result<MapBytes> source = readMapBytes(name);
    if (!source) return std::nullopt;
    const Result<QuakeMapFile> map = parseQuakeBsp(source->bytes, source->name);
    if (!map) return std::nullopt;
    const Result<QuakeVisibility> seen = readQuakeVisibility(*map, source->name);
    const Result<QuakeMap> entities = quakeEntities(*map, source->name);

    MapReport out;
    const uint64_t clusters = map->clusters, pairs = seen.ok() ? seen->seen.count() : 0;
    const double mean = clusters > 0 ? double(pairs) / double(clusters) : 0;
    out.json = {{"name", source->name},
                {"format", quakeFormatName(map->format)},
                {"nodes", map->tree.nodes.size()},
                {"leafs", map->tree.contents.size()},
                {"solid_leafs", countOf(map->tree, LeafContents::kSolid)},
                {"liquid_leafs", countOf(map->tree, LeafContents::kLiquid)},
                {"clusters", clusters},
                {"faces", map->faces.size()},
                {"models", map->models.size()},
                {"entities", entities.ok() ? entities->entities.size() : 0},
                {"pvs_bytes", map->visibility.size()},
                {"clusters_without_pvs", seen.ok() ? seen->rows_missing : clusters},
                {"visible_pairs", pairs}};
    out.text = fmt::format("  map                 {}\n", quakeFormatName(map->format));
    row(out.text, "  nodes", map->tree.nodes.size());
    row(out.text, "  leaves", map->tree.contents.size(),
        fmt::format("{} solid, {} liquid", grouped(countOf(map->tree, LeafContents::kSolid)),
                    grouped(countOf(map->tree, LeafContents::kLiquid))));
    row(out.text, "  clusters", clusters);
    row(out.text, "  models", map->models.size());
    if (entities.ok()) row(out.text, "  entities", entities->entities.size());
    if (!seen.ok()) out.text += fmt::format("  visibility          {}\n", oneLine(seen.error().message));
    else if (seen->rows_missing == clusters) out.text += "  visibility          none\n";
    else
        row(out.text, "  visibility", map->visibility.size(),
            fmt::format("bytes; a cluster sees {:.1f} others in the mean, {:.1f} %", mean,
                        100 * mean / double(clusters)));
    return out;
}

bool isPortalFile(const std::string& name) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(name, ignored)) return false;  // a pipe would have us wait
    std::ifstream in(name, std::ios::binary);
    char letters[4] = {};
    in.read(letters, sizeof letters);
    const std::string_view word(letters, static_cast<size_t>(in.gcount()));
    return word == "PRT1" || word == "PRT2";
}

Result<MapReport> reportPortals(const std::string& name) {
    constexpr double kTolerance = 0.1;  // [world units]: what such files are written to
    PrtNotes notes;
    const Result<CellGraph> graph = readPrt(name, &notes);
    if (!graph) return graph.error();
    const CellFaults faults = checkCells(*graph, kTolerance);
    MapReport out;
    out.json = {{"schema", "sightline.info/1"},
                {"file", name},
                {"portal_file", Json{{"kind", notes.kind},
                                     {"leafs", notes.leaves},
                                     {"clusters", graph->cells},
                                     {"portals", graph->portals.size()},
                                     {"points", graph->points.size()},
                                     {"without_area", notes.flat_lines.size()},
                                     {"bent", faults.bent_portals},
                                     {"concave_portals", faults.concave_portals},
                                     {"concave_clusters", faults.concave_cells}}}};
    out.text =
        fmt::format("{}\n  format              {}, the portals of a Quake-family map\n", oneLine(name), notes.kind);
    row(out.text, "leaves", notes.leaves);
    row(out.text, "clusters", graph->cells);
    row(out.text, "portals", graph->portals.size(), fmt::format("{} points", grouped(graph->points.size())));
    row(out.text, "  without area", notes.flat_lines.size());
    row(out.text, "  bent", faults.bent_portals, fmt::format("at most {} units", readable(faults.worst_bend, 3)));
    row(out.text, "  concave", faults.concave_portals);
    row(out.text, "concave clusters", faults.concave_cells,
        fmt::format("at most {} units", readable(faults.worst_concavity, 3)));
    return out;
}

}  // namespace sightline::cli
