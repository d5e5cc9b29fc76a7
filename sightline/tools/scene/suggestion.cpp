// A slip of the pen: which of some words was meant.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/suggestion.h"

#include <algorithm>
#include <numeric>

namespace sightline::tools {
namespace {

/// Levenshtein's distance: how many characters must be changed, left out or put in.
size_t distance(const std::string& a, const std::string& b) {
    std::vector<size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t{0});
    for (size_t i = 1; i <= a.size(); ++i) {
        size_t diagonal = i - 1;
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            const size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, changed});
        }
    }
    return row.back();
}

}  // namespace

std::string suggestion(const std::string& word, const std::vector<std::string>& words) {
    constexpr size_t kLongest = 64;  // longer ones are no slips
    std::string best;
    size_t least = word.size() <= kLongest ? std::min<size_t>(2, word.size() / 2) + 1 : 0;
    for (const std::string& each : words)
        if (const size_t d = least > 0 ? distance(word, each) : 0; d < least) {
            least = d;
            best = each;
        }
    // Or the only one that begins so.
    const auto begins = [&](const std::string& each) { return each.starts_with(word); };
    if (best.empty() && word.size() >= 3 && std::count_if(words.begin(), words.end(), begins) == 1)
        best = *std::find_if(words.begin(), words.end(), begins);
    return best.empty() ? std::string() : "; did you mean " + best + "?";
}

}  // namespace sightline::tools
