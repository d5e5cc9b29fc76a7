// The options of the verb `render`, and the settings that they stand for.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/render_options.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <set>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "apps/cli/shell/options.h"
#include "apps/cli/shell/apart.h"
#include "sightline/tools/report/output_file.h"

namespace sightline::cli {
using namespace studies;
using namespace tools;
namespace {

using Words = std::vector<std::string>;

/// The words of an option, in the order of its enumeration.
template <class Names>
Words words(const Names& names) {
    return {std::begin(names), std::end(names)};
}
const Words kPainterKeys = {"centre", "farthest"}, kFreeSamples = {"check", "segments", "bits"},
            kRayTracers = {"bvh", "embree"}, kSwitch = {"off", "on"},
            kClippings = {"guard-band", "frustum", "clipless"}, kFronts = {"ccw", "cw"}, kBackFaces = {"draw", "drop"},
            kComparisons = {"never",         "less",      "less-equal", "equal", "greater",
                            "greater-equal", "not-equal", "always",     "nearer"};

template <class T>
T chosen(const Words& all, const std::string& word) {
    return static_cast<T>(std::find(all.begin(), all.end(), word) - all.begin());
}

bool isOn(const std::string& word) { return word == "on"; }

void addWord(Command& verb, const std::string& name, std::string& value, const Words& all, const std::string& help) {
    verb.add_option(name, value, help)->check(OneOf(all))->capture_default_str();
}

/// Puts all options under a heading that have none and write nothing.
void headRest(Command& verb, const char* heading) {
    for (Option option : verb.get_options())
        if (option->get_group() == "Options" && option->nonpositional() && !verb.is_help(option) &&
            option->get_type_name().find("FILE") == std::string::npos &&
            option->get_type_name().find("DIR") == std::string::npos)
            option->group(heading);
}

void addOutputs(Command& verb, RenderOptions& options) {
    verb.add_option("-o,--output", options.image, "write the picture")->type_name("FILE.png");
    verb.add_option("--ids", options.ids, "write the object at each pixel: 24-bit colour = key + 1, black for none")
        ->type_name("FILE.png");
    verb.add_option("--heat-map", options.heat_map, "write how many fragments each pixel had")->type_name("FILE.png");
    addWord(verb, "--heat", options.heat, words(kHeatNames), "which fragments heat maps count");
    verb.add_option("--report", options.report,
                    "write DIR/index.html, one page with every method, DIR/render.json and each method's picture")
        ->type_name("DIR");
    addWord(verb, "--shading", options.shading, words(kShadingNames), "of pictures");
    addWord(verb, "--shadows", options.shadows, kSwitch, "of the sun, in pictures");
}

void addMethods(Command& verb, RenderOptions& options) {
    addWord(verb, "--painter-key", options.painter_key, kPainterKeys, "the depth that the painter sorts by");
    addWord(verb, "--free-samples", options.free_samples, kFreeSamples,
            "how bsp-front-to-back knows what is still free");
    addWord(verb, "--rays", options.ray_tracer, kRayTracers, "what traces the rays of raycast");
    addWord(verb, "--clipping", options.clipping, kClippings, "where triangles are cut");
    addWord(verb, "--front", options.front, kFronts, "the winding of front faces, as seen");
    addWord(verb, "--back-faces", options.back_faces, kBackFaces, "of single-sided triangles");
}

void addDepth(Command& verb, RenderOptions& options) {
    addWord(verb, "--depth-format", options.depth_format, words(kDepthFormatNames), "of the z-buffer");
    addWord(verb, "--depth-comparison", options.depth_comparison, kComparisons,
            "of the depth that comes with the one there (nearer: as the format has it)");
    addWord(verb, "--depth-write", options.depth_write, kSwitch, "off leaves depths as they are");
    verb.add_option("--polygon-offset", options.polygon_offset,
                    "moves polygons away by so many times their slope and so many smallest differences")
        ->expected(2)
        ->type_name("FACTOR UNITS");
    addWord(verb, "--early-z", options.early_z, kSwitch, "test depths before shading");
    addWord(verb, "--hierarchical-z", options.hierarchical_z, kSwitch, "reject and accept whole polygons and tiles");
    addWord(verb, "--fast-clear", options.fast_clear, kSwitch, "clear by a state per tile");
    addWord(verb, "--depth-compression", options.depth_compression, kSwitch, "keep depth tiles compressed");
}

/// Of files only; a directory's are those that the report has.
Status checkRenderApart(const RenderOptions& options) {
    ApartFiles files = filesRead(options);
    files.write("-o", options.image);
    files.write("--ids", options.ids);
    files.write("--heat-map", options.heat_map);
    files.write("--json", options.json);
    if (options.report.empty()) return files.status();
    const std::filesystem::path report = options.report;
    files.write("--report", report / "index.html");
    for (const std::string_view method : kHiddenMethodNames)
        if (options.all() || options.method == method) files.write("--report", report / (std::string(method) + ".png"));
    files.writeAgain("--report", report / "render.json", options.json);
    return files.status();
}

}  // namespace

bool drawsZBuffer(const RenderOptions& options) { return options.all() || methodOf(options) == HiddenMethod::kZBuffer; }

void addRenderOptions(Command& verb, RenderOptions& options) {
    options.repeat = 1;
    addCameraOptions(verb, options, "the work of one frame");
    Words methods = words(kHiddenMethodNames);
    methods.emplace_back("all");
    addWord(verb, "--method", options.method, methods, "how hidden surfaces are removed");
    verb.add_option("--frame", options.frame, "of the camera path, counted from 0")
        ->type_name("K")
        ->capture_default_str();
    verb.add_option("--repeat", options.repeat, "times are medians of so many")
        ->check(Range{1, 100000})
        ->type_name("N")
        ->capture_default_str();
    addMethods(verb, options);
    headRest(verb, "Methods");
    addOutputs(verb, options);
    headRest(verb, "Pictures");
    addDepth(verb, options);
    headRest(verb, "Depth");
}

Status finishRender(const Command& verb, RenderOptions& options) {
    if (Status good = finish(verb, options); !good) return good;
    const std::pair<const char*, const std::string*> outputs[] = {{"-o", &options.image},
                                                                  {"--ids", &options.ids},
                                                                  {"--heat-map", &options.heat_map},
                                                                  {"--report", &options.report}};
    for (const auto& [option, name] : outputs) {
        if (verb.count(option) == 0) continue;
        if (name->empty()) return usageError(fmt::format("{}: the name is empty", option));
        if (*name == "-") return usageError(fmt::format("{} -: only --json writes to standard output", option));
    }
    for (const double value : options.polygon_offset)
        if (!std::isfinite(value)) return usageError("--polygon-offset: not two finite numbers");
    return checkRenderApart(options);
}

Status checkOutputs(const RenderOptions& options) {
    if (Status writable = canWriteFiles({options.image, options.ids, options.heat_map, options.json}); !writable)
        return writable;
    if (options.report.empty()) return success();
    if (Status made = makeDirectory(options.report); !made) return made;
    return canWriteFile(options.report + "/index.html");
}

HiddenMethod methodOf(const RenderOptions& options) {
    return chosen<HiddenMethod>(words(kHiddenMethodNames), options.method);
}

void applyOptions(const RenderOptions& options, RenderRun& run) {
    run.scene = options.scene.title();
    run.width = options.width;
    run.height = options.height;
    run.frame = options.frame;
    run.repeat = options.repeat;
    run.shading = chosen<Shading>(words(kShadingNames), options.shading);
    run.shadows = isOn(options.shadows);
    run.heat = chosen<Heat>(words(kHeatNames), options.heat);
    RenderSettings& settings = run.settings;
    settings.threads = options.threads;
    settings.want_counts = !options.json.empty() || !options.report.empty() || !options.heat_map.empty();
    settings.painter_key = chosen<PainterKey>(kPainterKeys, options.painter_key);
    settings.free_samples = chosen<FreeSamples>(kFreeSamples, options.free_samples);
    settings.ray_tracer = chosen<RayTracer>(kRayTracers, options.ray_tracer);
    settings.projector.clipping = chosen<Clipping>(kClippings, options.clipping);
    settings.projector.front_face = chosen<FrontFace>(kFronts, options.front);
    settings.projector.cull_back_faces = options.back_faces == "drop";
    DepthSettings& depth = settings.depth;
    depth.format = chosen<DepthFormat>(words(kDepthFormatNames), options.depth_format);
    if (options.depth_comparison != "nearer")
        depth.comparison = chosen<DepthComparison>(kComparisons, options.depth_comparison);
    depth.write = isOn(options.depth_write);
    depth.offset_factor = options.polygon_offset[0];
    depth.offset_units = options.polygon_offset[1];
    depth.early_test = isOn(options.early_z);
    depth.hierarchy = isOn(options.hierarchical_z);
    depth.fast_clear = isOn(options.fast_clear);
    depth.compression = isOn(options.depth_compression);
}

std::string commandOf(const Command& verb, const RenderOptions& options) {
    static const std::set<std::string> kOutputs = {"SCENE",      "-o",     "--output", "--ids",
                                                   "--heat-map", "--json", "--report", "--help"};
    std::string command = "sightline render " + options.scene.words();
    for (const Option& option : verb.get_options()) {
        if (option->count() == 0 || kOutputs.count(option->get_name()) > 0) continue;
        command += " " + option->get_name();
        for (const std::string& word : option->results()) command += " " + quoted(word);
    }
    return command;
}

}  // namespace sightline::cli
