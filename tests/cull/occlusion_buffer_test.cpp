// The occlusion buffer alone hides nothing that a ray sees, and forgets at each frame.
// SPDX-License-Identifier: MIT
#include "sightline/cull/occlusion_buffer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/prepare/occluder/occluder.h"
#include "tests/support/memory.h"

namespace sightline {
namespace {

struct Wall {
    std::vector<glm::vec3> corners;
    glm::dmat4 transform{1.0};
    Occluder occluder;
};

/// A quadrangle of two triangles, anywhere before the eye, seen from both sides.
Wall makeWall(Random& random, const glm::dvec3& eye) {
    Wall wall;
    wall.corners = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    const std::vector<uint32_t> indices = {0, 1, 2, 0, 2, 3};
    const std::vector<uint8_t> both = {1, 1};
    wall.occluder = prepareOccluder({wall.corners, indices}, {}, both);
    const glm::dvec3 turn(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 1);
    wall.transform = glm::inverse(lookAt({0, 0, 0}, turn, {0, 1, 0}));
    for (int axis = 0; axis < 3; ++axis) wall.transform[axis] *= random.uniform(0.5, 6);
    wall.transform[3] =
        glm::dvec4(eye + glm::dvec3(random.uniform(-8, 8), random.uniform(-5, 5), random.uniform(-20, -4)), 1);
    return wall;
}

/// Whether the segment from the eye to a point meets a wall on its way.
bool isBlocked(const std::vector<Wall>& walls, const glm::dvec3& eye, const glm::dvec3& point) {
    for (const Wall& wall : walls) {
        const glm::dmat4 inverse = glm::inverse(wall.transform);
        const glm::dvec3 a(inverse * glm::dvec4(eye, 1)), b(inverse * glm::dvec4(point, 1));
        if (a.z * b.z >= 0) continue;
        const glm::dvec3 at = a + (b - a) * (a.z / (a.z - b.z));
        if (std::abs(at.x) <= 1 + 1e-9 && std::abs(at.y) <= 1 + 1e-9) return true;
    }
    return false;
}

View viewFrom(const glm::dvec3& eye, bool parallel) {
    View view;
    view.view = lookAt(eye, eye + glm::dvec3(0, 0, -1), {0, 1, 0});
    view.projection = parallel ? orthographic(9, 16.0 / 9, 0.1, 100) : perspective(1.0, 16.0 / 9, 0.1);
    return view;
}

TEST(OcclusionBuffer, HidesNothingThatARaySees) {
    uint64_t occluded = 0, outside = 0, visible = 0;
    for (uint64_t seed = 1; seed <= 60; ++seed) {
        Random random(mixSeed(seed, 77));
        const glm::dvec3 eye = seed % 3 == 0 ? glm::dvec3(1e7, -2e6, 3e5) : glm::dvec3(0);
        const View view = viewFrom(eye, false);
        OcclusionBuffer buffer(seed % 2 ? 64 : 320);
        ASSERT_EQ(buffer.begin(view), ViewProblem::kNone);
        std::vector<Wall> walls;
        for (int i = 0; i < 6; ++i) walls.push_back(makeWall(random, eye));
        for (const Wall& wall : walls) buffer.draw(wall.occluder, wall.transform);
        std::vector<Box3d> boxes;
        for (int i = 0; i < 120; ++i) {
            const glm::dvec3 size(random.uniform(0.01, 1.5), random.uniform(0.01, 1.5), random.uniform(0.01, 1.5));
            const glm::dvec3 low =
                eye + glm::dvec3(random.uniform(-20, 20), random.uniform(-12, 12), random.uniform(-40, 2));
            boxes.push_back({low, low + size});
        }
        std::vector<Sight> sights(boxes.size());
        buffer.ask(boxes, sights);
        for (size_t i = 0; i < boxes.size(); ++i) {
            const Box3d& box = boxes[i];
            EXPECT_EQ(buffer.ask(box), sights[i]) << "one by one, seed " << seed << ", box " << i;
            ++(sights[i] == Sight::kOccluded ? occluded : sights[i] == Sight::kOutside ? outside : visible);
            if (sights[i] == Sight::kVisible) continue;
            for (int k = 0; k < 40; ++k) {
                glm::dvec3 p(random.uniform(), random.uniform(), random.uniform());
                if (k < 8) p = {k & 1, k >> 1 & 1, k >> 2 & 1};
                p = box.min + p * box.size();
                const glm::dvec4 clip = view.projection * view.view * glm::dvec4(p, 1);
                const bool drawn = clip.z >= -clip.w && std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w;
                if (!drawn) continue;
                EXPECT_NE(sights[i], Sight::kOutside) << "seed " << seed << ", box " << i;
                EXPECT_TRUE(isBlocked(walls, eye, p)) << "seed " << seed << ", box " << i;
            }
        }
    }
    EXPECT_GT(occluded, 300u);
    EXPECT_GT(outside, 300u);
    EXPECT_GT(visible, 300u);
}

TEST(OcclusionBuffer, AsksInObjectsAsInTheWorld) {
    Random random(5);
    OcclusionBuffer buffer;
    const Wall wall = makeWall(random, {0, 0, 0});
    const glm::dvec3 center(wall.transform[3]);
    ASSERT_EQ(buffer.begin(viewFrom({center.x, center.y, 0}, true)), ViewProblem::kNone);
    EXPECT_EQ(buffer.draw(wall.occluder, wall.transform), 2u);
    // Behind the wall, in its own space: its box in the world is larger.
    const glm::dvec3 away = glm::dvec3(glm::inverse(wall.transform) * glm::dvec4(0, 0, -1, 0));
    const float side = away.z > 0 ? 1.0f : -1.0f;
    const Box3f box{{-0.2f, -0.2f, std::min(0.1f * side, 0.2f * side)},
                    {0.2f, 0.2f, std::max(0.1f * side, 0.2f * side)}};
    EXPECT_EQ(buffer.ask(box, wall.transform), Sight::kOccluded);
    const Box3f before{{-0.2f, -0.2f, std::min(-0.1f * side, -0.2f * side)},
                       {0.2f, 0.2f, std::max(-0.1f * side, -0.2f * side)}};
    EXPECT_EQ(buffer.ask(before, wall.transform), Sight::kVisible);
}

TEST(OcclusionBuffer, DoubtsAndUnusableViewsAreVisible) {
    Random random(9);
    const Wall wall = makeWall(random, {0, 0, 0});
    OcclusionBuffer buffer;
    const Box3d box{{-1, -1, -30}, {1, 1, -29}};
    EXPECT_EQ(buffer.ask(box), Sight::kVisible) << "before the first frame";
    EXPECT_EQ(buffer.draw(wall.occluder), 0u);
    ASSERT_EQ(buffer.begin(viewFrom({0, 0, 0}, false)), ViewProblem::kNone);
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                     kEndless = std::numeric_limits<double>::infinity();
    EXPECT_EQ(buffer.ask({{-1, -1, -1}, {1, 1, 1}}), Sight::kVisible) << "holds the eye";
    EXPECT_EQ(buffer.ask({{kNan, -1, -9}, {1, 1, -8}}), Sight::kVisible);
    EXPECT_EQ(buffer.ask({{-kEndless, -1, -9}, {kEndless, 1, -8}}), Sight::kVisible);
    View mirrored = viewFrom({0, 0, 0}, false);
    mirrored.view[0] = -mirrored.view[0];
    EXPECT_EQ(buffer.begin(mirrored), ViewProblem::kMirrors);
    EXPECT_EQ(buffer.draw(wall.occluder, wall.transform), 0u);
    EXPECT_EQ(buffer.ask(box), Sight::kVisible);
}

TEST(OcclusionBuffer, ForgetsAtEachFrameAndTakesNoMoreMemory) {
    test::CountingMemory memory;
    Random random(3);
    const Wall wall = makeWall(random, {0, 0, 0});
    OcclusionBuffer buffer(320, &memory);
    const glm::dvec3 center(wall.transform[3]);
    const Box3d behind{center + glm::dvec3(-0.05, -0.05, -8.1), center + glm::dvec3(0.05, 0.05, -8)};
    uint64_t allocations = 0;
    for (int frame = 0; frame < 4; ++frame) {
        ASSERT_EQ(buffer.begin(viewFrom({center.x, center.y, 0}, false)), ViewProblem::kNone);
        EXPECT_EQ(buffer.ask(behind), Sight::kVisible) << frame;
        EXPECT_EQ(buffer.draw(wall.occluder, wall.transform), 2u);
        EXPECT_EQ(buffer.ask(behind), Sight::kOccluded) << frame;
        if (frame == 1) allocations = memory.allocations;
        if (frame > 1) { EXPECT_EQ(memory.allocations, allocations) << frame; }
    }
    std::vector<float> nearness(size_t{buffer.width()} * buffer.height());
    std::vector<uint8_t> covered(nearness.size());
    buffer.depthImage(nearness, covered);
    EXPECT_GT(std::count(covered.begin(), covered.end(), 1), 20);
}

}  // namespace
}  // namespace sightline
