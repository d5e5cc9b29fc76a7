// Every kind of broken glTF is answered with one line that names the file, the place and the fault.
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>

#include <unistd.h>

#include "gltf_reading.h"

namespace sightline::test {
using namespace tools;
namespace {

void expectError(const Result<Scene>& result, const std::string& message, const std::string& file = "test.glb") {
    ASSERT_FALSE(result.ok()) << "no error, but expected: " << message;
    EXPECT_EQ(messageFault(result.error(), file), "") << result.error().message;
    EXPECT_EQ(result.error().message, file + ": " + message);
}

/// A triangle in the only node, spoilt.
void expectSpoilt(const std::function<void(GltfBuilder&)>& spoil, const std::string& message) {
    GltfBuilder b = GltfBuilder::triangle();
    spoil(b);
    expectError(parse(b.glb()), message);
}

void expectJsonSpoilt(const char* pointer, Json value, const std::string& message) {
    SCOPED_TRACE(std::string(pointer) + " = " + value.dump());
    expectSpoilt([&](GltfBuilder& b) { b.json[Json::json_pointer(pointer)] = std::move(value); }, message);
}

TEST(GltfBadInput, Containers) {
    expectError(parse(""), "is empty");
    expectError(parse("glTF"), "truncated: 4 of the 12 bytes of a GLB header");
    expectError(parse("not a model"), "not JSON: syntax error at byte 2");
    expectError(parse("[1, 2]"), "not glTF: the JSON is not an object");
    expectError(parse("{}"), "not glTF 2.0: asset is missing");
    expectError(parse(std::string(300, '[')), "JSON is nested deeper than 256 at byte 256");
    std::string glb = gltfSample("list.glb");
    glb[4] = 1;
    expectError(parse(glb), "is GLB version 1, not 2");
    glb = gltfSample("list.glb");
    const std::string size = std::to_string(glb.size());
    expectError(parse(glb.substr(0, 100)), "truncated: 100 of the " + size + " bytes that its header tells of");
    expectError(parse(R"({"asset": {"version")"), "truncated: the JSON ends at byte 20, before it is complete");
    expectError(parse(R"({"asset": "2.)"), "truncated: the JSON ends at byte 13, before it is complete");
    expectError(parse(R"({"asset": {"version": "2.0"}]})"), "not JSON: syntax error at byte 29");
    expectError(parse(R"({"asset": 1e999})"), "not JSON: a number is out of range");
    glb[15] = 0x7f;
    ASSERT_FALSE(parse(glb).ok());
    EXPECT_NE(parse(glb).error().message.find("GLB chunk at byte 20 is longer than the file"), std::string::npos);
}

TEST(GltfBadInput, TruncationAtEveryLength) {
    for (const char* name : {"indices_16.glb", "meshopt_triangles_32.glb", "skin_animated.glb", "data_base64.gltf"}) {
        const std::string whole = gltfSample(name);
        ASSERT_TRUE(parse(whole).ok());
        for (size_t length = 0; length < whole.size(); ++length) {
            const Result<Scene> result = parse(whole.substr(0, length));
            ASSERT_FALSE(result.ok()) << name << " cut to " << length << " bytes";
            ASSERT_EQ(messageFault(result.error(), "test.glb"), "") << result.error().message;
        }
    }
}

TEST(GltfBadInput, Versions) {
    expectJsonSpoilt("/asset/version", "1.0", "asset: version '1.0' is not 2.0");
    expectJsonSpoilt("/extensionsRequired", {"CESIUM_RTC"},
                     "extensionsRequired[0]: CESIUM_RTC is required but not supported");
}

TEST(GltfBadInput, LengthsOfTwoGigabytes) {
    expectJsonSpoilt("/bufferViews/0/byteLength", 2147483648u,
                     "bufferViews[0]: 2147483648 bytes at 0 reach beyond the 42 bytes of its buffer");
    expectJsonSpoilt("/accessors/0/count", 2147483648u,
                     "accessors[0]: 2147483648 elements of 12 bytes at 0 reach beyond the 36 bytes of bufferViews[0]");
    expectJsonSpoilt("/buffers", {{{"byteLength", 2147483648u}}},
                     "buffers[0]: byteLength 2147483648 is more than the 44 bytes of the GLB's BIN chunk");
    expectSpoilt(
        [](GltfBuilder& b) {
            b.json["accessors"][0].erase("bufferView");
            b.json["accessors"][0]["count"] = 2147483648u;
        },
        "accessors[0]: count 2147483648 without a bufferView is more than 1048576");
    expectJsonSpoilt("/bufferViews/0/byteOffset", 1e300,
                     "bufferViews[0]: byteOffset is not a whole number in range: 1e+300");
    expectJsonSpoilt("/accessors/0/byteOffset", 18446744073709551615u,
                     "accessors[0]: byteOffset is too large: 18446744073709551615");
    expectJsonSpoilt("/accessors/0/byteOffset", -1, "accessors[0]: byteOffset is not a whole number in range: -1");
}

TEST(GltfBadInput, Indices) {
    GltfBuilder b;
    const uint32_t positions = b.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
    b.node({{"mesh", b.mesh(positions, int(b.accessor<uint8_t>("SCALAR", {0, 17, 2})))}});
    expectError(parse(b.glb()), "accessors[1]: index 17 is out of range of 3 vertices");
    b.json["accessors"][1]["componentType"] = 5121;
    b.json["accessors"][1]["type"] = "VEC3";
    b.json["accessors"][1]["count"] = 1;
    expectError(parse(b.glb()), "accessors[1]: indices needs 1 components an element, not 3");
}

TEST(GltfBadInput, References) {
    expectJsonSpoilt("/nodes/0/mesh", 5, "nodes[0]: mesh 5 is out of range of 1");
    expectJsonSpoilt("/meshes/0/primitives/0/attributes/POSITION", 9,
                     "meshes[0].primitives[0]: POSITION 9 is out of range of 2");
    expectJsonSpoilt("/meshes/0/primitives/0/indices", 2, "meshes[0].primitives[0]: indices 2 is out of range of 2");
    expectJsonSpoilt("/meshes/0/primitives/0/material", 0, "meshes[0].primitives[0]: material 0 is out of range of 0");
    expectJsonSpoilt("/accessors/1/bufferView", 7, "accessors[1]: bufferView 7 is out of range of 2");
    expectJsonSpoilt("/bufferViews/1/buffer", 1, "bufferViews[1]: buffer 1 is out of range of 1");
    expectJsonSpoilt("/accessors/0/componentType", 5124, "accessors[0]: componentType 5124 is not known");
    expectJsonSpoilt("/accessors/0/type", "VEC5", "accessors[0]: type 'VEC5' is not known");
    expectJsonSpoilt("/nodes/0/mesh", "one", "nodes[0]: mesh is not a number");
    expectJsonSpoilt("/nodes/0", 3, "nodes[0]: is not an object");
    expectJsonSpoilt("/nodes", 3, "nodes is not an array");
}

TEST(GltfBadInput, PositionsThatAreNotFinite) {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        GltfBuilder b;
        b.node({{"mesh", b.mesh(b.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, bad, 0}))}});
        expectError(parse(b.glb()), "accessors[0]: position 2 is not finite");
    }
}

