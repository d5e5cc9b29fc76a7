// What the tool does with its words: the verbs, what comes before them, and the exit code.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/tool.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "apps/cli/shell/config.h"
#include "apps/cli/shell/help.h"
#include "apps/cli/shell/progress.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/verbs.h"
#include "apps/cli/verbs/vis_words.h"
#include "sightline/tools/scene/one_line.h"
#include "sightline/tools/scene/procedural.h"
#include "sightline/tools/scene/suggestion.h"

namespace sightline::cli {
namespace {

// Completions for bash, zsh and fish: each shell's script asks the tool what may stand at the cursor.

using Words = std::vector<std::string>;

// A word of ours is parted by bash at : and =, and only the part at the cursor is replaced.
constexpr const char* kBash = R"(# bash: source <(sightline completions bash)
_sightline() {
    local words line=${COMP_LINE:0:COMP_POINT}
    read -ra words <<<"$line"
    [[ $line == *[[:space:]] ]] && words+=('')
    mapfile -t COMPREPLY < <("${words[0]}" completions --words "${words[@]:1}" 2>/dev/null)
    local cur=${words[-1]}
    local head=${cur%"${COMP_WORDS[COMP_CWORD]#[:=]}"}
    COMPREPLY=("${COMPREPLY[@]#"$head"}")
    [[ ${COMPREPLY[0]} == *: ]] && compopt -o nospace 2>/dev/null
}
complete -o default -F _sightline sightline
)";

constexpr const char* kZsh = R"(#compdef sightline
# zsh: source <(sightline completions zsh)
_sightline() {
    local -a offered=("${(@f)$(${words[1]} completions --words "${(@)words[2,CURRENT]}" 2>/dev/null)}")
    if [[ -z $offered ]]; then
        _files
    else
        compadd -S '' -- ${(M)offered:#*:}
        compadd -- ${offered:#*:}
    fi
}
if [[ $funcstack[1] == _sightline ]]; then _sightline "$@"; else compdef _sightline sightline; fi
)";

constexpr const char* kFish = R"(# fish: sightline completions fish | source
function __sightline_offered
    set -l words (commandline -opc)
    set -l cur (commandline -ct)
    set -l offered ($words[1] completions --words $words[2..] "$cur" 2>/dev/null)
    if set -q offered[1]
        printf '%s\n' $offered
    else
        __fish_complete_path "$cur"
    end
end
complete -c sightline -f -a '(__sightline_offered)'
)";

/// Beginnings of procedural scenes, and those that are whole.
Words sceneWords() {
    Words words = {"city:", "building:", "terrain:"};
    for (const MadeScene& made : madeScenes()) words.push_back("made:" + std::string(made.name));
    return words;
}

/// @param cases  of the verb `bench`
Words valuesOf(const CLI::App& tool, const CLI::App& verb, const CLI::Option& option, const Words& cases) {
    const std::string name = option.get_positional() ? option.get_name() : valueName(option);
    if (name == "SCENE") return sceneWords();
    if (name == "VERB") return verbNames(tool);
    if (name == "NAME" && verb.get_name() == "bench") return cases;
    return choicesOf(option);
}

Words positionals(const CLI::App& tool, const CLI::App& verb, const Words& cases) {
    Words words;
    for (const CLI::Option* option : verb.get_options([](const CLI::Option* each) { return each->get_positional(); }))
        for (std::string& word : valuesOf(tool, verb, *option, cases)) words.push_back(std::move(word));
    return words;
}

Words optionNames(const CLI::App& app) {
    Words names;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_snames()) names.push_back("-" + name);
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    return names;
}

