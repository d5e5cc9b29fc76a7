// A procedural terrain: a height field in chunks, lakes, woods, rocks and farms.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/terrain/terrain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "sightline/base/random.h"
#include "sightline/tools/scene/terrain/height.h"
#include "sightline/tools/scene/terrain/library.h"
#include "sightline/tools/scene/terrain/strew.h"

namespace sightline::tools {
namespace {

using terrain::HeightField;

constexpr uint32_t kChunk = 64;  // squares along a side

/// A range of samples, both ends included.
struct Chunk {
    uint32_t i0, j0, i1, j1;
};

/// By height and steepness.
uint32_t groundMaterial(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::vec3 normal = glm::cross(b - a, c - a);
    const float height = std::min({a.y, b.y, c.y});
    if (height < static_cast<float>(terrain::kLakeLevel) + 1) return terrain::kSand;
    if (normal.y * normal.y < 0.5f * glm::dot(normal, normal)) return terrain::kScree;
    return height > 190 ? terrain::kSnow : height > 115 ? terrain::kEarth : terrain::kGrass;
}

/// Triangles by material, in order.
Mesh chunkMesh(const HeightField& field, const Chunk& chunk) {
    constexpr uint32_t kGroundMaterials = terrain::kSand + 1;
    const uint32_t wide = chunk.i1 - chunk.i0, high = chunk.j1 - chunk.j0;
    Mesh mesh;
    mesh.positions.reserve(size_t{wide + 1} * (high + 1));
    for (uint32_t j = chunk.j0; j <= chunk.j1; ++j)
        for (uint32_t i = chunk.i0; i <= chunk.i1; ++i) mesh.positions.push_back(field.position(i, j));
    for (const glm::vec3& position : mesh.positions) mesh.bounds.grow(glm::dvec3(position));
    std::vector<uint8_t> materials;
    materials.reserve(size_t{2} * wide * high);
    std::array<uint32_t, kGroundMaterials> counts{};
    const auto each = [&](const auto& visit) {
        for (uint32_t j = 0; j < high; ++j)
            for (uint32_t i = 0; i < wide; ++i) {
                const uint32_t a = j * (wide + 1) + i, b = a + 1, d = a + wide + 1, c = d + 1;
                visit(a, d, c);
                visit(a, c, b);
            }
    };
    each([&](uint32_t a, uint32_t b, uint32_t c) {
        materials.push_back(
            static_cast<uint8_t>(groundMaterial(mesh.positions[a], mesh.positions[b], mesh.positions[c])));
        ++counts[materials.back()];
    });
    std::array<uint32_t, kGroundMaterials> next{};
    uint32_t first = 0;
    for (uint32_t m = 0; m < kGroundMaterials; ++m) {
        next[m] = first;
        if (counts[m] > 0) mesh.primitives.push_back({first, counts[m], m});
        first += counts[m];
    }
    mesh.indices.resize(size_t{3} * first);
    size_t triangle = 0;
    each([&](uint32_t a, uint32_t b, uint32_t c) {
        uint32_t* const corner = &mesh.indices[size_t{3} * next[materials[triangle++]]++];
        corner[0] = a;
        corner[1] = b;
        corner[2] = c;
    });
    return mesh;
}

/// A sheet of water over a chunk.
Mesh waterMesh(const HeightField& field, const Chunk& chunk) {
    Mesh mesh;
    const std::pair<uint32_t, uint32_t> corners[] = {
        {chunk.i0, chunk.j0}, {chunk.i0, chunk.j1}, {chunk.i1, chunk.j1}, {chunk.i1, chunk.j0}};
    for (const auto& [i, j] : corners) {
        glm::vec3 position = field.position(i, j);
        position.y = static_cast<float>(terrain::kLakeLevel);
        mesh.positions.push_back(position);
        mesh.bounds.grow(glm::dvec3(position));
    }
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.primitives = {{0, 2, terrain::kWater}};
    return mesh;
}

uint32_t addNode(Scene& scene, std::string name, uint32_t parent) {
    scene.nodes.push_back({std::move(name), parent});
    return static_cast<uint32_t>(scene.nodes.size() - 1);
}

void addObject(Scene& scene, Mesh mesh, std::string name, uint32_t node) {
    mesh.name = name;
    SceneObject& object = scene.objects.emplace_back();
    object.key = scene.objects.size() - 1;
    object.mesh = static_cast<uint32_t>(scene.meshes.size());
    object.name = std::move(name);
    object.node = node;
    scene.meshes.push_back(std::move(mesh));
}

void addGround(const HeightField& field, Scene& scene) {
    const uint32_t ground = addNode(scene, "Ground", SceneNode::kNone);
    const uint32_t water = addNode(scene, "Water", SceneNode::kNone);
    const uint32_t squares = field.size() - 1, chunks = (squares + kChunk - 1) / kChunk;
    scene.meshes.reserve(scene.meshes.size() + size_t{chunks} * chunks);
    std::vector<Chunk> wet;
    for (uint32_t row = 0; row < chunks; ++row) {
        for (uint32_t column = 0; column < chunks; ++column) {
            const Chunk chunk{column * kChunk, row * kChunk, std::min(squares, (column + 1) * kChunk),
                              std::min(squares, (row + 1) * kChunk)};
            Mesh mesh = chunkMesh(field, chunk);
            if (mesh.bounds.min.y < terrain::kLakeLevel) wet.push_back(chunk);
            addObject(scene, std::move(mesh), "Chunk " + std::to_string(column) + "," + std::to_string(row), ground);
        }
    }
    for (const Chunk& chunk : wet)
        addObject(scene, waterMesh(field, chunk),
                  "Water " + std::to_string(chunk.i0 / kChunk) + "," + std::to_string(chunk.j0 / kChunk), water);
}

void addCamera(Scene& scene, std::string name, const glm::dvec3& eye, const glm::dvec3& target) {
    const glm::dvec3 back = glm::normalize(eye - target), right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), back));
    SceneCamera& camera = scene.cameras.emplace_back();
    camera.name = std::move(name);
    camera.transform = {glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0), glm::dvec4(back, 0),
                        glm::dvec4(eye, 1)};
    camera.fov_y = 1.0471975511966;  // 60 degrees
    camera.z_near = 0.25;
}

