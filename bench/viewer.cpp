// A frame of the viewer along a walk: by all stages, by the frustum alone, and without culling.
// SPDX-License-Identifier: MIT
#include "apps/viewer/viewer.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <vector>

#include <fmt/core.h>

#include "apps/gl/context.h"
#include "bench/cases.h"
#include "bench/stopwatch.h"
#include "sightline/tools/load/walk.h"
#include "sightline/tools/scene/city/city.h"

namespace sightline::bench {
using namespace tools;
namespace {

struct Shown {
    const char* what;
    uint32_t stages;
    std::vector<double> milliseconds = {};  ///< of a walk's frame in the middle, each time it was walked
    double most = 0;                        ///< [milliseconds]
    double visible = 0;                     ///< objects a frame
};

constexpr double kMostSeconds = 10;  // that a walk without culling takes; a larger world gets fewer frames of it
constexpr size_t kLeastFrames = 4;

/// Asks, draws and reads back a frame of the viewer's path.  [milliseconds]; below 0: the GL cannot
double drawFrame(viewer::Viewer& viewer, size_t frame) {
    const auto start = std::chrono::steady_clock::now();
    viewer.goTo(frame);
    if (!viewer.frame({}, 1280, 720) || !viewer.picture()) return -1;
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// How many of the path's frames a walk takes.
size_t framesToDraw(viewer::Viewer& viewer) {
    viewer.culler().settings.stages = 0;
    drawFrame(viewer, 0);  // makes what all further ones have
    const double fits = 1e3 * kMostSeconds / std::max(drawFrame(viewer, 1), 0.1);
    return std::min(viewer.path().frames.size(), std::max(static_cast<size_t>(fits), kLeastFrames));
}

/// Draws so many frames, spread over the viewer's path.
void walkOnce(viewer::Viewer& viewer, size_t frames, Shown& shown) {
    viewer.culler().settings.stages = shown.stages;
    shown.visible = 0;
    double whole = 0;
    for (size_t frame = 0; frame < frames; ++frame) {
        const double taken = drawFrame(viewer, frame * viewer.path().frames.size() / frames);
        if (taken < 0) return;
        whole += taken;
        shown.most = std::max(shown.most, taken);
        shown.visible += double(viewer.culler().visible().size()) / double(frames);
    }
    shown.milliseconds.push_back(whole / double(frames));
}

}  // namespace

Table benchViewer(const Options& options) {
    Table table{"viewer", {}};
    Result<GlContext> context = GlContext::create(2);
    if (!context) {
        table.faults.push_back(context.error().message);
        return table;
    }
    context->makeCurrent();
    const Scene made = options.scene ? Scene() : makeCity(1, 10000);
    const Scene& scene = options.scene ? *options.scene : made;
    WalkSettings walk;
    walk.frames = 60;
    walk.seed = 21;
    viewer::ViewerSettings settings;
    settings.path = walkThrough(scene, walk);
    const Result<std::unique_ptr<viewer::Viewer>> viewer =
        viewer::Viewer::create(scene, loadWorld(scene), QuerySettings(), settings);
    if (!viewer) {
        table.faults.push_back(viewer.error().message);
        return table;
    }
    Shown ways[] = {{"without culling", 0},
                    {"frustum alone", stageBit(Stage::kFrustum)},
                    {"frustum and occlusion", stageBit(Stage::kFrustum) | stageBit(Stage::kOcclusion)}};
    const int repeat = options.repeat ? options.repeat : 3;
    const size_t frames = framesToDraw(**viewer);
    for (int round = 0; round < repeat; ++round)
        for (Shown& shown : ways) walkOnce(**viewer, frames, shown);
    const double all = medianOf(ways[0].milliseconds);
    for (const Shown& shown : ways)
        table.rows.push_back(
            {scene.name, shown.what, medianOf(shown.milliseconds), "ms", "without culling", all,
             fmt::format("at most {:.1f}; {:.0f} objects visible; {} frames", shown.most, shown.visible, frames)});
    return table;
}

}  // namespace sightline::bench
