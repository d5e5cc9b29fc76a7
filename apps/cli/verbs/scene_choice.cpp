// Which scene a verb is to look at: files, procedural ones or several of both, and how files are read.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/scene_choice.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "apps/cli/shell/options.h"
#include "apps/cli/shell/progress.h"
#include "apps/cli/shell/quoted.h"
#include "apps/cli/shell/session.h"
#include "sightline/query/record/frame_recording.h"
#include "sightline/tools/import/scene_file.h"
#include "sightline/tools/load/recorded_scene.h"
#include "sightline/tools/report/readable.h"
#include "sightline/tools/scene/one_line.h"
#include "sightline/tools/scene/procedural.h"
#include "sightline/tools/scene/scene_core.h"
#include "sightline/tools/scene/text_file.h"

namespace sightline::cli {
using namespace tools;
namespace {

struct Unit {
    std::string_view name;
    double metres;
};

constexpr std::array kUnits =
    std::to_array<Unit>({{"m", 1}, {"cm", 0.01}, {"mm", 0.001}, {"km", 1000}, {"in", 0.0254}, {"ft", 0.3048}});

/// A positive number at the beginning of a text; what follows it stays in the text.
std::optional<double> takeNumber(std::string_view& text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || !(value > 0) || !std::isfinite(value)) return std::nullopt;
    text.remove_prefix(static_cast<size_t>(end - text.data()));
    return value;
}

Error wrongValue(const std::string& option, const std::string& value, const std::string& what) {
    return {Error::Kind::kUsage, fmt::format("{} {}: {}", option, value, what)};
}

Status readUnit(const std::string& text, double& out) {
    for (const Unit& unit : kUnits)
        if (unit.name == text) {
            out = unit.metres;
            return success();
        }
    std::string_view rest = text;
    const std::optional<double> value = takeNumber(rest);
    if (!value || !rest.empty() || *value < 1e-12 || *value > 1e12)
        return wrongValue("--unit", text, "not m, cm, mm, km, in, ft or a length in metres");
    out = *value;
    return success();
}

Status readMemory(const std::string& text, uint64_t& out) {
    std::string_view rest = text;
    const std::optional<double> value = takeNumber(rest);
    constexpr std::string_view kPrefixes = "KMGT";
    int shift = 0;
    if (!rest.empty())
        if (const size_t at = kPrefixes.find(rest[0]); at != std::string_view::npos) {
            shift = 10 * (static_cast<int>(at) + 1);
            rest.remove_prefix(1);
        }
    if (rest == "B" || rest == "iB") rest = {};
    const double bytes = value ? std::ldexp(*value, shift) : 0;
    if (!value || !rest.empty() || bytes < double(1 << 20) || bytes > 1e18)
        return wrongValue("--import-memory", text, "not a size from 1M on, as in 8G");
    out = static_cast<uint64_t>(bytes);
    return success();
}

Status readTime(const std::string& text, double& out) {
    std::string_view rest = text;
    const std::optional<double> value = takeNumber(rest);
    if (rest == "s") rest = {};
    if (!value || !rest.empty() || *value > 1e8) return wrongValue("--import-time", text, "not a number of seconds");
    out = *value;
    return success();
}

Result<ImportSettings> settingsOf(const SceneChoice& choice) {
    ImportSettings out;
    if (!choice.up.empty()) out.up = choice.up == "x" ? UpAxis::kX : choice.up == "y" ? UpAxis::kY : UpAxis::kZ;
    if (!choice.sides.empty())
        out.sides = choice.sides == "one" ? Sides::kOne : choice.sides == "both" ? Sides::kBoth : Sides::kAsFileSays;
    if (!choice.unit.empty())
        if (Status good = readUnit(choice.unit, out.scale); !good) return good.error();
    if (!choice.memory.empty())
        if (Status good = readMemory(choice.memory, out.memory_limit); !good) return good.error();
    if (!choice.time.empty())
        if (Status good = readTime(choice.time, out.time_limit); !good) return good.error();
    return out;
}

/// The options that were given, as pairs of a name and a value.
std::vector<std::pair<std::string, std::string>> optionsOf(const SceneChoice& choice) {
    std::vector<std::pair<std::string, std::string>> out;
    for (const auto& [name, value] : {std::pair<const char*, const std::string&>{"--up", choice.up},
                                      {"--unit", choice.unit},
                                      {"--sides", choice.sides},
                                      {"--import-memory", choice.memory},
                                      {"--import-time", choice.time}})
        if (!value.empty()) out.emplace_back(name, value);
    return out;
}

/// Whether a word begins a procedural scene, and no file is called so.
bool isBegun(const std::string& word) {
    std::error_code ignored;
    return isProcedural(word + ":") && !std::filesystem::exists(word, ignored);
}

Result<Scene> loadRecordedFrame(const std::string& name, const ImportSettings& settings) {
    const Result<std::string> bytes = readTextFile(name);
    if (!bytes) return bytes.error();
    const Result<FrameRecording> recording = parseRecording(*bytes, name);
    if (!recording) return recording.error();
    Scene scene = recordedScene(*recording);
    scene.name = name;
    scene.files = {{name, 0}};
    placeScene(scene, settings);
    return scene;
}

/// Of a name that no file has: whether it is written as a procedural scene is, as "town:1:5".
bool seemsProcedural(const std::string& name) {
    std::error_code ignored;
    const size_t colon = name.find(':');
    return colon != std::string::npos && colon > 1 && name.find_first_of("./\\") == std::string::npos &&
           !std::filesystem::exists(name, ignored);
}

Result<Scene> loadOne(const std::string& name, ImportSettings settings) {
    if (isProcedural(name)) return makeProcedural(name);
    if (isBegun(name)) return makeProcedural(name);  // which says what there is
    if (seemsProcedural(name))
        return Error{Error::Kind::kInput,
                     oneLine(name) +
                         ": no such file; procedural scenes are city:SEED:OBJECTS, building:SEED:FLOORS, "
                         "terrain:SEED:SIZE and made:NAME"};
    if (isRecordedFrame(name)) return loadRecordedFrame(name, settings);
    Progress progress("reading " + std::filesystem::path(name).filename().string(), "parts", 0);
    settings.progress = [&](size_t done, size_t total) { progress.set(done, total); };
    settings.note = [](const std::string& text) { note(text); };
    return loadSceneFile(name, settings);
}

/// Says which objects the file may draw otherwise than they stand, and what follows.
void tellOfChanges(const Scene& scene) {
    const auto tell = [&](SceneObject::Change change, const char* head, const char* tail) {
        std::vector<uint32_t> which;
        for (uint32_t i = 0; i < scene.objects.size(); ++i)
            if (scene.objects[i].changes & change) which.push_back(i);
        if (!which.empty())
            note(fmt::format("{} {} ({}): {}", head, counted(which.size(), "object"), namesOf(scene, which), tail));
    };
    tell(SceneObject::kAnimated, "the file may move, show or hide", "hides nothing, and a bake takes it as moving");
    tell(SceneObject::kLevels, "from afar the file draws other shapes for", "hides nothing in a bake or an export");
}

/// Says so where objects that reach through half a scene hold most of it, and what may help.
void tellOfWideObjects(const Scene& scene) {
    constexpr uint64_t kMany = 20000;
    const uint64_t all = drawnTriangles(scene);
    const WideObjects wide = wideObjects(scene);
    if (wide.triangles < kMany || wide.triangles < all / 2) return;
    note(fmt::format("{} {:.0f} % of the triangles: --split grid:8 may cull more of them, in a longer query",
                     wide.objects == 1 ? "one object through half the scene holds"
                                       : fmt::format("{} objects through half the scene hold", wide.objects),
                     100.0 * static_cast<double>(wide.triangles) / static_cast<double>(all)));
}

}  // namespace

