// Procedural scenes by their specification, and the small made ones that show where a hidden-surface method fails.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/procedural.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "sightline/geom/view.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/city/city.h"
#include "sightline/tools/scene/terrain/terrain.h"

namespace sightline::tools {
namespace {

constexpr double kFovY = 1.0;  // [radians]

struct Colour {
    const char* name;
    glm::vec4 value;
};

constexpr std::array<Colour, 8> kColours{{
    {"red", {0.80f, 0.10f, 0.08f, 1}},
    {"blue", {0.10f, 0.25f, 0.80f, 1}},
    {"yellow", {0.90f, 0.75f, 0.10f, 1}},
    {"green", {0.10f, 0.60f, 0.20f, 1}},
    {"violet", {0.50f, 0.15f, 0.65f, 1}},
    {"orange", {0.95f, 0.45f, 0.05f, 1}},
    {"cyan", {0.10f, 0.65f, 0.75f, 1}},
    {"grey", {0.55f, 0.55f, 0.55f, 1}},
}};

/// Adds a convex polygon as an object of its own; object i has material i and key i.
/// @param corners  counter-clockwise is front  [size: >= 3]
/// @pre fewer than kColours.size() objects are there
void addShape(Scene& scene, const std::string& what, std::vector<glm::vec3> corners) {
    const uint32_t number = static_cast<uint32_t>(scene.objects.size());
    const Colour& colour = kColours[number];
    Material material;
    material.name = colour.name;
    material.base_color = colour.value;
    material.double_sided = true;
    scene.materials.push_back(std::move(material));

    Mesh mesh;
    mesh.name = std::string(colour.name) + " " + what;
    for (uint32_t i = 2; i < corners.size(); ++i) mesh.indices.insert(mesh.indices.end(), {0, i - 1, i});
    for (const glm::vec3& corner : corners) mesh.bounds.grow(glm::dvec3(corner));
    mesh.positions = std::move(corners);
    mesh.primitives.push_back({0, static_cast<uint32_t>(mesh.triangles()), number});

    SceneObject object;
    object.key = number;
    object.mesh = number;
    object.name = mesh.name;
    scene.meshes.push_back(std::move(mesh));
    scene.objects.push_back(std::move(object));
}

void addCamera(Scene& scene, const glm::dvec3& eye, const glm::dvec3& target) {
    SceneCamera camera;
    camera.name = "made";
    camera.transform = glm::inverse(lookAt(eye, target, {0, 1, 0}));
    camera.fov_y = kFovY;
    scene.cameras.push_back(std::move(camera));
}

void makeCycle(Scene& scene) {
    const std::array<glm::vec3, 3> corners{{{-1, -0.7f, 0}, {1, -0.7f, 0}, {0, 1, 0}}};
    for (size_t i = 0; i < 3; ++i) {
        glm::vec3 begin = corners[i], end = corners[(i + 1) % 3];
        const glm::vec3 along = end - begin;
        const glm::vec3 across = 0.12f * glm::normalize(glm::vec3(-along.y, along.x, 0));
        begin -= 0.3f * along;
        end += 0.3f * along;
        begin.z = -3.5f;
        end.z = -4.5f;
        addShape(scene, "bar", {begin - across, end - across, end + across, begin + across});
    }
    addCamera(scene, {0, 0, 0}, {0, 0, -1});
}

void makeCrossing(Scene& scene) {
    addShape(scene, "triangle", {{-2, -1.25f, -3}, {2, -1.25f, -5}, {0, 1.5f, -4}});
    addShape(scene, "triangle", {{-2, -1.0f, -5}, {2, -1.0f, -3}, {0, 1.75f, -4}});
    addShape(scene, "triangle", {{-2, 0.75f, -4.5f}, {0, -1.5f, -3.25f}, {2, 0.75f, -4.5f}});
    addCamera(scene, {0, 0, 0}, {0, 0, -1});
}

/// All corners are multiples of 1/4, so that z = x/2 + y/4 - 5 is exact in float: the squares lie in one plane bit by
/// bit, but a method that evaluates each one's plane for itself may find either in front.
void makeCoplanar(Scene& scene) {
    const auto on = [](float x, float y) { return glm::vec3(x, y, 0.5f * x + 0.25f * y - 5); };
    for (const glm::vec2& low : {glm::vec2(-2.25f, -1.5f), glm::vec2(-1, -1), glm::vec2(0.25f, -0.5f)}) {
        const glm::vec2 high = low + 2.0f;
        addShape(scene, "square", {on(low.x, low.y), on(high.x, low.y), on(high.x, high.y), on(low.x, high.y)});
    }
    addCamera(scene, {0, 0, 0}, {0, 0, -1});
}

void makeNear(Scene& scene) {
    addShape(scene, "floor", {{-6, 0, -1}, {6, 0, -1}, {6, 0, -40}, {-6, 0, -40}});
    addShape(scene, "square", {{-1, 0.01f, -30}, {1, 0.01f, -30}, {1, 2.01f, -30}, {-1, 2.01f, -30}});
    addCamera(scene, {0, 10, 4}, {0, 0, -20});
}

void makeWalls(Scene& scene) {
    constexpr int kWalls = 8;
    const double half = std::tan(0.5 * kFovY) * 1.05;  // half the image's height at distance 1, and a margin
    for (int i = kWalls; i >= 1; --i) {
        const float z = static_cast<float>(-1 - i), y = static_cast<float>(-z * half), x = 4 * y;
        addShape(scene, "wall", {{-x, -y, z}, {x, -y, z}, {x, y, z}, {-x, y, z}});
    }
    addCamera(scene, {0, 0, 0}, {0, 0, -1});
}

void makeEye(Scene& scene) {
    addShape(scene, "floor", {{-5, -1, 4}, {5, -1, 4}, {0, -1, -12}});
    addShape(scene, "ceiling", {{-5, 1.25f, 4}, {0, 1.25f, -12}, {5, 1.25f, 4}});
    addShape(scene, "wall", {{-1.5f, -2, 3}, {-1.5f, 0, -10}, {-1.5f, 2, 3}});
    addShape(scene, "blade", {{0.5f, -1.5f, -6}, {2.5f, 0.25f, 3}, {0.75f, 1.5f, -6}});
    addShape(scene, "spike", {{-0.5f, -0.75f, 2}, {0.5f, -0.5f, 2}, {-0.25f, -0.25f, -8}});
    addCamera(scene, {0, 0, 0}, {0, 0, -1});
}

using Maker = void (*)(Scene&);
constexpr std::array<Maker, 6> kMakers{makeCycle, makeCrossing, makeCoplanar, makeNear, makeWalls, makeEye};

constexpr std::string_view kMade = "made";

/// A scene that a seed and a size make: name:SEED:SIZE.
struct WorldMaker {
    std::string_view name, size;  ///< as in the specification
    std::string_view size_in_words;
    uint64_t least, most;  ///< limits of the size
    Scene (*make)(uint64_t seed, uint32_t size);
};

constexpr std::array<WorldMaker, 3> kWorldMakers{{
    {"city", "OBJECTS", "number of objects", 1, 10'000'000, makeCity},
    {"building", "FLOORS", "number of floors", 1, 200, makeBuilding},
    {"terrain", "SIZE", "number of samples along a side", 16, 8192, makeTerrain},
}};

Error usage(const std::string& spec, const std::string& what) {
    return {Error::Kind::kUsage, fmt::format("{}: {}", spec, what)};
}

/// The whole text as a decimal number that fits.
std::optional<uint64_t> parseNumber(std::string_view text) {
    uint64_t number = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc() || stop != end) return std::nullopt;
    return number;
}

/// True if the text begins with the name and a colon.
bool begins(std::string_view spec, std::string_view name) {
    return spec.size() > name.size() && spec.substr(0, name.size()) == name && spec[name.size()] == ':';
}

Result<Scene> makeMade(const std::string& spec) {
    if (std::optional<Scene> scene = makeMadeScene(std::string_view(spec).substr(kMade.size() + 1)))
        return std::move(*scene);
    std::string names;
    for (const MadeScene& made : madeScenes()) names += (names.empty() ? "" : ", ") + std::string(made.name);
    return usage(spec, fmt::format("there is no such made scene (there are: {})", names));
}

Result<Scene> makeSeeded(const std::string& spec, const WorldMaker& maker) {
    const std::string_view rest = std::string_view(spec).substr(maker.name.size() + 1);
    const size_t colon = rest.find(':');
    if (colon == std::string_view::npos)
        return usage(spec, fmt::format("the {} is missing: {}:SEED:{}", maker.size_in_words, maker.name, maker.size));
    const std::optional<uint64_t> seed = parseNumber(rest.substr(0, colon));
    if (!seed) return usage(spec, "the seed is not a number from 0 to 2^64 - 1");
    const std::optional<uint64_t> size = parseNumber(rest.substr(colon + 1));
    if (!size || *size < maker.least || *size > maker.most)
        return usage(spec,
                     fmt::format("the {} is not a number from {} to {}", maker.size_in_words, maker.least, maker.most));
    Scene scene = maker.make(*seed, static_cast<uint32_t>(*size));
    scene.name = spec;
    return scene;
}

}  // namespace

