// What several verbs share: the common options, scenes by name, camera paths, errors.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/common.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <thread>
#include <tuple>
#include <utility>

#include <fmt/core.h>

#include "apps/cli/shell/options.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/setting_options.h"
#include "apps/cli/verbs/verbs.h"
#include "sightline/geom/view.h"
#include "sightline/tools/report/output_file.h"
#include "sightline/tools/report/readable.h"
#include "sightline/tools/scene/city/city.h"
#include "sightline/tools/scene/one_line.h"
#include "sightline/tools/scene/scene_core.h"
#include "sightline/tools/scene/suggestion.h"

namespace sightline::cli {
using namespace tools;
namespace {

constexpr uint32_t kLargestSide = 16384;  // [pixels]
constexpr uint32_t kMostFrames = 1000000;
constexpr std::pair<const char*, PathKind> kPathKinds[] = {{"tour", PathKind::kTour},
                                                           {"walk", PathKind::kWalk},
                                                           {"orbit", PathKind::kOrbit},
                                                           {"overview", PathKind::kOverview},
                                                           {"scatter", PathKind::kScatter}};

/// Reads a whole number that is all of the text.
template <class T>
bool readWhole(std::string_view text, T& out) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    return error == std::errc() && end == text.data() + text.size();
}

std::vector<std::string> chosenStageNames() {
    std::vector<std::string> names;
    for (int stage = 0; stage < kStageCount; ++stage)
        if (kAllStages >> stage & 1) names.emplace_back(kStageNames[stage]);
    return names;
}

std::string stageNames() {
    std::string names;
    for (const std::string& name : chosenStageNames()) names += (names.empty() ? "" : ", ") + name;
    return names;
}

Result<uint32_t> readStages(const std::string& option, const std::vector<std::string>& names) {
    uint32_t bits = 0;
    for (const std::string& name : names) {
        const auto* const found = std::find(std::begin(kStageNames), std::end(kStageNames), name);
        if (found == std::end(kStageNames))
            return usageError(fmt::format("{}: there is no stage \"{}\"{} (there are: {})", option, name,
                                          suggestion(name, chosenStageNames()), stageNames()));
        const uint32_t bit = 1u << (found - std::begin(kStageNames));
        if (!(bit & kAllStages))
            return usageError(
                fmt::format("{}: \"{}\" is counted, not chosen: it goes with frustum and occlusion; "
                            "--no-second-look turns it off",
                            option, name));
        bits |= bit;
    }
    return bits;
}

/// Whether a city is walked along its streets, and the seed in its `city:SEED:OBJECTS`, which has been checked by making
/// it.
bool walksStreets(const RunOptions& options, uint64_t& seed) {
    const PathChoice& choice = options.choice;
    if (!choice.file.empty() || choice.eye || choice.kind != PathKind::kAny || choice.walk.frames == 0 || choice.seeded)
        return false;
    const std::string scene = options.scene.procedural();
    return scene.starts_with("city:") && readWhole(std::string_view(scene).substr(5, scene.find(':', 5) - 5), seed);
}

}  // namespace

Status readSize(const std::string& option, const std::string& text, uint32_t& width, uint32_t& height) {
    const std::string_view size = text;
    const size_t cross = size.find('x');
    const bool good = cross != std::string_view::npos && readWhole(size.substr(0, cross), width) &&
                      readWhole(size.substr(cross + 1), height) && width >= 1 && height >= 1 && width <= kLargestSide &&
                      height <= kLargestSide;
    if (good) return success();
    return usageError(fmt::format("{} {}: not WxH with sides from 1 to {}", option, text, kLargestSide));
}

Result<glm::dvec3> readPoint(const char* option, const std::string& text) {
    const std::vector<std::string> parts = splitAt(text, ',');
    glm::dvec3 point(0.0);
    bool good = parts.size() == 3;
    for (int axis = 0; axis < 3 && good; ++axis)
        good = readNumber(parts[static_cast<size_t>(axis)], point[axis]) && std::isfinite(point[axis]);
    if (good) return point;
    return usageError(fmt::format("{} {}: not X,Y,Z of a point", option, text));
}

