// Frames of made worlds and their recordings, for their tests and for the seeds of their fuzzer.
// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include "sightline/base/bytes.h"
#include "sightline/query/record/frame_recorder.h"
#include "sightline/query/record/frame_replay.h"
#include "tests/support/made_world.h"

namespace sightline::test {

inline View someView(uint64_t seed) {
    Random random(seed);
    const glm::dvec3 eye = randomVector(random, {15, 3, 15});
    View view = viewAt(eye, randomVector(random, {5, 0, 5}), {.width = 320, .height = 180});
    if (seed % 3 == 1) view.projection = orthographic(12, 16.0 / 9.0, 0.1, 60);
    if (seed % 5 == 3) view.jitter = 2;
    return view;
}

inline QuerySettings someSettings(uint64_t seed) {
    QuerySettings settings;
    if (seed % 4 == 2) settings.occlusion_size = 96;
    return settings;
}

/// A sheet of so many quads a side, bent so that little of it is flat.
inline OccluderId addSheet(World& world, uint32_t side) {
    TestMesh mesh;
    for (uint32_t y = 0; y <= side; ++y)
        for (uint32_t x = 0; x <= side; ++x) {
            const float u = float(x) / float(side), v = float(y) / float(side);
            mesh.positions.push_back({u, v, 0.2f * u * v + 0.1f * u * u});
        }
    mesh.addGrid(side + 1, side + 1);
    const std::vector<uint8_t> both(mesh.indices.size() / 3, 1);
    return world.addOccluder(prepareOccluder(mesh.view(), {}, both));
}

/// A unit cube, for which a smaller one may stand in.
inline OccluderId addChest(World& world) {
    TestMesh within = boxMesh();
    for (glm::vec3& position : within.positions) position = glm::vec3(0.1f) + 0.8f * position;
    InnerOccluder inner;
    inner.occluder = prepareOccluder(within.view());
    inner.outside = {glm::vec3(0.0f), glm::vec3(1.0f)};
    inner.error = 0.1f;
    return world.addOccluder(prepareOccluder(boxMesh().view()), {&inner, 1});
}

/// @param boxes   of walls, floors and clutter
/// @param sheets  bent ones, of side * side quads; and as many chests, which have levels of detail or limits
inline MadeWorld someWorld(uint64_t seed, int boxes = 300, int sheets = 20, uint32_t side = 20) {
    MadeWorld made;
    made.shapes = seed % 2 == 0;
    made.fill(seed, boxes, {0, 0, 0});
    Random random(seed + 1);
    const auto add = [&](ObjectDef def, int i) {
        def.bounds = {glm::dvec3(0.0), glm::dvec3(1.0)};
        for (int axis = 0; axis < 3; ++axis) def.transform[axis][axis] = random.uniform(2, 9);
        def.transform[3] = glm::dvec4(random.uniform(-15, 10), random.uniform(-4, 0), random.uniform(-15, 15), 1);
        def.key = 1000 + static_cast<uint64_t>(i);
        made.world.add(def);
    };
    if (sheets == 0) return made;
    const OccluderId sheet = addSheet(made.world, side), chest = addChest(made.world);
    const LodLevel levels[] = {{0, 12, 8}, {0.05, 4, 4}};
    const LodsId lods = made.world.addLods(levels);
    for (int i = 0; i < sheets; ++i) {
        ObjectDef def;
        def.occluder = sheet;
        add(def, i);
    }
    for (int i = 0; i < sheets; ++i) {
        ObjectDef def;
        def.occluder = chest;
        def.layers = static_cast<uint32_t>(i % 3 + 1);
        if (i % 2) def.lods = lods;
        def.hides_in_lods = i % 4 == 1;
        if (i % 5 == 0) def.limits = {.always = i % 10 == 0, .max_distance = 12, .factor = 2};
        add(def, sheets + i);
    }
    return made;
}

inline FrameRecording recordOf(uint64_t seed) {
    MadeWorld made = someWorld(seed);
    QuerySettings settings = someSettings(seed);
    if (seed % 2) settings.max_distance = 25;
    return std::move(*recordFrame(made.world.commit(), someView(seed), settings));
}

/// Makes the hash of a file right again, so that what lies deeper is looked at.
inline void sealRecording(Array<char>& bytes) {
    if (bytes.size() < recording_file::kHashedAt) return;
    const uint64_t hash = contentHash(std::span<const char>(bytes).subspan(recording_file::kHashedAt));
    for (size_t i = 0; i < 8; ++i) bytes[recording_file::kHashAt + i] = static_cast<char>(hash >> 8 * i);
}

}  // namespace sightline::test
