// What several verbs share: the common options, scenes by name, camera paths, errors.
// SPDX-License-Identifier: MIT
#include "apps/cli/common.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <thread>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <fmt/format.h>

#include "apps/cli/session.h"
#include "apps/cli/cluster_options.h"
#include "apps/cli/section_options.h"
#include "apps/cli/size_options.h"
#include "apps/cli/visibility_options.h"
#include "apps/cli/verbs.h"
#include "sightline/geom/view.h"
#include "sightline/load/seeded_cameras.h"
#include "sightline/report/chart.h"
#include "sightline/report/output_file.h"
#include "sightline/scene/city.h"
#include "sightline/scene/one_line.h"

namespace sightline::cli {
namespace {

constexpr uint32_t kLargestSide = 16384;   // [pixels]
constexpr uint32_t kLargestBuffer = 8192;  // View::occlusion_size  [pixels]
constexpr uint32_t kMostFrames = 1000000;
constexpr uint32_t kMostThreads = 1024;

Error usage(const std::string& message) { return {Error::Kind::kUsage, message}; }

/// Reads what stands after --close-gaps, if anything does.
void readGap(const std::string& text, RunOptions& options) {
    if (text.empty() || text == "true" || text == "{}") {
        options.close_gaps = 1.0 / 1024.0;
        return;
    }
    double gap = 0;
    if (!CLI::detail::lexical_cast(text, gap) || !(gap > 0.0 && gap <= 1.0 / 16.0))
        throw CLI::ValidationError("--close-gaps", "wants pixels, above 0 and up to 0.0625, not '" + text + "'");
    options.close_gaps = gap;
}

/// Reads a whole number that is all of the text.
template <class T>
bool readWhole(std::string_view text, T& out) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    return error == std::errc() && end == text.data() + text.size();
}

std::string stageNames() {
    std::string names;
    for (const char* name : kStageNames) names += (names.empty() ? "" : ", ") + std::string(name);
    return names;
}

Result<uint32_t> readStages(const std::string& option, const std::vector<std::string>& names) {
    uint32_t bits = 0;
    for (const std::string& name : names) {
        const auto* const found = std::find(std::begin(kStageNames), std::end(kStageNames), name);
        if (found == std::end(kStageNames))
            return usage(fmt::format("{}: there is no stage \"{}\" (there are: {})", option, name, stageNames()));
        bits |= 1u << (found - std::begin(kStageNames));
    }
    return bits;
}

/// The city's seed in `city:SEED:OBJECTS`, which has been checked by making the city.
bool isCity(const std::string& scene, uint64_t& seed) {
    const std::string_view text = scene;
    if (text.substr(0, 5) != "city:") return false;
    return readWhole(text.substr(5, text.find(':', 5) - 5), seed);
}

}  // namespace

Status readSize(const std::string& option, const std::string& text, uint32_t& width, uint32_t& height) {
    const std::string_view size = text;
    const size_t cross = size.find('x');
    const bool good = cross != std::string_view::npos && readWhole(size.substr(0, cross), width) &&
                      readWhole(size.substr(cross + 1), height) && width >= 1 && height >= 1 && width <= kLargestSide &&
                      height <= kLargestSide;
    if (good) return success();
    return usage(fmt::format("{} {}: not WxH with sides from 1 to {}", option, text, kLargestSide));
}

void addOcclusionSize(CLI::App& verb, uint32_t& size) {
    verb.add_option("--occlusion-size", size,
                    "longer side of the occlusion buffer; a smaller viewport gets its own [pixels]")
        ->check(CLI::Range(1u, kLargestBuffer))
        ->type_name("N")
        ->group("Culling");
}

void addCameraOptions(CLI::App& verb, RunOptions& options, const std::string& shared) {
    addSceneChoice(verb, options.scene);
    verb.add_option("--cameras", options.cameras, "camera path (JSON)")->type_name("PATH.json")->group("Cameras");
    verb.add_option("--frames", options.frames,
                    "so many seeded cameras; a city without --seed is walked along its streets")
        ->check(CLI::Range(1u, kMostFrames))
        ->type_name("N")
        ->group("Cameras");
    verb.add_option("--seed", options.seed, "of the seeded cameras")
        ->type_name("S")
        ->capture_default_str()
        ->group("Cameras");
    verb.add_option("--size", options.size, "of the viewport [pixels]")
        ->type_name("WxH")
        ->capture_default_str()
        ->group("Cameras");
    verb.add_option("--threads", options.threads, "share " + shared + " among so many threads (default: one a core)")
        ->check(CLI::Range(1u, kMostThreads))
        ->type_name("N")
        ->group("General");
    verb.add_option("--json", options.json, "write the result as JSON (-: standard output)")->type_name("FILE");
}

