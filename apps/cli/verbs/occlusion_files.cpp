// What `cull` writes of the occlusion buffer: pictures of it, and a recording of what one frame asked of it.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/occlusion_files.h"

#include <mutex>

#include <fmt/format.h>

#include "apps/cli/shell/progress.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/cull_path.h"
#include "apps/cli/verbs/explain_object.h"
#include "sightline/query/record/occlusion_recording.h"
#include "sightline/tools/report/output_file.h"
#include "sightline/tools/report/pictures/depth_picture.h"

namespace sightline::cli {
using namespace tools;

Image<Rgb> bufferPicture(const Snapshot& now, const View& view, const QuerySettings& settings) {
    Query query;
    query.visible(now, view, settings);
    const Query::DepthImage image = query.depthImage(true);
    return depthPicture({image.width, image.height, image.perspective, image.nearness, image.covered});
}

Status writeDepthImages(const Snapshot& now, const CullRun& run, const RunOptions& options,
                        const std::string& directory) {
    Progress progress("drawing", "depth images", run.frames.size());
    std::mutex mutex;
    Status all = success();
    forEach(run.frames.size(), options.threads, [&](size_t i) {
        if (interrupted()) return;
        const Image<Rgb> picture = bufferPicture(now, viewOf(run.frames[i].camera, options), options.settings);
        const Status written =
            writeFileAside(fmt::format("{}/occlusion-{:04}.png", directory, i), encodePalettePng(picture));
        const std::lock_guard lock(mutex);
        if (!written && all) all = written;
        progress.step();
    });
    return all;
}

Status writeRecordingOf(const Snapshot& now, const View& view, const QuerySettings& settings, const std::string& file) {
    const Result<OcclusionRecording> recording = recordOcclusion(now, view, settings);
    if (!recording) return recording.error();
    const Array<char> bytes = recordingBytes(*recording);
    return writeFileAside(file, {bytes.data(), bytes.size()});
}

}  // namespace sightline::cli
