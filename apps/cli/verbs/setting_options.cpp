// What a query may be asked for on the command line, group by group: its options, their checks, and the words again.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/setting_options.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include <fmt/core.h>

#include "apps/cli/shell/options.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/shell/quoted.h"
#include "sightline/geom/setting_rows.h"
#include "sightline/tools/report/run/calibration_json.h"
#include "sightline/tools/report/run/cull_run.h"
#include "sightline/tools/scene/text_file.h"

namespace sightline::cli {
using namespace tools;
namespace {

/// Reads "NAME=0.5"; a name may hold a '='.
DoorAsked readDoor(const std::string& text) {
    const size_t equals = text.rfind('=');
    DoorAsked door;
    const bool good = equals != std::string::npos && equals > 0 && readNumber(text.substr(equals + 1), door.open) &&
                      door.open >= 0 && door.open <= 1;
    if (!good) refuse("--door", "wants NAME=OPEN, from 0 (shut) to 1 (open), not '" + text + "'");
    door.name = text.substr(0, equals);
    return door;
}

bool names(const std::vector<std::string>& list, Stage stage) {
    return std::find(list.begin(), list.end(), kStageNames[static_cast<int>(stage)]) != list.end();
}

[[noreturn]] void refusePlane(const std::string& text) {
    refuse("--section", "wants four numbers A,B,C,D: Ax + By + Cz + D >= 0 is kept, not '" + text + "'");
}

glm::dvec4 readPlane(const std::string& text) {
    const std::vector<std::string> parts = splitAt(text, ',');
    glm::dvec4 plane(0.0);
    if (parts.size() != 4) refusePlane(text);
    for (int i = 0; i < 4; ++i)
        if (!readNumber(parts[static_cast<size_t>(i)], plane[i]) || !std::isfinite(plane[i])) refusePlane(text);
    if (glm::dvec3(plane) == glm::dvec3(0.0))
        refuse("--section", "A, B and C are all 0 in '" + text + "': that is no plane");
    return plane;
}

constexpr double kGapIfNotSaid = 1.0 / 1024.0;  // --close-gaps alone  [pixels of the buffer]

template <class Value>
std::string optionOf(const SettingRow<Value>& row) {
    return std::string("--") + row.option;
}

template <class Value>
std::string helpOf(const SettingRow<Value>& row) {
    return std::string(row.help) + (*row.unit ? fmt::format(" [{}]", row.unit) : "");
}

/// Reads a number from 0, which may have its unit behind it, as in 2px. Without an upper limit it may be infinite.
double readFromZero(const std::string& option, const SettingRow<double>& row, std::string text) {
    const std::string given = text;
    if (text.size() > 2 && text.ends_with("px")) text.resize(text.size() - 2);
    double value = 0;
    const bool endless = row.most >= 1e300;
    if (!readNumber(text, value) || !(value >= 0.0 && (endless || value <= row.most)))
        refuse(option, endless ? fmt::format("wants a distance from 0 (off), not '{}'", given)
                               : fmt::format("wants {} from 0 (off) to {}, not '{}'", row.unit, row.most, given));
    return value;
}

void addSetting(Command& verb, const SettingRow<bool>& row, QuerySettings& settings) {
    const bool standard = row.standard();
    verb.add_flag_callback(
            optionOf(row), [&settings, row, standard] { settings.*row.member = !standard; }, row.help)
        ->group("Culling");
}

void addSetting(Command& verb, const SettingRow<PortalWindows>& row, QuerySettings& settings) {
    verb.add_option_function<std::string>(
            optionOf(row),
            [&settings, row](const std::string& name) {
                const auto* const found = std::find(std::begin(kWindowNames), std::end(kWindowNames), name);
                settings.*row.member = static_cast<PortalWindows>(found - std::begin(kWindowNames));
            },
            row.help)
        ->check(OneOf(std::begin(kWindowNames), std::end(kWindowNames)))
        ->default_str(kWindowNames[static_cast<int>(row.standard())])
        ->group("Culling");
}

void addSetting(Command& verb, const SettingRow<uint32_t>& row, QuerySettings& settings) {
    verb.add_option(optionOf(row), settings.*row.member, helpOf(row))
        ->check(Range{static_cast<uint32_t>(row.least), static_cast<uint32_t>(row.most)})
        ->type_name("N")
        ->capture_default_str()
        ->group("Culling");
}

void addSetting(Command& verb, const SettingRow<double>& row, QuerySettings& settings) {
    const std::string option = optionOf(row);
    // Those that are off unless they are asked for may have their unit behind them.
    const bool off = row.member == &QuerySettings::max_distance || row.member == &QuerySettings::contribution;
    const bool gap = row.member == &QuerySettings::close_gaps;
    if (!off && !gap) {
        verb.add_option(option, settings.*row.member, helpOf(row))
            ->check(Range{row.least, row.most})
            ->type_name("X")
            ->capture_default_str()
            ->group("Culling");
        return;
    }
    Option added = verb.add_option_function<std::string>(
        option,
        [&settings, row, option, gap](const std::string& text) {
            const bool alone = gap && (text.empty() || text == "true" || text == "{}");
            settings.*row.member = alone ? kGapIfNotSaid : readFromZero(option, row, text);
        },
        helpOf(row) + (gap ? fmt::format(" [alone: 1/{:g}]", 1.0 / kGapIfNotSaid) : ""));
    added->type_name("X")->group("Culling");
    if (gap) added->expected(0, 1);
}

template <class Value>
std::string wordsOf(const SettingRow<Value>& row, Value value) {
    if constexpr (std::is_same_v<Value, bool>) return " " + optionOf(row);
    else if constexpr (std::is_same_v<Value, PortalWindows>)
        return fmt::format(" {} {}", optionOf(row), kWindowNames[static_cast<int>(value)]);
    else return fmt::format(" {} {}", optionOf(row), value);
}

}  // namespace

void addVisibilityOptions(Command& verb, RunOptions& options) {
    VisibilityAsked& asked = options.visibility;
    verb.add_option("--visibility", asked.file, "what `sightline bake` made of this scene: its cells, portals and rows")
        ->type_name("FILE")
        ->group("Culling");
    addSettingOptions(verb, options.settings, {"windows", "portal_depth"});
    verb.add_option_function<std::vector<std::string>>(
            "--door",
            [&asked](const std::vector<std::string>& doors) {
                asked.doors.clear();
                for (const std::string& door : doors) asked.doors.push_back(readDoor(door));
            },
            "how far a door is open: 0 is shut, 1 open [may be given many times; default: all are open]")
        ->expected(1)
        ->take_all()
        ->type_name("NAME=OPEN")
        ->group("Culling");
}

Status finishVisibilityOptions(RunOptions& options) {
    const VisibilityAsked& asked = options.visibility;
    if (!asked.file.empty()) return success();
    if (options.settings.windows != QuerySettings().windows) return usageError("--windows goes with --visibility");
    if (options.settings.portal_depth > 0) return usageError("--portal-depth goes with --visibility");
    if (!asked.doors.empty()) return usageError("--door goes with --visibility");
    for (const Stage stage : {Stage::kPvs, Stage::kPortals})
        if (names(options.use, stage))
            return usageError(fmt::format("--use {}: goes with --visibility", kStageNames[static_cast<int>(stage)]));
    options.settings.stages &= ~kCellStages;
    return success();
}

std::string visibilityOptionsOf(const VisibilityAsked& asked) {
    std::string words;
    if (asked.file.empty()) return words;
    words += " --visibility " + quoted(asked.file);
    for (const DoorAsked& door : asked.doors) words += " --door " + quoted(fmt::format("{}={}", door.name, door.open));
    return words;
}

void addClusterOptions(Command& verb, RunOptions& options) {
    verb.add_option_function<double>(
            "--cluster-test",
            [&options](const double& test) {
                if (!(test > 0.0) || std::isinf(test)) refuse("--cluster-test", "wants a number above 0");
                options.cluster_test = test;
            },
            "what a cluster's test costs, in triangles: for the stage clusters")
        ->default_str(fmt::format("{}", RunOptions().cluster_test))
        ->type_name("T")
        ->group("Culling");
    verb.add_option("--calibration", options.calibration, "takes that from a file of calibrate")
        ->type_name("FILE")
        ->group("Culling");
    verb.add_flag("--dear-shading", options.dear_shading, "of the calibration, what dear shading says")
        ->group("Culling");
}

Status finishClusterOptions(RunOptions& options) {
    if (options.calibration.empty()) {
        if (!options.dear_shading) return success();
        return Error{Error::Kind::kUsage, "--dear-shading: says which figure of --calibration is taken"};
    }
    const Result<std::string> text = readTextFile(options.calibration);
    if (!text) return text.error();
    const Result<FacingCosts> costs = parseCalibration(*text, options.calibration);
    if (!costs) return costs.error();
    options.cluster_test = costs->testInTriangles(options.dear_shading ? ShadingCost::kDear : ShadingCost::kCheap);
    const Result<std::optional<DrawCost>> cost = parseDrawCost(*text, options.calibration);
    if (!cost) return cost.error();
    if (!*cost || drawCost(options.settings).known()) return success();
    options.settings.cost_object = (*cost)->object;
    options.settings.cost_triangle = (*cost)->triangle;
    options.settings.cost_vertex = (*cost)->vertex;
    options.settings.cost_pixel = (*cost)->pixel;
    return success();
}

std::string clusterOptionsOf(double cluster_test) {
    return cluster_test == 0 || cluster_test == RunOptions().cluster_test
               ? ""
               : fmt::format(" --cluster-test {}", cluster_test);
}

void addSizeOptions(Command& verb, RunOptions& options) {
    addSettingOptions(verb, options.settings, {"max_distance", "contribution"});
}

Status finishSizeOptions(RunOptions& options) {
    const auto needs = [](const char* stage) {
        return Error{Error::Kind::kUsage, fmt::format("--use {}: how much is told by --{}", stage, stage)};
    };
    QuerySettings& settings = options.settings;
    if (names(options.use, Stage::kDistance) && !(settings.max_distance > 0)) return needs("distance");
    if (names(options.use, Stage::kContribution) && !(settings.contribution > 0)) return needs("contribution");
    if (names(options.use, Stage::kLod) && !(settings.lod_error > 0) && !(settings.budget > 0))
        return usageError("--use lod: how much is told by --lod-error or --budget");
    if (settings.budget > 0 && !drawCost(settings).known())
        return usageError("--budget: what drawing costs is told by --cost-triangle and its like, or by --calibration");
    if (settings.hard_budget && !(settings.budget > 0)) return usageError("--hard-budget goes with --budget");
    // What was given asks for its stage, and --use lists the others.
    for (const Stage stage : {Stage::kDistance, Stage::kContribution, Stage::kLod})
        if (!options.use.empty() && !names(options.skip, stage)) settings.stages |= stageBit(stage);
    settings.stages = stagesInUse(View(), settings);
    return success();
}

void addSectionOptions(Command& verb, RunOptions& options) {
    verb.add_option_function<std::vector<std::string>>(
            "--section",
            [&options](const std::vector<std::string>& planes) {
                options.sections = {};
                for (const std::string& plane : planes)
                    if (!options.sections.add(readPlane(plane)))
                        refuse("--section", fmt::format("{} planes at most", ViewPlanes::kMost));
            },
            "cut the scene open: what is not on the side Ax + By + Cz + D >= 0 is not drawn [may be given 8 times]")
        ->expected(1)
        ->take_all()
        ->type_name("A,B,C,D")
        ->group("Culling");
}

std::string sectionOptionsOf(const ViewPlanes& sections) {
    std::string words;
    for (const glm::dvec4& plane : sections.all())
        words += fmt::format(" --section={},{},{},{}", plane.x, plane.y, plane.z, plane.w);
    return words;
}

void addSettingOptions(Command& verb, QuerySettings& settings, std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names)
        forEachSetting([&](const auto& row) {
            if (name == row.name && row.option) addSetting(verb, row, settings);
        });
}

