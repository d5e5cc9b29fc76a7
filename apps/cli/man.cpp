// The manual page, from the options as they are.
// SPDX-License-Identifier: MIT
#include "apps/cli/man.h"

#include <span>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/cli/common.h"
#include "apps/cli/help.h"
#include "apps/cli/option_facts.h"
#include "apps/cli/verbs.h"

namespace sightline::cli {
namespace {

/// A text as roff takes it: nothing in it is a command, and dashes are dashes that can be searched for and copied.
std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '\\') out += "\\e";
        else if (c == '-') out += "\\-";
        else if (c == '\'') out += "\\(aq";
        else if (c == '`') out += "\\(ga";
        else if (c == '^') out += "\\(ha";
        else if (c == '~') out += "\\(ti";
        else if (c == '.' && (out.empty() || out.back() == '\n')) out += "\\&.";
        else if (c == '\n') out += ' ';
        else out += c;
    }
    return out;
}

std::string bold(const std::string& text) { return "\\fB" + escaped(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + escaped(text) + "\\fR"; }

/// A paragraph under a term.
std::string tagged(const std::string& term, const std::string& text) { return ".TP\n" + term + "\n" + text + "\n"; }

std::string entries(const std::string& title, std::span<const Entry> all) {
    std::string page = ".SH " + title + "\n";
    for (const Entry& entry : all) page += tagged(bold(entry.term), escaped(entry.text));
    return page;
}

std::string option(const OptionFacts& facts) {
    std::string term;
    for (const std::string& name : facts.names)
        term += (term.empty() ? "" : ", ") + (facts.positional ? italic(name) : bold(name));
    if (!facts.positional && !facts.value.empty()) term += " " + italic(facts.value);
    if (facts.several) term += " ...";
    std::string text = escaped(facts.help);
    if (!facts.choices.empty()) {
        text += text.empty() ? "One of: " : ". One of: ";
        if (facts.list) text += "(or several, separated by commas) ";
        for (size_t i = 0; i < facts.choices.size(); ++i) text += (i ? ", " : "") + bold(facts.choices[i]);
    }
    if (!facts.standard.empty() && facts.standard != "[]")
        text += fmt::format(" (default: {})", escaped(facts.standard));
    return tagged(term, text.empty() ? "\\&" : text + ".");
}

std::string verbText(const CLI::App& tool, const CLI::App& verb) {
    std::string page = fmt::format(".SS {}\n{}.\n", escaped(verb.get_name()), escaped(verb.get_description()));
    page += ".PP\n" + bold("sightline " + verb.get_name());
    const std::vector<OptionFacts> options = optionsOf(verb);
    for (const OptionFacts& facts : options)
        if (facts.positional)
            page += (facts.required ? " " : " [") + italic(facts.names[0]) + (facts.several ? " ..." : "") +
                    (facts.required ? "" : "]");
    page += " [" + italic("OPTIONS") + "]\n";
    std::string group;
    for (const OptionFacts& facts : options) {
        // What the tool itself takes is said once, for all verbs.
        if (!facts.positional && tool.get_option_no_throw(facts.names.back())) continue;
        if (facts.group != group) page += fmt::format(".PP\n{}:\n", italic(facts.group));
        group = facts.group;
        page += option(facts);
    }
    return page;
}

}  // namespace

std::string manualPage(const CLI::App& tool, const std::string& version) {
    std::string page = fmt::format(
        ".\\\" Made by \"sightline man\".\n"
        ".TH SIGHTLINE 1 \"\" \"{}\" \"User Commands\"\n"
        ".ad l\n.nh\n"
        ".SH NAME\nsightline \\- tells what can be seen in a 3D world, and proves it\n"
        ".SH SYNOPSIS\n.B sightline\n{} [{}]\n.br\n.B sightline help\n[{}]\n"
        ".SH DESCRIPTION\n",
        escaped(version), italic("VERB"), italic("ARGUMENTS"), italic("VERB"));
    page += escaped(kAbout) + "\n.PP\n" +
            escaped(
                "Sightline reads a scene, moves a camera through it, and tells for each frame which objects have a "
                "visible point. It answers conservatively: no visible object is left out. Two witnesses that share "
                "no code with the culling can judge every answer. Long work shows a bar with the time left on a "
                "terminal, and lines when piped. Results asked for with - go to standard output alone.") +
            "\n.PP\n" +
            escaped(
                "Ctrl-C ends the frames: those that were finished are written as a run of fewer frames. A second "
                "one ends the tool at once. Files are written aside and renamed, so that an old one stays until "
                "the new one is whole.") +
            "\n.SH VERBS\n";
    for (const CLI::App* verb : verbsOf(tool)) page += verbText(tool, *verb);
    page += ".SH OPTIONS OF EVERY VERB\n";
    for (const OptionFacts& facts : optionsOf(tool)) page += option(facts);
    page += entries("SCENES", sceneEntries()) + entries("CAMERAS", cameraEntries());
    page += entries("EXIT STATUS", exitCodeEntries()) + entries("ENVIRONMENT", environmentEntries());
    page += entries("FILES", fileEntries()) + ".SH EXAMPLES\n";
    for (const CLI::App* verb : verbsOf(tool))
        for (const Entry& example : examplesOf(verb->get_name()))
            page += tagged(bold(example.term), escaped(example.text) + ".");
    return page;
}

void addMan(CLI::App& tool, const std::string& version, int& exit_code) {
    CLI::App* verb = tool.add_subcommand("man", "print the manual page");
    verb->callback([&tool, &exit_code, version] {
        const Status printed = writeText("-", manualPage(tool, version));
        exit_code = printed ? kDone : report(printed.error());
    });
}

}  // namespace sightline::cli
