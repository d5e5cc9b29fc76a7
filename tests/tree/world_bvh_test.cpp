// The laws of the hierarchy of a world: every item once, in a row of places below each node, with bounds that are tight.
// SPDX-License-Identifier: MIT
#include "sightline/tree/world_bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <map>

#include "sightline/tree/bvh_node.h"
#include "tests/tree/living_fixture.h"

namespace sightline::test {
namespace {

constexpr double kWorld = 100.0;

using Truth = std::map<uint32_t, Box3d>;

bool same(const Box3f& a, const Box3f& b) { return a.min == b.min && a.max == b.max; }

/// Looks at all of a tree. @returns how many nodes it has
uint32_t expectSound(const PlacedBvh& tree, const Truth& truth) {
    std::vector<int> met(tree.order.size(), 0);
    uint32_t nodes = 0;
    struct Visit {
        uint32_t node, first, end;
    };
    std::vector<Visit> stack;
    if (!tree.nodes.empty()) stack.push_back({0, 0, tree.order.size()});
    while (!stack.empty()) {
        const Visit visit = stack.back();
        stack.pop_back();
        ++nodes;
        const BvhNode& node = tree.nodes[visit.node];
        for (int slot = 0; slot < 8; ++slot) {
            const Box3f box = slotBox(node, slot);
            const uint32_t first = node.first[slot], count = node.count[slot], child = node.child[slot];
            if (count == 0) {
                EXPECT_TRUE(box.empty());
                EXPECT_EQ(child, kUnusedChild);
                continue;
            }
            EXPECT_GE(first, visit.first);
            EXPECT_LE(first + count, visit.end);
            uint32_t gone = 0;
            for (uint32_t place = first; place < first + count; ++place) gone += tree.order[place] == PlacedBvh::kNone;
            EXPECT_EQ(node.empty[slot], gone);
            if (child & BvhNode::kLeaf) {
                EXPECT_EQ(child & ~BvhNode::kLeaf, first);
                EXPECT_EQ(count, 1u);
                ++met[first];
                const uint32_t item = tree.order[first];
                const auto at = truth.find(item);
                if (at == truth.end()) {
                    ADD_FAILURE() << "item " << item << " has left";
                    continue;
                }
                EXPECT_TRUE(same(box, roundOutward(at->second, tree.origin))) << "item " << item;
                EXPECT_EQ(tree.slot[item], 8 * visit.node + static_cast<uint32_t>(slot));
                EXPECT_EQ(tree.placeOf(item), first);
            } else {
                EXPECT_TRUE(same(box, boundsOf(tree.nodes[child]))) << "a child's bounds are tight";
                stack.push_back({child, first, first + count});
            }
        }
    }
    size_t living = 0;
    for (uint32_t place = 0; place < tree.order.size(); ++place) {
        const bool empty = tree.order[place] == PlacedBvh::kNone;
        EXPECT_EQ(met[place], empty ? 0 : 1) << "place " << place;
        living += !empty;
    }
    EXPECT_EQ(living, truth.size());
    EXPECT_EQ(tree.size(), truth.size());
    for (uint32_t item = 0; item < tree.slot.size(); ++item)
        EXPECT_EQ(tree.placeOf(item) != PlacedBvh::kNone, truth.count(item) > 0) << "item " << item;
    return nodes;
}

bool meet(const Box3f& a, const Box3f& b) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(a.min[axis] <= b.max[axis] && b.min[axis] <= a.max[axis])) return false;
    return true;
}

/// The items whose slots, and all nodes above, `keeps` keeps; in rising order.
template <class Keeps>
std::vector<uint32_t> walk(const PlacedBvh& tree, Keeps keeps) {
    std::vector<uint32_t> kept, stack;
    if (!tree.nodes.empty()) stack.push_back(0);
    while (!stack.empty()) {
        const BvhNode& node = tree.nodes[stack.back()];
        stack.pop_back();
        const uint32_t slots = keeps(node);
        for (int slot = 0; slot < 8; ++slot) {
            if (node.count[slot] == 0 || !(slots >> slot & 1)) continue;
            if (node.child[slot] & BvhNode::kLeaf) kept.push_back(tree.order[node.first[slot]]);
            else stack.push_back(node.child[slot]);
        }
    }
    std::sort(kept.begin(), kept.end());
    return kept;
}

