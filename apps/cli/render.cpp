// The verb `render`: one frame by any hidden-surface method, or by all of them beside one another.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <fmt/format.h>

#include "apps/cli/common.h"
#include "apps/cli/cull_path.h"
#include "apps/cli/progress.h"
#include "apps/cli/verbs.h"
#include "sightline/report/cull_run.h"
#include "sightline/report/output_file.h"
#include "sightline/report/picture.h"
#include "sightline/report/render_page.h"
#include "sightline/report/render_pictures.h"
#include "sightline/report/render_run.h"

namespace sightline::cli {
namespace {

struct RenderOptions : RunOptions {
    std::string method = "zbuffer", image, ids, heat_map;
    std::string heat = "generated", shading = "flat", shadows = "on";
    std::string painter_key = "farthest", free_samples = "bits", ray_tracer = "bvh";
    uint32_t frame = 0;
};

/// The words of an option, in the order of its enumeration.
template <class Names>
std::vector<std::string> words(const Names& names) {
    return {std::begin(names), std::end(names)};
}
const std::vector<std::string> kPainterKeys = {"centre", "farthest"}, kFreeSamples = {"check", "segments", "bits"},
                               kRayTracers = {"bvh", "embree"}, kSwitch = {"off", "on"};

/// The place of a word that CLI::IsMember has let through.
template <class T>
T chosen(const std::vector<std::string>& all, const std::string& word) {
    return static_cast<T>(std::find(all.begin(), all.end(), word) - all.begin());
}

RenderRun describe(const Scene& scene, const CameraPath& path, const RenderOptions& options) {
    RenderRun run;
    run.scene = options.scene;
    run.objects = countKeys(scene, orderByKey(scene));
    run.triangles = drawnTriangles(scene);
    run.width = options.width;
    run.height = options.height;
    run.frame = options.frame;
    run.frames = static_cast<uint32_t>(path.frames.size());
    run.camera = path.frames[options.frame];
    run.repeat = options.repeat;
    run.settings.threads = options.threads;
    run.settings.painter_key = chosen<PainterKey>(kPainterKeys, options.painter_key);
    run.settings.free_samples = chosen<FreeSamples>(kFreeSamples, options.free_samples);
    run.settings.ray_tracer = chosen<RayTracer>(kRayTracers, options.ray_tracer);
    run.settings.want_counts = !options.json.empty() || !options.report.empty() || !options.heat_map.empty();
    run.shading = chosen<Shading>(words(kShadingNames), options.shading);
    run.shadows = options.shadows == "on";
    run.heat = chosen<Heat>(words(kHeatNames), options.heat);
    return run;
}

std::vector<HiddenMethod> methodsOf(const RenderOptions& options, RenderRun& run) {
    if (options.method != "all") return {chosen<HiddenMethod>(words(kHiddenMethodNames), options.method)};
    std::vector<HiddenMethod> methods;
    for (int i = 0; i < kHiddenMethods; ++i) {
        const auto method = static_cast<HiddenMethod>(i);
        const uint64_t limit = practicalPolygons(method);
        if (run.polygons_in_view <= limit) methods.push_back(method);
        else
            run.left_out.push_back({method, fmt::format("{} polygons in view; practical up to {}",
                                                        grouped(run.polygons_in_view), grouped(limit))});
    }
    return methods;
}

void drawMethods(const RenderList& scene, const View& view, const RenderOptions& options, RenderRun& run) {
    const HiddenImage reference = plainZBuffer(scene.list(), view, run.settings.projector);
    run.objects_in_view = scene.list().items().size();
    run.triangles_in_view = scene.list().surfaces();
    run.polygons_in_view = reference.counters.geometry.produced;
    const std::vector<HiddenMethod> methods = methodsOf(options, run);
    Progress progress("rendering", "methods", methods.size());
    for (const HiddenMethod method : methods) {
        run.methods.push_back(drawMethod(scene, view, run.settings, method, run.repeat));
        judge(scene, view, reference, run.settings, run.methods.back());
        progress.step();
    }
}

void printRun(std::FILE* out, const RenderRun& run) {
    fmt::print(out, "{}: {} objects, {} triangles; frame {} of {}, {}x{}: {} objects, {} polygons in view\n", run.scene,
               grouped(run.objects), grouped(run.triangles), run.frame, run.frames, run.width, run.height,
               grouped(run.objects_in_view), grouped(run.polygons_in_view));
    for (const MethodResult& result : run.methods) {
        const Agreement& agreement = result.agreement;
        std::string verdict = "as the plain z-buffer";
        if (agreement.differing > 0)
            verdict = fmt::format("differs at {}: {} at edges, {} ties, {} wrong", grouped(agreement.differing),
                                  grouped(agreement.at_edges), grouped(agreement.ties), grouped(agreement.wrong));
        fmt::print(out, "{:<18} {:>9.2f} ms  {:>12} fragments generated, {:>12} shaded  {}\n", result.name(),
                   result.milliseconds, grouped(result.image.counters.generated), grouped(result.image.counters.shaded),
                   verdict);
    }
    for (const LeftOut& left : run.left_out)
        fmt::print(out, "{:<18} left out: {}\n", kHiddenMethodNames[static_cast<int>(left.method)], left.why);
}

/// Finds out before the work whether its results can be written.
Status checkOutputs(const RenderOptions& options) {
    for (const std::string* file : {&options.image, &options.ids, &options.heat_map, &options.json})
        if (!file->empty() && *file != "-")
            if (Status writable = canWriteFile(*file); !writable) return writable;
    if (options.report.empty()) return success();
    if (Status made = makeDirectory(options.report); !made) return made;
    return canWriteFile(options.report + "/index.html");
}

Status checkNames(const CLI::App& verb, const RenderOptions& options) {
    const std::map<std::string, const std::string*> outputs = {{"-o", &options.image},
                                                               {"--ids", &options.ids},
                                                               {"--heat-map", &options.heat_map},
                                                               {"--report", &options.report}};
    for (const auto& [option, name] : outputs) {
        if (verb.count(option) == 0) continue;
        if (name->empty()) return Error{Error::Kind::kUsage, option + ": the name is empty"};
        if (*name == "-") return Error{Error::Kind::kUsage, option + " -: only --json writes to standard output"};
    }
    return success();
}

Status writeOutputs(const RenderList& scene, const View& view, const RenderRun& run, const RenderOptions& options) {
    PictureSettings pictures{run.shading, run.shadows, [&](size_t count, const std::function<void(size_t)>& work) {
                                 forEach(count, options.threads, work);
                             }};
    // Of several methods, files show the z-buffer.
    const MethodResult* const zbuffer = run.find(HiddenMethod::kZBuffer);
    const HiddenImage& image = (zbuffer ? *zbuffer : run.methods.front()).image;
    if (!options.image.empty()) {
        const std::string png = encodePng(shadedPicture(scene, view, image, pictures));
        if (Status written = writeFileAside(options.image, png); !written) return written;
    }
    if (!options.ids.empty()) {
        const Result<Image<Rgb>> ids = idPicture(scene, image);
        if (!ids) return ids.error();
        if (Status written = writeFileAside(options.ids, encodePng(*ids)); !written) return written;
    }
    if (!options.heat_map.empty()) {
        const std::vector<uint16_t>& counts = countsOf(image, run.heat);
        const std::string png = encodePng(heatMap(countPicture(image, counts), heatScale(counts)));
        if (Status written = writeFileAside(options.heat_map, png); !written) return written;
    }
    const std::string json = renderJson(run);
    if (!options.json.empty())
        if (Status written = writeText(options.json, json); !written) return written;
    if (options.report.empty()) return success();
    if (Status written = writeFileAside(options.report + "/render.json", json); !written) return written;
    return writeFileAside(options.report + "/index.html", renderPage(scene, view, run, pictures));
}

/// The command that repeats a run.
std::string commandOf(const RenderOptions& options) {
    std::string command = "sightline render " + quoted(options.scene);
    if (!options.cameras.empty()) command += " --cameras " + quoted(options.cameras);
    if (options.frames > 0) command += fmt::format(" --frames {}", options.frames);
    if (options.seed_given) command += fmt::format(" --seed {}", options.seed);
    if (options.frame > 0) command += fmt::format(" --frame {}", options.frame);
    command += fmt::format(" --size {}x{} --method {}", options.width, options.height, options.method);
    const RenderOptions plain;
    const auto other = [&](const char* option, const std::string& word, const std::string& usual) {
        if (word != usual) command += fmt::format(" {} {}", option, word);
    };
    other("--painter-key", options.painter_key, plain.painter_key);
    other("--free-samples", options.free_samples, plain.free_samples);
    other("--rays", options.ray_tracer, plain.ray_tracer);
    other("--shading", options.shading, plain.shading);
    other("--shadows", options.shadows, plain.shadows);
    other("--heat", options.heat, plain.heat);
    return command;
}

Status runRender(const CLI::App& verb, RenderOptions& options) {
    if (Status good = finish(verb, options); !good) return good;
    if (Status named = checkNames(verb, options); !named) return named;
    const Result<Scene> scene = loadScene(options.scene);
    if (!scene) return scene.error();
    const Result<CameraPath> path = loadPath(*scene, options);
    if (!path) return path.error();
    if (options.frame >= path->frames.size())
        return Error{Error::Kind::kUsage, fmt::format("--frame {}: the camera path has {} frames, counted from 0",
                                                      options.frame, path->frames.size())};
    const View view = makeView(path->frames[options.frame], options.width, options.height);
    if (!isUsable(view))
        return Error{Error::Kind::kInput,
                     fmt::format("{}: frame {}: its matrices are not a camera's",
                                 options.cameras.empty() ? options.scene : options.cameras, options.frame)};
    if (Status writable = checkOutputs(options); !writable) return writable;

    RenderRun run = describe(*scene, *path, options);
    run.command = commandOf(options);
    const RenderList list(*scene, view);
    drawMethods(list, view, options, run);
    printRun(options.json == "-" ? stderr : stdout, run);
    return writeOutputs(list, view, run, options);
}

void addOutputOptions(CLI::App& verb, RenderOptions& options) {
    verb.add_option("-o,--output", options.image, "write the picture")->type_name("FILE.png");
    verb.add_option("--ids", options.ids, "write the object at each pixel: 24-bit colour = key + 1, black for none")
        ->type_name("FILE.png");
    verb.add_option("--heat-map", options.heat_map, "write how many fragments each pixel had")->type_name("FILE.png");
    verb.add_option("--heat", options.heat, "which fragments heat maps count")
        ->check(CLI::IsMember(words(kHeatNames)))
        ->capture_default_str();
    verb.add_option("--report", options.report, "write DIR/index.html, one page with every method, and DIR/render.json")
        ->type_name("DIR");
    verb.add_option("--shading", options.shading, "of pictures")
        ->check(CLI::IsMember(words(kShadingNames)))
        ->capture_default_str();
    verb.add_option("--shadows", options.shadows, "of the sun, in pictures")
        ->check(CLI::IsMember(kSwitch))
        ->capture_default_str();
}

}  // namespace

void addRender(CLI::App& tool, int& exit_code) {
    CLI::App* verb = tool.add_subcommand("render", "one frame by any hidden-surface method, or by all of them");
    const auto options = std::make_shared<RenderOptions>();
    options->repeat = 1;
    addCameraOptions(*verb, *options, "the work of one frame");
    std::vector<std::string> methods = words(kHiddenMethodNames);
    methods.push_back("all");
    verb->add_option("--method", options->method, "how hidden surfaces are removed")
        ->check(CLI::IsMember(methods))
        ->capture_default_str();
    verb->add_option("--frame", options->frame, "of the camera path, counted from 0")
        ->type_name("K")
        ->capture_default_str();
    verb->add_option("--repeat", options->repeat, "times are medians of so many")
        ->check(CLI::Range(1, 100000))
        ->type_name("N")
        ->capture_default_str();
    addOutputOptions(*verb, *options);
    verb->add_option("--painter-key", options->painter_key, "the depth that the painter sorts by")
        ->check(CLI::IsMember(kPainterKeys))
        ->capture_default_str();
    verb->add_option("--free-samples", options->free_samples, "how bsp-front-to-back knows what is still free")
        ->check(CLI::IsMember(kFreeSamples))
        ->capture_default_str();
    verb->add_option("--rays", options->ray_tracer, "what traces the rays of raycast")
        ->check(CLI::IsMember(kRayTracers))
        ->capture_default_str();
    verb->callback([verb, options, &exit_code] {
        const Status done = runRender(*verb, *options);
        exit_code = done ? kDone : report(done.error());
    });
}

}  // namespace sightline::cli
