// Nodes, scenes, instances and cameras of a glTF arrive where they belong.
// SPDX-License-Identifier: MIT
#include <cmath>

#include "gltf_reading.h"

namespace sightline::test {
using namespace tools;
namespace {

std::vector<uint64_t> keysOf(const Scene& scene) {
    std::vector<uint64_t> out;
    for (const SceneObject& object : scene.objects) out.push_back(object.key);
    return out;
}

TEST(GltfNodes, ComposesTransformsDownTheTreeOfOneSharedMesh) {
    const Scene scene = loadSample("node_tree.glb");
    ASSERT_EQ(keysOf(scene), (std::vector<uint64_t>{2, 3}));
    EXPECT_EQ(scene.objects[0].name, "deep");
    // (x, y, z) -> (x + 1, y, z), scaled by (2, 3, 4), a quarter turn about z, then 10 along x.
    expectCorners(cornersOf(scene, 0), {{10, 2, 0}, {10, 4, 0}, {7, 2, 0}});
    EXPECT_GT(glm::determinant(glm::dmat3(scene.objects[0].transform)), 0);
    // A mirror stays in the transform.
    expectCorners(cornersOf(scene, 1), {{15, 6, 7}, {14, 6, 7}, {15, 7, 7}});
    EXPECT_LT(glm::determinant(glm::dmat3(scene.objects[1].transform)), 0);
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.objects[0].mesh, scene.objects[1].mesh);
}

TEST(GltfNodes, ComposesInDouble) {
    GltfBuilder b;
    b.node({{"mesh", b.triangleMesh()}, {"translation", {0.0009765625, 0, 0}}});
    b.node({{"children", {0}}, {"translation", {1e9, 0, 0}}});
    EXPECT_EQ(load(b.glb()).objects.at(0).transform[3][0], 1e9 + 0.0009765625);
}

TEST(GltfNodes, NormalizesRotations) {
    GltfBuilder b;
    b.node({{"mesh", b.triangleMesh()}, {"rotation", {0, 0, 2, 2}}});
    expectCorners(cornersOf(load(b.glb()), 0), {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}});
}

TEST(GltfNodes, ShowsTheMarkedSceneOrAllOrEveryNode) {
    EXPECT_EQ(keysOf(loadSample("scene_marked.glb")), (std::vector<uint64_t>{1}));
    EXPECT_EQ(keysOf(loadSample("scenes_unmarked.glb")), (std::vector<uint64_t>{0, 1}));
    EXPECT_EQ(keysOf(loadSample("scenes_none.glb")), (std::vector<uint64_t>{0, 1, 2}));
}

/// A node with two levels, of which the second is larger; the tree of `parent`, if there is one, holds the node.
GltfBuilder nodeWithLevels() {
    GltfBuilder b;
    const uint32_t fine = b.triangleMesh(), coarse = b.triangleMesh(), coarsest = b.triangleMesh();
    b.node({{"mesh", fine}, {"translation", {5, 0, 0}}, {"extensions", {{"MSFT_lod", {{"ids", {1, 2}}}}}}});
    b.node({{"mesh", coarse}, {"translation", {5, 0, 0}}});
    b.node({{"mesh", coarsest}, {"translation", {6, 0, 0}}, {"scale", {2, 2, 2}}});
    b.json["extensionsUsed"] = {"MSFT_lod"};
    return b;
}

