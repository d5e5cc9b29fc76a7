// A bake as the tool runs it: its options, on threads, with progress, and with a state on disk that it goes on from.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "apps/cli/shell/options.h"
#include "apps/cli/shell/apart.h"
#include "apps/cli/shell/progress.h"
#include "apps/cli/verbs/vis_map.h"
#include "sightline/bake/bake.h"
#include "sightline/base/result.h"
#include "sightline/base/thread_pool.h"

namespace sightline::cli {
using namespace bake;

struct BakeOptions {
    std::string output, json, report;  ///< empty: not written
    std::string cells;                 ///< empty: not given
    std::string state;                 ///< file; empty: finish() names it after the output, if there is one
    uint32_t threads = 0;              ///< 0: all cores
    std::optional<uint64_t> budget;    ///< BakeSettings; 0: no limit; none given: kUsualWork bounds the whole bake
    double time_limit = 0;             ///< BakeSettings  [s]
    double farthest = 0;               ///< BakeSettings  [world units]
    bool in_place = false, objects = false;
    std::vector<std::string> prepare;  ///< what the file holds of meshes, too
};

/// What --cells says of a .bsp.
VisCells visCellsOf(const std::string& word);

/// @param output     what `-o` writes
/// @param of_scenes  scenes are baked as well as maps
void addBakeOptions(Command& verb, BakeOptions& options, const std::string& output, bool of_scenes = false);

/// Names the state, and checks that what is written is apart from what is read and can be written.
/// @param files  what is read, and what else the verb writes. Errors: kUsage, kOutput.
Status finishBakeOptions(BakeOptions& options, ApartFiles& files);

/// A bake on threads. From its beginning on Ctrl-C stops it gently, and the state is there for the next time.
class BakeRun {
public:
    /// @param options  must outlive this
    explicit BakeRun(const BakeOptions& options);

    /// Before view cells are divided: what an earlier run left of them in the state's file. From here on Ctrl-C stops gently.
    /// Errors: the file holds something else than a state.
    Result<RowJournal*> beginViewCells();
    /// The settings of the bake; it goes on from the state's file if there is one of this graph and budget. Errors: as
    /// above.
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
    std::optional<RowJournal> journal_;
    std::string step_;
    std::unique_ptr<Progress> progress_;
};

/// What the rows cannot be baked for, with what would help. Errors: of checkBakeSize().
/// @param of_bsp  then --cells may make fewer portals
Status checkSize(const CellGraph& rows, const std::string& title, bool of_bsp);

}  // namespace sightline::cli
