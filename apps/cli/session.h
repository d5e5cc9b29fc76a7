// What holds for a whole run of the tool: how much it says, where to, and whether it is to stop.
// SPDX-License-Identifier: MIT
#pragma once

namespace sightline::cli {

/// True once Ctrl-C was pressed, or the process asked to end: loops over frames stop and leave what is finished.
bool interrupted();

/// True with --quiet: no progress and no summaries; errors, and what was asked for on standard output, remain.
bool quiet();

}  // namespace sightline::cli
