// Regions that a user names: boxes, marked cells and nodes of a scene; and which objects may be seen from any of them.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/regions.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include <fmt/core.h>

#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/common.h"
#include "sightline/query/sight_query.h"
#include "sightline/tools/scene/one_line.h"

namespace sightline::cli {
using namespace tools;
namespace {

/// Whether a text is a pattern in which * stands for any characters and ? for one.
bool matches(std::string_view pattern, std::string_view text) {
    size_t p = 0, t = 0, star = std::string_view::npos, after = 0;
    while (t < text.size()) {
        if (p < pattern.size() && pattern[p] == '*') {
            star = p++;
            after = t;
        } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
            ++p;
            ++t;
        } else if (star != std::string_view::npos) {
            p = star + 1;
            t = ++after;
        } else {
            return false;
        }
    }
    return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

std::string pathOf(const Scene& scene, uint32_t node) {
    std::string path;
    for (uint32_t at = node; at != SceneNode::kNone && path.size() < kLongestPath; at = scene.nodes[at].parent)
        if (!scene.nodes[at].name.empty()) path = scene.nodes[at].name + (path.empty() ? "" : "/" + path);
    return path;
}

std::vector<NamedRegion> nodesLike(const Scene& scene, const std::string& pattern) {
    std::vector<uint8_t> named(scene.nodes.size());
    for (uint32_t i = 0; i < named.size(); ++i)
        named[i] = matches(pattern, lower(scene.nodes[i].name)) || matches(pattern, lower(pathOf(scene, i)));
    std::map<uint32_t, Box3d> boxes;  // by node
    for (const SceneObject& object : scene.objects) {
        const Box3d& bounds = scene.meshes[object.mesh].bounds;
        Box3d placed;
        for (uint32_t i = 0; i < 8 && !bounds.empty(); ++i)
            placed.grow(glm::dvec3(object.transform * glm::dvec4(bounds.corner(i), 1)));
        for (uint32_t at = object.node; at != SceneNode::kNone; at = scene.nodes[at].parent)
            if (named[at] && !placed.empty()) boxes[at].grow(placed);
    }
    std::vector<NamedRegion> regions;
    for (const auto& [node, box] : boxes) regions.push_back({pathOf(scene, node), box});
    return regions;
}

Result<NamedRegion> readBox(const std::string& text) {
    const std::vector<std::string> parts = splitAt(text, ',');
    double numbers[6] = {};
    bool good = parts.size() == 6;
    for (size_t i = 0; i < 6 && good; ++i) good = readNumber(parts[i], numbers[i]) && std::isfinite(numbers[i]);
    const Box3d box{{numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}};
    if (good && !box.empty()) return NamedRegion{text, box};
    return usageError(fmt::format("--from-box {}: not X,Y,Z,X,Y,Z of a box's least and greatest corner", text));
}

}  // namespace

void addRegionOptions(Command& verb, RegionChoice& choice) {
    verb.add_option("--from-box", choice.box, "eyes anywhere in a box [world units]")->type_name("X,Y,Z,X,Y,Z");
    verb.add_option("--from-node", choice.node,
                    "eyes anywhere in the boxes of the marked cells, or else of the nodes, of this name; * and ? stand "
                    "for any characters, as in 'Corridor*'")
        ->type_name("NAME");
    verb.add_option(
            "--inset", choice.inset,
            "with these: eyes stay so far from the sides of the boxes, as from walls and the floor [world units]")
        ->check(Range{0.0, 1e9})
        ->type_name("D")
        ->capture_default_str();
}

namespace {

Result<std::vector<NamedRegion>> wholeRegionsOf(const Scene& scene, const RegionChoice& choice) {
    std::vector<NamedRegion> regions;
    if (!choice.box.empty()) {
        const Result<NamedRegion> box = readBox(choice.box);
        if (!box) return box.error();
        regions.push_back(*box);
    }
    if (choice.node.empty()) return regions;
    const std::string pattern = lower(choice.node);
    const size_t before = regions.size();
    for (const SceneCell& cell : scene.cells)
        if (matches(pattern, lower(cell.name))) regions.push_back({cell.name, cell.bounds});
    if (regions.size() == before)
        for (NamedRegion& region : nodesLike(scene, pattern)) regions.push_back(std::move(region));
    if (regions.size() > before) return regions;
    return usageError(
        fmt::format("--from-node {}: no cell and no node that holds objects has such a name", choice.node));
}

}  // namespace

Result<std::vector<NamedRegion>> regionsOf(const Scene& scene, const RegionChoice& choice) {
    Result<std::vector<NamedRegion>> regions = wholeRegionsOf(scene, choice);
    if (!regions) return regions;
    std::vector<NamedRegion> out;
    for (NamedRegion region : *regions) {
        region.box.min += choice.inset;
        region.box.max -= choice.inset;
        if (!region.box.empty()) out.push_back(std::move(region));
    }
    const std::string first = oneLine(regions->front().name, 80);
    if (out.empty()) return usageError(fmt::format("--inset {}: nothing is left of \"{}\"", choice.inset, first));
    if (out.size() < regions->size())
        note(fmt::format("--inset {}: {} of {} boxes are too narrow for an eye", choice.inset,
                         regions->size() - out.size(), regions->size()));
    return out;
}

SeenFromRegions seenFrom(const AskedScene& asked, const std::vector<NamedRegion>& regions) {
    SeenFromRegions out;
    out.seen.assign(asked.scene.objects.size(), 0);
    SightQuery query;
    for (const NamedRegion& region : regions) {
        const RegionSet set = query.seenFrom(asked.now, region.box);
        if (!set.known) out.unknown.push_back(region.name);
        for (const Visible& visible : set.objects) out.seen[AskedScene::objectOf(visible.id)] = 1;
    }
    return out;
}

}  // namespace sightline::cli
