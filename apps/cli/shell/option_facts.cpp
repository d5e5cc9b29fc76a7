// What CLI11 knows of the options of a verb, as help, completions and configuration files ask for it.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/option_facts.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "sightline/geom/view.h"

namespace sightline::cli {
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

bool isFlag(const CLI::Option& option) { return option.get_items_expected_max() == 0; }

std::string valueName(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    return type.substr(0, type.find(':'));
}

std::vector<std::string> choicesOf(const CLI::Option& option) {
    if (isList(option)) return {std::begin(kStageNames), std::end(kStageNames)};
    const std::string type = option.get_type_name();  // of CLI::IsMember "TEXT:{a,b}"
    const size_t open = type.find(":{");
    if (open == std::string::npos || type.back() != '}') return {};
    return CLI::detail::split(type.substr(open + 2, type.size() - open - 3), ',');
}

std::string helpOf(const CLI::Option& option) {
    const std::string text = option.get_description();
    const std::vector<std::string> choices = choicesOf(option);
    if (choices.empty() || valueName(option) != "TEXT") return text;
    return fmt::format("{}{}{}", text, text.empty() ? "" : ": ", fmt::join(choices, ", "));
}

bool isList(const CLI::Option& option) { return valueName(option) == "LIST"; }

bool isWritten(const CLI::Option& option) {
    const std::string name = valueName(option);
    return name.find("FILE") != std::string::npos || name.find("DIR") != std::string::npos;
}

std::vector<std::string> verbNames(const CLI::App& tool) {
    std::vector<std::string> names;
    for (const CLI::App* verb : tool.get_subcommands({})) names.push_back(verb->get_name());
    return names;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& words) {
    constexpr size_t kLongest = 64;  // longer ones are no slips
    std::string best;
    size_t least = word.size() <= kLongest ? std::min<size_t>(2, word.size() / 2) + 1 : 0;
    for (const std::string& each : words)
        if (const size_t d = least > 0 ? distance(word, each) : 0; d < least) {
            least = d;
            best = each;
        }
    return best.empty() ? std::string() : "; did you mean " + best + "?";
}

}  // namespace sightline::cli
