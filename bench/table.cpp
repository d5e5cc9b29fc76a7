// The rows of a benchmark: one measured value each, beside its plain baseline.
// SPDX-License-Identifier: MIT
#include "bench/table.h"

#include <algorithm>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "sightline/tools/profile/facing_costs.h"
#include "sightline/tools/scene/json_text.h"

namespace sightline::bench {
using namespace tools;

std::string toText(const Table& table) {
    size_t where = 4, what = 4;
    for (const Row& row : table.rows) {
        where = std::max(where, row.where.size());
        what = std::max(what, row.what.size());
    }
    std::string text = fmt::format("bench {} on {}\n", table.name, machineName());
    for (const Row& row : table.rows) {
        text += fmt::format("{:<{}}  {:<{}}  {:>12.4g} {}", row.where, where, row.what, what, row.value, row.unit);
        if (!row.baseline.empty())
            text += fmt::format("{:<{}} {:>7.3f}x of {:.4g}, {}", "", row.unit.size() < 14 ? 14 - row.unit.size() : 0,
                                row.ratio(), row.baseline_value, row.baseline);
        text += row.note.empty() ? "\n" : fmt::format("; {}\n", row.note);
    }
    return text;
}

std::string toJson(const Table& table) {
    nlohmann::ordered_json json{{"schema", "sightline.bench/1"}, {"name", table.name}, {"machine", machineName()}};
    json["rows"] = nlohmann::ordered_json::array();
    for (const Row& row : table.rows) {
        json["rows"].push_back({{"case", row.where},
                                {"what", row.what},
                                {"value", row.value},
                                {"unit", row.unit},
                                {"baseline", row.baseline},
                                {"baseline_value", row.baseline_value},
                                {"ratio", row.ratio()}});
        if (!row.note.empty()) json["rows"].back()["note"] = row.note;
    }
    if (!table.faults.empty()) json["faults"] = table.faults;
    return jsonText(json, 2) + "\n";
}

}  // namespace sightline::bench
