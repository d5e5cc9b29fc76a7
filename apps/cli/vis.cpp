// The verb `vis`: which leaves of a Quake-family map see one another.
// SPDX-License-Identifier: MIT
#include <cctype>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/cli/apart.h"
#include "apps/cli/common.h"
#include "apps/cli/progress.h"
#include "apps/cli/session.h"
#include "apps/cli/verbs.h"
#include "apps/cli/vis_bake.h"
#include "apps/cli/vis_map.h"
#include "apps/cli/vis_verify.h"
#include "sightline/bake/box_visibility.h"
#include "sightline/bake/outside.h"
#include "sightline/base/thread_pool.h"
#include "sightline/import/map_source.h"
#include "sightline/import/quake_visibility.h"
#include "sightline/report/output_file.h"
#include "sightline/report/vis_json.h"
#include "sightline/report/vis_page.h"
#include "sightline/visfile/visibility_file.h"

namespace sightline::cli {
namespace {

using Clock = std::chrono::steady_clock;

struct VisOptions {
    VisMapChoice map;
    std::string output;  ///< .bsp: the map with its lump; else a visibility file; empty: nothing is written
    std::string json;
    std::string report;  ///< directory, or empty
    std::string cells = "clusters";
    uint32_t threads = 0;  ///< 0: all cores
    VisBakeOptions bake;
    bool in_place = false;
    bool objects = false;
    std::string leak;  ///< file, or empty
    bool verify = false;
    uint64_t rays = 1000000;
};

std::string endOf(const std::string& name) {
    std::string end = std::filesystem::path(name).extension().string();
    for (char& c : end) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return end;
}

bool isBsp(const std::string& name) { return endOf(name) == ".bsp"; }

Status checkFiles(const VisOptions& options) {
    ApartFiles files;
    files.read("MAP", splitMapName(options.map.name).file);
    files.read("--bsp", options.map.bsp);
    files.read("--prt", portalFileOf(options.map));
    files.write("-o", options.output);
    files.write("--json", options.json);
    files.write("--state", options.bake.state);
    files.write("--leak", options.leak);
    if (!options.report.empty()) files.write("--report", std::filesystem::path(options.report) / "index.html");
    if (!files.status()) return files.status();
    for (const char* end : {".map", ".prt", ".pak", ".pk3"})
        for (const std::string& name : {options.output, options.json, options.bake.state, options.leak})
            if (endOf(name) == end)
                return Error{Error::Kind::kUsage,
                             name + ": an output of vis does not end in " + end + ", as its inputs do"};
    if (!options.leak.empty() && endOf(splitMapName(options.map.name).file) != ".map")
        return Error{Error::Kind::kUsage, "--leak goes with a .map"};
    for (const std::string& name : {options.output, options.bake.state, options.leak})
        if (!name.empty())
            if (Status writable = canWriteFile(name); !writable) return writable;
    if (!options.json.empty() && options.json != "-")
        if (Status writable = canWriteFile(options.json); !writable) return writable;
    return options.report.empty() ? success() : makeDirectory(options.report);
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

/// What is written, and its sizes.
struct VisOutputs {
    Array<char> packed, in_place;
    std::vector<unsigned char> map;  ///< with its new lump; empty: not asked for
    uint64_t lump_bytes = 0, resident_bytes = 0;
};

Result<VisOutputs> makeOutputs(const VisOptions& options, const VisMap& map, const CellVisibility& visibility) {
    VisOutputs out;
    const bool write_map = !options.output.empty() && isBsp(options.output);
    const bool write_rows = !options.output.empty() && !write_map;
    const std::string name = std::filesystem::path(splitMapName(options.map.name).file).filename().string();
    const VisibilityContent content{visibility.visible, map.graph.cell_of_leaf, name, map.content_hash};
    if (write_rows || !options.json.empty()) {
        Result<Array<char>> in_place = visibilityFile(content, VisibilityForm::kInPlace);
        if (!in_place) return in_place.error();
        out.in_place = std::move(*in_place);
        const Result<VisibilityFile> file = VisibilityFile::open(out.in_place, name);
        if (!file) return file.error();
        out.resident_bytes = file->residentBytes();
        out.packed = packedFile(*file);
    }
    if (write_map || !options.json.empty()) {
        const BitMatrix rows = leafRows(map, visibility.visible);
        const QuakeFormat format = map.map ? map.map->format : QuakeFormat::kQuake;
        out.lump_bytes = packQuakeVisibility(format, rows).bytes.size();
        if (write_map) {
            Result<std::vector<unsigned char>> bytes = replaceQuakeVisibility(map.map_bytes, map.map_name, rows);
            if (!bytes) return bytes.error();
            out.map = std::move(*bytes);
        }
    }
    return out;
}

Status writeOutput(const VisOptions& options, const VisOutputs& outputs) {
    if (options.output.empty()) return success();
    if (!outputs.map.empty())
        return writeFileAside(options.output, {reinterpret_cast<const char*>(outputs.map.data()), outputs.map.size()});
    const Array<char>& bytes = options.in_place ? outputs.in_place : outputs.packed;
    return writeFileAside(options.output, {bytes.data(), bytes.size()});
}

/// None: interrupted.
std::optional<VisSummary::Objects> bakeObjects(const VisMap& map, const CellVisibility& visibility,
                                               const VisOptions& options, Jobs& jobs) {
    const std::clock_t begin = std::clock();
    const CellBoxes faces = facesOf(map);
    Progress progress("visibility, objects", "cells", map.graph.cells);
    CellVisibilitySettings settings;
    settings.jobs = &jobs;
    settings.budget = options.bake.budget;
    settings.stop = [] { return interrupted(); };
    settings.progress = [&](const BakeProgress& now) {
        progress.set(static_cast<size_t>(now.done * static_cast<double>(map.graph.cells)), map.graph.cells);
    };
    const BoxVisibility boxes = bakeBoxVisibility(map.graph, visibility, faces, settings);
    if (boxes.stopped) return std::nullopt;
    return VisSummary::Objects{faces.boxes.size(), boxes.visible.count(), boxes.by_cells,
                               static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC};
}

std::string share(uint64_t part, uint64_t whole) {
    return fmt::format("{:.2f} %", whole ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0);
}

void printSummary(std::FILE* out, const VisSummary& s) {
    tell(out, fmt::format("{}: {} leaves in {} cells ({}), {} portals\n", s.map, grouped(s.leafs), grouped(s.clusters),
                          s.cells_are, grouped(s.portals)));
    const double mean = s.leafs ? static_cast<double>(s.visible_leaf_pairs) / static_cast<double>(s.leafs) : 0;
    tell(out, fmt::format("visible pairs of leaves {} (a leaf sees {:.1f} of them, {})\n",
                          grouped(s.visible_leaf_pairs), mean, share(s.visible_leaf_pairs, s.leafs * s.leafs)));
    tell(out, fmt::format("  witnessed by rays     {}\n  unresolved            {} ({} of the visible)\n",
                          grouped(s.witnessed_pairs), grouped(s.unresolved_pairs),
                          share(s.unresolved_pairs, s.visible_leaf_pairs)));
    if (s.over_budget)
        tell(out,
             fmt::format("  portals over budget   {}: what they may see counts as visible\n", grouped(s.over_budget)));
    if (s.stopped) tell(out, "  stopped by the time limit: what was not settled counts as visible\n");
    for (const VisSummary::Leak& leak : s.leaks)
        tell(out,
             fmt::format("leaks: from {} at {:g} {:g} {:g} there is a way of {} points to the outside, which stays in "
                         "the rows (--leak "
                         "writes it)\n",
                         leak.from, leak.path.front().x + 0.0, 0.0 - leak.path.front().z, leak.path.front().y + 0.0,
                         leak.path.size()));
    if (s.objects)
        tell(out, fmt::format("faces: {} pairs of cells and faces, {} of those in visible cells, in {:.2f} s of CPU\n",
                              grouped(s.objects->visible_pairs),
                              share(s.objects->visible_pairs, s.objects->pairs_by_cells), s.objects->cpu_seconds));
    if (s.pvs_bytes)
        tell(out, fmt::format("bytes: {} packed, {} resident; run-length lump {}\n", grouped(s.pvs_bytes),
                              grouped(s.resident_bytes), grouped(s.lump_bytes)));
    tell(out, fmt::format("{:.2f} s of CPU, {:.2f} s\n", s.cpu_seconds, s.wall_seconds));
    if (s.verification)
        tell(out, fmt::format("verified: {} segments, {} false negatives\n", grouped(s.verification->segments),
                              grouped(s.verification->false_negatives)));
}

/// All figures but the times.
VisSummary summaryOf(const VisMap& map, const CellVisibility& visibility, const VisOutputs& outputs) {
    VisSummary summary;
    summary.cells_are = map.cells_are;
    summary.leafs = map.leaves;
    summary.clusters = map.graph.cells;
    summary.portals = map.graph.portals.size();
    summary.visible_leaf_pairs = leafPairs(map, visibility.visible);
    summary.witnessed_pairs = leafPairs(map, visibility.witnessed);
    summary.unresolved_pairs = summary.visible_leaf_pairs - summary.witnessed_pairs;
    summary.visible_cluster_pairs = visibility.visible.count();
    summary.witnessed_cluster_pairs = visibility.witnessed.count();
    summary.pvs_bytes = outputs.packed.size();
    summary.resident_bytes = outputs.resident_bytes;
    summary.lump_bytes = outputs.lump_bytes;
    summary.steps = visibility.steps;
    summary.over_budget = visibility.over_budget;
    summary.stopped = visibility.stopped;
    for (const MapLeak& leak : map.leaks) summary.leaks.push_back({leak.what, leak.path});
    return summary;
}

Result<int> runVis(VisOptions& options) {
    const Clock::time_point begin = Clock::now();
    if (options.cells == "leaves") options.map.cells = VisCells::kLeaves;
    if (options.cells == "groups") options.map.cells = VisCells::kGroups;
    options.map.needs_bsp = isBsp(options.output);
    if (options.in_place && (options.output.empty() || isBsp(options.output)))
        return Error{Error::Kind::kUsage, "--in-place goes with -o of a visibility file"};
    if (Status good = checkFiles(options); !good) return good.error();
    const Result<VisMap> map = loadVisMap(options.map);
    if (!map) return map.error();
    if (map->graph.portals.size() > kMostBakedPortals)
        return Error{Error::Kind::kInput,
                     fmt::format("{}: {} portals, and at most {} can be baked at once{}", options.map.name,
                                 grouped(map->graph.portals.size()), grouped(kMostBakedPortals),
                                 map->map ? ": --cells groups makes fewer" : "")};
    if (options.objects && !map->map) return Error{Error::Kind::kUsage, "--objects needs a .bsp: it has the faces"};
    options.bake.keep_follows = options.objects;
    if (!options.leak.empty() && !map->leaks.empty())
        if (Status written = writeFileAside(options.leak, pointFile(map->leaks[0])); !written) return written.error();

    const uint32_t threads = options.threads ? options.threads : std::max(1u, std::thread::hardware_concurrency());
    ThreadPool pool(threads);
    if (options.bake.state.empty() && !options.output.empty()) options.bake.state = options.output + ".state";
    const Result<CellVisibility> visibility = bakeVis(map->graph, options.bake, pool);
    if (!visibility) return visibility.error();
    if (visibility->stopped && interrupted())
        return reportInterruption(options.bake.state.empty()
                                      ? "a part of the bake"
                                      : "a part of the bake, which goes on from " + options.bake.state,
                                  false);

    const Result<VisOutputs> outputs = makeOutputs(options, *map, *visibility);
    if (!outputs) return outputs.error();
    if (Status written = writeOutput(options, *outputs); !written) return written.error();
    removeBakeState(options.bake);

    VisSummary summary = summaryOf(*map, *visibility, *outputs);
    summary.map = options.map.name;
    summary.threads = threads;
    summary.cpu_seconds = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    summary.wall_seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    if (options.objects) summary.objects = bakeObjects(*map, *visibility, options, pool);
    if (options.objects && !summary.objects) return reportInterruption("the cells, in the midst of the objects", true);
    if (options.verify) summary.verification = verifyVis(*map, visibility->visible, options.rays, pool);

    if (!options.report.empty())
        if (Status written =
                writeVisPage(map->graph, visibility->visible, visibility->witnessed, summary, options.report);
            !written)
            return written.error();
    printSummary(options.json == "-" ? stderr : stdout, summary);
    if (!options.json.empty())
        if (Status written = writeText(options.json, visJson(summary)); !written) return written.error();
    return summary.verification && summary.verification->false_negatives > 0 ? kAnswerIsNo : kDone;
}

}  // namespace

void addVis(CLI::App& tool, int& exit_code) {
    CLI::App* verb = tool.add_subcommand("vis", "which leaves of a Quake-family map see one another");
    const auto options = std::make_shared<VisOptions>();
    verb->add_option("MAP", options->map.name, "a .prt, a .bsp, a .bsp in a .pak or .pk3 (x.pk3:maps/y.bsp), or a .map")
        ->required()
        ->type_name("FILE");
    verb->add_option("-o,--output", options->output,
                     "write the .bsp with its visibility lump, or, if the name ends otherwise, a visibility file")
        ->type_name("FILE");
    verb->add_option("--bsp", options->map.bsp,
                     "the .bsp that a .prt belongs to (default: beside it, of the same name)")
        ->type_name("FILE");
    verb->add_option("--prt", options->map.prt,
                     "take the clusters of a .bsp from this portal file (default: beside it, of the same name)")
        ->type_name("FILE");
    verb->add_option("--cells", options->cells,
                     "what has a row: clusters, as the map's compiler made them; leaves, each its own, which is "
                     "tighter and takes "
                     "far longer; groups, of leaves that are open to one another")
        ->check(CLI::IsMember({"clusters", "leaves", "groups"}))
        ->capture_default_str();
    verb->add_flag("--opaque-water", options->map.water_is_opaque,
                   "nothing is seen from one kind of contents into another");
    verb->add_option("--threads", options->threads, "share the portals among so many threads (default: one a core)")
        ->check(CLI::Range(1u, 1024u));
    verb->add_option("--budget", options->bake.budget,
                     "portals that may be clipped for each portal and direction; what is not settled by then is "
                     "visible, and counted "
                     "(default: no limit)")
        ->type_name("WORK");
    verb->add_option("--time-limit", options->bake.time_limit,
                     "stop after so many seconds; what is not settled by then is visible")
        ->check(CLI::PositiveNumber)
        ->type_name("S");
    verb->add_option("--state", options->bake.state,
                     "where a long bake writes down how far it is, to go on after its end (default: the output's name "
                     "and .state)")
        ->type_name("FILE");
    verb->add_option("--json", options->json, "write the figures as JSON (-: standard output)")->type_name("FILE");
    verb->add_option("--report", options->report, "write pictures and a page")->type_name("DIR");
    verb->add_flag("--in-place", options->in_place,
                   "of a visibility file the larger form, which answers without being unpacked");
    verb->add_flag("--objects", options->objects,
                   "tell also which faces each cell sees: takes longer than the cells do");
    verb->add_option("--leak", options->leak, "write the way by which a .map leaks, as engines draw it (.pts)")
        ->type_name("FILE");
    verb->add_flag("--verify", options->verify, "hold the rows against rays through the map, and through its portals");
    verb->add_option("--rays", options->rays, "of --verify")
        ->check(CLI::Range(uint64_t{1}, uint64_t{1} << 40))
        ->capture_default_str();
    verb->callback([options, &exit_code] {
        const Result<int> done = runVis(*options);
        exit_code = done ? *done : report(done.error());
    });
}

}  // namespace sightline::cli