// A bake takes what an animation of the file moves, shows or hides for what moves.
TEST(GltfNodes, KnowsWhatAnimationsMove) {
    const auto animatedBy = [](const Json& target) {
        GltfBuilder b;
        const uint32_t mesh = b.triangleMesh();
        b.node({{"mesh", mesh}, {"name", "apart"}});
        b.node({{"children", {2}}, {"name", "hinge"}});
        b.node({{"children", {3}}, {"name", "leaf"}, {"mesh", mesh}});
        b.node({{"mesh", mesh}, {"name", "knob"}});
        const uint32_t times = b.accessor<float>("SCALAR", {0, 1});
        const uint32_t values = b.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0});
        b.json["animations"] = Json::array({{{"samplers", Json::array({{{"input", times}, {"output", values}}})},
                                             {"channels", Json::array({{{"sampler", 0}, {"target", target}}})}}});
        std::string moved;
        for (const SceneObject& object : load(b.glb()).objects)
            if (object.changes == SceneObject::kAnimated) moved += object.name + " ";
        return moved;
    };
    const auto byPointer = [](const std::string& pointer) {
        return Json{{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
    };
    for (const char* path : {"translation", "rotation", "scale"}) {
        EXPECT_EQ(animatedBy({{"node", 2}, {"path", path}}), "leaf knob ") << path;
        EXPECT_EQ(animatedBy({{"node", 1}, {"path", path}}), "leaf knob ") << path;
        EXPECT_EQ(animatedBy({{"node", 3}, {"path", path}}), "knob ") << path;
        EXPECT_EQ(animatedBy(byPointer("/nodes/2/" + std::string(path))), "leaf knob ") << path;
    }
    EXPECT_EQ(animatedBy(byPointer("/nodes/0/extensions/KHR_node_visibility/visible")), "apart ");
    for (const Json& nothing :
         {Json{{"path", "translation"}}, Json{{"node", 2}, {"path", "weights"}}, byPointer("/materials/0/alphaCutoff"),
          byPointer("/meshes/0/weights"), byPointer("/nodes/77/scale"), Json{{"node", 77}, {"path", "scale"}}})
        EXPECT_EQ(animatedBy(nothing), "") << nothing.dump();
}

TEST(GltfNodes, KeepsTheLevelsOfDetailOfANode) {
    GltfBuilder b = nodeWithLevels();
    b.json["scenes"] = {{{"nodes", {0}}}};
    for (const bool listed : {false, true}) {
        if (listed) b.json["scenes"] = {{{"nodes", {0, 1, 2}}}};  // some writers do
        const Scene scene = load(b.glb());
        ASSERT_EQ(keysOf(scene), (std::vector<uint64_t>{0}));
        ASSERT_EQ(scene.levels.size(), 2u);
        EXPECT_EQ(scene.levels[0].object, 0u);
        EXPECT_EQ(scene.levels[0].transform, glm::dmat4(1.0));
        EXPECT_EQ(scene.levels[1].transform[3].x, 1.0);
        EXPECT_EQ(scene.levels[1].transform[0].x, 2.0);
        EXPECT_EQ(scene.meshes.size(), 3u);
    }
}

TEST(GltfNodes, LevelsTakeTheNodesPlaceInTheTree) {
    GltfBuilder b = nodeWithLevels();
    b.node({{"children", {0}}, {"translation", {0, 100, 0}}, {"scale", {3, 3, 3}}});
    b.json["scenes"] = {{{"nodes", {3}}}};
    const Scene scene = load(b.glb());
    ASSERT_EQ(scene.levels.size(), 2u);
    EXPECT_EQ(scene.objects[0].transform[3], glm::dvec4(15, 100, 0, 1));
    EXPECT_NEAR(scene.levels[1].transform[3].x, 1.0, 1e-12);
    EXPECT_NEAR(scene.levels[1].transform[0].x, 2.0, 1e-12);
}

TEST(GltfNodes, LevelsThatWouldLoseSomethingAreLeftOut) {
    const auto levelsOf = [](GltfBuilder b) {
        b.json["scenes"] = {{{"nodes", {0}}}};
        const Scene scene = load(b.glb());
        EXPECT_EQ(keysOf(scene).front(), 0u);
        return scene.levels.size();
    };
    EXPECT_EQ(levelsOf(nodeWithLevels()), 2u);
    GltfBuilder without = nodeWithLevels();
    without.json["nodes"][2].erase("mesh");  // drawn as nothing from afar
    EXPECT_EQ(levelsOf(without), 0u);
    GltfBuilder children = nodeWithLevels();
    children.json["nodes"][1]["children"] = {children.node({{"mesh", 0}})};
    EXPECT_EQ(levelsOf(children), 0u);
    GltfBuilder wrong = nodeWithLevels();
    wrong.json["nodes"][0]["extensions"]["MSFT_lod"]["ids"] = {7};
    const Result<Scene> refused = parse(wrong.glb());
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().message.find("nodes[0]: ids 7 is out of range of 3"), std::string::npos)
        << refused.error().message;
}

TEST(GltfNodes, ReadsLongChains) {
    GltfBuilder b;
    b.triangleMesh();
    constexpr int kNodes = 100000;
    Json nodes = Json::array();
    for (int i = 0; i + 1 < kNodes; ++i) nodes.push_back({{"children", {i + 1}}, {"translation", {1, 0, 0}}});
    nodes.push_back({{"mesh", 0}});
    b.json["nodes"] = std::move(nodes);
    const Scene scene = load(b.glb());
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(scene.objects[0].transform[3][0], kNodes - 1);
}

