// What hides in a loaded world: opaque triangles of rigid meshes, and nothing else.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/load_world.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sightline/query/query.h"

namespace sightline {
using namespace tools;
namespace {

/// A wall in front of a small square; what the wall is made of decides.
Scene wallScene(const Material& material, bool deforms) {
    Scene scene;
    scene.materials = {Material(), material};
    const auto square = [&](float size, uint32_t made_of) {
        Mesh mesh;
        mesh.positions = {{-size, -size, 0}, {size, -size, 0}, {size, size, 0}, {-size, size, 0}};
        mesh.indices = {0, 1, 2, 0, 2, 3};
        mesh.primitives = {{0, 2, made_of}};
        for (const glm::vec3& p : mesh.positions) mesh.bounds.grow(glm::dvec3(p));
        scene.meshes.push_back(mesh);
    };
    square(10, 1);
    scene.meshes[0].deforms = deforms;
    square(1, 0);
    for (uint32_t i = 0; i < 2; ++i) {
        SceneObject object;
        object.key = 10 + i;
        object.mesh = i;
        object.transform[3].z = -5.0 - 5.0 * i;
        scene.objects.push_back(object);
    }
    return scene;
}

std::vector<uint64_t> visibleKeys(const Scene& scene) {
    LoadedWorld loaded = loadWorld(scene);
    EXPECT_EQ(loaded.ids.size(), scene.objects.size());
    View view;
    view.projection = perspective(1.0, 16.0 / 9.0, 0.1);
    Query query;
    std::vector<uint64_t> keys;
    for (const Visible& object : query.visible(loaded.world.commit(), view).objects) keys.push_back(object.key);
    std::sort(keys.begin(), keys.end());
    return keys;
}

size_t visibleObjects(const Scene& scene) { return visibleKeys(scene).size(); }

TEST(LoadWorld, OnlyOpaqueRigidSurfacesHide) {
    Material opaque;
    EXPECT_EQ(visibleObjects(wallScene(opaque, false)), 1u);
    EXPECT_EQ(visibleObjects(wallScene(opaque, true)), 2u);
    Material glass = opaque;
    glass.alpha_mode = AlphaMode::kBlend;
    EXPECT_EQ(visibleObjects(wallScene(glass, false)), 2u);
    Material leaves = opaque;
    leaves.alpha_mode = AlphaMode::kMask;
    EXPECT_EQ(visibleObjects(wallScene(leaves, false)), 2u);
    Material water = opaque;
    water.transmissive = true;
    EXPECT_EQ(visibleObjects(wallScene(water, false)), 2u);
}

TEST(LoadWorld, ASingleSidedWallHidesOnItsFrontOnly) {
    Scene scene = wallScene(Material(), false);
    scene.objects[0].transform[0][0] = scene.objects[0].transform[2][2] = -1;  // turned about
    EXPECT_EQ(visibleKeys(scene), std::vector<uint64_t>{11}) << "its back is not drawn: it neither hides nor shows";
    scene.materials[1].double_sided = true;
    EXPECT_EQ(visibleKeys(scene), std::vector<uint64_t>{10});
    scene = wallScene(Material(), false);
    scene.objects[0].transform[0][0] = -1;  // mirrored: winding and transform both turn
    EXPECT_EQ(visibleObjects(scene), 1u);
}

}  // namespace
}  // namespace sightline
