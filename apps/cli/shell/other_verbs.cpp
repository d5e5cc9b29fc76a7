// The table of verbs that other programs have.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/other_verbs.h"

#include <algorithm>

namespace sightline::cli {
namespace {

constexpr OtherVerb kOthers[] = {
    {"render", "one frame by any hidden-surface method, or by all of them", "sightline-lab",
     "split up unit sides import-memory import-time cameras eye look path frames seed fps speed size threads json= "
     "method frame repeat painter-key free-samples rays clipping front back-faces output= ids= heat-map= "
     "heat report= shading shadows depth-format depth-comparison depth-write polygon-offset early-z "
     "hierarchical-z fast-clear depth-compression quiet -o -q"},
    {"sight", "whether two points see each other, the way between them, and what a region sees", "sightline-lab",
     "split up unit sides import-memory import-time from to within from-box from-node inset unseen visibility= "
     "narrowest "
     "json= "
     "quiet -q"},
    {"replay", "a recorded frame asked again: the same answer, and how long it takes", "sightline-lab",
     "repeat target verify rays json= image= quiet -q"},
    {"check", "the certificates of a run or a recorded frame, each held to exact arithmetic", "sightline-lab",
     "split up unit sides import-memory import-time threads json= quiet -q"},
    {"judge", "what any engine drew, frame by frame: what it missed, and what it drew in vain", "sightline-lab",
     "split up unit sides import-memory import-time cameras eye look path frames seed fps speed size threads json= "
     "answers pictures= section stereo jitter rays no-proofs quiet -q"},
    {"export", "the scene as glTF, cut into objects and without what is not seen", "sightline-lab",
     "split up unit sides import-memory import-time cameras eye look path frames seed fps speed size threads json= "
     "output= outside from-path from-box from-node inset visibility= list quiet -o -q"},
    {"calibrate", "what a cluster's test and a triangle cost on this machine", "sightline-lab", "json= quiet -q"},
    {"profile", "what limits a scene's frames, what its parts cost, and what each stage is worth there",
     "sightline-lab",
     "split up unit sides import-memory import-time cameras eye look path frames seed fps speed size threads json= "
     "repeat use skip distance contribution section visibility= windows portal-depth door cluster-test "
     "calibration= dear-shading jitter occluder-triangles occlusion-size masked occluder-error close-gaps "
     "no-faces no-second-look second-look-polygons lod-error lod-fade budget hard-budget cost-object "
     "cost-triangle cost-vertex cost-pixel renderer stream time-limit quiet -q"},
    {"advise", "what to turn on, bake, split or merge in a scene, each tried on its own frames", "sightline-lab",
     "split up unit sides import-memory import-time cameras eye look path frames seed fps speed size threads json= "
     "repeat use skip distance contribution section visibility= windows portal-depth door cluster-test "
     "calibration= dear-shading jitter occluder-triangles occlusion-size masked occluder-error close-gaps "
     "no-faces no-second-look second-look-polygons lod-error lod-fade budget hard-budget cost-object "
     "cost-triangle cost-vertex cost-pixel quiet -q"},
    {"report", "what cull's JSON holds, as a page; and two runs compared", "sightline-lab",
     "compare output= json= fail-if-slower quiet -o -q"},
    {"bench", "measures this machine: each technique beside its plain baseline", "sightline-bench", ""},
    {"view", "fly through a scene, leave the culling camera and look at what it left", "sightline-view", ""},
    {"config", "every option of a configuration file, with what is in effect", "sightline-lab", ""},
};

/// The words of a verb's options.
std::vector<std::string_view> wordsOf(const OtherVerb& verb) {
    std::vector<std::string_view> words;
    for (size_t at = 0; at < verb.options.size();) {
        const size_t end = std::min(verb.options.find(' ', at), verb.options.size());
        words.push_back(verb.options.substr(at, end - at));
        at = end + 1;
    }
    return words;
}

}  // namespace

std::span<const OtherVerb> otherVerbs() { return kOthers; }

const OtherVerb* findOtherVerb(std::string_view name) {
    for (const OtherVerb& other : kOthers)
        if (other.name == name) return &other;
    return nullptr;
}

std::vector<OtherOption> optionsOf(const OtherVerb& verb) {
    std::vector<OtherOption> options;
    for (const std::string_view word : wordsOf(verb))
        if (!word.starts_with('-')) options.push_back({word.substr(0, word.find('=')), word.ends_with('=')});
    return options;
}

std::vector<std::string> otherOwners(std::string_view option) {
    std::vector<std::string> owners;
    for (const OtherVerb& other : kOthers)
        for (const std::string_view word : wordsOf(other))
            if (word == option || (option.starts_with("--") && word.substr(0, word.find('=')) == option.substr(2)))
                owners.emplace_back(other.name);
    return owners;
}

Command addOtherVerb(Command& tool, std::string_view name) {
    return tool.add_subcommand(std::string(name), std::string(findOtherVerb(name)->about));
}

}  // namespace sightline::cli
