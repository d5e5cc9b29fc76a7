// A bake as the tool runs it: on threads, with progress, and with a state on disk that it goes on from.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "apps/cli/shell/progress.h"
#include "apps/cli/verbs/bake_options.h"
#include "sightline/bake/bake.h"
#include "sightline/base/thread_pool.h"

namespace sightline::cli {
using namespace bake;

/// From here on Ctrl-C stops the bake gently, and the state is there for the next time.
class BakeRun {
public:
    /// @param options  must outlive this
    explicit BakeRun(const BakeOptions& options);

    /// The settings of the bake; it goes on from the state's file if there is one of this graph and budget. Errors: the
    /// file holds something else than a state.
    Result<BakeSettings> begin(const CellGraph& rows);
    /// Says that the bake was interrupted. @return the exit code
    int reportInterrupted();
    /// Clears the progress and removes the state: the result is written.
    void end();

    uint32_t threads() const { return threads_; }
    Jobs& jobs() { return pool_; }

private:
    void show(const BakeProgress& now);

    const BakeOptions& options_;
    uint32_t threads_;
    ThreadPool pool_;
    std::optional<CellVisibilityState> left_;
    std::string step_;
    std::unique_ptr<Progress> progress_;
};

/// What the rows cannot be baked for, with what would help. Errors: of checkBakeSize().
/// @param of_bsp  then --cells may make fewer portals
Status checkSize(const CellGraph& rows, const std::string& title, bool of_bsp);

}  // namespace sightline::cli
