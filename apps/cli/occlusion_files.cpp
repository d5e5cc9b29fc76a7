// What `cull` writes of the occlusion buffer: pictures of it, and a recording of what one frame asked of it.
// SPDX-License-Identifier: MIT
#include "apps/cli/occlusion_files.h"

#include <mutex>

#include <fmt/format.h>

#include "apps/cli/cull_path.h"
#include "apps/cli/explain_object.h"
#include "apps/cli/progress.h"
#include "apps/cli/session.h"
#include "sightline/report/depth_picture.h"
#include "sightline/report/output_file.h"
#include "sightline/run/occlusion_recording.h"

namespace sightline::cli {

Image<Rgb> bufferPicture(const Snapshot& now, const View& view) {
    Query query;
    query.visible(now, view);
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
        const Image<Rgb> picture = bufferPicture(now, viewOfFrame(run.frames[i].camera, options));
        const Status written =
            writeFileAside(fmt::format("{}/occlusion-{:04}.png", directory, i), encodePalettePng(picture));
        const std::lock_guard lock(mutex);
        if (!written && all) all = written;
        progress.step();
    });
    return all;
}

Status writeRecordingOf(const Snapshot& now, const View& view, const std::string& file) {
    const Result<OcclusionRecording> recording = recordOcclusion(now, view);
    if (!recording) return recording.error();
    const Array<char> bytes = recordingBytes(*recording);
    return writeFileAside(file, {bytes.data(), bytes.size()});
}

}  // namespace sightline::cli
