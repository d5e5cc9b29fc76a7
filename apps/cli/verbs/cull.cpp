// The verb `cull`: the visible set along a camera path, measured, proved and reported as asked for.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/cli/shell/apart.h"
#include "apps/cli/shell/progress.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/cull_path.h"
#include "apps/cli/verbs/explain_object.h"
#include "apps/cli/verbs/frame_notes.h"
#include "apps/cli/verbs/occlusion_files.h"
#include "apps/cli/verbs/size_options.h"
#include "apps/cli/verbs/summary.h"
#include "apps/cli/verbs/verbs.h"
#include "apps/cli/verbs/visibility_choice.h"
#include "apps/cli/verbs/window_overlay.h"
#include "sightline/tools/report/output_file.h"
#include "sightline/tools/report/page/cull_page.h"
#include "sightline/tools/report/run/trace_json.h"

namespace sightline::cli {
using namespace tools;
namespace {

struct CullOptions : RunOptions {
    bool verify = false;
    std::string trace;         ///< file, or empty
    std::string recording;     ///< file, or empty
    std::string depth_images;  ///< directory, or empty
    uint32_t frame = 0;        ///< that is recorded
};

/// That nothing is written over what is read, or over another output.
Status checkCullApart(const CullOptions& options) {
    ApartFiles files;
    for (const std::string& name : options.scene.names) files.read("SCENE", name);
    files.read("--cameras", options.cameras);
    files.read("--visibility", options.visibility.file);
    files.write("--json", options.json);
    files.write("--trace", options.trace);
    files.write("--record-occlusion", options.recording);
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
    if (!options.json.empty() && options.json != "-")
        if (Status writable = canWriteFile(options.json); !writable) return writable;
    if (!options.trace.empty())
        if (Status writable = canWriteFile(options.trace); !writable) return writable;
    if (!options.recording.empty())
        if (Status writable = canWriteFile(options.recording); !writable) return writable;
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
             {"frame-", "culled-", "plan-", "section-", "heat-all-", "heat-kept-", "buffer-", "windows-"})
            if (isPictureOf(what, name)) old.push_back(entry.path());
    }
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
    const std::string page = reportPage(scene, run, settings);
    if (!all) return all;
    return writeFileAside(options.report + "/index.html", page);
}

Status writeCullOutputs(const Scene& scene, const Snapshot& now, const CullRun& run, const CullOptions& options) {
    const std::string json = cullJson(run, scene);
    if (!options.json.empty())
        if (Status written = writeText(options.json, json); !written) return written;
    if (!options.trace.empty())
        if (Status written = writeFileAside(options.trace, traceJson(run)); !written) return written;
    if (!options.recording.empty() && options.frame < run.frames.size())  // else interrupted before
        if (Status written = writeRecordingOf(now, viewOf(run.frames[options.frame].camera, options), options.settings,
                                              options.recording);
            !written)
            return written;
    if (!options.depth_images.empty())
        if (Status written = writeDepthImages(now, run, options, options.depth_images); !written) return written;
    if (options.report.empty()) return success();
    if (Status written = writeFileAside(options.report + "/cull.json", json); !written) return written;
    if (Status written = writeFileAside(options.report + "/trace.json", traceJson(run)); !written) return written;
    return writeCullPage(scene, now, run, options);
}

/// What --record-occlusion and --depth-images need of the other options.
Status checkOcclusion(const CLI::App& verb, const CullOptions& options) {
    if (verb.count("--frame") > 0 && options.recording.empty())
        return usageError("--frame goes with --record-occlusion");
    if (options.settings.stages & stageBit(Stage::kOcclusion)) return success();
    if (!options.recording.empty()) return usageError("--record-occlusion needs the occlusion stage");
    if (!options.depth_images.empty()) return usageError("--depth-images needs the occlusion stage");
    return success();
}

/// The whole verb. Returns the exit code.
Result<int> runCull(const CLI::App& verb, CullOptions& options) {
    if (Status good = finish(verb, options); !good) return good.error();
    if (Status good = checkOcclusion(verb, options); !good) return good.error();
    if (Status apart = checkCullApart(options); !apart) return apart.error();
    const Result<Scene> scene = loadScene(options.scene);
    if (!scene) return scene.error();
    if (Status opened = openVisibility(*scene, options); !opened) return opened.error();
    const Result<CameraPath> path = loadPath(*scene, options);
    if (!path) return path.error();
    if (options.frame >= path->frames.size())
        return Error{Error::Kind::kUsage,
                     fmt::format("--frame {}: the path has {} frames, from 0", options.frame, path->frames.size())};
    if (Status writable = checkCullOutputs(options); !writable) return writable.error();

    options.credits = !options.report.empty();
    // Whoever explains the frames asks the world that was culled; without need of that its memory is given back.
    std::optional<LoadedWorld> world;
    const bool asked_again = !options.report.empty() || !options.recording.empty() || !options.depth_images.empty();
    CullRun run = cullPath(*scene, *path, options, asked_again ? &world : nullptr);
    if (run.frames.empty()) return exitCodeOf(run, path->frames.size(), options.verify);
    run.command = replayOfRun(options, options.verify);
    const Snapshot now = world ? world->world.commit() : Snapshot();
    countChanges(*scene, options, run);
    if (options.verify) verifyPath(*scene, options, run);
    if (!options.report.empty()) noteFrames(*scene, options, std::move(world), run);

    printSummary(options.json == "-" ? stderr : stdout, run);
    if (Status explained = explainFalseCulls(*scene, options, run); !explained) return explained.error();
    if (Status written = writeCullOutputs(*scene, now, run, options); !written) return written.error();
    if (!options.report.empty())
        tell(options.json == "-" ? stderr : stdout, fmt::format("report       {}/index.html\n", options.report));
    return exitCodeOf(run, path->frames.size(), options.verify);
}

}  // namespace

void addCull(CLI::App& tool, int& exit_code) {
    CLI::App* verb = tool.add_subcommand("cull", "the visible set along a camera path");
    const auto options = std::make_shared<CullOptions>();
    addSceneOptions(*verb, *options);
    addQueryOptions(*verb, *options);
    verb->add_flag("--verify", options->verify,
                   "let rays and an id-buffer judge every frame; exit code 1 if "
                   "anything visible was culled");
    verb->add_option("--report", options->report,
                     "write DIR/index.html, one page with pictures, and its numbers and pictures beside it")
        ->type_name("DIR");
    verb->add_option("--trace", options->trace, "write a timeline for chrome://tracing and Perfetto")
        ->type_name("FILE");
    verb->add_option("--record-occlusion", options->recording,
                     "write what one frame asks of its occlusion buffer, for `sightline replay`")
        ->type_name("FILE");
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
