// The verb `replay`: a recorded frame asked again: the same answer, how long it takes, and whether it is right.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <hwy/targets.h>
#include <nlohmann/json.hpp>

#include "apps/cli/shell/other_verbs.h"
#include "apps/cli/shell/apart.h"
#include "apps/cli/shell/progress.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/verbs.h"
#include "sightline/buffer/depth_image.h"
#include "sightline/query/record/frame_replay.h"
#include "sightline/query/record/occlusion_replay.h"
#include "sightline/tools/load/recorded_scene.h"
#include "sightline/tools/report/output_file.h"
#include "sightline/tools/report/pictures/depth_picture.h"
#include "sightline/tools/report/run/cull_run.h"
#include "sightline/tools/scene/json_text.h"
#include "sightline/tools/scene/one_line.h"
#include "sightline/tools/scene/text_file.h"
#include "sightline/tools/truth/verify.h"

namespace sightline::cli {
using namespace tools;
namespace {

struct ReplayOptions {
    std::string file, json, image, target;
    int repeat = 25;
    bool verify = false;
    uint64_t rays = 1000000;
};

/// An object that is answered otherwise now than when the frame was recorded.
struct Changed {
    uint32_t object = 0;
    bool kept = false;  ///< now
};

/// What the replays gave.
struct ReplayRun {
    FrameReplay::Answer answer;
    std::vector<uint8_t> reasons;
    std::vector<Changed> changed;
    std::string target;
    uint64_t bytes = 0;
    uint32_t width = 0, height = 0;                ///< of the buffer; 0: nothing was drawn
    uint64_t draws = 0, triangles = 0, tests = 0;  ///< of the buffer
    double query = 0, draw = 0, test = 0;          ///< medians [microseconds]
    std::optional<FrameVerdict> recorded, again;   ///< of both answers
};

/// The instruction sets that this machine has and the tool was built for, the best first.
std::vector<int64_t> targetsHere() {
    std::vector<int64_t> targets;
    for (int64_t left = hwy::SupportedTargets(); left; left &= left - 1) targets.push_back(left & -left);
    return targets;
}

/// Puts the instruction set in force; an empty name is the best.
Result<std::string> choose(const std::string& name) {
    std::string names;
    for (const int64_t target : targetsHere()) {
        const std::string here = hwy::TargetName(target);
        names += (names.empty() ? "" : ", ") + here;
        if (!name.empty() && lower(here) != lower(name)) continue;
        if (!name.empty()) hwy::SetSupportedTargetsForTest(target);
        return here;
    }
    return Error{Error::Kind::kUsage,
                 fmt::format("--target: there is no instruction set \"{}\" here (there are: {})", name, names)};
}

uint64_t keptOf(std::span<const uint8_t> reasons) {
    return static_cast<uint64_t>(std::count(reasons.begin(), reasons.end(), uint8_t{0}));
}

/// The frame asked so often, and the times. Interrupted, there are fewer, or none.
/// @returns how often it was asked
int timeQuery(const FrameRecording& recording, FrameReplay& replay, int repeat, ReplayRun& run) {
    std::vector<double> times;
    Progress progress("replaying", "times", static_cast<size_t>(repeat));
    for (int i = 0; i < repeat && !interrupted(); ++i) {
        const FrameReplay::Answer answer = replay.run();
        if (i == 0 || !answer.same()) run.answer = answer;
        times.push_back(1e-3 * static_cast<double>(answer.stats.nanoseconds));
        progress.step();
    }
    run.reasons.assign(replay.reasons().begin(), replay.reasons().end());
    for (uint32_t i = 0; i < run.reasons.size(); ++i)
        if ((run.reasons[i] == 0) != (recording.reasons[i] == 0)) run.changed.push_back({i, run.reasons[i] == 0});
    run.query = medianOf(times);
    return static_cast<int>(times.size());
}

/// What the query does to its buffer, done by itself: drawing and asking apart.
void timeBuffer(OcclusionReplay& replay, const OcclusionRecording& calls, int repeat, ReplayRun& run) {
    std::vector<double> draw, test;
    for (int i = 0; i < repeat && !interrupted(); ++i) {
        // Side by side, so that the tests' share is a difference of neighbours.
        const double drawn = 1e-3 * static_cast<double>(replay.draw());
        const ReplayAnswer answer = replay.run();
        run.triangles = answer.triangles;
        draw.push_back(drawn);
        test.push_back(std::max(1e-3 * static_cast<double>(answer.nanoseconds) - drawn, 0.0));  // noise
    }
    run.draws = calls.draws.size();
    run.tests = calls.asked.rects.size() + calls.asked.tiles.size();
    run.draw = medianOf(std::move(draw));
    run.test = medianOf(std::move(test));
    run.width = replay.screen().width;
    run.height = replay.screen().height;
}

/// What rays, samples and exact proofs say of an answer; stages that cull what may be visible are not judged.
FrameVerdict judge(const Witness& witness, const View& view, std::span<const uint8_t> reasons, uint64_t rays) {
    std::vector<uint8_t> culled(reasons.begin(), reasons.end());
    for (uint8_t& reason : culled)
        if (reason > kStageCount || (reason > 0 && (kLossyStages >> (reason - 1) & 1))) reason = 0;
    WitnessSettings settings;
    settings.rays = rays;
    settings.aimed_rays = std::min(settings.aimed_rays, rays / 5);
    settings.prove = true;
    return witness.judge(view, culled, settings);
}

std::string textOf(const ReplayRun& run, const FrameRecording& recording, const ReplayOptions& options) {
    std::string text =
        fmt::format("{}: {} bytes; {} objects, viewport {}x{}\n", oneLine(options.file), grouped(run.bytes),
                    grouped(recording.objects.size()), recording.view.width, recording.view.height);
    const auto kept_now = static_cast<size_t>(
        std::count_if(run.changed.begin(), run.changed.end(), [](const Changed& one) { return one.kept; }));
    const auto answer = [&](const char* name, std::span<const uint8_t> reasons, const std::string& of_kept,
                            const std::string& of_culled) {
        const uint64_t kept = keptOf(reasons);
        text += fmt::format("{:<12} {:>10}  kept{}; {} culled, {}\n", name, grouped(kept), of_kept,
                            grouped(reasons.size() - kept), of_culled);
    };
    answer("recorded", recording.reasons, "",
           fmt::format("{} of which by certificates", grouped(recording.certificates.size())));
    answer("again", run.reasons, fmt::format(", {} of which were culled", grouped(kept_now)),
           fmt::format("{} of which were kept", grouped(run.changed.size() - kept_now)));
    text += fmt::format("query        {:>10.1f}  us, median of {}, on {}\n", run.query, options.repeat, run.target);
    const auto each = [](double microseconds, uint64_t count) {
        return count > 0 ? fmt::format("{:.1f} ns each", 1e3 * microseconds / static_cast<double>(count)) : "none";
    };
    if (run.width > 0) {
        text += fmt::format("draws        {:>10}  {} triangles, {:>9.1f} us, {}; buffer {}x{}\n", grouped(run.draws),
                            grouped(run.triangles), run.draw, each(run.draw, run.draws), run.width, run.height);
        text += fmt::format("tests        {:>10}  {:>9.1f} us, {}\n", grouped(run.tests), run.test,
                            each(run.test, run.tests));
    }
    if (run.again)
        text += fmt::format("verified     {:>10}  false culls as recorded, {} again; {} rays\n",
                            run.recorded->false_culls.size(), run.again->false_culls.size(),
                            grouped(run.recorded->rays + run.again->rays));
    return text;
}

nlohmann::ordered_json falseCullsOf(const FrameVerdict& verdict, const FrameRecording& recording) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const FalseCull& cull : verdict.false_culls)
        rows.push_back({{"object", cull.object},
                        {"key", recording.objects[cull.object].key},
                        {"pixel", {cull.x, cull.y}},
                        {"witness", cull.witness}});
    return rows;
}