/// Boxes and views: what a walk of the tree finds is what all boxes one by one give.
void expectBruteForce(const PlacedBvh& tree, const Truth& truth, Random& random) {
    for (int query = 0; query < 8; ++query) {
        const Box3f range = roundOutward(randomBox(random, randomPoint(random, kWorld), kWorld), tree.origin);
        std::vector<uint32_t> expected;
        for (const auto& [item, box] : truth)
            if (meet(roundOutward(box, tree.origin), range)) expected.push_back(item);
        EXPECT_EQ(walk(tree,
                       [&](const BvhNode& node) {
                           uint32_t slots = 0;
                           for (int slot = 0; slot < 8; ++slot)
                               slots |= uint32_t{meet(slotBox(node, slot), range)} << slot;
                           return slots;
                       }),
                  expected);
        const Frustum frustum = makeFrustum(randomView(random, kWorld));
        const std::vector<uint32_t> kept = walk(tree, [&](const BvhNode& node) {
            return ~testFrustum(frustum, eyeBoxes(node, tree.origin - frustum.eye), 63).outside;
        });
        for (const auto& [item, box] : truth)
            EXPECT_TRUE(!touches(frustum, box) || std::binary_search(kept.begin(), kept.end(), item))
                << "item " << item;
    }
}

struct Both {
    WorldBvh tree;
    Truth truth;
    uint32_t next = 0;
    uint64_t placed = 0;  ///< places given out since the tree was built
    uint64_t inserted = 0, mended = 0, renewed = 0, in_batch = 0;

    void build() {
        std::vector<Box3d> boxes;
        std::vector<uint32_t> items;
        for (const auto& [item, box] : truth) {
            boxes.push_back(box);
            items.push_back(item);
        }
        tree.build(boxes, items);
    }
    void append(const std::vector<Box3d>& boxes, std::vector<uint32_t> items = {}) {
        for (size_t i = 0; i < boxes.size(); ++i) {
            if (items.size() <= i) items.push_back(next++);
            truth[items[i]] = boxes[i];
        }
        const uint32_t first = tree.append(boxes, items);
        ASSERT_LE(first, tree.now().order.size());
        placed += tree.now().order.size() - first;
    }
    void remove(uint32_t item) {
        const uint32_t place = tree.now().placeOf(item);
        ASSERT_EQ(tree.remove(item), place);
        ASSERT_FALSE(tree.contains(item));
        truth.erase(item);
    }
    /// Moves an item; what has strayed leaves and comes again.
    bool move(uint32_t item, const Box3d& box) {
        if (tree.move(item, box)) {
            truth[item] = box;
            return true;
        }
        remove(item);
        enter(item, box);
        return false;
    }
    void enter(uint32_t item, const Box3d& box) {
        truth[item] = box;
        const uint32_t place = tree.insert(item, box);
        if (place == WorldBvh::kNone) return append({box}, {item});
        ++inserted;
        ASSERT_EQ(tree.now().placeOf(item), place);
        ASSERT_EQ(tree.now().order[place], item);
    }
    /// Of the items in batches, gives some new boxes and builds all anew.
    void renew(Random& random) {
        std::vector<Box3d> boxes;
        std::vector<uint32_t> items;
        uint32_t in_batches = 0;
        const uint64_t one_of = 1 + random.below(3);
        for (auto& [item, box] : truth) {
            if (!tree.isInBatch(item)) continue;
            ++in_batches;
            if (random.below(one_of) > 0) continue;
            items.push_back(item);
            boxes.push_back(box = randomBox(random, randomPoint(random, kWorld), 0.1 * kWorld));
        }
        ASSERT_EQ(tree.inBatches(), in_batches);
        renewed += items.size();
        const std::vector<uint32_t> before = order();
        const uint32_t first = tree.renewBatches(boxes, items);
        const std::vector<uint32_t> after = order();
        ASSERT_LE(first, after.size());
        ASSERT_TRUE(std::equal(before.begin(), before.begin() + first, after.begin()));
        ASSERT_EQ(tree.inBatches(), in_batches);
        if (items.empty()) return;
        for (const auto& [item, box] : truth) ASSERT_EQ(tree.isInBatch(item), tree.now().placeOf(item) >= first);
    }
    /// Puts an item in again, if it finds a place in a batch.
    void enterBatch(uint32_t item) {
        const Box3d box = truth[item];
        remove(item);
        truth[item] = box;
        const uint32_t place = tree.insert(item, box, WorldBvh::Among::kBatches);
        if (place == WorldBvh::kNone) return append({box}, {item});
        ASSERT_TRUE(tree.isInBatch(item));
        ++in_batch;
    }
    void mend(bool check) {
        if (!check) {
            for (const WorldBvh::Places& places : tree.mend(1000)) mended += places.end - places.first;
            return;
        }
        const std::vector<uint32_t> before = order();
        std::vector<bool> anew(before.size(), false);
        for (const WorldBvh::Places& places : tree.mend(1000))
            for (uint32_t place = places.first; place < places.end; ++place) anew[place] = true;
        const std::vector<uint32_t> after = order();
        ASSERT_EQ(before.size(), after.size());
        for (size_t place = 0; place < after.size(); ++place) {
            ASSERT_TRUE(anew[place] || before[place] == after[place]) << "place " << place;
            mended += anew[place];
        }
    }
    std::vector<uint32_t> order() const {
        std::vector<uint32_t> all;
        for (uint32_t place = 0; place < tree.now().order.size(); ++place) all.push_back(tree.now().order[place]);
        return all;
    }
    uint32_t any(Random& random) const {
        auto at = truth.lower_bound(static_cast<uint32_t>(random.below(next)));
        return at == truth.end() ? truth.begin()->first : at->first;
    }
};

