// A procedural terrain: a height field in chunks, lakes, woods, rocks and farms.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/terrain/terrain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "sightline/base/random.h"
#include "sightline/tools/scene/scene.h"
#include "sightline/tools/scene/terrain/height.h"
#include "sightline/tools/scene/terrain/library.h"

namespace sightline::tools::terrain {
namespace {

// Strews trees, rocks and farms over a procedural terrain.

inline constexpr uint32_t kMostObjects = 200'000;  ///< that stand on the ground

constexpr double kCell = 16;       // one stream of random numbers for each square  [metres]
constexpr double kFarmCell = 224;  // at most one farm in each
constexpr double kFarmReach = 34;  // from its middle to beyond its fence
constexpr double kShore = 1.25;    // nothing stands lower over the water
constexpr int kMostInCell = 3;     // trees

/// Where a square of the plan has its random numbers.
uint64_t placeOf(int64_t x, int64_t z) {
    return (static_cast<uint64_t>(static_cast<uint32_t>(x)) << 32) | static_cast<uint32_t>(z);
}

/// A direction of the plan, uniform enough, and the same on every machine.
glm::dvec2 anyDirection(Random& random) {
    for (;;) {
        const glm::dvec2 d{random.uniform(-1, 1), random.uniform(-1, 1)};  // braces keep the order
        const double length2 = glm::dot(d, d);
        if (length2 > 0.01 && length2 <= 1) return d / std::sqrt(length2);
    }
}

class Strewer {
public:
    Strewer(const HeightField& field, uint64_t seed, Scene& scene)
        : field_(field),
          seed_(seed),

          scene_(scene),
          trees_(node("Trees", SceneNode::kNone)),
          rocks_(node("Rocks", SceneNode::kNone)) {
        const double side = (field.high() - field.low()) / kCell;
        const double expected = side * side * (kMostInCell + 1);
        keep_ = std::min(1.0, kMostObjects / (1.05 * expected));
    }

    void strew() {
        const uint32_t farms = node("Farms", SceneNode::kNone);
        eachCell(kFarmCell, [&](int64_t x, int64_t z) { addFarm(x, z, farms); });
        eachCell(kCell, [&](int64_t x, int64_t z) { fillCell(x, z); });
    }

private:
    uint32_t node(std::string name, uint32_t parent) {
        scene_.nodes.push_back({std::move(name), parent});
        return static_cast<uint32_t>(scene_.nodes.size() - 1);
    }

    /// All squares that touch the terrain, by their number from the origin.
    template <class Visit>
    void eachCell(double cell, const Visit& visit) {
        const auto first = static_cast<int64_t>(std::floor(field_.low() / cell));
        const auto last = static_cast<int64_t>(std::floor(field_.high() / cell));
        for (int64_t z = first; z <= last; ++z)
            for (int64_t x = first; x <= last; ++x) visit(x, z);
    }

    bool inside(const glm::dvec2& at, double margin) const {
        return std::min(at.x, at.y) >= field_.low() + margin && std::max(at.x, at.y) <= field_.high() - margin;
    }

    void put(Item item, const glm::dvec2& at, const glm::dvec2& front, const glm::dvec3& scale, uint32_t node,
             double sunk = 0) {
        if (standing_ == kMostObjects) return;
        ++standing_;
        SceneObject& object = scene_.objects.emplace_back();
        object.key = scene_.objects.size() - 1;
        object.mesh = item;
        object.node = node;
        object.name = scene_.meshes[item].name + " " + std::to_string(++counts_[item]);
        object.transform[0] = {front.y * scale.x, 0, -front.x * scale.x, 0};
        object.transform[1] = {0, scale.y, 0, 0};
        object.transform[2] = {front.x * scale.z, 0, front.y * scale.z, 0};
        object.transform[3] = {at.x, field_.ground(at) - sunk, at.y, 1};
    }

    /// Difference between the highest and the lowest ground under a square.
    double relief(const glm::dvec2& at, double reach) const {
        double low = field_.ground(at), high = low;
        for (double x = -reach; x <= reach; x += 0.25 * reach)
            for (double z = -reach; z <= reach; z += 0.25 * reach) {
                const double height = field_.ground(at + glm::dvec2(x, z));
                low = std::min(low, height);
                high = std::max(high, height);
            }
        return high - low;
    }

    bool onFarm(const glm::dvec2& at) const {
        const auto x = static_cast<int64_t>(std::floor(at.x / kFarmCell)),
                   z = static_cast<int64_t>(std::floor(at.y / kFarmCell));
        const auto farm = farms_.find({x, z});  // a farm keeps within its own square
        return farm != farms_.end() && glm::dot(at - farm->second, at - farm->second) < kFarmReach * kFarmReach;
    }

