// Levels of detail that a scene brings with it: named by its file, or by the names of its objects.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/scene_levels.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sightline/geom/lod.h"

namespace sightline::tools {
namespace {

/// "Tree_LOD2" of "tree" is 2.
struct LevelName {
    std::string base;
    uint32_t level = 0;
};

std::optional<LevelName> readLevelName(const std::string& name) {
    std::string lower;
    for (const char c : name) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const size_t at = lower.rfind("_lod");
    if (at == std::string::npos || at == 0) return std::nullopt;
    LevelName out{lower.substr(0, at), 0};
    const char *const begin = lower.data() + at + 4, *const end = lower.data() + lower.size();
    const auto [rest, wrong] = std::from_chars(begin, end, out.level);
    if (wrong != std::errc() || rest != end || out.level >= kMostLods) return std::nullopt;
    return out;
}

/// Where the objects of one family stand: the nodes that hold them carry their names, so it is what is above these.
using Family = std::pair<uint32_t, std::string>;

uint32_t parentOf(const Scene& scene, const SceneObject& object) {
    const bool own = object.node != SceneNode::kNone && scene.nodes[object.node].name == object.name;
    return own ? scene.nodes[object.node].parent : object.node;
}

std::string lowered(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

/// Removes objects, and numbers what refers to them anew.
void removeObjects(Scene& scene, const std::vector<uint8_t>& goes) {
    std::vector<uint32_t> now_at(scene.objects.size());
    size_t left = 0;
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        now_at[i] = static_cast<uint32_t>(left);
        if (!goes[i]) scene.objects[left++] = std::move(scene.objects[i]);
    }
    scene.objects.resize(left);
    for (ScenePortal& portal : scene.portals)
        if (portal.door != ScenePortal::kNone) portal.door = now_at[portal.door];
    for (SceneLevel& level : scene.levels) level.object = now_at[level.object];
}

/// A mesh with the levels that one of its objects has.
Mesh joined(const Scene& scene, uint32_t mesh, std::span<const SceneLevel> levels) {
    Mesh out = scene.meshes[mesh];
    out.lods.clear();
    for (const SceneLevel& level : levels) {
        const Mesh& from = scene.meshes[level.mesh];
        if (from.indices.empty() || from.deforms) break;
        const Box3d box = transformBox(from.bounds, level.transform);
        if (!box.finite() || glm::any(glm::greaterThan(glm::max(-box.min, box.max), glm::dvec3(1e30)))) break;
        const auto first = static_cast<uint32_t>(out.positions.size());
        const bool flips = glm::determinant(glm::dmat3(level.transform)) < 0;
        for (const glm::vec3& position : from.positions) {
            out.positions.emplace_back(glm::dvec3(level.transform * glm::dvec4(position, 1.0)));
            out.bounds.grow(glm::dvec3(out.positions.back()));
        }
        MeshLod& lod = out.lods.emplace_back();
        lod.primitives = from.primitives;
        for (size_t i = 0; i < from.indices.size(); i += 3)
            for (const size_t corner : {size_t{0}, flips ? size_t{2} : size_t{1}, flips ? size_t{1} : size_t{2}})
                lod.indices.push_back(first + from.indices[i + corner]);
    }
    return out;
}

}  // namespace

uint32_t takeNamedLevels(Scene& scene) {
    std::vector<uint8_t> stays(scene.objects.size(), 0), goes(scene.objects.size(), 0);
    for (const ScenePortal& portal : scene.portals)
        if (portal.door != ScenePortal::kNone) stays[portal.door] = 1;
    for (const SceneLevel& level : scene.levels) stays[level.object] = 1;
    std::map<Family, std::map<uint32_t, uint32_t>> families;  // level to object; of two of one level neither counts
    std::map<Family, uint32_t> plain;
    constexpr uint32_t kTwice = ~0u;
    for (uint32_t i = 0; i < scene.objects.size(); ++i) {
        const SceneObject& object = scene.objects[i];
        if (stays[i] || scene.meshes[object.mesh].deforms) continue;
        const uint32_t parent = parentOf(scene, object);
        const auto name = readLevelName(object.name);
        const auto note = [&](auto& table, const auto& key) {
            const auto [at, is_new] = table.try_emplace(key, i);
            if (!is_new) at->second = kTwice;
        };
        if (name) note(families[{parent, name->base}], name->level);
        else note(plain, Family{parent, lowered(object.name)});
    }
    uint32_t taken = 0;
    for (auto& [family, levels] : families) {
        if (!levels.contains(0))
            if (const auto finest = plain.find(family); finest != plain.end()) levels[0] = finest->second;
        const auto broken = [&](const auto& each) { return each.second == kTwice; };
        if (!levels.contains(0) || std::any_of(levels.begin(), levels.end(), broken)) continue;
        const uint32_t finest = levels[0];
        const glm::dmat4 inverse = glm::inverse(scene.objects[finest].transform);
        for (const auto& [level, object] : levels) {
            if (level == 0) continue;
            scene.levels.push_back({finest, scene.objects[object].mesh, inverse * scene.objects[object].transform});
            goes[object] = 1;
            ++taken;
        }
    }
    if (taken > 0) removeObjects(scene, goes);
    std::stable_sort(scene.levels.begin(), scene.levels.end(),
                     [](const SceneLevel& a, const SceneLevel& b) { return a.object < b.object; });
    return taken;
}

void joinLevels(Scene& scene) {
    // Objects with the same mesh and the same levels share a mesh again.
    std::map<std::vector<double>, uint32_t> known;
    for (size_t i = 0; i < scene.levels.size();) {
        const uint32_t object = scene.levels[i].object;
        std::vector<double> key = {static_cast<double>(scene.objects[object].mesh)};
        const size_t begin = i;
        for (; i < scene.levels.size() && scene.levels[i].object == object; ++i) {
            key.push_back(static_cast<double>(scene.levels[i].mesh));
            // Matrices that differ by rounding alone are one.
            for (int column = 0; column < 4; ++column)
                for (int row = 0; row < 3; ++row)
                    key.push_back(static_cast<double>(static_cast<float>(scene.levels[i].transform[column][row])));
        }
        const auto [at, is_new] = known.try_emplace(key, static_cast<uint32_t>(scene.meshes.size()));
        if (is_new) {
            const auto levels = std::span(scene.levels).subspan(begin, i - begin);
            scene.meshes.push_back(joined(scene, scene.objects[object].mesh, levels));
        }
        scene.objects[object].mesh = at->second;
    }
    scene.levels.clear();
}

}  // namespace sightline::tools
