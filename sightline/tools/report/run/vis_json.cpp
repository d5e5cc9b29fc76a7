// What a bake of a map's visibility came to, as JSON.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/run/vis_json.h"
#include "sightline/tools/scene/json_text.h"

#include <nlohmann/json.hpp>

namespace sightline::tools {

std::string visJson(const VisSummary& summary) {
    using Json = nlohmann::ordered_json;
    Json out;
    out["schema"] = "sightline.vis/1";
    out["map"] = summary.map;
    out["clusters_are"] = summary.cells_are;
    out["leafs"] = summary.leafs;
    out["clusters"] = summary.clusters;
    out["portals"] = summary.portals;
    out["visible_leaf_pairs"] = summary.visible_leaf_pairs;
    out["witnessed_pairs"] = summary.witnessed_pairs;
    out["unresolved_pairs"] = summary.unresolved_pairs;
    out["visible_cluster_pairs"] = summary.visible_cluster_pairs;
    out["witnessed_cluster_pairs"] = summary.witnessed_cluster_pairs;
    out["pvs_bytes"] = summary.pvs_bytes;
    out["resident_bytes"] = summary.resident_bytes;
    out["lump_bytes"] = summary.lump_bytes;
    out["steps"] = summary.steps;
    out["over_budget"] = summary.over_budget;
    out["stopped"] = summary.stopped;
    out["farthest"] = summary.farthest;
    out["threads"] = summary.threads;
    out["cpu_seconds"] = summary.cpu_seconds;
    out["wall_seconds"] = summary.wall_seconds;
    const auto vector = [](const glm::dvec3& p) { return Json{p.x, p.y, p.z}; };
    out["unknown_brushes"] = {{"count", summary.unknown_brushes}, {"textures", summary.unknown_textures}};
    out["leaks"] = Json::array();
    for (const VisSummary::Leak& leak : summary.leaks) {
        Json path = Json::array();
        for (const glm::dvec3& point : leak.path) path.push_back(vector(point));
        out["leaks"].push_back({{"from", leak.from}, {"path", path}});
    }
    if (summary.before)
        out["before"] = {{"visible_pairs", summary.before->visible_pairs},
                         {"removed", summary.before->removed},
                         {"added", summary.before->added}};
    if (summary.objects)
        out["objects"] = {{"count", summary.objects->objects},
                          {"visible_pairs", summary.objects->visible_pairs},
                          {"pairs_by_cells", summary.objects->pairs_by_cells},
                          {"cpu_seconds", summary.objects->cpu_seconds}};
    if (summary.verification) {
        const VisSummary::Verification& verified = *summary.verification;
        const auto examples = [&](const std::vector<VisSummary::Verification::Example>& of) {
            Json all = Json::array();
            for (const VisSummary::Verification::Example& e : of)
                all.push_back({{"from_leaf", e.from_leaf},
                               {"to_leaf", e.to_leaf},
                               {"from", vector(e.from)},
                               {"to", vector(e.to)}});
            return all;
        };
        out["verification"] = {{"segments", verified.segments},
                               {"false_negatives", verified.false_negatives},
                               {"doubtful", verified.doubtful},
                               {"examples", examples(verified.examples)}};
        if (verified.brushes)
            out["verification"]["brushes"] = {{"segments", verified.brushes->segments},
                                              {"false_negatives", verified.brushes->false_negatives},
                                              {"solid_leaves", verified.brushes->solid_leaves},
                                              {"examples", examples(verified.brushes->examples)}};
    }
    return jsonText(out, 2) + "\n";
}

}  // namespace sightline::tools
