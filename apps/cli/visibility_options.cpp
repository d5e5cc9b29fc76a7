// The options of what was baked: the visibility file, how windows are known, and how far doors are open.
// SPDX-License-Identifier: MIT
#include "apps/cli/visibility_options.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace sightline::cli {
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
    verb.add_option("--windows", asked.windows, "how the part of the image that a cell is seen through is known")
        ->check(CLI::IsMember(std::vector<std::string>(std::begin(kWindowNames), std::end(kWindowNames))))
        ->capture_default_str()
        ->group("Culling");
    verb.add_option("--portal-depth", asked.portal_depth,
                    "look through so many portals one after the other at most; what is farther may be visible and is "
                    "culled")
        ->type_name("N")
        ->group("Culling");
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
    const auto usage = [](const std::string& message) { return Error{Error::Kind::kUsage, message}; };
    if (!asked.file.empty()) return success();
    if (asked.portal_depth > 0) return usage("--portal-depth goes with --visibility");
    if (!asked.doors.empty()) return usage("--door goes with --visibility");
    options.stages &= ~kCellStages;
    return success();
}

std::string visibilityOptionsOf(const VisibilityAsked& asked) {
    std::string words;
    if (asked.file.empty()) return words;
    words += " --visibility " + quoted(asked.file);
    if (asked.windows != VisibilityAsked().windows) words += " --windows " + asked.windows;
    if (asked.portal_depth > 0) words += fmt::format(" --portal-depth {}", asked.portal_depth);
    for (const DoorAsked& door : asked.doors) words += " --door " + quoted(fmt::format("{}={}", door.name, door.open));
    return words;
}

void applyVisibility(const VisibilityAsked& asked, View& view) {
    const auto* const found = std::find(std::begin(kWindowNames), std::end(kWindowNames), asked.windows);
    if (found != std::end(kWindowNames)) view.windows = static_cast<PortalWindows>(found - std::begin(kWindowNames));
    view.portal_depth = asked.portal_depth;
}

}  // namespace sightline::cli
