// The verb `advise`: what to turn on, bake, split or merge in a scene, each tried on its own frames.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "apps/cli/shell/other_verbs.h"
#include "apps/cli/shell/progress.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/bake_source.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/scene_frames.h"
#include "apps/cli/verbs/verbs.h"
#include "apps/cli/verbs/visibility_choice.h"
#include "sightline/bake/bake.h"
#include "sightline/tools/profile/loaded_reference.h"
#include "sightline/tools/report/run/advice.h"
#include "sightline/tools/scene/merge.h"
#include "sightline/tools/scene/split.h"

namespace sightline::cli {
using namespace bake;
using namespace tools;
namespace {

// Beyond these a change is not tried: it would take minutes.
constexpr uint64_t kMostClustered = 1000000;  // triangles of meshes
constexpr uint64_t kMostWalls = 300000;       // triangles that cells are made of
constexpr double kMostBaking = 30;            // of rows  [s]
constexpr double kMostLoading = 20;           // of stages  [s]
// Below these there is nothing to try.
constexpr uint64_t kFewestClustered = 2000, kFewestSplit = 20000, kFewestSmall = 100;
constexpr uint32_t kCubes = 8;  // of --split grid:

/// A change that makes a scene of its own, or a world of its own.
struct Variant {
    Advice advice;
    std::unique_ptr<Scene> scene;  ///< null: the scene itself
    RunOptions options;
    std::unique_ptr<SceneFrames> frames;
};

struct AdvisedScene {
    const Scene& scene;
    const RunOptions& options;
    std::vector<View> views;
    std::vector<Variant> variants;
    std::vector<std::string> not_tried;

    void skip(const char* what, const std::string& why) { not_tried.push_back(fmt::format("{}: {}", what, why)); }
    void add(Advice advice, std::unique_ptr<Scene> made, const RunOptions& with) {
        variants.push_back({std::move(advice), std::move(made), with, nullptr});
    }

