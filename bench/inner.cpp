// Simpler occluders inside of dense solids: what a query saves by them, and what it then keeps.
// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include "bench/cases.h"
#include "bench/path_costs.h"
#include "bench/statue.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/load/seeded_cameras.h"

namespace sightline::bench {
using namespace tools;
namespace {

constexpr uint32_t kSide = 40;       // statues along each side of the field
constexpr uint32_t kDivisions = 70;  // of each face of the statue's octahedron: 39,200 triangles
constexpr int kFrames = 8;
constexpr double kErrors[] = {0.5, 1.0, 2.0, 4.0};  // [pixels of the buffer]

/// Statues in rows, an arm's length apart.
Scene field() {
    Scene scene;
    scene.name = "field of statues";
    scene.materials.resize(1);
    scene.meshes.push_back(makeStatue(kDivisions));
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
