// What is written is read again as the same triangles, with all that the file said of them.
// SPDX-License-Identifier: MIT
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

#include "gltf_reading.h"
#include "mutated.h"
#include "sightline/tools/export/gltf_cut.h"
#include "sightline/tools/export/gltf_scene.h"
#include "sightline/tools/scene/procedural.h"
#include "tests/support/drawn_triangles.h"
#include "tests/support/files.h"
#include "tests/support/shared_scenes.h"

namespace sightline::test {
using namespace tools;
namespace {

Result<WrittenGltf> cutBytes(const std::string& bytes, const CutScene& cut) {
    return cutGltf(std::span(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()), "test.glb", cut);
}

/// As the file must be; the test fails if it is not written.
WrittenGltf written(Result<WrittenGltf> result) {
    EXPECT_TRUE(result.ok()) << result.error().message;
    return result ? std::move(*result) : WrittenGltf();
}

CutScene cutAlong(Scene scene, const std::string& how) { return cutScene(std::move(scene), *readSplit(how)); }

/// Every second triangle of what does not deform.
std::vector<std::vector<uint32_t>> everySecond(const Scene& scene) {
    std::vector<std::vector<uint32_t>> out;
    for (const SceneObject& object : scene.objects) {
        const Mesh& mesh = scene.meshes[object.mesh];
        std::vector<uint32_t>& of_object = out.emplace_back();
        for (uint32_t t = 0; !mesh.deforms && t < mesh.triangles(); t += 2) of_object.push_back(t);
    }
    return out;
}

// The plain writer.

/// Of what has no name its mesh's stands in glTF.
std::vector<std::string> pathsIn(const Scene& scene) {
    std::vector<std::string> paths;
    for (SceneObject object : scene.objects) {
        if (object.name.empty()) object.name = scene.meshes[object.mesh].name;
        paths.push_back(objectPath(scene, object));
    }
    return paths;
}

void expectRoundTrip(const Scene& scene) {
    SCOPED_TRACE(scene.name);
    const Scene again = load(written(sceneGltf(scene, "test.glb")).bytes);
    EXPECT_EQ(trianglesDrawn(again), trianglesDrawn(scene));
    EXPECT_EQ(pathsIn(again), pathsIn(scene));
    ASSERT_EQ(again.objects.size(), scene.objects.size());
    for (size_t i = 0; i < scene.objects.size(); ++i)
        EXPECT_EQ(again.objects[i].transform, scene.objects[i].transform) << "object " << i;
    ASSERT_EQ(again.cells.size(), scene.cells.size());
    for (size_t i = 0; i < scene.cells.size(); ++i) {
        EXPECT_EQ(again.cells[i].name, scene.cells[i].name);
        EXPECT_EQ(again.cells[i].planes.size(), scene.cells[i].planes.size());
        expectNear(again.cells[i].bounds.min, scene.cells[i].bounds.min, 1e-5, "a cell's corner");
        expectNear(again.cells[i].bounds.max, scene.cells[i].bounds.max, 1e-5, "a cell's corner");
    }
    ASSERT_EQ(again.portals.size(), scene.portals.size());
    for (size_t i = 0; i < scene.portals.size(); ++i) {
        const ScenePortal &a = again.portals[i], &b = scene.portals[i];
        EXPECT_EQ(a.name, b.name);
        EXPECT_EQ(std::set<uint32_t>(a.cells, a.cells + 2), std::set<uint32_t>(b.cells, b.cells + 2)) << b.name;
        EXPECT_EQ(a.door, b.door) << b.name;
        EXPECT_EQ(a.polygon.size(), b.polygon.size()) << b.name;
        EXPECT_EQ(a.slide, b.slide) << b.name;
    }
    ASSERT_EQ(again.cameras.size(), scene.cameras.size());
    for (size_t i = 0; i < scene.cameras.size(); ++i) {
        const SceneCamera &a = again.cameras[i], &b = scene.cameras[i];
        EXPECT_EQ(a.transform, b.transform);
        EXPECT_EQ(a.fov_y, b.fov_y);
        EXPECT_EQ(a.orthographic_height, b.orthographic_height);
        EXPECT_EQ(a.z_near, b.z_near);
        if (b.z_far) { EXPECT_EQ(a.z_far, b.z_far); }
    }
}

TEST(SceneGltf, IsReadAsItWas) {
    for (const char* name : {"city:1:200", "building:1:2", "terrain:1:32", "made:cycle"}) {
        const Result<Scene> scene = makeProcedural(name);
        ASSERT_TRUE(scene.ok()) << name;
        expectRoundTrip(*scene);
    }
    for (const Sample& sample : gltfSamples()) {
        SCOPED_TRACE(sample.name);
        const Scene scene = load(sample.bytes);
        const WrittenGltf file = written(sceneGltf(scene, "test.glb"));
        if (scene.objects.empty()) continue;
        EXPECT_EQ(trianglesDrawn(load(file.bytes)), trianglesDrawn(scene));
    }
}

TEST(SceneGltf, KeepsMaterialsAndCameras) {
    Scene scene = load(GltfBuilder::triangle().glb());
    scene.materials[0].name = "tinted \"glass\"\n";
    scene.materials[0].base_color = {0.1f, 0.2f, 0.3f, 0.4f};
    scene.materials[0].alpha_mode = AlphaMode::kMask;
    scene.materials[0].alpha_cutoff = 0.25f;
    scene.materials[0].double_sided = scene.materials[0].transmissive = true;
    SceneCamera lens{"lens", glm::dmat4(1.0), 0.7, 0, 0.25, std::nullopt};
    lens.transform[3] = {1, 2, 3, 1};
    scene.cameras = {lens, {"wide", glm::dmat4(1.0), 0.7, 0, 0.25, 80}, {"plan", glm::dmat4(1.0), 0, 12, 0, 50}};
    const Scene again = load(written(sceneGltf(scene, "test.glb")).bytes);
    ASSERT_EQ(again.materials.size(), 1u);
    const Material& m = again.materials[0];
    EXPECT_EQ(m.name, scene.materials[0].name);
    EXPECT_EQ(m.base_color, scene.materials[0].base_color);
    EXPECT_EQ(m.alpha_mode, AlphaMode::kMask);
    EXPECT_EQ(m.alpha_cutoff, 0.25f);
    EXPECT_TRUE(m.double_sided && m.transmissive);
    expectRoundTrip(scene);
    EXPECT_FALSE(again.cameras[0].z_far.has_value());
    EXPECT_EQ(again.cameras[1].name, "wide");
}

TEST(SceneGltf, NamesAreNoMarksAndBecomeUtf8) {
    Scene scene = load(GltfBuilder::triangle().glb());
    scene.objects[0].name = "cell.kitchen";
    const Scene marked = load(written(sceneGltf(scene, "test.glb")).bytes);
    EXPECT_EQ(marked.objects.size(), 1u);
    EXPECT_TRUE(marked.cells.empty());
    scene.objects[0].name = "caf\xe9";
    EXPECT_EQ(load(written(sceneGltf(scene, "test.glb")).bytes).objects[0].name, "caf\xef\xbf\xbd");
}

TEST(SceneGltf, TellsWhatItLeavesOut) {
    Scene scene = load(GltfBuilder::triangle().glb());
    scene.cells.resize(1);
    scene.meshes[0].deforms = true;
    EXPECT_EQ(written(sceneGltf(scene, "test.glb")).notes.size(), 2u);
}

// Cutting a file.

TEST(GltfCut, DrawsTheSameInEverySample) {
    for (const Sample& sample : gltfSamples())
        for (const char* how : {"parts", "materials", "grid:1", "grid:2", "grid:7"}) {
            SCOPED_TRACE(sample.name + ", " + how);
            const Scene scene = load(sample.bytes);
            if (scene.objects.empty()) continue;
            CutScene cut = cutAlong(scene, how);
            const Scene again = load(written(cutBytes(sample.bytes, cut)).bytes);
            EXPECT_EQ(trianglesDrawn(again), trianglesDrawn(scene));
            EXPECT_EQ(again.objects.size(), cut.scene.objects.size());
            EXPECT_EQ(again.cells.size(), scene.cells.size());
            EXPECT_EQ(again.portals.size(), scene.portals.size());
            EXPECT_EQ(again.cameras.size(), scene.cameras.size());
            leaveOut(cut, everySecond(cut.scene));
            if (cut.scene.objects.empty()) continue;
            EXPECT_EQ(trianglesDrawn(load(written(cutBytes(sample.bytes, cut)).bytes)), trianglesDrawn(cut.scene));
        }
}

/// Two quads apart, of one mesh below a named node, whose corners have a texture coordinate, a colour and a normal each.
GltfBuilder texturedQuads() {
    GltfBuilder b;
    std::vector<float> positions, coordinates;
    std::vector<uint8_t> colors;
    std::vector<int8_t> normals;
    for (int i = 0; i < 8; ++i) {
        const auto x = static_cast<float>(i % 4 % 2 + 5 * (i / 4)), y = static_cast<float>(i % 4 / 2);
        positions.insert(positions.end(), {x, y, 0});
        coordinates.insert(coordinates.end(), {x / 16, y / 16});
        for (int c = 0; c < 4; ++c) colors.push_back(static_cast<uint8_t>(16 * i + c));
        normals.insert(normals.end(), {0, 0, 127, 0});
    }
    const uint32_t position = b.accessor<float>("VEC3", positions);
    const uint32_t coordinate = b.accessor<float>("VEC2", coordinates),
                   color = b.accessor<uint8_t>("VEC4", colors, true);
    const uint32_t normal = b.add("accessors", {{"bufferView", b.view(GltfBuilder::raw(normals), 4)},
                                                {"componentType", 5120},
                                                {"normalized", true},
                                                {"count", 8},
                                                {"type", "VEC3"}});
    const uint32_t indices = b.accessor<uint16_t>("SCALAR", {0, 1, 2, 2, 1, 3, 4, 5, 6, 6, 5, 7});
    const Json attributes = {
        {"POSITION", position}, {"TEXCOORD_0", coordinate}, {"COLOR_0", color}, {"NORMAL", normal}};
    b.json["materials"] =
        Json::array({{{"name", "brick"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
    b.json["textures"] = Json::array({{{"source", 0}}});
    const uint32_t image = b.view(std::string("\x89PNG an image of no size"));
    b.json["images"] = Json::array({{{"bufferView", image}, {"mimeType", "image/png"}}});
    b.add("meshes",
          {{"name", "quads"},
           {"primitives", Json::array({{{"attributes", attributes}, {"indices", indices}, {"material", 0}}})}});
    b.node({{"name", "floor"}, {"mesh", 0}, {"translation", {0, 0, 3}}});
    return b;
}

struct GlbParts {
    Json json;
    std::string binary;

    explicit GlbParts(const std::string& bytes) {
        uint32_t length = 0;
        std::memcpy(&length, bytes.data() + 12, 4);
        json = Json::parse(bytes.substr(20, length));
        if (bytes.size() > 20 + length) binary = bytes.substr(28 + length);
    }

    /// The bytes of an element, without what pads it.
    std::string element(uint32_t accessor, uint32_t i) const {
        const Json& a = json["accessors"][accessor];
        const Json& view = json["bufferViews"][a["bufferView"].get<size_t>()];
        const std::map<std::string, size_t> counts = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}};
        const std::map<int, size_t> sizes = {{5120, 1}, {5121, 1}, {5123, 2}, {5125, 4}, {5126, 4}};
        const size_t size = counts.at(a["type"].get<std::string>()) * sizes.at(a["componentType"].get<int>());
        const size_t at =
            view["byteOffset"].get<size_t>() + a.value("byteOffset", size_t{0}) + i * view.value("byteStride", size);
        return binary.substr(at, size);
    }
};

TEST(GltfCut, KeepsAttributesAndTextures) {
    const std::string bytes = texturedQuads().glb();
    const GlbParts before(bytes);
    const GlbParts after(written(cutBytes(bytes, cutAlong(load(bytes), "parts"))).bytes);
    // What each corner has, by its position.
    std::map<std::string, std::vector<std::string>> wanted;
    const auto attributesAt = [](const GlbParts& file, const Json& attributes, uint32_t i) {
        std::vector<std::string> out;
        for (const char* name : {"TEXCOORD_0", "COLOR_0", "NORMAL"}) out.push_back(file.element(attributes[name], i));
        return out;
    };
    const Json& all = before.json["meshes"][0]["primitives"][0]["attributes"];
    for (uint32_t i = 0; i < 8; ++i) wanted[before.element(all["POSITION"], i)] = attributesAt(before, all, i);
    ASSERT_EQ(after.json["meshes"].size(), 2u);
    size_t corners = 0;
    for (const Json& mesh : after.json["meshes"]) {
        const Json& attributes = mesh["primitives"][0]["attributes"];
        const Json& positions = after.json["accessors"][attributes["POSITION"].get<size_t>()];
        EXPECT_EQ(positions["count"], 4);
        EXPECT_EQ(positions["max"][0].get<double>() - positions["min"][0].get<double>(), 1) << "bounds of its own";
        for (uint32_t i = 0; i < 4; ++i, ++corners)
            EXPECT_EQ(attributesAt(after, attributes, i), wanted.at(after.element(attributes["POSITION"], i)));
        EXPECT_EQ(mesh["primitives"][0]["material"], 0);
    }
    EXPECT_EQ(corners, 8u);
    EXPECT_EQ(after.json["materials"], before.json["materials"]);
    EXPECT_EQ(after.json["textures"], before.json["textures"]);
    const Json& view = after.json["bufferViews"][after.json["images"][0]["bufferView"].get<size_t>()];
    EXPECT_EQ(after.binary.substr(view["byteOffset"], view["byteLength"]), "\x89PNG an image of no size");
    EXPECT_EQ(after.json["nodes"][0]["name"], "floor");
    EXPECT_EQ(after.json["nodes"][0]["children"], Json::array({1, 2}));
    EXPECT_FALSE(after.json["nodes"][0].contains("mesh"));
    EXPECT_EQ(after.json["accessors"].size(), 2u * 5) << "nothing of what is gone is left";
}

TEST(GltfCut, LeavesWholeWhatIsWhole) {
    const std::string bytes = texturedQuads().glb();
    const GlbParts before(bytes), after(written(cutBytes(bytes, uncut(load(bytes)))).bytes);
    EXPECT_EQ(after.json["nodes"], before.json["nodes"]);
    EXPECT_EQ(after.json["meshes"].size(), 1u);
    EXPECT_EQ(after.json["accessors"].size(), before.json["accessors"].size());
}

TEST(GltfCut, ANodeThatLosesAllStaysForItsChildren) {
    GltfBuilder b = texturedQuads();
    b.json["nodes"][0]["children"] = Json::array({1});
    b.node({{"mesh", 0}, {"translation", {0, 9, 0}}});
    b.json["scenes"] = Json::array({{{"nodes", Json::array({0})}}});
    const std::string bytes = b.glb();
    CutScene cut = uncut(load(bytes));
    ASSERT_EQ(cut.scene.objects.size(), 2u);
    leaveOut(cut, {{0, 1, 2, 3}, {}});
    const Scene again = load(written(cutBytes(bytes, cut)).bytes);
    ASSERT_EQ(again.objects.size(), 1u);
    EXPECT_EQ(again.objects[0].key, 1u);
    EXPECT_EQ(objectPath(again, again.objects[0]), "floor/quads");
}

TEST(GltfCut, APieceIsNoMark) {
    GltfBuilder b = texturedQuads();
    b.json["materials"][0]["name"] = "cell.wall";
    b.json["materials"].push_back({{"name", "portal.door"}});
    Json second = b.json["meshes"][0]["primitives"][0];
    second["material"] = 1;
    b.json["meshes"][0]["primitives"].push_back(second);
    const std::string bytes = b.glb();
    const Scene again = load(written(cutBytes(bytes, cutAlong(load(bytes), "materials"))).bytes);
    EXPECT_EQ(again.objects.size(), 2u);
    EXPECT_TRUE(again.cells.empty() && again.portals.empty());
}

TEST(GltfCut, PutsImagesBesideTheFileIntoIt) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("sightline-export-" + std::to_string(::getpid()));
    GltfBuilder b = texturedQuads();
    b.json["images"] = Json::array({{{"uri", "a%20brick.jpg"}}, {{"uri", "missing.png"}}, {{"uri", "notes.txt"}}});
    writeBytes(folder / "quads.gltf", b.gltf("quads.bin"));
    writeBytes(folder / "quads.bin", b.bytes);
    writeBytes(folder / "a brick.jpg", "\xff\xd8\xff and more");
    writeBytes(folder / "notes.txt", "no image");
    const std::string file = (folder / "quads.gltf").string();
    const Result<Scene> scene = loadGltf(file);
    ASSERT_TRUE(scene.ok());
    const WrittenGltf out = written(cutGltf(file, cutAlong(*scene, "parts")));
    std::filesystem::remove_all(folder);
    const GlbParts after(out.bytes);
    EXPECT_EQ(after.json["images"][0]["mimeType"], "image/jpeg");
    EXPECT_FALSE(after.json["images"][0].contains("uri"));
    const Json& view = after.json["bufferViews"][after.json["images"][0]["bufferView"].get<size_t>()];
    EXPECT_EQ(after.binary.substr(view["byteOffset"], view["byteLength"]), "\xff\xd8\xff and more");
    EXPECT_EQ(after.json["images"][1]["uri"], "missing.png");
    EXPECT_EQ(out.notes.size(), 2u);
    EXPECT_EQ(trianglesDrawn(load(out.bytes)), trianglesDrawn(*scene));
}

TEST(GltfCut, DropsExtensionsThatMayReferToWhatIsGone) {
    GltfBuilder b = texturedQuads();
    b.json["extensionsUsed"] = {"VENDOR_outline", "KHR_materials_unlit"};
    b.json["materials"][0]["extensions"]["KHR_materials_unlit"] = Json::object();
    b.json["meshes"][0]["primitives"][0]["extensions"]["VENDOR_outline"] = {{"indices", 4}};
    const std::string bytes = b.glb();
    const WrittenGltf out = written(cutBytes(bytes, cutAlong(load(bytes), "parts")));
    EXPECT_EQ(out.notes, (std::vector<std::string>{"an extension that is not known is left out: VENDOR_outline"}));
    EXPECT_EQ(out.bytes.find("VENDOR"), std::string::npos);
    EXPECT_EQ(GlbParts(out.bytes).json["extensionsUsed"], Json::array({"KHR_materials_unlit"}));
}

TEST(GltfCut, KeepsPointsAndLines) {
    GltfBuilder b = texturedQuads();
    const uint32_t ends = b.accessor<float>("VEC3", {0, 0, 0, 1, 1, 1});
    b.json["meshes"][0]["primitives"].push_back({{"mode", 1}, {"attributes", {{"POSITION", ends}}}});
    const std::string bytes = b.glb();
    const GlbParts after(written(cutBytes(bytes, cutAlong(load(bytes), "parts"))).bytes);
    ASSERT_EQ(after.json["nodes"].size(), 4u);
    EXPECT_EQ(after.json["nodes"][3]["name"], "points and lines");
    EXPECT_EQ(after.json["meshes"][after.json["nodes"][3]["mesh"].get<size_t>()]["primitives"][0]["mode"], 1);
}

TEST(GltfCut, AnAnimationWithoutChannelsStaysOne) {
    GltfBuilder b = texturedQuads();
    b.json["animations"] = Json::array({{{"name", "idle"}}});
    const std::string bytes = b.glb();
    const WrittenGltf out = written(cutBytes(bytes, cutAlong(load(bytes), "parts")));
    EXPECT_EQ(GlbParts(out.bytes).json["animations"], b.json["animations"]);
}

TEST(GltfCut, RefusesAFileThatChanged) {
    const Scene scene = load(texturedQuads().glb());
    const CutScene cut = cutAlong(scene, "parts");
    for (const std::string& bytes : {GltfBuilder::triangle().glb(), GltfBuilder().glb()}) {
        const Result<WrittenGltf> result = cutBytes(bytes, cut);
        ASSERT_FALSE(result.ok());
        EXPECT_EQ(messageFault(result.error(), "test.glb"), "");
    }
}

// A reader's answer to spoiled bytes is the importer's test; what it takes, this must write.
TEST(GltfCut, WritesWhateverIsRead) {
    const std::vector<Sample> samples = gltfSamples();
    size_t cuts = 0;
    for (uint64_t seed = 1; seed <= 100000; ++seed) {
        Random random(seed);
        const Sample& sample = samples[random.below(samples.size())];
        const std::string bytes = mutated(sample.bytes, random);
        const Result<Scene> scene = parse(bytes);
        if (!scene || scene->objects.empty()) continue;
        const CutScene cut = cutAlong(*scene, "grid:2");
        const Result<WrittenGltf> out = cutBytes(bytes, cut);
        if (!out) {
            ASSERT_EQ(messageFault(out.error(), "test.glb"), "") << "seed " << seed << " on " << sample.name;
            continue;
        }
        ++cuts;
        const Result<Scene> again = parse(out->bytes);
        ASSERT_TRUE(again.ok()) << "seed " << seed << " on " << sample.name << ": " << again.error().message;
        ASSERT_EQ(trianglesDrawn(*again).size(), trianglesDrawn(*scene).size())
            << "seed " << seed << " on " << sample.name;
    }
    EXPECT_GT(cuts, 1000u);
}

class GltfCutScenes : public SceneTest {};

TEST_P(GltfCutScenes, DrawTheSame) {
    const std::string file = SIGHTLINE_SHARED_DIR "/scenes/" + std::string(GetParam()) + ".glb";
    const Scene again = load(written(cutGltf(file, cutAlong(*scene, "grid:4"))).bytes);
    EXPECT_GT(again.objects.size(), scene->objects.size());
    EXPECT_TRUE(trianglesDrawn(again) == trianglesDrawn(*scene));
}

TEST_P(GltfCutScenes, AreReadAsTheyWere) {
    const Scene again = load(written(sceneGltf(*scene, "test.glb")).bytes);
    EXPECT_TRUE(trianglesDrawn(again) == trianglesDrawn(*scene));
    EXPECT_TRUE(pathsIn(again) == pathsIn(*scene));
}

INSTANTIATE_TEST_SUITE_P(Scenes, GltfCutScenes, kSmallScenes, sceneLabel);

}  // namespace
}  // namespace sightline::test
