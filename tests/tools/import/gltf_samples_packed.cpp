// Small valid files, one for each thing that the glTF reader understands: compressed and deforming geometry.
// SPDX-License-Identifier: MIT
#include <meshoptimizer.h>

#include "gltf_samples.h"

namespace sightline::test {
namespace {

/// Compressed views over a fallback buffer that has no data.
struct Packer {
    GltfBuilder b;
    size_t fallback = 0;

    Packer() { b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"EXT_meshopt_compression"}; }

    uint32_t view(const std::string& packed, size_t count, size_t stride, const char* mode, const char* filter) {
        const uint32_t view = b.view(packed);
        Json& json = b.json["bufferViews"][view];
        json["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                         {"byteOffset", json["byteOffset"]},
                                                         {"byteLength", packed.size()},
                                                         {"count", count},
                                                         {"byteStride", stride},
                                                         {"mode", mode},
                                                         {"filter", filter}};
        json["buffer"] = 1;
        json["byteOffset"] = fallback;
        json["byteLength"] = count * stride;
        if (std::string(mode) == "ATTRIBUTES") json["byteStride"] = stride;
        fallback += (count * stride + 3) / 4 * 4;
        return view;
    }

    uint32_t vertices(const void* data, size_t count, size_t stride, const char* filter) {
        std::string packed(meshopt_encodeVertexBufferBound(count, stride), '\0');
        packed.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(packed.data()), packed.size(), data,
                                                 count, stride));
        return view(packed, count, stride, "ATTRIBUTES", filter);
    }

    uint32_t accessor(uint32_t view, int component, size_t count, const char* type, bool normalized = false) {
        return b.add("accessors", {{"bufferView", view},
                                   {"componentType", component},
                                   {"count", count},
                                   {"type", type},
                                   {"normalized", normalized}});
    }

    std::string glb() {
        b.json["buffers"] = {
            {{"byteLength", b.bytes.size()}},
            {{"byteLength", fallback}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
        return b.glb();
    }
};

const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const std::vector<unsigned int> kSquareIndices = {0, 1, 2, 0, 2, 3};

std::string packed(const char* mode, size_t index_stride, const char* filter) {
    Packer p;
    std::vector<unsigned char> exponential(kSquare.size() * 4);
    meshopt_encodeFilterExp(exponential.data(), 4, 12, 15, kSquare.data());
    const bool filtered = std::string(filter) == "EXPONENTIAL";
    const void* data = filtered ? static_cast<const void*>(exponential.data()) : kSquare.data();
    const uint32_t positions = p.accessor(p.vertices(data, 4, 12, filter), 5126, 4, "VEC3");

    const bool triangles = std::string(mode) == "TRIANGLES";
    std::string indices(triangles ? meshopt_encodeIndexBufferBound(6, 4) : meshopt_encodeIndexSequenceBound(6, 4), 0);
    unsigned char* out = reinterpret_cast<unsigned char*>(indices.data());
    indices.resize(triangles ? meshopt_encodeIndexBuffer(out, indices.size(), kSquareIndices.data(), 6)
                             : meshopt_encodeIndexSequence(out, indices.size(), kSquareIndices.data(), 6));
    const uint32_t view = p.view(indices, 6, index_stride, mode, "NONE");
    const uint32_t accessor = p.accessor(view, index_stride == 2 ? 5123 : 5125, 6, "SCALAR");
    p.b.node({{"mesh", p.b.mesh(positions, int(accessor))}});
    return p.glb();
}

// Instances whose rotations are packed as quaternions, and whose places are unit vectors in octahedral form.
std::string packedInstances() {
    Packer p;
    p.b.json["extensionsUsed"].push_back("EXT_mesh_gpu_instancing");
    const std::vector<float> rotations = {0, 0, 0, 1, 0, 0, 0.70710678f, 0.70710678f};
    const std::vector<float> directions = {0, 0, 1, 0, 0.6f, -0.8f, 0, 0};
    std::vector<int16_t> quaternions(8), small(8);
    std::vector<int8_t> octahedral(8);
    meshopt_encodeFilterQuat(quaternions.data(), 2, 8, 16, rotations.data());
    meshopt_encodeFilterOct(octahedral.data(), 2, 4, 8, directions.data());
    const uint32_t translation = p.accessor(p.vertices(octahedral.data(), 2, 4, "OCTAHEDRAL"), 5120, 2, "VEC3", true);
    const uint32_t rotation = p.accessor(p.vertices(quaternions.data(), 2, 8, "QUATERNION"), 5122, 2, "VEC4", true);
    const uint32_t mesh = p.b.mesh(p.accessor(p.vertices(kSquare.data(), 4, 12, "NONE"), 5126, 4, "VEC3"));
    const Json attributes = {{"TRANSLATION", translation}, {"ROTATION", rotation}};
    p.b.node({{"mesh", mesh}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}});
    return p.glb();
}

// Two joints, the second 2 along x from the first; vertex 1 is 3 beyond the second.
struct Arm {
    GltfBuilder b;
    uint32_t mesh, skin;