TEST(WorldBvh, HoldsEveryItemOnceWhateverComesMovesAndGoes) {
    uint64_t strayed = 0, built = 0, inserted = 0, mended = 0, renewed = 0, in_batch = 0;
    for (uint64_t seed = 1; seed <= 30; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        Both both;
        const uint32_t changes = changesToMake(30000) / 30;
        const uint32_t check = std::max(changes / 20, 1u);  // looking at all of a tree takes long
        const double largest = seed % 2 ? kWorld : 0.05 * kWorld;
        for (uint32_t step = 0; step < changes; ++step) {
            const uint64_t kind = random.below(10);
            if (both.truth.empty() || kind == 0) {
                std::vector<Box3d> boxes(both.truth.empty() ? 2000 : random.below(random.below(4) ? 8 : 300));
                for (Box3d& box : boxes) box = randomBox(random, randomPoint(random, kWorld), largest);
                if (random.below(2)) both.append(boxes);
                else
                    for (const Box3d& box : boxes) both.enter(both.next++, box);
            } else if (kind <= 2 && both.truth.size() > 1) {
                for (uint64_t left = random.below(30); left > 0 && !both.truth.empty(); --left)
                    both.remove(both.any(random));
            } else {
                const uint32_t item = both.any(random);
                const double way = random.below(20) ? 0.5 : kWorld;
                const glm::dvec3 by = randomPoint(random, way);
                strayed += !both.move(item, {both.truth[item].min + by, both.truth[item].max + by});
            }
            if (random.below(60) == 0) both.renew(random);
            if (random.below(30) == 0 && !both.truth.empty()) both.enterBatch(both.any(random));
            if (step % 7 == 0) both.mend(step % std::max(check / 50, 1u) == 0);
            if (both.tree.isWorn()) {
                both.build();
                ++built;
                ASSERT_FALSE(both.tree.isWorn());
            }
            ASSERT_EQ(both.tree.size(), both.truth.size());
            if (step % check == 0) {
                expectSound(both.tree.share(), both.truth);
                expectBruteForce(both.tree.share(), both.truth, random);
            }
            if (testing::Test::HasFailure()) return;
        }
        expectSound(both.tree.share(), both.truth);
        inserted += both.inserted;
        mended += both.mended;
        renewed += both.renewed;
        in_batch += both.in_batch;
    }
    EXPECT_GT(strayed, 100u);
    EXPECT_GT(inserted, 1000u);
    EXPECT_GT(mended, 1000u);
    EXPECT_GT(renewed, 1000u);
    EXPECT_GT(in_batch, 100u);
    EXPECT_GT(built, 30u);
}

