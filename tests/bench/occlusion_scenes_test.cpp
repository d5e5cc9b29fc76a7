// The occlusion scenes: as many of everything as published, the same every time, and facing the right way.
// SPDX-License-Identifier: MIT
#include "bench/occlusion_scenes.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace sightline::bench {
namespace {

struct Counts {
    const char* name;
    size_t batches, triangles, boxes, cameras;
};

TEST(OcclusionScenes, HaveThePublishedCounts) {
    for (const Counts& c :
         {Counts{"city", 1024, 49152, 200000, 8}, Counts{"terrain", 1024, 524288, 100000, 8},
          Counts{"indoor", 1024, 124872, 50000, 8}, Counts{"soup-area", 782, 100000, 50000, 2},
          Counts{"soup-side", 782, 100000, 50000, 2}, Counts{"wall-brick-0.01", 3072, 6144, 21000, 4}}) {
        const OcclusionScene scene = makeOcclusionScene(c.name);
        EXPECT_EQ(scene.name, c.name);
        EXPECT_EQ(scene.batches.size(), c.batches) << c.name;
        EXPECT_EQ(scene.triangles(), c.triangles) << c.name;
        EXPECT_EQ(scene.boxes.size(), c.boxes) << c.name;
        EXPECT_EQ(scene.cameras.size(), c.cameras) << c.name;
    }
    EXPECT_TRUE(makeOcclusionScene("no such scene").batches.empty());
}

TEST(OcclusionScenes, AreTheSameEveryTimeAndDifferFromEachOther) {
    std::set<uint64_t> hashes;
    for (const std::string& name : occlusionSceneNames()) {
        const uint64_t hash = hashOcclusionScene(makeOcclusionScene(name));
        EXPECT_EQ(hash, hashOcclusionScene(makeOcclusionScene(name))) << name;
        hashes.insert(hash);
    }
    EXPECT_EQ(hashes.size(), occlusionSceneNames().size());
}

// No mathematical function but the square root's kin enters these, so every machine must have these very bits.
TEST(OcclusionScenes, HaveTheBitsOfThePublishedFigures) {
    OcclusionScene city = makeOcclusionCity(), terrain = makeOcclusionTerrain(), indoor = makeOcclusionIndoor();
    for (OcclusionScene* scene : {&city, &terrain, &indoor}) scene->cameras.clear();
    EXPECT_EQ(hashOcclusionScene(city), 0xd5a8076196645c1eull);
    EXPECT_EQ(hashOcclusionScene(terrain), 0x511485576c495b2cull);
    EXPECT_EQ(hashOcclusionScene(indoor), 0x0a149996d6c7ce8cull);
}

TEST(OcclusionScenes, NameOnlyVerticesThatAreThereAndBoundThem) {
    for (const char* name : {"city", "terrain", "indoor", "soup-area", "soup-side", "wall-tilted-0.1"}) {
        const OcclusionScene scene = makeOcclusionScene(name);
        for (const OccluderBatch& batch : scene.batches) {
            ASSERT_LT(*std::max_element(batch.indices.begin(), batch.indices.end()), batch.positions.size()) << name;
            Box3f bounds;
            for (const glm::vec3& p : batch.positions) bounds.grow(p);
            ASSERT_TRUE(bounds.min == batch.bounds.min && bounds.max == batch.bounds.max) << name;
            ASSERT_TRUE(bounds.finite()) << name;
        }
        for (const Box3f& box : scene.boxes) ASSERT_FALSE(box.empty()) << name;
    }
}

/// Mean over triangles in front of the camera, in pixels of 1280x720 [pixels, or square pixels].
void soupSizes(const OcclusionScene& scene, double& area, double& side, double& front) {
    const double pixels = 720 / (2 * std::tan(scene.fov_y / 2));
    size_t count = 0;
    area = side = front = 0;
    for (const OccluderBatch& batch : scene.batches)
        for (size_t i = 0; i < batch.indices.size(); i += 3) {
            glm::dvec2 p[3];
            for (size_t k = 0; k < 3; ++k) {
                const glm::vec3& v = batch.positions[batch.indices[i + k]];
                p[k] = glm::dvec2(-v.x, v.y) * (pixels / v.z);  // the camera looks along z: x is to its left
            }
            const glm::dvec2 u = p[1] - p[0], v = p[2] - p[0];
            const double doubled = u.x * v.y - u.y * v.x;
            area += 0.5 * std::abs(doubled);
            side += glm::length(u);
            front += doubled > 0;
            ++count;
        }
    area /= static_cast<double>(count);
    side /= static_cast<double>(count);
    front /= static_cast<double>(count);
}

TEST(OcclusionScenes, SoupHasTrianglesOfTheSizeThatItsNameSays) {
    double area, side, front;
    soupSizes(makeOcclusionSoup(SoupSize::kArea), area, side, front);
    EXPECT_NEAR(area, 30, 1);
    EXPECT_GT(front, 0.99);
    soupSizes(makeOcclusionSoup(SoupSize::kSide), area, side, front);
    EXPECT_NEAR(side, 30, 1);
    EXPECT_GT(front, 0.99);
}

TEST(OcclusionScenes, PanelsOfAWallAreAsFarApartAsAsked) {
    for (WallBond bond : {WallBond::kGrid, WallBond::kBrick}) {
        for (double gap : {0.0, 0.01, 0.1}) {
            const OcclusionScene wall = makeOcclusionWall(bond, gap);
            const Box3f &left = wall.batches[0].bounds, &right = wall.batches[1].bounds;
            const double pixel = 2 * std::tan(wall.fov_y / 2) * 20 / 720;
            EXPECT_NEAR((right.min.x - left.max.x) / pixel, gap, 1e-4);
            if (gap == 0.0) { EXPECT_EQ(right.min.x, left.max.x); }
        }
    }
}

// Without a gap a wall has no slit: one that rounding opened between a corner and an edge would be seen through.
TEST(OcclusionScenes, CornersOfTouchingBricksLieOnTheirNeighboursEdgesExactly) {
    for (WallBond bond : {WallBond::kBrick, WallBond::kTilted}) {
        const OcclusionScene wall = makeOcclusionWall(bond, 0);
        // Corners 1 and 2 are the ends of its upper side.
        const std::vector<glm::vec3>& brick = wall.batches[48 * 20 + 20].positions;
        const glm::dvec2 from(brick[1]), to(brick[2]);
        int between = 0;
        for (const OccluderBatch& other : wall.batches)
            for (const glm::vec3& corner : other.positions) {
                const glm::dvec2 d = to - from, p = glm::dvec2(corner) - from;
                const double along = glm::dot(p, d) / glm::dot(d, d);
                if (along <= 0 || along >= 1 || std::abs(d.x * p.y - d.y * p.x) > 1e-3) continue;
                EXPECT_EQ(d.x * p.y - d.y * p.x, 0.0);
                ++between;
            }
        EXPECT_EQ(between, 2);  // the lower corners of the two bricks above
    }
}

TEST(OcclusionScenes, ViewsHaveTheSceneInFront) {
    for (const std::string& name : occlusionSceneNames()) {
        const OcclusionScene scene = makeOcclusionScene(name);
        for (size_t camera = 0; camera < scene.cameras.size(); ++camera) {
            const View view = occlusionView(scene, camera, 1280, 720);
            ASSERT_TRUE(isUsable(view)) << name;
            const glm::dvec3 ahead =
                glm::dvec3(scene.cameras[camera].eye) + glm::dvec3(scene.cameras[camera].direction) * 10.0;
            const glm::dvec4 clip = view.projection * view.view * glm::dvec4(ahead, 1.0);
            EXPECT_GT(clip.w, 0) << name;
            EXPECT_NEAR(clip.x / clip.w, 0, 1e-6) << name;
            EXPECT_NEAR(clip.y / clip.w, 0, 1e-6) << name;
        }
    }
}

}  // namespace
}  // namespace sightline::bench
