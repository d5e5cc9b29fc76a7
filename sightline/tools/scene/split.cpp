// Cuts meshes into pieces: a number for each triangle, then a mesh for each number.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/split.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "sightline/tools/scene/joined_sets.h"
#include "sightline/tools/scene/welded.h"

namespace sightline::tools {
namespace {

using Cube = std::array<uint32_t, 3>;

/// To which piece each triangle of a mesh belongs, and what pieces are called.
struct Cut {
    std::vector<uint32_t> piece_of;  ///< by triangle
    std::vector<std::string> names;  ///< of pieces, in the order of their first triangles
};

/// Numbers pieces in the order in which they are met.
template <class Key, class Name>
Cut numbered(const std::vector<Key>& keys, Name&& name) {
    Cut cut;
    std::map<Key, uint32_t> numbers;
    for (const Key& key : keys) {
        const auto [found, is_new] = numbers.try_emplace(key, static_cast<uint32_t>(numbers.size()));
        if (is_new) cut.names.push_back(name(key, found->second));
        cut.piece_of.push_back(found->second);
    }
    return cut;
}

Cut cutIntoParts(const Mesh& mesh) {
    const std::vector<uint32_t> place_of = weldedPositions(mesh);
    JoinedSets sets(place_of.size());
    const auto& indices = mesh.indices;
    for (size_t i = 0; i < indices.size(); i += 3)
        for (const size_t k : {i + 1, i + 2}) sets.join(place_of[indices[i]], place_of[indices[k]]);
    std::vector<uint32_t> keys;
    for (size_t i = 0; i < indices.size(); i += 3) keys.push_back(sets.find(place_of[indices[i]]));
    return numbered(keys, [](uint32_t, uint32_t number) { return fmt::format("part {}", number); });
}

Cut cutByMaterial(const Mesh& mesh, const std::vector<Material>& materials) {
    std::vector<uint32_t> keys;
    for (const Primitive& primitive : mesh.primitives)
        keys.insert(keys.end(), primitive.triangle_count, primitive.material);
    return numbered(keys, [&](uint32_t material, uint32_t) {
        const std::string& name = materials[material].name;
        return name.empty() ? fmt::format("material {}", material) : name;
    });
}

Cut cutByGrid(const Mesh& mesh, uint32_t cubes) {
    Box3d box;
    for (const uint32_t i : mesh.indices) box.grow(glm::dvec3(mesh.positions[i]));
    const glm::dvec3 size = box.empty() ? glm::dvec3(0) : box.size();
    const double longest = std::max({size.x, size.y, size.z});
    std::vector<Cube> keys;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        glm::dvec3 center(0);
        for (size_t k = i; k < i + 3; ++k) center += glm::dvec3(mesh.positions[mesh.indices[k]]) / 3.0;
        Cube cube = {0, 0, 0};
        for (int axis = 0; longest > 0 && axis < 3; ++axis) {
            const double at = (center[axis] - box.min[axis]) / longest * cubes;
            cube[axis] = static_cast<uint32_t>(std::clamp(at, 0.0, cubes - 1.0));
        }
        keys.push_back(cube);
    }
    return numbered(keys, [](const Cube& c, uint32_t) { return fmt::format("cube {} {} {}", c[0], c[1], c[2]); });
}

Cut cutMesh(const Scene& scene, const Mesh& mesh, const Split& split) {
    switch (split.along) {
        case Split::Along::kParts:
            return cutIntoParts(mesh);
        case Split::Along::kMaterials:
            return cutByMaterial(mesh, scene.materials);
        case Split::Along::kGrid:
            return cutByGrid(mesh, split.cubes);
        case Split::Along::kNothing:
            break;
    }
    return {};
}

/// Some triangles of a mesh as a mesh.
/// @param triangles  ascending
Mesh partOf(const Mesh& mesh, const std::vector<uint32_t>& triangles) {
    Mesh part;
    part.name = mesh.name;
    std::unordered_map<uint32_t, uint32_t> known;  // the mesh's corners to the part's
    auto primitive = mesh.primitives.begin();
    for (const uint32_t t : triangles) {
        while (t >= primitive->first_triangle + primitive->triangle_count) ++primitive;
        if (part.primitives.empty() || part.primitives.back().material != primitive->material)
            part.primitives.push_back({static_cast<uint32_t>(part.triangles()), 0, primitive->material});
        ++part.primitives.back().triangle_count;
        for (size_t k = 3 * size_t{t}; k < 3 * size_t{t} + 3; ++k) {
            const uint32_t corner = mesh.indices[k];
            const auto [found, is_new] = known.try_emplace(corner, static_cast<uint32_t>(part.positions.size()));
            if (is_new) part.positions.push_back(mesh.positions[corner]);
            if (is_new) part.bounds.grow(glm::dvec3(mesh.positions[corner]));
            part.indices.push_back(found->second);
        }
    }
    return part;
}

/// Takes out the meshes that no object is of.
void dropUnused(CutScene& cut) {
    Scene& scene = cut.scene;
    constexpr uint32_t kUnused = ~0u;
    std::vector<uint32_t> now_at(scene.meshes.size(), kUnused);
    for (const SceneObject& object : scene.objects) now_at[object.mesh] = 0;
    std::vector<Mesh> used;
    std::vector<std::vector<uint32_t>> triangles;
    for (size_t i = 0; i < scene.meshes.size(); ++i) {
        if (now_at[i] == kUnused) continue;
        now_at[i] = static_cast<uint32_t>(used.size());
        used.push_back(std::move(scene.meshes[i]));
        triangles.push_back(std::move(cut.triangles_of[i]));
    }
    for (SceneObject& object : scene.objects) object.mesh = now_at[object.mesh];
    scene.meshes = std::move(used);
    cut.triangles_of = std::move(triangles);
}

std::vector<bool> shutPortals(const Scene& scene) {
    std::vector<bool> doors(scene.objects.size());
    for (const ScenePortal& portal : scene.portals)
        if (portal.door != ScenePortal::kNone) doors[portal.door] = true;
    return doors;
}

}  // namespace

