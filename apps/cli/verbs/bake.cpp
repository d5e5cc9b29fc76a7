// The verb `bake`: the cells, portals and visible sets of a map or a scene with cells, as a visibility file.
// SPDX-License-Identifier: MIT
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "apps/cli/shell/options.h"
#include "apps/cli/shell/apart.h"
#include "apps/cli/shell/progress.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/bake_prepared.h"
#include "apps/cli/verbs/bake_run.h"
#include "apps/cli/verbs/bake_source.h"
#include "apps/cli/verbs/bake_summary.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/verbs.h"
#include "sightline/tools/import/quake/map_source.h"
#include "sightline/tools/load/choose_path.h"
#include "sightline/tools/report/output_file.h"
#include "sightline/tools/report/page/bake_page.h"
#include "sightline/tools/report/page/vis_page.h"
#include "sightline/tools/scene/scene_core.h"
#include "sightline/tools/truth/region_sight.h"

namespace sightline::cli {
using namespace bake;
using namespace tools;
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point then) { return std::chrono::duration<double>(Clock::now() - then).count(); }

struct SceneBakeOptions : BakeOptions {
    SceneChoice scene;
    BakeSourceChoice source;
    std::optional<double> height;  ///< at which the page's plans cut
    uint32_t rays = 0;             ///< from each view cell
};

/// Where somebody stands in the scene: whose storey the page shows.
glm::dvec3 eyeIn(const Scene& scene, std::optional<double> height) {
    PathChoice walk;
    walk.kind = PathKind::kWalk;
    walk.walk.frames = 1;
    const Result<CameraPath> path = choosePath(scene, walk);
    glm::dvec3 eye = path && !path->frames.empty() ? path->frames.front().eye : coreOf(scene).bounds.center();
    if (height) eye.y = *height;
    return eye;
}

/// Of cells that have rows the page has these alone, of others what walls and view cells are.
Status writePage(const SceneBakeOptions& options, const BakeSource& source, const Baked& baked,
                 const BakeSummary& summary, const std::string& json) {
    VisSummary rows = summary.rows;
    rows.objects.reset();
    if (source.rows_are != "none")
        return writeVisPage(baked.cells.rows, baked.rows.visible, baked.rows.witnessed, rows, options.report);
    DrawnBake drawn;
    drawn.scene = &source.scene;
    drawn.space = &baked.cells.space;
    if (source.walls)
        for (const WallGap& gap : source.walls->gaps) drawn.gaps.push_back({gap.from, gap.to});
    if (baked.view_rows.rows() > 0) {
        drawn.views = &baked.cells.views->tree;
        drawn.rows = &baked.view_rows;
        if (summary.by_rays) drawn.seen = &summary.by_rays->seen;
        drawn.object_of = baked.objects.object_of;
    }
    drawn.eye = eyeIn(source.scene, options.height);
    return writeBakePage(drawn, json, options.report);
}

/// Looks from each view cell; none if that was interrupted.
std::optional<RowsByRays> lookFromCells(const Scene& scene, const Baked& baked, uint32_t rays, Jobs& jobs) {
    RowRaysSettings settings;
    settings.rays = rays;
    settings.jobs = &jobs;
    settings.stop = [] { return interrupted(); };
    constexpr size_t kParts = 100;
    Progress progress("looking from view cells", "percent", kParts);
    settings.progress = [&](double done) { progress.set(static_cast<size_t>(done * kParts), kParts); };
    BitMatrix seen = seenOfRows(scene, baked.cells.views->tree, baked.objects.object_of, baked.view_rows, settings);
    if (interrupted()) return std::nullopt;
    return rowsByRays(rays, std::move(seen), baked.view_rows);
}

