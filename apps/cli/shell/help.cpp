// How help looks and what it says beside the options, and what is known of an option beside its name.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/help.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "sightline/geom/view.h"
#include "sightline/tools/scene/one_line.h"

namespace sightline::cli {
namespace {

constexpr size_t kColumn = 30, kWidth = 70;  // of the names and of what is said of them  [characters]

constexpr const char* kWords = R"(Scenes:
  FILE.glb, FILE.gltf         glTF 2.0
  FILE.obj, .ply, .stl, ...   other formats, by Assimp in a process of its own, where the tool was
                              built with it
  several files               one scene of all of them
  city:SEED:OBJECTS           a city of 1 to 10,000,000 objects
  building:SEED:FLOORS        an office building of 1 to 200 floors, with its cells and portals
  terrain:SEED:SIZE           a height field of SIZE x SIZE samples, 16 to 8192, with trees and rocks
  made:NAME                   a few triangles that show where methods fail: cycle, crossing,
                              coplanar, near, walls, eye

Cameras:
  --cameras PATH.json         a camera path
  --eye X,Y,Z --look X,Y,Z    one camera, and the point that it looks at
  --path WORD                 tour: the whole, then a walk through it, or around it; walk: frame by frame;
                              orbit; overview; scatter: anywhere, as proofs want it
  --frames N, --seed S        so many cameras of it; where it begins
  none of these               the scene's own cameras, else a tour of 16. A city with --frames alone is
                              walked along its streets

Exit codes:
  0                           done
  1                           the answer is no: verification found something visible that was culled
  2                           the arguments are wrong
  3                           an input cannot be read, a configuration file among them
  4                           an output cannot be written, standard output among them
  130                         interrupted by Ctrl-C or asked to end: frames that were finished are
                              written, if there are any

`sightline help VERB` tells of a verb.)";

struct Example {
    const char *verb, *command, *meaning;
};
constexpr Example kExamples[] = {
    {"cull", "cull model.glb --frames 64 --verify --report out",
     "cull along 64 cameras, prove it, and write out/index.html"},
    {"cull", "cull city:1:100000 --frames 64 --json - | jq '.frames[].triangles'", "triangles of each frame"},
    {"verify", "verify building:1:10 --frames 32", "a verdict for each of 32 views of a building"},
    {"verify", "verify model.glb --rays 5000000 --quiet && echo sound", "the exit code alone"},
    {"render", "render made:cycle --method all --report out", "all methods side by side, where the painter fails"},
    {"render", "render model.glb --frame 3 -o picture.png --heat-map heat.png", "a picture and its depth complexity"},
    {"info", "info part-1.obj part-2.stl --json -", "what two files hold together, as JSON"},
    {"bake", "bake building:1:10 -o building.vis", "its cells, portals and visible sets, as a file"},
    {"bake", "bake maps/e1m1.bsp -o e1m1.vis --objects", "of a map, and which faces each cell sees"},
    {"export", "export model.glb --split grid:8 --outside -o small.glb",
     "in parts of its own, without what closed surfaces hide"},
    {"export", "export house.ifc --from-path --cameras tour.json -o tour.glb", "only what a tour may see"},
    {"vis", "vis maps/e1m1.bsp -o e1m1-vis.bsp --verify", "the map with its visibility, proved by rays"},
    {"bench", "bench occlusion", "the occlusion buffer beside its baselines"},
    {"explain", "explain model.glb --object 42 --frame 3 -o why.png",
     "why object 42 is kept or culled, with a picture"},
    {"explain", "explain model.glb --at 640,360", "what is at this pixel, and what lies behind it"},
    {"explain", "explain model.glb --frames 64", "who hides most on a path, and what is never seen"},
    {"sight", "sight model.glb --from 0,1.6,0 --to 12,1.6,3", "does something stand between two points?"},
    {"sight", "sight model.glb --from 0,1.6,0 --within 2 --visibility model.vis",
     "what a player who is there may see within two metres"},
    {"sight", "sight house.glb --from-node 'Corridor*' --inset 0.1 --visibility house.vis --unseen",
     "what is never seen from any corridor"},
    {"export", "export house.glb --from-node 'Corridor*' --inset 0.1 --visibility house.vis -o seen.glb",
     "the same left out"},
    {"view", "view model.glb", "fly through it; F leaves the culling camera where it is"},
    {"view", "view model.glb --headless --screenshot p.png --frozen 6", "what the seventh camera left, as a picture"},
    {"profile", "profile model.glb", "what its frames wait for, and what each stage of the query is worth"},
    {"profile", "profile city:1:10000 --frames 4 --renderer gl --json profile.json",
     "of the software GL; cull --calibration reads the costs"},
    {"advise", "advise model.glb", "what to turn on, bake, split or merge, tried on its own frames"},
    {"replay", "replay wrong.frame --verify",
     "the frame that `cull --record wrong.frame` or an engine wrote, once more"},
    {"check", "check run.json house.glb",
     "each certificate of `cull --remember --certificates --json run.json`, exactly"},
    {"judge", "judge model.glb --cameras path.json --answers drawn.csv --pictures missed",
     "what an engine drew, held to proofs; with pictures of what it missed"},
    {"judge", "judge model.glb --answers run.json",
     "the same of what `cull --json run.json` wrote, or another build of it"},
    {"report", "report --compare before after -o difference", "two runs side by side, as a page"},
    {"report", "report --compare a.json b.json --fail-if-slower 1.05", "exit code 1 if b is slower by 5 %"},
    {"config", "config --no-config >sightline.toml", "a file to begin with"},
    {"config", "config cull", "what `sightline cull` would take from which line"},
    {"completions", "completions fish >~/.config/fish/completions/sightline.fish", "for every fish"},
};

/// Headings in their order; those that verbs bring stand where the empty one does.
constexpr std::string_view kHeadings[] = {"Input", "Cameras", "Culling", "", "Output", "General"};

/// Options that most runs are made of: set apart where there are many.
constexpr std::string_view kOftenUsed[] = {"--cameras",    "--eye",      "--look",   "--path", "--frames", "--size",
                                           "--visibility", "--remember", "--verify", "--list", "--report", "--json"};
constexpr size_t kManyOptions = 40;

bool isOftenUsed(const CLI::Option* option) {
    return std::find(std::begin(kOftenUsed), std::end(kOftenUsed), option->get_name()) != std::end(kOftenUsed);
}

size_t rankOf(const std::string& group) {
    const auto* const found = std::find(std::begin(kHeadings), std::end(kHeadings), group);
    return static_cast<size_t>((found == std::end(kHeadings) ? &kHeadings[3] : found) - kHeadings);
}

/// CLI11's formatter with headings in order, texts in lines, and values as words in capitals.
class HelpFormatter : public CLI::Formatter {
public:
    HelpFormatter() {
        column_width(kColumn);
        label("Usage", "usage");
        label("SUBCOMMAND", "VERB");
        label("Positionals", "Arguments");
    }

    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
        std::string text = app->get_description() + "\n\n" + make_usage(app, name) + make_positionals(app) +
                           make_subcommands(app, mode);
        std::vector<std::string> groups = app->get_groups();
        std::stable_sort(groups.begin(), groups.end(),
                         [](const auto& a, const auto& b) { return rankOf(a) < rankOf(b); });
        const bool many = app->get_options([](const CLI::Option*) { return true; }).size() > kManyOptions;
        if (many) text += make_group("Often used", false, app->get_options(isOftenUsed));
        for (const std::string& group : groups) {
            const auto options = app->get_options([&](const CLI::Option* option) {
                return option->get_group() == group && option->nonpositional() && !(many && isOftenUsed(option));
            });
            if (!options.empty()) text += make_group(group, false, options);
        }
        return text + "\n" + make_footer(app);
    }
    std::string make_option_usage(const CLI::Option* option) const override {
        const std::string name = option->get_name() + (option->get_items_expected_max() > 1 ? "..." : "");
        return option->get_required() ? name : "[" + name + "]";
    }
    std::string make_option_opts(const CLI::Option* option) const override {
        if (option->get_positional()) return option->get_items_expected_max() > 1 ? " ..." : "";
        if (isFlag(*option)) return {};
        const std::string name = valueName(*option);
        return " " + (name == "TEXT" ? "WORD" : name);
    }
    std::string make_option_desc(const CLI::Option* option) const override {
        std::string text = helpOf(*option);
        if (const std::string standard = option->get_default_str();
            !isFlag(*option) && !standard.empty() && standard != "[]")
            text += fmt::format(" (default: {})", standard);
        std::string lines;
        size_t column = 0;
        std::istringstream words(text);
        for (std::string word; words >> word; column += word.size() + 1) {
            if (column > 0) lines += column + word.size() > kWidth ? '\n' : ' ';
            if (column + word.size() > kWidth) column = 0;
            lines += word;
        }
        return lines;
    }
};

