// Small valid files, one for each thing that the glTF reader understands: geometry compressed by Draco.
// SPDX-License-Identifier: MIT
#include "gltf_draco_packer.h"
#include "gltf_samples.h"

namespace sightline::test {
namespace {

// A dented square of 2 x 2 quads with a hole at one corner.
PackedSource patch() {
    PackedSource source;
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x)
            source.positions.insert(source.positions.end(), {float(x), float(y), x * y * 0.25f});
    for (uint32_t y = 0; y < 2; ++y)
        for (uint32_t x = 0; x < 2; ++x) {
            const uint32_t a = 3 * y + x;
            source.indices.insert(source.indices.end(), {a, a + 1, a + 4});
            if (x + y < 2) source.indices.insert(source.indices.end(), {a, a + 4, a + 3});
        }
    return source;
}

std::string packedPatch(const PackedSettings& settings) {
    GltfBuilder b;
    b.node({{"mesh", addDracoMesh(b, patch(), settings)}});
    return b.glb();
}

std::string withNormals() {
    PackedSource source = patch();
    for (size_t i = 0; i < source.vertices(); ++i) source.normals.insert(source.normals.end(), {0, float(i % 2), 1});
    GltfBuilder b;
    b.node({{"mesh", addDracoMesh(b, source)}});
    return b.glb();
}

// Two joints share the patch, left and right.
std::string skinned() {
    PackedSource source = patch();
    for (size_t i = 0; i < source.vertices(); ++i) {
        const float right = source.positions[3 * i] / 2;
        source.joints.insert(source.joints.end(), {0, 1, 0, 0});
        source.weights.insert(source.weights.end(), {1 - right, right, 0, 0});
    }
    GltfBuilder b;
    const uint32_t mesh = addDracoMesh(b, source, {.edgebreaker = false});
    b.node({{"name", "left"}, {"children", {1}}});
    b.node({{"name", "right"}, {"translation", {0, 0, 5}}});
    b.add("skins", {{"joints", {0, 1}}});
    b.node({{"mesh", mesh}, {"skin", 0}});
    return b.glb();
}

}  // namespace

void addDracoSamples(std::vector<Sample>& out) {
    out.push_back({"draco_sequential.glb", packedPatch({.edgebreaker = false})});
    out.push_back(
        {"draco_sequential_quantized.glb", packedPatch({.edgebreaker = false, .quantization = 8, .speed = 0})});
    out.push_back({"draco_edgebreaker.glb", packedPatch({.edgebreaker = true})});
    out.push_back(
        {"draco_edgebreaker_quantized.glb", packedPatch({.edgebreaker = true, .quantization = 11, .speed = 0})});
    out.push_back({"draco_valence.glb", packedPatch({.quantization = 11, .speed = 1, .valence = true})});
    out.push_back({"draco_normals.glb", withNormals()});
    out.push_back({"draco_skin.glb", skinned()});
}

}  // namespace sightline::test
