// Each kind of geometry that a glTF may hold arrives as the triangles that it means.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "gltf_reading.h"

namespace sightline::test {
using namespace tools;
namespace {

const Corners kSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}};

TEST(GltfGeometry, ReadsIndicesOfEachWidth) {
    for (const char* name : {"indices_8.glb", "indices_16.glb", "indices_32.glb"}) {
        const Scene scene = loadSample(name);
        ASSERT_EQ(scene.objects.size(), 1u);
        EXPECT_EQ(scene.objects[0].name, "square");
        EXPECT_EQ(scene.meshes[0].positions.size(), 4u);
        expectCorners(cornersOf(scene, 0), kSquare);
        EXPECT_EQ(scene.meshes[0].bounds.min, glm::dvec3(0));
        EXPECT_EQ(scene.meshes[0].bounds.max, glm::dvec3(1, 1, 0));
        EXPECT_FALSE(scene.meshes[0].deforms);
    }
}

// The zigzag's vertices 0 to 5.
const Corners kZ = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}, {1, 2, 0}};

const Corners kStrip = {kZ[0], kZ[1], kZ[2], kZ[1], kZ[3], kZ[2], kZ[2], kZ[3], kZ[4], kZ[3], kZ[5], kZ[4]};
const Corners kFan = {kZ[1], kZ[2], kZ[0], kZ[2], kZ[3], kZ[0], kZ[3], kZ[4], kZ[0], kZ[4], kZ[5], kZ[0]};
const Corners kTriangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
const Corners kSparse = {{0, 0, 0}, {2, 0, 0}, {2, 3, 4}};

TEST(GltfGeometry, ReadsEachFormOfTriangles) {
    // The scale of 2 of the quantized samples' node is in the expected numbers.
    const std::pair<const char*, Corners> samples[] = {
        {"list.glb", kZ},
        {"strip.glb", kStrip},
        {"strip_indexed.glb", kStrip},
        {"fan.glb", kFan},
        {"sparse.glb", kSparse},
        {"sparse_alone.glb", kSparse},
        {"bytes.glb", {{0, 0, 0}, {6, 0, 0}, {0, -4, 0}}},
        {"shorts.glb", {{0, 0, 0}, {600, 0, 0}, {0, -400, 0}}},
        {"bytes_normalized.glb", {{0, 0, 0}, {2, 0, 0}, {0, -2, 0}}},
        {"shorts_normalized.glb", {{0, 0, 0}, {2, 0, 0}, {0, -2, 0}}},
        {"unsigned_bytes_normalized.glb", {{0, 0, 0}, {2, 0, 0}, {0, 0.4, 0}}},
        {"unsigned_shorts_normalized.glb", {{0, 0, 0}, {2, 0, 0}, {0, 0.4, 0}}},
        {"interleaved.glb", kTriangle},
        {"data_base64.gltf", kTriangle},
        {"data_percent.gltf", kTriangle},
        {"meshopt_indices_16.glb", kSquare},
        {"meshopt_indices_32.glb", kSquare}};
    for (const auto& [name, corners] : samples) {
        SCOPED_TRACE(name);
        expectCorners(cornersOf(loadSample(name), 0), corners);
    }
    for (size_t i = 0; i < kStrip.size(); i += 3)
        EXPECT_GT(glm::cross(kStrip[i + 1] - kStrip[i], kStrip[i + 2] - kStrip[i]).z, 0);
}

// A primitive that variants draw otherwise hides no more than the least hiding of them, and is seen from all their sides.
TEST(GltfGeometry, VariantsHideWhatAllOfThemHide) {
    const Json materials =
        Json::array({{{"doubleSided", true}},
                     {{"alphaMode", "BLEND"}, {"doubleSided", true}},
                     {{"alphaMode", "MASK"}, {"doubleSided", true}},
                     {{"name", "one-sided"}},
                     {{"doubleSided", true}, {"name", "too"}},
                     {{"doubleSided", true}, {"extensions", {{"KHR_materials_transmission", Json::object()}}}}});
    struct Case {
        uint32_t usual;
        std::vector<uint32_t> variants;
        bool hides, double_sided;
    };
    for (const Case& c :
         {Case{0, {}, true, true}, Case{0, {0}, true, true}, Case{0, {4}, true, true}, Case{0, {1}, false, true},
          Case{0, {4, 2}, false, true}, Case{0, {5}, false, true}, Case{0, {3}, false, true}, Case{3, {0}, false, true},
          Case{3, {}, true, false}, Case{3, {3, 3}, true, false}, Case{1, {0}, false, true}, Case{2, {3}, false, true},
          Case{4, {0, 1, 2, 3}, false, true}}) {
        GltfBuilder b;
        b.json["materials"] = materials;
        const uint32_t positions = b.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
        Json mappings = Json::array();
        for (const uint32_t material : c.variants) mappings.push_back({{"material", material}, {"variants", {0}}});
        Json more = {{"material", c.usual}};
        if (!c.variants.empty()) more["extensions"] = {{"KHR_materials_variants", {{"mappings", mappings}}}};
        for (int twice = 0; twice < 2; ++twice) b.node({{"mesh", b.mesh(positions, -1, more)}});
        const Scene scene = load(b.glb());
        const Material& material = scene.materials[scene.meshes[0].primitives[0].material];
        SCOPED_TRACE("material " + std::to_string(c.usual) + " and " + mappings.dump());
        EXPECT_EQ(material.hides(), c.hides);
        EXPECT_EQ(material.double_sided, c.double_sided);
        EXPECT_LE(scene.materials.size(), materials.size() + 1) << "the same variants make one material";
    }
}

