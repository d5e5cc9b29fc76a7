// What `cull` writes of the occlusion buffer: pictures of it, and a recording of what one frame asked of it.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "apps/cli/verbs/common.h"
#include "sightline/query/query.h"
#include "sightline/tools/report/pictures/png.h"
#include "sightline/tools/report/run/cull_run.h"

namespace sightline::cli {
using namespace tools;

/// The picture of the buffer that a frame's query leaves, all shared pixels resolved.
Image<Rgb> bufferPicture(const Snapshot& now, const View& view, const QuerySettings& settings);

/// Writes occlusion-0000.png and so on into a directory, one for each frame of the run. Interrupted, the first ones.
Status writeDepthImages(const Snapshot& now, const CullRun& run, const RunOptions& options,
                        const std::string& directory);

/// Writes what a frame asks of its occlusion buffer, for `sightline replay`.
Status writeRecordingOf(const Snapshot& now, const View& view, const QuerySettings& settings, const std::string& file);

}  // namespace sightline::cli
