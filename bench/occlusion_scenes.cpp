// The scenes on which occlusion is measured: the same geometry on every machine, as occluder batches and boxes to test.
// SPDX-License-Identifier: MIT
//
// George Marsaglia. Xorshift RNGs. 2003.
#include "bench/occlusion_scenes.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/core.h>

namespace sightline::bench {
namespace {

constexpr float kPi = 3.14159265f;

/// The scenes' own random numbers. Published figures were taken on these scenes: the stream, and the order in which it
/// is read, must stay as they are.
class Stream {
public:
    explicit Stream(uint64_t seed) : state_(seed) {}

    /// In [0, 1), on the grid of 2^-24.
    float unit() {
        state_ ^= state_ << 13;
        state_ ^= state_ >> 7;
        state_ ^= state_ << 17;
        return static_cast<float>(static_cast<uint32_t>(state_ >> 16) & 0xffffff) / 16777216.0f;
    }
    float between(float low, float high) { return low + (high - low) * unit(); }

private:
    uint64_t state_;
};

Box3f boxAround(const glm::vec3& center, const glm::vec3& half) {
    Box3f box;
    box.min = center - half;
    box.max = center + half;
    return box;
}

/// A box of twelve triangles that face outward.
void addBlock(OccluderBatch& batch, const glm::vec3& low, const glm::vec3& high) {
    static constexpr uint32_t kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                              {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    const uint32_t first = static_cast<uint32_t>(batch.positions.size());
    for (int corner = 0; corner < 8; ++corner)
        batch.positions.emplace_back(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                                     corner & 4 ? high.z : low.z);
    for (const auto& face : kFaces)
        for (int k : {0, 1, 2, 0, 2, 3}) batch.indices.push_back(first + face[k]);
}

void addBatch(OcclusionScene& scene, OccluderBatch&& batch) {
    for (const glm::vec3& p : batch.positions) batch.bounds.grow(p);
    scene.batches.push_back(std::move(batch));
}

/// A corner of the height field's noise, hashed from its place.
float latticeNoise(int x, int z) {
    uint32_t h = static_cast<uint32_t>(x) * 374761393u + static_cast<uint32_t>(z) * 668265263u;
    h = (h ^ (h >> 13)) * 1274126177u;
    return static_cast<float>((h ^ (h >> 16)) & 0xffffff) / 16777216.0f;
}

float smoothNoise(float x, float z) {
    const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(z));
    float u = x - static_cast<float>(column), v = z - static_cast<float>(row);
    u = u * u * (3 - 2 * u);
    v = v * v * (3 - 2 * v);
    const float a = latticeNoise(column, row), b = latticeNoise(column + 1, row);
    const float c = latticeNoise(column, row + 1), d = latticeNoise(column + 1, row + 1);
    return a + (b - a) * u + (c - a) * v + (a - b - c + d) * u * v;
}

/// Six octaves of ridges.
float groundHeight(float x, float z) {
    float height = 0, amplitude = 160, frequency = 1 / 260.0f;
    for (int octave = 0; octave < 6; ++octave) {
        const float ridge = 1 - std::abs(2 * smoothNoise(x * frequency, z * frequency) - 1);
        height += amplitude * ridge * ridge;
        amplitude *= 0.45f;
        frequency *= 2.03f;
    }
    return height;
}

/// The side of a room that lies along one axis: solid, or two pieces and a lintel around a doorway.
void addRoomWall(OccluderBatch& batch, Stream& random, float x, float z, bool along_z) {
    constexpr float kPitch = 10, kHeight = 3.5f, kThick = 0.1f, kDoorHalf = 0.6f, kDoorHeight = 2.2f;
    const float door = random.between(2, 8);
    const bool open = random.unit() < 0.8f;
    const float start = along_z ? z : x;
    const auto piece = [&](float from, float bottom, float to) {
        if (along_z) addBlock(batch, {x - kThick, bottom, from}, {x + kThick, kHeight, to});
        else addBlock(batch, {from, bottom, z - kThick}, {to, kHeight, z + kThick});
    };
    if (!open) return piece(start, 0, start + kPitch);
    piece(start, 0, start + door - kDoorHalf);
    piece(start + door + kDoorHalf, 0, start + kPitch);
    piece(start + door - kDoorHalf, kDoorHeight, start + door + kDoorHalf);
}

OccluderBatch makeRoom(Stream& random, float x, float z) {
    constexpr float kPitch = 10, kHeight = 3.5f, kSlab = 0.2f;
    OccluderBatch room;
    addRoomWall(room, random, x, z, true);
    addRoomWall(room, random, x, z, false);
    addBlock(room, {x, -kSlab, z}, {x + kPitch, 0, z + kPitch});
    addBlock(room, {x, kHeight, z}, {x + kPitch, kHeight + kSlab, z + kPitch});
    for (int cupboard = 0; cupboard < 3; ++cupboard) {
        const float half = random.between(0.3f, 0.8f), height = random.between(0.5f, 2);
        const float at_x = random.between(1.5f, 8.5f), at_z = random.between(1.5f, 8.5f);
        addBlock(room, {x + at_x - half, 0, z + at_z - half}, {x + at_x + half, height, z + at_z + half});
    }
    return room;
}

/// A block of the height field, two triangles to a cell, in world units of 4 to a cell.
OccluderBatch makeGround(const std::vector<float>& heights, int cells, int first_x, int first_z, int side) {
    constexpr float kCell = 4;
    OccluderBatch ground;
    for (int z = first_z; z <= first_z + side; ++z)
        for (int x = first_x; x <= first_x + side; ++x)
            ground.positions.emplace_back(static_cast<float>(x) * kCell,
                                          heights[static_cast<size_t>(z * (cells + 1) + x)],
                                          static_cast<float>(z) * kCell);
    const uint32_t row = static_cast<uint32_t>(side) + 1;
    for (uint32_t z = 0; z + 1 < row; ++z)
        for (uint32_t x = 0; x + 1 < row; ++x) {
            const uint32_t a = z * row + x;
            for (uint32_t corner : {a, a + row, a + row + 1, a, a + row + 1, a + 1}) ground.indices.push_back(corner);
        }
    return ground;
}

template <class T>
void hashIn(uint64_t& hash, const T& value) {
    uint32_t words[sizeof(T) / 4];
    std::memcpy(words, &value, sizeof value);
    for (uint32_t word : words) {
        hash = (hash ^ word) * 0x9e3779b97f4a7c15ull;
        hash ^= hash >> 32;
    }
}

}  // namespace

size_t OcclusionScene::triangles() const {
    size_t count = 0;
    for (const OccluderBatch& batch : batches) count += batch.indices.size() / 3;
    return count;
}

OcclusionScene makeOcclusionCity() {
    constexpr int kSide = 64;
    constexpr float kPitch = 20;
    struct Building {
        float x0, z0, x1, z1, height;
    };
    OcclusionScene scene{"city", 60 * kPi / 180, {}, {}, {}, BatchesAre::kApart};
    Stream random(12345);
    std::vector<Building> buildings;
    for (int z = 0; z < kSide; ++z)
        for (int x = 0; x < kSide; ++x) {
            const float half_x = random.between(6, 8), half_z = random.between(6, 8), tall = random.unit();
            const float center_x = static_cast<float>(x) * kPitch + 10, center_z = static_cast<float>(z) * kPitch + 10;
            buildings.push_back(
                {center_x - half_x, center_z - half_z, center_x + half_x, center_z + half_z, 6 + tall * tall * 74});
        }
    for (int z = 0; z < kSide; z += 2)
        for (int x = 0; x < kSide; x += 2) {
            OccluderBatch quarter;
            for (int at : {z * kSide + x, z * kSide + x + 1, (z + 1) * kSide + x, (z + 1) * kSide + x + 1}) {
                const Building& b = buildings[static_cast<size_t>(at)];
                addBlock(quarter, {b.x0, 0, b.z0}, {b.x1, b.height, b.z1});
            }
            addBatch(scene, std::move(quarter));
        }
    while (scene.boxes.size() < 200000) {
        const float x = random.between(0, kSide * kPitch), z = random.between(0, kSide * kPitch);
        const Building& b = buildings[static_cast<size_t>(static_cast<int>(z / kPitch) * kSide) +
                                      static_cast<size_t>(static_cast<int>(x / kPitch))];
        const float half = random.between(0.2f, 1.5f);
        float y = half;
        if (random.unit() >= 0.8f) y += random.between(0, 20);
        // What would stand in a building stands on its roof.
        if (x > b.x0 - half && x < b.x1 + half && z > b.z0 - half && z < b.z1 + half) y = b.height + half;
        scene.boxes.push_back(boxAround({x, y, z}, {half, half * random.between(0.5f, 1), half}));
    }
    for (int i = 0; i < 8; ++i) {
        const float angle = static_cast<float>(i) * 0.785f + 0.25f;
        const bool above = i == 7;
        const glm::vec3 eye(static_cast<float>(24 + 2 * i) * kPitch + (i & 1 ? 0.0f : 0.5f), above ? 45.0f : 1.7f,
                            static_cast<float>(26 + i * 5 % 13) * kPitch + 3);
        scene.cameras.push_back({eye, {std::sin(angle), above ? -0.2f : 0.02f, std::cos(angle)}});
    }
    return scene;
}

OcclusionScene makeOcclusionTerrain() {
    constexpr int kCells = 512, kBatch = 16;
    constexpr float kCell = 4;
    OcclusionScene scene{"terrain", 60 * kPi / 180, {}, {}, {}, BatchesAre::kOneSurface};
    Stream random(777);
    std::vector<float> heights;
    for (int z = 0; z <= kCells; ++z)
        for (int x = 0; x <= kCells; ++x)
            heights.push_back(groundHeight(static_cast<float>(x) * kCell, static_cast<float>(z) * kCell));
    for (int z = 0; z < kCells; z += kBatch)
        for (int x = 0; x < kCells; x += kBatch) addBatch(scene, makeGround(heights, kCells, x, z, kBatch));
    for (int i = 0; i < 100000; ++i) {
        const float x = random.between(0, kCells * kCell), z = random.between(0, kCells * kCell);
        const float half = random.between(0.5f, 3);
        const float ground = heights[static_cast<size_t>(static_cast<int>(z / kCell) * (kCells + 1)) +
                                     static_cast<size_t>(static_cast<int>(x / kCell))];
        scene.boxes.push_back(boxAround({x, ground + half, z}, {half * 0.6f, half, half * 0.6f}));
    }
    static constexpr float kAbove[8] = {3, 30, 8, 60, 2, 15, 40, 100};
    for (int i = 0; i < 8; ++i) {
        const float turn = static_cast<float>(i), angle = turn * 0.785f + 0.3f;
        const float x = 1024 + 300 * std::sin(turn * 2.3f), z = 1024 + 300 * std::cos(turn * 1.7f);
        scene.cameras.push_back({{x, groundHeight(x, z) + kAbove[i], z},
                                 {std::sin(angle), kAbove[i] > 20 ? -0.12f : 0.03f, std::cos(angle)}});
    }
    return scene;
}

OcclusionScene makeOcclusionIndoor() {
    constexpr int kSide = 32;
    constexpr float kPitch = 10;
    OcclusionScene scene{"indoor", 70 * kPi / 180, {}, {}, {}, BatchesAre::kApart};
    Stream random(4242);
    for (int z = 0; z < kSide; ++z)
        for (int x = 0; x < kSide; ++x)
            addBatch(scene, makeRoom(random, static_cast<float>(x) * kPitch, static_cast<float>(z) * kPitch));
    for (int i = 0; i < 50000; ++i) {
        const float half = random.between(0.05f, 0.4f);
        const float x = random.between(0.5f, kSide * kPitch - 0.5f), y = random.between(half, 3);
        const float z = random.between(0.5f, kSide * kPitch - 0.5f);
        scene.boxes.push_back(boxAround({x, y, z}, glm::vec3(half)));
    }
    for (int i = 0; i < 8; ++i) {
        const float angle = static_cast<float>(i) * 0.785f + 0.15f;
        const glm::vec3 eye(static_cast<float>(10 + i * 7 % 13) * kPitch + 5.2f, 1.7f,
                            static_cast<float>(9 + i * 5 % 11) * kPitch + 5.1f);
        scene.cameras.push_back({eye, {std::sin(angle), -0.03f, std::cos(angle)}});
    }
    return scene;
}

OcclusionScene makeOcclusionSoup(SoupSize size) {
    constexpr size_t kTriangles = 100000, kBatch = 128;
    constexpr float kFov = 60 * kPi / 180, kLines = 720;
    OcclusionScene scene{size == SoupSize::kArea ? "soup-area" : "soup-side", kFov, {}, {}, {}, BatchesAre::kApart};
    Stream random(99);
    const float slope = std::tan(kFov / 2);
    std::vector<glm::vec3> centers;
    for (size_t i = 0; i < kTriangles; ++i) {
        const float z = 5 + 195 * std::pow(random.unit(), 0.5f);
        const float x = random.between(-1, 1) * slope * 16 / 9 * z;
        centers.emplace_back(x, random.between(-1, 1) * slope * z, z);
    }
    // Not stable: the published figures' order among equal depths is that of libstdc++'s sort.
    std::sort(centers.begin(), centers.end(), [](const auto& a, const auto& b) { return a.z < b.z; });
    for (size_t first = 0; first < kTriangles; first += kBatch) {
        OccluderBatch batch;
        for (size_t i = first; i < std::min(kTriangles, first + kBatch); ++i) {
            const glm::vec3& center = centers[i];
            const float pixel = 2 * slope * center.z / kLines, extent = random.between(10, 50);
            // An equilateral triangle's area is 1.299 and its side 1.732 of its radius.
            const float radius = (size == SoupSize::kArea ? std::sqrt(extent / 1.299f) : extent / 1.7320508f) * pixel;
            const float turn = random.between(0, 6.28f);
            const uint32_t vertex = static_cast<uint32_t>(batch.positions.size());
            for (int k = 0; k < 3; ++k) {
                const float angle = turn + static_cast<float>(k) * 2.0944f;
                batch.positions.emplace_back(center.x + radius * std::cos(angle), center.y + radius * std::sin(angle),
                                             center.z + random.between(-0.5f, 0.5f) * radius);
            }
            for (uint32_t corner : {0u, 2u, 1u}) batch.indices.push_back(vertex + corner);
        }
        addBatch(scene, std::move(batch));
    }
    for (int i = 0; i < 50000; ++i) {
        const float z = 10 + 240 * random.unit(), half = random.between(1, 6) * (2 * slope * z / kLines);
        const float x = random.between(-1, 1) * slope * 16 / 9 * z;
        scene.boxes.push_back(boxAround({x, random.between(-1, 1) * slope * z, z}, glm::vec3(half)));
    }
    scene.cameras = {{glm::vec3(0.0f), {0, 0, 1}}, {glm::vec3(0.0f), {0.05f, 0.03f, 1}}};
    return scene;
}

OcclusionScene makeOcclusionWall(WallBond bond, double gap) {
    constexpr float kFov = 60 * kPi / 180, kDistance = 20;
    constexpr int kColumns = 24, kRows = 32;  // on each side of the middle
    constexpr float kWide = 2, kTall = 1;
    static constexpr const char* kNames[] = {"grid", "brick", "tilted"};
    OcclusionScene scene{
        fmt::format("wall-{}-{}", kNames[static_cast<int>(bond)], gap), kFov, {}, {}, {}, BatchesAre::kPanels};
    const float slope = std::tan(kFov / 2);
    // Turned by a vector of short binary numbers, so that a corner which meets an edge lies on it exactly.
    const glm::vec2 along(1.0f, bond == WallBond::kTilted ? 0.1875f : 0.0f);
    const float half_gap = static_cast<float>(gap) * slope * kDistance / 720 / glm::length(along);
    for (int row = -kRows; row < kRows; ++row)
        for (int column = -kColumns; column < kColumns; ++column) {
            const float shift = bond != WallBond::kGrid && (row & 1) ? 0.5f : 0.0f;
            const float x0 = (static_cast<float>(column) + shift) * kWide + half_gap;
            const float x1 = (static_cast<float>(column + 1) + shift) * kWide - half_gap;
            const float y0 = static_cast<float>(row) * kTall + half_gap;
            const float y1 = static_cast<float>(row + 1) * kTall - half_gap;
            OccluderBatch panel;
            for (const glm::vec2& p : {glm::vec2(x0, y0), glm::vec2(x0, y1), glm::vec2(x1, y1), glm::vec2(x1, y0)})
                panel.positions.emplace_back(along.x * p.x - along.y * p.y, along.y * p.x + along.x * p.y, kDistance);
            panel.indices = {0, 1, 2, 0, 2, 3};
            addBatch(scene, std::move(panel));
        }
    Stream random(2024);
    for (int i = 0; i < 21000; ++i) {
        const float z = i < 20000 ? random.between(24, 160) : random.between(4, 18), half = random.between(0.1f, 1.2f);
        const float x = random.between(-1.2f, 1.2f) * slope * 16 / 9 * z;
        scene.boxes.push_back(boxAround({x, random.between(-1.2f, 1.2f) * slope * z, z}, glm::vec3(half)));
    }
    scene.cameras = {{{0, 0, 0}, {0, 0, 1}},
                     {{0.37f, 0.21f, 0}, {0.2f, 0.1f, 1}},
                     {{-6.1f, -1.3f, 1.7f}, {0.6f, 0.05f, 1}},
                     {{3.3f, 2.9f, -7.3f}, {-0.1f, -0.15f, 1}}};
    return scene;
}

std::vector<std::string> occlusionSceneNames() {
    return {"city",           "terrain",         "indoor",           "soup-area",
            "soup-side",      "wall-grid-0",     "wall-brick-0",     "wall-tilted-0",
            "wall-grid-0.01", "wall-brick-0.01", "wall-tilted-0.01", "wall-grid-0.1",
            "wall-brick-0.1", "wall-tilted-0.1"};
}

OcclusionScene makeOcclusionScene(std::string_view name) {
    if (name == "city") return makeOcclusionCity();
    if (name == "terrain") return makeOcclusionTerrain();
    if (name == "indoor") return makeOcclusionIndoor();
    for (SoupSize size : {SoupSize::kArea, SoupSize::kSide})
        if (name == (size == SoupSize::kArea ? "soup-area" : "soup-side")) return makeOcclusionSoup(size);
    for (double gap : {0.0, 0.01, 0.1}) {
        if (name == fmt::format("wall-grid-{}", gap)) return makeOcclusionWall(WallBond::kGrid, gap);
        if (name == fmt::format("wall-brick-{}", gap)) return makeOcclusionWall(WallBond::kBrick, gap);
        if (name == fmt::format("wall-tilted-{}", gap)) return makeOcclusionWall(WallBond::kTilted, gap);
    }
    return {};
}

View occlusionView(const OcclusionScene& scene, size_t camera, uint32_t width, uint32_t height) {
    constexpr double kNear = 0.1;
    const OcclusionCamera& from = scene.cameras[camera];
    const glm::dvec3 eye(from.eye);
    View view;
    view.view = lookAt(eye, eye + glm::dvec3(from.direction), {0, 1, 0});
    view.projection = perspective(scene.fov_y, static_cast<double>(width) / height, kNear);
    view.width = width;
    view.height = height;
    view.jitter = 0;
    return view;
}

uint64_t hashOcclusionScene(const OcclusionScene& scene) {
    uint64_t hash = 0x2545f4914f6cdd1dull;
    hashIn(hash, scene.fov_y);
    for (const OcclusionCamera& camera : scene.cameras) {
        hashIn(hash, camera.eye);
        hashIn(hash, camera.direction);
    }
    for (const OccluderBatch& batch : scene.batches) {
        for (const glm::vec3& p : batch.positions) hashIn(hash, p);
        for (uint32_t index : batch.indices) hashIn(hash, index);
    }
    for (const Box3f& box : scene.boxes) {
        hashIn(hash, box.min);
        hashIn(hash, box.max);
    }
    return hash;
}

}  // namespace sightline::bench
