// The table of verbs that other programs have.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/other_verbs.h"

namespace sightline::cli {
namespace {

constexpr OtherVerb kOthers[] = {
    {"render", "one frame by any hidden-surface method, or by all of them", "sightline-lab", "back-faces clipping depth-comparison depth-compression depth-format depth-write early-z fast-clear free-samples front heat heat-map hierarchical-z ids method painter-key polygon-offset shading shadows"},
    {"sight", "whether two points see each other, the way between them, and what a region sees", "sightline-lab", "from narrowest to within"},
    {"replay", "a recorded frame asked again: the same answer, and how long it takes", "sightline-lab", "image target"},
    {"check", "the certificates of a run or a recorded frame, each held to exact arithmetic", "sightline-lab", ""},
    {"export", "the scene as glTF, cut into objects and without what is not seen", "sightline-lab", "from-path"},
    {"calibrate", "what a cluster's test and a triangle cost on this machine", "sightline-lab", ""},
    {"profile", "what limits a scene's frames, what its parts cost, and what each stage is worth there",
     "sightline-lab", "renderer stream"},
    {"advise", "what to turn on, bake, split or merge in a scene, each tried on its own frames", "sightline-lab", ""},
    {"report", "what cull's JSON holds, as a page; and two runs compared", "sightline-lab", "compare fail-if-slower"},
    {"bench", "measures this machine: each technique beside its plain baseline", "sightline-bench", ""},
    {"view", "fly through a scene, leave the culling camera and look at what it left", "sightline-view", ""},
    {"config", "every option of a configuration file, with what is in effect", "sightline-lab", ""},
};

bool has(std::string_view words, std::string_view word) {
    while (!words.empty()) {
        const size_t end = words.find(' ');
        if (words.substr(0, end) == word) return true;
        words.remove_prefix(end == std::string_view::npos ? words.size() : end + 1);
    }
    return false;
}

}  // namespace

std::span<const OtherVerb> otherVerbs() { return kOthers; }

const OtherVerb* findOtherVerb(std::string_view name) {
    for (const OtherVerb& other : kOthers)
        if (other.name == name) return &other;
    return nullptr;
}

std::vector<std::string> otherOwners(std::string_view option) {
    std::vector<std::string> owners;
    for (const OtherVerb& other : kOthers)
        if (has(other.options, option)) owners.emplace_back(other.name);
    return owners;
}

Command addOtherVerb(Command& tool, std::string_view name) {
    return tool.add_subcommand(std::string(name), std::string(findOtherVerb(name)->about));
}

}  // namespace sightline::cli