TEST(GltfNodes, MakesAnObjectOfEachInstance) {
    const Scene scene = loadSample("instances.glb");
    ASSERT_EQ(keysOf(scene), (std::vector<uint64_t>{0, 1, 1, 1}));
    for (size_t i = 1; i < 4; ++i) {
        EXPECT_EQ(scene.objects[i].name, "grove");
        EXPECT_EQ(scene.objects[i].node, 1u);
        EXPECT_EQ(objectPath(scene, scene.objects[i]), "grove");
    }
    EXPECT_EQ(scene.meshes.size(), 1u);
    expectCorners(cornersOf(scene, 1), {{100, 0, 0}, {101, 0, 0}, {100, 1, 0}});
    for (size_t corner = 0; corner < 3; ++corner) {
        const glm::dvec3 expected[] = {{105, 0, 0}, {105, 2, 0}, {103, 0, 0}};
        expectNear(cornersOf(scene, 2)[corner], expected[corner], 1e-4, "a turned corner");
    }
    expectCorners(cornersOf(scene, 3), {{100, 7, 0}, {99, 7, 0}, {100, 8, 0}});
    EXPECT_LT(glm::determinant(glm::dmat3(scene.objects[3].transform)), 0);
}

TEST(GltfNodes, KeepsTheTreeOfNames) {
    GltfBuilder b;
    const uint32_t mesh = b.triangleMesh();
    const uint32_t joint = b.node({{"name", "Handle"}, {"mesh", mesh}});
    const uint32_t door = b.node({{"name", "Door"}, {"mesh", mesh}, {"children", {joint}}});
    const uint32_t unnamed = b.node({{"children", {door}}});
    const uint32_t level = b.node({{"name", "Level 1"}, {"children", {unnamed}}});
    const uint32_t building = b.node({{"name", "Building"}, {"children", {level}}});
    const Scene scene = load(b.glb());
    ASSERT_EQ(scene.nodes.size(), 5u);
    EXPECT_EQ(scene.nodes[door].name, "Door");
    EXPECT_EQ(scene.nodes[door].parent, unnamed);
    EXPECT_EQ(scene.nodes[building].parent, SceneNode::kNone);
    ASSERT_EQ(scene.objects.size(), 2u);
    EXPECT_EQ(scene.objects[0].node, joint);
    EXPECT_EQ(objectPath(scene, scene.objects[0]), "Building/Level 1/Door/Handle");
    EXPECT_EQ(objectPath(scene, scene.objects[1]), "Building/Level 1/Door");
}

// An object is named after its mesh if its node has no name; its path goes on to say where it hangs.
TEST(GltfNodes, NamesObjectsOfUnnamedNodesAfterTheirMesh) {
    GltfBuilder b;
    const uint32_t mesh = b.triangleMesh();
    b.json["meshes"][mesh]["name"] = "Chair";
    const uint32_t chair = b.node({{"mesh", mesh}});
    b.node({{"name", "Kitchen"}, {"children", {chair}}});
    const Scene scene = load(b.glb());
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(objectPath(scene, scene.objects[0]), "Kitchen/Chair");
}

TEST(GltfNodes, ReadsCameras) {
    const Scene scene = loadSample("cameras.glb");
    ASSERT_EQ(scene.cameras.size(), 3u) << "one that a scale of zero flattens looks nowhere and is left out";
    EXPECT_EQ(scene.cameras[0].name, "lens");
    EXPECT_EQ(scene.cameras[0].fov_y, 0.5);
    EXPECT_EQ(scene.cameras[0].z_near, 0.25);
    EXPECT_EQ(scene.cameras[0].z_far, 50.0);
    EXPECT_EQ(glm::dvec3(scene.cameras[0].transform[3]), glm::dvec3(1, 2, 3));
    EXPECT_EQ(scene.cameras[1].name, "watch");
    EXPECT_FALSE(scene.cameras[1].z_far.has_value());
    EXPECT_EQ(scene.cameras[2].fov_y, 0.0);
    EXPECT_EQ(scene.cameras[2].orthographic_height, 4.0);
    EXPECT_EQ(scene.cameras[2].z_far, 9.0);
}

TEST(GltfNodes, IgnoresExtensionsThatLeaveTrianglesAlone) {
    for (const char* name : {"KHR_texture_transform", "KHR_texture_basisu", "KHR_materials_unlit", "EXT_texture_webp",
                             "KHR_materials_not_yet_known", "KHR_lights_punctual"}) {
        GltfBuilder b = GltfBuilder::triangle();
        b.json["extensionsRequired"] = {name};
        EXPECT_EQ(load(b.glb()).objects.size(), 1u) << name;
    }
}

}  // namespace
}  // namespace sightline::test
