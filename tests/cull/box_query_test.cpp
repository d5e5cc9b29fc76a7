// The law of box queries: on every instruction set, trees and lists give just the items whose stored boxes overlap the box.
// SPDX-License-Identifier: MIT
#include "sightline/cull/box_query.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "sightline/base/random.h"
#include "tests/support/targets.h"

namespace sightline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double powerOf(Random& random, double low, double high) { return std::pow(10.0, random.uniform(low, high)); }

glm::dvec3 pointIn(Random& random, double half) {
    const double x = random.uniform(-half, half), y = random.uniform(-half, half);
    return {x, y, random.uniform(-half, half)};
}

/// Points, needles, plates and lumps, some of them far larger than the rest.
Box3d boxIn(Random& random, const glm::dvec3& middle, double half) {
    const glm::dvec3 center = middle + pointIn(random, half);
    glm::dvec3 size(0.0);
    for (int axis = 0; axis < 3; ++axis)
        if (random.below(5) != 0) size[axis] = half * powerOf(random, -4.0, -0.3);
    return {center - size, center + size};
}

/// What should be found: one by one, in double, over the boxes as they are stored.
std::vector<uint32_t> bruteForce(const Box3d& box, const std::vector<Box3f>& stored, const glm::dvec3& origin) {
    const Box3f asked = roundOutward(box, origin);
    std::vector<uint32_t> found;
    for (uint32_t i = 0; i < stored.size(); ++i) {
        bool overlap = true;
        for (int axis = 0; axis < 3; ++axis) {
            if (box.min[axis] > box.max[axis]) overlap = false;  // an empty one
            if (double{stored[i].min[axis]} > double{asked.max[axis]}) overlap = false;
            if (double{stored[i].max[axis]} < double{asked.min[axis]}) overlap = false;
        }
        if (overlap) found.push_back(i);
    }
    return found;
}

/// The same boxes in all that can be asked.
struct Worlds {
    glm::dvec3 middle;  ///< origin of the tree and of the list
    std::vector<Box3d> boxes;
    WorldBvh tree;
    std::vector<float> bounds[6];
    BoxArrays flat;
    HierarchyScratch scratch;
    std::vector<uint32_t> kept;

    Worlds(Random& random, size_t count, const glm::dvec3& around) : kept((count + 15) / 16 * 16 + 8) {
        std::vector<uint32_t> items;
        for (uint32_t i = 0; i < count; ++i) {
            boxes.push_back(boxIn(random, around, 100.0));
            items.push_back(i);
        }
        tree.build(boxes, items);
        middle = tree.now().origin;
        list();
    }
    void list() {
        for (auto& bound : bounds) bound.assign((boxes.size() + 15) / 16 * 16, 0.0f);
        for (size_t i = 0; i < boxes.size(); ++i) {
            const Box3f box = roundOutward(boxes[i], middle);
            for (int axis = 0; axis < 3; ++axis) bounds[axis][i] = box.min[axis], bounds[3 + axis][i] = box.max[axis];
        }
        for (int axis = 0; axis < 3; ++axis)
            flat.min[axis] = bounds[axis].data(), flat.max[axis] = bounds[3 + axis].data();
        flat.count = boxes.size();
        flat.origin = middle;
    }
    std::vector<Box3f> stored() const {
        std::vector<Box3f> out;
        for (const Box3d& box : boxes) out.push_back(roundOutward(box, middle));
        return out;
    }
    std::vector<uint32_t> sorted(size_t count) const {
        std::vector<uint32_t> found(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(count));
        std::sort(found.begin(), found.end());
        return found;
    }
    void expectExact(const Box3d& box) {
        const std::vector<uint32_t> expected = bruteForce(box, stored(), middle);
        EXPECT_EQ(sorted(queryBox(box, tree.now(), scratch, kept)), expected);
        const size_t count = queryBox(box, flat, kept);
        ASSERT_EQ(count, expected.size());
        EXPECT_TRUE(std::equal(expected.begin(), expected.end(), kept.begin()));  // in rising order
    }
};

}  // namespace

TEST(BoxQuery, FindsWhatBruteForceFinds) {
    Random random(1);
    size_t found = 0, asked = 0;
    for (const size_t count : {1u, 7u, 8u, 9u, 65u, 1000u}) {
        for (const double away : {0.0, 1e3, 1e7}) {
            Worlds worlds(random, count, away * glm::dvec3(1.0, -0.7, 0.3));
            std::vector<Box3d> asked_boxes{{worlds.middle - 1000.0, worlds.middle + 1000.0}, worlds.boxes[0]};
            for (int i = 0; i < 30; ++i) asked_boxes.push_back(boxIn(random, worlds.middle, 120.0));
            // One that just touches an item, on a side that float has.
            asked_boxes.push_back(worlds.boxes[0]);
            asked_boxes.back().max.x = asked_boxes.back().min.x;
            test::forEachTarget([&](const std::string& target) {
                SCOPED_TRACE(target);
                for (const Box3d& box : asked_boxes) worlds.expectExact(box);
            });
            for (const Box3d& box : asked_boxes) {
                found += queryBox(box, worlds.flat, worlds.kept);
                asked += count;
            }
        }
    }
    EXPECT_GT(found, asked / 100);  // else nothing was tested
    EXPECT_LT(found, asked / 2);
}

