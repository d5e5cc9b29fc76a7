// Simpler occluders inside of dense solids: what a query saves by them, and what it then keeps.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "bench/cases.h"
#include "bench/path_costs.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/load/seeded_cameras.h"

namespace sightline::bench {
using namespace tools;
namespace {

constexpr uint32_t kSide = 40;       // statues along each side of the field
constexpr uint32_t kDivisions = 70;  // of each face of the octahedron: 39,200 triangles
constexpr int kFrames = 8;
constexpr double kErrors[] = {0.5, 1.0, 2.0, 4.0};  // [pixels of the buffer]

/// A closed surface: an octahedron, each face divided, blown up to a bumpy sphere of radius 1, about.
Mesh statue() {
    Mesh mesh;
    mesh.name = "statue";
    std::map<std::array<int, 3>, uint32_t> known;
    constexpr int n = static_cast<int>(kDivisions);
    const auto vertex = [&](int x, int y, int z) {
        const auto [at, fresh] = known.try_emplace({x, y, z}, static_cast<uint32_t>(mesh.positions.size()));
        if (fresh) {
            const glm::dvec3 d = glm::normalize(glm::dvec3(x, y, z));
            const double bumps = std::sin(9.0 * d.x) * std::sin(7.0 * d.y + 1.0) * std::sin(8.0 * d.z + 2.0);
            mesh.positions.push_back(glm::vec3(d * (1.0 + 0.08 * bumps)));
            mesh.bounds.grow(glm::dvec3(mesh.positions.back()));
        }
        return at->second;
    };
    for (int face = 0; face < 8; ++face) {
        const int sx = face & 1 ? -1 : 1, sy = face & 2 ? -1 : 1, sz = face & 4 ? -1 : 1;
        const auto corner = [&](int i, int j) { return vertex(sx * (n - i - j), sy * i, sz * j); };
        const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
            if (sx * sy * sz < 0) std::swap(b, c);
            for (const uint32_t v : {a, b, c}) mesh.indices.push_back(v);
        };
        for (int i = 0; i < n; ++i)
            for (int j = 0; i + j < n; ++j) {
                add(corner(i, j), corner(i + 1, j), corner(i, j + 1));
                if (i + j + 1 < n) add(corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1));
            }
    }
    mesh.primitives.push_back({0, static_cast<uint32_t>(mesh.triangles()), 0});
    return mesh;
}

/// Statues in rows, an arm's length apart.
Scene field() {
    Scene scene;
    scene.name = "field of statues";
    scene.materials.resize(1);
    scene.meshes.push_back(statue());
    for (uint32_t i = 0; i < kSide * kSide; ++i) {
        SceneObject object;
        object.key = i;
        object.transform[3] = glm::dvec4(2.75 * (i % kSide), 0.0, 2.75 * (i / kSide), 1.0);
        scene.objects.push_back(object);
    }
    return scene;
}

}  // namespace

Table benchInner(const Options& options) {
    Table table{"inner", {}};
    const Scene scene = options.scene ? *options.scene : field();
    const int repeat = options.repeat ? options.repeat : 5;
    const double start = threadTime();
    LoadedWorld plain = loadWorld(scene, {}, loadSettings(false, 0));
    const double without = threadTime();
    LoadedWorld loaded = loadWorld(scene, {}, loadSettings(false, kErrors[0]));
    const double with = threadTime();
    table.rows.push_back({scene.name, "preparing, with simpler occluders", (with - without) * 1e-3, "ms",
                          "prepareOccluder() alone", (without - start) * 1e-3});
    const CameraPath path = seededCameras(scene, kFrames, 1);
    std::vector<QuerySettings> choices{{.occluder_error = 0.0}};
    for (const double error : kErrors) choices.push_back({.occluder_error = error});
    const std::vector<SettingsCost> costs = costsAlong(path, loaded.world.commit(), choices, repeat);
    for (size_t i = 1; i < costs.size(); ++i) {
        const auto row = [&](const char* what, double value, const char* unit, double base) {
            table.rows.push_back({scene.name, fmt::format("{}, error {} pixels", what, choices[i].occluder_error),
                                  value, unit, "the mesh's own polygons", base});
        };
        row("query", costs[i].time, "us", costs[0].time);
        row("triangles drawn", costs[i].occluder_triangles, "triangles", costs[0].occluder_triangles);
        row("kept", costs[i].kept, "objects", costs[0].kept);
    }
    return table;
}

}  // namespace sightline::bench
