// The verb `render`: one frame by any hidden-surface method, or by all of them beside one another.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "apps/cli/shell/other_verbs.h"
#include "apps/cli/shell/progress.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/cull_path.h"
#include "apps/cli/verbs/render_options.h"
#include "apps/cli/verbs/verbs.h"
#include "sightline/studies/hidden/zbuffer/zbuffer_method.h"
#include "sightline/tools/report/output_file.h"
#include "sightline/tools/report/page/render_page.h"
#include "sightline/tools/report/pictures/picture.h"
#include "sightline/tools/report/pictures/render_pictures.h"
#include "sightline/tools/report/readable.h"
#include "sightline/tools/report/run/cull_run.h"
#include "sightline/tools/report/run/render_run.h"
#include "sightline/tools/scene/one_line.h"

namespace sightline::cli {
using namespace studies;
using namespace tools;
namespace {

/// Of several methods, files show the z-buffer.
const MethodResult& shown(const RenderRun& run) {
    const MethodResult* const zbuffer = run.find(HiddenMethod::kZBuffer);
    return zbuffer ? *zbuffer : run.methods.front();
}

RenderRun describe(const Scene& scene, const CameraPath& path, const RenderOptions& options) {
    RenderRun run;
    applyOptions(options, run);
    run.objects = countKeys(scene, orderByKey(scene));
    run.triangles = drawnTriangles(scene);
    run.frames = static_cast<uint32_t>(path.frames.size());
    run.camera = path.frames[options.frame];
    return run;
}

/// A picture that is no use is worth a word, lest it be taken for a failure.
void noteComparison(const RenderList& scene, const View& view, const RenderOptions& options, const RenderRun& run) {
    const DepthSettings& depth = run.settings.depth;
    if (!depth.comparison || !drawsZBuffer(options)) return;
    const bool less = *depth.comparison == DepthComparison::kLess || *depth.comparison == DepthComparison::kLessEqual;
    const bool greater =
        *depth.comparison == DepthComparison::kGreater || *depth.comparison == DepthComparison::kGreaterEqual;
    const bool nearer_is_greater = depthCodecFor(scene.list(), view, depth.format).convention.greaterIsNearer();
    if (!(nearer_is_greater ? less : greater)) return;
    note(
        fmt::format("--depth-comparison {}: in {} nearer depths are {}, so that only what is farther than the empty "
                    "buffer passes; the picture will be empty",
                    options.depth_comparison, options.depth_format, nearer_is_greater ? "greater" : "less"));
}

/// Of the methods whose heat maps are written.
void noteHeat(const RenderOptions& options, const RenderRun& run) {
    if (options.heat_map.empty() && options.report.empty()) return;
    std::string names;
    for (const MethodResult& result : run.methods) {
        if (options.report.empty() && &result != &shown(run)) continue;
        const std::vector<uint16_t>& counts = countsOf(result.image, run.heat);
        if (std::any_of(counts.begin(), counts.end(), [](uint16_t count) { return count != 0; })) continue;
        names += fmt::format("{}{}", names.empty() ? "" : ", ", result.name());
    }
    if (!names.empty())
        note(fmt::format("--heat {}: no fragment was {} by {}; heat maps of that are black", options.heat, options.heat,
                         names));
}

std::vector<HiddenMethod> methodsOf(const RenderOptions& options, RenderRun& run) {
    if (!options.all()) return {methodOf(options)};
    std::vector<HiddenMethod> methods;
    for (int i = 0; i < kHiddenMethods; ++i) {
        const auto method = static_cast<HiddenMethod>(i);
        std::string why = whyImpractical(run, method);
        if (why.empty()) methods.push_back(method);
        else run.left_out.push_back({method, std::move(why)});
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
    std::string text;
    text += fmt::format("{}: {}, {}; {}, {}x{}: {}, {} in view\n", oneLine(run.scene), counted(run.objects, "object"),
                        counted(run.triangles, "triangle"), frameOf(run.frame, run.frames), run.width, run.height,
                        counted(run.objects_in_view, "object"), counted(run.polygons_in_view, "polygon"));
    for (const MethodResult& result : run.methods) {
        const Agreement& agreement = result.agreement;
        std::string verdict = "as the plain z-buffer";
        if (agreement.differing > 0)
            verdict = fmt::format("differs at {}: {} at edges, {} ties, {} wrong", grouped(agreement.differing),
                                  grouped(agreement.at_edges), grouped(agreement.ties), grouped(agreement.wrong));
        if (const std::string why = whyInexact(run, result); !why.empty()) verdict += ": " + why;
        std::string prepare;
        if (result.prepare_milliseconds > 0)
            prepare = fmt::format(" + {:.2f} ms to prepare", result.prepare_milliseconds);
        text += fmt::format("{:<18} {:>9.2f} ms{}  {:>12} fragments generated, {:>12} shaded  {}\n", result.name(),
                            result.milliseconds, prepare, grouped(result.image.counters.generated),
                            grouped(result.image.counters.shaded), verdict);
    }
    for (const LeftOut& left : run.left_out)
        text += fmt::format("{:<18} left out: {}\n", kHiddenMethodNames[static_cast<int>(left.method)], left.why);
    tell(out, text);
}

Status writeRenderOutputs(const RenderList& scene, const View& view, const RenderRun& run,
                          const PictureSettings& pictures, const RenderOptions& options) {
    const HiddenImage& image = shown(run).image;
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
    Status saved = success();
    const auto save = [&](const MethodResult& result, const Image<Rgb>& picture) {
        if (saved) saved = writeFileAside(fmt::format("{}/{}.png", options.report, result.name()), encodePng(picture));
    };
    const std::string page = renderPage(scene, view, run, pictures, save);
    if (!saved) return saved;
    if (Status written = writeFileAside(options.report + "/index.html", page); !written) return written;
    tellPage(options.json == "-" ? stderr : stdout, options.report);
    return success();
}

Status runRender(const Command& verb, RenderOptions& options) {
    if (Status good = finishRender(verb, options); !good) return good;
    const Result<Scene> scene = loadScene(options.scene);
    if (!scene) return scene.error();
    const Result<CameraPath> path = loadPath(*scene, options);
    if (!path) return path.error();
    if (Status there = checkFrame(options.frame, path->frames.size()); !there) return there;
    const View view = makeView(path->frames[options.frame], options.width, options.height);
    if (!isUsable(view))
        return Error{
            Error::Kind::kInput,
            fmt::format("{}: frame {}: its matrices are not a camera's",
                        options.choice.file.empty() ? options.scene.title() : options.choice.file, options.frame)};
    if (Status writable = checkOutputs(options); !writable) return writable;

    RenderRun run = describe(*scene, *path, options);
    run.command = commandOf(verb, options);
    const RenderList list(*scene, view);
    noteComparison(list, view, options, run);
    drawMethods(list, view, options, run);
    noteHeat(options, run);
    const ShareWork share = [&](size_t count, const std::function<void(size_t)>& work) {
        forEach(count, options.threads, work);
    };
    if (!options.report.empty() && run.find(HiddenMethod::kZBuffer)) findFights(list, view, share, run);
    printRun(options.json == "-" ? stderr : stdout, run);
    return writeRenderOutputs(list, view, run, {run.shading, run.shadows, share}, options);
}

}  // namespace

void addRender(Command& tool, int& exit_code) {
    Command verb = addOtherVerb(tool, "render");
    const auto options = std::make_shared<RenderOptions>();
    addRenderOptions(*verb, *options);
    verb->callback([verb, options, &exit_code] {
        const Status done = runRender(*verb, *options);
        exit_code = done ? kDone : report(done.error());
    });
}

}  // namespace sightline::cli