TEST(GltfBadInput, Transforms) {
    expectJsonSpoilt("/nodes/0/matrix", {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                     "nodes[0]: matrix is not affine: its last row holds 0.5 at column 0");
    expectJsonSpoilt("/nodes/0/matrix", {1, 2, 3}, "nodes[0]: matrix is not 16 numbers");
    expectJsonSpoilt("/nodes/0/scale", {1e308, 1, 1}, "nodes[0]: its bounds in the world are too large");
    expectSpoilt(
        [](GltfBuilder& b) {
            b.json["nodes"][0]["scale"] = {1e200, 1, 1};
            b.node({{"scale", {1e200, 1, 1}}, {"children", {0}}});
        },
        "nodes[0]: its world transform is not finite");
}

TEST(GltfBadInput, NodeGraphs) {
    expectSpoilt(
        [](GltfBuilder& b) {
            b.json["nodes"] = {{{"children", {1}}}, {{"children", {0}}}};
        },
        "nodes[0]: is its own ancestor");
    expectJsonSpoilt("/nodes/0/children", {0}, "nodes[0]: is its own ancestor");
    expectSpoilt(
        [](GltfBuilder& b) {
            b.node({{"children", {0}}});
            b.node({{"children", {0}}});
        },
        "nodes[0]: has two parents: nodes[1] and nodes[2]");
    expectJsonSpoilt("/scene", 3, "scene 3 is out of range of 0");
}

TEST(GltfBadInput, NothingToDraw) {
    const std::string nothing = "draws nothing: no triangle in the scene that it shows";
    expectError(parse(R"({"asset": {"version": "2.0"}})"), nothing);
    expectError(parse(R"({"asset": {"version": "2.0"}, "scenes": [{}], "scene": 0})"), nothing);
    expectJsonSpoilt("/meshes/0/primitives/0/mode", 1, nothing);
}

TEST(GltfBadInput, CompressedData) {
    std::string glb = gltfSample("meshopt_triangles_32.glb");
    const size_t json_length = *reinterpret_cast<const uint32_t*>(glb.data() + 12);
    glb[20 + json_length + 8] ^= 0x5a;
    expectError(parse(glb), "bufferViews[0]: meshopt data is damaged");
    GltfBuilder b = GltfBuilder::triangle();
    const Json packed = {{"buffer", 0}, {"byteLength", 36}, {"byteStride", 12}, {"count", 3}, {"mode", "ATTRIBUTES"}};
    const auto spoil = [&](const char* key, Json value, const std::string& message) {
        GltfBuilder spoilt = b;
        Json& json = spoilt.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"];
        json = packed;
        json[key] = std::move(value);
        expectError(parse(spoilt.glb()), "bufferViews[0]: " + message);
    };
    spoil("byteStride", 13, "meshopt byteStride 13 does not suit its mode and filter");
    spoil("count", 4000000000u, "36 meshopt bytes cannot hold 4000000000 elements");
    spoil("mode", "POINTS", "meshopt mode 'POINTS' is not known");
    spoil("filter", "BLUR", "meshopt filter 'BLUR' is not known");
    spoil("byteLength", 2147483648u, "2147483648 bytes at 0 reach beyond the 42 bytes of its buffer");
}

// The second extension has a filter for colours, which no triangle needs, and another version of the vertex codec.
TEST(GltfBadInput, CompressedDataOfTheSecondExtension) {
    std::string glb = gltfSample("meshopt_triangles_32.glb");
    const size_t json_length = *reinterpret_cast<const uint32_t*>(glb.data() + 12);
    ASSERT_EQ(uint8_t(glb[20 + json_length + 8]), 0xa0);
    glb[20 + json_length + 8] = char(0xa3);
    const Result<Scene> scene = parse(glb);
    ASSERT_FALSE(scene.ok());
    EXPECT_NE(scene.error().message.find("bufferViews[0]: is packed by version 3 of meshopt's vertex codec"),
              std::string::npos)
        << scene.error().message;
    GltfBuilder b = GltfBuilder::triangle();
    const uint32_t colors = b.view(std::string(64, '\0'));
    b.json["bufferViews"][colors]["extensions"]["KHR_meshopt_compression"] = {
        {"buffer", 0}, {"byteLength", 64},     {"byteStride", 4},
        {"count", 3},  {"mode", "ATTRIBUTES"}, {"filter", "COLOR"}};
    EXPECT_TRUE(parse(b.glb()).ok());
}

TEST(GltfBadInput, Instances) {
    GltfBuilder b;
    const uint32_t mesh = b.triangleMesh();
    const Json attributes = {{"TRANSLATION", b.accessor<float>("VEC3", {0, 0, 0, 5, 0, 0})},
                             {"SCALE", b.accessor<float>("VEC3", {1, 1, 1})}};
    b.node({{"mesh", mesh}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}});
    expectError(parse(b.glb()), "nodes[0]: GPU instance attributes of 1 and 2 elements");
}