Result<Split> readSplit(std::string_view text) {
    Split split;
    constexpr std::string_view kGrid = "grid:";
    if (text == "parts") split.along = Split::Along::kParts;
    else if (text == "materials") split.along = Split::Along::kMaterials;
    else if (text.starts_with(kGrid)) {
        const std::string_view number = text.substr(kGrid.size());
        const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), split.cubes);
        if (error == std::errc() && end == number.data() + number.size() && split.cubes >= 1 &&
            split.cubes <= Split::kMostCubes)
            split.along = Split::Along::kGrid;
    }
    if (split.along != Split::Along::kNothing) return split;
    return Error{Error::Kind::kUsage,
                 fmt::format("\"{}\" is not parts, materials or grid:N with N from 1 to {}", text, Split::kMostCubes)};
}

CutScene uncut(Scene scene) {
    CutScene cut;
    for (const SceneObject& object : scene.objects) cut.keys.push_back(object.key);
    cut.object_of.resize(scene.objects.size());
    std::iota(cut.object_of.begin(), cut.object_of.end(), 0u);
    cut.triangles_of.resize(scene.meshes.size());
    cut.scene = std::move(scene);
    return cut;
}

CutScene cutScene(Scene whole_scene, const Split& split) {
    CutScene out = uncut(std::move(whole_scene));
    if (split.along == Split::Along::kNothing) return out;
    Scene& scene = out.scene;
    const std::vector<bool> doors = shutPortals(scene);

    struct Cutting {
        std::vector<std::string> names;
        uint32_t first = 0;  ///< mesh of its pieces
    };
    std::vector<std::optional<Cutting>> cuttings(scene.meshes.size());
    std::vector<Mesh> pieces;
    const auto first_piece = static_cast<uint32_t>(scene.meshes.size());
    const auto cuttingOf = [&](uint32_t index) -> const Cutting& {
        if (cuttings[index]) return *cuttings[index];
        const Mesh& mesh = scene.meshes[index];
        Cut cut = cutMesh(scene, mesh, split);
        cuttings[index] = Cutting{std::move(cut.names), first_piece + static_cast<uint32_t>(pieces.size())};
        const std::vector<std::string>& names = cuttings[index]->names;
        if (names.size() < 2) return *cuttings[index];
        std::vector<std::vector<uint32_t>> triangles(names.size());
        for (uint32_t t = 0; t < cut.piece_of.size(); ++t) triangles[cut.piece_of[t]].push_back(t);
        for (size_t i = 0; i < names.size(); ++i) {
            pieces.push_back(partOf(mesh, triangles[i]));
            pieces.back().name = mesh.name.empty() ? names[i] : mesh.name + " " + names[i];
            out.triangles_of.push_back(std::move(triangles[i]));
        }
        return *cuttings[index];
    };

    std::vector<SceneObject> objects;
    std::vector<uint32_t> object_of;
    std::vector<uint32_t> now_at(scene.objects.size());  // of the first piece of each object
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        SceneObject& object = scene.objects[i];
        now_at[i] = static_cast<uint32_t>(objects.size());
        const bool stays = doors[i] || scene.meshes[object.mesh].deforms;
        const Cutting* cutting = stays ? nullptr : &cuttingOf(object.mesh);
        if (!cutting || cutting->names.size() < 2) {
            objects.push_back(std::move(object));
            object_of.push_back(static_cast<uint32_t>(i));
            continue;
        }
        const auto node = static_cast<uint32_t>(scene.nodes.size());
        scene.nodes.push_back({std::move(object.name), object.node});
        for (size_t k = 0; k < cutting->names.size(); ++k) {
            SceneObject piece;
            piece.mesh = cutting->first + static_cast<uint32_t>(k);
            piece.transform = object.transform;
            piece.name = cutting->names[k];
            piece.node = node;
            objects.push_back(std::move(piece));
            object_of.push_back(static_cast<uint32_t>(i));
        }
    }
    for (ScenePortal& portal : scene.portals)
        if (portal.door != ScenePortal::kNone) portal.door = now_at[portal.door];
    for (SceneFile& file : scene.files) {
        // Files follow one another, and so do their objects.
        const auto first =
            std::find_if(out.keys.begin(), out.keys.end(), [&](uint64_t key) { return key >= file.first_key; });
        const auto index = static_cast<size_t>(first - out.keys.begin());
        file.first_key = index < now_at.size() ? now_at[index] : objects.size();
    }
    for (size_t i = 0; i < objects.size(); ++i) objects[i].key = i;
    scene.objects = std::move(objects);
    scene.levels.clear();
    out.object_of = std::move(object_of);
    for (Mesh& piece : pieces) scene.meshes.push_back(std::move(piece));
    dropUnused(out);
    return out;
}