TEST(BoxQuery, NeverMissesATrueOverlapFarFromTheOrigin) {
    Random random(2);
    size_t overlaps = 0;
    for (int round = 0; round < 20; ++round) {
        Worlds worlds(random, 300, 1e8 * pointIn(random, 1.0));
        for (int i = 0; i < 20; ++i) {
            // It touches an item in a face, and may meet others.
            Box3d box = worlds.boxes[random.below(300)];
            const int axis = static_cast<int>(random.below(3));
            box.max[axis] = box.min[axis];
            box.min[axis] -= random.uniform(0.0, 30.0);
            std::vector<bool> is_found(worlds.boxes.size(), false);
            const size_t count = queryBox(box, worlds.tree.now(), worlds.scratch, worlds.kept);
            for (size_t k = 0; k < count; ++k) is_found[worlds.kept[k]] = true;
            for (size_t item = 0; item < worlds.boxes.size(); ++item) {
                const Box3d& other = worlds.boxes[item];
                if (glm::any(glm::greaterThan(other.min, box.max)) || glm::any(glm::lessThan(other.max, box.min)))
                    continue;
                ++overlaps;
                EXPECT_TRUE(is_found[item]) << "round " << round << ", item " << item;
            }
        }
    }
    EXPECT_GE(overlaps, 400u);
}

TEST(BoxQuery, LeavesOpenWhatIsInfiniteOrNoNumber) {
    Random random(3);
    Worlds worlds(random, 200, glm::dvec3(0.0));
    test::forEachTarget([&](const std::string& target) {
        SCOPED_TRACE(target);
        for (const double open : {kInfinity, kNan}) {
            Box3d box{glm::dvec3(-kInfinity, -20.0, -30.0), glm::dvec3(open, 30.0, 20.0)};
            if (std::isnan(open)) box.min.x = kNan;
            const Box3d closed{glm::dvec3(-1e6, -20.0, -30.0), glm::dvec3(1e6, 30.0, 20.0)};
            const std::vector<uint32_t> expected = bruteForce(closed, worlds.stored(), worlds.middle);
            ASSERT_GT(expected.size(), 0u);
            ASSERT_LT(expected.size(), worlds.boxes.size());
            EXPECT_EQ(worlds.sorted(queryBox(box, worlds.tree.now(), worlds.scratch, worlds.kept)), expected);
            EXPECT_EQ(worlds.sorted(queryBox(box, worlds.flat, worlds.kept)), expected);
        }
        const Box3d everything{glm::dvec3(-kInfinity), glm::dvec3(kInfinity)};
        EXPECT_EQ(queryBox(everything, worlds.tree.now(), worlds.scratch, worlds.kept), 200u);
        EXPECT_EQ(queryBox(everything, worlds.flat, worlds.kept), 200u);
    });
}

TEST(BoxQuery, FindsNothingInAnEmptyBoxOrAnEmptyTree) {
    Random random(4);
    Worlds worlds(random, 200, glm::dvec3(0.0));
    Box3d inverted{glm::dvec3(-50.0), glm::dvec3(50.0)};
    std::swap(inverted.min.y, inverted.max.y);
    for (const Box3d& box : {Box3d(), inverted}) {
        EXPECT_EQ(queryBox(box, worlds.tree.now(), worlds.scratch, worlds.kept), 0u);
        EXPECT_EQ(queryBox(box, worlds.flat, worlds.kept), 0u);
    }
    const Box3d unit{glm::dvec3(0.0), glm::dvec3(1.0)};
    EXPECT_EQ(queryBox(unit, WorldBvh().now(), worlds.scratch, worlds.kept), 0u);
    EXPECT_EQ(queryBox(unit, BoxArrays{}, worlds.kept), 0u);
}

TEST(BoxQuery, HoldsWhileATreeLives) {
    Random random(5);
    Worlds worlds(random, 500, glm::dvec3(10.0));
    for (int frame = 0; frame < 20; ++frame) {
        for (int i = 0; i < 100; ++i) {
            const uint32_t item = static_cast<uint32_t>(random.below(500));
            const Box3d box = boxIn(random, worlds.middle, 150.0);
            worlds.boxes[item] = box;
            if (worlds.tree.move(item, box)) continue;
            worlds.tree.remove(item);
            if (worlds.tree.insert(item, box) == WorldBvh::kNone) worlds.tree.append({&box, 1}, {&item, 1});
        }
        if (frame % 3) worlds.tree.mend(100);
        for (int i = 0; i < 20; ++i) {
            const Box3d box = boxIn(random, worlds.middle, 150.0);
            EXPECT_EQ(worlds.sorted(queryBox(box, worlds.tree.now(), worlds.scratch, worlds.kept)),
                      bruteForce(box, worlds.stored(), worlds.middle));
        }
    }
}

TEST(BoxQuery, LooksAtLittleWhereTheBoxIsSmallOrHoldsAll) {
    Random random(6);
    std::vector<Box3d> boxes;
    std::vector<uint32_t> items;
    for (uint32_t i = 0; i < 20000; ++i) {
        const glm::dvec3 at = pointIn(random, 100.0);
        boxes.push_back({at, at + 0.5});
        items.push_back(i);
    }
    WorldBvh tree;
    tree.build(boxes, items);
    HierarchyScratch scratch;
    std::vector<uint32_t> kept(boxes.size() + 8);
    HierarchyStats stats;
    queryBox({glm::dvec3(-2.0), glm::dvec3(2.0)}, tree.now(), scratch, kept, &stats);
    EXPECT_GT(stats.nodes, 0u);
    EXPECT_LT(stats.nodes, tree.now().nodes.size() / 20);
    EXPECT_EQ(queryBox({glm::dvec3(-200.0), glm::dvec3(200.0)}, tree.now(), scratch, kept, &stats), boxes.size());
    EXPECT_EQ(stats.nodes, 1u);
}

}  // namespace sightline