std::string jsonOf(const ReplayRun& run, const FrameRecording& recording, const ReplayOptions& options) {
    nlohmann::ordered_json json;
    json["schema"] = "sightline.replay/2";
    json["file"] = options.file;
    json["bytes"] = run.bytes;
    json["width"] = recording.view.width;
    json["height"] = recording.view.height;
    json["objects"] = recording.objects.size();
    json["recorded"] = {{"kept", keptOf(recording.reasons)}, {"certificates", recording.certificates.size()}};
    json["again"] = {{"kept", keptOf(run.reasons)}};
    nlohmann::ordered_json& changed = json["changed"] = nlohmann::ordered_json::array();
    for (const Changed& one : run.changed)
        changed.push_back({{"object", one.object}, {"key", recording.objects[one.object].key}, {"kept", one.kept}});
    json["instruction_set"] = run.target;
    json["repeat"] = options.repeat;
    json["microseconds"] = run.query;
    if (run.width > 0)
        json["buffer"] = {{"size", {run.width, run.height}}, {"draws", run.draws},
                          {"triangles", run.triangles},      {"tests", run.tests},
                          {"draw_microseconds", run.draw},   {"test_microseconds", run.test}};
    json["same"] = run.answer.same();
    json["differences"] = run.answer.differences;
    if (run.again)
        json["verification"] = {{"rays", run.recorded->rays + run.again->rays},
                                {"recorded", falseCullsOf(*run.recorded, recording)},
                                {"again", falseCullsOf(*run.again, recording)}};
    return jsonText(json, 2) + "\n";
}

Status writeImage(OcclusionReplay& replay, const std::string& file) {
    DepthTiles& tiles = replay.tiles();
    std::vector<float> nearness(size_t{tiles.width} * tiles.height);
    std::vector<uint8_t> covered(nearness.size());
    readDepthImage(tiles, Seams::kResolve, nearness, covered, 0.0f);
    return writeFileAside(
        file,
        encodePalettePng(depthPicture({tiles.width, tiles.height, replay.screen().perspective, nearness, covered})));
}

