// The verb `cull`: the visible set along a camera path, measured, proved and reported as asked for.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "apps/cli/shell/options.h"
#include "apps/cli/shell/apart.h"
#include "apps/cli/shell/progress.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/cull_path.h"
#include "apps/cli/verbs/explain_object.h"
#include "apps/cli/verbs/setting_options.h"
#include "apps/cli/verbs/summary.h"
#include "apps/cli/verbs/verbs.h"
#include "apps/cli/verbs/visibility_choice.h"
#include "sightline/cells/portals.h"
#include "sightline/query/query.h"
#include "sightline/query/record/frame_recorder.h"
#include "sightline/tools/report/output_file.h"
#include "sightline/tools/report/page/cull_page.h"
#include "sightline/tools/report/pictures/canvas.h"
#include "sightline/tools/report/pictures/depth_picture.h"
#include "sightline/tools/report/pictures/png.h"
#include "sightline/tools/report/pictures/window_picture.h"
#include "sightline/tools/report/readable.h"
#include "sightline/tools/report/run/cull_run.h"
#include "sightline/tools/report/run/trace_json.h"
#include "sightline/tools/scene/one_line.h"
#include "sightline/tools/scene/scene_core.h"

namespace sightline::cli {
using namespace tools;
namespace {

// The windows of a frame, for pictures: the part of the image that each cell is seen through, as an outline.

/// Finds windows as the stage of portals does, but for what rows leave out. Any number of threads may ask.
class WindowOverlay {
public:
    /// @pre RunOptions::opened
    explicit WindowOverlay(const RunOptions& options);

