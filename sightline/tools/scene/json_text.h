// JSON to text and back. nlohmann's lexer, parser and serializer are compiled here alone: each costs a second a file.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace sightline::tools {

/// Bytes that are no UTF-8 become U+FFFD.
/// @param indent  of each level [blanks]; negative: all in one line
std::string jsonText(const nlohmann::ordered_json& json, int indent = -1);
std::string jsonText(const nlohmann::json& json, int indent = -1);

/// Throws nlohmann::json::exception for what is no JSON.
nlohmann::json parseJson(std::string_view text);
/// A value that is_discarded() for what is no JSON.
nlohmann::json parseJsonOrNone(std::string_view text);

}  // namespace sightline::tools
