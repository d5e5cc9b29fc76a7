// A compiled map as a scene: faces to meshes, entities to nodes, textures to materials.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/quake/quake_scene.h"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "sightline/tools/import/gltf/gltf_fault.h"
#include "sightline/tools/import/quake/map_source.h"
#include "sightline/tools/import/quake/quake_map.h"
#include "sightline/tools/import/quake/quake_patch.h"
#include "sightline/tools/import/quake/quake_surface.h"

namespace sightline::tools {
namespace {

using gltf::fail;
using gltf::printable;

/// Materials by texture and by what becomes of it, each made when it is first asked for.
class Materials {
public:
    Materials(const QuakeMapFile& map, Scene& scene) : map_(map), scene_(scene), known_(map.textures.size()) {
        for (auto& of_texture : known_) of_texture.fill(kNone);
        scene_.materials.emplace_back();
    }

    uint32_t of(uint32_t texture, QuakeSurface surface) {
        uint32_t& known = known_[texture][static_cast<size_t>(surface)];
        if (known != kNone) return known;
        known = static_cast<uint32_t>(scene_.materials.size());
        Material& material = scene_.materials.emplace_back();
        material.name = map_.textures[texture].name;
        if (surface == QuakeSurface::kSeeThrough) material.alpha_mode = AlphaMode::kBlend;
        material.transmissive = surface == QuakeSurface::kMovable || surface == QuakeSurface::kCurved;
        material.double_sided = surface == QuakeSurface::kSeeThrough || surface == QuakeSurface::kCurved;
        return known;
    }

private:
    static constexpr uint32_t kNone = ~0u;
    const QuakeMapFile& map_;
    Scene& scene_;
    std::vector<std::array<uint32_t, static_cast<size_t>(QuakeSurface::kNotDrawn)>> known_;
};

/// Fans are drawn around the first point, as engines do.
Mesh meshOf(const QuakeMapFile& map, const QuakeFace& face) {
    const std::span points = std::span(map.points).subspan(face.first_point, face.point_count);
    Mesh out;
    if (face.kind == QuakeFace::Kind::kPatch) {
        tessellatePatch(points, face.patch_width, face.patch_height, out);
        return out;
    }
    out.positions.assign(points.begin(), points.end());
    const std::span indices = std::span(map.indices).subspan(face.first_index, face.index_count);
    out.indices.assign(indices.begin(), indices.end());
    if (out.indices.empty())
        for (uint32_t i = 1; i + 1 < face.point_count; ++i)
            for (const uint32_t index : {0u, i, i + 1}) out.indices.push_back(index);
    for (const glm::vec3& point : out.positions) out.bounds.grow(glm::dvec3(point));
    return out;
}

/// Where a model stands: an entity's node and origin.
struct Place {
    uint32_t node = 0;
    glm::dvec3 origin{0};
};

/// "*12" is model 12.
uint32_t modelOf(std::string_view text, size_t models) {
    uint32_t model = 0;
    if (!text.starts_with('*')) return 0;
    const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), model);
    return error == std::errc() && end == text.data() + text.size() && model < models ? model : 0;
}

/// The world's place, and one for each entity that shows a model; models that none shows stand where they are.
std::vector<std::vector<Place>> placesOf(const QuakeMapFile& map, const QuakeMap& text, Scene& scene) {
    std::vector<std::vector<Place>> out(map.models.size());
    const auto addNode = [&](std::string name) {
        scene.nodes.push_back({std::move(name), SceneNode::kNone});
        return static_cast<uint32_t>(scene.nodes.size() - 1);
    };
    out[0].push_back({addNode("worldspawn"), {}});
    uint64_t shown = 0;
    for (size_t i = 0; i < text.entities.size(); ++i) {
        const QuakeMapEntity& entity = text.entities[i];
        const uint32_t model = modelOf(text.valueOf(entity, "model"), map.models.size());
        if (model == 0) continue;
        Place place;
        if (const std::string_view words = text.valueOf(entity, "origin"); !words.empty()) {
            const std::optional<glm::dvec3> origin = quakeVector(words);
            if (!origin) fail("", "entity {}: its origin '{}' is no point", i, printable(words));
            place.origin = *origin;
        }
        shown += map.models[model].face_count;
        if (shown > 4 * map.faces.size()) fail("", "entity {}: its model is shown too often", i);
        place.node = addNode(fmt::format("{} *{}", text.valueOf(entity, "classname"), model));
        out[model].push_back(place);
    }
    for (size_t model = 1; model < out.size(); ++model)
        if (out[model].empty()) out[model].push_back({addNode(fmt::format("*{}", model)), {}});
    return out;
}

