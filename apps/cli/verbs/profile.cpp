// The verb `profile`: what limits a scene's frames, what its parts cost, and what each stage of the query is worth there.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/cli/shell/other_verbs.h"
#include "apps/cli/shell/progress.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/scene_frames.h"
#include "apps/cli/verbs/verbs.h"
#ifdef SIGHTLINE_GL
#include "apps/gl/loaded_gl.h"
#endif
#include "sightline/tools/profile/loaded_reference.h"
#include "sightline/tools/report/run/profile_run.h"

namespace sightline::cli {
using namespace tools;
namespace {

struct ProfileOptions : RunOptions {
    std::string renderer = "reference";
    bool stream = false;
    double time_limit = 60;
};

/// Of what the query leaves in each view.
DrawCosts costsOf(SceneFrames& frames, LoadedRenderer& renderer, const ProfileOptions& options, Progress& progress) {
    std::vector<std::vector<DrawItem>> items;
    std::vector<CostView> views;
    QuerySettings whole = options.settings;
    whole.stages &= ~stageBit(Stage::kClusters);  // whose items do not last
    for (size_t i = 0; i < frames.views().size(); ++i) {
        const std::span<const DrawItem> left = frames.submit(i, whole);
        items.emplace_back(left.begin(), left.end());
    }
    for (size_t i = 0; i < items.size(); ++i) views.push_back({frames.views()[i], items[i]});
    DrawCostSettings settings;
    settings.rounds = static_cast<uint32_t>(options.repeat);
    settings.threads = options.threads;
    settings.progress = [&](size_t done, size_t total) { progress.set(done, total); };
    return measureDrawCosts(renderer, views, settings);
}

void measure(SceneFrames& frames, LoadedRenderer& renderer, const ProfileOptions& options, ProfileRun& run) {
    BottleneckSettings settings;
    settings.seconds = options.time_limit;
    {
        Progress progress("loading stages", "rounds", 0);
        settings.progress = [&](size_t done, size_t total) { progress.set(done, total); };
        run.bottleneck = findBottleneck(pathOf(frames, renderer, options.settings), settings);
    }
    {
        Progress progress("fitting costs", "views", 0);
        run.costs = costsOf(frames, renderer, options, progress);
        run.facing = measureFacingCosts();
    }
    Progress progress("leaving stages out", "paths", 0);
    std::vector<FrameTrial> trials = ablationTrials(frames, options.settings);
    measureTrials(trials, options.threads, options.stream, static_cast<uint32_t>(options.repeat),
                  [&](size_t done, size_t total) { progress.set(done, total); });
    for (const FrameTrial& trial : trials) run.ablation.push_back(trial.row);
}

#ifdef SIGHTLINE_GL
/// What the GL's own counters say of the frames, in the mean.
DriverCounts driverCountsOf(SceneFrames& frames, LoadedGl& gl, const ProfileOptions& options, double gpu_busy) {
    DriverCounts out;
    out.gpu_busy = gpu_busy;
    const double part = 1.0 / static_cast<double>(frames.views().size());
    const auto add = [&](std::optional<double>& to, const std::optional<uint64_t>& count, bool first) {
        if (!count) to.reset();
        else if (first || to) to = to.value_or(0) + part * static_cast<double>(*count);
    };
    for (size_t i = 0; i < frames.views().size(); ++i) {
        const GlStatistics counts = gl.count(frames.views()[i], [&, i] { return frames.submit(i, options.settings); });
        add(out.vertices, counts.vertices, i == 0);
        add(out.triangles, counts.triangles, i == 0);
        add(out.fragments, counts.fragments, i == 0);
        out.samples_passed += part * static_cast<double>(counts.samples_passed);
    }
    return out;
}

Status measureGl(SceneFrames& frames, const ProfileOptions& options, ProfileRun& run) {
    // Of one thread the caller's own: then nothing overlaps, and a frame is the sum of its parts.
    const Result<GlContext> context = GlContext::create(options.threads > 1 ? std::min(options.threads, 16u) : 0);
    if (!context) return context.error();
    LoadedGlSettings settings;
    settings.stream = options.stream;
    Result<LoadedGl> gl = LoadedGl::create(*context, frames.items(), settings);
    if (!gl) return gl.error();
    run.driver = context->renderer();
    measure(frames, *gl, options, run);
    const Bottleneck& found = run.bottleneck;
    run.driver_counts =
        driverCountsOf(frames, *gl, options, found.gpu && found.frame > 0 ? *found.gpu / found.frame : 0);
    return gl->status();
}
#endif

Status measureBy(SceneFrames& frames, const ProfileOptions& options, ProfileRun& run) {
#ifdef SIGHTLINE_GL
    if (options.renderer == "gl") return measureGl(frames, options, run);
#endif
    LoadedReference reference({options.threads, options.stream});
    measure(frames, reference, options, run);
    return success();
}

ProfileRun profiled(const Scene& scene, const SceneFrames& frames, const ProfileOptions& options) {
    ProfileRun run;
    run.scene = options.scene.title();
    run.renderer = options.renderer;
    run.machine = machineName();
    run.objects = scene.objects.size();
    run.triangles = drawnTriangles(scene);
    run.width = options.width;
    run.height = options.height;
    run.frames = static_cast<uint32_t>(frames.views().size());
    run.threads = options.threads;
    run.stream = options.stream;
    return run;
}

Status runProfile(const Command& verb, ProfileOptions& options) {
#ifndef SIGHTLINE_GL
    if (options.renderer == "gl") return usageError("--renderer gl: this build has no GL (libepoxy-dev was not there)");
#endif
    Result<AskedFrames> asked = openFrames(verb, options);
    if (!asked) return asked.error();
    SceneFrames frames(asked->scene, options, std::move(asked->views));
    ProfileRun run = profiled(asked->scene, frames, options);
    if (Status measured = measureBy(frames, options, run); !measured) return measured;
    tell(options.json == "-" ? stderr : stdout, profileText(run));
    return options.json.empty() ? success() : writeText(options.json, profileJson(run));
}

}  // namespace

void addProfile(Command& tool, int& exit_code) {
    Command verb = addOtherVerb(tool, "profile");
    const auto options = std::make_shared<ProfileOptions>();
    options->repeat = 5;
    addFrameOptions(*verb, *options);
    verb->add_option("--renderer", options->renderer, "that is loaded: the z-buffer of `render`, or software GL")
        ->check(OneOf{"reference", "gl"})
        ->capture_default_str()
        ->group("Measuring");
    verb->add_flag("--stream", options->stream,
                   "carry the meshes of what is drawn to the renderer each frame, not its transforms alone")
        ->group("Measuring");
    verb->add_option("--time-limit", options->time_limit, "for finding what limits [s]; what is known by then counts")
        ->check(Range{0.1, 1e6})
        ->capture_default_str()
        ->type_name("S")
        ->group("Measuring");
    verb->callback([verb, options, &exit_code] {
        const Status done = runProfile(*verb, *options);
        exit_code = done ? kDone : report(done.error());
    });
}

}  // namespace sightline::cli
