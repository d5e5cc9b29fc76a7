// Recordings of frames of made worlds, for their tests and for the seeds of their fuzzer.
// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include "sightline/base/bytes.h"
#include "sightline/query/record/occlusion_recording.h"
#include "sightline/query/record/occlusion_replay.h"
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

/// @param boxes   of walls, floors and clutter
/// @param sheets  bent ones, of side * side quads
inline MadeWorld someWorld(uint64_t seed, int boxes = 300, int sheets = 20, uint32_t side = 20) {
    MadeWorld made(seed, boxes);
    const OccluderId sheet = addSheet(made.world, side);
    Random random(seed + 1);
    for (int i = 0; i < sheets; ++i) {
        ObjectDef def;
        def.bounds = {glm::dvec3(0.0), glm::dvec3(1.0)};
        for (int axis = 0; axis < 3; ++axis) def.transform[axis][axis] = random.uniform(2, 9);
        def.transform[3] = glm::dvec4(random.uniform(-15, 10), random.uniform(-4, 0), random.uniform(-15, 15), 1);
        def.key = 1000 + static_cast<uint64_t>(i);
        def.occluder = sheet;
        made.world.add(def);
    }
    return made;
}

inline OcclusionRecording recordOf(uint64_t seed) {
    MadeWorld made = someWorld(seed);
    return std::move(*recordOcclusion(made.world.commit(), someView(seed), someSettings(seed)));
}

/// With two tests of tiles beside those that the walk made, and the answers that they get.
inline OcclusionRecording withTiles(OcclusionRecording recording) {
    OcclusionReplay replay(recording);
    replay.run();
    replay.tiles().log = &recording.asked;
    for (uint32_t tile : {replay.tiles().stride + 1, 2 * replay.tiles().stride + 3}) {
        float nearest[64];
        for (int i = 0; i < 64; ++i) nearest[i] = 0.01f * static_cast<float>(i);
        openPixels(replay.tiles(), tile, 0x00ffff0012345678u, nearest);
        uint32_t& noted = recording.asked.tiles.back().tile;
        noted = noted / replay.tiles().stride * replay.tiles().columns + noted % replay.tiles().stride;
    }
    replay.tiles().log = nullptr;
    return recording;
}

inline OcclusionRecording recordWithTiles(uint64_t seed) { return withTiles(recordOf(seed)); }

/// Makes the hash of a file right again, so that what lies deeper is looked at.
inline void seal(Array<char>& bytes) {
    if (bytes.size() < recording_file::kHashedAt) return;
    const uint64_t hash = contentHash(std::span<const char>(bytes).subspan(recording_file::kHashedAt));
    for (size_t i = 0; i < 8; ++i) bytes[recording_file::kHashAt + i] = static_cast<char>(hash >> 8 * i);
}

}  // namespace sightline::test
