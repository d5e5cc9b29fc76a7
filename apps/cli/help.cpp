// What the tool says of itself: its words on scenes, cameras, exit codes, files; help of a verb; the nearest word.
// SPDX-License-Identifier: MIT
#include "apps/cli/help.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <numeric>
#include <sstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/cli/common.h"
#include "apps/cli/option_facts.h"
#include "apps/cli/verbs.h"

namespace sightline::cli {

const char* const kAbout =
    "What can be seen, from any view of any world: conservative visibility, measured and proved.";

namespace {

constexpr size_t kWidth = 100, kColumn = 30;  // [characters]

constexpr Entry kScenes[] = {
    {"FILE.glb, FILE.gltf", "glTF 2.0."},
    {"FILE.obj, .ply, .stl, .fbx, .ifc, .dae, ...",
     "other formats, by Assimp in a process of its own, where the tool was built with it."},
    {"several files", "one scene of all of them."},
    {"city:SEED:OBJECTS", "a city of 1 to 10,000,000 objects."},
    {"building:SEED:FLOORS", "an office building of 1 to 200 floors, with its cells and portals."},
    {"terrain:SEED:SIZE", "a height field of SIZE x SIZE samples, 16 to 8192, with trees and rocks."},
    {"made:NAME", "a few triangles that show where methods fail: cycle, crossing, coplanar, near, walls, eye."},
};

constexpr Entry kCameras[] = {
    {"--cameras PATH.json", "a camera path."},
    {"--frames N, --seed S", "so many seeded cameras that stand as a visitor would."},
    {"neither",
     "the scene's own cameras, else 16 seeded ones. A city with --frames and without --seed is walked along "
     "its streets."},
};

constexpr Entry kExitCodes[] = {
    {"0", "done."},
    {"1", "the answer is no: verification found something visible that was culled."},
    {"2", "the arguments are wrong."},
    {"3", "an input cannot be read, a configuration file among them."},
    {"4", "an output cannot be written, standard output among them."},
    {"130", "interrupted by Ctrl-C or asked to end: frames that were finished are written, if there are any."},
};

constexpr Entry kEnvironment[] = {
    {"NO_COLOR", "if set and not empty, nothing is coloured; --color always wins."},
    {"TERM", "if dumb or not set, nothing is coloured."},
    {"XDG_CONFIG_HOME", "where sightline/config.toml is looked for; ~/.config if not set."},
    {"TMPDIR", "where readers of other formats keep what they pass on; /tmp if not set."},
};

constexpr Entry kFiles[] = {
    {"./sightline.toml",
     "defaults of options for what lies here; read if there is no --config. It may not name files "
     "to be written, as it may come from somebody else."},
    {"~/.config/sightline/config.toml", "defaults of options, read if there is neither of the others."},
};

struct Example {
    const char* verb;
    Entry entry;
};
constexpr Example kExamples[] = {
    {"cull",
     {"sightline cull model.glb --frames 64 --verify --report out",
      "cull along 64 cameras, prove it, and write out/index.html"}},
    {"cull",
     {"sightline cull city:1:100000 --frames 64 --json - | jq '.frames[].triangles'", "triangles of each frame"}},
    {"cull",
     {"sightline cull model.gltf --cameras tour.json --report out --watch",
      "again whenever the model or the path changes"}},
    {"verify", {"sightline verify building:1:10 --frames 32", "a verdict for each of 32 views of a building"}},
    {"verify", {"sightline verify model.glb --rays 5000000 --quiet && echo sound", "the exit code alone"}},
    {"render",
     {"sightline render made:cycle --method all --report out",
      "all methods beside one another, where the painter fails"}},
    {"render",
     {"sightline render model.glb --frame 3 -o picture.png --heat-map heat.png", "a picture and its depth complexity"}},
    {"info", {"sightline info model.glb", "what it holds"}},
    {"info", {"sightline info part-1.obj part-2.stl --json -", "what two files hold together, as JSON"}},
    {"bake", {"sightline bake building:1:10 -o building.see", "its cells, portals and visible sets, as a file"}},
    {"bake", {"sightline bake maps/e1m1.bsp -o e1m1.see --objects", "of a map, and which faces each cell sees"}},
    {"bench", {"sightline bench occlusion", "the occlusion buffer beside its baselines"}},
    {"explain",
     {"sightline explain model.glb --object 42 --frame 3 -o why.png",
      "why object 42 is kept or culled in frame 3, and a picture of it"}},
    {"explain", {"sightline explain model.glb --object \"Desk 1\" --frame all", "the same by name, a line a frame"}},
    {"explain", {"sightline explain model.glb --at 640,360", "what is at this pixel, and what lies behind it"}},
    {"explain",
     {"sightline explain model.glb --frames 64", "who hides most on a path, which occluders pay, what is never seen"}},
    {"cull",
     {"sightline cull model.glb --frame 3 --record-occlusion slow.rec",
      "what frame 3 asks of its occlusion buffer, to be sent to whoever looks into it"}},
    {"replay", {"sightline replay slow.rec --image slow.png", "the same calls again: the same answers, and how long"}},
    {"report", {"sightline report out", "what `cull --report out` wrote, in short"}},
    {"report", {"sightline report --compare before after -o difference", "two runs side by side, as a page"}},
    {"report", {"sightline report --compare a.json b.json --fail-if-slower 1.05", "exit code 1 if b is slower by 5 %"}},
    {"config", {"sightline config --template >sightline.toml", "a file to begin with"}},
    {"config", {"sightline config cull", "what `sightline cull` would take from which file"}},
    {"completions", {"source <(sightline completions bash)", "completions for this shell"}},
    {"completions", {"sightline completions fish >~/.config/fish/completions/sightline.fish", "for every fish"}},
    {"man", {"sightline man | man -l -", "read it where it is not installed"}},
};

std::string lineOf(const std::string& left, const std::string& right) {
    std::string line = "  " + left;
    if (right.empty()) return line + "\n";
    if (line.size() + 2 > kColumn) line += "\n" + std::string(kColumn, ' ');
    else line.append(kColumn - line.size(), ' ');
    return line + wrapped(right, kColumn, kWidth) + "\n";
}

std::string optionLine(const OptionFacts& facts) {
    std::string left = fmt::format("{}", fmt::join(facts.names, ", "));
    if (!facts.positional && !facts.value.empty())
        left += " " + (facts.choices.empty() || facts.list ? facts.value : "WORD");
    if (facts.several && facts.positional) left += " ...";
    std::string right = facts.help;
    // Lists are as long as the help may be; choices that the help has already said are not said again.
    if (!facts.choices.empty() && !facts.list && right.find(facts.choices.front() + ",") == std::string::npos)
        right += fmt::format("{}{}", right.empty() ? "" : ": ", fmt::join(facts.choices, ", "));
    if (!facts.standard.empty() && facts.standard != "[]") right += fmt::format(" (default: {})", facts.standard);
    return lineOf(left, right);
}

std::string usageOf(const CLI::App& app, const std::string& name) {
    std::string usage = "usage: " + name;
    if (app.get_parent() == nullptr) return usage + " VERB ARGUMENTS\n";
    for (const OptionFacts& facts : optionsOf(app))
        if (facts.positional)
            usage += (facts.required ? " " : " [") + facts.names[0] + (facts.several ? "..." : "") +
                     (facts.required ? "" : "]");
    return usage + " [OPTIONS]\n";
}

class HelpFormatter : public CLI::Formatter {
public:
    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode) const override {
        const bool verb = app->get_parent() != nullptr;
        std::string help =
            app->get_description() + "\n\n" + usageOf(*app, verb ? "sightline " + app->get_name() : name);
        if (!verb) {
            help += "\nVerbs:\n";
            for (const CLI::App* each : verbsOf(*app)) help += lineOf(each->get_name(), each->get_description());
        }
        std::string group;
        for (const OptionFacts& facts : optionsOf(*app)) {
            if (facts.group != group) help += "\n" + facts.group + ":\n";
            group = facts.group;
            help += optionLine(facts);
        }
        return help + "\n" + app->get_footer();
    }
};

std::string section(const std::string& title, std::span<const Entry> entries) {
    std::string text = title + ":\n";
    for (const Entry& entry : entries) text += lineOf(entry.term, entry.text);
    return text;
}

std::string examplesText(const std::string& verb) {
    const std::vector<Entry> examples = examplesOf(verb);
    if (examples.empty()) return {};
    std::string text = "Examples:\n";
    for (const Entry& example : examples) text += fmt::format("  {}\n      {}\n", example.term, example.text);
    return text;
}

Status printHelp(const CLI::App& tool, const std::string& verb) {
    // App::help() would give the help of the verb that is running, which is this one.
    if (verb.empty())
        return writeText("-", tool.get_formatter()->make_help(&tool, "sightline", CLI::AppFormatMode::Normal));
    std::vector<std::string> names;
    for (const CLI::App* each : verbsOf(tool)) {
        if (each->get_name() == verb) return writeText("-", each->help());
        names.push_back(each->get_name());
    }
    return Error{Error::Kind::kUsage, fmt::format("there is no verb \"{}\"{}", verb, suggestion(verb, names))};
}

}  // namespace

