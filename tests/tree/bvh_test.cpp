// The laws of the hierarchy: parents hold their children, and each item is there once.
// SPDX-License-Identifier: MIT
#include "sightline/tree/bvh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sightline/base/random.h"
#include "sightline/math/round_outward.h"

namespace sightline {
namespace {

std::vector<Box3d> randomBoxes(uint64_t seed, size_t count, double world) {
    Random random(seed);
    std::vector<Box3d> boxes;
    for (size_t i = 0; i < count; ++i) {
        const glm::dvec3 p(random.uniform(-world, world), random.uniform(-world, world), random.uniform(-world, world));
        const double size = world * random.uniform(0.0, random.below(20) ? 0.01 : 1.0);
        boxes.push_back({p, p + glm::dvec3(size, size * random.uniform(), size * random.uniform())});
    }
    return boxes;
}

/// Whether every slot's box holds all boxes below it, and every place is below exactly the slots that say so.
void expectSound(const Bvh& bvh, const std::vector<Box3d>& boxes) {
    std::vector<int> met(boxes.size(), 0), below(bvh.nodes.size(), 0);
    for (uint32_t n = 0; n < bvh.nodes.size(); ++n) {
        const BvhNode& node = bvh.nodes[n];
        for (uint32_t slot = 0; slot < 8; ++slot) {
            for (uint32_t place = node.first[slot]; place < node.first[slot] + node.count[slot]; ++place) {
                const Box3d& box = boxes[bvh.order[place]];
                for (int axis = 0; axis < 3; ++axis) {
                    ASSERT_LE(bvh.origin[axis] + node.min[axis][slot], box.min[axis]);
                    ASSERT_GE(bvh.origin[axis] + node.max[axis][slot], box.max[axis]);
                }
            }
            if (node.count[slot] == 0) continue;
            if (node.child[slot] & BvhNode::kLeaf) {
                ASSERT_EQ(node.count[slot], 1u);
                const uint32_t item = bvh.order[node.child[slot] & ~BvhNode::kLeaf];
                ++met[item];
            } else {
                ++below[node.child[slot]];
            }
        }
    }
    for (int times : met) ASSERT_EQ(times, 1);
    for (uint32_t n = 0; n < below.size(); ++n)
        ASSERT_EQ(below[n], n > 0) << "each node but the root is below one slot";
}

TEST(Bvh, HoldsEveryItemOnceInsideAllItsParents) {
    for (size_t count : {1u, 2u, 7u, 8u, 9u, 63u, 64u, 65u, 1000u, 20000u})
        expectSound(buildBvh(randomBoxes(count, count, 100.0)), randomBoxes(count, count, 100.0));
}

TEST(Bvh, HoldsItemsFarFromTheOrigin) {
    std::vector<Box3d> boxes = randomBoxes(3, 500, 10.0);
    for (Box3d& box : boxes) {
        box.min += glm::dvec3(1e9, -1e9, 1e6);
        box.max += glm::dvec3(1e9, -1e9, 1e6);
    }
    expectSound(buildBvh(boxes), boxes);
}

TEST(Bvh, BuildsOverBoxesInOnePlace) {
    const std::vector<Box3d> boxes(3000, Box3d{glm::dvec3(1.0), glm::dvec3(2.0)});
    expectSound(buildBvh(boxes), boxes);
}

TEST(Bvh, BuildsOverWidthsBelowAndBeyondFloat) {
    for (const double size : {1e-45, 1e-40, 1e-38, 1e19, 1e30, 1e38, 1e39, 1e300}) {
        SCOPED_TRACE(size);
        const std::vector<Box3d> boxes = randomBoxes(11, 300, size);
        expectSound(buildBvh(boxes), boxes);
        std::vector<Box3d> flat = randomBoxes(12, 300, 10.0);
        for (size_t i = 0; i < flat.size(); ++i) flat[i].min.y = flat[i].max.y = boxes[i].min.y;
        expectSound(buildBvh(flat), flat);
    }
}

TEST(Bvh, IsEmptyWithoutItems) { EXPECT_TRUE(buildBvh({}).nodes.empty()); }

TEST(Bvh, RoundsOutwardEvenBetweenFloats) {
    const Box3d box{glm::dvec3(0.1), glm::dvec3(0.1 + 1e-12)};
    const Box3f out = roundOutward(box, glm::dvec3(0.0));
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(double(out.min[axis]), box.min[axis]);
        EXPECT_GE(double(out.max[axis]), box.max[axis]);
    }
}

TEST(RoundOutward, IsWhatTheStandardLibraryFinds) {
    Random random(2);
    for (int i = 0; i < 200000; ++i) {
        double value = std::ldexp(random.uniform(-1.0, 1.0), static_cast<int>(random.below(320)) - 160);
        if (i % 100 == 0) value = static_cast<float>(value);
        const float f = static_cast<float>(value);
        const float down = f > value ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
        const float up = f < value ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
        ASSERT_EQ(roundDown(value), down) << value;
        ASSERT_EQ(roundUp(value), up) << value;
    }
    EXPECT_EQ(roundDown(1e300), std::numeric_limits<float>::max());
    EXPECT_EQ(roundUp(1e300), std::numeric_limits<float>::infinity());
    EXPECT_TRUE(std::isnan(roundDown(std::numeric_limits<double>::quiet_NaN())));
}

}  // namespace
}  // namespace sightline
