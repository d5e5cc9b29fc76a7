// Small scenes, each made to show where a hidden-surface method fails or what it costs.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/made.h"

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "sightline/geom/view.h"

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

}  // namespace sightline::tools
