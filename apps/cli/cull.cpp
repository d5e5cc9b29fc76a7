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

#include "apps/cli/apart.h"
#include "apps/cli/common.h"
#include "apps/cli/cull_path.h"
#include "apps/cli/explain_object.h"
#include "apps/cli/frame_notes.h"
#include "apps/cli/occlusion_files.h"
#include "apps/cli/progress.h"
#include "apps/cli/session.h"
#include "apps/cli/size_options.h"
#include "apps/cli/summary.h"
#include "apps/cli/verbs.h"
#include "apps/cli/visibility_choice.h"
#include "apps/cli/window_overlay.h"
#include "sightline/report/output_file.h"
#include "sightline/report/page.h"
#include "sightline/report/trace_json.h"

namespace sightline::cli {
namespace {

struct CullOptions : RunOptions {
    bool verify = false;
    std::string trace;         ///< file, or empty
    std::string recording;     ///< file, or empty
    std::string depth_images;  ///< directory, or empty
    uint32_t frame = 0;        ///< that is recorded
};

/// That nothing is written over what is read, or over another output.
Status checkApart(const CullOptions& options) {
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
Status checkOutputs(const CullOptions& options) {
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
Status writePage(const Scene& scene, const Snapshot& now, const CullRun& run, const CullOptions& options) {
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
    if (run.stages & stageBit(Stage::kOcclusion))
        settings.buffer = [&](size_t frame) {
            return bufferPicture(now, viewOfFrame(run.frames[frame].camera, options));
        };
    std::optional<WindowOverlay> overlay;
    if (options.opened && run.stages & stageBit(Stage::kPortals)) {
        overlay.emplace(options);
        settings.windows = [&](size_t frame, PortalWindows kind) {
            return overlay->windows(viewOfFrame(run.frames[frame].camera, options), kind);
        };
    }
    const std::string page = reportPage(scene, run, settings);
    if (!all) return all;
    return writeFileAside(options.report + "/index.html", page);
}

Status writeOutputs(const Scene& scene, const Snapshot& now, const CullRun& run, const CullOptions& options) {
    const std::string json = cullJson(run, scene);
    if (!options.json.empty())
        if (Status written = writeText(options.json, json); !written) return written;
    if (!options.trace.empty())
        if (Status written = writeFileAside(options.trace, traceJson(run)); !written) return written;
    if (!options.recording.empty() && options.frame < run.frames.size())  // else interrupted before
        if (Status written =
                writeRecordingOf(now, viewOfFrame(run.frames[options.frame].camera, options), options.recording);
            !written)
            return written;
    if (!options.depth_images.empty())
        if (Status written = writeDepthImages(now, run, options, options.depth_images); !written) return written;
    if (options.report.empty()) return success();
    if (Status written = writeFileAside(options.report + "/cull.json", json); !written) return written;
    if (Status written = writeFileAside(options.report + "/trace.json", traceJson(run)); !written) return written;
    return writePage(scene, now, run, options);
}

/// What --record-occlusion and --depth-images need of the other options.
Status checkOcclusion(const CLI::App& verb, const CullOptions& options) {
    const auto usage = [](const std::string& message) { return Error{Error::Kind::kUsage, message}; };
    if (verb.count("--frame") > 0 && options.recording.empty()) return usage("--frame goes with --record-occlusion");
    if (options.stages & stageBit(Stage::kOcclusion)) return success();
    if (!options.recording.empty()) return usage("--record-occlusion needs the occlusion stage");
    if (!options.depth_images.empty()) return usage("--depth-images needs the occlusion stage");
    return success();
}

/// The whole verb. Returns the exit code.
Result<int> runCull(const CLI::App& verb, CullOptions& options) {
    if (Status good = finish(verb, options); !good) return good.error();
    if (Status good = checkOcclusion(verb, options); !good) return good.error();
    if (Status apart = checkApart(options); !apart) return apart.error();
    const Result<Scene> scene = loadScene(options.scene);
    if (!scene) return scene.error();
    if (Status opened = openVisibility(*scene, options); !opened) return opened.error();
    const Result<CameraPath> path = loadPath(*scene, options);
    if (!path) return path.error();
    if (options.frame >= path->frames.size())
        return Error{Error::Kind::kUsage,
                     fmt::format("--frame {}: the path has {} frames, from 0", options.frame, path->frames.size())};
    if (Status writable = checkOutputs(options); !writable) return writable.error();

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
    if (Status written = writeOutputs(*scene, now, run, options); !written) return written.error();
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
