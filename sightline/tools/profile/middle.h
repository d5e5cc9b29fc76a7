// Medians, and how well they are known.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace sightline::tools {

/// The median; of an even number the mean of both in the middle; 0 of none.
inline double middleOf(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// Standard error of the median, by the median of deviations, which a spike does not move: 1.4826 of it are a standard
/// deviation of normal noise, and a median errs by sqrt(pi / 2) as much as a mean.
inline double middleError(const std::vector<double>& values) {
    const double middle = middleOf(values);
    std::vector<double> off;
    off.reserve(values.size());
    for (const double value : values) off.push_back(std::abs(value - middle));
    const double count = static_cast<double>(std::max<size_t>(values.size(), 1));
    return 1.2533 * 1.4826 * middleOf(std::move(off)) / std::sqrt(count);
}

}  // namespace sightline::tools
