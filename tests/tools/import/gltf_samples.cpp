// Small valid files, one for each thing that the glTF reader understands: geometry and nodes.
// SPDX-License-Identifier: MIT
#include "gltf_samples.h"

namespace sightline::test {
namespace {

// A unit square in z = 0 as two triangles.
const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

template <class Index>
std::string indexed() {
    GltfBuilder b;
    const uint32_t positions = b.accessor("VEC3", kSquare);
    const uint32_t indices = b.accessor<Index>("SCALAR", {0, 1, 2, 0, 2, 3});
    b.node({{"mesh", b.mesh(positions, int(indices))}, {"name", "square"}});
    return b.glb();
}

// Six vertices in a zigzag, in one of the modes.
std::string zigzag(int mode, bool indices) {
    GltfBuilder b;
    const uint32_t positions = b.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0, 1, 2, 0});
    const int accessor = indices ? int(b.accessor<uint8_t>("SCALAR", {0, 1, 2, 3, 4, 5})) : -1;
    b.node({{"mesh", b.mesh(positions, accessor, {{"mode", mode}})}});
    return b.glb();
}

std::string pointsAndLines() {
    GltfBuilder b;
    const uint32_t positions = b.accessor("VEC3", kSquare);
    Json primitives = Json::array();
    for (const int mode : {0, 1, 4, 2, 3})
        primitives.push_back({{"attributes", {{"POSITION", positions}}}, {"mode", mode}});
    b.node({{"mesh", b.add("meshes", {{"primitives", primitives}})}});
    const uint32_t lines = b.mesh(positions, -1, {{"mode", 1}});
    b.node({{"mesh", lines}});
    return b.glb();
}

std::string sparse(bool with_base) {
    GltfBuilder b;
    const uint32_t positions = b.accessor("VEC3", with_base ? kSquare : std::vector<float>(12, 0.0f));
    Json& accessor = b.json["accessors"][positions];
    if (!with_base) accessor.erase("bufferView");
    const uint32_t places = b.view(GltfBuilder::raw(std::vector<uint16_t>{1, 2}));
    const uint32_t values = b.view(GltfBuilder::raw(std::vector<float>{2, 0, 0, 2, 3, 4}));
    b.json["accessors"][positions]["sparse"] = {{"count", 2},
                                                {"indices", {{"bufferView", places}, {"componentType", 5123}}},
                                                {"values", {{"bufferView", values}}}};
    b.node({{"mesh", b.mesh(positions, int(b.accessor<uint8_t>("SCALAR", {0, 1, 2})))}});
    return b.glb();
}

template <class T>
std::string quantized(const std::vector<T>& values, bool normalized) {
    GltfBuilder b;
    b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    b.node({{"mesh", b.mesh(b.accessor("VEC3", values, normalized))}, {"scale", {2, 2, 2}}});
    return b.glb();
}

