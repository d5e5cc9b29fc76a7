// Defaults of options from a configuration file in TOML: which file, what it may say, and what is in effect.
// SPDX-License-Identifier: MIT
//
// TOML 1.0, https://toml.io, is read by toml++; a section is a verb, a key the long name of one of its options.
#include "apps/cli/shell/config.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "apps/cli/shell/help.h"
#include "apps/cli/shell/other_verbs.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/verbs.h"
#include "sightline/tools/scene/procedural.h"
#include "sightline/tools/scene/suggestion.h"
#include "sightline/tools/scene/text_file.h"

#define TOML_EXCEPTIONS 0
#include <toml++/toml.h>

namespace sightline::cli {
using namespace tools;
namespace {

using Words = std::vector<std::string>;

constexpr const char* kHere = "sightline.toml";
constexpr size_t kMostBytes = size_t{1} << 16;  // a.a.a... nests so deep that the stack may end where there are more

/// A key with its value.
struct Entry {
    std::string section;  ///< empty: above all sections
    std::string key;
    const toml::node* value;
};

class File {
public:
    static Result<File> read(const std::string& name) {
        const Result<std::string> text = readTextFile(name, kMostBytes);
        if (!text) return text.error();
        toml::parse_result parsed = toml::parse(*text, name);
        if (!parsed) return fault(name, parsed.error().source(), std::string(parsed.error().description()));
        return File(name, std::move(parsed).table());
    }

    static Error fault(const std::string& name, const toml::source_region& at, const std::string& what) {
        return {Error::Kind::kInput, fmt::format("{}:{}: {}", name, at.begin.line, what)};
    }
    Error fault(const toml::node& at, const std::string& what) const { return fault(name_, at.source(), what); }

    const toml::table& table() const { return table_; }

    /// What holds for an option of a verb, or null.
    const toml::node* find(const std::string& verb, const std::string& key) const {
        if (const toml::table* section = table_[verb].as_table())
            if (const toml::node* value = section->get(key)) return value;
        const toml::node* value = table_.get(key);
        return value && !value->is_table() ? value : nullptr;
    }

private:
    File(std::string name, toml::table table) : name_(std::move(name)), table_(std::move(table)) {}

