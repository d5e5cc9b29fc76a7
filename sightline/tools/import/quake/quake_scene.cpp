// A compiled map as a scene: faces to meshes, entities to nodes, textures to materials.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/quake/quake_scene.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "sightline/tools/import/gltf/gltf_fault.h"
#include "sightline/tools/import/quake/map_source.h"
#include "sightline/tools/import/quake/quake_map.h"

namespace sightline::tools {
namespace {

using namespace std::string_view_literals;

/// '*' and '!' are liquids, '{' is cut out; the others are not drawn as they look, or not at all.
bool seenThroughByName(std::string_view name, bool half_life) {
    constexpr std::array kPrefixes = {"*"sv,          "!"sv,      "{"sv,         "sky"sv,      "trigger"sv,
                                      "aaatrigger"sv, "clip"sv,   "skip"sv,      "hint"sv,     "origin"sv,
                                      "null"sv,       "nodraw"sv, "waterskip"sv, "lavaskip"sv, "slimeskip"sv};
    std::string low(name);
    std::transform(low.begin(), low.end(), low.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
    if (half_life && (low.starts_with("water") || low.starts_with("laser"))) return true;  // drawn as liquids are
    return std::any_of(kPrefixes.begin(), kPrefixes.end(),
                       [&](std::string_view prefix) { return low.starts_with(prefix); });
}

/// A face parts two contents, the same two everywhere. Close behind the middle of each triangle of its fan must be
/// what is solid.
bool solidBehind(const QuakeMapFile& map, const QuakeFace& face) {
    const glm::vec3* const points = map.points.data() + face.first_point;
    glm::dvec3 area(0);
    for (uint32_t i = 1; i + 1 < face.point_count; ++i)
        area += glm::cross(glm::dvec3(points[i]) - glm::dvec3(points[0]),
                           glm::dvec3(points[i + 1]) - glm::dvec3(points[0]));
    if (!(glm::length(area) > 0)) return false;
    const glm::dvec3 normal = glm::normalize(area);
    for (uint32_t i = 1; i + 1 < face.point_count; ++i) {
        const glm::dvec3 middle = (glm::dvec3(points[0]) + glm::dvec3(points[i]) + glm::dvec3(points[i + 1])) / 3.0;
        for (const double depth : {0.03125, 0.25})  // [world units]: past the rounding of points and planes
            if (map.tree.contents[leafAt(map.tree, middle - depth * normal)] != LeafContents::kSolid) return false;
    }
    return true;
}

QuakeSurface firstSurface(const QuakeMapFile& map, const QuakeFace& face) {
    constexpr uint32_t kSpecial = 1;  // without light: liquids and skies
    const QuakeTexture& texture = map.textures[face.texture];
    const bool seen_through = (texture.surface_flags & kSpecial) != 0 ||
                              seenThroughByName(texture.name, map.format == QuakeFormat::kHalfLife);
    if (seen_through) return QuakeSurface::kSeeThrough;
    if (face.model != 0) return QuakeSurface::kMovable;
    return solidBehind(map, face) ? QuakeSurface::kSolid : QuakeSurface::kSeeThrough;
}

QuakeSurface secondSurface(const QuakeMapFile& map, const QuakeFace& face) {
    constexpr uint32_t kSky = 4, kWarp = 8, kTrans33 = 0x10, kTrans66 = 0x20, kNoDraw = 0x80, kHint = 0x100,
                       kSkip = 0x200,
                       kAlphaTest = 0x2000000;  // of later engines
    const uint32_t flags = map.textures[face.texture].surface_flags;
    if (flags & (kNoDraw | kHint | kSkip) && !(flags & kSky)) return QuakeSurface::kNotDrawn;
    if (flags & (kSky | kWarp | kTrans33 | kTrans66 | kAlphaTest)) return QuakeSurface::kSeeThrough;
    return face.model == 0 ? QuakeSurface::kSolid : QuakeSurface::kMovable;
}

QuakeSurface thirdSurface(const QuakeMapFile& map, const QuakeFace& face) {
    constexpr uint32_t kSky = 4, kNoDraw = 0x80, kHint = 0x100, kSkip = 0x200, kNonSolid = 0x4000;
    constexpr uint32_t kSolid = 1, kLava = 8, kSlime = 16, kWater = 32, kFog = 64, kTranslucent = 0x20000000;
    const QuakeTexture& texture = map.textures[face.texture];
    if (texture.surface_flags & (kNoDraw | kHint | kSkip) && !(texture.surface_flags & kSky))
        return QuakeSurface::kNotDrawn;
    if (texture.surface_flags & (kSky | kNonSolid)) return QuakeSurface::kSeeThrough;
    if (texture.contents & (kLava | kSlime | kWater | kFog | kTranslucent)) return QuakeSurface::kSeeThrough;
    if (face.kind == QuakeFace::Kind::kPatch) return QuakeSurface::kCurved;
    if (!(texture.contents & kSolid) || face.kind != QuakeFace::Kind::kPolygon) return QuakeSurface::kSeeThrough;
    return face.model == 0 ? QuakeSurface::kSolid : QuakeSurface::kMovable;
}

constexpr uint32_t kSteps = 4;  // along each side of a patch of 3 x 3 control points

/// Quadratic, over each three of the points that share an end with the next three.
struct Weights {
    uint32_t first;
    double of[3];
};

Weights weightsAt(uint32_t step, uint32_t points) {
    const uint32_t part = std::min(step / kSteps, (points - 1) / 2 - 1);
    const double t = double(step - part * kSteps) / kSteps;
    return {2 * part, {(1 - t) * (1 - t), 2 * t * (1 - t), t * t}};
}

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
    scene.walk_speed = 320;  // of the family's players
    return scene;
}

}  // namespace

QuakeSurface quakeSurface(const QuakeMapFile& map, const QuakeFace& face) {
    if (face.kind == QuakeFace::Kind::kNothing) return QuakeSurface::kNotDrawn;
    if (map.format == QuakeFormat::kQuake3) return thirdSurface(map, face);
    return map.format == QuakeFormat::kQuake2 ? secondSurface(map, face) : firstSurface(map, face);
}

void tessellatePatch(std::span<const glm::vec3> control, uint32_t width, uint32_t height, Mesh& mesh) {
    const uint32_t columns = (width - 1) / 2 * kSteps, rows = (height - 1) / 2 * kSteps;
    for (uint32_t row = 0; row <= rows; ++row)
        for (uint32_t column = 0; column <= columns; ++column) {
            const Weights u = weightsAt(column, width), v = weightsAt(row, height);
            glm::dvec3 point(0);
            for (uint32_t j = 0; j < 3; ++j)
                for (uint32_t i = 0; i < 3; ++i)
                    point += u.of[i] * v.of[j] * glm::dvec3(control[size_t(v.first + j) * width + u.first + i]);
            mesh.positions.emplace_back(point);
        }
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column) {
            const uint32_t a = row * (columns + 1) + column, b = a + 1, c = a + columns + 1, d = c + 1;
            for (const uint32_t index : {a, b, d, a, d, c}) mesh.indices.push_back(index);
        }
    for (const glm::vec3& point : control) mesh.bounds.grow(glm::dvec3(point));
    for (const glm::vec3& point : mesh.positions) mesh.bounds.grow(glm::dvec3(point));
    mesh.deforms = true;
}

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