std::string interleaved() {
    GltfBuilder b;
    const std::vector<float> data = {0, 0, 0, 9, 9, 1, 0, 0, 9, 9, 0, 1, 0, 9, 9};
    const uint32_t view = b.view(GltfBuilder::raw(data), 20);
    const uint32_t positions =
        b.add("accessors",
              {{"bufferView", view}, {"byteOffset", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
    b.node({{"mesh", b.mesh(positions)}});
    return b.glb();
}

std::string materials() {
    GltfBuilder b;
    b.add("materials", {{"name", "plain"}, {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 0.125, 1}}}}});
    b.add("materials", {{"name", "leaf"}, {"alphaMode", "MASK"}, {"alphaCutoff", 0.25}, {"doubleSided", true}});
    b.add("materials", {{"name", "water"}, {"alphaMode", "BLEND"}});
    const auto extended = [](const char* name, Json value) { return Json{{"extensions", {{name, std::move(value)}}}}; };
    b.add("materials", extended("KHR_materials_transmission", {{"transmissionFactor", 1}}));
    b.add("materials", extended("KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 1}}));
    b.json["extensionsUsed"] = {"KHR_materials_transmission", "KHR_materials_diffuse_transmission"};
    const uint32_t positions = b.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
    Json primitives = Json::array();
    for (int material = -1; material < 5; ++material) {
        primitives.push_back({{"attributes", {{"POSITION", positions}}}});
        if (material >= 0) primitives.back()["material"] = material;
    }
    b.node({{"mesh", b.add("meshes", {{"name", "patches"}, {"primitives", primitives}})}});
    return b.glb();
}

std::string nodeTree() {
    GltfBuilder b;
    const uint32_t mesh = b.triangleMesh();
    b.json["nodes"] = {
        {{"children", {1, 3}}, {"translation", {10, 0, 0}}},
        {{"children", {2}}, {"rotation", {0, 0, 0.70710678118654752, 0.70710678118654752}}, {"scale", {2, 3, 4}}},
        {{"mesh", mesh}, {"name", "deep"}, {"translation", {1, 0, 0}}},
        {{"mesh", mesh}, {"name", "mirrored"}, {"matrix", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}}};
    b.add("scenes", {{"nodes", {0}}});
    b.json["scene"] = 0;
    return b.glb();
}

// Three nodes; which of them are drawn depends on the scenes.
std::string scenes(int marked, bool any) {
    GltfBuilder b;
    const uint32_t mesh = b.triangleMesh();
    for (int i = 0; i < 3; ++i) b.node({{"mesh", mesh}});
    if (any) {
        b.add("scenes", {{"nodes", {0}}});
        b.add("scenes", {{"nodes", {1}}});
    }
    if (marked >= 0) b.json["scene"] = marked;
    return b.glb();
}

std::string cameras() {
    GltfBuilder b = GltfBuilder::triangle();
    b.add("cameras", {{"name", "lens"},
                      {"type", "perspective"},
                      {"perspective", {{"yfov", 0.5}, {"znear", 0.25}, {"zfar", 50}, {"aspectRatio", 2}}}});
    b.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.5}}}});
    b.add("cameras",
          {{"type", "orthographic"}, {"orthographic", {{"xmag", 3}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}}}});
    b.node({{"camera", 0}, {"translation", {1, 2, 3}}});
    b.node({{"camera", 1}, {"name", "watch"}});
    b.node({{"camera", 2}});
    b.node({{"camera", 2}, {"name", "flattened"}, {"scale", {0, 0, 0}}});
    return b.glb();
}

std::string instances() {
    GltfBuilder b;
    b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    const uint32_t mesh = b.triangleMesh();
    const Json attributes = {
        {"TRANSLATION", b.accessor<float>("VEC3", {0, 0, 0, 5, 0, 0, 0, 7, 0})},
        {"ROTATION", b.accessor<int16_t>("VEC4", {0, 0, 0, 32767, 0, 0, 23170, 23170, 0, 0, 0, 32767}, true)},
        {"SCALE", b.accessor<float>("VEC3", {1, 1, 1, 2, 2, 2, -1, 1, 1})}};
    b.node({{"name", "plain"}, {"mesh", mesh}});
    b.node({{"name", "grove"},
            {"mesh", mesh},
            {"translation", {100, 0, 0}},
            {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}});
    return b.glb();
}

std::string dataUri(bool escaped) {
    GltfBuilder b = GltfBuilder::triangle();
    if (!escaped) return b.gltf();
    std::string data = "data:,";
    for (const char c : b.bytes) {
        const char* digits = "0123456789abcdef";
        data += {'%', digits[uint8_t(c) >> 4], digits[uint8_t(c) & 15]};
    }
    return b.gltf(data);
}