TEST(GltfGeometry, LeavesOutPointsAndLines) {
    const Scene scene = loadSample("points_and_lines.glb");
    ASSERT_EQ(scene.objects.size(), 1u) << "the node of lines draws nothing";
    expectCorners(cornersOf(scene, 0), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
    EXPECT_EQ(scene.meshes[0].positions.size(), 3u) << "only what a triangle uses";
}

TEST(GltfGeometry, LeavesOutIncompleteTriangles) {
    GltfBuilder b;
    const uint32_t positions = b.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 9, 9, 9, 8, 8, 8});
    b.node({{"mesh", b.mesh(positions)}});
    b.node({{"mesh", b.mesh(positions, int(b.accessor<uint8_t>("SCALAR", {0, 1})), {{"mode", 5}})}});
    const Scene scene = load(b.glb());
    ASSERT_EQ(scene.objects.size(), 1u);
    expectCorners(cornersOf(scene, 0), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
}

TEST(GltfGeometry, UnpacksMeshoptStreams) {
    // The triangle codec may turn the corners of a triangle about.
    for (const char* name : {"meshopt_triangles_16.glb", "meshopt_triangles_32.glb"}) {
        const Corners corners = cornersOf(loadSample(name), 0);
        ASSERT_EQ(corners.size(), 6u);
        for (size_t triangle = 0; triangle < 2; ++triangle) {
            size_t turn = 0;
            while (turn < 2 && corners[triangle * 3 + turn] != kSquare[triangle * 3]) ++turn;
            for (size_t k = 0; k < 3; ++k)
                EXPECT_EQ(corners[triangle * 3 + (turn + k) % 3], kSquare[triangle * 3 + k]) << name;
        }
    }
}

TEST(GltfGeometry, UnpacksMeshoptFilters) {
    const Scene scene = loadSample("meshopt_instances.glb");
    ASSERT_EQ(scene.objects.size(), 2u);
    const glm::dmat4 &first = scene.objects[0].transform, &second = scene.objects[1].transform;
    EXPECT_LT(glm::length(glm::dvec3(first[3]) - glm::dvec3(0, 0, 1)), 0.02);
    EXPECT_LT(glm::length(glm::dvec3(second[3]) - glm::dvec3(0.6, -0.8, 0)), 0.02);
    EXPECT_LT(glm::length(glm::dvec3(first[0]) - glm::dvec3(1, 0, 0)), 1e-3);
    EXPECT_LT(glm::length(glm::dvec3(second[0]) - glm::dvec3(0, 1, 0)), 1e-3);
}

// KHR_meshopt_compression has the layout of EXT_meshopt_compression, and reads the same data.
TEST(GltfGeometry, UnpacksMeshoptUnderItsSecondName) {
    for (const char* name : {"meshopt_indices_32.glb", "meshopt_triangles_16.glb", "meshopt_instances.glb"}) {
        std::string bytes = gltfSample(name);
        const Scene expected = load(bytes);
        for (size_t at = 0; (at = bytes.find("EXT_meshopt", at)) != std::string::npos; ++at)
            bytes.replace(at, 3, "KHR");
        const Scene scene = load(bytes);
        ASSERT_EQ(scene.objects.size(), expected.objects.size());
        EXPECT_EQ(scene.meshes[0].positions, expected.meshes[0].positions) << name;
        EXPECT_EQ(scene.meshes[0].indices, expected.meshes[0].indices) << name;
    }
}

TEST(GltfGeometry, ReadsMaterialsAndPrimitivesInOrder) {
    const Scene scene = loadSample("materials.glb");
    ASSERT_EQ(scene.materials.size(), 6u) << "the default comes first";
    ASSERT_EQ(scene.meshes[0].primitives.size(), 6u);
    for (uint32_t i = 0; i < 6; ++i) {
        EXPECT_EQ(scene.meshes[0].primitives[i].first_triangle, i);
        EXPECT_EQ(scene.meshes[0].primitives[i].triangle_count, 1u);
        EXPECT_EQ(scene.meshes[0].primitives[i].material, i);
    }
    EXPECT_EQ(scene.meshes[0].positions.size(), 3u) << "primitives share their vertices";
    EXPECT_TRUE(scene.materials[0].hides());
    EXPECT_FALSE(scene.materials[0].double_sided);
    EXPECT_EQ(scene.materials[1].name, "plain");
    EXPECT_EQ(scene.materials[1].base_color, glm::vec4(0.5f, 0.25f, 0.125f, 1.0f));
    EXPECT_TRUE(scene.materials[1].hides());
    EXPECT_EQ(scene.materials[2].alpha_mode, AlphaMode::kMask);
    EXPECT_EQ(scene.materials[2].alpha_cutoff, 0.25f);
    EXPECT_TRUE(scene.materials[2].double_sided);
    EXPECT_EQ(scene.materials[3].alpha_mode, AlphaMode::kBlend);
    for (size_t i = 2; i < 6; ++i) EXPECT_FALSE(scene.materials[i].hides()) << i;
    EXPECT_TRUE(scene.materials[4].transmissive);
    EXPECT_TRUE(scene.materials[5].transmissive);
}

TEST(GltfGeometry, GivesAMaterialToASceneWithoutAny) {
    const Scene scene = loadSample("list.glb");
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_TRUE(scene.materials[0].hides());
}

}  // namespace
}  // namespace sightline::test