std::span<const Entry> sceneEntries() { return kScenes; }
std::span<const Entry> cameraEntries() { return kCameras; }
std::span<const Entry> exitCodeEntries() { return kExitCodes; }
std::span<const Entry> environmentEntries() { return kEnvironment; }
std::span<const Entry> fileEntries() { return kFiles; }

std::vector<Entry> examplesOf(const std::string& verb) {
    std::vector<Entry> examples;
    for (const Example& example : kExamples)
        if (verb.empty() || verb == example.verb) examples.push_back(example.entry);
    return examples;
}

void dressHelp(CLI::App& tool) {
    const auto formatter = std::make_shared<HelpFormatter>();
    tool.formatter(formatter);
    tool.set_help_flag("-h,--help", "print this help");
    tool.footer(section("Scenes", kScenes) + "\n" + section("Cameras", kCameras) + "\n" +
                section("Exit codes", kExitCodes) +
                "\n`sightline help VERB` tells of a verb, `man sightline` of all.\n");
    groupOptions(tool);
    for (CLI::App* verb : tool.get_subcommands({})) {
        verb->formatter(formatter);
        verb->set_help_flag("-h,--help", "print this help");
        groupOptions(*verb);
        verb->footer(examplesText(verb->get_name()));
    }
}

void addHelp(CLI::App& tool, int& exit_code) {
    CLI::App* verb = tool.add_subcommand("help", "what a verb does, and its options");
    const auto name = std::make_shared<std::string>();
    verb->add_option("VERB", *name, "which one; without it: all verbs in short");
    verb->callback([&tool, &exit_code, name] {
        const Status printed = printHelp(tool, *name);
        exit_code = printed ? kDone : report(printed.error());
    });
}

