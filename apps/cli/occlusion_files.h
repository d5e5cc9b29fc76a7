// What `cull` writes of the occlusion buffer: pictures of it, and a recording of what one frame asked of it.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "apps/cli/common.h"
#include "sightline/report/cull_run.h"
#include "sightline/report/png.h"
#include "sightline/run/query.h"

namespace sightline::cli {

/// The picture of the buffer that a frame's query leaves, all shared pixels resolved.
Image<Rgb> bufferPicture(const Snapshot& now, const View& view);

/// Writes occlusion-0000.png and so on into a directory, one for each frame of the run. Interrupted, the first ones.
Status writeDepthImages(const Snapshot& now, const CullRun& run, const RunOptions& options,
                        const std::string& directory);

/// Writes what a frame asks of its occlusion buffer, for `sightline replay`.
Status writeRecordingOf(const Snapshot& now, const View& view, const std::string& file);

}  // namespace sightline::cli
