// Several scenes as one: keys do not repeat, names tell where things come from, and everything follows a turn.
// SPDX-License-Identifier: MIT
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gltf_check.h"
#include "scene_stream_samples.h"
#include "sightline/tools/import/scene_file.h"

namespace sightline {
using namespace tools;
namespace {

using namespace test;

Scene sample(const std::string& name, uint64_t first_key) {
    Scene scene = sampleScene();
    scene.name = name;
    scene.files = {{name, 0}};
    for (SceneObject& object : scene.objects) object.key += first_key;
    for (Mesh& mesh : scene.meshes)
        for (const glm::vec3& p : mesh.positions) mesh.bounds.grow(glm::dvec3(p));
    SceneCell cell{"hall", {{1, 0, 0, -2}, {0, 0.6, 0.8, 3}}, {{2, -1, -1}, {4, 5, 6}}};
    scene.cells = {cell, cell};
    ScenePortal hole;
    hole.name = "hole";
    hole.cells[1] = 1;
    hole.polygon = {{1, 2, 3}, {4, 5, 6}, {7, 8, 10}};
    hole.door = 1;
    scene.portals = {hole};
    return scene;
}

TEST(SceneJoin, OneSceneStaysAsItIs) {
    const Scene joined = joinScenes({sample("a/arch.glb", 5)});
    EXPECT_EQ(joined.name, "a/arch.glb");
    EXPECT_EQ(joined.objects[0].key, 5u);
    EXPECT_EQ(joined.nodes.size(), 3u);
}

TEST(SceneJoin, KeysDoNotRepeatAndPathsNameTheFile) {
    Scene second = sample("mep.ifc", 0);
    second.objects[2].node = SceneNode::kNone;
    const Scene joined = joinScenes({sample("a/arch.glb", 5), second, sample("b/arch.glb", 100)});
    EXPECT_EQ(joined.name, "a/arch.glb + mep.ifc + b/arch.glb");
    EXPECT_EQ(sceneFault(joined), "");
    std::set<uint64_t> keys;
    for (const SceneObject& object : joined.objects) keys.insert(object.key);
    EXPECT_EQ(keys.size(), 9u);
    ASSERT_EQ(joined.files.size(), 3u);
    EXPECT_EQ(joined.files[0].first_key, 0u);
    EXPECT_EQ(joined.files[1].first_key, 8u);
    EXPECT_EQ(joined.files[2].first_key, 11u);
    EXPECT_EQ(joined.objects[3].key, 8u);
    EXPECT_EQ(joined.objects[6].key, 111u);
    EXPECT_EQ(objectPath(joined, joined.objects[0]), "arch/House/Room/Door");
    EXPECT_EQ(objectPath(joined, joined.objects[4]), "mep/House/Room/Cat");
    EXPECT_EQ(objectPath(joined, joined.objects[5]), "mep");
    for (size_t i = 0; i < 3; ++i) {
        const ScenePortal& portal = joined.portals[i];
        EXPECT_EQ(portal.cells[0], 2 * i);
        EXPECT_EQ(portal.cells[1], 2 * i + 1);
        EXPECT_EQ(portal.door, 3 * i + 1);
    }
    EXPECT_EQ(joined.cameras.size(), 6u);
    ASSERT_EQ(joined.rooms.size(), 6u);
    EXPECT_EQ(roomPath(joined, joined.rooms[2]), "mep/House/Room");
    EXPECT_EQ(joined.meshes[3].primitives[1].material, 3u);
}

TEST(SceneJoin, ATurnAndAScaleMoveEverything) {
    Scene before = sample("a.glb", 0);
    before.walk_speed = 320;
    for (const UpAxis up : {UpAxis::kX, UpAxis::kZ}) {
        Scene after = before;
        ImportSettings settings;
        settings.up = up;
        settings.scale = 2.5;
        placeScene(after, settings);
        EXPECT_EQ(sceneFault(after), "");
        const auto moved = [&](const glm::dvec3& p) {
            return 2.5 * (up == UpAxis::kX ? glm::dvec3(-p.y, p.x, p.z) : glm::dvec3(p.x, p.z, -p.y));
        };
        const auto near = [](const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-12; };
        for (size_t i = 0; i < before.objects.size(); ++i)
            for (const glm::dvec3& p : {glm::dvec3(0), glm::dvec3(1, 2, 3)})
                EXPECT_TRUE(near(glm::dvec3(after.objects[i].transform * glm::dvec4(p, 1)),
                                 moved(glm::dvec3(before.objects[i].transform * glm::dvec4(p, 1)))));
        for (size_t i = 0; i < before.cameras.size(); ++i) {
            const glm::dmat4 &a = before.cameras[i].transform, &b = after.cameras[i].transform;
            EXPECT_TRUE(near(glm::dvec3(b[3]), moved(glm::dvec3(a[3]))));
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_TRUE(near(2.5 * glm::dvec3(b[axis]), moved(glm::dvec3(a[axis]))))
                    << "directions keep their length";
        }
        EXPECT_EQ(after.walk_speed, 800);
        EXPECT_EQ(joinScenes({sample("b.glb", 0), after}).walk_speed, 800);
        EXPECT_EQ(after.cameras[0].z_near, 1.25);
        EXPECT_EQ(after.cameras[0].z_far, 250);
        EXPECT_EQ(after.cameras[1].orthographic_height, 50);
        for (size_t i = 0; i < 3; ++i)
            EXPECT_TRUE(near(after.portals[0].polygon[i], moved(before.portals[0].polygon[i])));
        for (const glm::dvec3& p : {glm::dvec3(0), glm::dvec3(5, -3, 4)})
            for (size_t i = 0; i < 2; ++i) {
                const glm::dvec4 &was = before.cells[0].planes[i], &is = after.cells[0].planes[i];
                EXPECT_NEAR(glm::dot(glm::dvec3(is), moved(p)) + is.w, 2.5 * (glm::dot(glm::dvec3(was), p) + was.w),
                            1e-12);
            }
        EXPECT_LT(glm::length(after.rooms[0].bounds.size() - glm::abs(moved(before.rooms[0].bounds.size()))), 1e-9);
        EXPECT_TRUE(near(after.cells[0].bounds.size(), glm::abs(moved(before.cells[0].bounds.size()))));
    }
}

}  // namespace
}  // namespace sightline
