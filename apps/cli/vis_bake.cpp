// SPDX-License-Identifier: MIT
#include "apps/cli/vis_bake.h"

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "apps/cli/progress.h"
#include "apps/cli/session.h"
#include "sightline/bake/bake_state.h"
#include "sightline/report/output_file.h"
#include "sightline/scene/text_file.h"

namespace sightline::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kSecondsBetweenStates = 10;
constexpr size_t kProgressParts = 100;

/// The state that was left by an earlier run, if it is one of this bake.
Result<std::optional<CellVisibilityState>> stateLeft(const CellGraph& graph, const VisBakeOptions& options) {
    std::error_code error;
    std::optional<CellVisibilityState> state_left;
    if (options.state.empty() || !std::filesystem::is_regular_file(options.state, error)) return state_left;
    const Result<std::string> bytes = readTextFile(options.state, size_t(1) << 36);
    if (!bytes) {
        note(bytes.error().message + ": the bake begins anew");
        return state_left;
    }
    Result<CellVisibilityState> state = readBakeState(*bytes, options.state, graph, options.budget);
    if (!state && !isBakeState(*bytes))
        return Error{Error::Kind::kOutput, options.state + ": holds something else than the state of a bake"};
    if (!state) {
        note(state.error().message + ": the bake begins anew");
        return state_left;
    }
    note("goes on from " + options.state);
    state_left = std::move(*state);
    return state_left;
}

}  // namespace

Result<CellVisibility> bakeVis(const CellGraph& graph, const VisBakeOptions& options, Jobs& jobs) {
    stopGently();
    Result<std::optional<CellVisibilityState>> found = stateLeft(graph, options);
    if (!found) return found.error();
    std::optional<CellVisibilityState>& left = *found;
    const Clock::time_point begin = Clock::now();
    const auto secondsSince = [](Clock::time_point then) {
        return std::chrono::duration<double>(Clock::now() - then).count();
    };
    Clock::time_point saved = begin;
    Status failed = success();
    std::unique_ptr<Progress> progress;
    std::string step;

    CellVisibilitySettings settings;
    settings.jobs = &jobs;
    settings.budget = options.budget;
    settings.keep_follows = options.keep_follows;
    settings.resume = left ? &*left : nullptr;
    settings.stop = [&] {
        return !failed || interrupted() || (options.time_limit > 0 && secondsSince(begin) > options.time_limit);
    };
    settings.progress = [&](const BakeProgress& now) {
        if (!progress || step != now.step) {
            step = now.step;
            progress.reset();
            progress = std::make_unique<Progress>("visibility, " + step, "percent", kProgressParts);
        }
        progress->set(static_cast<size_t>(now.done * static_cast<double>(kProgressParts)), kProgressParts);
    };
    settings.checkpoint = [&](const CellVisibilityState& state) {
        if (options.state.empty() || state.flowed == state.order.size()) return;
        if (!interrupted() && secondsSince(saved) < kSecondsBetweenStates) return;
        if (Status written = writeFileAside(options.state, bakeStateBytes(state, hashOf(graph), options.budget));
            !written)
            failed = written;
        saved = Clock::now();
    };
    CellVisibility visibility = bakeCellVisibility(graph, settings);
    if (!failed) return failed.error();
    return visibility;
}

void removeBakeState(const VisBakeOptions& options) {
    std::error_code ignored;
    if (!options.state.empty()) std::filesystem::remove(options.state, ignored);
}

}  // namespace sightline::cli
