// The options of distance and contribution culling, and what these cost in a run's pictures.
// SPDX-License-Identifier: MIT
#include "apps/cli/size_options.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/cli/cull_frame.h"
#include "apps/cli/cull_path.h"
#include "apps/cli/progress.h"
#include "apps/cli/session.h"
#include "sightline/truth/changed_pixels.h"

namespace sightline::cli {
namespace {

/// Reads "2px" or "2".
void readContribution(std::string text, RunOptions& options) {
    const std::string given = text;
    if (text.size() > 2 && text.ends_with("px")) text.resize(text.size() - 2);
    double radius = 0;
    if (!CLI::detail::lexical_cast(text, radius) || !(radius > 0.0 && radius <= 16384.0))
        throw CLI::ValidationError("--contribution", "wants pixels, above 0 and up to 16384, not '" + given + "'");
    options.contribution = radius;
}

void readDistance(const std::string& text, RunOptions& options) {
    double distance = 0;
    if (!CLI::detail::lexical_cast(text, distance) || !(distance > 0.0) || std::isinf(distance))
        throw CLI::ValidationError("--distance", "wants a distance above 0, not '" + text + "'");
    options.max_distance = distance;
}

bool names(const std::vector<std::string>& list, Stage stage) {
    return std::find(list.begin(), list.end(), kStageNames[static_cast<int>(stage)]) != list.end();
}

}  // namespace

void addSizeOptions(CLI::App& verb, RunOptions& options) {
    verb.add_option_function<std::string>(
            "--distance", [&options](const std::string& text) { readDistance(text, options); },
            "cull what is wholly farther away, although it may be visible [world units]")
        ->type_name("D")
        ->group("Culling");
    verb.add_option_function<std::string>(
            "--contribution", [&options](const std::string& text) { readContribution(text, options); },
            "cull what looks smaller than a disk of this radius, as 2px, although it may be visible; the pixels that "
            "change are counted")
        ->type_name("PX")
        ->group("Culling");
}

Status finishSizeOptions(RunOptions& options) {
    const auto needs = [](const char* stage) {
        return Error{Error::Kind::kUsage, fmt::format("--use {}: how much is told by --{}", stage, stage)};
    };
    if (names(options.use, Stage::kDistance) && !(options.max_distance > 0)) return needs("distance");
    if (names(options.use, Stage::kContribution) && !(options.contribution > 0)) return needs("contribution");
    View view;
    // What was given asks for its stage, and --use lists the others.
    view.stages = options.stages;
    if (!options.use.empty() && !names(options.skip, Stage::kDistance)) view.stages |= stageBit(Stage::kDistance);
    if (!options.use.empty() && !names(options.skip, Stage::kContribution))
        view.stages |= stageBit(Stage::kContribution);
    view.max_distance = options.max_distance;
    view.contribution = options.contribution;
    options.stages = stagesInUse(view);
    return success();
}

std::string sizeOptionsOf(double max_distance, double contribution) {
    std::string words;
    if (max_distance > 0) words += fmt::format(" --distance {}", max_distance);
    if (contribution > 0) words += fmt::format(" --contribution {}px", contribution);
    return words;
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
        frame.changed_pixels = countChangedPixels(facts, view, drawn);
        progress.step();
    });
}

}  // namespace sightline::cli
