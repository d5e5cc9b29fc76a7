// The options of what was baked: the visibility file, how windows are known, and how far doors are open.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/visibility_options.h"

#include "apps/cli/shell/fault.h"
#include "apps/cli/shell/quoted.h"

#include <cmath>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/cli/verbs/setting_options.h"

namespace sightline::cli {
using namespace tools;
namespace {

/// Reads "NAME=0.5"; a name may hold a '='.
DoorAsked readDoor(const std::string& text) {
    const size_t equals = text.rfind('=');
    DoorAsked door;
    const bool good = equals != std::string::npos && equals > 0 &&
                      CLI::detail::lexical_cast(text.substr(equals + 1), door.open) && door.open >= 0 && door.open <= 1;
    if (!good) throw CLI::ValidationError("--door", "wants NAME=OPEN, from 0 (shut) to 1 (open), not '" + text + "'");
    door.name = text.substr(0, equals);
    return door;
}

}  // namespace

void addVisibilityOptions(CLI::App& verb, RunOptions& options) {
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
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->type_name("NAME=OPEN")
        ->group("Culling");
}

Status finishVisibilityOptions(RunOptions& options) {
    const VisibilityAsked& asked = options.visibility;
    if (!asked.file.empty()) return success();
    if (options.settings.portal_depth > 0) return usageError("--portal-depth goes with --visibility");
    if (!asked.doors.empty()) return usageError("--door goes with --visibility");
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

}  // namespace sightline::cli