Status checkReplayFiles(const ReplayOptions& options) {
    ApartFiles files;
    files.read("FILE", options.file);
    files.write("--json", options.json);
    files.write("--image", options.image);
    if (!files.status()) return files.status();
    return canWriteFiles({options.json, options.image});
}

void tellFaults(const ReplayRun& run, const FrameRecording& recording, const ReplayOptions& options) {
    constexpr size_t kMostCulls = 20;  // of an answer
    const auto say = [&](const std::string& what) {
        const std::string line = fmt::format("{}: {}\n", oneLine(options.file), what);
        (void)std::fwrite(line.data(), 1, line.size(), stderr);
    };
    if (!run.answer.same())
        say(fmt::format(
            "{} of {} objects are answered otherwise than on the machine that recorded it; the first has key {}",
            run.answer.differences, recording.objects.size(), recording.objects[run.answer.different].key));
    for (const auto& [verdict, when] : {std::pair{&run.recorded, "when it was recorded"}, {&run.again, "again"}}) {
        if (!*verdict) continue;
        const auto& culls = (*verdict)->false_culls;
        for (size_t i = 0; i < std::min(culls.size(), kMostCulls); ++i)
            say(fmt::format("false cull, {}: the object with key {} is seen at pixel ({:.3f}, {:.3f}) by {}", when,
                            recording.objects[culls[i].object].key, culls[i].x, culls[i].y, culls[i].witness));
        if (culls.size() > kMostCulls) say(fmt::format("and {} more", culls.size() - kMostCulls));
    }
}

Result<int> runReplay(const Command& verb, const ReplayOptions& options) {
    if (verb.count("--rays") > 0 && !options.verify) return usageError("--rays goes with --verify");
    const Result<std::string> target = choose(options.target);
    if (!target) return target.error();
    const Result<std::string> bytes = readTextFile(options.file);
    if (!bytes) return bytes.error();
    const Result<FrameRecording> recording = parseRecording(*bytes, options.file);
    if (!recording) return recording.error();
    const bool draws = stagesInUse(recording->view, recording->settings) & stageBit(Stage::kOcclusion);
    if (!draws && !options.image.empty()) return usageError("--image: the recorded query has no occlusion stage");
    if (Status good = checkReplayFiles(options); !good) return good.error();
    stopGently();
    ReplayRun run;
    run.target = *target;
    run.bytes = bytes->size();
    FrameReplay replay(*recording);
    if (timeQuery(*recording, replay, options.repeat, run) == 0) return reportInterruption("no replay", false);
    std::optional<OcclusionRecording> calls;
    std::optional<OcclusionReplay> buffer;
    if (draws) {
        Result<OcclusionRecording> made = recordOcclusion(replay.snapshot(), recording->view, replay.settings());
        if (!made) return made.error();
        buffer.emplace(calls.emplace(std::move(*made)));
        timeBuffer(*buffer, *calls, options.repeat, run);
    }
    if (options.verify && !interrupted()) {
        const Scene scene = recordedScene(*recording);
        const Witness witness(scene);
        run.recorded = judge(witness, recording->view, recording->reasons, options.rays);
        run.again = judge(witness, recording->view, run.reasons, options.rays);
    }
    tell(options.json == "-" ? stderr : stdout, textOf(run, *recording, options));
    tellFaults(run, *recording, options);
    if (!options.json.empty())
        if (Status written = writeText(options.json, jsonOf(run, *recording, options)); !written)
            return written.error();
    if (!options.image.empty())
        if (Status written = writeImage(*buffer, options.image); !written) return written.error();
    const bool sound = !run.again || (run.recorded->false_culls.empty() && run.again->false_culls.empty());
    return run.answer.same() && sound ? kDone : kAnswerIsNo;
}

}  // namespace

void addReplay(Command& tool, int& exit_code) {
    Command verb = addOtherVerb(tool, "replay");
    const auto options = std::make_shared<ReplayOptions>();
    verb->add_option("FILE", options->file, "of cull --record, or of an engine")->required();
    verb->add_option("--repeat", options->repeat, "times are medians of so many")
        ->check(Range{1, 100000})
        ->type_name("N")
        ->capture_default_str();
    verb->add_option("--target", options->target, "the instruction set to use, as AVX2 or SCALAR (default: the best)")
        ->type_name("NAME");
    verb->add_flag("--verify", options->verify,
                   "let rays, an id-buffer and exact proofs judge the recorded answer and the new one; exit code 1 if "
                   "anything visible was culled");
    verb->add_option("--rays", options->rays, "for each answer, with --verify")
        ->check(Range{uint64_t{1}, uint64_t{1} << 40})
        ->type_name("N")
        ->capture_default_str();
    verb->add_option("--json", options->json, "write the result as JSON (-: standard output)")->type_name("FILE");
    verb->add_option("--image", options->image, "draw the buffer: light is near, dark is far, blue is open")
        ->type_name("FILE.png");
    verb->callback([verb, options, &exit_code] {
        const Result<int> done = runReplay(*verb, *options);
        exit_code = done ? *done : report(done.error());
    });
}

}  // namespace sightline::cli
