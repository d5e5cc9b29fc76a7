// Completions for bash, zsh and fish: each shell's script asks the tool what may stand at the cursor.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/completions.h"

#include <memory>

#include <CLI/CLI.hpp>

#include "apps/cli/shell/option_facts.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/verbs.h"
#include "sightline/tools/scene/made.h"

namespace sightline::cli {
using namespace tools;
namespace {

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

}  // namespace

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

void addCompletions(CLI::App& tool, int& exit_code) {
    CLI::App* verb = tool.add_subcommand("completions", "print a shell's completions of this command line");
    const auto shell = std::make_shared<std::string>();
    verb->add_option("SHELL", *shell, "which shell")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
    verb->callback([&exit_code, shell] {
        const Status printed = writeText("-", *shell == "bash" ? kBash : *shell == "zsh" ? kZsh : kFish);
        exit_code = printed ? kDone : report(printed.error());
    });
}

}  // namespace sightline::cli
