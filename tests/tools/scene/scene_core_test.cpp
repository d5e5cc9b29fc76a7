// What lies far off or around all is left aside, and nothing else is.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/scene_core.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/tools/scene/procedural.h"
#include "tests/tools/truth/test_scenes.h"

namespace sightline::tools {
namespace {

using namespace test;

glm::dmat4 placed(const glm::dvec3& at, double size) {
    glm::dmat4 out(size);
    out[3] = glm::dvec4(at, 1);
    return out;
}

/// Boxes of half a unit to two, within ten units.
Scene houseOf(Random& random, uint32_t boxes) {
    Scene scene = emptyScene();
    const uint32_t box = addBox(scene, glm::vec3(1.0f));
    for (uint32_t i = 0; i < boxes; ++i)
        addObject(scene, box,
                  placed({random.uniform(-5, 5), random.uniform(0, 3), random.uniform(-5, 5)}, random.uniform(0.5, 2)));
    return scene;
}

TEST(SceneCore, LeavesStraysAndDomesAside) {
    Random random(1);
    for (const uint32_t boxes : {1u, 2u, 3u, 24u, 300u})
        for (const double far : {1e3, 1e5, 1e7})
            for (const bool dome : {false, true}) {
                SCOPED_TRACE(std::to_string(boxes) + " boxes, at " + std::to_string(far) + (dome ? ", a dome" : ""));
                Scene scene = houseOf(random, boxes);
                const Box3d house = worldBounds(scene);
                const uint32_t box = scene.objects[0].mesh;
                addObject(scene, box, dome ? placed(glm::dvec3(0), far) : placed({0, far, 0}, 0.2));
                const SceneCore core = coreOf(scene);
                if (boxes < 3 && !dome) continue;  // of two boxes either may be the stray
                ASSERT_EQ(core.aside, std::vector<uint32_t>{boxes});
                EXPECT_LT(glm::length(core.bounds.min - house.min), 1e-9);
                EXPECT_LT(glm::length(core.bounds.max - house.max), 1e-9);
            }
}

TEST(SceneCore, FindsWhatStrayedWithinOneMesh) {
    Random random(2);
    for (const double far : {1e3, 1e6}) {
        Scene scene = emptyScene();
        const uint32_t box = addBox(scene, glm::vec3(2.0f));
        Mesh& mesh = scene.meshes[box];
        const auto first = static_cast<uint32_t>(mesh.positions.size());
        for (int c = 0; c < 3; ++c)
            mesh.positions.emplace_back(far + random.uniform(), random.uniform(), random.uniform());
        for (uint32_t c = 0; c < 3; ++c) mesh.indices.push_back(first + c);
        ++mesh.primitives.back().triangle_count;
        for (const glm::vec3& point : mesh.positions) mesh.bounds.grow(glm::dvec3(point));
        addObject(scene, box, glm::dmat4(1));
        const SceneCore core = coreOf(scene);
        EXPECT_EQ(core.aside, std::vector<uint32_t>{0});
        EXPECT_LT(core.diagonal(), 7);
    }
}

TEST(SceneCore, IsAllOfWhatHangsTogether) {
    Random random(3);
    EXPECT_TRUE(coreOf(Scene()).isWhole());
    EXPECT_EQ(coreOf(Scene()).diagonal(), 0);
    for (uint32_t boxes = 1; boxes < 40; ++boxes) {
        Scene scene = houseOf(random, boxes);
        EXPECT_TRUE(coreOf(scene).isWhole());
        // A room around what is small, and a lawn around a house.
        addObject(scene, scene.objects[0].mesh, placed(glm::dvec3(0), 15));
        EXPECT_TRUE(coreOf(scene).isWhole()) << boxes;
    }
    for (const char* words : {"city:1:200", "terrain:1:64", "building:1:3"}) {
        const Result<Scene> scene = makeProcedural(words);
        ASSERT_TRUE(scene.ok()) << words;
        EXPECT_TRUE(coreOf(*scene).isWhole()) << words;
        EXPECT_EQ(coreOf(*scene).bounds.max, worldBounds(*scene).max);
    }
}

TEST(SceneCore, NamesThreeAtMost) {
    Random random(4);
    Scene scene = houseOf(random, 9);
    scene.objects[2].name = "west wing";
    EXPECT_EQ(asideText(scene, {}), "");
    const uint32_t one[] = {2}, four[] = {2, 3, 4, 5};
    EXPECT_EQ(asideText(scene, one), "1 of 9 objects reaches far beyond all others ('west wing')");
    EXPECT_NE(asideText(scene, four).find("4 of 9 objects reach far beyond all others ('west wing', "),
              std::string::npos);
    EXPECT_NE(asideText(scene, four).find(", ...)"), std::string::npos);
}

}  // namespace
}  // namespace sightline::tools