    void addFarm(int64_t x, int64_t z, uint32_t parent) {
        Random random(mixSeed(seed_ ^ 0x6661726dull, placeOf(x, z)));
        for (int tries = 0; tries < 12; ++tries) {
            const double share = kFarmReach / kFarmCell;
            const glm::dvec2 at =
                (glm::dvec2(x, z) + glm::dvec2{random.uniform(share, 1 - share), random.uniform(share, 1 - share)}) *
                kFarmCell;
            const glm::dvec2 front = anyDirection(random);
            if (!inside(at, kFarmReach + 4) || relief(at, 22) > 9 || field_.ground(at) < kLakeLevel + 4) continue;
            if (relief(at, 6) > 2.5 || field_.ground(at) > 110) continue;
            farms_[{x, z}] = at;
            const uint32_t farm = node("Farm " + std::to_string(farms_.size()), parent);
            const glm::dvec2 right(front.y, -front.x);
            const double size = random.uniform(0.9, 1.1);
            put(random.below(4) ? kHouse : kHut, at, front, glm::dvec3(size), farm);
            const glm::dvec2 barn = at - front * 2.0 + right * (random.below(2) ? 17.0 : -17.0);
            if (relief(barn, 8) < 3) put(kBarn, barn, random.below(2) ? right : front, glm::dvec3(1), farm);
            put(kWell, at + front * 9.0 - right * 4.0, front, glm::dvec3(1), farm);
            addFence(at, front, 6 + static_cast<int>(random.below(2)), 5, farm);
            for (int i = 0; i < 4; ++i) {
                const double back = random.uniform(10, 15), aside = random.uniform(-16, 16);
                const glm::dvec2 tree = at - front * back + right * aside;
                const double tall = random.uniform(0.4, 0.7);
                put(kOak, tree, anyDirection(random), glm::dvec3(tall), farm);
            }
            return;
        }
    }

    /// Around a yard of 2 half[0] by 2 half[1] lengths, with a gate in front; each length follows the ground.
    void addFence(const glm::dvec2& middle, const glm::dvec2& front, int half_wide, int half_deep, uint32_t farm) {
        const glm::dvec2 right(front.y, -front.x);
        for (int side = 0; side < 4; ++side) {
            const glm::dvec2 out = side == 0 ? front : side == 1 ? right : side == 2 ? -front : -right;
            const glm::dvec2 along(out.y, -out.x);
            const int reach = side % 2 == 0 ? half_wide : half_deep, away = side % 2 == 0 ? half_deep : half_wide;
            for (int i = -reach; i < reach; ++i) {
                if (side == 0 && i == 0) continue;
                const glm::dvec2 from = middle + out * (kFenceLength * away) + along * (kFenceLength * i);
                const glm::dvec2 to = from + along * kFenceLength;
                if (field_.ground(from) < kLakeLevel + kShore || field_.ground(to) < kLakeLevel + kShore) continue;
                if (standing_ == kMostObjects) return;
                put(kFence, from, out, glm::dvec3(1), farm);
                scene_.objects.back().transform[0].y = (field_.ground(to) - field_.ground(from)) / kFenceLength;
            }
        }
    }

    void fillCell(int64_t x, int64_t z) {
        Random random(mixSeed(seed_ ^ 0x747265ull, placeOf(x, z)));
        for (int i = 0; i <= kMostInCell; ++i) {
            const glm::dvec2 at = (glm::dvec2(x, z) + glm::dvec2{random.uniform(), random.uniform()}) * kCell;
            const glm::dvec2 front = anyDirection(random);
            const double kept = random.uniform(), chance = random.uniform(), size = random.uniform(0.7, 1.2),
                         kind = random.uniform();
            if (kept >= keep_ || !inside(at, 2) || onFarm(at)) continue;
            const double height = field_.ground(at);
            if (height < kLakeLevel + kShore) continue;
            const glm::dvec2 slope = field_.slope(at);
            const double steep = glm::dot(slope, slope);
            if (i == kMostInCell) {
                if (chance < (steep > 0.3 ? 0.5 : 0.06)) addRock(at, front, size, kind);
            } else if (steep < 0.8 && height < 170) {
                addPlant(at, front, height, chance, size, kind);
            }
        }
    }

    void addRock(const glm::dvec2& at, const glm::dvec2& front, double size, double kind) {
        const Item item = kind < 0.35 ? kBoulder : kind < 0.6 ? kSlabRock : kStones;
        put(item, at, front, glm::dvec3(size * (kind < 0.1 ? 2 : 1)), rocks_);
    }

    void addPlant(const glm::dvec2& at, const glm::dvec2& front, double height, double chance, double size,
                  double kind) {
        const double wood = noise(seed_ + 71, at / 150.0).value + 0.5 * noise(seed_ + 72, at / 47.0).value;
        const double thick = std::clamp(0.25 + 1.5 * wood, 0.015, 0.8);
        if (chance >= thick) return;
        const double cold = height / 90 + 0.6 * noise(seed_ + 73, at / 230.0).value + 0.5 * (kind - 0.5);
        const Item item = kind > 0.9    ? kBush
                          : cold > 0.25 ? (kind < 0.2 ? kPine : kSpruce)
                                        : (kind < 0.3 ? kBirch : kOak);
        put(item, at, front, {size, size * (0.85 + 0.3 * kind), size}, trees_);
    }

    const HeightField& field_;
    uint64_t seed_;
    Scene& scene_;
    uint32_t trees_, rocks_;
    double keep_ = 1;
    uint32_t standing_ = 0;
    std::array<uint32_t, kItemCount> counts_{};
    std::map<std::pair<int64_t, int64_t>, glm::dvec2> farms_;  ///< by square
};

/// Adds instances of the library, with which the scene's meshes begin, and their nodes. The place of
/// each follows from the seed and the ground alone; where there would be too many, they thin out evenly.
void strew(const HeightField& field, uint64_t seed, Scene& scene) { Strewer(field, seed, scene).strew(); }

}  // namespace
}  // namespace sightline::tools::terrain

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