/// What may stand in the last word's place, one a line. Nothing: whatever it is, it is not known; a file, perhaps.
/// @param words  behind "sightline"; the last one is as far as it is typed  [size: >= 1]
/// @param cases  of the verb `bench`
std::string completionsOf(const CLI::App& tool, const Words& words, const Words& cases) {
    const CLI::App* app = &tool;
    for (size_t i = 0; i + 1 < words.size() && app == &tool; ++i)
        for (const CLI::App* verb : tool.get_subcommands({}))
            if (verb->get_name() == words[i]) app = verb;
    std::string last = words.back(), before = words.size() > 1 ? words[words.size() - 2] : std::string(), kept;
    if (const size_t equals = last.find('='); last.starts_with("--") && equals != std::string::npos) {
        before = last.substr(0, equals);  // --option=value is two words
        kept = last.substr(0, equals + 1);
        last.erase(0, equals + 1);
    }
    const CLI::Option* option = before.starts_with('-') ? app->get_option_no_throw(before) : nullptr;
    Words offered;
    if (option && !isFlag(*option)) offered = valuesOf(tool, *app, *option, cases);
    else if (last.starts_with('-')) offered = optionNames(*app);
    else offered = app == &tool ? verbNames(tool) : positionals(tool, *app, cases);
    if (option && isList(*option))
        if (const size_t comma = last.rfind(','); comma != std::string::npos) {
            kept += last.substr(0, comma + 1);
            last.erase(0, comma + 1);
        }
    std::string text;
    for (const std::string& word : offered)
        if (word.starts_with(last)) text += kept + word + "\n";
    return text;
}

/// The verb `completions SHELL`, which prints the script. The scripts run `sightline completions --words WORD...`, which
/// main() answers by completionsOf() before the words are parsed.
void addCompletions(CLI::App& tool, int& exit_code) {
    CLI::App* verb = tool.add_subcommand("completions", "print a shell's completions of this command line");
    const auto shell = std::make_shared<std::string>();
    verb->add_option("SHELL", *shell, "which shell")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
    verb->callback([&exit_code, shell] {
        const Status printed = writeText("-", *shell == "bash" ? kBash : *shell == "zsh" ? kZsh : kFish);
        exit_code = printed ? kDone : report(printed.error());
    });
}

/// The verb that was being parsed, as "sightline cull".
std::string verbOf(const CLI::App& tool) {
    const auto chosen = tool.get_subcommands();
    return "sightline" + (chosen.empty() ? std::string() : " " + chosen.front()->get_name());
}