Result<int> runBake(SceneBakeOptions& options) {
    const Clock::time_point begin = Clock::now();
    ApartFiles files;
    for (const std::string& name : options.scene.names) files.read("SCENE", splitMapName(name).file);
    for (const std::string& path : options.source.rules.shaders) files.read("--shaders", path);
    if (Status good = finishBakeOptions(options, files); !good) return good.error();
    const std::string title = options.scene.title();
    BakeRun run(options);
    options.source.cells = options.cells;
    options.source.jobs = &run.jobs();
    options.source.begin_view_cells = [&] { return run.beginViewCells(); };
    Result<BakeSource> source = loadBakeSource(options.scene, options.source);
    if (!source) return source.error();
    if (interrupted()) return run.reportInterrupted();
    if (source->rows_are == "none" && options.objects)
        return usageError("--objects: these cells have no rows of visibility, which it tells of");
    if (options.height && (options.report.empty() || source->rows_are != "none"))
        return usageError("--height goes with --report, of a scene without marked cells");
    if (Status fits = checkSize(source->cells.rows, title, source->of_bsp); !fits) return fits.error();
    if (options.rays > 0 && options.source.view_cells < 2)
        return usageError("--rays goes with --view-cells: it looks from these");
    const double cells_seconds = secondsSince(begin);

    if (!options.prepare.empty() && (source->of_bsp || source->scene.objects.empty()))
        return usageError("--prepare: of scenes, not of maps");
    const PreparedMeshes prepared =
        options.prepare.empty() ? PreparedMeshes() : prepareForFile(source->scene, options.prepare, run.threads());

    Result<BakeSettings> settings = run.begin(source->cells.rows);
    if (!settings) return settings.error();
    settings->prepared = prepared.meshes;
    settings->prepared_of_object = prepared.mesh_of_object;
    const Result<Baked> baked = bake::bake(std::move(source->cells), source->scene, *settings);
    if (!baked) return baked.error();
    if (baked->interrupted) return run.reportInterrupted();
    const std::span<const char> bytes = baked->file.bytes(settings->form);
    if (!options.output.empty())
        if (Status written = writeFileAside(options.output, {bytes.data(), bytes.size()}); !written)
            return written.error();
    run.end();

    BakeSummary summary = bakeSummary(*source, *baked, settings->form);
    summary.rows.map = title;
    summary.rows.threads = run.threads();
    summary.cells_seconds = cells_seconds;
    summary.rows.wall_seconds = secondsSince(begin);
    if (options.rays > 0 && baked->view_rows.rows() > 0) {
        summary.by_rays = lookFromCells(source->scene, *baked, options.rays, run.jobs());
        if (!summary.by_rays) return reportInterruption("the bake", !options.output.empty());
    }
    const std::string json = bakeJson(*source, *baked, summary);
    if (!options.report.empty())
        if (Status written = writePage(options, *source, *baked, summary, json); !written) return written.error();
    printBakeSummary(options.json == "-" ? stderr : stdout, *source, *baked, summary);
    if (!options.report.empty()) tellPage(options.json == "-" ? stderr : stdout, options.report);
    if (!options.json.empty())
        if (Status written = writeText(options.json, json); !written) return written.error();
    return kDone;
}

}  // namespace

void addBake(Command& tool, int& exit_code) {
    Command verb = tool.add_subcommand("bake", "cells, portals and visible sets of a scene as a file");
    const auto options = std::make_shared<SceneBakeOptions>();
    addSceneChoice(*verb, options->scene);
    addBakeOptions(*verb, *options, "write the visibility file", true);
    verb->add_option("--smallest-occluder", options->source.smallest_occluder,
                     "of a scene without marked cells: the side of the smallest square of opaque surface that divides "
                     "space [world "
                     "units] (default: a 128th of the diagonal of what is near together, or a little more if hardly "
                     "less is hidden then)")
        ->check(Range{0.0, 1e9})
        ->type_name("L");
    verb->add_option("--smallest-hole", options->source.smallest_hole,
                     "and how wide a hole must be to be one [world units]; larger than coordinates are exact it shuts "
                     "holes that can be seen through, so that a cull may be false (default: 2^-22 of the largest "
                     "coordinate of the wall beside it)")
        ->check(Range{0.0, 1e9})
        ->type_name("L");
    verb->add_option("--widest-gap", options->source.widest_gap,
                     "list the slits between walls that are no wider, which were probably meant to be shut [world "
                     "units]; 0: none (default: 2^-12 of the diagonal of what is near together)")
        ->check(Range{0.0, 1e9})
        ->type_name("L");
    addMapRules(*verb, options->source.rules);
    verb->add_option("--moves", options->source.moves,
                     "of a scene: objects that may be elsewhere at run time, as doors that stand in no portal: they "
                     "hide nothing. A key, or what their paths have in common, as door [may be given many times] "
                     "(default: the leaves of doors in portals)")
        ->allow_extra_args(false)
        ->type_name("NAME");
    verb->add_option("--view-cells", options->source.view_cells,
                     "divide space into so many boxes and tell which objects may be seen from each, as 2048 (default: "
                     "none)")
        ->check(Range{0u, 1u << 16})
        ->type_name("COUNT");
    verb->add_option(
            "--rays", options->rays,
            "look from each view cell with so many rays: what they see may be seen for sure, so that the cell's "
            "row is known from below, too (default: none)")
        ->check(Range{0u, 1u << 30})
        ->type_name("COUNT");
    verb->add_option("--prepare", options->prepare,
                     "of a scene: what the file is to hold of its meshes, so that they need not be prepared again: "
                     "occluders, and with them inner, clusters or lods (default: nothing)")
        ->delimiter(',')
        ->check(OneOf(kPrepareWords))
        ->type_name("LIST");
    verb->add_option(
            "--height", options->height,
            "of a scene without marked cells, with --report: the height at which plans cut the walls [world units] "
            "(default: of an eye on a floor of the scene)")
        ->check(Range{-1e9, 1e9})
        ->type_name("Y");
    verb->callback([verb, options, &exit_code] {
        options->source.of_walls =
            verb->count("--smallest-occluder") + verb->count("--smallest-hole") + verb->count("--widest-gap") > 0;
        const Result<int> done = runBake(*options);
        exit_code = done ? *done : report(done.error());
    });
}

}  // namespace sightline::cli