const std::vector<MadeScene>& madeScenes() {
    static const std::vector<MadeScene> scenes{
        {"cycle", "three bars, each over the next"},      {"crossing", "triangles through one another"},
        {"coplanar", "overlapping squares in one plane"}, {"near", "a long floor and a small square"},
        {"walls", "eight walls, one behind the other"},   {"eye", "triangles through the plane of the eye"},
    };
    return scenes;
}

std::optional<Scene> makeMadeScene(std::string_view name) {
    for (size_t i = 0; i < kMakers.size(); ++i) {
        if (madeScenes()[i].name != name) continue;
        Scene scene;
        scene.name = "made:" + std::string(name);
        kMakers[i](scene);
        return scene;
    }
    return std::nullopt;
}

bool isProcedural(const std::string& spec) {
    if (begins(spec, kMade)) return true;
    return std::any_of(kWorldMakers.begin(), kWorldMakers.end(),
                       [&](const WorldMaker& maker) { return begins(spec, maker.name); });
}

Result<Scene> makeProcedural(const std::string& spec) {
    if (begins(spec, kMade)) return makeMade(spec);
    for (const WorldMaker& maker : kWorldMakers)
        if (begins(spec, maker.name)) return makeSeeded(spec, maker);
    std::string names;
    for (const WorldMaker& maker : kWorldMakers) names += fmt::format("{}:SEED:{}, ", maker.name, maker.size);
    return usage(spec, fmt::format("not a procedural scene (there are {}made:NAME)", names));
}

}  // namespace sightline::tools