/// From hills and valleys inward, and from above. Each of the first ones is the highest or the lowest dry place
/// of one part of the terrain.
void addCameras(const HeightField& field, Scene& scene) {
    const double low = field.low(), span = field.high() - low;
    const auto over = [&](const glm::dvec2& at, double height) {
        return glm::dvec3(at.x, std::max(field.ground(at), terrain::kLakeLevel) + height, at.y);
    };
    for (int part = 0; part < 4; ++part) {
        const glm::dvec2 corner = low + span * 0.5 * glm::dvec2(part % 2, part / 2);
        glm::dvec2 top = corner + 0.25 * span, bottom = top;
        for (int i = 1; i < 48; ++i)
            for (int j = 1; j < 48; ++j) {
                const glm::dvec2 at = corner + 0.5 * span * glm::dvec2(i, j) / 48.0;
                const double height = field.ground(at), lowest = field.ground(bottom);
                if (height > field.ground(top)) top = at;
                if (height > terrain::kLakeLevel + 1 && (height < lowest || lowest < terrain::kLakeLevel)) bottom = at;
            }
        const std::string number = std::to_string(part + 1);
        addCamera(scene, "Hill " + number, over(top, 4), over(-0.3 * top, 0));
        const glm::dvec2 ahead = 0.5 * (top + bottom);
        addCamera(scene, "Valley " + number, over(bottom, 1.75),
                  over(ahead, 1.5) * glm::dvec3(1, 0.5, 1) + glm::dvec3(0.5, 0.5 * over(bottom, 1.75).y, 0));
    }
    addCamera(scene, "Above", over({0.45 * span + low + 0.5 * span, low + 0.95 * span}, 0.12 * span + 40),
              over({low + 0.45 * span, low + 0.4 * span}, 0));
    SceneCamera& plan = scene.cameras.emplace_back();
    plan.name = "Plan";
    plan.transform = {{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 1000, 0, 1}};
    plan.orthographic_height = span;
    plan.z_far = 2000;
}

}  // namespace

Scene makeTerrain(uint64_t seed, uint32_t size) {
    Scene scene;
    scene.name = "terrain:" + std::to_string(seed) + ":" + std::to_string(size);
    Pieces library = terrain::makeLibrary();
    scene.materials = std::move(library.materials);
    scene.meshes = std::move(library.meshes);
    const uint64_t stream = mixSeed(seed, 0x74657272ull);
    const HeightField field(stream, size);
    addGround(field, scene);
    terrain::strew(field, stream, scene);
    addCameras(field, scene);
    return scene;
}

}  // namespace sightline::tools
