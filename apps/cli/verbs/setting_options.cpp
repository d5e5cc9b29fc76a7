// A query's settings on the command line: an option for each row of their table that has one, and the words again.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/setting_options.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "sightline/tools/report/run/cull_run.h"

namespace sightline::cli {
using namespace tools;
namespace {

constexpr double kGapIfNotSaid = 1.0 / 1024.0;  // --close-gaps alone  [pixels of the buffer]

template <class Value>
std::string optionOf(const SettingRow<Value>& row) {
    return std::string("--") + row.option;
}

template <class Value>
std::string helpOf(const SettingRow<Value>& row) {
    return std::string(row.help) + (*row.unit ? fmt::format(" [{}]", row.unit) : "");
}

/// Reads a number above 0, which may have its unit behind it, as in 2px.
double readAbove(const std::string& option, const SettingRow<double>& row, std::string text) {
    const std::string given = text;
    if (text.size() > 2 && text.ends_with("px")) text.resize(text.size() - 2);
    double value = 0;
    if (!CLI::detail::lexical_cast(text, value) || !(value > 0.0 && value <= row.most))
        throw CLI::ValidationError(
            option, row.most < 1e9 ? fmt::format("wants {}, above 0 and up to {}, not '{}'", row.unit, row.most, given)
                                   : fmt::format("wants a distance above 0, not '{}'", given));
    return value;
}

void addSetting(CLI::App& verb, const SettingRow<bool>& row, QuerySettings& settings) {
    const bool standard = row.standard();
    verb.add_flag_callback(
            optionOf(row), [&settings, row, standard] { settings.*row.member = !standard; }, row.help)
        ->group("Culling");
}

void addSetting(CLI::App& verb, const SettingRow<PortalWindows>& row, QuerySettings& settings) {
    verb.add_option_function<std::string>(
            optionOf(row),
            [&settings, row](const std::string& name) {
                const auto* const found = std::find(std::begin(kWindowNames), std::end(kWindowNames), name);
                settings.*row.member = static_cast<PortalWindows>(found - std::begin(kWindowNames));
            },
            row.help)
        ->check(CLI::IsMember(std::vector<std::string>(std::begin(kWindowNames), std::end(kWindowNames))))
        ->default_str(kWindowNames[static_cast<int>(row.standard())])
        ->group("Culling");
}

void addSetting(CLI::App& verb, const SettingRow<uint32_t>& row, QuerySettings& settings) {
    verb.add_option(optionOf(row), settings.*row.member, helpOf(row))
        ->check(CLI::Range(static_cast<uint32_t>(row.least), static_cast<uint32_t>(row.most)))
        ->type_name("N")
        ->capture_default_str()
        ->group("Culling");
}

void addSetting(CLI::App& verb, const SettingRow<double>& row, QuerySettings& settings) {
    const std::string option = optionOf(row);
    // Those that are off unless they are asked for want a number that means something.
    const bool off = row.member == &QuerySettings::max_distance || row.member == &QuerySettings::contribution;
    const bool gap = row.member == &QuerySettings::close_gaps;
    if (!off && !gap) {
        verb.add_option(option, settings.*row.member, helpOf(row))
            ->check(CLI::Range(row.least, row.most))
            ->type_name("X")
            ->capture_default_str()
            ->group("Culling");
        return;
    }
    CLI::Option* const added = verb.add_option_function<std::string>(
        option,
        [&settings, row, option, gap](const std::string& text) {
            const bool alone = gap && (text.empty() || text == "true" || text == "{}");
            settings.*row.member = alone ? kGapIfNotSaid : readAbove(option, row, text);
        },
        helpOf(row) + (gap ? fmt::format(" [alone: 1/{:g}]", 1.0 / kGapIfNotSaid) : ""));
    added->type_name("X")->group("Culling");
    if (gap) added->expected(0, 1);
}

template <class Value>
std::string wordsOf(const SettingRow<Value>& row, Value value) {
    if constexpr (std::is_same_v<Value, bool>) return " " + optionOf(row);
    else if constexpr (std::is_same_v<Value, PortalWindows>)
        return fmt::format(" {} {}", optionOf(row), kWindowNames[static_cast<int>(value)]);
    else return fmt::format(" {} {}", optionOf(row), value);
}

}  // namespace

void addSettingOptions(CLI::App& verb, QuerySettings& settings, std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names)
        forEachSetting([&](const auto& row) {
            if (name == row.name && row.option) addSetting(verb, row, settings);
        });
}

void addOtherSettingOptions(CLI::App& verb, QuerySettings& settings) {
    // Of cells, of sizes, and of a path of frames: each stands among its like.
    constexpr std::string_view kElsewhere[] = {"windows",      "portal_depth", "max_distance",
                                               "contribution", "bins",         "hysteresis"};
    forEachSetting([&](const auto& row) {
        if (row.option && std::find(std::begin(kElsewhere), std::end(kElsewhere), row.name) == std::end(kElsewhere))
            addSetting(verb, row, settings);
    });
}

Status checkSettings(const QuerySettings& settings) {
    Status status = success();
    forEachSetting([&](const auto& row) {
        if constexpr (std::is_same_v<std::decay_t<decltype(row.standard())>, double>)
            if (row.option && std::isnan(settings.*row.member))
                status = Error{Error::Kind::kUsage, optionOf(row) + ": not a number"};
    });
    return status;
}

std::string settingWords(const QuerySettings& settings) {
    const QuerySettings standard = toolSettings();
    std::string words;
    forEachSetting([&](const auto& row) {
        if (row.option && settings.*row.member != standard.*row.member) words += wordsOf(row, settings.*row.member);
    });
    return words;
}

}  // namespace sightline::cli
