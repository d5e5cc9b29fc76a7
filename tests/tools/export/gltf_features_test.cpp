// Whatever a glTF may draw otherwise than it stands hides nothing, and `export` leaves it where it is.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <unistd.h>

#include <gtest/gtest.h>

#include "gltf_builder.h"
#include "gltf_reading.h"
#include "sightline/query/query.h"
#include "sightline/tools/export/encased.h"
#include "sightline/tools/export/gltf_cut.h"
#include "sightline/tools/import/gltf/gltf_features.h"
#include "sightline/tools/load/load_world.h"
#include "tests/support/views.h"

namespace sightline::test {
namespace {

constexpr uint32_t kShell = 1, kWatch = 2;  // nodes, and numbers of objects less one

/// Puts something into a glTF.
using Change = std::function<void(Json&)>;

/// A node with a closed box below it, and a small triangle within that, 5 before the origin.
Json watchInBox(const Change& change, std::string& bytes) {
    GltfBuilder b;
    std::vector<float> corners;
    for (int i = 0; i < 8; ++i)
        for (const int axis : {1, 2, 4}) corners.push_back(i & axis ? 1.0f : -1.0f);
    const uint32_t box = b.accessor<float>("VEC3", corners);
    const uint32_t sides = b.accessor<uint16_t>("SCALAR", {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                                           2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5});
    const uint32_t watch = b.accessor<float>("VEC3", {-0.1f, -0.1f, 0, 0.1f, -0.1f, 0, 0, 0.1f, 0});
    b.json["materials"] = Json::array({{{"name", "stone"}}, {{"name", "glass"}, {"alphaMode", "BLEND"}}});
    b.node({{"children", {kShell}}});
    b.node({{"mesh", b.mesh(box, int(sides), {{"material", 0}})}, {"name", "shell"}, {"translation", {0, 0, -5}}});
    b.node({{"mesh", b.mesh(watch, -1, {{"material", 0}})}, {"name", "watch"}, {"translation", {0, 0, -5}}});
    b.node({{"mesh", 0}, {"scale", {2, 2, 2}}});
    b.json["scenes"] = {{{"nodes", {0, kWatch}}}};
    b.accessor<float>("SCALAR", {0, 1});
    change(b.json);
    bytes = b.glb();
    return b.json;
}

/// What becomes of the box and of the watch in it.
struct Outcome {
    bool hides = false;        ///< the query culls the watch
    bool is_left = false;      ///< `export --outside` leaves the watch where it is
    int shell = 0, watch = 0;  ///< SceneObject::changes
    bool operator==(const Outcome&) const = default;
};

void PrintTo(const Outcome& o, std::ostream* out) {
    *out << (o.hides ? "hides" : "does not hide") << (o.is_left ? ", is left" : ", goes") << ", shell " << o.shell
         << ", watch " << o.watch;
}

Outcome outcomeOf(const Change& change) {
    std::string bytes;
    watchInBox(change, bytes);
    const Scene scene = load(bytes);
    Outcome out;
    if (scene.objects.size() != 2) {
        ADD_FAILURE() << scene.objects.size() << " objects";
        return out;
    }
    LoadedWorld loaded = loadWorld(scene);
    Query query;
    const VisibleSet set = query.visible(loaded.world.commit(), viewAt({0, 0, 0}, {0, 0, -1}));
    out.hides =
        std::none_of(set.objects.begin(), set.objects.end(), [](const auto& object) { return object.key == kWatch; });
    out.is_left = encasedTriangles(scene).triangles[1].empty();
    out.shell = scene.objects[0].changes;
    out.watch = scene.objects[1].changes;
    return out;
}

Change carriedBy(const std::string& pointer, const std::string& name, Json value = Json::object()) {
    return [=](Json& json) { json[Json::json_pointer(pointer)]["extensions"][name] = value; };
}

Change animated(Json target) {
    return [=](Json& json) {
        const size_t times = json["accessors"].size() - 1;
        const Json sampler = {{"input", times}, {"output", times}};
        json["animations"] = Json::array({{{"samplers", Json::array({sampler})},
                                           {"channels", Json::array({{{"sampler", 0}, {"target", target}}})}}});
    };
}

Change pointedAt(const std::string& pointer) {
    return animated({{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}});
}

Change alphaMode(const char* mode) {
    return [=](Json& json) { json["materials"][0]["alphaMode"] = mode; };
}

constexpr Outcome kHides{true, false, 0, 0}, kClear{false, true, 0, 0};
constexpr int kAnimated = SceneObject::kAnimated, kUnknown = SceneObject::kUnknown, kLevels = SceneObject::kLevels;
constexpr Outcome kShellMoves{false, true, kAnimated, 0}, kWatchMoves{true, true, 0, kAnimated};
constexpr Outcome kAllMoves{false, true, kAnimated, kAnimated};

struct Row {
    std::string what;
    Change change;
    Outcome wanted;
};

std::vector<Row> rows() {
    std::vector<Row> out = {
        {"nothing", [](Json&) {}, kHides},
        {"BLEND", alphaMode("BLEND"), {false, true, 0, 0}},
        {"MASK", alphaMode("MASK"), kClear},
        {"a variant of glass",
         carriedBy("/meshes/0/primitives/0", "KHR_materials_variants",
                   {{"mappings", Json::array({{{"material", 1}, {"variants", {0}}}})}}),
         kClear},
        {"a variant of stone",
         carriedBy("/meshes/0/primitives/0", "KHR_materials_variants",
                   {{"mappings", Json::array({{{"material", 0}, {"variants", {0}}}})}}),
         kHides},
        {"a material that is glass from afar", carriedBy("/materials/0", "MSFT_lod", {{"ids", {1}}}), kClear},
        {"another shape from afar", carriedBy("/nodes/1", "MSFT_lod", {{"ids", {3}}}), {true, true, kLevels, 0}},
        {"translated", animated({{"node", 1}, {"path", "translation"}}), kShellMoves},
        {"turned", animated({{"node", 1}, {"path", "rotation"}}), kShellMoves},
        {"scaled", animated({{"node", 0}, {"path", "scale"}}), kShellMoves},
        {"what is within moves", animated({{"node", 2}, {"path", "translation"}}), kWatchMoves},
        {"weights that it has not", animated({{"node", 1}, {"path", "weights"}}), kHides},
        {"a pointer to its place", pointedAt("/nodes/1/translation"), kShellMoves},
        {"a pointer to its visibility", pointedAt("/nodes/0/extensions/KHR_node_visibility/visible"), kShellMoves},
        {"a pointer to its weights", pointedAt("/nodes/1/weights/0"), kHides},
        {"a pointer to an extension of it", pointedAt("/nodes/1/extensions/VENDOR_slide/amount"), kShellMoves},
        {"a pointer to a colour", pointedAt("/materials/0/pbrMetallicRoughness/baseColorFactor"), kHides},
        {"hidden, and shown by a pointer",
         [](Json& json) {
             pointedAt("/nodes/1/extensions/KHR_node_visibility/visible")(json);
             carriedBy("/nodes/1", "KHR_node_visibility", {{"visible", false}})(json);
         },
         kShellMoves},
        {"a graph that points at it",
         carriedBy("", "KHR_interactivity", {{"graphs", Json::array({{{"pointer", "/nodes/1/rotation"}}})}}),
         kShellMoves},
        {"a graph that may point at any node",
         carriedBy("", "KHR_interactivity", {{"pointer", "/nodes/{node}/rotation"}}), kAllMoves},
        {"a graph without nodes", carriedBy("", "KHR_interactivity", {{"pointer", "/materials/0/x"}}), kHides},
    };
    const auto scene = [](Json nodes) { return [=](Json& json) { json["scenes"][0]["nodes"] = nodes; }; };
    out.push_back({"a scene that names a child", scene({1, 2}), {false, true, kUnknown, 0}});
    out.push_back({"a scene that names a child and its parent", scene({0, 1, 2}), {false, true, kUnknown, 0}});
    for (const char* name : {"KHR_physics_rigid_bodies", "OMI_physics_body", "AGI_articulations"})
        out.push_back({name, carriedBy("/nodes/0", name), kShellMoves});
    for (const char* name : {"KHR_materials_transmission", "KHR_materials_diffuse_transmission",
                             "ADOBE_materials_thin_transparency", "KHR_materials_volume_scatter", "VENDOR_paint",
                             "KHR_materials_displacement", "KHR_techniques_webgl", "VRMC_materials_mtoon"})
        out.push_back({std::string(name) + " of a material", carriedBy("/materials/0", name), kClear});
    for (const char* name :
         {"KHR_materials_unlit", "KHR_materials_ior", "KHR_materials_volume", "KHR_materials_sheen",
          "KHR_materials_specular", "KHR_materials_clearcoat", "KHR_materials_anisotropy", "KHR_materials_iridescence",
          "KHR_materials_emissive_strength", "KHR_materials_dispersion", "EXT_materials_bump", "MOZ_lightmap"})
        out.push_back({std::string(name) + " of a material", carriedBy("/materials/0", name), kHides});
    for (const char* name : {"KHR_texture_transform", "KHR_lights_punctual", "EXT_lights_ies", "KHR_xmp_json_ld",
                             "KHR_node_selectability", "KHR_audio_emitter"})
        out.push_back({std::string(name) + " of a node", carriedBy("/nodes/1", name), kHides});
    out.push_back({"unknown, of the node", carriedBy("/nodes/1", "VENDOR_x"), {false, true, kUnknown, 0}});
    out.push_back({"unknown, of what is above", carriedBy("/nodes/0", "VENDOR_x"), {false, true, kUnknown, 0}});
    out.push_back({"unknown, of what is within", carriedBy("/nodes/2", "VENDOR_x"), {true, true, 0, kUnknown}});
    out.push_back({"unknown, of the mesh", carriedBy("/meshes/0", "VENDOR_x"), kClear});
    out.push_back({"unknown, of the primitive", carriedBy("/meshes/0/primitives/0", "VENDOR_x"), kClear});
    out.push_back({"unknown, of the file", carriedBy("", "VENDOR_x"), kHides});
    return out;
}

TEST(GltfFeatures, WhatMayBeDrawnOtherwiseHidesNothingAndStays) {
    for (const Row& row : rows()) {
        SCOPED_TRACE(row.what);
        EXPECT_EQ(outcomeOf(row.change), row.wanted);
    }
}

TEST(GltfFeatures, ExtensionsThatAreNotKnownAreTold) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("sightline-features-" + std::to_string(::getpid()) + ".glb");
    for (const Row& row : rows()) {
        SCOPED_TRACE(row.what);
        std::string bytes;
        const Json json = watchInBox(row.change, bytes);
        std::ofstream(file, std::ios::binary) << bytes;
        std::vector<std::string> notes;
        ASSERT_TRUE(loadGltf(file.string(), {}, [&](const std::string& note) { notes.push_back(note); }).ok());
        if (row.what.starts_with("a scene that names")) {
            ASSERT_EQ(notes.size(), 1u);
            EXPECT_NE(notes[0].find("nodes that have a parent (1, nodes[1] first)"), std::string::npos) << notes[0];
            continue;
        }
        const bool unknown =
            row.what.starts_with("unknown") ||
            (row.wanted == kClear && json["materials"][0].contains("extensions") &&
             gltf::featureOf(json["materials"][0]["extensions"].begin().key()).effect == gltf::Effect::kUnknown);
        ASSERT_EQ(notes.size(), unknown ? 1u : 0u);
        if (unknown) { EXPECT_NE(notes[0].find("not known"), std::string::npos) << notes[0]; }
    }
    std::filesystem::remove(file);
}

TEST(GltfFeatures, AnInterpolationThatIsNoTextIsLinear) {
    const Change odd = [](Json& json) {
        animated({{"node", 1}, {"path", "translation"}})(json);
        json["animations"][0]["samplers"][0]["interpolation"] = 9729;
    };
    EXPECT_EQ(outcomeOf(odd), kShellMoves);
    GltfBuilder b = GltfBuilder::triangle();
    const uint32_t far = b.accessor<float>("VEC3", {0, 0, 9, 0, 0, 9, 0, 0, 9});
    b.json["meshes"][0]["primitives"][0]["targets"] = Json::array({{{"POSITION", far}}});
    b.accessor<float>("SCALAR", {0, 3});
    animated({{"node", 0}, {"path", "weights"}})(b.json);
    b.json["animations"][0]["samplers"][0]["interpolation"] = 9729;
    EXPECT_NEAR(load(b.glb()).meshes[0].bounds.max.z, 27, 0.01);
}

// Weights of a mesh bound every pose, whichever pointer drives them; and a file that is written again keeps the pointer.
TEST(GltfFeatures, PointersToTheWeightsOfAMeshAreFollowed) {
    GltfBuilder b = GltfBuilder::triangle();
    const uint32_t far = b.accessor<float>("VEC3", {0, 0, 9, 0, 0, 9, 0, 0, 9});
    b.triangleMesh();
    b.json["meshes"][1]["primitives"][0]["targets"] = Json::array({{{"POSITION", far}}});
    b.node({{"mesh", 1}, {"name", "bent"}});
    b.accessor<float>("SCALAR", {0, 3});
    pointedAt("/meshes/1/weights/0")(b.json);
    const Scene scene = load(b.glb());
    ASSERT_EQ(scene.objects.size(), 2u);
    EXPECT_TRUE(scene.meshes[scene.objects[1].mesh].deforms);
    EXPECT_NEAR(scene.meshes[scene.objects[1].mesh].bounds.max.z, 27, 0.01);

    CutScene cut = cutScene(load(b.glb()), {});
    leaveOut(cut, {{0}, {}});
    const std::string bytes = b.glb();
    const Result<WrittenGltf> out =
        cutGltf(std::span(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()), "test.glb", cut);
    ASSERT_TRUE(out.ok()) << out.error().message;
    const Scene again = load(out->bytes);
    ASSERT_EQ(again.objects.size(), 1u);
    EXPECT_NEAR(again.meshes[again.objects[0].mesh].bounds.max.z, 27, 0.01) << "its mesh is number 0 now";
}

}  // namespace
}  // namespace sightline::test