    Arm() {
        const uint32_t positions = b.accessor<float>("VEC3", {0, 0, 0, 5, 0, 0, 2, 1, 0});
        const uint32_t joints = b.accessor<uint8_t>("VEC4", {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0});
        const uint32_t weights = b.accessor<uint8_t>("VEC4", {255, 0, 0, 0, 255, 0, 0, 0, 127, 128, 0, 0}, true);
        mesh = b.mesh(positions, -1,
                      {{"attributes", {{"POSITION", positions}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}}});
        const uint32_t binds = b.accessor<float>("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,  //
                                                          1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -2, 0, 0, 1});
        b.node({{"name", "root joint"}, {"translation", {0, 10, 0}}, {"children", {1}}});
        b.node({{"name", "elbow"}, {"translation", {2, 0, 0}}});
        skin = b.add("skins", {{"joints", {0, 1}}, {"inverseBindMatrices", binds}});
        b.node({{"name", "body"}, {"mesh", mesh}, {"skin", skin}, {"translation", {900, 900, 900}}});
    }

    uint32_t animate(uint32_t node, const char* path, uint32_t output, const char* interpolation = "LINEAR") {
        const uint32_t times = b.accessor<float>("SCALAR", {0, 1});
        const Json target = {{"node", node}, {"path", path}};
        return b.add("animations",
                     {{"samplers", {{{"input", times}, {"output", output}, {"interpolation", interpolation}}}},
                      {"channels", {{{"sampler", 0}, {"target", target}}}}});
    }
};

std::string skinAlone() { return Arm().b.glb(); }

std::string skinAnimated() {
    Arm arm;
    arm.animate(1, "translation", arm.b.accessor<float>("VEC3", {2, 0, 0, 0, 4, 0}));
    arm.animate(1, "scale", arm.b.accessor<float>("VEC3", {1, 1, 1, 2, 1, 1}));
    arm.animate(0, "rotation", arm.b.accessor<float>("VEC4", {0, 0, 0, 1, 0, 0, 1, 0}));
    return arm.b.glb();
}

std::string skinAndPlain() {
    Arm arm;
    arm.b.node({{"name", "statue"}, {"mesh", arm.mesh}, {"translation", {50, 0, 0}}});
    return arm.b.glb();
}

// One target lifts the triangle by 2, one shrinks it along x by 4.
struct Face {
    GltfBuilder b;

    Face() {
        const uint32_t positions = b.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
        const uint32_t lift = b.accessor<float>("VEC3", {0, 0, 2, 0, 0, 2, 0, 0, 2});
        const uint32_t shrink = b.accessor<float>("VEC3", {0, 0, 0, -4, 0, 0, 0, 0, 0});
        const uint32_t mesh = b.mesh(positions, -1, {{"targets", {{{"POSITION", lift}}, {{"POSITION", shrink}}}}});
        b.json["meshes"][mesh]["weights"] = {0.5, 0};
        b.node({{"mesh", mesh}, {"translation", {10, 0, 0}}});
    }

    void animate(const char* interpolation, const std::vector<float>& values) {
        const uint32_t times = b.accessor<float>("SCALAR", {0, 1});
        const uint32_t output = b.accessor("SCALAR", values);
        b.add("animations", {{"samplers", {{{"input", times}, {"output", output}, {"interpolation", interpolation}}}},
                             {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}});
    }
};

std::string morphAlone() { return Face().b.glb(); }

std::string morphAnimated() {
    Face face;
    face.animate("LINEAR", {0, 0, 3, -1});
    return face.b.glb();
}

// Tangents of 27 for one second lift the curve by up to 4 / 27 of each.
std::string morphSpline() {
    Face face;
    face.animate("CUBICSPLINE", {0, 0, 0, 0, 27, 0, -27, 0, 1, 0, 0, 0});
    return face.b.glb();
}

}  // namespace

void addCompressedSamples(std::vector<Sample>& out) {
    out.push_back({"meshopt_triangles_16.glb", packed("TRIANGLES", 2, "NONE")});
    out.push_back({"meshopt_triangles_32.glb", packed("TRIANGLES", 4, "EXPONENTIAL")});
    out.push_back({"meshopt_indices_16.glb", packed("INDICES", 2, "EXPONENTIAL")});
    out.push_back({"meshopt_indices_32.glb", packed("INDICES", 4, "NONE")});
    out.push_back({"meshopt_instances.glb", packedInstances()});
}

void addDeformingSamples(std::vector<Sample>& out) {
    out.push_back({"skin.glb", skinAlone()});
    out.push_back({"skin_animated.glb", skinAnimated()});
    out.push_back({"skin_and_plain.glb", skinAndPlain()});
    out.push_back({"morph.glb", morphAlone()});
    out.push_back({"morph_animated.glb", morphAnimated()});
    out.push_back({"morph_spline.glb", morphSpline()});
}

}  // namespace sightline::test