    std::string name_;
    toml::table table_;
};

std::string homeFile() {
    const auto absolute = [](const char* name) -> std::filesystem::path {
        const char* value = std::getenv(name);
        return value && value[0] == '/' ? value : "";
    };
    std::filesystem::path directory = absolute("XDG_CONFIG_HOME");
    if (directory.empty() && !absolute("HOME").empty()) directory = absolute("HOME") / ".config";
    return directory.empty() ? std::string() : (directory / "sightline" / "config.toml").string();
}

/// Verbs whose options a file may have.
std::vector<const CLI::App*> verbsOf(const CLI::App& tool) {
    return tool.get_subcommands([](const CLI::App* verb) { return verb->get_configurable(); });
}

std::string keyOf(const CLI::Option& option) { return option.get_single_name(); }

std::vector<const CLI::Option*> optionsOf(const CLI::App& verb) {
    return verb.get_options([&](const CLI::Option* option) {
        return option->nonpositional() && option->get_configurable() && option != verb.get_help_ptr();
    });
}

/// True if the verb is of another program: this one knows its name alone.
bool isElsewhere(const CLI::App& tool, const OtherVerb& other) {
    return !tool.get_subcommand(std::string(other.name))->get_configurable();
}

/// That some verb has what an entry sets; and of files that lie here, that it is not written.
Status checkEntry(const CLI::App& tool, const File& file, const Entry& entry, bool here) {
    bool known = false, written = false;
    Words keys;
    // The program that has the verb checks the values.
    for (const OtherVerb& other : otherVerbs()) {
        if (!isElsewhere(tool, other) || (!entry.section.empty() && entry.section != other.name)) continue;
        known |= !entry.section.empty() && other.options.empty();
        for (const OtherOption& option : optionsOf(other)) {
            keys.emplace_back(option.name);
            known |= option.name == entry.key;
            written |= option.name == entry.key && option.written;
        }
    }
    for (const CLI::App* verb : verbsOf(tool)) {
        if (!entry.section.empty() && entry.section != verb->get_name()) continue;
        for (const CLI::Option* option : optionsOf(*verb)) {
            keys.push_back(keyOf(*option));
            known |= keys.back() == entry.key;
            written |= keys.back() == entry.key && isWritten(*option);
        }
    }
    if (!known)
        return file.fault(*entry.value,
                          fmt::format("{} option \"{}\" that a file may set{}",
                                      entry.section.empty() ? "no verb has" : "\"" + entry.section + "\" has no",
                                      entry.key, suggestion(entry.key, keys)));
    if (here && written)
        return file.fault(*entry.value,
                          fmt::format("\"{}\" names what is written, which a file that was only found here "
                                      "may not: ask for it with --config {}",
                                      entry.key, kHere));
    return success();
}

Status checkFile(const CLI::App& tool, const File& file, bool here) {
    Words names;
    for (const CLI::App* verb : verbsOf(tool)) names.push_back(verb->get_name());
    for (const OtherVerb& other : otherVerbs())
        if (other.name != "config") names.emplace_back(other.name);
    std::vector<Entry> entries;
    for (const auto& [key, value] : file.table()) {
        const std::string name(key);
        const toml::table* const section = value.as_table();
        if (!section) {
            entries.push_back({"", name, &value});
            continue;
        }
        if (std::find(names.begin(), names.end(), name) == names.end())
            return file.fault(value,
                              fmt::format("there is no verb \"{}\" for a section{}", name, suggestion(name, names)));
        for (const auto& [inner, each] : *section) entries.push_back({name, std::string(inner), &each});
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        return a.value->source().begin < b.value->source().begin;  // the first fault is told
    });
    for (const Entry& entry : entries)
        if (Status good = checkEntry(tool, file, entry, here); !good) return good;
    return success();
}

/// A text or a number as the command line would have it.
std::optional<std::string> wordOf(const toml::node& value) {
    if (const auto* text = value.as_string()) return text->get();
    if (const auto* number = value.as_integer()) return fmt::format("{}", number->get());
    if (const auto* number = value.as_floating_point()) return fmt::format("{}", number->get());
    return std::nullopt;
}

/// Gives the value to the option.
/// @return what is wrong with it, or nothing
std::string giveValue(CLI::Option& option, const toml::node& value) {
    if (isFlag(option) != value.is_boolean())
        return value.is_boolean() ? "is no switch: true and false are not its values"
                                  : "is either true or false, without quotes";
    Words words;
    if (const auto* flag = value.as_boolean()) {
        if (flag->get()) words.push_back("true");
    } else if (const toml::array* array = value.as_array()) {
        if (option.get_items_expected_max() == 1) return "takes one value, not a list";
        for (const toml::node& each : *array) {
            if (!wordOf(each)) return "takes a list of texts or numbers";
            words.push_back(*wordOf(each));
        }
    } else if (const auto word = wordOf(value)) words.push_back(*word);
    else return "takes a text in quotes, or a number";
    if (words.empty()) return {};
    try {
        option.clear();
        for (const std::string& word : words) option.add_result(word);
        option.run_callback();
    } catch (const CLI::Error& error) { return error.what(); }
    return {};
}

/// What the command line leaves no room for: cameras of two kinds, and how files are read where there are none.
bool isRuledOut(const CLI::App& verb, const CLI::Option& option) {
    const auto given = [&](const char* name) { return verb.get_option_no_throw(name) && verb.count(name) > 0; };
    const std::string key = keyOf(option);
    if (key == "cameras") return given("--frames") || given("--seed");
    if (key == "frames" || key == "seed") return given("--cameras");
    const CLI::Option* const scene = verb.get_option_no_throw("SCENE");
    if (option.get_group() != "Input" || !scene) return false;
    return std::all_of(scene->results().begin(), scene->results().end(), isProcedural);
}

/// A line of the verb `config`: what the file says, else the default or what may stand there, as a comment.
std::string lineOf(const CLI::Option& option, const toml::node* value) {
    if (value) {
        std::ostringstream text;
        text << toml::toml_formatter(*value, toml::format_flags::none);
        return fmt::format("{} = {}  # line {}\n", keyOf(option), text.str(), value->source().begin.line);
    }
    std::string standard = option.get_default_str();
    double ignored = 0;
    if (isFlag(option)) standard = "true";
    else if (isList(option)) standard = fmt::format("[\"{}\"]", choicesOf(option)[0]);
    else if (standard.empty() || standard == "[]") standard = "\"" + valueName(option) + "\"";
    else if (!CLI::detail::lexical_cast(standard, ignored)) standard = "\"" + standard + "\"";
    return fmt::format("# {} = {}  # {}\n", keyOf(option), standard, helpOf(option));
}

Status printConfig(CLI::App& tool, const SessionOptions& session, const std::string& only) {
    const std::vector<const CLI::App*> all = verbsOf(tool);
    Words names;
    for (const CLI::App* verb : all) names.push_back(verb->get_name());
    if (!only.empty() && std::find(names.begin(), names.end(), only) == names.end())
        return Error{Error::Kind::kUsage,
                     fmt::format("there is no verb \"{}\" that a file may configure{}", only, suggestion(only, names))};
    const ConfigChoice choice = findConfig(session);
    std::optional<File> file;
    if (!choice.file.empty()) {
        Result<File> read = File::read(choice.file);
        if (!read) return read.error();
        file = std::move(*read);
    }
    std::string text = choice.file.empty() ? "# no configuration file; lines without # count in one\n"
                                           : fmt::format("# from {}\n", choice.file);
    for (const std::string& name : names) {
        if (!only.empty() && name != only) continue;
        CLI::App& verb = *tool.get_subcommand(name);
        if (Status good = applyConfig(tool, verb, choice); !good) return good;
        text += fmt::format("\n# {}\n[{}]\n", verb.get_description(), name);
        for (const CLI::Option* option : optionsOf(verb))
            text += lineOf(*option, file ? file->find(name, keyOf(*option)) : nullptr);
    }
    return writeText("-", text);
}

}  // namespace

