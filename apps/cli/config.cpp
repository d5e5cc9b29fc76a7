// Defaults of options from a configuration file: which file, what it may say, and what is in effect.
// SPDX-License-Identifier: MIT
#include "apps/cli/config.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/cli/common.h"
#include "apps/cli/help.h"
#include "apps/cli/option_facts.h"
#include "apps/cli/session.h"
#include "apps/cli/verbs.h"
#include "sightline/scene/procedural.h"

namespace sightline::cli {
namespace {

constexpr const char* kHere = "sightline.toml";

std::string homeFile() {
    const auto absolute = [](const char* name) -> std::filesystem::path {
        const char* value = std::getenv(name);
        return value && value[0] == '/' ? value : "";
    };
    std::filesystem::path directory = absolute("XDG_CONFIG_HOME");
    if (directory.empty() && !absolute("HOME").empty()) directory = absolute("HOME") / ".config";
    return directory.empty() ? std::string() : (directory / "sightline" / "config.toml").string();
}

bool isThere(const std::string& file) {
    std::error_code ignored;
    return !file.empty() && std::filesystem::is_regular_file(file, ignored);
}

/// Verbs that look at something, and whose options a file may have.
std::vector<const CLI::App*> configurable(const CLI::App& tool) {
    std::vector<const CLI::App*> verbs = verbsOf(tool);
    std::erase_if(verbs, [](const CLI::App* verb) { return !verb->get_configurable(); });
    return verbs;
}

std::vector<OptionFacts> configurableOptions(const CLI::App& verb) {
    std::vector<OptionFacts> options = optionsOf(verb);
    std::erase_if(options, [&](const OptionFacts& facts) {
        return facts.positional || !facts.option->get_configurable() || facts.option == verb.get_help_ptr();
    });
    return options;
}

const OptionFacts* findKey(const std::vector<OptionFacts>& options, const std::string& key) {
    const auto found =
        std::find_if(options.begin(), options.end(), [&](const OptionFacts& facts) { return facts.key() == key; });
    return found == options.end() ? nullptr : &*found;
}

/// Keys and sections that there are; and of files that lie here, none that writes.
Status checkKeys(const CLI::App& tool, const ConfigFile& file, bool here) {
    const std::vector<const CLI::App*> verbs = configurable(tool);
    std::vector<std::string> names;
    for (const CLI::App* verb : verbs) names.push_back(verb->get_name());
    for (const ConfigEntry& section : file.sections)
        if (std::find(names.begin(), names.end(), section.section) == names.end())
            return file.fault(section.line, fmt::format("there is no verb \"{}\" for a section{}", section.section,
                                                        suggestion(section.section, names)));
    for (const ConfigEntry& entry : file.entries) {
        bool known = false, writes = false;
        std::vector<std::string> keys;
        for (const CLI::App* verb : verbs) {
            if (!entry.section.empty() && entry.section != verb->get_name()) continue;
            const std::vector<OptionFacts> options = configurableOptions(*verb);
            for (const OptionFacts& facts : options) keys.push_back(facts.key());
            const OptionFacts* const found = findKey(options, entry.key);
            known |= found != nullptr;
            writes |= found && found->writes();
        }
        const std::string of = entry.section.empty() ? "no verb has" : "\"" + entry.section + "\" has no";
        if (!known)
            return file.fault(entry.line, fmt::format("{} option \"{}\" that a file may set{}", of, entry.key,
                                                      suggestion(entry.key, keys)));
        if (here && writes)
            return file.fault(entry.line, fmt::format("\"{}\" names what is written, which a file that was only found "
                                                      "here may not: ask for it with --config {}",
                                                      entry.key, kHere));
    }
    return success();
}

/// The words as the command line would have them.
std::vector<std::string> wordsOf(const ConfigEntry& entry, const OptionFacts& facts) {
    if (!facts.list || entry.words.empty()) return entry.words;
    return {fmt::format("{}", fmt::join(entry.words, ","))};
}

/// What is wrong with the entry as a value of the option, or nothing.
std::string giveValue(CLI::Option& option, const OptionFacts& facts, const ConfigEntry& entry) {
    const bool flag = facts.value.empty();
    if (flag != (entry.kind == ConfigEntry::Kind::kSwitch))
        return flag ? "is either true or false, without quotes" : "is no switch: true and false are not its values";
    if (flag && entry.words[0] == "false") return {};
    if (entry.kind == ConfigEntry::Kind::kList && !facts.list && !facts.several) return "takes one value, not a list";
    if (entry.words.empty()) return {};
    try {
        option.clear();
        for (const std::string& word : wordsOf(entry, facts)) option.add_result(word);
        option.run_callback();
    } catch (const CLI::Error& error) { return error.what(); }
    return {};
}

/// True if the command line has the option, here or before the verb.
bool isGiven(const CLI::App& tool, const OptionFacts& facts) {
    if (facts.option->count() > 0) return true;
    const CLI::Option* const general = tool.get_option_no_throw("--" + facts.key());
    return general && general->count() > 0;
}

/// What the command line leaves no room for: cameras of two kinds, and how files are read where there are none.
bool isRuledOut(const CLI::App& verb, const OptionFacts& facts, const std::vector<std::string>& given) {
    const auto has = [&](const char* name) { return std::find(given.begin(), given.end(), name) != given.end(); };
    const std::string key = facts.key();
    if (key == "cameras") return has("frames") || has("seed");
    if (key == "frames" || key == "seed") return has("cameras");
    const CLI::Option* const scene = verb.get_option_no_throw("SCENE");
    if (facts.group != "Input" || !scene) return false;
    const std::vector<std::string>& names = scene->results();
    return std::all_of(names.begin(), names.end(), isProcedural);
}

struct ConfigOptions {
    std::string verb;
    bool pattern = false;
};

std::string shown(const OptionFacts& facts, const std::vector<std::string>& words) {
    if (facts.value.empty()) return "true";
    const auto one = [](const std::string& word) {
        double ignored = 0;
        return CLI::detail::lexical_cast(word, ignored) ? word : tomlText(word);
    };
    std::vector<std::string> parts = words;
    if (facts.list && words.size() == 1) parts = CLI::detail::split(words[0], ',');
    if (!facts.list && !facts.several) return one(words[0]);
    for (std::string& part : parts) part = one(part);
    return fmt::format("[{}]", fmt::join(parts, ", "));
}

/// Each verb's options: those that are set with where that was, the others as comments with their defaults.
std::string effective(const CLI::App& tool, const std::string& only, const ConfigChoice& choice,
                      const ConfigFile& file) {
    std::string text = choice.file.empty() ? "# no configuration file\n" : fmt::format("# from {}\n", choice.file);
    for (const CLI::App* verb : configurable(tool)) {
        if (!only.empty() && verb->get_name() != only) continue;
        text += fmt::format("\n[{}]\n", verb->get_name());
        for (const OptionFacts& facts : configurableOptions(*verb)) {
            const ConfigEntry* const entry = findEntry(file, verb->get_name(), facts.key());
            if (facts.option->count() > 0)
                text += fmt::format("{} = {}  # line {}\n", facts.key(), shown(facts, facts.option->results()),
                                    entry ? entry->line : 0);
            else if (!facts.standard.empty() && facts.standard != "[]")
                text += fmt::format("# {} = {}\n", facts.key(), shown(facts, {facts.standard}));
        }
    }
    return text;
}

std::string pattern(const CLI::App& tool, const std::string& only) {
    std::string text =
        "# Defaults of sightline's options: what the command line says comes before them. Lines without # count.\n"
        "# Options above the first section hold for every verb that has them; a verb's section comes before them.\n"
        "# It is read as ./sightline.toml (without options that name files to be written), as\n"
        "# ~/.config/sightline/config.toml, or with --config FILE.\n";
    for (const CLI::App* verb : configurable(tool)) {
        if (!only.empty() && verb->get_name() != only) continue;
        text += fmt::format("\n# {}\n[{}]\n", verb->get_description(), verb->get_name());
        for (const OptionFacts& facts : configurableOptions(*verb)) {
            std::string value = "\"" + facts.value + "\"";
            if (facts.value.empty()) value = "true";
            else if (facts.list) value = "[" + tomlText(facts.choices[0]) + "]";
            else if (!facts.standard.empty() && facts.standard != "[]") value = shown(facts, {facts.standard});
            std::string help = facts.help;
            if (!facts.choices.empty()) help += fmt::format(": {}", fmt::join(facts.choices, ", "));
            text += fmt::format("# {} = {}  # {}\n", facts.key(), value, wrapped(help, 0, 1000));
        }
    }
    return text;
}

Status runConfig(CLI::App& tool, const SessionOptions& session, const ConfigOptions& options) {
    std::vector<std::string> names;
    for (const CLI::App* verb : configurable(tool)) names.push_back(verb->get_name());
    if (!options.verb.empty() && std::find(names.begin(), names.end(), options.verb) == names.end())
        return Error{Error::Kind::kUsage, fmt::format("there is no verb \"{}\" that a file may configure{}",
                                                      options.verb, suggestion(options.verb, names))};
    if (options.pattern) return writeText("-", pattern(tool, options.verb));
    const ConfigChoice choice = findConfig(session);
    ConfigFile file;
    if (!choice.file.empty()) {
        Result<ConfigFile> read = readConfig(choice.file);
        if (!read) return read.error();
        file = std::move(*read);
    }
    for (CLI::App* verb : tool.get_subcommands([](const CLI::App* each) { return each->get_configurable(); }))
        if (options.verb.empty() || options.verb == verb->get_name())
            if (Status applied = applyConfig(tool, *verb, choice); !applied) return applied;
    return writeText("-", effective(tool, options.verb, choice, file));
}

}  // namespace

std::vector<std::string> configPlaces(const SessionOptions& options) {
    if (options.no_config) return {};
    if (!options.config.empty()) return {options.config};
    std::vector<std::string> places = {kHere};
    if (std::string home = homeFile(); !home.empty()) places.push_back(std::move(home));
    return places;
}

ConfigChoice findConfig(const SessionOptions& options) {
    for (const std::string& file : configPlaces(options))
        if (!options.config.empty() || isThere(file)) return {file, options.config.empty() && file == kHere};
    return {};
}

const ConfigEntry* findEntry(const ConfigFile& file, const std::string& verb, const std::string& key) {
    const ConfigEntry* general = nullptr;
    for (const ConfigEntry& entry : file.entries) {
        if (entry.key != key) continue;
        if (entry.section == verb) return &entry;
        if (entry.section.empty()) general = &entry;
    }
    return general;
}

Status applyConfig(const CLI::App& tool, CLI::App& verb, const ConfigChoice& choice) {
    if (choice.file.empty() || !verb.get_configurable()) return success();
    const Result<ConfigFile> file = readConfig(choice.file);
    if (!file) return file.error();
    if (Status good = checkKeys(tool, *file, choice.here); !good) return good;
    const std::vector<OptionFacts> options = configurableOptions(verb);
    std::vector<std::string> given;
    for (const OptionFacts& facts : options)
        if (isGiven(tool, facts)) given.push_back(facts.key());
    for (const OptionFacts& facts : options) {
        const ConfigEntry* const entry = findEntry(*file, verb.get_name(), facts.key());
        if (!entry || std::find(given.begin(), given.end(), facts.key()) != given.end()) continue;
        if (isRuledOut(verb, facts, given)) continue;
        CLI::Option& option = *verb.get_option(facts.names.back());
        if (const std::string wrong = giveValue(option, facts, *entry); !wrong.empty())
            return file->fault(entry->line, fmt::format("\"{}\": {}", entry->key, wrong));
    }
    return success();
}

void addConfig(CLI::App& tool, const SessionOptions& session, int& exit_code) {
    CLI::App* verb = tool.add_subcommand("config", "what would be in effect from a configuration file");
    const auto options = std::make_shared<ConfigOptions>();
    verb->add_option("VERB", options->verb, "of this verb alone");
    verb->add_flag("--template", options->pattern, "print a file to begin with: every option, as a comment");
    verb->callback([&tool, &session, &exit_code, options] {
        const Status done = runConfig(tool, session, *options);
        exit_code = done ? kDone : report(done.error());
    });
}

}  // namespace sightline::cli