Scene splitScene(Scene scene, const Split& split) { return cutScene(std::move(scene), split).scene; }

std::vector<std::vector<uint32_t>> inPieces(const CutScene& cut, const std::vector<std::vector<uint32_t>>& of_wholes) {
    std::vector<std::vector<uint32_t>> out(cut.scene.objects.size());
    for (size_t i = 0; i < out.size(); ++i) {
        const std::vector<uint32_t>& of_whole = of_wholes[cut.object_of[i]];
        const std::vector<uint32_t>& triangles = cut.triangles_of[cut.scene.objects[i].mesh];
        if (triangles.empty()) out[i] = of_whole;
        for (uint32_t t = 0; t < triangles.size(); ++t)
            if (std::binary_search(of_whole.begin(), of_whole.end(), triangles[t])) out[i].push_back(t);
    }
    return out;
}

uint64_t leaveOut(CutScene& cut, const std::vector<std::vector<uint32_t>>& without) {
    Scene& scene = cut.scene;
    const uint64_t before = drawnTriangles(scene);
    const std::vector<bool> doors = shutPortals(scene);
    const auto goes = [&](size_t i) {
        return !doors[i] && without[i].size() == scene.meshes[scene.objects[i].mesh].triangles();
    };
    // A triangle of a mesh goes where none of the objects that are left needs it.
    std::vector<std::optional<std::vector<uint32_t>>> unneeded(scene.meshes.size());
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        if (goes(i)) continue;
        auto& of_mesh = unneeded[scene.objects[i].mesh];
        std::vector<uint32_t> both;
        if (of_mesh && !doors[i])
            std::set_intersection(of_mesh->begin(), of_mesh->end(), without[i].begin(), without[i].end(),
                                  std::back_inserter(both));
        else if (!doors[i]) both = without[i];
        of_mesh = std::move(both);
    }
    std::vector<SceneObject> objects;
    std::vector<uint32_t> object_of, now_at(scene.objects.size());
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        now_at[i] = static_cast<uint32_t>(objects.size());
        if (goes(i)) continue;
        objects.push_back(std::move(scene.objects[i]));
        object_of.push_back(cut.object_of[i]);
    }
    scene.objects = std::move(objects);
    scene.levels.clear();
    cut.object_of = std::move(object_of);
    for (ScenePortal& portal : scene.portals)
        if (portal.door != ScenePortal::kNone) portal.door = now_at[portal.door];

    for (size_t m = 0; m < scene.meshes.size(); ++m) {
        Mesh& mesh = scene.meshes[m];
        if (!unneeded[m] || unneeded[m]->empty() || mesh.deforms) continue;
        std::vector<uint32_t> all(mesh.triangles()), left, of;
        std::iota(all.begin(), all.end(), 0u);
        std::set_difference(all.begin(), all.end(), unneeded[m]->begin(), unneeded[m]->end(), std::back_inserter(left));
        for (const uint32_t t : left) of.push_back(cut.triangles_of[m].empty() ? t : cut.triangles_of[m][t]);
        mesh = partOf(mesh, left);
        cut.triangles_of[m] = std::move(of);
    }
    dropUnused(cut);
    return before - drawnTriangles(scene);
}

}  // namespace sightline::tools