void addOtherSettingOptions(Command& verb, QuerySettings& settings) {
    // Of cells, of sizes, and of a path of frames: each stands among its like.
    constexpr std::string_view kElsewhere[] = {"windows",      "portal_depth", "max_distance",
                                               "contribution", "bins",         "hysteresis"};
    forEachSetting([&](const auto& row) {
        if (row.option && std::find(std::begin(kElsewhere), std::end(kElsewhere), row.name) == std::end(kElsewhere))
            addSetting(verb, row, settings);
    });
}

Status checkSettings(const QuerySettings& settings) {
    Status status = success();
    forEachSetting([&](const auto& row) {
        if constexpr (std::is_same_v<std::decay_t<decltype(row.standard())>, double>)
            if (row.option && std::isnan(settings.*row.member))
                status = Error{Error::Kind::kUsage, optionOf(row) + ": not a number"};
    });
    return status;
}

namespace {

constexpr const char* kNoOcclusion = "the stage occlusion is off";
constexpr const char* kNoBudget = "there is no budget; see --budget";

/// A setting that does nothing beside others.
struct IdleRow {
    const char* name;  ///< of kQuerySettings
    bool (*idle)(const QuerySettings& settings);
    const char* why;
};
bool hasNoOcclusion(const QuerySettings& s) { return !(s.stages & stageBit(Stage::kOcclusion)); }
bool hasNoBudget(const QuerySettings& s) { return !(s.budget > 0); }
constexpr IdleRow kIdleRows[] = {
    {"occluder_triangles_limit", hasNoOcclusion, kNoOcclusion},
    {"occlusion_size", hasNoOcclusion, kNoOcclusion},
    {"masked", hasNoOcclusion, kNoOcclusion},
    {"occluder_error", hasNoOcclusion, kNoOcclusion},
    {"close_gaps", hasNoOcclusion, kNoOcclusion},
    {"faces", hasNoOcclusion, kNoOcclusion},
    {"second_look", hasNoOcclusion, kNoOcclusion},
    {"second_look_polygons_limit", hasNoOcclusion, kNoOcclusion},
    {"second_look_polygons_limit", [](const QuerySettings& s) { return !s.second_look; }, "--no-second-look"},
    {"lod_fade", [](const QuerySettings& s) { return !(s.stages & stageBit(Stage::kLod)); },
     "no levels of detail are chosen; see --lod-error and --budget"},
    {"cost_object", hasNoBudget, kNoBudget},
    {"cost_triangle", hasNoBudget, kNoBudget},
    {"cost_vertex", hasNoBudget, kNoBudget},
    {"cost_pixel", hasNoBudget, kNoBudget},
};

}  // namespace

