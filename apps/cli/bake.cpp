// The verb `bake`: the cells, portals and visible sets of a map or a scene with cells, as a visibility file.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/cli/apart.h"
#include "apps/cli/bake_source.h"
#include "apps/cli/bake_summary.h"
#include "apps/cli/common.h"
#include "apps/cli/progress.h"
#include "apps/cli/session.h"
#include "apps/cli/verbs.h"
#include "apps/cli/vis_bake.h"
#include "sightline/bake/box_visibility.h"
#include "sightline/base/thread_pool.h"
#include "sightline/import/map_source.h"
#include "sightline/report/output_file.h"
#include "sightline/report/vis_page.h"
#include "sightline/visfile/visibility_file.h"

namespace sightline::cli {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point then) { return std::chrono::duration<double>(Clock::now() - then).count(); }

struct BakeOptions {
    SceneChoice scene;
    std::string output, json, report;  ///< empty: not written
    std::string cells;                 ///< empty: not given
    uint32_t threads = 0;              ///< 0: all cores
    VisBakeOptions bake;
    bool in_place = false, objects = false;
};

Status checkFiles(const BakeOptions& options) {
    ApartFiles files;
    for (const std::string& name : options.scene.names) files.read("SCENE", splitMapName(name).file);
    files.write("-o", options.output);
    files.write("--json", options.json);
    files.write("--state", options.bake.state);
    if (!options.report.empty()) files.write("--report", std::filesystem::path(options.report) / "index.html");
    if (!files.status()) return files.status();
    if (options.in_place && options.output.empty())
        return Error{Error::Kind::kUsage, "--in-place goes with -o: it says how that is written"};
    for (const std::string& name : {options.output, options.bake.state})
        if (!name.empty())
            if (Status writable = canWriteFile(name); !writable) return writable;
    if (!options.json.empty() && options.json != "-")
        if (Status writable = canWriteFile(options.json); !writable) return writable;
    return options.report.empty() ? success() : makeDirectory(options.report);
}

ObjectCells placeObjects(BakeSource& source, Jobs& jobs) {
    Progress progress("cells of objects", "objects", source.scene.objects.size());
    source.placing.jobs = &jobs;
    source.placing.progress = [&](size_t done, size_t total) { progress.set(done, total); };
    return cellsOfObjects(source.scene, source.space, source.placing);
}

/// The objects as boxes in rows: what a row must not miss.
CellBoxes boxesOf(const BakeSource& source, const ObjectPlaces& objects) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const double margin = std::max(source.placing.margin, source.space.tolerance);
    CellBoxes boxes;
    std::vector<uint32_t> rows;
    for (size_t i = 0; i < objects.size(); ++i) {
        rows.clear();
        for (const uint32_t cell : objects.cellsOf(i)) rows.push_back(source.space.row_of_cell[cell]);
        std::sort(rows.begin(), rows.end());
        rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
        const bool everywhere = objects.everywhere[i] || (!rows.empty() && rows.back() == CellGraph::kNoCell);
        const Box3d all{glm::dvec3(-kInfinity), glm::dvec3(kInfinity)};
        const Box3d& box = objects.bounds[i];
        if (everywhere) boxes.add(all, {});
        else boxes.add({box.min - margin, box.max + margin}, rows);
    }
    return boxes;
}

BoxVisibility bakeObjects(const BakeSource& source, const CellVisibility& visibility, const ObjectPlaces& objects,
                          const BakeOptions& options, Jobs& jobs) {
    Progress progress("visibility, objects", "cells", source.rows.cells);
    CellVisibilitySettings settings;
    settings.jobs = &jobs;
    settings.budget = options.bake.budget;
    settings.stop = [] { return interrupted(); };
    settings.progress = [&](const BakeProgress& now) {
        progress.set(static_cast<size_t>(now.done * static_cast<double>(source.rows.cells)), source.rows.cells);
    };
    return bakeBoxVisibility(source.rows, visibility, boxesOf(source, objects), settings);
}

Status writePage(const BakeSource& source, const CellVisibility& visibility, const BakeSummary& summary,
                 const std::string& directory) {
    VisSummary page;
    page.map = summary.scene;
    page.cells_are = source.rows_are;
    page.leafs = page.clusters = visibility.visible.rows();
    page.portals = source.rows.portals.size();
    page.visible_leaf_pairs = page.visible_cluster_pairs = summary.visible_pairs;
    page.witnessed_pairs = page.witnessed_cluster_pairs = summary.witnessed_pairs;
    page.unresolved_pairs = summary.visible_pairs - summary.witnessed_pairs;
    page.pvs_bytes = summary.bytes;
    page.resident_bytes = summary.resident_bytes;
    page.steps = visibility.steps;
    page.over_budget = visibility.over_budget;
    page.stopped = visibility.stopped;
    page.wall_seconds = summary.seconds;
    page.threads = summary.threads;
    return writeVisPage(source.rows, visibility.visible, visibility.witnessed, page, directory);
}

int interruptedBake(const BakeOptions& options) {
    return reportInterruption(options.bake.state.empty()
                                  ? "a part of the bake"
                                  : "a part of the bake, which goes on from " + options.bake.state,
                              false);
}

