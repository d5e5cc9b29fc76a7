// Configuration files: sections of keys and values, the part of TOML that options need.
// SPDX-License-Identifier: MIT
//
// TOML 1.0, https://toml.io. Of it: comments, [sections], bare and quoted keys, strings of one line, integers, floats,
// booleans, and arrays of these. Not of it: dotted keys, tables in tables, dates, strings of several lines.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sightline/base/result.h"

namespace sightline::cli {

struct ConfigEntry {
    enum class Kind : uint8_t { kText, kNumber, kSwitch, kList };
    std::string section;  ///< empty: before the first one
    std::string key;
    Kind kind = Kind::kText;
    std::vector<std::string> words;  ///< one, or a list's; numbers and `true` as they are written, without underscores
    uint32_t line = 0;               ///< from 1
};

struct ConfigFile {
    std::string name;
    std::vector<ConfigEntry> entries;   ///< in the file's order; no section has a key twice
    std::vector<ConfigEntry> sections;  ///< section and line alone

    /// "sightline.toml:3: what is wrong", as an input that cannot be read.
    Error fault(uint32_t line, const std::string& what) const;
};

/// Errors (kInput) are one line with the name and the line.
/// @param name  for errors
Result<ConfigFile> parseConfig(std::string_view text, const std::string& name);

/// @param text  [limit: 1 MiB]
Result<ConfigFile> readConfig(const std::string& file);

/// A string as TOML has it, in double quotes.
std::string tomlText(std::string_view text);

}  // namespace sightline::cli