std::vector<std::string> longOptions(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

/// Of an option that a verb has not: which have it, or which of its own may have been meant.
std::string meantOption(const CLI::App& tool, const CLI::App& verb, const std::string& option) {
    Words owners;
    const auto note = [&](const std::string& owner) {
        if (owner != verb.get_name() && std::find(owners.begin(), owners.end(), owner) == owners.end())
            owners.push_back(owner);
    };
    for (const CLI::App* other : tool.get_subcommands({}))
        if (other->get_option_no_throw(option)) note(other->get_name());
    for (const std::string& owner : otherOwners(option)) note(owner);
    if (owners.empty()) return suggestion(option, longOptions(verb));
    return fmt::format("; it belongs to {}", joined(owners, ", "));
}

/// A number that is none is not told by its range.
std::string withoutRange(const std::string& what) {
    const std::string_view kValue = "Value ", kRange = " not in range";
    const size_t value = what.find(kValue), range = what.find(kRange);
    if (value == std::string::npos || range == std::string::npos) return what;
    const std::string word = what.substr(value + kValue.size(), range - value - kValue.size());
    double number = 0;
    return CLI::detail::lexical_cast(word, number) ? what : what.substr(0, value) + word + " is not a number";
}

/// The parser's words in ours.
std::string inOurWords(std::string what) {
    if (const size_t at = what.find(" was given a disallowed flag override"); at != std::string::npos)
        return "--" + what.substr(0, at) + " takes no value";
    if (const std::string_view kConvert = "Could not convert: "; what.starts_with(kConvert))
        if (const size_t equals = what.find(" = "); equals != std::string::npos)
            return what.substr(kConvert.size(), equals - kConvert.size()) + ": " + what.substr(equals + 3) +
                   " is not a number";
    if (const size_t at = what.find(": At Most 1 required but received"); at != std::string::npos)
        return what.substr(0, at) + " is given more than once";
    return withoutRange(what);
}

/// Of a value that an option does not take: which of those it takes may have been meant.
std::string meantValue(const std::string& what) {
    const std::string_view kNotIn = " not in {";
    const size_t at = what.find(kNotIn), end = what.find('}', at);
    if (at == std::string::npos || end == std::string::npos) return "";
    const size_t word = what.rfind(' ', at - 1) + 1;  // behind the option's name, or the whole
    const size_t first = at + kNotIn.size();
    return suggestion(what.substr(word, at - word), CLI::detail::split(what.substr(first, end - first), ','));
}

/// What the parser found wrong, with a word that may have been meant.
std::string explained(const CLI::App& tool, const CLI::ParseError& error) {
    std::string meant;
    if (dynamic_cast<const CLI::ExtrasError*>(&error)) {
        const auto chosen = tool.get_subcommands();
        const CLI::App& app = chosen.empty() ? tool : *chosen.front();
        const std::vector<std::string> extras = app.remaining();
        if (!extras.empty() && extras[0].size() > 1 && extras[0].starts_with('-'))
            meant = meantOption(tool, app, extras[0].substr(0, extras[0].find('=')));
    } else {
        meant = meantValue(error.what());
    }
    return fmt::format("{}{} (see {} --help)", inOurWords(error.what()), meant, verbOf(tool));
}

/// Refuses what no option means: values of nothing, numbers below zero where only others count, and pictures by the
/// suffix of another format.
Status checkValues(const CLI::App& verb) {
    for (const CLI::Option* option : verb.get_options()) {
        if (isFlag(*option) || option->get_positional()) continue;
        const std::string kind = valueName(*option);
        const auto wrong = [&](const std::string& what) {
            return Error{Error::Kind::kUsage, fmt::format("--{}: {}", option->get_single_name(), what)};
        };
        for (const std::string& value : option->results()) {
            if (value.empty() && option->get_items_expected_min() > 0) return wrong("its value is empty");
            if ((kind == "N" || kind == "S" || kind == "UINT") && value[0] == '-') return wrong(value + " is below 0");
            if (kind != "FILE.png") continue;
            const std::string suffix = std::filesystem::path(value).extension().string();
            for (const char* other :
                 {".jpg", ".jpeg", ".webp", ".gif", ".bmp", ".tga", ".tif", ".tiff", ".ppm", ".exr"})
                if (CLI::detail::to_lower(suffix) == other)
                    return wrong(fmt::format("{}: pictures are written as PNG: name it .png", value));
        }
    }
    return success();
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
    insist(checkValues(verb));
    setQuiet(session.quiet);
    if (config.here && verb.get_configurable()) note("options are taken from ./" + config.file);
}

const HeldVerb* findHeld(std::span<const HeldVerb> held, std::string_view name) {
    for (const HeldVerb& each : held)
        if (each.name == name) return &each;
    return nullptr;
}

void addVerbs(CLI::App& tool, std::span<const HeldVerb> held, SessionOptions& session, int& exit_code) {
    Command command(&tool);
    for (const auto add : {addCull, addVerify, addExplain, addBake, addVis, addInfo}) add(command, exit_code);
    for (const OtherVerb& other : otherVerbs()) {
        const HeldVerb* here = findHeld(held, other.name);
        if (here && here->add) here->add(command, exit_code);
        else if (!here) addOtherVerb(command, other.name);  // what is said of it comes from the other program
    }
    for (CLI::App* verb : tool.get_subcommands({}))
        verb->configurable(!findOtherVerb(verb->get_name()) || findHeld(held, verb->get_name()));
    // What follows tells of the tool itself.
    if (findHeld(held, "config")) addConfig(tool, session, exit_code);
    addCompletions(tool, exit_code);
    addSessionOptions(tool, session);
    for (CLI::App* verb : tool.get_subcommands({})) addSessionOptions(*verb, session);
    dressHelp(tool);
}

/// Of a word that is no verb, but a scene: what may be done with that.
std::string meantVerb(const std::string& word, const std::vector<std::string>& names) {
    std::error_code ignored;
    if (!isProcedural(word) && !std::filesystem::exists(word, ignored)) return suggestion(word, names);
    return fmt::format("; for a scene: sightline cull {0}, or sightline info {0}", quoted(word));
}

/// The verb that the words are about, or whose completions or help they ask for.
std::string aboutVerb(const std::vector<std::string>& words) {
    size_t at = 0;
    if (words.size() > 2 && words[0] == "completions" && words[1] == "--words") at = 2;
    else if (words.size() > 1 && words[0] == "help") at = 1;
    return at < words.size() ? words[at] : "";
}

/// Becomes another program, which lies beside this one.
int runBeside(const OtherVerb& verb, const std::vector<std::string>& words) {
    std::error_code failed;
    const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe", failed).parent_path();
    const std::string program = (here / verb.program).string();
    std::vector<std::string> all = words;
    all.insert(all.begin(), program);
    std::vector<char*> pointers;
    for (std::string& word : all) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    std::fflush(nullptr);
    execv(program.c_str(), pointers.data());
    const auto asks = [&](const char* word) { return std::find(words.begin(), words.end(), word) != words.end(); };
    if (words[0] == "completions") return kDone;  // nothing is offered
    if (words[0] == "help" || asks("--help") || asks("-h")) {
        const Status told = writeText(
            "-", fmt::format(
                     "{0}: {1}\n\nThe program {2} has this verb, and is not built. `./run.sh help {0}` builds it and "
                     "tells its options;\n`./run.sh {0} ...` runs it. docs/command-line.md leads to them, too.\n",
                     verb.name, verb.about, verb.program));
        return told ? kDone : report(told.error());
    }
    return report(
        {Error::Kind::kUsage, fmt::format("{0}: the program {1} is not beside this one; `./run.sh {0}` builds it",
                                          verb.name, verb.program)});
}

/// What the verb's NAME may be.
std::vector<std::string> casesOf(std::span<const HeldVerb> held) {
    for (const HeldVerb& each : held)
        if (each.names) return each.names();
    return {};
}

int runTool(std::vector<std::string> words, std::span<const HeldVerb> held) {
    if (const OtherVerb* other = findOtherVerb(aboutVerb(words)); other && !findHeld(held, other->name))
        return runBeside(*other, words);
    CLI::App tool("What can be seen, from any view of any world: conservative visibility, measured and proved.",
                  "sightline");
    tool.set_version_flag("--version", "sightline " SIGHTLINE_VERSION, "print the version");
    tool.require_subcommand(1);
    int exit_code = kDone;
    SessionOptions session;
    addVerbs(tool, held, session, exit_code);
    std::optional<SilenceWatch> watch;
    tool.parse_complete_callback([&] {
        beginVerb(tool, session);
        const std::string verb = tool.get_subcommands().front()->get_name();
        if (verb != "view") watch.emplace(verb);  // a window shows that it lives
    });

    if (words.empty()) {
        std::fputs(tool.help().c_str(), stderr);
        return kWrongArguments;
    }
    if (words.size() > 2 && words[0] == "completions" && words[1] == "--words") {
        std::fputs(completionsOf(tool, {words.begin() + 2, words.end()}, casesOf(held)).c_str(), stdout);
        return kDone;
    }
    if (words[0] == "help") {  // `help VERB` is `VERB --help`
        words.erase(words.begin());
        words.insert(words.begin() + (words.empty() ? 0 : 1), "--help");
    }
    const std::vector<std::string> names = verbNames(tool);
    if (!words[0].starts_with('-') && std::find(names.begin(), names.end(), words[0]) == names.end())
        return report({Error::Kind::kUsage, fmt::format("there is no verb \"{}\"{} (see sightline --help)", words[0],
                                                        meantVerb(words[0], names))});
    Result<std::vector<std::string>> known = visWords(words);
    if (!known) return report(known.error());
    words = std::move(*known);
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

int toolMain(int count, char** words, std::initializer_list<HeldVerb> held) {
    openSession();
    int exit_code = kDone;
    try {
        exit_code = runTool({words + 1, words + std::max(count, 1)}, {held.begin(), held.size()});
    } catch (const std::bad_alloc&) {
        exit_code = report({Error::Kind::kInput, "not enough memory for this scene"});
    } catch (const std::exception& error) {
        // What a full or closed standard output throws is endSession()'s concern.
        if (!std::ferror(stdout)) exit_code = report({Error::Kind::kInput, error.what()});
    }
    return endSession(exit_code);
}

}  // namespace sightline::cli
