// Numbers as a reader takes them.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/readable.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace sightline::tools {

std::string readable(double value, int digits) {
    constexpr double kNothing = 1e-9;
    if (!std::isfinite(value)) return "–";
    if (std::abs(value) < kNothing) return "0";
    const int exponent = static_cast<int>(std::floor(std::log10(std::abs(value))));
    std::string text = fmt::format("{:.{}f}", value, std::max(digits - 1 - exponent, 0));
    size_t point = text.find('.');
    if (point == std::string::npos) point = text.size();
    else text.erase(std::max(text.find_last_not_of('0'), point - 1) + 1);
    if (text.size() == point + 1) text.pop_back();
    const size_t first = text[0] == '-' ? 1 : 0;
    for (size_t place = point; place > first + 3; place -= 3) text.insert(place - 3, 1, ',');
    return text;
}

std::string counted(uint64_t count, const char* what) {
    return fmt::format("{} {}{}", readable(static_cast<double>(count)), what, count == 1 ? "" : "s");
}

}  // namespace sightline::tools