    void tryClusters();
    void trySplit();
    void tryMerge();
    void tryBake();
};

void AdvisedScene::tryClusters() {
    if (options.settings.stages & stageBit(Stage::kClusters)) return;  // a stage in use, as others are
    uint64_t triangles = 0;
    for (const Mesh& mesh : scene.meshes)
        if (mesh.triangles() >= 128 && !mesh.deforms) triangles += mesh.triangles();
    if (triangles < kFewestClustered) return skip("clusters", "no dense meshes");
    if (triangles > kMostClustered) return skip("clusters", "more than a million triangles to prepare");
    RunOptions with = options;
    with.settings.stages |= stageBit(Stage::kClusters);
    Advice advice;
    advice.what = "clusters";
    std::string use;
    for (int stage = 0; stage < kStageCount; ++stage)
        if (with.settings.stages >> stage & 1) use += (use.empty() ? "" : ",") + std::string(kStageNames[stage]);
    advice.how = "--use " + use;
    add(std::move(advice), nullptr, with);
}

void AdvisedScene::trySplit() {
    if (!options.scene.split.empty()) return;
    if (options.opened) return skip("split", "a visibility file knows the objects as they are");
    const WideObjects wide = wideObjects(scene);
    if (wide.triangles < kFewestSplit || wide.triangles < drawnTriangles(scene) / 4)
        return skip("split", "no large mesh reaches through half of the scene");
    auto cut = std::make_unique<Scene>(splitScene(scene, {Split::Along::kGrid, kCubes}));
    Advice advice;
    advice.kind = Advice::Kind::kSplit;
    advice.what =
        fmt::format("{} of {} triangles into {} objects", wide.objects == 1 ? "the mesh" : "the widest meshes",
                    grouped(wide.triangles), grouped(cut->objects.size()));
    advice.how = fmt::format("--split grid:{}", kCubes);
    add(std::move(advice), std::move(cut), options);
}

void AdvisedScene::tryMerge() {
    if (options.opened) return skip("merge", "a visibility file knows the objects as they are");
    MergedScene merged = mergeSmall(scene);
    if (merged.small < kFewestSmall) return skip("merge", "fewer than 100 small objects are near others");
    Advice advice;
    advice.kind = Advice::Kind::kMerge;
    advice.what = fmt::format("{} objects of fewer than {} triangles into {}", grouped(merged.small),
                              MergeSmall().triangles, grouped(merged.joined));
    add(std::move(advice), std::make_unique<Scene>(std::move(merged.scene)), options);
}

/// In memory, as `bake` would write it.
Result<std::shared_ptr<const OpenedVisibility>> bakeInMemory(const RunOptions& options, std::string& cells_are) {
    BakeSourceChoice choice;
    const bool was_quiet = quiet();
    setQuiet(true);  // the scene's notes were printed once
    Result<BakeSource> source = loadBakeSource(options.scene, choice);
    setQuiet(was_quiet);
    if (!source) return source.error();
    cells_are = source->cells_are;
    if (cells_are == "all of space") return std::shared_ptr<const OpenedVisibility>();
    BakeSettings settings;
    settings.time_limit = kMostBaking;
    settings.form = VisibilityForm::kInPlace;
    const Result<Baked> baked = bake::bake(std::move(source->cells), source->scene, settings);
    if (!baked) return baked.error();
    const std::span<const char> bytes = baked->file.bytes(settings.form);
    auto text = std::make_unique<std::string>(bytes.data(), bytes.size());
    Result<VisibilityFile> file = VisibilityFile::open(*text, "baked");
    if (!file) return file.error();
    return std::shared_ptr<const OpenedVisibility>(
        std::make_shared<OpenedVisibility>(std::move(text), std::move(*file)));
}

void AdvisedScene::tryBake() {
    if (options.opened) return;  // its stages are tried
    if (drawnTriangles(scene) > kMostWalls) return skip("bake", "more than 300,000 triangles");
    std::string cells_are;
    const auto baked = bakeInMemory(options, cells_are);
    if (!baked) return skip("bake", baked.error().message);
    if (*baked == nullptr) return skip("bake", "the scene has hardly an inside");
    RunOptions with = options;
    with.opened = *baked;
    with.settings.stages |= kCellStages;
    Advice advice;
    advice.kind = Advice::Kind::kBake;
    advice.what = fmt::format("its cells, {}", cells_are);
    advice.how = fmt::format("sightline bake {} -o FILE, then --visibility FILE", options.scene.words());
    add(std::move(advice), nullptr, with);
}

Advice adviceOf(const StageBenefit& benefit, const QuerySettings& settings) {
    Advice advice;
    advice.what = kStageNames[static_cast<int>(benefit.stage)];
    advice.done = benefit.in_use;
    advice.saves = benefit.milliseconds;
    advice.spread = benefit.spread;
    if (benefit.words() != "nothing") advice.helps = benefit.words();
    if (benefit.in_use) {
        advice.how = "--skip " + advice.what;
        return advice;
    }
    for (int stage = 0; stage < kStageCount; ++stage)
        if ((settings.stages | stageBit(benefit.stage)) >> stage & 1)
            advice.how += (advice.how.empty() ? "--use " : ",") + std::string(kStageNames[stage]);
    return advice;
}

/// Stages and variants take turns, so that all are measured in the same minutes.
void measureAll(AdvisedScene& advised, SceneFrames& base, AdviceRun& run) {
    std::vector<FrameTrial> trials = ablationTrials(base, advised.options.settings);
    const size_t stages = trials.size();
    for (Variant& variant : advised.variants) {
        variant.frames = std::make_unique<SceneFrames>(variant.scene ? *variant.scene : advised.scene, variant.options,
                                                       advised.views);
        FrameTrial trial;
        trial.frames = variant.frames.get();
        trial.settings = variant.options.settings;
        trials.push_back(std::move(trial));
    }
    Progress progress("measuring", "paths", 0);
    measureTrials(trials, advised.options.threads, false, run.rounds,
                  [&](size_t done, size_t total) { progress.set(done, total); });
    std::vector<AblationRow> rows;
    for (size_t i = 0; i < stages; ++i) rows.push_back(trials[i].row);
    run.frame_milliseconds = rows.front().frame_milliseconds;
    run.query_microseconds = rows.front().query_microseconds;
    for (const StageBenefit& benefit : benefitsOf(rows))
        run.advice.push_back(adviceOf(benefit, advised.options.settings));
    for (size_t i = 0; i < advised.variants.size(); ++i) {
        Advice advice = advised.variants[i].advice;
        const AblationRow &with = trials[stages + i].row, &without = trials.front().row;
        advice.saves = without.frame_milliseconds - with.frame_milliseconds;
        advice.spread = std::hypot(without.frame_spread, with.frame_spread);
        run.advice.push_back(std::move(advice));
    }
}

Status runAdvise(const Command& verb, RunOptions& options) {
    const Result<AskedFrames> asked = openFrames(verb, options);
    if (!asked) return asked.error();
    const Scene& scene = asked->scene;
    AdviceRun run;
    run.scene = options.scene.title();
    run.machine = machineName();
    run.objects = scene.objects.size();
    run.triangles = drawnTriangles(scene);
    run.width = options.width;
    run.height = options.height;
    run.frames = static_cast<uint32_t>(asked->views.size());
    run.threads = options.threads;
    run.rounds = static_cast<uint32_t>(options.repeat);
    AdvisedScene advised{scene, options, asked->views, {}, {}};
    advised.tryClusters();
    advised.tryBake();
    advised.trySplit();
    advised.tryMerge();
    SceneFrames base(scene, options, asked->views);
    measureAll(advised, base, run);
    run.not_tried = advised.not_tried;
    LoadedReference reference({options.threads, false});
    BottleneckSettings settings;
    settings.seconds = kMostLoading;
    run.bottleneck = findBottleneck(pathOf(base, reference, options.settings), settings);
    tell(options.json == "-" ? stderr : stdout, adviceText(run));
    return options.json.empty() ? success() : writeText(options.json, adviceJson(run));
}

}  // namespace

void addAdvise(Command& tool, int& exit_code) {
    Command verb = addOtherVerb(tool, "advise");
    const auto options = std::make_shared<RunOptions>();
    options->repeat = 5;
    addFrameOptions(*verb, *options);
    verb->callback([verb, options, &exit_code] {
        const Status done = runAdvise(*verb, *options);
        exit_code = done ? kDone : report(done.error());
    });
}

}  // namespace sightline::cli
