// The options of distance and contribution culling, and what these cost in a run's pictures.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/size_options.h"

#include <algorithm>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/cli/verbs/setting_options.h"

namespace sightline::cli {
using namespace tools;
namespace {

bool names(const std::vector<std::string>& list, Stage stage) {
    return std::find(list.begin(), list.end(), kStageNames[static_cast<int>(stage)]) != list.end();
}

}  // namespace

void addSizeOptions(CLI::App& verb, RunOptions& options) {
    addSettingOptions(verb, options.settings, {"max_distance", "contribution"});
}

Status finishSizeOptions(RunOptions& options) {
    const auto needs = [](const char* stage) {
        return Error{Error::Kind::kUsage, fmt::format("--use {}: how much is told by --{}", stage, stage)};
    };
    QuerySettings& settings = options.settings;
    if (names(options.use, Stage::kDistance) && !(settings.max_distance > 0)) return needs("distance");
    if (names(options.use, Stage::kContribution) && !(settings.contribution > 0)) return needs("contribution");
    // What was given asks for its stage, and --use lists the others.
    for (const Stage stage : {Stage::kDistance, Stage::kContribution})
        if (!options.use.empty() && !names(options.skip, stage)) settings.stages |= stageBit(stage);
    settings.stages = stagesInUse(View(), settings);
    return success();
}

}  // namespace sightline::cli