std::string nearest(const std::string& word, const std::vector<std::string>& words) {
    // Damerau's and Levenshtein's distance, with neighbours that changed places as one fault.
    const auto distance = [](const std::string& a, const std::string& b) {
        std::vector<std::vector<size_t>> rows(a.size() + 1, std::vector<size_t>(b.size() + 1));
        for (size_t i = 0; i <= a.size(); ++i) {
            for (size_t j = 0; j <= b.size(); ++j) {
                if (i == 0 || j == 0) {
                    rows[i][j] = i + j;
                    continue;
                }
                rows[i][j] = std::min(
                    {rows[i - 1][j] + 1, rows[i][j - 1] + 1, rows[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
                if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                    rows[i][j] = std::min(rows[i][j], rows[i - 2][j - 2] + 1);
            }
        }
        return rows[a.size()][b.size()];
    };
    constexpr size_t kLongest = 64;  // longer ones are no slips
    std::string best;
    size_t least = word.size() <= kLongest ? std::min<size_t>(2, word.size() / 2) + 1 : 0;
    for (const std::string& each : words) {
        if (least == 0) break;
        if (const size_t d = distance(word, each); d < least) {
            least = d;
            best = each;
        }
    }
    return best;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& words) {
    const std::string best = nearest(word, words);
    return best.empty() ? std::string() : "; did you mean " + best + "?";
}

std::string wrapped(const std::string& text, size_t indent, size_t width) {
    std::string out;
    size_t column = indent;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (column > indent && column + 1 + word.size() > width) {
            out += "\n" + std::string(indent, ' ');
            column = indent;
        } else if (column > indent) {
            out += ' ';
            ++column;
        }
        out += word;
        column += word.size();
    }
    return out;
}

}  // namespace sightline::cli