// Two rooms of 4 x 3 x 4 side by side, one by its mesh, one by a box; two portals between them, one with a door.
std::string cells() {
    GltfBuilder b;
    const uint32_t leaf = b.node({{"name", "leaf"}, {"mesh", b.triangleMesh()}});
    std::vector<float> corners;
    for (int i = 0; i < 8; ++i) corners.insert(corners.end(), {float(i & 1), float(i >> 1 & 1), float(i >> 2)});
    const uint32_t positions = b.accessor<float>("VEC3", corners);
    // One of its faces is wound the other way, as happens.
    const uint32_t indices = b.accessor<uint16_t>("SCALAR", {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                                             2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 5, 7, 1, 7, 3});
    const uint32_t cube = b.mesh(positions, int(indices));
    b.node({{"name", "cell.kitchen"}, {"mesh", cube}, {"scale", {4, 3, 4}}, {"translation", {10, 0, 0}}});
    const uint32_t quad = b.mesh(b.accessor<float>("VEC3", {0, 0, 0, 0, 2, 0, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0, 0, 1}));
    b.node(
        {{"name", "portal:door"},
         {"mesh", quad},
         {"translation", {14, 0, 1}},
         {"extras",
          {{"sightline", {{"portal", "way"}, {"cells", {"hall", "kitchen"}}, {"door", leaf}, {"slide", {0, 0, 1}}}}}}});
    b.node({{"name", "portal.window"}, {"mesh", quad}, {"translation", {14, 0.5, 3}}});
    b.node({{"translation", {14, 0, 0}},
            {"extras", {{"sightline", {{"cell", "hall"}, {"box", {{0, 0, 0}, {4, 3, 4}}}}}}}});
    return b.glb();
}

}  // namespace

void addGeometrySamples(std::vector<Sample>& out) {
    out.push_back({"indices_8.glb", indexed<uint8_t>()});
    out.push_back({"indices_16.glb", indexed<uint16_t>()});
    out.push_back({"indices_32.glb", indexed<uint32_t>()});
    out.push_back({"list.glb", zigzag(4, false)});
    out.push_back({"strip.glb", zigzag(5, false)});
    out.push_back({"strip_indexed.glb", zigzag(5, true)});
    out.push_back({"fan.glb", zigzag(6, false)});
    out.push_back({"points_and_lines.glb", pointsAndLines()});
    out.push_back({"sparse.glb", sparse(true)});
    out.push_back({"sparse_alone.glb", sparse(false)});
    out.push_back({"bytes.glb", quantized<int8_t>({0, 0, 0, 3, 0, 0, 0, -2, 0}, false)});
    out.push_back({"bytes_normalized.glb", quantized<int8_t>({0, 0, 0, 127, 0, 0, 0, -128, 0}, true)});
    out.push_back({"unsigned_bytes_normalized.glb", quantized<uint8_t>({0, 0, 0, 255, 0, 0, 0, 51, 0}, true)});
    out.push_back({"shorts.glb", quantized<int16_t>({0, 0, 0, 300, 0, 0, 0, -200, 0}, false)});
    out.push_back({"shorts_normalized.glb", quantized<int16_t>({0, 0, 0, 32767, 0, 0, 0, -32768, 0}, true)});
    out.push_back({"unsigned_shorts_normalized.glb", quantized<uint16_t>({0, 0, 0, 65535, 0, 0, 0, 13107, 0}, true)});
    out.push_back({"interleaved.glb", interleaved()});
    out.push_back({"materials.glb", materials()});
    out.push_back({"data_base64.gltf", dataUri(false)});
    out.push_back({"data_percent.gltf", dataUri(true)});
}

void addNodeSamples(std::vector<Sample>& out) {
    out.push_back({"node_tree.glb", nodeTree()});
    out.push_back({"scene_marked.glb", scenes(1, true)});
    out.push_back({"scenes_unmarked.glb", scenes(-1, true)});
    out.push_back({"scenes_none.glb", scenes(-1, false)});
    out.push_back({"cameras.glb", cameras()});
    out.push_back({"instances.glb", instances()});
    out.push_back({"cells.glb", cells()});
}

std::vector<Sample> gltfSamples() {
    std::vector<Sample> out;
    addGeometrySamples(out);
    addNodeSamples(out);
    addCompressedSamples(out);
    addDeformingSamples(out);
#ifdef SIGHTLINE_HAS_DRACO
    addDracoSamples(out);
#endif
    return out;
}

std::string gltfSample(const std::string& name) {
    for (Sample& sample : gltfSamples())
        if (sample.name == name) return std::move(sample.bytes);
    return {};
}

}  // namespace sightline::test