    /// Of no cell if the eye's cells are not known.
    std::vector<CellWindow> windows(const View& view, PortalWindows kind, uint32_t depth) const;

private:
    PortalGraph graph_;
    std::vector<DoorState> doors_;
};

/// Takes planes to the image: a plane through the sight lines is a x + b y + c >= 0 there.
class ImageLines {
public:
    explicit ImageLines(const View& view) {
        const glm::dmat4 m = view.projection * glm::dmat4(glm::dmat3(view.view));
        const auto row = [&](int r) { return glm::dvec3(m[0][r], m[1][r], m[2][r]); };
        parallel_ = isOrthographic(view);
        scale_ = parallel_ ? 1 / m[3][3] : 1;
        shift_ = {m[3][0], m[3][1]};
        from_planes_ = glm::inverse(glm::dmat3(row(0), row(1), parallel_ ? row(2) : row(3)));
    }
    glm::dvec3 line(const glm::dvec4& plane) const {
        glm::dvec3 line = from_planes_ * glm::dvec3(plane);
        if (parallel_) {
            line.z = plane.w - line.x * shift_.x - line.y * shift_.y;
            line.x /= scale_;
            line.y /= scale_;
        }
        return line;
    }

private:
    bool parallel_ = false;
    double scale_ = 1;
    glm::dvec2 shift_{0.0};
    glm::dmat3 from_planes_;
};

WindowOverlay::WindowOverlay(const RunOptions& options) : graph_(options.opened->file.cellSpace()) {
    const CellSpace space = options.opened->file.cellSpace();
    doors_.resize(space.doors.size());
    for (const DoorAsked& asked : options.visibility.doors)
        for (size_t i = 0; i < space.doors.size(); ++i)
            if (space.doors[i].name == asked.name) {
                doors_[i].open = static_cast<float>(asked.open);
                break;
            }
}

std::vector<CellWindow> WindowOverlay::windows(const View& view, PortalWindows kind, uint32_t depth) const {
    std::vector<CellWindow> out;
    PortalSettings settings;
    settings.windows = kind;
    settings.depth = depth;
    PortalFlood flood;
    if (!isUsable(view) || !flood.run(graph_, view, settings, doors_)) return out;
    const ImageLines lines(view);
    for (const SeenCell& seen : flood.cells()) {
        CellWindow window;
        window.cell = seen.cell;
        window.outline = {
            {seen.left, seen.bottom}, {seen.right, seen.bottom}, {seen.right, seen.top}, {seen.left, seen.top}};
        for (uint32_t i = 0; i < seen.plane_count; ++i)
            cutOutline(window.outline, lines.line(flood.planes()[seen.first_plane + i]));
        for (glm::dvec2& corner : window.outline)
            corner = {0.5 * (corner.x + 1) * view.width, 0.5 * (1 - corner.y) * view.height};
        out.push_back(std::move(window));
    }
    return out;
}

// What `cull` writes besides: pictures of the occlusion buffer, and the recording of a frame.

/// The picture of the buffer that a frame's query leaves, all shared pixels resolved.
Image<Rgb> bufferPicture(const Snapshot& now, const View& view, const QuerySettings& settings) {
    Query query;
    query.visible(now, view, settings);
    const Query::DepthImage image = query.depthImage(true);
    return depthPicture({image.width, image.height, image.perspective, image.nearness, image.covered});
}

/// Writes occlusion-0000.png and so on into a directory, one for each frame of the run. Interrupted, the first ones.
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

Status writeRecording(const Result<FrameRecording>& recording, const std::string& file) {
    if (!recording) return recording.error();
    const Array<char> bytes = recordingBytes(*recording);
    return writeFileAside(file, {bytes.data(), bytes.size()});
}

struct CullOptions : RunOptions {
    bool verify = false;
    std::string trace;         ///< file, or empty
    std::string recording;     ///< file, or empty
    std::string depth_images;  ///< directory, or empty
    uint32_t frame = 0;        ///< that is recorded
    bool list = false;         ///< name what is visible
};

/// That nothing is written over what is read, or over another output.
Status checkCullApart(const CullOptions& options) {
    ApartFiles files = filesRead(options);
    files.write("--json", options.json);
    files.write("--trace", options.trace);
    files.write("--record", options.recording);
    if (!options.depth_images.empty())
        files.write("--depth-images", std::filesystem::path(options.depth_images) / "occlusion-0000.png");
    if (options.report.empty()) return files.status();
    const std::filesystem::path report = options.report;
    files.write("--report", report / "index.html");
    files.writeAgain("--report", report / "cull.json", options.json);
    files.writeAgain("--report", report / "trace.json", options.trace);
    return files.status();
}

/// Finds out before the work whether its result can be written.
Status checkCullOutputs(const CullOptions& options) {
    if (Status writable = canWriteFiles({options.json, options.trace, options.recording}); !writable) return writable;
    if (!options.depth_images.empty())
        if (Status made = makeDirectory(options.depth_images); !made) return made;
    if (options.report.empty()) return success();
    if (Status made = makeDirectory(options.report + "/frames"); !made) return made;
    return canWriteFile(options.report + "/index.html");
}

/// "culled-0012.png" of "culled-"; of a file that the user put there, no.
bool isPictureOf(const std::string& what, const std::string& name) {
    constexpr std::string_view kSuffix = ".png";
    if (name.size() <= what.size() + kSuffix.size() || name.rfind(what, 0) != 0 || !name.ends_with(kSuffix))
        return false;
    const auto digits = std::string_view(name).substr(what.size(), name.size() - what.size() - kSuffix.size());
    return std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Pictures of an earlier report of the same directory would pass for this one's.
void removePictures(const std::string& directory) {
    std::error_code ignored;
    std::vector<std::filesystem::path> old;
    for (const auto& entry : std::filesystem::directory_iterator(directory, ignored)) {
        const std::string name = entry.path().filename().string();
        for (const char* what :
             {"frame-", "culled-", "outside-", "plan-", "section-", "heat-all-", "heat-kept-", "buffer-", "windows-"})
            if (isPictureOf(what, name)) old.push_back(entry.path());
    }
    old.push_back(std::filesystem::path(directory) / "overview.png");
    for (const auto& file : old) std::filesystem::remove(file, ignored);
}

/// The page and the pictures beside it.
Status writeCullPage(const Scene& scene, const Snapshot& now, const CullRun& run, const CullOptions& options) {
    removePictures(options.report + "/frames");
    Progress progress("drawing", "pictures", 0);
    std::mutex mutex;
    Status all = success();
    PageSettings settings;
    settings.for_each = [&](size_t count, const std::function<void(size_t)>& work) {
        forEach(count, options.threads, work);
    };
    settings.progress = [&](size_t done, size_t total) { progress.set(done, total); };
    settings.save = [&](const std::string& name, const std::string& bytes) {
        Status written = writeFileAside(options.report + "/" + name, bytes);
        const std::lock_guard lock(mutex);
        if (!written && all) all = written;
    };
    if (run.settings.stages & stageBit(Stage::kOcclusion))
        settings.buffer = [&](size_t frame) {
            return bufferPicture(now, viewOf(run.frames[frame].camera, options), options.settings);
        };
    std::optional<WindowOverlay> overlay;
    if (options.opened && run.settings.stages & stageBit(Stage::kPortals)) {
        overlay.emplace(options);
        settings.windows = [&](size_t frame, PortalWindows kind) {
            return overlay->windows(viewOf(run.frames[frame].camera, options), kind, options.settings.portal_depth);
        };
    }
    std::optional<CellSpace> cells;
    if (options.opened) settings.cells = &cells.emplace(options.opened->file.cellSpace());
    const std::string page = reportPage(scene, run, settings);
    if (!all) return all;
    return writeFileAside(options.report + "/index.html", page);
}

/// What some frame kept, by keys: in how many frames, and its path.
void printList(std::FILE* out, const Scene& scene, const CullRun& run) {
    std::map<uint64_t, size_t> frames_of;
    for (const FrameResult& frame : run.frames)
        for (const uint64_t key : frame.visible) ++frames_of[key];
    std::map<uint64_t, std::string> paths;
    for (const SceneObject& object : scene.objects)
        if (frames_of.contains(object.key)) paths.try_emplace(object.key, objectPath(scene, object));
    tell(out, fmt::format("visible in {}: frames, key, path\n", run.frames.size() == 1 ? "the frame" : "some frame"));
    for (const auto& [key, frames] : frames_of)
        tell(out, fmt::format("  {:>6}  {:>8}  {}\n", frames, key, oneLine(paths[key])));
}

/// Of cameras that look away from everything.
void noteEmptyFrames(const Scene& scene, const CullRun& run) {
    const auto isEmpty = [](const FrameResult& frame) { return frame.visible.empty(); };
    const auto empty = static_cast<size_t>(std::count_if(run.frames.begin(), run.frames.end(), isEmpty));
    const Box3d box = coreOf(scene).bounds;
    if (empty == 0 || box.empty()) return;
    const auto text = [](const glm::dvec3& p) {
        return fmt::format("({}, {}, {})", readable(p.x), readable(p.y), readable(p.z));
    };
    note(fmt::format("{} of {} frames {} nothing; the scene lies from {} to {}", empty, run.frames.size(),
                     empty == 1 ? "sees" : "see", text(box.min), text(box.max)));
}

Status writeCullOutputs(const Scene& scene, const Snapshot& now, const CullRun& run, const CullOptions& options) {
    const std::string json = cullJson(run, scene);
    if (!options.json.empty())
        if (Status written = writeText(options.json, json); !written) return written;
    if (!options.trace.empty())
        if (Status written = writeFileAside(options.trace, traceJson(run)); !written) return written;
    if (!options.depth_images.empty())
        if (Status written = writeDepthImages(now, run, options, options.depth_images); !written) return written;
    if (options.report.empty()) return success();
    if (Status written = writeFileAside(options.report + "/cull.json", json); !written) return written;
    if (Status written = writeFileAside(options.report + "/trace.json", traceJson(run)); !written) return written;
    return writeCullPage(scene, now, run, options);
}

/// What --record, --certificates and --depth-images need of the other options.
Status checkOcclusion(const Command& verb, const CullOptions& options) {
    if (verb.count("--frame") > 0 && options.recording.empty()) return usageError("--frame goes with --record");
    if (options.certificates) {
        if (options.settings.stateless)
            return usageError("--certificates: only a query that remembers has some; see --remember");
        if (options.json.empty() && options.report.empty())
            return usageError("--certificates: they are written with --json or --report");
        if (options.stereo > 0) return usageError("--certificates: not of two eyes");
        if (options.settings.stages & stageBit(Stage::kLod))
            return usageError("--certificates: not of levels of detail, which the check does not draw");
    }
    if (options.settings.stages & stageBit(Stage::kOcclusion)) return success();
    if (!options.depth_images.empty()) return usageError("--depth-images needs the occlusion stage");
    return success();
}

/// The whole verb. Returns the exit code.
Result<int> runCull(const Command& verb, CullOptions& options) {
    if (Status good = finish(verb, options); !good) return good.error();
    if (Status good = checkOcclusion(verb, options); !good) return good.error();
    if (Status apart = checkCullApart(options); !apart) return apart.error();
    Result<Scene> scene = loadScene(options.scene);
    if (!scene) return scene.error();
    if (Status opened = openVisibility(*scene, options); !opened) return opened.error();
    const Result<CameraPath> path = loadPath(*scene, options);
    if (!path) return path.error();
    if (Status there = checkFrame(options.frame, path->frames.size()); !there) return there.error();
    if (Status writable = checkCullOutputs(options); !writable) return writable.error();

    prepareLods(*scene, options);
    options.credits = !options.report.empty();
    // Whoever explains the frames asks the world that was culled; without need of that its memory is given back.
    std::optional<LoadedWorld> world;
    const bool asked_again = !options.report.empty() || !options.depth_images.empty();
    std::optional<Result<FrameRecording>> recording;
    FrameHook record;
    if (!options.recording.empty())
        record = [&](size_t frame, const Query& query) {
            if (frame == options.frame) recording.emplace(recordFrame(query));
        };
    CullRun run = cullPath(*scene, *path, options, asked_again ? &world : nullptr, record);
    if (run.frames.empty()) return exitCodeOf(run, path->frames.size(), options.verify);
    run.command = replayOfRun(options, options.verify);
    const Snapshot now = world ? world->world.commit() : Snapshot();
    countChanges(*scene, options, run);
    if (options.verify) verifyPath(*scene, options, run);
    if (!options.report.empty()) noteFrames(*scene, options, std::move(world), run);

    printSummary(options.json == "-" ? stderr : stdout, run);
    noteEmptyFrames(*scene, run);
    if (options.list) printList(options.json == "-" ? stderr : stdout, *scene, run);
    if (Status explained = explainFalseCulls(*scene, options, run); !explained) return explained.error();
    if (Status written = writeCullOutputs(*scene, now, run, options); !written) return written.error();
    if (recording)
        if (Status written = writeRecording(*recording, options.recording); !written) return written.error();
    if (!options.report.empty()) tellPage(options.json == "-" ? stderr : stdout, options.report);
    return exitCodeOf(run, path->frames.size(), options.verify);
}

}  // namespace

void addCull(Command& tool, int& exit_code) {
    Command verb = tool.add_subcommand("cull", "the visible set along a camera path");
    const auto options = std::make_shared<CullOptions>();
    addSceneOptions(*verb, *options);
    addQueryOptions(*verb, *options);
    verb->add_flag("--verify", options->verify,
                   "let rays and an id-buffer judge every frame; exit code 1 if "
                   "anything visible was culled");
    verb->add_flag("--list", options->list, "name what is visible: the frames that keep it, its key and its path");
    verb->add_option("--report", options->report,
                     "write DIR/index.html, one page with pictures, and its numbers and pictures beside it")
        ->type_name("DIR");
    verb->add_option("--trace", options->trace, "write a timeline for chrome://tracing and Perfetto")
        ->type_name("FILE");
    verb->add_option("--record", options->recording,
                     "write one frame with its objects, what they hide with and the answer, for `sightline replay`")
        ->type_name("FILE");
    verb->add_flag(
        "--certificates", options->certificates,
        "write with the numbers whom each cull by a certificate names, for `sightline check`; needs --remember");
    verb->add_option("--frame", options->frame, "of the path, from 0: the one that is recorded")
        ->type_name("K")
        ->capture_default_str();
    verb->add_option("--depth-images", options->depth_images,
                     "write a picture of each frame's occlusion buffer: light is near, blue is open")
        ->type_name("DIR");
    verb->callback([verb, options, &exit_code] {
        const Result<int> done = runCull(*verb, *options);
        exit_code = done ? *done : report(done.error());
    });
}

}  // namespace sightline::cli
