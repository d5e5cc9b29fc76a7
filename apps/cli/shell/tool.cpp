// What the tool does with its words: the verbs, what comes before them, and the exit code.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/tool.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/cli/shell/completions.h"
#include "apps/cli/shell/config.h"
#include "apps/cli/shell/help.h"
#include "apps/cli/shell/option_facts.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/verbs.h"

namespace sightline::cli {
namespace {

/// The verb that was being parsed, as "sightline cull".
std::string verbOf(const CLI::App& tool) {
    const auto chosen = tool.get_subcommands();
    return "sightline" + (chosen.empty() ? std::string() : " " + chosen.front()->get_name());
}

/// What the parser found wrong, with a word that may have been meant.
std::string explained(const CLI::App& tool, const CLI::ParseError& error) {
    std::string what = error.what(), meant;
    if (const size_t at = what.find(" was given a disallowed flag override"); at != std::string::npos)
        what = "--" + what.substr(0, at) + " takes no value";
    if (dynamic_cast<const CLI::ExtrasError*>(&error)) {
        const auto chosen = tool.get_subcommands();
        const CLI::App& app = chosen.empty() ? tool : *chosen.front();
        const std::vector<std::string> extras = app.remaining();
        std::vector<std::string> names;
        for (const CLI::Option* option : app.get_options())
            for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
        if (!extras.empty() && extras[0].substr(0, 2) == "--")
            meant = suggestion(extras[0].substr(0, extras[0].find('=')), names);
    }
    return fmt::format("{}{} (see {} --help)", what, meant, verbOf(tool));
}

/// All that happens between the command line and the verb.
void beginVerb(CLI::App& tool, const SessionOptions& session) {
    CLI::App& verb = *tool.get_subcommands().front();
    const auto insist = [](const Status& status) {
        if (!status) throw CLI::RuntimeError(report(status.error()));
    };
    if (!session.config.empty() && session.no_config)
        insist(Error{Error::Kind::kUsage, "--no-config excludes --config"});
    const ConfigChoice config = findConfig(session);
    insist(applyConfig(tool, verb, config));
    setQuiet(session.quiet);
    if (config.here && verb.get_configurable()) note("options are taken from ./" + config.file);
}

void addVerbs(CLI::App& tool, const BenchVerb& bench, SessionOptions& session, int& exit_code) {
    for (const auto add : {addCull, addVerify, addRender, addExplain, addReplay, addVis, addBake, addCalibrate,
                           addReport, addInfo, bench.add})
        add(tool, exit_code);
    for (CLI::App* verb : tool.get_subcommands({})) verb->configurable();
    // What follows tells of the tool itself.
    addConfig(tool, session, exit_code);
    addCompletions(tool, exit_code);
    addSessionOptions(tool, session);
    for (CLI::App* verb : tool.get_subcommands({})) addSessionOptions(*verb, session);
    dressHelp(tool);
}

/// Whether the words are about the verb `bench`, or its completions or help.
bool isAboutBench(const std::vector<std::string>& words) {
    size_t at = 0;
    if (words.size() > 2 && words[0] == "completions" && words[1] == "--words") at = 2;
    else if (words.size() > 1 && words[0] == "help") at = 1;
    return at < words.size() && words[at] == "bench";
}

int runTool(std::vector<std::string> words, const BenchVerb& bench) {
    if (bench.elsewhere && isAboutBench(words)) return bench.elsewhere(words);
    CLI::App tool("What can be seen, from any view of any world: conservative visibility, measured and proved.",
                  "sightline");
    tool.set_version_flag("--version", "sightline " SIGHTLINE_VERSION, "print the version");
    tool.require_subcommand(1);
    int exit_code = kDone;
    SessionOptions session;
    addVerbs(tool, bench, session, exit_code);
    tool.parse_complete_callback([&] { beginVerb(tool, session); });

    if (words.empty()) {
        std::fputs(tool.help().c_str(), stderr);
        return kWrongArguments;
    }
    if (words.size() > 2 && words[0] == "completions" && words[1] == "--words") {
        std::fputs(completionsOf(tool, {words.begin() + 2, words.end()},
                                 bench.names ? bench.names() : std::vector<std::string>())
                       .c_str(),
                   stdout);
        return kDone;
    }
    if (words[0] == "help") {  // `help VERB` is `VERB --help`
        words.erase(words.begin());
        words.insert(words.begin() + (words.empty() ? 0 : 1), "--help");
    }
    const std::vector<std::string> names = verbNames(tool);
    if (!words[0].starts_with('-') && std::find(names.begin(), names.end(), words[0]) == names.end())
        return report({Error::Kind::kUsage, fmt::format("there is no verb \"{}\"{} (see sightline --help)", words[0],
                                                        suggestion(words[0], names))});
    std::reverse(words.begin(), words.end());  // as CLI11 takes them
    try {
        tool.parse(words);
    } catch (const CLI::RuntimeError& error) { return error.get_exit_code(); } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return tool.exit(error);  // --help and --version
        return report({Error::Kind::kUsage, explained(tool, error)});
    }
    return exit_code;
}

}  // namespace

int toolMain(int count, char** words, const BenchVerb& bench) {
    openSession();
    int exit_code = kDone;
    try {
        exit_code = runTool({words + 1, words + std::max(count, 1)}, bench);
    } catch (const std::bad_alloc&) {
        exit_code = report({Error::Kind::kInput, "not enough memory for this scene"});
    } catch (const std::exception& error) {
        // What a full or closed standard output throws is endSession()'s concern.
        if (!std::ferror(stdout)) exit_code = report({Error::Kind::kInput, error.what()});
    }
    return endSession(exit_code);
}

}  // namespace sightline::cli
