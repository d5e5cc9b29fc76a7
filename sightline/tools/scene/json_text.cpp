// JSON to text and back, by nlohmann's library.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/json_text.h"

#include <nlohmann/json.hpp>

namespace sightline::tools {

std::string jsonText(const nlohmann::ordered_json& json, int indent) {
    return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}
std::string jsonText(const nlohmann::json& json, int indent) {
    return json.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

nlohmann::json parseJson(std::string_view text) { return nlohmann::json::parse(text); }
nlohmann::json parseJsonOrNone(std::string_view text) { return nlohmann::json::parse(text, nullptr, false); }

}  // namespace sightline::tools
