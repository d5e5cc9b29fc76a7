// What a query may be asked for on the command line, group by group: its options, their checks, and the words again.
// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "apps/cli/shell/options.h"
#include "apps/cli/verbs/run_options.h"
#include "sightline/base/result.h"
#include "sightline/geom/query_settings.h"
#include "sightline/tools/report/run/cull_run.h"

namespace sightline::cli {

/// --visibility, --windows, --portal-depth and --door.
void addVisibilityOptions(Command& verb, RunOptions& options);
/// Checks them, after the stages are known: without a file the stages of cells are out of use. Errors are kUsage.
Status finishVisibilityOptions(RunOptions& options);

/// The options again, as a shell takes them, each with a space before it; what is default is left out.
std::string visibilityOptionsOf(const VisibilityAsked& asked);

void addClusterOptions(Command& verb, RunOptions& options);

/// Reads the calibration, if one was given, into RunOptions::cluster_test.
Status finishClusterOptions(RunOptions& options);

/// With a blank before it; empty for the default.
std::string clusterOptionsOf(double cluster_test);

/// --distance and --contribution.
void addSizeOptions(Command& verb, RunOptions& options);

/// Checks them against --use, and takes the stages out of RunOptions::settings that have nothing to do. Errors are kUsage.
Status finishSizeOptions(RunOptions& options);

/// --section, as often as there are planes.
void addSectionOptions(Command& verb, RunOptions& options);

/// " --section=A,B,C,D" of each.
std::string sectionOptionsOf(const ViewPlanes& sections);

/// Adds the options of some rows, by their names there.
void addSettingOptions(Command& verb, QuerySettings& settings, std::initializer_list<std::string_view> names);
/// Adds the options of all rows but those that verbs add by name.
void addOtherSettingOptions(Command& verb, QuerySettings& settings);

/// What no range of a single option leaves out: numbers that are none. Errors are kUsage.
Status checkSettings(const QuerySettings& settings);

/// Notes which settings were given that do nothing beside the others: each with its reason.
/// @param calibrated  the costs of drawing are a calibration's
void noteIdleSettings(const QuerySettings& settings, bool calibrated);

/// The settings that are as the tool has them by default, and the library has not: "hysteresis 0 (there 0.1)".
std::string ownDefaults(const QuerySettings& settings);

/// The options again, as a shell takes them, each with a space before it; what is as the tool has it is left out.
std::string settingWords(const QuerySettings& settings);

}  // namespace sightline::cli