/// Where players begin, and where the game looks from between two levels.
void addCameras(const QuakeMap& text, Scene& scene) {
    constexpr std::string_view kStarts[] = {"info_player_start", "info_player_deathmatch", "info_player_coop",
                                            "info_intermission", "info_player_intermission"};
    constexpr size_t kMost = 64;
    constexpr double kEyes = 22;  // above an entity's origin  [world units]
    for (const std::string_view wanted : kStarts)
        for (const QuakeMapEntity& entity : text.entities) {
            const std::optional<glm::dvec3> origin = quakeVector(text.valueOf(entity, "origin"));
            if (text.valueOf(entity, "classname") != wanted || !origin || scene.cameras.size() == kMost) continue;
            const std::string_view angle = text.valueOf(entity, "angle");
            double degrees = 0;
            std::from_chars(angle.data(), angle.data() + angle.size(), degrees);
            if (!(std::abs(degrees) <= 360)) degrees = 0;
            const double yaw = degrees * std::numbers::pi / 180;  // from x towards the file's y, which is our -z
            const glm::dvec3 ahead(std::cos(yaw), 0, -std::sin(yaw)), up(0, 1, 0);
            SceneCamera& camera = scene.cameras.emplace_back();
            camera.name = wanted;
            camera.transform[0] = glm::dvec4(glm::cross(ahead, up), 0);
            camera.transform[1] = glm::dvec4(up, 0);
            camera.transform[2] = glm::dvec4(-ahead, 0);
            camera.transform[3] = glm::dvec4(*origin + kEyes * up, 1);
            camera.fov_y = 60 * std::numbers::pi / 180;
            camera.z_near = 1;
        }
}

Scene sceneOf(const QuakeMapFile& map, const QuakeMap& text) {
    Scene scene;
    Materials materials(map, scene);
    const std::vector<std::vector<Place>> places = placesOf(map, text, scene);
    for (size_t i = 0; i < map.faces.size(); ++i) {
        const QuakeFace& face = map.faces[i];
        const QuakeSurface surface = quakeSurface(map, face);
        if (surface == QuakeSurface::kNotDrawn || face.model == QuakeFace::kNone) continue;
        Mesh mesh = meshOf(map, face);
        mesh.primitives = {{0, static_cast<uint32_t>(mesh.triangles()), materials.of(face.texture, surface)}};
        for (const Place& place : places[face.model]) {
            SceneObject& object = scene.objects.emplace_back();
            object.key = i;
            object.mesh = static_cast<uint32_t>(scene.meshes.size());
            object.transform[3] = glm::dvec4(place.origin, 1);
            object.name = map.textures[face.texture].name;
            object.node = place.node;
        }
        scene.meshes.push_back(std::move(mesh));
    }
    if (scene.objects.empty()) fail("", "has no face that is drawn");
    addCameras(text, scene);
    return scene;
}

}  // namespace

Result<QuakeMap> quakeEntities(const QuakeMapFile& map, const std::string& name) {
    if (map.entities.empty()) return QuakeMap();
    const auto* const bytes = reinterpret_cast<const unsigned char*>(map.entities.data());
    return parseQuakeMap({bytes, map.entities.size()}, name + ": entities");
}

Result<Scene> quakeScene(const QuakeMapFile& map, const std::string& name) {
    const Result<QuakeMap> entities = quakeEntities(map, name);
    if (!entities) return entities.error();
    try {
        Scene scene = sceneOf(map, *entities);
        scene.name = name;
        return scene;
    } catch (const gltf::Fault& fault) { return Error{Error::Kind::kInput, name + ": " + fault.message}; }
}

Result<Scene> loadQuakeScene(const std::string& name) {
    const Result<MapBytes> source = readMapBytes(name);
    if (!source) return source.error();
    const Result<QuakeMapFile> map = parseQuakeBsp(source->bytes, source->name);
    if (!map) return map.error();
    return quakeScene(*map, source->name);
}

}  // namespace sightline::tools
