// The command line tool: verbs, their help, and what the exit code says.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/cli/common.h"
#include "apps/cli/completions.h"
#include "apps/cli/config.h"
#include "apps/cli/help.h"
#include "apps/cli/man.h"
#include "apps/cli/option_facts.h"
#include "apps/cli/session.h"
#include "apps/cli/verbs.h"
#include "apps/cli/watch.h"

namespace sightline::cli {
namespace {

std::string commandLine(int count, char** words) {
    std::string line = "sightline";
    for (int i = 1; i < count; ++i) line += " " + quoted(words[i]);
    return line;
}

/// The verb that was being parsed, as "sightline cull".
std::string verbOf(const CLI::App& tool) {
    const auto chosen = tool.get_subcommands();
    return "sightline" + (chosen.empty() ? std::string() : " " + chosen.front()->get_name());
}

std::vector<std::string> verbNames(const CLI::App& tool) {
    std::vector<std::string> names;
    for (const CLI::App* verb : verbsOf(tool)) names.push_back(verb->get_name());
    return names;
}

/// What the parser found wrong, with a word that may have been meant.
std::string explained(const CLI::App& tool, const CLI::ParseError& error) {
    std::string meant;
    if (dynamic_cast<const CLI::ExtrasError*>(&error)) {
        const auto chosen = tool.get_subcommands();
        const CLI::App& app = chosen.empty() ? tool : *chosen.front();
        const std::vector<std::string> extras = app.remaining();
        std::vector<std::string> names;
        for (const OptionFacts& facts : optionsOf(app))
            names.insert(names.end(), facts.names.begin(), facts.names.end());
        if (!extras.empty() && extras[0].substr(0, 2) == "--")
            meant = suggestion(extras[0].substr(0, extras[0].find('=')), names);
    }
    return fmt::format("{}{} (see {} --help)", error.what(), meant, verbOf(tool));
}

/// A word that gives a flag a value, which the parser would take: "--masked=3". Empty: there is none.
std::string flagWithValue(const CLI::App& tool, int count, char** words) {
    const CLI::App* app = &tool;
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        if (word == "--") break;
        if (word.substr(0, 1) != "-") {
            for (const CLI::App* verb : app == &tool ? verbsOf(tool) : std::vector<const CLI::App*>())
                if (verb->get_name() == word) app = verb;
            continue;
        }
        const size_t equals = word.find('=');
        if (equals == std::string::npos) continue;
        const CLI::Option* option = app->get_option_no_throw(word.substr(0, equals));
        if (option && option->get_items_expected_max() == 0) return word;
    }
    return "";
}

/// All that happens between the command line and the verb.
void beginVerb(CLI::App& tool, SessionOptions& session, const std::string& command) {
    CLI::App& verb = *tool.get_subcommands().front();
    const auto insist = [](const Status& status) {
        if (!status) throw CLI::RuntimeError(report(status.error()));
    };
    if (!session.config.empty() && session.no_config)
        insist(Error{Error::Kind::kUsage, "--no-config excludes --config"});
    if (session.watch)
        if (const std::optional<int> ended = watchRuns(verb, session)) throw CLI::RuntimeError(*ended);
    const ConfigChoice config = findConfig(session);
    const Status configured = applyConfig(tool, verb, config);
    insist(beginSession(session, "sightline " SIGHTLINE_VERSION, command));
    if (config.here && verb.get_configurable()) note("options are taken from ./" + config.file);
    insist(configured);
}

int runTool(int count, char** words) {
    CLI::App tool(kAbout, "sightline");
    tool.set_version_flag("--version", "sightline " SIGHTLINE_VERSION, "print the version");
    tool.require_subcommand(1);
    int exit_code = kDone;
    addCull(tool, exit_code);
    addVerify(tool, exit_code);
    addRender(tool, exit_code);
    addExplain(tool, exit_code);
    addReplay(tool, exit_code);
    addVis(tool, exit_code);
    addBake(tool, exit_code);
    addCalibrate(tool, exit_code);
    addReport(tool, exit_code);
    addInfo(tool, exit_code);
    addBench(tool, exit_code);
    // The options that every verb has; what follows tells of the tool itself.
    SessionOptions session;
    addSessionOptions(tool, session);
    for (CLI::App* verb : tool.get_subcommands({})) {
        addSessionOptions(*verb, session);
        verb->configurable();
        if (verb->get_option_no_throw("SCENE")) addWatchOption(*verb, session);
    }
    addConfig(tool, session, exit_code);
    addSessionOptions(*tool.get_subcommand("config"), session);
    addHelp(tool, exit_code);
    addCompletions(tool, exit_code);
    addMan(tool, "sightline " SIGHTLINE_VERSION, exit_code);
    dressHelp(tool);
    tool.parse_complete_callback([&] { beginVerb(tool, session, commandLine(count, words)); });

    if (count <= 1) {
        std::fputs(tool.help().c_str(), stderr);
        return kWrongArguments;
    }
    const std::string first = words[1];
    const std::vector<std::string> names = verbNames(tool);
    if (first.substr(0, 1) != "-" && std::find(names.begin(), names.end(), first) == names.end())
        return report({Error::Kind::kUsage, fmt::format("there is no verb \"{}\"{} (see sightline --help)", first,
                                                        suggestion(first, names))});
    if (const std::string word = flagWithValue(tool, count, words); !word.empty())
        return report(
            {Error::Kind::kUsage, fmt::format("{}: {} takes no value", word, word.substr(0, word.find('=')))});
    try {
        tool.parse(count, words);
    } catch (const CLI::RuntimeError& error) { return error.get_exit_code(); } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return tool.exit(error);  // --help and --version
        return report({Error::Kind::kUsage, explained(tool, error)});
    }
    return exit_code;
}

}  // namespace
}  // namespace sightline::cli

int main(int count, char** words) {
    using sightline::Error;
    using namespace sightline::cli;
    openSession();
    int exit_code = kDone;
    try {
        exit_code = runTool(count, words);
    } catch (const std::bad_alloc&) {
        exit_code = report({Error::Kind::kInput, "not enough memory for this scene"});
    } catch (const std::exception& error) {
        // What a full or closed standard output throws is endSession()'s concern.
        if (!std::ferror(stdout)) exit_code = report({Error::Kind::kInput, error.what()});
    }
    return endSession(exit_code);
}