bool isRecordedFrame(const std::string& name) {
    char head[sizeof recording_file::kMagic] = {};
    std::ifstream file(name, std::ios::binary);
    return file.read(head, sizeof head) && isRecording(head);
}

std::string SceneChoice::title() const { return joinedFew(names); }

std::string SceneChoice::words() const {
    std::string words;
    for (const std::string& name : names)  // a name that looks like an option needs its directory
        words += (words.empty() ? "" : " ") + quoted(name.starts_with('-') ? "./" + name : name);
    for (const auto& [name, value] : optionsOf(*this)) words += " " + name + " " + quoted(value);
    if (!split.empty()) words += " --split " + split;
    return words;
}

std::string SceneChoice::procedural() const {
    return names.size() == 1 && isProcedural(names.front()) ? names.front() : std::string();
}

std::string SceneChoice::plainFile() const {
    const bool is_plain =
        names.size() == 1 && !isProcedural(names.front()) && up.empty() && unit.empty() && sides.empty();
    return is_plain ? names.front() : std::string();
}

void addSceneChoice(Command& verb, SceneChoice& choice) {
    verb.add_option("SCENE", choice.names,
                    "files (sightline info --formats lists what can be read) or procedural scenes, as city:1:100000, "
                    "building:1:3, terrain:1:256 or made:cycle; several are joined")
        ->required()
        ->expected(1, 1000);
    verb.add_option(
            "--split", choice.split,
            "cut meshes into objects of their own: what hangs together, what is of one material, or what lies in "
            "one cube of a grid with N cubes along a mesh's longest side")
        ->type_name("parts|materials|grid:N")
        ->group("Input");
    addImportOptions(verb, choice);
}

