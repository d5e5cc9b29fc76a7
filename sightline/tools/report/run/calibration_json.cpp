// What was measured of a machine, as a file: the schema `sightline.calibration/1`.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/calibration_json.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sightline/tools/scene/one_line.h"

namespace sightline::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "sightline.calibration/1";
constexpr const char* kTest = "cluster_test_ns";
constexpr const char* kDropped = "triangle_dropped_ns";
constexpr const char* kDrawn = "triangle_drawn_ns";

}  // namespace

std::string calibrationJson(const FacingCosts& costs, const std::string& machine) {
    Json out;
    out["schema"] = kSchema;
    out["machine"] = machine;
    out[kTest] = costs.test;
    out[kDropped] = costs.dropped;
    out[kDrawn] = costs.drawn;
    return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<FacingCosts> parseCalibration(std::string_view text, const std::string& file) {
    const auto fail = [&](const std::string& what) {
        return Error{Error::Kind::kInput, fmt::format("{}: {}", oneLine(file), what)};
    };
    const Json json = Json::parse(text, nullptr, false);
    if (json.is_discarded()) return fail("not JSON");
    if (!json.is_object()) return fail("not an object");
    const auto schema = json.find("schema");
    if (schema == json.end() || !schema->is_string() || schema->get<std::string>() != kSchema)
        return fail(fmt::format("schema: not {}", kSchema));
    FacingCosts costs;
    const std::pair<const char*, double*> fields[] = {
        {kTest, &costs.test}, {kDropped, &costs.dropped}, {kDrawn, &costs.drawn}};
    for (const auto& [name, value] : fields) {
        const auto at = json.find(name);
        if (at == json.end()) return fail(fmt::format("{}: missing", name));
        *value = at->is_number() ? at->get<double>() : 0.0;
        if (!(*value > 0.0) || !std::isfinite(*value)) return fail(fmt::format("{}: not a number above 0", name));
    }
    return costs;
}

}  // namespace sightline::tools
