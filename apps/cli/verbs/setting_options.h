// A query's settings on the command line: an option for each row of their table that has one, and the words again.
// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "sightline/base/result.h"
#include "sightline/geom/query_settings.h"

namespace CLI {
class App;
}

namespace sightline::cli {

/// Adds the options of some rows, by their names there.
void addSettingOptions(CLI::App& verb, QuerySettings& settings, std::initializer_list<std::string_view> names);
/// Adds the options of all rows but those that verbs add by name.
void addOtherSettingOptions(CLI::App& verb, QuerySettings& settings);

/// What no range of a single option leaves out: numbers that are none. Errors are kUsage.
Status checkSettings(const QuerySettings& settings);

/// The options again, as a shell takes them, each with a space before it; what is as the tool has it is left out.
std::string settingWords(const QuerySettings& settings);

}  // namespace sightline::cli
