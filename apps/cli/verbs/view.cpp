// The verb `view`: a window onto a scene, or a picture of what would be in it.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "apps/cli/shell/other_verbs.h"
#include "apps/cli/shell/apart.h"
#include "apps/cli/shell/progress.h"
#include "apps/cli/shell/tool.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/cull_path.h"
#include "apps/cli/verbs/explain_object.h"
#include "apps/cli/verbs/verbs.h"
#include "apps/cli/verbs/visibility_choice.h"
#include "apps/gl/context.h"
#include "apps/viewer/loading_screen.h"
#include "apps/viewer/viewer.h"
#include "apps/viewer/window.h"
#include "sightline/tools/report/output_file.h"
#include "sightline/tools/report/readable.h"

namespace sightline::cli {
using namespace tools;
namespace {

struct ViewOptions : RunOptions {
    bool headless = false, no_panels = false;
    std::string screenshot;
    uint32_t frame = 0;
    std::optional<uint32_t> frozen;
    std::string object, colours = "materials", culled = "boxes";
    bool x_ray = false, ways = false, clusters = false, cells = false;
    int tree_level = -1;
    std::optional<double> bsp;
};

template <class Choice, size_t count>
Choice choiceOf(const char* const (&names)[count], const std::string& word) {
    return static_cast<Choice>(std::find(names, names + count, word) - names);
}

/// What the options ask for.
Status arrange(const ViewOptions& options, const Scene& scene, viewer::Viewer& viewer) {
    viewer::ViewerState& state = viewer.state;
    state.panels = !options.no_panels;
    state.colour_by = choiceOf<viewer::ColourBy>(viewer::kColourByNames, options.colours);
    state.culled_as = choiceOf<viewer::CulledAs>(viewer::kCulledAsNames, options.culled);
    state.x_ray = options.x_ray;
    state.tree_level = options.tree_level;
    state.ways = options.ways;
    state.clusters = options.clusters;
    state.cells = options.cells;
    state.bsp = options.bsp.has_value();
    state.bsp_part = static_cast<float>(options.bsp.value_or(1));
    for (const DoorAsked& asked : options.visibility.doors)
        for (viewer::ViewerDoor& door : viewer.culler().doors())
            if (door.name == asked.name) door.open = static_cast<float>(asked.open);
    if (options.frozen) {
        viewer.goTo(*options.frozen);
        state.frozen = true;
    }
    viewer.goTo(options.frame);
    if (options.object.empty()) return success();
    const Result<std::vector<uint32_t>> objects = findObjects(scene, options.object);
    if (!objects) return objects.error();
    state.chosen = objects->front();
    return success();
}

Status writePicture(const viewer::Viewer& viewer, const std::string& file) {
    const Result<Image<Rgb>> picture = viewer.picture();
    if (!picture) return picture.error();
    return writeFileAside(file, encodePng(*picture));
}

/// Panels take their places in the first frames, and other ways of culling find out in some what they show.
Status drawOnce(const ViewOptions& options, viewer::Viewer& viewer) {
    for (int i = 0; i < 5; ++i)
        if (Status drawn = viewer.frame({}, options.width, options.height); !drawn) return drawn;
    if (options.screenshot.empty()) return success();
    return writePicture(viewer, options.screenshot);
}

Status runWindow(const ViewOptions& options, viewer::Window& window, viewer::Viewer& viewer) {
    Status status = success();
    uint64_t frames = 0;
    window.run([&](const viewer::Input& input, uint32_t width, uint32_t height) {
        status = viewer.frame(input, width, height);
        if (!status) return viewer::Window::Next::kEnd;
        viewer.show(width, height);
        if (viewer.state.wants_picture) {
            viewer.state.wants_picture = false;
            const std::string name = freeFileName("sightline-view", ".png");
            const Status written = writePicture(viewer, name);
            viewer.state.said = written ? name + " written" : written.error().message;
        }
        if (++frames == 3 && !options.screenshot.empty()) {
            status = writePicture(viewer, options.screenshot);
            return viewer::Window::Next::kEnd;
        }
        if (viewer.state.wants_to_close || interrupted()) return viewer::Window::Next::kEnd;
        return viewer.rests() && frames > 3 ? viewer::Window::Next::kRest : viewer::Window::Next::kFrame;
    });
    return status;
}

Status checkView(const ViewOptions& options) {
    ApartFiles files = filesRead(options);
    files.write("--screenshot", options.screenshot);
    if (!files.status()) return files.status();
    if (options.screenshot == "-") return usageError("--screenshot -: pictures go into files");
    if (options.clusters && options.object.empty()) return usageError("--clusters: of which object? --object OBJECT");
    if (options.cells && options.visibility.file.empty())
        return usageError("--cells: of which file? --visibility FILE");
    if (options.headless && options.screenshot.empty()) return usageError("--headless goes with --screenshot");
    return options.screenshot.empty() ? success() : canWriteFile(options.screenshot);
}

LoadedWorld loadForView(const Scene& scene, const ViewOptions& options) {
    Progress progress("preparing", "meshes", scene.meshes.size());
    LoadSettings settings = loadSettingsOf(options);
    settings.volumes = true;
    LoadedWorld loaded = loadWorld(
        scene, [&](size_t done, size_t total) { progress.set(done, total); }, settings);
    attachVisibility(options, loaded.world);
    return loaded;
}

/// What takes its time before the first frame.
struct Loaded {
    std::unique_ptr<Scene> scene;
    CameraPath path;
    std::optional<LoadedWorld> world;
};

Result<Loaded> load(ViewOptions& options) {
    Result<Scene> scene = loadScene(options.scene);
    if (!scene) return scene.error();
    Loaded loaded;
    loaded.scene = std::make_unique<Scene>(std::move(*scene));
    prepareLods(*loaded.scene, options);
    if (Status opened = openVisibility(*loaded.scene, options); !opened) return opened.error();
    Result<CameraPath> path = loadPath(*loaded.scene, options);
    if (!path) return path.error();
    loaded.path = std::move(*path);
    const size_t frames = loaded.path.frames.size();
    if (Status there = checkFrame(options.frame, frames); !there) return there.error();
    if (options.frozen && *options.frozen >= frames)
        return usageError(
            fmt::format("--frozen {}: the path has {}, from 0", *options.frozen, counted(frames, "frame")));
    loaded.world = loadForView(*loaded.scene, options);
    return loaded;
}

/// Loads while the window shows how far that is. What is there at once shows no progress.
Result<Loaded> loadBeside(viewer::Window& window, ViewOptions& options) {
    std::mutex mutex;
    viewer::LoadingPart now;
    watchProgress([&](const std::string& what, double part) {
        const std::lock_guard lock(mutex);
        now = {what, part};
    });
    std::future<Result<Loaded>> loading = std::async(std::launch::async, [&] { return load(options); });
    const auto isThere = [&](int milliseconds) {
        return loading.wait_for(std::chrono::milliseconds(milliseconds)) == std::future_status::ready;
    };
    Status status = success();
    if (!isThere(300)) {
        Result<viewer::LoadingScreen> screen = viewer::LoadingScreen::create();
        if (!screen) status = screen.error();
        bool waits = true;
        if (screen)
            window.run([&](const viewer::Input& input, uint32_t width, uint32_t height) {
                viewer::LoadingPart part;
                {
                    const std::lock_guard lock(mutex);
                    part = now;
                }
                status = screen->frame(input, width, height, window.scale(), options.scene.title(), part);
                screen->show(width, height);
                waits = status.ok() && !isThere(15);
                return waits ? viewer::Window::Next::kFrame : viewer::Window::Next::kEnd;
            });
        if (waits && screen) {  // its user closed it: a load cannot be stopped halfway, and leaves nothing behind
            (void)std::fflush(nullptr);
            std::_Exit(kDone);
        }
    }
    Result<Loaded> loaded = loading.get();
    watchProgress({});
    return status ? std::move(loaded) : Result<Loaded>(status.error());
}

Status runView(const Command& verb, ViewOptions& options) {
    if (Status good = finish(verb, options); !good) return good;
    if (Status good = checkView(options); !good) return good;
    viewer::ViewerSettings shown;
    std::optional<viewer::Window> window;
    if (!options.headless) {
        Result<viewer::Window> opened =
            viewer::Window::open("Sightline: " + options.scene.title(), options.width, options.height);
        if (!opened) return opened.error();
        window.emplace(std::move(*opened));
        shown.scale = window->scale();
    }
    Result<Loaded> loaded = window ? loadBeside(*window, options) : load(options);
    if (!loaded) return loaded.error();
    const Scene& scene = *loaded->scene;
    std::optional<GlContext> context;
    if (!window) {
        Result<GlContext> made = GlContext::create(2);
        if (!made) return made.error();
        context.emplace(std::move(*made));
        context->makeCurrent();
    }
    QuerySettings settings = options.settings;
    settings.stateless = false;
    shown.path = loaded->path;
    shown.sections = options.sections;
    shown.jitter = options.jitter;
    shown.times = !options.headless;
    if (options.opened) shown.cells = options.opened->file.cellSpace();
    Result<std::unique_ptr<viewer::Viewer>> made =
        viewer::Viewer::create(scene, std::move(*loaded->world), settings, std::move(shown));
    if (!made) return made.error();
    if (Status ready = arrange(options, scene, **made); !ready) return ready;
    stopGently();
    return options.headless ? drawOnce(options, **made) : runWindow(options, *window, **made);
}

}  // namespace

void addView(Command& tool, int& exit_code) {
    Command verb = addOtherVerb(tool, "view");
    const auto options = std::make_shared<ViewOptions>();
    addSceneOptions(*verb, *options);
    for (const char* name :
         {"--json", "--rays", "--no-proofs", "--repeat", "--threads"})  // of verbs that run through a path
        verb->remove_option(verb->get_option(name));
    verb->add_flag("--headless", options->headless, "draw one frame without a window, for --screenshot");
    verb->add_option("--screenshot", options->screenshot, "write the picture, and end")->type_name("FILE.png");
    verb->add_option("--frame", options->frame, "of the path, where the eye stands")
        ->type_name("N")
        ->capture_default_str();
    verb->add_option("--frozen", options->frozen,
                     "leave the culling camera at this frame of the path, and look at what it left from --frame")
        ->type_name("N");
    verb->add_option("--object", options->object, "choose this object: its key, its name or a part of its path")
        ->type_name("OBJECT");
    verb->add_option("--colours", options->colours, "of what is visible")
        ->check(OneOf(std::vector<std::string>(std::begin(viewer::kColourByNames), std::end(viewer::kColourByNames))))
        ->type_name("materials|objects|answer|levels")
        ->capture_default_str();
    verb->add_option("--culled", options->culled, "what was culled is shown as")
        ->check(OneOf{"nothing", "boxes", "ghosts"})
        ->type_name("nothing|boxes|ghosts")
        ->capture_default_str();
    verb->add_flag("--x-ray", options->x_ray, "what is visible is see-through, and what was culled is shown");
    verb->add_option("--tree-level", options->tree_level, "show the boxes of a level of the hierarchy (-1: none)")
        ->check(Range{-1, 12})
        ->type_name("N")
        ->capture_default_str();
    verb->add_option("--bsp", options->bsp,
                     "paint this part of the scene in the order of a BSP tree, the farthest first (0 to 1)")
        ->check(Range{0.0, 1.0})
        ->type_name("PART");
    verb->add_flag("--ways", options->ways, "show what other ways of culling keep of the same view");
    verb->add_flag("--clusters", options->clusters, "show the clusters of the chosen object's triangles (--object)");
    verb->add_flag("--cells", options->cells,
                   "show the camera's cell, and those that are seen from there (--visibility)");
    verb->add_flag("--no-panels", options->no_panels, "without panels");
    verb->callback([verb, options, &exit_code] {
        const Status done = runView(*verb, *options);
        exit_code = !done ? report(done.error()) : interrupted() ? kInterrupted : kDone;
    });
}

}  // namespace sightline::cli