// A small file may not ask for a large world: one accessor named by a million instances of long names.
TEST(GltfBadInput, WorldsOutOfProportion) {
    GltfBuilder b;
    const uint32_t mesh = b.triangleMesh();
    const uint32_t zeros = b.add("accessors", {{"componentType", 5126}, {"count", 1 << 20}, {"type", "VEC3"}});
    const Json instancing = {{"attributes", {{"TRANSLATION", zeros}}}};
    for (int i = 0; i < 50; ++i)
        b.node({{"mesh", mesh},
                {"name", std::string(1000, 'n')},
                {"extensions", {{"EXT_mesh_gpu_instancing", instancing}}}});
    const Result<Scene> result = parse(b.glb());
    ASSERT_FALSE(result.ok());
    EXPECT_NE(result.error().message.find("times the memory"), std::string::npos) << result.error().message;
}

TEST(GltfBadInput, SkinsAndMorphs) {
    GltfBuilder b = GltfBuilder::triangle();
    b.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", b.accessor<float>("VEC3", {1, 1, 1})}}};
    expectError(parse(b.glb()), "meshes[0].primitives[0].targets[0]: moves 1 vertices of 3");

    GltfBuilder skinned;
    const Json attributes = {{"POSITION", skinned.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0})},
                             {"JOINTS_0", skinned.accessor<uint8_t>("VEC4", {0, 0, 0, 0, 9, 0, 0, 0, 0, 0, 0, 0})},
                             {"WEIGHTS_0", skinned.accessor<float>("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0})}};
    skinned.node({{"mesh", skinned.mesh(0, -1, {{"attributes", attributes}})}, {"skin", 0}});
    skinned.add("skins", {{"joints", {0}}});
    expectError(parse(skinned.glb()), "accessors[1]: joint 9 is out of range of 1");
    skinned.json["skins"][0]["joints"] = Json::array();
    expectError(parse(skinned.glb()), "skins[0]: has no joints");
}

TEST(GltfBadInput, MorphWeightsBeyondFloat) {
    GltfBuilder b = GltfBuilder::triangle();
    const uint32_t target = b.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    b.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", target}}};
    b.json["meshes"][0]["weights"] = {1e300};
    expectError(parse(b.glb()), "meshes[0]: weights is too large for a float");
    b.json["meshes"][0]["weights"] = {0};
    b.json["nodes"][0]["weights"] = {-1e300};
    expectError(parse(b.glb()), "nodes[0]: weights is too large for a float");
}

// Files of a test, gone afterwards.
struct Folder {
    std::filesystem::path path;

    Folder() {
        path = std::filesystem::temp_directory_path() / ("sightline_gltf_" + std::to_string(::getpid()));
        std::filesystem::create_directories(path);
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    std::string file(const std::string& name, const std::string& bytes) const {
        std::ofstream(path / name, std::ios::binary) << bytes;
        return (path / name).string();
    }
};

TEST(GltfBadInput, Files) {
    const Folder folder;
    const std::string absent = (folder.path / "absent.glb").string();
    expectError(loadGltf(absent), "no such file", absent);
    expectError(loadGltf(folder.path.string()), "is a directory", folder.path.string());
    const std::string empty = folder.file("empty.glb", "");
    expectError(loadGltf(empty), "is empty", empty);
    expectError(loadGltf(""), "no such file", "");

    const std::string forbidden = folder.file("forbidden.glb", gltfSample("list.glb"));
    std::filesystem::permissions(forbidden, std::filesystem::perms::none);
    if (::access(forbidden.c_str(), R_OK) != 0)
        expectError(loadGltf(forbidden), "cannot be opened: Permission denied", forbidden);
}

TEST(GltfBadInput, BuffersBeside) {
    const Folder folder;
    GltfBuilder b = GltfBuilder::triangle();
    const std::string scene = folder.file("scene.gltf", b.gltf("data/some%20geometry.bin"));
    expectError(loadGltf(scene), "buffers[0]: 'data/some%20geometry.bin': no such file", scene);
    std::filesystem::create_directories(folder.path / "data");
    folder.file("data/some geometry.bin", b.bytes.substr(0, 40));
    expectError(loadGltf(scene), "buffers[0]: 'data/some%20geometry.bin' holds 40 of 42 bytes", scene);
    folder.file("data/some geometry.bin", b.bytes);
    const Result<Scene> whole = loadGltf(scene);
    ASSERT_TRUE(whole.ok()) << whole.error().message;
    expectCorners(cornersOf(*whole, 0), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});

    const std::string remote = folder.file("remote.gltf", b.gltf("https://example.org/a.bin"));
    expectError(loadGltf(remote), "buffers[0]: URI is not a file: 'https://example.org/a.bin'", remote);
    const std::string broken = folder.file("broken.gltf", b.gltf("data:;base64,A*B="));
    expectError(loadGltf(broken), "buffers[0]: data URI is not base64", broken);
    const std::string short_data = folder.file("short.gltf", b.gltf("data:;base64,AAAA"));
    expectError(loadGltf(short_data), "buffers[0]: data URI holds 3 of 42 bytes", short_data);
    expectError(parse(b.gltf("a.bin")), "buffers[0]: file 'a.bin' is not opened: the glTF came from memory");
}

}  // namespace
}  // namespace sightline::test
