// Culls a scene along a camera path on several threads, and lets the witnesses judge the answers.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/cull_path.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include "apps/cli/shell/progress.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/cull_frame.h"
#include "apps/cli/verbs/proposer.h"
#include "apps/cli/verbs/setting_options.h"
#include "apps/cli/verbs/verbs.h"
#include "apps/cli/verbs/visibility_choice.h"
#include "sightline/bake/objects/scene_hash.h"
#include "sightline/base/thread_pool.h"
#include "sightline/query/explain/credits.h"
#include "sightline/lod/lod_choice.h"
#include "sightline/query/query.h"
#include "sightline/studies/hidden/threads.h"
#include "sightline/tools/load/mesh_lods.h"
#include "sightline/tools/load/scene_levels.h"
#include "sightline/tools/report/output_file.h"
#include "sightline/tools/report/readable.h"
#include "sightline/tools/scene/one_line.h"
#include "sightline/tools/truth/changed_pixels.h"
#include "sightline/tools/truth/verify.h"

namespace sightline::cli {
using namespace studies;
using namespace tools;
namespace {

/// What a thread answers frames with.
struct Answerer {
    explicit Answerer(uint32_t threads) : pool(threads) {}

    ThreadPool pool;  ///< that shares each query
    Query query{defaultMemory(), pool.workers() > 1 ? &pool : nullptr};
    Query of_frustum;  ///< for what that stage alone would leave: it remembers nothing of `query`'s frames
    std::optional<CreditBook> book;    ///< if credits were asked for
    std::optional<Proposer> proposer;  ///< if it is to propose
    std::optional<Query> teacher;      ///< that `query` learns from, if it does
};

void creditFrame(const CullRun& run, CreditBook& book, FrameResult& frame) {
    for (const Credit& credit : book.credits(viewOf(frame.camera, run), run.settings))
        frame.credits.push_back({credit.item, credit.triangles, credit.hidden, credit.hidden_weight});
}

uint64_t countOnce(std::vector<uint64_t>& keys) {
    std::sort(keys.begin(), keys.end());
    return static_cast<uint64_t>(std::unique(keys.begin(), keys.end()) - keys.begin());
}

VerificationRow rowOf(const FrameVerdict& verdict, const FrameResult& frame, const Scene& scene, const CullRun& run) {
    VerificationRow row;
    row.rays = verdict.rays;
    row.aimed_rays = verdict.aimed_rays;
    row.id_samples = verdict.id_samples;
    row.supersampling = verdict.supersampling;
    row.unconfirmed = verdict.unconfirmed;
    row.proofs = verdict.proofs;
    std::vector<uint64_t> keys, lossy;
    for (size_t i = 0; i < verdict.seen.size(); ++i)
        if (verdict.seen[i]) (isLossy(frame.reasons[i], run) ? lossy : keys).push_back(scene.objects[i].key);
    row.exactly_visible = countOnce(keys);
    row.lossy_seen = countOnce(lossy);
    for (size_t i = 0; i < frame.reasons.size(); ++i)
        if (frame.reasons[i] == 0 && !(i < verdict.seen.size() && verdict.seen[i]))
            row.kept_unseen.push_back(static_cast<uint32_t>(i));
    std::set<uint64_t> hidden;
    for (const FalseCull& cull : verdict.false_culls) {
        const uint64_t key = scene.objects[cull.object].key;
        hidden.insert(key);
        row.rows.push_back({cull.object, key, cull.x, cull.y, cull.witness});
    }
    row.false_culls = hidden.size();
    return row;
}

using Worker = std::function<void(size_t)>;

/// Calls worker(i) for i in [0, count), in rising order as far as threads allow, until `stop` says so: what was begun
/// is then finished. Where memory does not reach for so many threads, those that find none end, and what they had
/// begun is done again when the others are through. Throws what work throws, once all threads have ended.
/// @param stop  may be empty
/// @param make  makes the worker of a thread, on that thread
/// @return how many were done: those before it, and no others
size_t shareOut(size_t count, uint32_t threads, const std::function<bool()>& stop,
                const std::function<Worker(uint32_t thread)>& make) {
    std::mutex mutex;
    size_t next = 0;
    std::vector<size_t> again;
    FirstFault fault;
    const auto take = [&]() -> std::optional<size_t> {
        const std::lock_guard lock(mutex);
        if (fault.any() || next >= count || (stop && stop())) return std::nullopt;
        return next++;
    };
    threads = static_cast<uint32_t>(std::min<size_t>(threads, count));
    again.reserve(threads);
    const auto loop = [&](uint32_t thread) {
        fault.guard([&] {
            std::optional<size_t> mine;
            try {
                const Worker work = make(thread);
                while ((mine = take())) work(*mine);
            } catch (const std::bad_alloc&) {
                const std::lock_guard lock(mutex);
                if (mine) again.push_back(*mine);
            }
        });
    };
    std::vector<std::thread> others = startThreads(threads, loop);
    loop(0);
    for (std::thread& other : others) other.join();
    fault.rethrow();
    if (again.empty() && (next >= count || (stop && stop()))) return next;
    const Worker alone = make(0);
    for (const size_t i : again) alone(i);
    while (const auto mine = take()) alone(*mine);
    return next;
}

/// Where the run's other files go, with a slash, or nothing for the current directory.
std::string directoryOfOutputs(const RunOptions& options) {
    std::filesystem::path directory;
    if (!options.report.empty()) directory = options.report;
    else if (!options.json.empty() && options.json != "-")
        directory = std::filesystem::path(options.json).parent_path();
    return directory.empty() ? "" : (directory / "").string();
}

/// The command that judges frames again in the same way.
std::string replayCommand(const RunOptions& options, const CullRun& run, const std::string& camera_file) {
    std::string command = fmt::format("sightline verify {} --cameras {} --size {}x{} --rays {}", options.scene.words(),
                                      quoted(camera_file), run.width, run.height, options.rays);
    if (run.jitter != View().jitter) command += fmt::format(" --jitter {}", run.jitter);
    command += settingWords(run.settings) + sectionOptionsOf(run.sections) + visibilityOptionsOf(run.visibility) +
               clusterOptionsOf(run.cluster_test);
    if (run.stereo > 0) command += fmt::format(" --stereo {}", run.stereo);
    if (!run.settings.stateless) command += " --remember";
    if (options.propose) command += " --propose";
    if (options.taught) command += " --taught";
    if (options.no_proofs) command += " --no-proofs";
    QuerySettings asked;
    asked.max_distance = run.settings.max_distance;
    asked.contribution = run.settings.contribution;
    asked.lod_error = run.settings.lod_error;
    asked.budget = run.settings.budget;
    const uint32_t unnamed = stageBit(Stage::kClusters) | (run.visibility.file.empty() ? kCellStages : 0);
    const uint32_t stages = stagesInUse(View(), asked) & ~unnamed;  // if none are named
    std::string used, skipped;
    for (int stage = 0; stage < kStageCount; ++stage) {
        const bool uses = run.settings.stages >> stage & 1;
        if (!uses && !(stages >> stage & 1)) continue;  // left out anyway
        std::string& names = uses ? used : skipped;
        names += (names.empty() ? "" : ",") + std::string(kStageNames[stage]);
    }
    if (run.settings.stages & ~stages) command += " --use " + used;
    else if (run.settings.stages != stages) command += " --skip " + skipped;
    return command;
}

}  // namespace

void forEach(size_t count, uint32_t threads, const std::function<void(size_t)>& work) {
    shareOut(count, threads, nullptr, [&](uint32_t) { return work; });
}

void prepareLods(Scene& scene, const RunOptions& options) {
    if (!(options.settings.stages & stageBit(Stage::kLod))) return;
    if (const uint32_t taken = takeNamedLevels(scene))
        tell(stderr, fmt::format("{}: {} by their names levels of detail of others\n", oneLine(scene.name),
                                 taken == 1 ? "1 object is" : grouped(taken) + " objects are"));
    joinLevels(scene);
    Progress progress("simplifying", "meshes", scene.meshes.size());
    forEach(scene.meshes.size(), options.threads, [&](size_t i) {
        const PreparedMesh* before =
            options.opened && !options.opened->of_mesh.empty() ? options.opened->of_mesh[i] : nullptr;
        const bool known = before && !before->lods.levels.empty() && scene.meshes[i].lods.empty();
        if (!known || !setMeshLods(scene.meshes[i], before->lods)) addMeshLods(scene.meshes[i]);
        progress.step();
    });
}

CullRun newRun(const Scene& scene, const std::vector<uint32_t>& key_order, const CameraPath& path,
               const RunOptions& options) {
    CullRun run;
    run.scene = options.scene.title();
    run.objects = countKeys(scene, key_order);
    run.instances = scene.objects.size();
    run.triangles = drawnTriangles(scene);
    run.width = options.width;
    run.height = options.height;
    run.jitter = options.jitter;
    run.sections = options.sections;
    run.stereo = options.stereo;
    run.frames.resize(path.frames.size());
    for (size_t i = 0; i < path.frames.size(); ++i) run.frames[i].camera = path.frames[i];
    return run;
}

CullRun cullPath(const Scene& scene, const CameraPath& path, const RunOptions& options,
                 std::optional<LoadedWorld>* world, const FrameHook& answered) {
    const std::vector<uint32_t> key_order = orderByKey(scene);
    CullRun run = newRun(scene, key_order, path, options);
    run.settings = options.settings;
    run.visibility = options.visibility;
    run.cluster_test = options.cluster_test;
    if (run.settings.stages & stageBit(Stage::kLod) && !path.frames.empty())
        run.corner_stretch = cornerStretch(viewOf(path.frames[0], run));
    run.repeat = options.repeat;
    if (options.certificates) run.scene_hash = fmt::format("{:016x}", bake::hashOf(scene));

    LoadedWorld loaded = [&] {
        Progress progress("preparing", "meshes", scene.meshes.size());
        return loadWorld(
            scene, [&](size_t done, size_t total) { progress.set(done, total); }, loadSettingsOf(options));
    }();
    attachVisibility(options, loaded.world);
    const Snapshot now = loaded.world.commit();

    std::vector<double> weights;
    if (options.credits)
        for (const SceneObject& object : scene.objects)
            weights.push_back(static_cast<double>(scene.meshes[object.mesh].triangles()));

    stopGently();
    Progress progress("culling", "frames", path.frames.size());
    const auto begin = std::chrono::steady_clock::now();
    const auto since = [&] {
        return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count();
    };
    const uint32_t threads = run.settings.stateless ? options.threads : 1;  // what remembers is asked in order
    const size_t done = shareOut(path.frames.size(), threads, interrupted, [&](uint32_t thread) {
        const auto answerer = std::make_shared<Answerer>(options.query_threads);
        if (options.credits) answerer->book.emplace(now, weights);
        if (options.propose) answerer->proposer.emplace(scene, loaded.ids);
        if (options.taught) answerer->teacher.emplace();
        return [&, thread, answerer](size_t i) {
            FrameResult& frame = run.frames[i];
            frame = FrameResult();
            frame.thread = thread;
            frame.begin_microseconds = since();
            frame.camera = path.frames[i];
            cullFrame(now, run, i > 0 ? &path.frames[i - 1] : nullptr, answerer->query, frame);
            countByKey(scene, key_order, run.settings.stages, frame);
            if (answered) answered(i, answerer->query);
            if (options.certificates) frame.certificates = certificatesOf(answerer->query, loaded.ids, frame.reasons);
            frame.end_microseconds = since();
            if (answerer->proposer)
                answerer->proposer->propose(viewOf(frame.camera, run), frame.reasons, answerer->query);
            if (answerer->teacher) {
                answerer->teacher->visible(now, viewOf(frame.camera, run), run.settings);
                answerer->query.learn(*answerer->teacher);
            }
            FrameResult alone;
            alone.reasons = reasonsOfFrustum(now, run, frame.camera, answerer->of_frustum);
            countByKey(scene, key_order, stageBit(Stage::kFrustum), alone);
            frame.frustum_alone = {alone.visible.size(), alone.triangles};
            if (answerer->book) creditFrame(run, *answerer->book, frame);
            progress.step();
        };
    });
    run.frames_wanted = path.frames.size();
    run.interrupted = done < path.frames.size();
    run.frames.resize(done);
    if (world) world->emplace(std::move(loaded));
    return run;
}

void verifyPath(const Scene& scene, const RunOptions& options, CullRun& run) {
    WitnessSettings settings;
    settings.rays = options.rays;
    settings.aimed_rays = std::min(settings.aimed_rays, options.rays / 5);
    settings.prove = !options.no_proofs;
    settings.stop = interrupted;
    settings.lines_are_hidden = options.lines_are_hidden;
    if (interrupted()) return;
    const Witness witness(scene);
    Progress progress("verifying", "frames", run.frames.size());
    const Worker judge = [&](size_t i) {
        FrameResult& frame = run.frames[i];
        if (frame.reasons.empty() && !scene.objects.empty()) return;
        const FrameVerdict verdict = judgeFrame(witness, run, frame, settings);
        if (verdict.stopped && verdict.false_culls.empty()) return;  // it was not judged; what was found is found
        frame.verification = rowOf(verdict, frame, scene, run);
        progress.step();
    };
    shareOut(run.frames.size(), options.threads, interrupted, [&](uint32_t) { return judge; });
}

void countChanges(const Scene& scene, const RunOptions& options, CullRun& run) {
    if (!lossyStages(run) || interrupted()) return;
    const SceneFacts facts(scene);
    Progress progress("comparing", "frames", run.frames.size());
    forEach(run.frames.size(), options.threads, [&](size_t i) {
        FrameResult& frame = run.frames[i];
        const View view = viewOf(frame.camera, run);
        const std::vector<uint8_t>& reasons = frame.eye_reasons[0].empty() ? frame.reasons : frame.eye_reasons[0];
        if (!isUsable(view)) frame.changed_pixels = 0;
        if (frame.changed_pixels || interrupted()) return;
        std::vector<Drawn> drawn(reasons.size());
        for (size_t object = 0; object < reasons.size(); ++object)
            drawn[object] = reasons[object] == 0            ? Drawn::kAlways
                            : isLossy(reasons[object], run) ? Drawn::kFullOnly
                                                            : Drawn::kNever;
        frame.changed_pixels = countChangedPixels(facts, view, drawn, frame.lods);
        progress.step();
    });
}

size_t judgedFrames(const CullRun& run) {
    const auto judged = [](const FrameResult& frame) { return frame.verification.has_value(); };
    return static_cast<size_t>(std::count_if(run.frames.begin(), run.frames.end(), judged));
}

int exitCodeOf(const CullRun& run, size_t frames, bool verify) {
    const size_t judged = judgedFrames(run), culled = run.frames.size();
    int exit_code = kDone;
    if (culled < frames || (verify && judged < culled)) {
        std::string done = fmt::format("{} of {} frames", culled, frames);
        if (verify && culled > 0) done += fmt::format(", {} of them verified", judged);
        exit_code = reportInterruption(done, culled > 0);
    }
    const auto sum = sumVerification(run);
    return sum && sum->false_culls > 0 ? kAnswerIsNo : exit_code;
}

void tellFalseCulls(const Scene& scene, const CullRun& run) {
    constexpr size_t kMostLines = 20;  // a frame
    std::string text;
    for (size_t i = 0; i < run.frames.size(); ++i) {
        if (!run.frames[i].verification) continue;
        const auto& rows = run.frames[i].verification->rows;
        for (size_t k = 0; k < std::min(rows.size(), kMostLines); ++k) {
            text += fmt::format("false cull: frame {}: object {} \"{}\" is seen at pixel ({:.3f}, {:.3f}) by {}", i,
                                rows[k].key, oneLine(objectPath(scene, scene.objects[rows[k].object]), 200), rows[k].x,
                                rows[k].y, rows[k].witness);
            text += rows[k].pixels ? fmt::format("; {} show it\n", counted(*rows[k].pixels, "pixel")) : "\n";
        }
        if (rows.size() > kMostLines)
            text += fmt::format("false cull: frame {}: and {} more\n", i, rows.size() - kMostLines);
    }
    (void)std::fwrite(text.data(), 1, text.size(), stderr);
}

Status explainFalseCulls(const Scene& scene, const RunOptions& options, const CullRun& run) {
    const auto is_wrong = [](const FrameResult& frame) {
        return frame.verification && !frame.verification->rows.empty();
    };
    // A query that remembers is asked all frames before this one; with hysteresis alone, the frame before.
    const bool remembers = !run.settings.stateless, looks_back = run.settings.hysteresis > 0;
    CameraPath path;
    size_t taken = 0;  // of the run's frames
    for (size_t i = 0; i < run.frames.size(); ++i) {
        if (!is_wrong(run.frames[i])) continue;
        const size_t first = remembers ? 0 : looks_back && i > 0 ? i - 1 : i;
        for (size_t k = std::max(first, taken); k <= i; ++k) path.frames.push_back(run.frames[k].camera);
        taken = i + 1;
    }
    if (path.frames.empty()) return success();
    const std::string file = directoryOfOutputs(options) + "replay-frames.json";
    if (Status written = writeFileAside(file, cameraPathJson(path)); !written) return written;
    tellFalseCulls(scene, run);
    const std::string line = fmt::format("replay: {}\n", replayCommand(options, run, file));
    (void)std::fwrite(line.data(), 1, line.size(), stderr);
    return success();
}

}  // namespace sightline::cli
