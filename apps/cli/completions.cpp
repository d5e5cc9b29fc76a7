// Completions for shells, from the options as they are.
// SPDX-License-Identifier: MIT
#include "apps/cli/completions.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/cli/common.h"
#include "apps/cli/option_facts.h"
#include "apps/cli/verbs.h"
#include "sightline/scene/made.h"

namespace sightline::cli {
namespace {

/// What may stand in a value's place.
enum class Value { kNone, kAny, kWords, kList, kFile, kDirectory, kScene };

Value valueOf(const OptionFacts& facts) {
    if (facts.names[0] == "SCENE" || facts.value == "SCENE") return Value::kScene;
    if (facts.value.empty() && !facts.positional) return Value::kNone;
    if (facts.list) return Value::kList;
    if (!facts.choices.empty()) return Value::kWords;
    if (facts.value.find("DIR") != std::string::npos) return Value::kDirectory;
    if (facts.writes() || facts.value.find("PATH") != std::string::npos) return Value::kFile;
    return Value::kAny;
}

/// Beginnings of procedural scenes, and those that are whole.
std::vector<std::string> sceneWords() {
    std::vector<std::string> words = {"city:", "building:", "terrain:"};
    for (const MadeScene& made : madeScenes()) words.push_back("made:" + std::string(made.name));
    return words;
}

/// A positional's choices are the verb's: the names of other verbs, of cases, of shells.
std::vector<OptionFacts> facts(const CLI::App& tool, const CLI::App& app) {
    std::vector<OptionFacts> all = optionsOf(app);
    for (OptionFacts& one : all)
        if (one.names[0] == "VERB")
            for (const CLI::App* verb : verbsOf(tool))
                if (app.get_name() != "config" || verb->get_configurable()) one.choices.push_back(verb->get_name());
    return all;
}

std::string spaced(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

std::string bashValue(const OptionFacts& one) {
    switch (valueOf(one)) {
        case Value::kWords:
            return fmt::format("_sightline_words '{}'", spaced(one.choices));
        case Value::kList:
            return fmt::format("_sightline_list '{}'", spaced(one.choices));
        case Value::kFile:
            return "_sightline_files";
        case Value::kDirectory:
            return "_sightline_directories";
        case Value::kScene:
            return fmt::format("_sightline_scene '{}'", spaced(sceneWords()));
        case Value::kAny:
        case Value::kNone:
            break;
    }
    return ":";
}

constexpr const char* kBashHead = R"(# bash completion for sightline; made by "sightline completions bash".
#     source <(sightline completions bash)

# The words, with those put together again that bash parted at : and =.
_sightline_read() {
    local i word glue=
    words=() cur=
    for ((i = 0; i <= COMP_CWORD; ++i)); do
        word=${COMP_WORDS[i]}
        if [[ $word == : || $word == = || -n $glue ]] && ((${#words[@]} > 1)); then
            words[-1]+=$word
        else
            words+=("$word")
        fi
        glue=
        [[ $word == : || $word == = ]] && glue=1
    done
    cur=${words[-1]}
    # --option=value is two words.
    if [[ $cur == --*=* ]]; then
        words[-1]=${cur%%=*}
        cur=${cur#*=}
        words+=("$cur")
    fi
}
_sightline_words() { mapfile -t COMPREPLY < <(compgen -W "$1" -- "$cur"); }
_sightline_list() {
    local done=
    [[ $cur == *,* ]] && done=${cur%,*},
    mapfile -t COMPREPLY < <(compgen -P "$done" -W "$1" -- "${cur##*,}")
    compopt -o nospace 2>/dev/null
}
_sightline_files() {
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -f -- "$cur")
}
_sightline_directories() {
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -d -- "$cur")
}
_sightline_scene() {
    local scenes files
    mapfile -t scenes < <(compgen -W "$1" -- "$cur")
    mapfile -t files < <(compgen -f -- "$cur")
    COMPREPLY=("${scenes[@]}" "${files[@]}")
    if ((${#scenes[@]} == 0)); then
        compopt -o filenames 2>/dev/null
    elif [[ ${#COMPREPLY[@]} == 1 && ${COMPREPLY[0]} == *: ]]; then
        compopt -o nospace 2>/dev/null
    fi
}
)";

constexpr const char* kBashTail = R"(
    # bash replaces only what stands after its last : of the word.
    if [[ $cur == *:* && $COMP_WORDBREAKS == *:* ]]; then
        local i head=${cur%"${cur##*:}"}
        for i in "${!COMPREPLY[@]}"; do COMPREPLY[i]=${COMPREPLY[i]#"$head"}; done
    fi
}
complete -F _sightline sightline
)";

/// One verb's part: values after their options, then options, then what stands without one.
std::string bashVerb(const std::string& name, const std::vector<OptionFacts>& all) {
    std::string values, options, rest = ":";
    for (const OptionFacts& one : all) {
        if (one.positional) {
            rest = bashValue(one);
            continue;
        }
        for (const std::string& word : one.names) options += (options.empty() ? "" : " ") + word;
        if (valueOf(one) != Value::kNone)
            values += fmt::format("                {}) {} ;;\n", fmt::join(one.names, "|"), bashValue(one));
    }
    return fmt::format(
        "        {})\n            case $last in\n{}"
        "                *) if [[ $cur == -* ]]; then _sightline_words '{}'; else {}; fi ;;\n"
        "            esac ;;\n",
        name, values, options, rest);
}

std::string bashScript(const CLI::App& tool) {
    std::vector<std::string> names;
    for (const CLI::App* verb : verbsOf(tool)) names.push_back(verb->get_name());
    std::string script = kBashHead;
    script += fmt::format(
        "_sightline() {{\n    local words cur verb= last word\n    _sightline_read\n    COMPREPLY=()\n"
        "    last=${{words[-2]}}\n    for word in \"${{words[@]:1:${{#words[@]}}-2}}\"; do\n"
        "        case $word in\n            {}) verb=$word; break ;;\n        esac\n    done\n    case $verb in\n",
        fmt::join(names, "|"));
    for (const CLI::App* verb : verbsOf(tool)) script += bashVerb(verb->get_name(), facts(tool, *verb));
    // Before the verb: the tool's own options, and the verbs.
    OptionFacts verbs;
    verbs.names = {"VERB"};
    verbs.positional = true;
    verbs.choices = names;
    std::vector<OptionFacts> general = facts(tool, tool);
    general.push_back(verbs);
    return script + bashVerb("*", general) + "    esac\n" + kBashTail;
}

/// A text in single quotes, for zsh and fish.
std::string single(const std::string& text, bool fish) {
    std::string out = "'";
    for (const char c : text) {
        if (c == '\'') out += fish ? "\\'" : "'\\''";
        else if (c == '\\' && fish) out += "\\\\";
        else out += c == '\n' ? ' ' : c;
    }
    return out + "'";
}

/// What _arguments takes for a piece of a specification: colons and brackets have a meaning there.
std::string zshText(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == ':' || c == '[' || c == ']' || c == '\\') out += '\\';
        out += c;
    }
    return out;
}

std::string zshAction(const OptionFacts& one) {
    switch (valueOf(one)) {
        case Value::kWords:
            return "(" + spaced(one.choices) + ")";
        case Value::kList:
            return "_sequence compadd - " + spaced(one.choices);
        case Value::kDirectory:
            return "_files -/";
        case Value::kFile:
            return "_files";
        case Value::kScene:
            return "_sightline_scene";
        case Value::kAny:
        case Value::kNone:
            break;
    }
    return " ";
}

std::string zshSpecs(const std::vector<OptionFacts>& all) {
    std::string text;
    for (const OptionFacts& one : all) {
        const std::string value = zshText(one.value.empty() ? one.names[0] : one.value) + ":" + zshAction(one);
        if (one.positional) {
            text += " \\\n        " + single((one.several ? "*:" : one.required ? "1:" : "1::") + value, false);
            continue;
        }
        for (const std::string& name : one.names) {
            // Names of one option shut one another out.
            std::string spec = one.names.size() > 1 ? "(" + spaced(one.names) + ")" : "";
            spec += name + (valueOf(one) != Value::kNone && name.substr(0, 2) == "--" ? "=" : "");
            spec += "[" + zshText(one.help) + "]";
            if (valueOf(one) != Value::kNone) spec += ":" + value;
            text += " \\\n        " + single(spec, false);
        }
    }
    return text;
}

std::string zshScript(const CLI::App& tool) {
    std::vector<std::string> scenes = sceneWords();
    std::string script = fmt::format(
        "#compdef sightline\n# zsh completion for sightline; made by \"sightline completions zsh\".\n\n"
        "_sightline_scene() {{\n    compadd -S '' -- {}\n    _files\n}}\n\n",
        spaced(scenes));
    script += "_sightline_verbs() {\n    local -a verbs=(\n";
    for (const CLI::App* verb : verbsOf(tool))
        script += "        " + single(verb->get_name() + ":" + zshText(verb->get_description()), false) + "\n";
    script += "    )\n    _describe verb verbs\n}\n\n_sightline() {\n    local curcontext=$curcontext state line\n";
    script += "    _arguments -C" + zshSpecs(facts(tool, tool)) +
              " \\\n        '1:verb:_sightline_verbs' \\\n        '*::argument:->verb'\n"
              "    [[ $state == verb ]] || return\n    case $line[1] in\n";
    for (const CLI::App* verb : verbsOf(tool))
        script += fmt::format("    {})\n        _arguments{} ;;\n", verb->get_name(), zshSpecs(facts(tool, *verb)));
    return script +
           "    esac\n}\n\nif [[ $funcstack[1] == _sightline ]]; then\n    _sightline \"$@\"\nelse\n"
           "    compdef _sightline sightline\nfi\n";
}

std::string fishLine(const std::string& condition, const OptionFacts& one) {
    std::string line = "complete -c sightline -n " + single(condition, true);
    for (const std::string& name : one.names) {
        if (one.positional) break;
        line += name.substr(0, 2) == "--" ? " -l " + name.substr(2) : " -s " + name.substr(1);
    }
    switch (valueOf(one)) {
        case Value::kNone:
            break;
        case Value::kWords:
            line += (one.positional ? " -a " : " -x -a ") + single(spaced(one.choices), true);
            break;
        case Value::kList:
            line += " -x -a " + single("(__fish_append , " + spaced(one.choices) + ")", true);
            break;
        case Value::kDirectory:
            line += " -x -a '(__fish_complete_directories)'";
            break;
        case Value::kFile:
            line += " -r -F";
            break;
        case Value::kScene:
            line += (one.positional ? " -F -a " : " -r -F -a ") + single(spaced(sceneWords()), true);
            break;
        case Value::kAny:
            line += one.positional ? "" : " -x";
            break;
    }
    return one.help.empty() ? line + "\n" : line + " -d " + single(one.help, true) + "\n";
}

std::string fishScript(const CLI::App& tool) {
    std::vector<std::string> names;
    for (const CLI::App* verb : verbsOf(tool)) names.push_back(verb->get_name());
    const std::string none = "not __fish_seen_subcommand_from " + spaced(names);
    std::string script =
        "# fish completion for sightline; made by \"sightline completions fish\".\ncomplete -c sightline -f\n";
    for (const CLI::App* verb : verbsOf(tool))
        script += fmt::format("complete -c sightline -n {} -a {} -d {}\n", single(none, true), verb->get_name(),
                              single(verb->get_description(), true));
    for (const OptionFacts& one : facts(tool, tool)) script += fishLine(none, one);
    for (const CLI::App* verb : verbsOf(tool))
        for (const OptionFacts& one : facts(tool, *verb))
            script += fishLine("__fish_seen_subcommand_from " + verb->get_name(), one);
    return script;
}

}  // namespace

std::string completionScript(const CLI::App& tool, const std::string& shell) {
    return shell == "bash" ? bashScript(tool) : shell == "zsh" ? zshScript(tool) : fishScript(tool);
}

void addCompletions(CLI::App& tool, int& exit_code) {
    CLI::App* verb = tool.add_subcommand("completions", "print a shell's completions of this command line");
    const auto shell = std::make_shared<std::string>();
    verb->add_option("SHELL", *shell, "which shell")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
    verb->callback([&tool, &exit_code, shell] {
        const Status printed = writeText("-", completionScript(tool, *shell));
        exit_code = printed ? kDone : report(printed.error());
    });
}

}  // namespace sightline::cli
