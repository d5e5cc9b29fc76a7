// Compresses meshes of tests with Draco's own encoder.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gltf_builder.h"

namespace sightline::test {

struct PackedSource {
    std::vector<float> positions;   ///< [size: 3 * vertices]
    std::vector<uint32_t> indices;  ///< [size: 3 * triangles]
    std::vector<float> normals;     ///< [size: 3 * vertices] or none
    std::vector<uint16_t> joints;   ///< [size: 4 * vertices] or none
    std::vector<float> weights;     ///< [size: 4 * vertices] or none

    size_t vertices() const { return positions.size() / 3; }
};

struct PackedSettings {
    bool edgebreaker = true;
    int quantization = 0;  ///< [bits] of positions; 0: none
    int speed = 5;         ///< [0..10]; 0 packs best
    bool valence = false;  ///< the edgebreaker that predicts by valences
};

struct PackedStream {
    std::string bytes;
    size_t vertices = 0, triangles = 0;
};

/// Ids of the attributes in a stream are POSITION 0, then NORMAL, JOINTS_0 and WEIGHTS_0 where they are given.
PackedStream packDraco(const PackedSource& source, const PackedSettings& settings = {});

/// A point cloud, as no primitive may hold.
std::string packDracoPoints(const PackedSource& source);

/// Adds a mesh whose only primitive is compressed.
uint32_t addDracoMesh(GltfBuilder& b, const PackedSource& source, const PackedSettings& settings = {});

/// Adds a primitive that takes its data from a stream.
uint32_t addDracoMesh(GltfBuilder& b, const PackedSource& source, const PackedStream& stream);

}  // namespace sightline::test