std::string examplesOf(const std::string& verb) {
    std::string text;
    for (const Example& example : kExamples)
        if (verb == example.verb) text += fmt::format("  sightline {}\n      {}\n", example.command, example.meaning);
    return text.empty() ? text : "Examples:\n" + text;
}

void dress(CLI::App& app, const std::shared_ptr<CLI::FormatterBase>& formatter) {
    app.formatter(formatter);
    app.set_help_flag("-h,--help", "print this help");
    for (CLI::Option* option : app.get_options()) {
        if (option == app.get_help_ptr() || option == app.get_version_ptr()) option->group("General");
        else if (option->get_group() == "Options" && option->nonpositional() && isWritten(*option))
            option->group("Output");
        if (isFlag(*option)) option->disable_flag_override();  // --masked=3 is a slip
    }
}

}  // namespace

bool isFlag(const CLI::Option& option) { return option.get_items_expected_max() == 0; }

std::string valueName(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    // Behind a colon stand the names of checks, but in "grid:N".
    const size_t colon = type.find(':');
    if (colon != std::string::npos && type.substr(colon) == ":N") return type;
    const std::string name = type.substr(0, colon);
    return name == "UINT" || name == "INT" ? "N" : name;
}

std::vector<std::string> choicesOf(const CLI::Option& option) {
    if (isList(option)) {
        std::vector<std::string> chosen;
        for (int stage = 0; stage < kStageCount; ++stage)
            if (kAllStages >> stage & 1) chosen.emplace_back(kStageNames[stage]);
        return chosen;
    }
    const std::string type = option.get_type_name();  // of CLI::IsMember "TEXT:{a,b}"
    const size_t open = type.find(":{");
    if (open == std::string::npos || type.back() != '}') return {};
    return CLI::detail::split(type.substr(open + 2, type.size() - open - 3), ',');
}

std::string helpOf(const CLI::Option& option) {
    const std::string text = option.get_description();
    const std::vector<std::string> choices = choicesOf(option);
    if (choices.empty() || valueName(option) != "TEXT") return text;
    return fmt::format("{}{}{}", text, text.empty() ? "" : ": ", tools::joined(choices, ", "));
}

bool isList(const CLI::Option& option) { return valueName(option) == "LIST"; }

bool isWritten(const CLI::Option& option) {
    const std::string name = valueName(option);
    return name.find("FILE") != std::string::npos || name.find("DIR") != std::string::npos;
}

std::vector<std::string> verbNames(const CLI::App& tool) {
    std::vector<std::string> names;
    for (const CLI::App* verb : tool.get_subcommands({})) names.push_back(verb->get_name());
    return names;
}

void dressHelp(CLI::App& tool) {
    const auto formatter = std::make_shared<HelpFormatter>();
    dress(tool, formatter);
    tool.footer(kWords);
    for (CLI::App* verb : tool.get_subcommands({})) {
        dress(*verb, formatter);
        verb->group("Verbs");
        verb->footer(examplesOf(verb->get_name()));
    }
}

}  // namespace sightline::cli