void addCameraOptions(Command& verb, RunOptions& options, const std::string& shared) {
    std::vector<std::string> paths;
    for (const auto& [word, kind] : kPathKinds) paths.emplace_back(word);
    addSceneChoice(verb, options.scene);
    WalkSettings& walk = options.choice.walk;
    verb.add_option("--cameras", options.choice.file, "camera path (JSON)")->type_name("PATH.json")->group("Cameras");
    verb.add_option("--eye", options.eye, "one camera that stands there [world units]")
        ->type_name("X,Y,Z")
        ->group("Cameras");
    verb.add_option("--look", options.look, "and looks at this point (default: the middle of the scene)")
        ->type_name("X,Y,Z")
        ->group("Cameras");
    verb.add_option("--path", options.path,
                    "a view of the whole and a walk through it; a walk, frame by frame; once around; the whole from "
                    "outside; or cameras that stand anywhere (default: the scene's own cameras, else tour)")
        ->check(OneOf(paths))
        ->type_name(joined(paths, "|"))
        ->group("Cameras");
    verb.add_option("--frames", walk.frames,
                    "so many cameras; a city without --path and --seed is walked along its streets")
        ->check(Range{1u, kMostFrames})
        ->type_name("N")
        ->group("Cameras");
    verb.add_option("--seed", walk.seed, "of the path")->type_name("S")->capture_default_str()->group("Cameras");
    verb.add_option("--fps", walk.fps, "frames a second of a walk")
        ->check(Range{1.0, 10000.0})
        ->type_name("N")
        ->capture_default_str()
        ->group("Cameras");
    verb.add_option("--speed", walk.speed,
                    "of a walk [world units a second]; a map of the Quake family is walked at 320 without it")
        ->check(Range{0.0, 1e9})
        ->type_name("N")
        ->capture_default_str()
        ->group("Cameras");
    verb.add_option("--size", options.size, "of the viewport [pixels]")
        ->type_name("WxH")
        ->capture_default_str()
        ->group("Cameras");
    verb.add_option("--threads", options.threads, "share " + shared + " among so many threads (default: one a core)")
        ->check(Range{1u, kMostThreads})
        ->type_name("N")
        ->group("General");
    verb.add_option("--json", options.json, "write the result as JSON (-: standard output)")->type_name("FILE");
}

void addSceneOptions(Command& verb, RunOptions& options) {
    addCameraOptions(verb, options, "the frames");
    verb.add_option("--repeat", options.repeat, "queries a frame; times are their medians")
        ->check(Range{1, 100000})
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
    addOtherSettingOptions(verb, options.settings);
    addWitnessOptions(verb, options);
}

void addWitnessOptions(Command& verb, RunOptions& options) {
    verb.add_option("--jitter", options.jitter, "largest shift of the image that the answer must hold for")
        ->check(Range{0.0, 1024.0})
        ->type_name("PX")
        ->capture_default_str()
        ->group("Culling");
    verb.add_option("--rays", options.rays, "that the first witness casts for a frame")
        ->check(Range{uint64_t{1}, uint64_t{1} << 40})
        ->type_name("N")
        ->capture_default_str()
        ->group("Culling");
    verb.add_flag("--no-proofs", options.no_proofs, "let rays and an id-buffer alone judge: no exact proofs")
        ->group("Culling");
}

void addStereoOption(Command& verb, RunOptions& options) {
    constexpr double kLeast = 1e-9, kMost = 1e9;
    const auto check = [](const std::string& text) -> std::string {
        double value = 0;
        if (!readNumber(text, value)) return "\"" + text + "\" is not a number";
        if (value >= kLeast && value <= kMost) return {};
        return text + " is not a distance between the eyes, from 1e-9 to 1e9; for one eye leave it out";
    };
    verb.add_option("--stereo", options.stereo,
                    "two eyes so far apart [world units], each with a buffer of its own; pictures are the left one's")
        ->check(Validator{check, "distance"})
        ->type_name("IPD")
        ->group("Culling");
}

