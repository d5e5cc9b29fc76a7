// The verb `vis`: which leaves of a Quake-family map see one another.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "apps/cli/shell/options.h"
#include "apps/cli/shell/apart.h"
#include "apps/cli/shell/progress.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/bake_run.h"
#include "apps/cli/verbs/bake_summary.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/verbs.h"
#include "apps/cli/verbs/vis_map.h"
#include "sightline/bake/brushes/brush_tree.h"
#include "sightline/bake/brushes/outside.h"
#include "sightline/bake/flow/flow_portals.h"
#include "sightline/base/jobs.h"
#include "sightline/tools/import/quake/map_source.h"
#include "sightline/tools/import/quake/quake_ambient.h"
#include "sightline/tools/import/quake/quake_visibility.h"
#include "sightline/tools/report/output_file.h"
#include "sightline/tools/report/page/vis_page.h"
#include "sightline/tools/report/readable.h"
#include "sightline/tools/report/run/vis_json.h"
#include "sightline/tools/scene/one_line.h"
#include "sightline/tools/truth/brush_rays.h"
#include "sightline/tools/truth/graph_rays.h"
#include "sightline/tools/truth/tree_rays.h"

namespace sightline::cli {
using namespace bake;
using namespace tools;
namespace {

using Clock = std::chrono::steady_clock;

struct VisOptions : BakeOptions {
    VisMapChoice map;
    std::string leak;                      ///< file, or empty
    std::vector<std::string> no_ambient;   ///< sounds; "all"
    std::optional<double> farthest_given;  ///< none: the map says it
    bool verify = false;
    uint64_t rays = 1000000, seed = 1;
};

// Rows of a map held against rays.

void addReport(const RowReport& report, VisSummary::Verification& out, const std::vector<uint32_t>& leaf_of_row) {
    out.segments += report.segments;
    out.false_negatives += report.misses;
    out.doubtful += report.doubtful;
    for (const RowMiss& miss : report.examples)
        out.examples.push_back({leaf_of_row[miss.row], leaf_of_row[miss.column], miss.from, miss.to});
}

/// None: the brushes are not written as the witness reads them, which is noted.
std::optional<VisSummary::Verification::Brushes> verifyByBrushes(const VisMap& map, const BitMatrix& visible,
                                                                 const AimedHoles& holes,
                                                                 const RowCheckSettings& settings,
                                                                 const std::vector<uint32_t>& leaf_of_cell) {
    std::vector<uint8_t> stops;
    for (const BrushRole role : map.roles.roles) stops.push_back(role <= BrushRole::kSky);
    const Result<BrushRays> rays =
        BrushRays::read(map.source, stops, BrushTreeSettings().snap_distance + map.tolerance);
    if (!rays) {
        note("the brushes are not judged: " + rays.error().message);
        return std::nullopt;
    }
    const BrushReport report = checkBrushRows(*rays, *map.tree, visible, map.graph.cell_of_leaf, holes, settings);
    VisSummary::Verification::Brushes out;
    out.segments = report.rows.segments;
    out.false_negatives = report.rows.misses;
    out.solid_leaves = report.solid.size();
    for (const RowMiss& miss : report.rows.examples)
        out.examples.push_back({leaf_of_cell[miss.row], leaf_of_cell[miss.column], miss.from, miss.to});
    for (size_t i = 0; i < std::min(report.solid.size(), settings.most_examples); ++i)
        out.examples.push_back({report.solid[i].row, report.solid[i].row, report.solid[i].from, report.solid[i].to});
    return out;
}

/// Rays pass a portal only within its outline by twice what its points are known by, of its own coordinates: narrower ones
/// are no openings, but what cells that touch in an edge share by the tolerance of the tree.
/// Half of the rays go through the map's own tree, if it has one: then the rows hold for the map, and not only for its
/// portals. The others go through the portals. Of a source as many as through the tree go through its brushes.
VisSummary::Verification verifyVis(const VisMap& map, const BitMatrix& visible, const VisOptions& options, Jobs& jobs) {
    const CellGraph& graph = map.graph;
    Progress progress("verifying by rays", "", 0);
    VisSummary::Verification out;
    std::vector<uint32_t> leaf_of_cell(graph.cells, 0);
    for (size_t leaf = graph.cell_of_leaf.size(); leaf-- > 0;)
        if (graph.cell_of_leaf[leaf] != CellGraph::kNoCell)
            leaf_of_cell[graph.cell_of_leaf[leaf]] = static_cast<uint32_t>(leaf);
    RowCheckSettings settings;
    settings.jobs = &jobs;
    settings.segments = map.tree ? std::max<uint64_t>(1, options.rays / 2) : options.rays;
    settings.farthest = options.farthest;
    settings.seed = options.seed;
    // Twice what rows promise: how well the points of each portal are known (FlowPortals).
    double largest = 1;
    for (const glm::dvec3& point : graph.points) largest = std::max(largest, largestCoordinate(point));
    const PortalMargin margin{2 * kGraphPrecision * largest, 2 * kPortalPrecision, 0x1p-45 * largest};
    const GraphRays through_portals(graph, margin);
    addReport(checkCellRows(through_portals, visible, settings), out, leaf_of_cell);
    if (map.tree) {
        AimedHoles holes;
        for (const CellPortal& portal : graph.portals) holes.add(graph.outline(portal));
        TreeRaySettings through;
        through.contents_stop = map.contents_stop;
        addReport(checkLeafRows(TreeRays(*map.tree, through), visible, graph.cell_of_leaf, holes, settings), out,
                  leaf_of_cell);
        if (!map.source.empty()) out.brushes = verifyByBrushes(map, visible, holes, settings, leaf_of_cell);
    }
    return out;
}

std::string endOf(const std::string& name) { return lower(std::filesystem::path(name).extension().string()); }

/// `-o` names a map (.bsp), and not a visibility file.
bool writesMap(const VisOptions& options) { return endOf(options.output) == ".bsp"; }

/// `-o` names a visibility file.
bool writesRows(const VisOptions& options) { return !options.output.empty() && !writesMap(options); }

/// The map that a name without an end stands for, as compilers take it.
std::string mapFileOf(const std::string& name) {
    std::error_code none;
    if (std::filesystem::path(name).has_extension() || std::filesystem::exists(name, none)) return name;
    return std::filesystem::exists(name + ".bsp", none) ? name + ".bsp" : name;
}

Status checkVisFiles(VisOptions& options) {
    if (options.in_place && writesMap(options))
        return Error{Error::Kind::kUsage, "--in-place goes with -o of a visibility file"};
    if (options.farthest_given.value_or(0) > 0 && writesRows(options))
        return Error{Error::Kind::kUsage, "--farthest goes with -o of a .bsp: a visibility file holds at any distance"};
    for (const char* end : {".map", ".prt", ".pak", ".pk3"})
        for (const std::string& name : {options.output, options.json, options.state, options.leak})
            if (endOf(name) == end)
                return Error{Error::Kind::kUsage,
                             name + ": an output of vis does not end in " + end + ", as its inputs do"};
    if (!options.leak.empty() && mapKind(options.map.name) != ".map")
        return Error{Error::Kind::kUsage, "--leak goes with a .map"};
    ApartFiles files;
    for (const auto& [option, name] : {std::pair("MAP", options.map.name), std::pair("--bsp", options.map.bsp)})
        if (!(writesMap(options) && sameFile(options.output, name))) files.read(option, name);
    files.read("--prt", portalFileOf(options.map));
    for (const std::string& path : options.map.rules.shaders) files.read("--shaders", path);
    files.write("--leak", options.leak);
    if (Status good = finishBakeOptions(options, files); !good) return good.error();
    return canWriteFiles({options.leak});
}

/// Rows of leaves, as a lump has them: leaf i + 1 of the map is row i.
BitMatrix leafRows(const VisMap& map, const BitMatrix& cells) {
    if (map.map) return clusterRows(*map.map, cells, map.graph.cell_of_leaf);
    const auto& cell_of_leaf = map.graph.cell_of_leaf;
    const size_t leaves = cell_of_leaf.empty() ? 0 : cell_of_leaf.size() - 1;
    BitMatrix rows(leaves, leaves);
    for (size_t a = 0; a < leaves; ++a)
        for (size_t b = 0; b < leaves; ++b) {
            const uint32_t from = cell_of_leaf[a + 1], to = cell_of_leaf[b + 1];
            if (from != CellGraph::kNoCell && to != CellGraph::kNoCell && cells.at(from, to)) rows.set(a, b);
        }
    return rows;
}

/// The lump that a map came with, beside the rows that would take its place.
std::optional<VisSummary::Before> compareWithLump(const VisMap& map, const BitMatrix& cells) {
    if (!map.map || map.map->visibility.empty()) return std::nullopt;
    const Result<QuakeVisibility> lump = readQuakeVisibility(*map.map, map.map_name);
    if (!lump) return std::nullopt;  // it is not what is asked about
    const BitMatrix rows = leafRows(map, cells);
    VisSummary::Before before;
    for (size_t row = 0; row < rows.rows(); ++row)
        for (size_t word = 0; word < rows.wordsPerRow(); ++word) {
            const uint64_t was = lump->seen.row(row)[word], is = rows.row(row)[word];
            before.visible_pairs += static_cast<uint64_t>(std::popcount(was));
            before.removed += static_cast<uint64_t>(std::popcount(was & ~is));
            before.added += static_cast<uint64_t>(std::popcount(is & ~was));
        }
    return before;
}

/// What is written, and its sizes.
struct VisOutputs {
    BakedFile rows;
    std::vector<unsigned char> map;  ///< with its new lump; empty: not asked for
    uint64_t lump_bytes = 0, leaves_with_sounds = 0;
};

AmbientSounds soundsOf(const VisOptions& options) {
    const auto sounds = [&](const char* name) {
        return std::none_of(options.no_ambient.begin(), options.no_ambient.end(),
                            [&](const std::string& silent) { return silent == name || silent == "all"; });
    };
    return {sounds("water"), sounds("sky"), sounds("slime"), sounds("lava")};
}

Result<VisOutputs> makeOutputs(const VisOptions& options, const VisMap& map, const CellVisibility& visibility) {
    VisOutputs out;
    const bool write_map = writesMap(options), figures = !options.json.empty();
    const std::string name = std::filesystem::path(splitMapName(options.map.name).file).filename().string();
    if (figures || writesRows(options)) {
        const VisibilityContent content{visibility.visible, map.graph.cell_of_leaf, name, map.content_hash};
        Result<BakedFile> rows = bakedFile(content, true);
        if (!rows) return rows.error();
        out.rows = std::move(*rows);
    }
    if (figures || write_map) {
        const BitMatrix rows = leafRows(map, visibility.visible);
        const QuakeFormat format = map.map ? map.map->format : QuakeFormat::kQuake;
        out.lump_bytes = packQuakeVisibility(format, rows).bytes.size();
        if (write_map) {
            Result<std::vector<unsigned char>> bytes = replaceQuakeVisibility(map.map_bytes, map.map_name, rows);
            if (!bytes) return bytes.error();
            out.map = std::move(*bytes);
            const Result<uint64_t> heard = writeAmbientLevels(out.map, map.map_name, rows, soundsOf(options));
            if (!heard) return heard.error();
            out.leaves_with_sounds = *heard;
        }
    }
    return out;
}

Status writeOutput(const std::string& file, const VisOutputs& outputs, VisibilityForm form) {
    if (file.empty()) return success();
    if (!outputs.map.empty())
        return writeFileAside(file, {reinterpret_cast<const char*>(outputs.map.data()), outputs.map.size()});
    const std::span<const char> bytes = outputs.rows.bytes(form);
    return writeFileAside(file, {bytes.data(), bytes.size()});
}

/// None: interrupted.
std::optional<VisSummary::Objects> bakeFaces(const VisMap& map, const CellVisibility& visibility,
                                             const BakeSettings& settings) {
    const std::clock_t begin = std::clock();
    const BoxVisibility faces = bakeObjectRows(map.graph, visibility, facesOf(map), settings);
    if (faces.stopped) return std::nullopt;
    VisSummary::Objects figures = objectFigures(faces);
    figures.cpu_seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    return figures;
}

/// All figures but the times.
VisSummary summaryOf(const VisMap& map, const CellVisibility& visibility, const VisOutputs& outputs) {
    VisSummary summary = rowFigures(map.graph, visibility);
    summary.cells_are = map.cells_are;
    summary.leafs = map.leaves;
    summary.visible_leaf_pairs = leafPairs(map, visibility.visible);
    summary.witnessed_pairs = leafPairs(map, visibility.witnessed);
    summary.unresolved_pairs = summary.visible_leaf_pairs - summary.witnessed_pairs;
    summary.pvs_bytes = outputs.rows.packed.size();
    summary.resident_bytes = outputs.rows.resident_bytes;
    summary.lump_bytes = outputs.lump_bytes;
    for (const MapLeak& leak : map.leaks) summary.leaks.push_back({leak.what, leak.path});
    summary.unknown_brushes = map.roles.unknown;
    summary.unknown_textures = map.roles.unknown_textures;
    return summary;
}

Result<VisMap> loadCheckedMap(VisOptions& options) {
    options.map.cells = visCellsOf(options.cells);
    options.map.needs_bsp = writesMap(options);
    if (Status good = checkVisFiles(options); !good) return good.error();
    Result<VisMap> map = loadVisMap(options.map);
    if (!map) return map;
    if (Status fits = checkSize(map->graph, options.map.name, map->map.has_value()); !fits) return fits.error();
    if (options.objects && !map->map) return Error{Error::Kind::kUsage, "--objects needs a .bsp: it has the faces"};
    if (!options.leak.empty() && !map->leaks.empty())
        if (Status written = writeFileAside(options.leak, pointFile(map->leaks[0])); !written) return written.error();
    return map;
}

/// What was asked for, or what the map says.
void chooseFarthest(VisOptions& options, double of_map) {
    options.farthest = options.farthest_given.value_or(writesRows(options) ? 0 : of_map);
    if (options.farthest_given || of_map == 0) return;
    note(writesRows(options) ? "the map's _farplanedist has no effect: a visibility file holds at any distance"
                             : fmt::format("sight ends at {} units, by the map's _farplanedist (--farthest 0: nowhere)",
                                           readable(of_map, 6)));
}

Result<int> runVis(VisOptions& options) {
    const Clock::time_point begin = Clock::now();
    options.map.name = mapFileOf(options.map.name);
    std::optional<Progress> reading(std::in_place, "reading " + oneLine(options.map.name), "", 0);
    const Result<VisMap> map = loadCheckedMap(options);
    reading.reset();
    if (!map) return map.error();
    chooseFarthest(options, map->farthest);
    BakeRun run(options);
    const Result<BakeSettings> settings = run.begin(map->graph);
    if (!settings) return settings.error();
    const Result<CellVisibility> visibility = bakeRows(map->graph, *settings);
    if (!visibility) return visibility.error();
    if (visibility->stopped && interrupted()) return run.reportInterrupted();

    std::optional<Progress> writing(std::in_place, "packing rows", "", 0);
    const Result<VisOutputs> outputs = makeOutputs(options, *map, *visibility);
    if (!outputs) return outputs.error();
    if (Status written = writeOutput(options.output, *outputs, settings->form); !written) return written.error();
    run.end();

    VisSummary summary = summaryOf(*map, *visibility, *outputs);
    summary.before = compareWithLump(*map, visibility->visible);
    writing.reset();
    summary.map = options.map.name;
    summary.farthest = options.farthest;
    summary.threads = run.threads();
    summary.cpu_seconds = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    summary.wall_seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    if (options.objects) summary.objects = bakeFaces(*map, *visibility, *settings);
    if (options.objects && !summary.objects) return reportInterruption("the cells, in the midst of the objects", true);
    if (options.verify) summary.verification = verifyVis(*map, visibility->visible, options, run.jobs());

    if (!options.report.empty())
        if (Status written =
                writeVisPage(map->graph, visibility->visible, visibility->witnessed, summary, options.report);
            !written)
            return written.error();
    printVisSummary(options.json == "-" ? stderr : stdout, summary);
    if (outputs->leaves_with_sounds > 0)
        tell(options.json == "-" ? stderr : stdout,
             fmt::format("ambient sounds are heard in {} leaves\n", grouped(outputs->leaves_with_sounds)));
    if (!options.report.empty()) tellPage(options.json == "-" ? stderr : stdout, options.report);
    if (!options.leak.empty() && !summary.leaks.empty())
        tell(options.json == "-" ? stderr : stdout, fmt::format("leak         {}\n", options.leak));
    if (options.output.empty() && options.json.empty() && options.report.empty() && options.leak.empty())
        note("nothing was written: -o writes the map with its lump, or a visibility file");
    if (!options.json.empty())
        if (Status written = writeText(options.json, visJson(summary)); !written) return written.error();
    const auto& verified = summary.verification;
    const bool wrong =
        verified && (verified->false_negatives > 0 || (verified->brushes && verified->brushes->wrong() > 0));
    return wrong ? kAnswerIsNo : kDone;
}

}  // namespace

void addVis(Command& tool, int& exit_code) {
    Command verb = tool.add_subcommand("vis", "which leaves of a Quake-family map see one another");
    const auto options = std::make_shared<VisOptions>();
    verb->add_option("MAP", options->map.name,
                     "a .prt, a .bsp (which may be left out), a .bsp in a .pak or .pk3 (x.pk3:maps/y.bsp), or a .map")
        ->required()
        ->type_name("FILE");
    addBakeOptions(
        *verb, *options,
        "write the .bsp with its visibility lump, which may be MAP itself; or, if the name ends otherwise, a "
        "visibility file");
    verb->add_option("--bsp", options->map.bsp,
                     "the .bsp that a .prt belongs to (default: beside it, of the same name)")
        ->type_name("FILE");
    verb->add_option("--prt", options->map.prt,
                     "take the clusters of a .bsp from this portal file (default: beside it, of the same name)")
        ->type_name("FILE");
    addMapRules(*verb, options->map.rules);
    verb->add_option("--farthest", options->farthest_given,
                     "sight ends so far from the eye, as at a far plane or in fog; 0: nowhere (default: _farplanedist "
                     "of the map's worldspawn, or nowhere)")
        ->check(Range{0.0, 1e9})
        ->type_name("UNITS");
    verb->add_flag("--opaque-water", options->map.water_is_opaque,
                   "nothing is seen from one kind of contents into another");
    verb->add_option("--leak", options->leak, "write the way by which a .map leaks, as engines draw it (.pts)")
        ->type_name("FILE");
    verb->add_option("--no-ambient", options->no_ambient,
                     "of a Quake map that is written: these ambient sounds are heard nowhere, separated by commas")
        ->delimiter(',')
        ->check(OneOf{"all", "water", "sky", "slime", "lava"})
        ->type_name("LIST");
    verb->add_flag(
        "--verify", options->verify,
        "hold the rows against rays through the map, through its portals, and through the brushes of a .map");
    verb->add_option("--rays", options->rays, "of --verify")
        ->check(Range{uint64_t{1}, uint64_t{1} << 40})
        ->capture_default_str();
    verb->add_option("--seed", options->seed, "of --rays: other seeds are other rays")->capture_default_str();
    verb->callback([options, &exit_code] {
        const Result<int> done = runVis(*options);
        exit_code = done ? *done : report(done.error());
    });
}

}  // namespace sightline::cli