void addSceneOptions(CLI::App& verb, RunOptions& options) {
    addCameraOptions(verb, options, "the frames");
    verb.add_option("--repeat", options.repeat, "queries a frame; times are their medians")
        ->check(CLI::Range(1, 100000))
        ->type_name("N")
        ->capture_default_str()
        ->group("Culling");
    verb.add_option("--use", options.use,
                    "only these stages, separated by commas (" + stageNames() +
                        "; default: all but volumes, if --distance and --contribution say how much)")
        ->delimiter(',')
        ->type_name("LIST")
        ->group("Culling");
    verb.add_option("--skip", options.skip, "not these stages")->delimiter(',')->type_name("LIST")->group("Culling");
    addSizeOptions(verb, options);
    addSectionOptions(verb, options);
    addVisibilityOptions(verb, options);
    addClusterOptions(verb, options);
    verb.add_option("--jitter", options.jitter, "largest shift of the image that the answer must hold for")
        ->check(CLI::Range(0.0, 1024.0))
        ->type_name("PX")
        ->capture_default_str()
        ->group("Culling");
    verb.add_option("--occluder-triangles", options.occluder_triangles,
                    "that a query draws at most, the nearest first; further objects hide nothing")
        ->type_name("N")
        ->capture_default_str()
        ->group("Culling");
    addOcclusionSize(verb, options.occlusion_size);
    verb.get_option("--occlusion-size")->capture_default_str();
    verb.add_option(
            "--occluder-error", options.occluder_error,
            "prepare simpler occluders inside of dense solids, and draw them where they err by so much at most, in "
            "pixels of the occlusion buffer; 0: none")
        ->check(CLI::Range(0.0, 1024.0))
        ->type_name("PX")
        ->capture_default_str()
        ->group("Culling");
    verb.add_flag("--masked", options.masked,
                  "let a tile of the occlusion buffer remember two depths and a mask, not a depth per pixel")
        ->group("Culling");
    verb.add_option_function<std::string>(
            "--close-gaps", [&options](const std::string& text) { readGap(text, options); },
            "close gaps between occluders that are narrower than TAU pixels of the "
            "occlusion buffer [1/1024]; what is seen through them alone may be culled")
        ->expected(0, 1)
        ->type_name("TAU")
        ->group("Culling");
    verb.add_flag("--no-faces", options.no_faces,
                  "ask an object by the rectangle around its box, not by the box's faces")
        ->group("Culling");
    verb.add_flag("--no-second-look", options.no_second_look, "do not ask what its box keeps by its own triangles")
        ->group("Culling");
    verb.add_option("--second-look-polygons", options.second_look_polygons,
                    "that a query asks at most; further objects are kept by their boxes")
        ->type_name("N")
        ->capture_default_str()
        ->group("Culling");
    verb.add_option("--rays", options.rays, "that the first witness casts for a frame")
        ->check(CLI::Range(uint64_t{1}, uint64_t{1} << 40))
        ->type_name("N")
        ->capture_default_str()
        ->group("Culling");
}

void addStereoOption(CLI::App& verb, RunOptions& options) {
    constexpr double kLeast = 1e-9, kMost = 1e9;
    const auto check = [](const std::string& text) -> std::string {
        double value = 0;
        if (!CLI::detail::lexical_cast(text, value)) return "\"" + text + "\" is not a number";
        if (value >= kLeast && value <= kMost) return {};
        return text + " is not a distance between the eyes, from 1e-9 to 1e9; for one eye leave it out";
    };
    verb.add_option("--stereo", options.stereo,
                    "two eyes so far apart [world units], each with a buffer of its own; pictures are the left one's")
        ->check(CLI::Validator(check, "", "distance"))
        ->type_name("IPD")
        ->group("Culling");
}