TEST(WorldBvh, ASharedTreeStaysAsItWas) {
    Random random(5);
    Both both;
    std::vector<Box3d> boxes(3000);
    for (Box3d& box : boxes) box = randomBox(random, randomPoint(random, kWorld), kWorld);
    both.append(boxes);
    std::vector<std::pair<PlacedBvh, Truth>> kept;
    for (int round = 0; round < 12; ++round) {
        kept.emplace_back(both.tree.share(), both.truth);
        for (int i = 0; i < 40; ++i) {
            const uint32_t item = both.any(random);
            const glm::dvec3 by = randomPoint(random, i % 4 ? 1.0 : kWorld);
            both.move(item, {both.truth[item].min + by, both.truth[item].max + by});
            both.remove(both.any(random));
        }
        both.append({boxes.begin(), boxes.begin() + 30 * (round % 3)});
    }
    for (const auto& [tree, truth] : kept) expectSound(tree, truth);
}

TEST(WorldBvh, OneByOneNoItemIsPlacedMoreOftenThanLogarithmically) {
    Random random(6);
    Both both;
    std::vector<Box3d> boxes(40000);
    for (Box3d& box : boxes) box = randomBox(random, randomPoint(random, kWorld), kWorld);
    both.append(boxes);
    both.placed = 0;
    constexpr uint32_t kCame = 4096;
    for (uint32_t i = 0; i < kCame; ++i) both.append({boxes[i]});
    EXPECT_FALSE(both.tree.isWorn());
    EXPECT_LE(both.placed, 2 * uint64_t{kCame} * std::bit_width(kCame));
    expectSound(both.tree.share(), both.truth);
}

TEST(WorldBvh, WhatWandersOffStraysAndSwarmsThatMoveTogetherDoNot) {
    Random random(7);
    Both both;
    std::vector<Box3d> boxes;
    for (int i = 0; i < 4096; ++i) {
        const glm::dvec3 at(i % 64, 0, i / 64);
        boxes.push_back({at, at + 0.5});
    }
    both.append(boxes);
    EXPECT_TRUE(both.tree.move(100, {boxes[100].min + 0.3, boxes[100].max + 0.3}));
    const PlacedBvh before = both.tree.share();
    EXPECT_FALSE(both.tree.move(200, {boxes[200].min + 500.0, boxes[200].max + 500.0}));
    const uint32_t at = both.tree.now().slot[200];
    EXPECT_TRUE(same(slotBox(both.tree.now().nodes[at / 8], static_cast<int>(at % 8)),
                     slotBox(before.nodes[at / 8], static_cast<int>(at % 8))));
    uint32_t strayed = 0;
    for (int frame = 1; frame <= 300; ++frame)
        for (uint32_t item = 0; item < 4096; ++item)
            strayed += !both.move(item, {boxes[item].min + 0.1 * frame, boxes[item].max + 0.1 * frame});
    EXPECT_EQ(strayed, 0u);
}

TEST(WorldBvh, BuildsOverAnyNumber) {
    for (const uint32_t count : {0u, 1u, 2u, 8u, 9u, 65u, 5000u}) {
        SCOPED_TRACE(count);
        Random random(count);
        Both both;
        for (; both.next < count; ++both.next)
            both.truth[both.next] = randomBox(random, randomPoint(random, kWorld), kWorld);
        both.build();
        expectSound(both.tree.share(), both.truth);
        for (uint32_t i = 0; i < 200; ++i) {
            both.enter(both.next++, randomBox(random, randomPoint(random, kWorld), kWorld));
            both.remove(both.any(random));
        }
        expectSound(both.tree.share(), both.truth);
        while (!both.truth.empty()) both.remove(both.any(random));
        expectSound(both.tree.share(), both.truth);
        EXPECT_EQ(both.tree.now().reach(), 0.0f);
    }
}

TEST(WorldBvh, HoldsManyItemsInOnePlace) {
    Both both;
    for (; both.next < 3000; ++both.next) both.truth[both.next] = {glm::dvec3(1.0), glm::dvec3(1.0)};
    both.build();
    expectSound(both.tree.share(), both.truth);
}

