// The rows of a benchmark: one measured value each, beside its plain baseline.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "sightline/base/result.h"

namespace sightline::bench {

struct Row {
    std::string where;  ///< the case: a scene or a size
    std::string what;
    double value = 0;
    std::string unit;
    std::string baseline;  ///< what it is compared with
    double baseline_value = 0;
    std::string note = {};  ///< printed behind it; may be empty

    double ratio() const { return baseline_value != 0 ? value / baseline_value : 0; }
};

struct Table {
    std::string name;
    std::vector<Row> rows;
    std::vector<std::string> faults = {};  ///< of a proof that was asked for, a line each; none: it holds
};

/// Adds the rows of one case.
struct Rows {
    Table& table;
    std::string where;
    std::string unit = {};  ///< of values that come without one
    double scale = 1;       ///< of these

    void operator()(const std::string& what, double value, const std::string& of, const std::string& baseline,
                    double base, const std::string& note = {}) const {
        table.rows.push_back({where, what, value, of, baseline, base, note});
    }
    void operator()(const std::string& what, double value, const std::string& baseline, double base,
                    const std::string& note = {}) const {
        (*this)(what, value * scale, unit, baseline, base * scale, note);
    }
};

/// Aligned columns for a reader.
std::string toText(const Table& table);

/// The schema `sightline.bench/1`.
std::string toJson(const Table& table);

}  // namespace sightline::bench
