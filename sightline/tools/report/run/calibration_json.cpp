// What was measured of a machine, as a file: the schema `sightline.calibration/1`.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/calibration_json.h"

#include <cmath>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "sightline/tools/scene/json_text.h"
#include "sightline/tools/scene/one_line.h"

namespace sightline::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "sightline.calibration/1";
constexpr const char* kProfileSchema = "sightline.profile/1";  // has the fields in its "costs"
constexpr const char* kTest = "cluster_test_ns";
constexpr const char* kDropped = "triangle_dropped_ns";
constexpr const char* kDrawn = "triangle_drawn_ns";

Error wrongFile(const std::string& file, const std::string& what) {
    return {Error::Kind::kInput, fmt::format("{}: {}", oneLine(file), what)};
}

}  // namespace

std::string calibrationJson(const FacingCosts& costs, const std::string& machine) {
    Json out;
    out["schema"] = kSchema;
    out["machine"] = machine;
    out[kTest] = costs.test;
    out[kDropped] = costs.dropped;
    out[kDrawn] = costs.drawn;
    return jsonText(out, 2) + "\n";
}

Result<FacingCosts> parseCalibration(std::string_view text, const std::string& file) {
    const auto fail = [&](const std::string& what) { return wrongFile(file, what); };
    nlohmann::json json = parseJsonOrNone(text);
    if (json.is_discarded()) return fail("not JSON");
    if (!json.is_object()) return fail("not an object");
    const auto schema = json.find("schema");
    const std::string name = schema != json.end() && schema->is_string() ? schema->get<std::string>() : std::string();
    if (name == kProfileSchema) {
        const auto of_profile = json.find("costs");
        if (of_profile == json.end() || !of_profile->is_object()) return fail("costs: missing");
        json = nlohmann::json(*of_profile);
    } else if (name != kSchema) {
        return fail(fmt::format("schema: neither {} nor {}", kSchema, kProfileSchema));
    }
    FacingCosts costs;
    const std::pair<const char*, double*> fields[] = {
        {kTest, &costs.test}, {kDropped, &costs.dropped}, {kDrawn, &costs.drawn}};
    for (const auto& [field, value] : fields) {
        const auto at = json.find(field);
        if (at == json.end()) return fail(fmt::format("{}: missing", field));
        *value = at->is_number() ? at->get<double>() : 0.0;
        if (!(*value > 0.0) || !std::isfinite(*value)) return fail(fmt::format("{}: not a number above 0", field));
    }
    return costs;
}

Result<std::optional<DrawCost>> parseDrawCost(std::string_view text, const std::string& file) {
    const nlohmann::json json = parseJsonOrNone(text);
    if (!json.is_object()) return wrongFile(file, json.is_discarded() ? "not JSON" : "not an object");
    if (json.value("schema", nlohmann::json()) != nlohmann::json(kProfileSchema)) return std::optional<DrawCost>();
    const auto costs = json.find("costs");
    if (costs == json.end() || !costs->is_object()) return wrongFile(file, "costs: missing");
    DrawCost cost;
    const std::pair<const char*, double*> fields[] = {{"object_ns", &cost.object},
                                                      {"triangle_ns", &cost.triangle},
                                                      {"vertex_ns", &cost.vertex},
                                                      {"pixel_ns", &cost.pixel}};
    for (const auto& [field, value] : fields) {
        const auto at = costs->find(field);
        if (at == costs->end()) return wrongFile(file, fmt::format("{}: missing", field));
        *value = at->is_number() ? at->get<double>() : -1.0;
        if (!(*value >= 0.0) || !std::isfinite(*value))
            return wrongFile(file, fmt::format("{}: not a number from 0 on", field));
    }
    return std::optional<DrawCost>(cost);
}

}  // namespace sightline::tools
