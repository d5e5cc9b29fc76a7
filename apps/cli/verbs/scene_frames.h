// A scene's frames along some cameras, as a program has them: a query, the list of what it leaves, a drawing.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "apps/cli/shell/options.h"
#include "apps/cli/verbs/run_options.h"
#include "sightline/base/result.h"
#include "sightline/prepare/facing/draw_clusters.h"
#include "sightline/query/query.h"
#include "sightline/studies/hidden/draw_item.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/report/pictures/render_list.h"
#include "sightline/tools/report/run/profile_run.h"

namespace sightline::cli {
using namespace studies;
using namespace tools;

/// The scene, its cameras and the query, as of `cull`; --threads are the reference renderer's, and one without a word.
void addFrameOptions(Command& verb, RunOptions& options);

/// What a verb looks at.
struct AskedFrames {
    Scene scene;
    std::vector<View> views;
};
/// Checks the options and whether the JSON can be written, and reads all that is to be read. Of a path that nobody asked for
/// four frames are looked at, evenly. Errors: of all these; a camera whose matrices are none.
Result<AskedFrames> openFrames(const Command& verb, RunOptions& options);

/// The scene as a world with the stages that need preparing, and each object as an item. Every view stands by itself:
/// queries are stateless.
class SceneFrames {
public:
    /// @param scene    must outlive it
    /// @param options  stages that need preparing, and the visibility file that was opened
    SceneFrames(const Scene& scene, const RunOptions& options, std::vector<View> views);
    SceneFrames(const SceneFrames&) = delete;
    SceneFrames& operator=(const SceneFrames&) = delete;

    /// Asks a view, and makes the list of what is to be drawn. Valid until it is called again.
    std::span<const DrawItem> submit(size_t view, const QuerySettings& settings);
    /// Of the query of the last submit().
    uint64_t queryNanoseconds() const { return query_nanoseconds_; }

    std::span<const View> views() const { return views_; }
    std::span<const DrawItem> items() const { return all_.casters(); }  ///< all that may be drawn
    const Scene& scene() const { return all_.scene(); }

private:
    /// The triangles that clusters leave of one object, one after the other.
    struct Rest {
        std::vector<uint32_t> indices;
        std::vector<uint8_t> double_sided, writes_depth;
    };
    void addRest(const DrawItem& whole, std::span<const DrawRange> ranges);

    std::vector<View> views_;
    RenderList all_;
    std::vector<uint32_t> item_of_;                      ///< by object: of items(), or ~0u
    std::vector<std::optional<DrawClusters>> clusters_;  ///< by mesh; empty without that stage
    LoadedWorld loaded_;
    Snapshot now_;
    Query query_;
    uint64_t query_nanoseconds_ = 0;
    std::vector<DrawItem> drawn_;
    std::vector<Rest> rests_;
    size_t rests_used_ = 0;
};

/// What a query leaves of all frames, one after the other, as one frame for findBottleneck(). All must outlive it.
DrawFrame pathOf(SceneFrames& frames, LoadedRenderer& renderer, const QuerySettings& settings);

/// One set of stages on one scene's frames.
struct FrameTrial {
    SceneFrames* frames = nullptr;
    QuerySettings settings;
    AblationRow row;
    std::vector<double> query_microseconds, frame_milliseconds;  ///< per round
};

/// The query's stages: as asked, each left out, volumes added, and none.
std::vector<FrameTrial> ablationTrials(SceneFrames& frames, const QuerySettings& settings);

/// Counts, then times all in turns by the reference renderer, and fills their rows.
/// @param rounds    times are medians of so many
/// @param progress  called with (done, total) now and then; may be empty
void measureTrials(std::span<FrameTrial> trials, uint32_t threads, bool stream, uint32_t rounds,
                   const std::function<void(size_t, size_t)>& progress = {});

}  // namespace sightline::cli
