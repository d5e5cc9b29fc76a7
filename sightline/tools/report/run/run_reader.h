// Reads what `cull --json` wrote: the schema sightline.cull/1, from a stranger's file.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sightline/base/result.h"
#include "sightline/tools/report/run/cull_run.h"

namespace sightline::tools {

/// A run as its file holds it: without what culled each single object.
struct RunFile {
    std::string file;            ///< that it was read from
    std::string directory;       ///< with a slash; where pictures of the run may lie; empty: nowhere
    CullRun run;                 ///< FrameResult::reasons are empty
    std::vector<KeyName> names;  ///< ascending; of every key that the run speaks of. An `object` of the run's rows, and
                                 ///< VerificationRow::kept_unseen, are places in this list

    /// "Level 1/Door", or "object 7".
    std::string labelOf(uint64_t key) const;
};

/// Fields that are not known are passed over; those added to the schema after its first release may be missing.
/// Errors (kInput) name the file and the place: "run.json: frames[3].visible[7]: not a whole number".
Result<RunFile> parseRun(std::string_view text, const std::string& file);

/// A file, or a report's directory with a cull.json in it.
Result<RunFile> readRun(const std::string& path);

}  // namespace sightline::tools