ConfigChoice findConfig(const SessionOptions& options) {
    const auto isThere = [](const std::string& file) {
        std::error_code ignored;
        return !file.empty() && std::filesystem::is_regular_file(file, ignored);
    };
    if (options.no_config) return {};
    if (!options.config.empty()) return {options.config, false};
    if (isThere(kHere)) return {kHere, true};
    if (const std::string home = homeFile(); isThere(home)) return {home, false};
    return {};
}

Status applyConfig(const CLI::App& tool, CLI::App& verb, const ConfigChoice& choice) {
    if (choice.file.empty() || !verb.get_configurable()) return success();
    const Result<File> file = File::read(choice.file);
    if (!file) return file.error();
    if (Status good = checkFile(tool, *file, choice.here); !good) return good;
    std::vector<std::pair<CLI::Option*, const toml::node*>> set;
    for (const CLI::Option* option : optionsOf(verb)) {
        const toml::node* const value = file->find(verb.get_name(), keyOf(*option));
        const CLI::Option* const general = tool.get_option_no_throw("--" + keyOf(*option));
        const bool given = option->count() > 0 || (general && general->count() > 0);
        if (value && !given && !isRuledOut(verb, *option)) set.emplace_back(verb.get_option(option->get_name()), value);
    }
    for (const auto& [option, value] : set)
        if (const std::string wrong = giveValue(*option, *value); !wrong.empty())
            return file->fault(*value, fmt::format("\"{}\": {}", keyOf(*option), wrong));
    return success();
}

void addConfig(CLI::App& tool, const SessionOptions& session, int& exit_code) {
    Command command(&tool);
    CLI::App* verb = &addOtherVerb(command, "config")->cli();
    const auto only = std::make_shared<std::string>();
    verb->add_option("VERB", *only, "of this verb alone");
    verb->callback([&tool, &session, &exit_code, only] {
        const Status done = printConfig(tool, session, *only);
        exit_code = done ? kDone : report(done.error());
    });
}

}  // namespace sightline::cli
