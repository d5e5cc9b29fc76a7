// A larger city keeps the smaller one, every machine builds the same one, and its walk is free.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/city/city.h"

#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "sightline/tools/scene/city/layout.h"
#include "sightline/tools/scene/city/library.h"
#include "tests/tools/scene/scene_hash.h"

namespace sightline {
using namespace tools;
namespace {

TEST(City, LargerCityKeepsTheSmaller) {
    for (const uint64_t seed : {0ull, 1ull, 12345678901234567890ull}) {
        const Scene large = makeCity(seed, 30000);
        for (const uint32_t count : {1u, 2u, 10u, 123u, 1000u, 2777u, 29999u}) {
            const Scene small = makeCity(seed, count);
            ASSERT_EQ(small.objects.size(), count);
            ASSERT_EQ(small.meshes.size(), large.meshes.size());
            for (size_t m = 0; m < small.meshes.size(); ++m) {
                ASSERT_EQ(small.meshes[m].positions, large.meshes[m].positions) << "seed " << seed << ", mesh " << m;
                ASSERT_EQ(small.meshes[m].indices, large.meshes[m].indices) << "seed " << seed << ", mesh " << m;
            }
            for (uint32_t i = 0; i < count; ++i) {
                const SceneObject &a = small.objects[i], &b = large.objects[i];
                ASSERT_TRUE(a.key == i && b.key == i && a.mesh == b.mesh && a.transform == b.transform)
                    << "seed " << seed << ", " << count << " objects, object " << i;
            }
        }
    }
}

TEST(City, IsTheSameOnEveryMachine) {
    EXPECT_EQ(hashOfScene(makeCity(1, 5000)), 8622902441323407931ull);
    EXPECT_NE(hashOfScene(makeCity(1, 5000)), hashOfScene(makeCity(2, 5000)));
}

TEST(City, TransformsAreUprightQuarterTurnsAndSomeMirror) {
    const Scene scene = makeCity(3, 20000);
    size_t mirrored = 0;
    for (const SceneObject& object : scene.objects) {
        const glm::dmat4& m = object.transform;
        EXPECT_EQ(m[0][0] * m[0][2], 0) << "object " << object.key;
        EXPECT_EQ(m[2][0] * m[2][2], 0) << "object " << object.key;
        EXPECT_GT(m[1][1], 0) << "object " << object.key;
        const double determinant = glm::determinant(glm::dmat3(m));
        EXPECT_GT(std::abs(determinant), 0.25) << "object " << object.key;
        if (determinant < 0) ++mirrored;
    }
    EXPECT_GT(mirrored, 100u);
    EXPECT_LT(mirrored, 4000u);
}

TEST(City, HasFurnitureForEveryBuilding) {
    for (const uint64_t seed : {1, 2, 3}) {
        const Scene scene = makeCity(seed, 50000);
        size_t buildings = 0;
        for (const SceneObject& object : scene.objects) buildings += object.mesh >= city::kItemCount;
        const double ratio = static_cast<double>(scene.objects.size() - buildings) / static_cast<double>(buildings);
        EXPECT_GE(ratio, 6) << "seed " << seed;
        EXPECT_LE(ratio, 12) << "seed " << seed;
    }
}

TEST(City, AThousandObjectsEncloseTheMarket) {
    // The middle and the eight blocks around it are what its visitors see.
    for (uint64_t seed = 0; seed < 20; ++seed) {
        const Scene scene = makeCity(seed, 1000);
        std::set<std::pair<double, double>> grounds;
        for (const SceneObject& object : scene.objects)
            if (object.mesh <= city::kGroundSmall) grounds.insert({object.transform[3].x, object.transform[3].z});
        EXPECT_GE(grounds.size(), 9u) << "seed " << seed;
    }
}

TEST(City, BlocksTileThePlan) {
    const std::vector<city::Block> blocks = city::blocksBetween(0, 600 * 600);
    for (size_t i = 1; i < blocks.size(); ++i) EXPECT_LE(blocks[i - 1].distance2, blocks[i].distance2);
    int checked = 0;
    for (double x = -300.25; x < 300; x += 3.5) {
        for (double z = -300.25; z < 300; z += 3.5, ++checked) {
            int covers = 0;
            for (const city::Block& block : blocks)
                covers += std::abs(x - block.x) < 0.5 * block.size() && std::abs(z - block.z) < 0.5 * block.size();
            ASSERT_EQ(covers, 1) << "x " << x << ", z " << z;
        }
    }
    EXPECT_GT(checked, 10000);
}

TEST(City, BlocksComeInOneOrderHoweverFarOneLooks) {
    city::BlockSequence sequence;
    const std::vector<city::Block> blocks = city::blocksBetween(0, 2000 * 2000);
    for (size_t i = 0; i < blocks.size(); ++i) {
        const city::Block block = sequence.next(), &other = blocks[i];
        ASSERT_TRUE(block.x == other.x && block.z == other.z && block.small == other.small) << "block " << i;
    }
}

TEST(City, WalkIsTheSameForEveryCallAndFreeOfObstacles) {
    constexpr double kClearance = 0.25;  // [metres]
    for (const uint64_t seed : {1, 2, 3, 4, 5}) {
        const CameraPath path = cityStreetPath(seed, 2000);
        ASSERT_EQ(path.frames.size(), 2000u);
        const Scene scene = makeCity(seed, 3000);
        std::vector<Box3d> boxes;
        for (const SceneObject& object : scene.objects)
            boxes.push_back(transformBox(scene.meshes[object.mesh].bounds, object.transform));
        for (size_t f = 0; f < path.frames.size(); ++f) {
            const CameraFrame& frame = path.frames[f];
            EXPECT_EQ(frame.eye.y, 1.7);
            EXPECT_EQ(frame.z_near, 0.1);
            EXPECT_FALSE(frame.z_far.has_value());
            EXPECT_EQ(frame.fov_y_degrees, 60);
            ASSERT_TRUE(isUsable(makeView(frame, 1280, 720)));
            for (size_t i = 0; i < boxes.size(); ++i) {
                const glm::dvec3 outside = glm::max(boxes[i].min - frame.eye, frame.eye - boxes[i].max);
                ASSERT_GT(glm::max(outside.x, glm::max(outside.y, outside.z)), kClearance)
                    << "seed " << seed << ", frame " << f << ", object " << i << " ("
                    << scene.meshes[scene.objects[i].mesh].name << ")";
            }
        }
    }
}

TEST(City, WalkIsSmooth) {
    const CameraPath path = cityStreetPath(9, 4000);
    for (size_t f = 0; f < path.frames.size(); ++f) {
        const CameraFrame &a = path.frames[f], &b = path.frames[(f + 1) % path.frames.size()];
        const glm::dvec3 step = b.eye - a.eye;
        EXPECT_LT(glm::length(step), 0.25) << "frame " << f;
        const glm::dvec3 look = glm::normalize(a.target - a.eye), next = glm::normalize(b.target - b.eye);
        EXPECT_GT(glm::dot(look, next), 0.99) << "frame " << f;
        EXPECT_GT(glm::dot(look, glm::normalize(step)), 0.85) << "frame " << f;
    }
}

}  // namespace
}  // namespace sightline