void noteIdleSettings(const QuerySettings& settings, bool calibrated) {
    const QuerySettings standard = toolSettings();
    for (const IdleRow& idle : kIdleRows)
        forEachSetting([&](const auto& row) {
            if (std::string_view(row.name) != idle.name || settings.*row.member == standard.*row.member) return;
            if (calibrated && idle.why == kNoBudget) return;  // nobody asked for these costs by name
            if (idle.idle(settings)) note(fmt::format("{} has no effect: {}", optionOf(row), idle.why));
        });
}

std::string ownDefaults(const QuerySettings& settings) {
    const QuerySettings tool = toolSettings(), library;
    std::string words;
    forEachSetting([&](const auto& row) {
        using Value = std::decay_t<decltype(settings.*row.member)>;
        const Value value = settings.*row.member;
        if (std::string_view(row.name) == "stages" || value != tool.*row.member || value == library.*row.member) return;
        words += words.empty() ? "" : ", ";
        if constexpr (std::is_same_v<Value, bool>) words += fmt::format("{} {}", row.name, value ? "on" : "off");
        else if constexpr (!std::is_same_v<Value, PortalWindows>)
            words += fmt::format("{} {} (there {})", row.name, value, library.*row.member);
    });
    return words;
}

std::string settingWords(const QuerySettings& settings) {
    const QuerySettings standard = toolSettings();
    std::string words;
    forEachSetting([&](const auto& row) {
        if (row.option && settings.*row.member != standard.*row.member) words += wordsOf(row, settings.*row.member);
    });
    return words;
}

}  // namespace sightline::cli