void addRememberOption(Command& verb, RunOptions& options) {
    verb.add_flag_callback(
            "--remember", [&options] { options.settings.stateless = false; },
            "frames in order, by one query that remembers what hid and what was visible, as a game asks; "
            "else each frame stands by itself")
        ->group("Culling");
}

void addQueryOptions(Command& verb, RunOptions& options) {
    addStereoOption(verb, options);
    addSettingOptions(verb, options.settings, {"bins", "hysteresis"});
    addRememberOption(verb, options);
    verb.add_flag(
            "--propose", options.propose,
            "tell the query what an id-buffer of the frame before, one sample a pixel, does not show, as a renderer "
            "that asks its GPU can; it culls what it can prove of that; needs --remember")
        ->group("Culling");
    verb.add_flag(
            "--taught", options.taught,
            "learn from another query, which is asked for each frame after this one, as on another thread; its time "
            "does not count; needs --remember")
        ->group("Culling");
    verb.add_option("--query-threads", options.query_threads, "share the bins of each query among so many threads")
        ->check(Range{1u, kMostThreads})
        ->type_name("N")
        ->capture_default_str()
        ->group("Culling");
}

namespace {

/// Checks what is asked of the cameras.
Status finishPath(const Command& verb, RunOptions& options) {
    PathChoice& choice = options.choice;
    choice.seeded = verb.count("--seed") > 0;
    choice.speed_given = verb.count("--speed") > 0;
    const bool made = choice.walk.frames > 0 || choice.seeded || !options.path.empty();
    if (!choice.file.empty() && made) return usageError("--cameras excludes --path, --frames and --seed");
    if (!options.eye.empty() && (made || !choice.file.empty()))
        return usageError("--eye excludes --cameras, --path, --frames and --seed");
    if (!options.look.empty() && options.eye.empty()) return usageError("--look goes with --eye");
    for (auto [option, text, point] :
         {std::tuple("--eye", &options.eye, &choice.eye), std::tuple("--look", &options.look, &choice.look)}) {
        if (text->empty()) continue;
        const Result<glm::dvec3> read = readPoint(option, *text);
        if (!read) return read.error();
        *point = *read;
    }
    for (const auto& [word, kind] : kPathKinds)
        if (options.path == word) choice.kind = kind;
    for (const char* of_walk : {"--fps", "--speed"})
        if (choice.kind != PathKind::kWalk && verb.count(of_walk) > 0)
            return usageError(fmt::format("{} goes with --path walk", of_walk));
    if (!std::isfinite(choice.walk.fps) || !std::isfinite(choice.walk.speed))
        return usageError("--fps, --speed: not a number");  // no range leaves it out
    return success();
}

}  // namespace