Result<int> runBake(BakeOptions& options) {
    const Clock::time_point begin = Clock::now();
    if (options.bake.state.empty() && !options.output.empty()) options.bake.state = options.output + ".state";
    if (Status good = checkFiles(options); !good) return good.error();
    const VisCells cells = options.cells == "leaves"   ? VisCells::kLeaves
                           : options.cells == "groups" ? VisCells::kGroups
                                                       : VisCells::kClusters;
    Result<BakeSource> source = loadBakeSource(options.scene, cells, !options.cells.empty());
    if (!source) return source.error();
    if (source->rows.portals.size() > kMostBakedPortals)
        return Error{Error::Kind::kInput,
                     fmt::format("{}: {} portals, and at most {} can be baked at once{}", options.scene.title(),
                                 grouped(source->rows.portals.size()), grouped(kMostBakedPortals),
                                 source->row_of_leaf.empty() ? "" : ": --cells groups makes fewer")};
    BakeSummary summary;
    summary.cells_seconds = secondsSince(begin);
    summary.threads = options.threads ? options.threads : std::max(1u, std::thread::hardware_concurrency());
    ThreadPool pool(summary.threads);

    options.bake.keep_follows = options.objects;
    const Clock::time_point rows_begin = Clock::now();
    Result<CellVisibility> visibility = bakeVis(source->rows, options.bake, pool);
    if (!visibility) return visibility.error();
    if (visibility->stopped && interrupted()) return interruptedBake(options);
    const std::vector<uint32_t> open_rows = seeAllFromOutside(source->space, visibility->visible);
    summary.rows_seconds = secondsSince(rows_begin);

    const Clock::time_point objects_begin = Clock::now();
    const ObjectCells objects = placeObjects(*source, pool);
    std::optional<BoxVisibility> boxes;
    if (options.objects) boxes = bakeObjects(*source, *visibility, objects.places, options, pool);
    if (boxes)
        for (const uint32_t row : open_rows)
            for (size_t i = 0; i < boxes->visible.columns(); ++i) boxes->visible.set(row, i);
    if (interrupted()) return interruptedBake(options);
    summary.objects_seconds = secondsSince(objects_begin);

    VisibilityContent content{visibility->visible, source->row_of_leaf, source->name, source->hash, &source->space};
    content.objects = &objects.places;
    if (boxes) content.object_rows = &boxes->visible;
    const Result<Array<char>> in_place = visibilityFile(content, VisibilityForm::kInPlace);
    if (!in_place) return in_place.error();
    const Result<VisibilityFile> file = VisibilityFile::open(*in_place, options.scene.title());
    if (!file) return file.error();
    const Array<char> packed = options.in_place ? Array<char>() : packedFile(*file);
    const Array<char>& bytes = options.in_place ? *in_place : packed;
    if (!options.output.empty())
        if (Status written = writeFileAside(options.output, {bytes.data(), bytes.size()}); !written)
            return written.error();
    removeBakeState(options.bake);

    summary.scene = options.scene.title();
    summary.visible_pairs = visibility->visible.count();
    summary.witnessed_pairs = visibility->witnessed.count();
    if (boxes) summary.object_rows = BakeSummary::ObjectRows{boxes->visible.count(), boxes->by_cells};
    summary.bytes = bytes.size();
    summary.in_place_bytes = in_place->size();
    summary.resident_bytes = file->residentBytes();
    summary.seconds = secondsSince(begin);
    if (!options.report.empty())
        if (Status written = writePage(*source, *visibility, summary, options.report); !written) return written.error();
    printBakeSummary(options.json == "-" ? stderr : stdout, *source, *visibility, objects, summary);
    if (!options.json.empty())
        if (Status written = writeText(options.json, bakeJson(*source, *visibility, objects, summary)); !written)
            return written.error();
    return kDone;
}

}  // namespace

void addBake(CLI::App& tool, int& exit_code) {
    CLI::App* verb = tool.add_subcommand("bake", "cells, portals and visible sets of a scene as a file");
    const auto options = std::make_shared<BakeOptions>();
    addSceneChoice(*verb, options->scene);
    verb->add_option("-o,--output", options->output, "write the visibility file")->type_name("FILE");
    verb->add_option(
            "--cells", options->cells,
            "what of a .bsp has a row: clusters, as the map's compiler made them; leaves, each its own, which is "
            "tighter and takes far longer; groups, of leaves that are open to one another (default: clusters)")
        ->check(CLI::IsMember({"clusters", "leaves", "groups"}));
    verb->add_flag("--objects", options->objects,
                   "tell also which objects each cell sees: takes longer than the cells do");
    verb->add_option("--threads", options->threads, "share the portals among so many threads (default: one a core)")
        ->check(CLI::Range(1u, 1024u));
    verb->add_option("--budget", options->bake.budget,
                     "portals that may be clipped for each portal and direction; what is not settled by then is "
                     "visible, and counted (default: no limit)")
        ->type_name("WORK");
    verb->add_option("--time-limit", options->bake.time_limit,
                     "stop after so many seconds; what is not settled by then is visible")
        ->check(CLI::PositiveNumber)
        ->type_name("S");
    verb->add_option("--state", options->bake.state,
                     "where a long bake writes down how far it is, to go on after its end (default: the output's name "
                     "and .state)")
        ->type_name("FILE");
    verb->add_flag("--in-place", options->in_place, "the larger form, which answers without being unpacked");
    verb->add_option("--json", options->json, "write the figures as JSON (-: standard output)")->type_name("FILE");
    verb->add_option("--report", options->report, "write pictures and a page")->type_name("DIR");
    verb->callback([options, &exit_code] {
        const Result<int> done = runBake(*options);
        exit_code = done ? *done : report(done.error());
    });
}

}  // namespace sightline::cli