TEST(WorldBvh, IsTheSameTreeForTheSameCalls) {
    std::vector<uint32_t> orders[2];
    for (std::vector<uint32_t>& order : orders) {
        Random random(8);
        Both both;
        both.append(std::vector<Box3d>(1000, {glm::dvec3(0.0), glm::dvec3(1.0)}));
        for (int i = 0; i < 5000; ++i) {
            both.move(both.any(random), randomBox(random, randomPoint(random, kWorld), 0.1 * kWorld));
            if (i % 100 == 0) both.mend(false);
        }
        order = both.order();
    }
    EXPECT_EQ(orders[0], orders[1]);
}

TEST(WorldBvh, AFewMovesTouchFewNodes) {
    Random random(9);
    Both both;
    std::vector<Box3d> boxes;
    for (int i = 0; i < 50000; ++i) {
        const glm::dvec3 at = randomPoint(random, kWorld);
        boxes.push_back({at, at + 0.5});
    }
    both.append(boxes);
    const PlacedBvh before = both.tree.share();
    ASSERT_TRUE(both.tree.move(77, {boxes[77].min + 0.01, boxes[77].max + 0.01}));
    const PlacedBvh& after = both.tree.now();
    uint32_t copied = 0;
    for (uint32_t i = 0; i < after.nodes.size(); i += 32) copied += &after.nodes[i] != &before.nodes[i];
    EXPECT_LE(copied, 12u);
    EXPECT_GE(after.nodes.size(), 32 * 200u);
}

/// Sum over a tree's nodes of their surface.
double surfaceOf(const PlacedBvh& tree) {
    double sum = 0;
    std::vector<uint32_t> stack{0};
    while (!stack.empty()) {
        const BvhNode& node = tree.nodes[stack.back()];
        stack.pop_back();
        sum += halfArea(boundsOf(node));
        for (int slot = 0; slot < 8; ++slot)
            if (node.count[slot] > 0 && !(node.child[slot] & BvhNode::kLeaf)) stack.push_back(node.child[slot]);
    }
    return sum;
}

TEST(WorldBvh, BatchesThatAreBuiltQuicklyAreNotMuchWorse) {
    constexpr uint32_t kCount = 3000;
    Random random(23);
    Both both;
    both.append(std::vector<Box3d>(kCount, {glm::dvec3(0.0), glm::dvec3(1.0)}));
    std::vector<Box3d> boxes;
    std::vector<uint32_t> items;
    for (uint32_t i = 0; i < kCount; ++i) {
        const glm::dvec3 at = randomPoint(random, kWorld);
        boxes.push_back({at, at + 1.0});
        items.push_back(kCount + i);
    }
    both.append(boxes);
    const double well = surfaceOf(both.tree.now());
    ASSERT_EQ(both.tree.inBatches(), kCount);
    both.tree.renewBatches(boxes, items);
    expectSound(both.tree.share(), both.truth);
    EXPECT_LT(surfaceOf(both.tree.now()), 1.5 * well);
    EXPECT_NE(surfaceOf(both.tree.now()), well);
}

TEST(WorldBvh, StaysAboutAsGoodAsFreshWhenAllGoAstray) {
    constexpr uint32_t kCount = 4000;
    Random random(17);
    Both both;
    for (; both.next < kCount; ++both.next) {
        const glm::dvec3 at = randomPoint(random, kWorld);
        both.truth[both.next] = {at, at + 1.0};
    }
    both.build();
    for (int frame = 0; frame < 60; ++frame) {
        for (uint32_t item = 0; item < kCount; ++item) {
            const glm::dvec3 by = randomPoint(random, 3.0);
            both.move(item, {both.truth[item].min + by, both.truth[item].max + by});
        }
        both.mend(false);
        if (both.tree.isWorn()) both.build();
    }
    const double cost = surfaceOf(both.tree.now());
    both.build();
    EXPECT_LT(cost, 1.9 * surfaceOf(both.tree.now()));
    EXPECT_GT(both.mended, 0u);
}

}  // namespace
}  // namespace sightline::test
