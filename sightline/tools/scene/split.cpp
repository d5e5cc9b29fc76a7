// Cuts meshes into pieces: a number for each triangle, then a mesh for each number.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/split.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

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

/// Sets that grow together; each is known by its least member.
class Sets {
public:
    explicit Sets(size_t size) : parents_(size) { std::iota(parents_.begin(), parents_.end(), 0u); }

    uint32_t find(uint32_t i) {
        while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
        return i;
    }
    void join(uint32_t a, uint32_t b) {
        const uint32_t root_a = find(a), root_b = find(b);
        parents_[std::max(root_a, root_b)] = std::min(root_a, root_b);
    }

private:
    std::vector<uint32_t> parents_;
};

Cut cutIntoParts(const Mesh& mesh) {
    std::map<std::array<float, 3>, uint32_t> places;
    std::vector<uint32_t> place_of;
    for (const glm::vec3& p : mesh.positions) {
        const std::array<float, 3> key = {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};  // no zero has a sign
        place_of.push_back(places.try_emplace(key, static_cast<uint32_t>(places.size())).first->second);
    }
    Sets sets(places.size());
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

/// One mesh for each piece.
std::vector<Mesh> piecesOf(const Mesh& mesh, const Cut& cut) {
    std::vector<Mesh> pieces(cut.names.size());
    std::vector<std::unordered_map<uint32_t, uint32_t>> corners(pieces.size());  // the mesh's to the piece's
    for (size_t i = 0; i < pieces.size(); ++i)
        pieces[i].name = mesh.name.empty() ? cut.names[i] : mesh.name + " " + cut.names[i];
    for (const Primitive& primitive : mesh.primitives)
        for (uint32_t t = primitive.first_triangle; t < primitive.first_triangle + primitive.triangle_count; ++t) {
            Mesh& piece = pieces[cut.piece_of[t]];
            auto& known = corners[cut.piece_of[t]];
            if (piece.primitives.empty() || piece.primitives.back().material != primitive.material)
                piece.primitives.push_back({static_cast<uint32_t>(piece.triangles()), 0, primitive.material});
            ++piece.primitives.back().triangle_count;
            for (size_t k = 3 * size_t{t}; k < 3 * size_t{t} + 3; ++k) {
                const uint32_t corner = mesh.indices[k];
                const auto [found, is_new] = known.try_emplace(corner, static_cast<uint32_t>(piece.positions.size()));
                if (is_new) piece.positions.push_back(mesh.positions[corner]);
                if (is_new) piece.bounds.grow(glm::dvec3(mesh.positions[corner]));
                piece.indices.push_back(found->second);
            }
        }
    return pieces;
}

/// Takes out the meshes that no object is of.
void dropUnused(Scene& scene) {
    constexpr uint32_t kUnused = ~0u;
    std::vector<uint32_t> now_at(scene.meshes.size(), kUnused);
    for (const SceneObject& object : scene.objects) now_at[object.mesh] = 0;
    std::vector<Mesh> used;
    for (size_t i = 0; i < scene.meshes.size(); ++i) {
        if (now_at[i] == kUnused) continue;
        now_at[i] = static_cast<uint32_t>(used.size());
        used.push_back(std::move(scene.meshes[i]));
    }
    for (SceneObject& object : scene.objects) object.mesh = now_at[object.mesh];
    scene.meshes = std::move(used);
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

Scene splitScene(Scene scene, const Split& split) {
    if (split.along == Split::Along::kNothing) return scene;
    std::vector<bool> whole(scene.objects.size());
    for (const ScenePortal& portal : scene.portals)
        if (portal.door != ScenePortal::kNone) whole[portal.door] = true;

    struct Cutting {
        Cut cut;
        uint32_t first = 0;  ///< mesh of its pieces
    };
    std::vector<std::optional<Cutting>> cuttings(scene.meshes.size());
    std::vector<Mesh> pieces;
    const auto first_piece = static_cast<uint32_t>(scene.meshes.size());
    const auto cuttingOf = [&](uint32_t mesh) -> const Cutting& {
        if (!cuttings[mesh]) {
            Cutting made{cutMesh(scene, scene.meshes[mesh], split), first_piece + static_cast<uint32_t>(pieces.size())};
            if (made.cut.names.size() > 1)
                for (Mesh& piece : piecesOf(scene.meshes[mesh], made.cut)) pieces.push_back(std::move(piece));
            cuttings[mesh] = std::move(made);
        }
        return *cuttings[mesh];
    };

    std::vector<SceneObject> objects;
    std::vector<uint32_t> now_at(scene.objects.size());  // of the first piece of each object
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        SceneObject& object = scene.objects[i];
        now_at[i] = static_cast<uint32_t>(objects.size());
        const bool stays = whole[i] || scene.meshes[object.mesh].deforms;
        const Cutting* cutting = stays ? nullptr : &cuttingOf(object.mesh);
        if (!cutting || cutting->cut.names.size() < 2) {
            objects.push_back(std::move(object));
            continue;
        }
        const auto node = static_cast<uint32_t>(scene.nodes.size());
        scene.nodes.push_back({std::move(object.name), object.node});
        for (size_t k = 0; k < cutting->cut.names.size(); ++k) {
            SceneObject piece;
            piece.mesh = cutting->first + static_cast<uint32_t>(k);
            piece.transform = object.transform;
            piece.name = cutting->cut.names[k];
            piece.node = node;
            objects.push_back(std::move(piece));
        }
    }
    for (ScenePortal& portal : scene.portals)
        if (portal.door != ScenePortal::kNone) portal.door = now_at[portal.door];
    for (SceneFile& file : scene.files) {
        // Files follow one another, and so do their objects.
        const auto first = std::find_if(scene.objects.begin(), scene.objects.end(),
                                        [&](const SceneObject& object) { return object.key >= file.first_key; });
        const auto index = static_cast<size_t>(first - scene.objects.begin());
        file.first_key = index < now_at.size() ? now_at[index] : objects.size();
    }
    for (size_t i = 0; i < objects.size(); ++i) objects[i].key = i;
    scene.objects = std::move(objects);
    for (Mesh& piece : pieces) scene.meshes.push_back(std::move(piece));
    dropUnused(scene);
    return scene;
}

}  // namespace sightline::tools
