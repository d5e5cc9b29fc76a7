// Numbers as a reader takes them.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/readable.h"

#include <cmath>

#include <fmt/core.h>

namespace sightline::tools {

std::string readable(double value) {
    if (!std::isfinite(value)) return "–";
    if (std::abs(value) < 1000) return fmt::format("{:.4g}", value);
    std::string text = fmt::format("{:.0f}", value);
    const size_t first = text[0] == '-' ? 1 : 0;
    for (size_t place = text.size(); place > first + 3; place -= 3) text.insert(place - 3, 1, ',');
    return text;
}

std::string counted(uint64_t count, const char* what) {
    return fmt::format("{} {}{}", readable(static_cast<double>(count)), what, count == 1 ? "" : "s");
}

}  // namespace sightline::tools