void addQueryOptions(CLI::App& verb, RunOptions& options) {
    addStereoOption(verb, options);
    verb.add_option("--bins", options.bins,
                    "strips of the occlusion buffer, each with a walk of its own, that threads can share")
        ->check(CLI::Range(1, 16))
        ->type_name("K")
        ->capture_default_str()
        ->group("Culling");
    verb.add_option("--query-threads", options.query_threads, "share the bins of each query among so many threads")
        ->check(CLI::Range(1u, kMostThreads))
        ->type_name("N")
        ->capture_default_str()
        ->group("Culling");
    verb.add_option(
            "--hysteresis", options.hysteresis,
            "keep what the frame before kept until it is so much farther or smaller than the limits of --distance "
            "and --contribution; that frame is asked each time for that")
        ->check(CLI::Range(0.0, 1.0))
        ->type_name("SHARE")
        ->group("Culling");
    verb.add_flag("--last-visible-first", options.last_visible_first,
                  "begin with what the frame before kept, which is asked each time for that")
        ->group("Culling");
}

Status finish(const CLI::App& verb, RunOptions& options) {
    if (Status size = readSize("--size", options.size, options.width, options.height); !size) return size;
    if (std::isnan(options.jitter)) return usage("--jitter: not a number");  // no range leaves it out
    if (std::isnan(options.stereo)) return usage("--stereo: not a number");
    if (std::isnan(options.hysteresis)) return usage("--hysteresis: not a number");
    if (options.hysteresis > 0 && !(options.max_distance > 0) && !(options.contribution > 0))
        return usage("--hysteresis: there is no limit; see --distance and --contribution");
    if (std::isnan(options.occluder_error)) return usage("--occluder-error: not a number");
    if (options.query_threads > 1 && options.bins == 1 && options.stereo == 0)
        return usage("--query-threads: one bin has nothing to share; see --bins");
    const Result<uint32_t> use = readStages("--use", options.use), skip = readStages("--skip", options.skip);
    if (!use) return use.error();
    if (!skip) return skip.error();
    // Clusters take long to prepare: they are for those who ask for them.
    options.stages = (options.use.empty() ? kDefaultStages & ~stageBit(Stage::kClusters) : *use) & ~*skip;
    if (Status sizes = finishSizeOptions(options); !sizes) return sizes;
    if (Status cells = finishVisibilityOptions(options); !cells) return cells;
    if (Status clusters = finishClusterOptions(options); !clusters) return clusters;
    options.seed_given = verb.count("--seed") > 0;
    if (!options.cameras.empty() && (options.frames > 0 || options.seed_given))
        return usage("--cameras excludes --frames and --seed");
    if (options.threads == 0) options.threads = std::clamp(std::thread::hardware_concurrency(), 1u, kMostThreads);
    if (options.json.empty() && verb.count("--json") > 0) return usage("--json: the name is empty");
    return success();
}

Result<CameraPath> loadPath(const Scene& scene, const RunOptions& options) {
    constexpr uint32_t kDefaultFrames = 16;
    uint64_t city_seed = 0;
    if (options.cameras.empty() && options.frames > 0 && !options.seed_given &&
        isCity(options.scene.procedural(), city_seed))
        return cityStreetPath(city_seed, options.frames);
    PathChoice choice;
    choice.file = options.cameras;
    choice.frames = options.frames == 0 && options.seed_given ? kDefaultFrames : options.frames;
    choice.seed = options.seed;
    return choosePath(scene, choice);
}

int report(const Error& error) {
    const std::string line = "sightline: " + oneLine(error.message) + "\n";
    (void)std::fwrite(line.data(), 1, line.size(), stderr);
    logLine(line);
    switch (error.kind) {
        case Error::Kind::kUsage:
            return kWrongArguments;
        case Error::Kind::kOutput:
            return kOutputUnwritable;
        case Error::Kind::kInput:
            break;
    }
    return kInputUnreadable;
}

Status writeText(const std::string& file, const std::string& text) {
    if (file != "-") return writeFileAside(file, text);
    if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return success();
    return Error{Error::Kind::kOutput, "standard output: cannot be written"};
}

std::string grouped(uint64_t number) { return readable(static_cast<double>(number)); }

std::string quoted(const std::string& word) {
    const auto plain = [](unsigned char c) {
        return std::isalnum(c) || std::string_view("@%+=:,./_-").find(static_cast<char>(c)) != std::string_view::npos;
    };
    if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
    std::string out = "'";
    for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

}  // namespace sightline::cli
