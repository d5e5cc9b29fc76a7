// A scene's frames along some cameras, as a program has them: a query, the list of what it leaves, a drawing.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/scene_frames.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "apps/cli/shell/options.h"
#include "apps/cli/shell/apart.h"
#include "apps/cli/shell/progress.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/cull_frame.h"
#include "apps/cli/verbs/visibility_choice.h"
#include "sightline/studies/hidden/render.h"
#include "sightline/tools/profile/loaded_reference.h"
#include "sightline/tools/profile/middle.h"

namespace sightline::cli {
namespace {

constexpr size_t kFewFrames = 4;       // of a path that nobody asked for
constexpr size_t kFewTriangles = 128;  // of a mesh that has no clusters, as loadWorld() has it

uint64_t trianglesIn(std::span<const DrawItem> items) {
    uint64_t count = 0;
    for (const DrawItem& item : items) count += item.mesh.triangles();
    return count;
}

/// The counters of a set's frames, in the mean.
void countFrames(FrameTrial& trial, uint32_t threads, bool stream) {
    AblationRow& row = trial.row;
    const size_t views = trial.frames->views().size();
    const double part = 1.0 / static_cast<double>(views);
    RenderSettings settings;
    settings.threads = threads;
    settings.want_counts = true;
    for (size_t i = 0; i < views; ++i) {
        const std::span<const DrawItem> items = trial.frames->submit(i, trial.settings);
        const HiddenCounters counters = render(DrawList(items), trial.frames->views()[i], settings).counters;
        row.objects += part * static_cast<double>(items.size());
        row.triangles += part * static_cast<double>(trianglesIn(items));
        row.drawn += part * static_cast<double>(counters.geometry.produced);
        row.fragments += part * static_cast<double>(counters.generated);
        row.shaded += part * static_cast<double>(counters.shaded);
        row.bytes += part * static_cast<double>(carriedBytes(items, stream));
    }
}

AblationRow changed(AblationRow::Change change, Stage stage = Stage::kFrustum) {
    AblationRow row;
    row.change = change;
    row.stage = stage;
    return row;
}

Status checkFrameOutput(const RunOptions& options) {
    ApartFiles files = filesRead(options);
    files.write("--json", options.json);
    if (!files.status()) return files.status();
    return canWriteFiles({options.json});
}

Result<std::vector<View>> chooseViews(const CameraPath& path, const RunOptions& options) {
    const size_t count = path.frames.size();
    const PathChoice& choice = options.choice;
    const bool asked = !choice.file.empty() || choice.walk.frames > 0 || count <= kFewFrames;
    std::vector<View> views;
    for (size_t i = 0; i < (asked ? count : kFewFrames); ++i) {
        const size_t frame = asked ? i : i * count / kFewFrames;
        views.push_back(viewOf(path.frames[frame], options));
        if (!isUsable(views.back()))
            return Error{Error::Kind::kInput,
                         fmt::format("{}: frame {}: its matrices are not a camera's",
                                     choice.file.empty() ? options.scene.title() : choice.file, frame)};
    }
    return views;
}

}  // namespace

void addFrameOptions(Command& verb, RunOptions& options) {
    addSceneOptions(verb, options);
    for (const char* name : {"--rays", "--no-proofs"}) verb.remove_option(verb.get_option(name));
    verb.get_option("--threads")->description("that the reference renderer draws with (default: 1)");
    verb.get_option("--repeat")->description("times of stages and costs are medians of so many");
}

Result<AskedFrames> openFrames(const Command& verb, RunOptions& options) {
    if (Status good = finish(verb, options); !good) return good.error();
    if (verb.count("--threads") == 0) options.threads = 1;
    if (Status writable = checkFrameOutput(options); !writable) return writable.error();
    Result<Scene> scene = loadScene(options.scene);
    if (!scene) return scene.error();
    if (Status opened = openVisibility(*scene, options); !opened) return opened.error();
    const Result<CameraPath> path = loadPath(*scene, options);
    if (!path) return path.error();
    Result<std::vector<View>> views = chooseViews(*path, options);
    if (!views) return views.error();
    return AskedFrames{std::move(*scene), std::move(*views)};
}

SceneFrames::SceneFrames(const Scene& scene, const RunOptions& options, std::vector<View> views)
    : views_(std::move(views)), all_(scene, views_.front()), item_of_(scene.objects.size(), ~0u) {
    const std::span<const DrawItem> items = all_.casters();
    for (size_t i = 0; i < items.size(); ++i) item_of_[items[i].id] = static_cast<uint32_t>(i);
    const bool clusters = (options.settings.stages & stageBit(Stage::kClusters)) != 0;
    const LoadSettings load = loadSettings(true, options.settings.occluder_error, clusters, options.cluster_test);
    Progress progress("preparing", "meshes", scene.meshes.size());
    loaded_ = loadWorld(
        scene, [&](size_t done, size_t total) { progress.set(done, total); }, load);
    attachVisibility(options, loaded_.world);
    now_ = loaded_.world.commit();
    if (!clusters) return;
    // The world has clusters of its own, but not for whoever draws them.
    clusters_.resize(scene.meshes.size());
    for (size_t m = 0; m < scene.meshes.size(); ++m) {
        const Mesh& mesh = scene.meshes[m];
        if (mesh.deforms || mesh.triangles() < kFewTriangles) continue;
        std::vector<MeshPart> parts;
        for (const Primitive& primitive : mesh.primitives)
            parts.push_back({primitive.first_triangle, primitive.triangle_count,
                             scene.materials[primitive.material].double_sided,
                             scene.materials[primitive.material].hides()});
        clusters_[m].emplace(prepareDrawClusters({mesh.positions, mesh.indices}, parts, load.draw_clusters));
    }
}

void SceneFrames::addRest(const DrawItem& whole, std::span<const DrawRange> ranges) {
    const DrawClusters& clusters = *clusters_[scene().objects[whole.id].mesh];
    if (rests_used_ == rests_.size()) rests_.emplace_back();
    Rest& rest = rests_[rests_used_++];
    rest.indices.clear();
    rest.double_sided.clear();
    rest.writes_depth.clear();
    for (const DrawRange& range : ranges)
        for (uint32_t place = range.first; place < range.first + range.count; ++place) {
            const uint32_t triangle = clusters.triangles[place];
            const auto first = whole.mesh.indices.begin() + static_cast<std::ptrdiff_t>(3 * size_t{triangle});
            rest.indices.insert(rest.indices.end(), first, first + 3);
            rest.double_sided.push_back(whole.double_sided[triangle]);
            rest.writes_depth.push_back(whole.writes_depth[triangle]);
        }
    DrawItem item = whole;
    item.mesh.indices = rest.indices;
    item.double_sided = rest.double_sided;
    item.writes_depth = rest.writes_depth;
    drawn_.push_back(item);
}

std::span<const DrawItem> SceneFrames::submit(size_t view, const QuerySettings& settings) {
    const VisibleSet set = query_.visible(now_, views_[view], settings);
    query_nanoseconds_ = set.stats.nanoseconds;
    drawn_.clear();
    rests_used_ = 0;
    size_t next = 0;
    for (size_t i = 0; i < set.objects.size(); ++i) {
        const size_t first = next;
        while (next < set.ranges.size() && set.ranges[next].object == i) ++next;
        const uint32_t object = set.objects[i].id.index - 1;
        if (item_of_[object] == ~0u) continue;
        const DrawItem& item = items()[item_of_[object]];
        if (next > first) addRest(item, set.ranges.subspan(first, next - first));
        else drawn_.push_back(item);
    }
    return drawn_;
}

DrawFrame pathOf(SceneFrames& frames, LoadedRenderer& renderer, const QuerySettings& settings) {
    return [&frames, &renderer, &settings](const StageLoads& loads) {
        FrameTimes all;
        all.gpu = 0.0;
        for (size_t i = 0; i < frames.views().size(); ++i) {
            const FrameTimes one = renderer.draw(
                frames.views()[i], [&, i] { return frames.submit(i, settings); }, loads);
            all.wall += one.wall;
            all.cpu += one.cpu;
            if (one.gpu && all.gpu) *all.gpu += *one.gpu;
            else all.gpu.reset();
        }
        return all;
    };
}

void measureTrials(std::span<FrameTrial> trials, uint32_t threads, bool stream, uint32_t rounds,
                   const std::function<void(size_t, size_t)>& progress) {
    const size_t total = trials.size() * (rounds + 1);
    size_t done = 0;
    const auto step = [&] {
        if (progress) progress(++done, total);
    };
    for (FrameTrial& trial : trials) {
        countFrames(trial, threads, stream);
        step();
    }
    LoadedReference renderer({threads, stream});
    for (uint32_t round = 0; round < rounds; ++round)
        for (FrameTrial& trial : trials) {
            double query = 0, frame = 0;
            const size_t views = trial.frames->views().size();
            for (size_t i = 0; i < views; ++i) {
                frame +=
                    renderer.draw(trial.frames->views()[i], [&] { return trial.frames->submit(i, trial.settings); }, {})
                        .wall;
                query += static_cast<double>(trial.frames->queryNanoseconds());
            }
            trial.frame_milliseconds.push_back(1e3 * frame / static_cast<double>(views));
            trial.query_microseconds.push_back(1e-3 * query / static_cast<double>(views));
            step();
        }
    for (FrameTrial& trial : trials) {
        trial.row.query_microseconds = middleOf(trial.query_microseconds);
        trial.row.frame_milliseconds = middleOf(trial.frame_milliseconds);
        trial.row.frame_spread = middleError(trial.frame_milliseconds);
    }
}

std::vector<FrameTrial> ablationTrials(SceneFrames& frames, const QuerySettings& settings) {
    using Change = AblationRow::Change;
    std::vector<FrameTrial> trials;
    const auto add = [&](uint32_t stages, const AblationRow& row) {
        trials.push_back({&frames, settings, row, {}, {}});
        trials.back().settings.stages = stages;
    };
    add(settings.stages, changed(Change::kNothing));
    for (int i = 0; i < kStageCount; ++i) {
        const auto stage = static_cast<Stage>(i);
        if (settings.stages & stageBit(stage))
            add(settings.stages & ~stageBit(stage), changed(Change::kWithout, stage));
    }
    // Others need a file, a limit or clusters, which nobody asked for.
    if (!(settings.stages & stageBit(Stage::kVolumes)))
        add(settings.stages | stageBit(Stage::kVolumes), changed(Change::kWith, Stage::kVolumes));
    if (settings.stages != 0) add(0, changed(Change::kNone));
    return trials;
}

}  // namespace sightline::cli