Status finish(const Command& verb, RunOptions& options) {
    if (Status size = readSize("--size", options.size, options.width, options.height); !size) return size;
    if (std::isnan(options.jitter)) return usageError("--jitter: not a number");  // no range leaves it out
    if (std::isnan(options.stereo)) return usageError("--stereo: not a number");
    if (Status settings = checkSettings(options.settings); !settings) return settings;
    const QuerySettings& settings = options.settings;
    if (settings.hysteresis > 0 && !(settings.max_distance > 0) && !(settings.contribution > 0) &&
        !(settings.lod_error > 0) && !(settings.budget > 0))
        return usageError("--hysteresis: there is no limit; see --distance, --contribution and --lod-error");
    if (!settings.stateless) {
        const Option repeat = verb.get_option_no_throw("--repeat");
        if (repeat && repeat->count() > 0 && options.repeat > 1)
            return usageError("--remember: each frame is asked once; --repeat would ask it again");
        options.repeat = 1;
        if (options.threads > 1)
            note("--threads: with --remember frames are culled in order, by one thread; the others judge and draw");
    }
    if (options.propose && settings.stateless)
        return usageError("--propose: only a query that remembers takes proposals; see --remember");
    if (options.propose && options.stereo > 0) return usageError("--propose: not for two eyes");
    if (options.taught && settings.stateless)
        return usageError("--taught: only a query that remembers can learn; see --remember");
    if (options.taught && options.stereo > 0) return usageError("--taught: not for two eyes");
    if (options.query_threads > 1 && settings.bins == 1 && options.stereo == 0)
        return usageError("--query-threads: one bin has nothing to share; see --bins");
    const Result<uint32_t> use = readStages("--use", options.use), skip = readStages("--skip", options.skip);
    if (!use) return use.error();
    if (!skip) return skip.error();
    // Clusters take long to prepare: they are for those who ask for them.
    options.settings.stages = (options.use.empty() ? kDefaultStages & ~stageBit(Stage::kClusters) : *use) & ~*skip;
    const Option cluster_test = verb.get_option_no_throw("--cluster-test");
    if (cluster_test && cluster_test->count() > 0 && !options.calibration.empty())
        return usageError("--cluster-test: --calibration tells it, too; give one of them");
    if (Status clusters = finishClusterOptions(options); !clusters) return clusters;
    if (Status sizes = finishSizeOptions(options); !sizes) return sizes;
    if (Status cells = finishVisibilityOptions(options); !cells) return cells;
    noteIdleSettings(options.settings, !options.calibration.empty());
    if (Status path = finishPath(verb, options); !path) return path;
    if (options.threads == 0) options.threads = std::clamp(std::thread::hardware_concurrency(), 1u, kMostThreads);
    const Option json = verb.get_option_no_throw("--json");  // not every verb has it
    if (options.json.empty() && json && json->count() > 0) return usageError("--json: the name is empty");
    return success();
}

Result<CameraPath> loadPath(const Scene& scene, const RunOptions& options) {
    uint64_t city_seed = 0;
    if (walksStreets(options, city_seed)) return cityStreetPath(city_seed, options.choice.walk.frames);
    if (options.choice.file.empty() && !options.choice.eye && !takesOwnCameras(scene, options.choice))
        if (const std::string text = asideText(scene, coreOf(scene).aside); !text.empty())
            note(text + ": the cameras leave what is beyond aside");
    return choosePath(scene, options.choice);
}

std::string ownerOfPath(const Scene& scene, const RunOptions& options) {
    uint64_t city_seed = 0;
    if (!options.choice.file.empty()) return oneLine(options.choice.file);
    if (options.choice.eye) return "--eye " + options.eye;
    if (!options.path.empty()) return "--path " + options.path;
    if (walksStreets(options, city_seed)) return "a walk along the streets";
    return takesOwnCameras(scene, options.choice) ? "the scene's own cameras" : "a tour";
}

std::string frameOf(size_t frame, size_t frames) {
    return frames == 1 ? "the only frame" : fmt::format("frame {} (0 to {})", frame, frames - 1);
}

Status checkFrame(size_t frame, size_t frames) {
    if (frame < frames) return success();
    return usageError(fmt::format("--frame {}: the path has {}, from 0", frame, counted(frames, "frame")));
}

Status writeText(const std::string& file, const std::string& text) {
    if (file != "-") return writeFileAside(file, text);
    if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return success();
    return Error{Error::Kind::kOutput, "standard output: cannot be written"};
}

ApartFiles filesRead(const RunOptions& options) {
    ApartFiles files;
    for (const std::string& name : options.scene.names) files.read("SCENE", name);
    files.read("--cameras", options.choice.file);
    files.read("--visibility", options.visibility.file);
    files.read("--calibration", options.calibration);
    return files;
}

Status canWriteFiles(std::initializer_list<std::string> files) {
    for (const std::string& file : files)
        if (!file.empty() && file != "-")
            if (Status writable = canWriteFile(file); !writable) return writable;
    return success();
}

void tellPage(std::FILE* out, const std::string& directory) {
    tell(out, fmt::format("report       {}/index.html\n", directory));
}

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

std::string grouped(uint64_t number) { return readable(static_cast<double>(number)); }

}  // namespace sightline::cli
