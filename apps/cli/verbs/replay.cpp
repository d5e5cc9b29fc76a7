// The verb `replay`: a recorded frame's occlusion calls again: the same answers, and how long they take.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <hwy/targets.h>
#include <nlohmann/json.hpp>

#include "apps/cli/shell/apart.h"
#include "apps/cli/shell/progress.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/verbs.h"
#include "sightline/buffer/depth_image.h"
#include "sightline/query/record/occlusion_replay.h"
#include "sightline/tools/report/output_file.h"
#include "sightline/tools/report/pictures/depth_picture.h"
#include "sightline/tools/report/run/cull_run.h"
#include "sightline/tools/scene/one_line.h"
#include "sightline/tools/scene/text_file.h"

namespace sightline::cli {
using namespace tools;
namespace {

struct ReplayOptions {
    std::string file, json, image, target;
    int repeat = 25;
};

/// What the replays gave.
struct ReplayRun {
    ReplayAnswer answer;
    std::string target;
    uint64_t bytes = 0;
    uint32_t width = 0, height = 0;      ///< of the buffer
    double draw = 0, test = 0, all = 0;  ///< medians [microseconds]
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

ReplayRun replay(OcclusionReplay& replay, int repeat) {
    ReplayRun run;
    std::vector<double> draw, test, all;
    Progress progress("replaying", "times", static_cast<size_t>(repeat));
    for (int i = 0; i < repeat && !interrupted(); ++i) {
        // Side by side, so that the tests' share is a difference of neighbours.
        const double drawn = 1e-3 * static_cast<double>(replay.draw());
        const ReplayAnswer answer = replay.run();
        if (i == 0) run.answer = answer;
        draw.push_back(drawn);
        all.push_back(1e-3 * static_cast<double>(answer.nanoseconds));
        test.push_back(std::max(all.back() - drawn, 0.0));  // neighbours that differ by noise alone
        progress.step();
    }
    run.draw = medianOf(draw);
    run.test = medianOf(test);
    run.all = medianOf(all);
    run.width = replay.screen().width;
    run.height = replay.screen().height;
    return run;
}

std::string textOf(const ReplayRun& run, const OcclusionRecording& recording, const ReplayOptions& options) {
    const size_t tests = recording.asked.rects.size() + recording.asked.tiles.size();
    size_t clusters = 0;
    for (const Occluder& occluder : recording.occluders) clusters += occluder.clusters.size();
    std::string text =
        fmt::format("{}: {} bytes; buffer {}x{} for a viewport of {}x{}\n", oneLine(options.file), grouped(run.bytes),
                    run.width, run.height, recording.view.width, recording.view.height);
    text += fmt::format("occluders    {:>10}  with {} clusters, of {} objects\n", grouped(recording.occluders.size()),
                        grouped(clusters), grouped(recording.instances.size()));
    const auto each = [](double microseconds, size_t count) {
        return count > 0 ? fmt::format("{:.1f} ns each", 1e3 * microseconds / static_cast<double>(count)) : "none";
    };
    text += fmt::format("draws        {:>10}  {} triangles, {:>9.1f} us, {}\n", grouped(recording.draws.size()),
                        grouped(run.answer.triangles), run.draw, each(run.draw, recording.draws.size()));
    text += fmt::format("tests        {:>10}  {} rectangles hidden, {:>9.1f} us, {}\n", grouped(tests),
                        grouped(run.answer.hidden), run.test, each(run.test, tests));
    text += fmt::format("all          {:>10.1f} us, median of {}, on {}\n", run.all, options.repeat, run.target);
    return text;
}

std::string jsonOf(const ReplayRun& run, const OcclusionRecording& recording, const ReplayOptions& options) {
    nlohmann::ordered_json json;
    json["schema"] = "sightline.replay/1";
    json["file"] = options.file;
    json["bytes"] = run.bytes;
    json["width"] = recording.view.width;
    json["height"] = recording.view.height;
    json["buffer"] = {run.width, run.height};
    json["occluders"] = recording.occluders.size();
    json["instances"] = recording.instances.size();
    json["draws"] = recording.draws.size();
    json["triangles"] = run.answer.triangles;
    json["rectangle_tests"] = recording.asked.rects.size();
    json["rectangles_hidden"] = run.answer.hidden;
    json["tile_tests"] = recording.asked.tiles.size();
    json["instruction_set"] = run.target;
    json["repeat"] = options.repeat;
    json["draw_microseconds"] = run.draw;
    json["test_microseconds"] = run.test;
    json["microseconds"] = run.all;
    json["same"] = run.answer.same();
    json["differences"] = run.answer.differences;
    if (!run.answer.same())
        json["first_difference"] = {{"call", run.answer.different},
                                    {"recorded", describeTest(recording, run.answer.different)}};
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
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
    for (const std::string& file : {options.json, options.image})
        if (!file.empty() && file != "-")
            if (Status writable = canWriteFile(file); !writable) return writable;
    return success();
}

Result<int> runReplay(const ReplayOptions& options) {
    const Result<std::string> target = choose(options.target);
    if (!target) return target.error();
    const Result<std::string> bytes = readTextFile(options.file);
    if (!bytes) return bytes.error();
    const Result<OcclusionRecording> recording = parseRecording(*bytes, options.file);
    if (!recording) return recording.error();
    if (Status good = checkReplayFiles(options); !good) return good.error();
    stopGently();
    OcclusionReplay again(*recording);
    ReplayRun run = replay(again, options.repeat);
    if (run.width == 0 || interrupted()) return reportInterruption("no replay", false);
    run.target = *target;
    run.bytes = bytes->size();
    tell(options.json == "-" ? stderr : stdout, textOf(run, *recording, options));
    if (!run.answer.same()) {
        const std::string line = fmt::format(
            "{}: {} of {} tests are answered otherwise; the first is call {}, {} in the "
            "recording\n",
            oneLine(options.file), run.answer.differences,
            recording->asked.rects.size() + recording->asked.tiles.size(), run.answer.different,
            describeTest(*recording, run.answer.different));
        (void)std::fwrite(line.data(), 1, line.size(), stderr);
    }
    if (!options.json.empty())
        if (Status written = writeText(options.json, jsonOf(run, *recording, options)); !written)
            return written.error();
    if (!options.image.empty())
        if (Status written = writeImage(again, options.image); !written) return written.error();
    return run.answer.same() ? kDone : kAnswerIsNo;
}

}  // namespace

void addReplay(CLI::App& tool, int& exit_code) {
    CLI::App* verb = tool.add_subcommand("replay", "a recorded frame's occlusion calls again, checked and timed");
    const auto options = std::make_shared<ReplayOptions>();
    verb->add_option("FILE", options->file, "of cull --record-occlusion")->required();
    verb->add_option("--repeat", options->repeat, "times are medians of so many")
        ->check(CLI::Range(1, 100000))
        ->type_name("N")
        ->capture_default_str();
    verb->add_option("--target", options->target, "the instruction set to use, as AVX2 or SCALAR (default: the best)")
        ->type_name("NAME");
    verb->add_option("--json", options->json, "write the result as JSON (-: standard output)")->type_name("FILE");
    verb->add_option("--image", options->image, "draw the buffer: light is near, dark is far, blue is open")
        ->type_name("FILE.png");
    verb->callback([options, &exit_code] {
        const Result<int> done = runReplay(*options);
        exit_code = done ? *done : report(done.error());
    });
}

}  // namespace sightline::cli
