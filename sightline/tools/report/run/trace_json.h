// A run as a timeline that chrome://tracing and Perfetto open: Chrome's trace event format.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sightline/tools/report/run/cull_run.h"

namespace sightline::tools {

/// One track a thread, each frame a slice from its beginning to its end, in it its query, and in that the stages one
/// after the other; counters for kept objects, exactly visible ones and triangles. Times are in microseconds since the
/// run began. The stages are timed in a run of their own: where they sum to more than the query, they are drawn
/// shorter in proportion, and their arguments hold what was measured.
std::string traceJson(const CullRun& run);

}  // namespace sightline::tools