void addImportOptions(Command& verb, SceneChoice& choice) {
    verb.add_option("--up", choice.up, "the axis of the files that points up")
        ->check(OneOf{"x", "y", "z"})
        ->type_name("x|y|z")
        ->group("Input");
    verb.add_option("--unit", choice.unit, "length of one unit of the files: m, cm, mm, km, in, ft or so many metres")
        ->type_name("UNIT")
        ->group("Input");
    verb.add_option("--sides", choice.sides, "which sides of surfaces are drawn (default: as the files say)")
        ->check(OneOf{"file", "one", "both"})
        ->type_name("file|one|both")
        ->group("Input");
    verb.add_option("--import-memory", choice.memory, "for readers of foreign formats (default: 8G)")
        ->type_name("SIZE")
        ->group("Input");
    verb.add_option("--import-time", choice.time, "for readers of foreign formats (default: 300 seconds)")
        ->type_name("S")
        ->group("Input");
}

Result<Scene> loadWholeScene(const SceneChoice& choice, Split& split) {
    const Result<ImportSettings> settings = settingsOf(choice);
    if (!settings) return settings.error();
    if (!choice.split.empty()) {
        Result<Split> read = readSplit(choice.split);
        if (!read) return Error{read.error().kind, "--split: " + read.error().message};
        split = *read;
    }
    if (std::all_of(choice.names.begin(), choice.names.end(), isProcedural) && !optionsOf(choice).empty())
        return Error{Error::Kind::kUsage,
                     fmt::format("{}: says how files are read, but there is none", optionsOf(choice).front().first)};
    std::vector<Scene> scenes;
    for (const std::string& name : choice.names) {
        Result<Scene> scene = loadOne(name, *settings);
        if (!scene) return scene;
        scenes.push_back(std::move(*scene));
    }
    Scene joined = joinScenes(std::move(scenes));
    if (joined.objects.empty())
        return Error{
            Error::Kind::kInput,
            joined.name + ": draws nothing: it has cells or portals alone; name the scene that they belong to, too"};
    tellOfChanges(joined);
    if (choice.split.empty()) tellOfWideObjects(joined);
    return joined;
}

Result<Scene> loadScene(const SceneChoice& choice) {
    Split split;
    Result<Scene> scene = loadWholeScene(choice, split);
    if (!scene) return scene;
    return splitScene(std::move(*scene), split);
}

}  // namespace sightline::cli
