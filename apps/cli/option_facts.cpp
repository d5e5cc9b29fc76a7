// What the options of a verb are, for all that lists them: help, the man page, completions, the configuration.
// SPDX-License-Identifier: MIT
#include "apps/cli/option_facts.h"

#include <algorithm>
#include <iterator>

#include <CLI/CLI.hpp>

#include "bench/bench.h"
#include "sightline/geom/view.h"

namespace sightline::cli {
namespace {

constexpr const char* kOrder[] = {"Input",   "Cameras", "Culling", "Options", "Pictures",
                                  "Methods", "Depth",   "Output",  "General"};

/// The heading's place; headings that verbs bring stand where "Options" does.
size_t placeOf(const std::string& group) {
    const auto* const found = std::find(std::begin(kOrder), std::end(kOrder), group);
    return static_cast<size_t>((found == std::end(kOrder) ? &kOrder[3] : found) - kOrder);
}

/// The words of CLI::IsMember, whose type reads "TEXT:{a,b}".
std::vector<std::string> choicesIn(const std::string& type) {
    const size_t open = type.find(":{");
    if (open == std::string::npos || type.back() != '}') return {};
    return CLI::detail::split(type.substr(open + 2, type.size() - open - 3), ',');
}

OptionFacts factsOf(const CLI::App& app, const CLI::Option& option) {
    OptionFacts facts;
    facts.option = &option;
    facts.positional = option.get_positional() && option.get_lnames().empty() && option.get_snames().empty();
    if (facts.positional) facts.names = {option.get_name()};
    for (const std::string& name : option.get_snames()) facts.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) facts.names.push_back("--" + name);
    const std::string type = option.get_type_name();
    if (option.get_type_size() != 0) facts.value = type.substr(0, type.find(':'));
    facts.choices = choicesIn(type);
    if (app.get_name() == "bench" && facts.positional) facts.choices = bench::names();
    if (facts.value == "LIST") {
        facts.list = true;
        facts.choices.assign(std::begin(kStageNames), std::end(kStageNames));
    }
    facts.help = option.get_description();
    facts.standard = option.get_type_size() == 0 ? "" : option.get_default_str();
    facts.group = facts.positional ? "Input" : option.get_group();
    facts.required = option.get_required();
    facts.several = option.get_items_expected_max() > 1 && !facts.list;
    return facts;
}

}  // namespace

std::string OptionFacts::key() const {
    const std::string& name = *std::max_element(
        names.begin(), names.end(), [](const std::string& a, const std::string& b) { return a.size() < b.size(); });
    return name.substr(std::min(name.find_first_not_of('-'), name.size()));
}

bool OptionFacts::writes() const {
    return value.find("FILE") != std::string::npos || value.find("DIR") != std::string::npos;
}

std::vector<OptionFacts> optionsOf(const CLI::App& app) {
    std::vector<OptionFacts> all;
    for (const CLI::Option* option : app.get_options())
        if (!option->get_group().empty()) all.push_back(factsOf(app, *option));
    std::stable_sort(all.begin(), all.end(), [](const OptionFacts& a, const OptionFacts& b) {
        if (a.positional != b.positional) return a.positional;
        return placeOf(a.group) < placeOf(b.group);
    });
    return all;
}

std::vector<const CLI::App*> verbsOf(const CLI::App& tool) {
    return tool.get_subcommands([](const CLI::App* verb) { return !verb->get_group().empty(); });
}

void groupOptions(CLI::App& app) {
    for (CLI::Option* option : app.get_options()) {
        if (option == app.get_help_ptr() || option == app.get_version_ptr()) option->group("General");
        if (option->get_group() != "Options") continue;
        const OptionFacts facts = factsOf(app, *option);
        if (!facts.positional && facts.writes()) option->group("Output");
    }
}

}  // namespace sightline::cli
