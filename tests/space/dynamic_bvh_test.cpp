// The laws of the hierarchy that lives: it equals the flat list whatever happens, and its bounds hold and are tight.
// SPDX-License-Identifier: MIT
#include "sightline/space/dynamic_bvh.h"

#include <gtest/gtest.h>

#include <thread>

#include "sightline/cull/hierarchy.h"
#include "sightline/math/round_outward.h"
#include "sightline/space/bvh_node.h"
#include "tests/space/living_fixture.h"

namespace sightline::test {
namespace {

constexpr double kWorld = 100.0;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();

/// A tree and a plain list of what should be in it.
struct Both {
    DynamicBvh tree;
    std::vector<Box3d> boxes;  ///< per item
    std::vector<bool> there;   ///< per item
    std::vector<uint32_t> items;

    explicit Both(const DynamicBvhDef& def = {}) : tree(def) {}

    void insert(const Box3d& box, const glm::dvec3& displacement = glm::dvec3(0.0)) {
        const uint32_t item = tree.insert(box, displacement);
        if (item >= boxes.size()) {
            boxes.resize(item + 1);
            there.resize(item + 1, false);
        }
        ASSERT_FALSE(there[item]) << "item " << item << " was handed out twice";
        there[item] = true;
        boxes[item] = box;
        items.push_back(item);
    }
    void move(size_t which, const Box3d& box, const glm::dvec3& displacement = glm::dvec3(0.0)) {
        boxes[items[which]] = box;
        ASSERT_TRUE(tree.move(items[which], box, displacement));
    }
    void remove(size_t which) {
        ASSERT_TRUE(tree.remove(items[which]));
        ASSERT_FALSE(tree.contains(items[which]));
        ASSERT_FALSE(tree.remove(items[which]));
        there[items[which]] = false;
        items[which] = items.back();
        items.pop_back();
    }
    /// One of all kinds of change.
    void changeAtRandom(Random& random, size_t wanted) {
        const uint64_t kind = random.below(8);
        if (items.empty() || (kind == 0 && items.size() < 2 * wanted) || items.size() < wanted / 2)
            return insert(randomBox(random, randomPoint(random, kWorld), kWorld));
        const size_t which = random.below(items.size());
        if (kind == 1) return remove(which);
        Box3d box = boxes[items[which]];
        if (kind == 2 || !box.finite()) return move(which, randomBox(random, randomPoint(random, kWorld), kWorld));
        const glm::dvec3 by = randomPoint(random, kind == 3 ? 10.0 : 0.5);
        move(which, {box.min + by, box.max + by});
    }
};

/// Every item once; every slot's box around all below, and no larger if it should be tight.
void expectSound(const Both& both, bool tight) {
    const LivingBvh& tree = both.tree.now();
    ASSERT_EQ(tree.count, both.items.size());
    std::vector<int> met(both.boxes.size(), 0);
    for (uint32_t item : tree.unbounded) ++met[item];
    struct Visit {
        uint32_t node;
        Box3f outer;
    };
    std::vector<Visit> stack;
    if (tree.root != LivingBvh::kNone) stack.push_back({tree.root, boundsOf(tree.node(tree.root))});
    while (!stack.empty()) {
        const Visit visit = stack.back();
        stack.pop_back();
        const BvhNode& node = tree.node(visit.node);
        const Box3f bounds = boundsOf(node);
        ASSERT_TRUE(holds(visit.outer, bounds));
        ASSERT_TRUE(!tight || holds(bounds, visit.outer));
        int used = 0;
        for (int slot = 0; slot < 8; ++slot) {
            if (node.count[slot] == 0) {
                ASSERT_EQ(node.child[slot], kUnusedChild);
                ASSERT_TRUE(slotBox(node, slot).empty());
                continue;
            }
            ++used;
            const Box3f box = slotBox(node, slot);
            ASSERT_TRUE(box.finite());
            if (!(node.child[slot] & BvhNode::kLeaf)) {
                stack.push_back({node.child[slot], box});
                continue;
            }
            const uint32_t item = node.child[slot] & ~BvhNode::kLeaf;
            ++met[item];
            const Box3f now = both.tree.storedBox(item);
            ASSERT_TRUE(holds(now, box) && holds(box, now));
            ASSERT_TRUE(holds(box, relativeBox(both.boxes[item], tree.origin)));
        }
        ASSERT_GT(used, 0);
    }
    for (size_t item = 0; item < met.size(); ++item) ASSERT_EQ(met[item], both.there[item]) << "item " << item;
}

std::vector<uint32_t> keptByTree(const Frustum& frustum, const LivingBvh& tree) {
    HierarchyScratch scratch;
    std::vector<uint32_t> kept(tree.count + 8);
    kept.resize(cullHierarchy(frustum, tree, scratch, kept));
    std::sort(kept.begin(), kept.end());
    return kept;
}

/// To the bit what a flat list of the stored boxes keeps; and nothing that touches is missing.
void expectEqualsFlat(const Both& both, uint64_t seed, int views = 4) {
    SCOPED_TRACE(seed);
    Random random(seed);
    std::vector<Box3f> stored;
    for (uint32_t item : both.items) stored.push_back(both.tree.storedBox(item));
    for (int i = 0; i < views; ++i) {
        const Frustum frustum = makeFrustum(randomView(random, kWorld));
        const LivingBvh& tree = both.tree.now();
        const std::vector<uint32_t> kept = keptByTree(frustum, tree);
        std::vector<uint32_t> flat;
        for (uint32_t which : keptByFlat(frustum, stored, tree.origin, tree.reach())) flat.push_back(both.items[which]);
        std::sort(flat.begin(), flat.end());
        ASSERT_EQ(kept, flat);
        for (uint32_t item : both.items)
            ASSERT_TRUE((both.boxes[item].finite() && !touches(frustum, both.boxes[item])) ||
                        std::binary_search(kept.begin(), kept.end(), item))
                << "item " << item;
    }
}

TEST(DynamicBvh, EqualsAFlatListUnderRandomChanges) {
    for (const bool rotations : {true, false}) {
        DynamicBvhDef def;
        def.rotations = rotations;
        def.origin = {3.0, -5.0, 7.0};
        Both both(def);
        Random random(41 + rotations);
        const uint32_t changes = changesToMake(60000);
        for (uint32_t i = 0; i < changes; ++i) {
            ASSERT_NO_FATAL_FAILURE(both.changeAtRandom(random, 3000));
            if (i % 300 == 299 && random.below(4)) both.tree.update();
            if (i % (changes / 20) == 0) {
                ASSERT_NO_FATAL_FAILURE(expectSound(both, false));
                ASSERT_NO_FATAL_FAILURE(expectEqualsFlat(both, i));
                both.tree.update();
                ASSERT_NO_FATAL_FAILURE(expectSound(both, true));
                ASSERT_NO_FATAL_FAILURE(expectEqualsFlat(both, i + 1));
            }
        }
        while (!both.items.empty()) {
            both.remove(random.below(both.items.size()));
            if (both.items.size() % 500 == 3) both.tree.update();
            if (both.items.size() % 400 != 0) continue;
            ASSERT_NO_FATAL_FAILURE(expectSound(both, false));
        }
        EXPECT_EQ(both.tree.now().root, LivingBvh::kNone);
    }
}

TEST(DynamicBvh, IsTheSameTreeForTheSameCalls) {
    std::vector<uint32_t> answers[2];
    for (std::vector<uint32_t>& answer : answers) {
        Both both;
        Random random(5);
        for (int i = 0; i < 20000; ++i) {
            both.changeAtRandom(random, 1000);
            if (i % 500 == 0) both.tree.update();
        }
        HierarchyScratch scratch;
        answer.resize(both.tree.size() + 8);
        const Frustum frustum = makeFrustum(randomView(random, kWorld));
        answer.resize(cullHierarchy(frustum, both.tree.now(), scratch, answer));
    }
    EXPECT_EQ(answers[0], answers[1]) << "in this order, too";
}

TEST(DynamicBvh, BuildsAndRebuildsOverAnyNumber) {
    for (const size_t count : {0u, 1u, 2u, 8u, 9u, 65u, 5000u}) {
        Random random(count);
        Both both;
        for (size_t i = 0; i < count; ++i) both.boxes.push_back(randomBox(random, randomPoint(random, kWorld), kWorld));
        if (count > 5) both.boxes[3].max.x = kNan;
        both.there.assign(count, true);
        for (uint32_t i = 0; i < count; ++i) both.items.push_back(i);
        both.tree.build(both.boxes);
        ASSERT_NO_FATAL_FAILURE(expectSound(both, true));
        ASSERT_NO_FATAL_FAILURE(expectEqualsFlat(both, count));
        for (int i = 0; i < 200; ++i) ASSERT_NO_FATAL_FAILURE(both.changeAtRandom(random, count));
        both.tree.rebuild();
        ASSERT_NO_FATAL_FAILURE(expectSound(both, true));
        for (int i = 0; i < 200; ++i) ASSERT_NO_FATAL_FAILURE(both.changeAtRandom(random, count));
        both.tree.update();
        ASSERT_NO_FATAL_FAILURE(expectSound(both, true));
        ASSERT_NO_FATAL_FAILURE(expectEqualsFlat(both, count));
    }
}

TEST(DynamicBvh, KeepsApartWhatHasNoBounds) {
    Both both;
    Random random(9);
    for (int i = 0; i < 500; ++i) both.insert(randomBox(random, randomPoint(random, kWorld), kWorld));
    const Box3d plain{glm::dvec3(1.0), glm::dvec3(2.0)};
    std::vector<Box3d> bad(8, plain);
    bad[0].min.x = kNan;
    bad[1].max.z = kInf;
    bad[2].min.y = -kInf;
    bad[3] = {glm::dvec3(kNan), glm::dvec3(kNan)};
    bad[4] = Box3d();                 // empty
    bad[5] = {plain.max, plain.min};  // inside out
    bad[6].max.x = 1e19;              // its surface does not fit into float
    bad[7] = {glm::dvec3(-1e300), glm::dvec3(1e300)};
    for (const Box3d& box : bad) {
        both.move(7, box);
        EXPECT_EQ(both.tree.now().unbounded.size(), 1u);
        EXPECT_TRUE(both.tree.storedBox(both.items[7]).empty());
        ASSERT_NO_FATAL_FAILURE(expectSound(both, false));
        both.move(9, box);
        both.insert(box);
        EXPECT_EQ(both.tree.now().unbounded.size(), 3u);
        both.tree.update();
        ASSERT_NO_FATAL_FAILURE(expectSound(both, true));
        Random views(3);
        const std::vector<uint32_t> kept = keptByTree(makeFrustum(randomView(views, kWorld)), both.tree.now());
        for (const uint32_t item : {both.items[7], both.items[9], both.items.back()})
            EXPECT_TRUE(std::binary_search(kept.begin(), kept.end(), item)) << "always visible";
        both.remove(both.items.size() - 1);
        both.move(9, plain);
    }
    both.move(7, plain, glm::dvec3(kNan, 0.0, 0.0));
    EXPECT_EQ(both.tree.now().unbounded.size(), 1u) << "nobody knows how far it goes";
    both.move(7, plain);
    EXPECT_TRUE(both.tree.now().unbounded.empty());
    both.tree.update();
    ASSERT_NO_FATAL_FAILURE(expectSound(both, true));
}

TEST(DynamicBvh, KnowsNothingOfItemsThatWereNeverThere) {
    DynamicBvh tree;
    EXPECT_FALSE(tree.remove(0));
    EXPECT_FALSE(tree.move(7, {glm::dvec3(0.0), glm::dvec3(1.0)}));
    EXPECT_FALSE(tree.contains(DynamicBvh::kNone));
    EXPECT_EQ(tree.update().refitted, 0u);
    EXPECT_TRUE(keptByTree(Frustum(), tree.now()).empty());
}

TEST(DynamicBvh, MarginsAndMotionHoldTheWayAndSpareTheWork) {
    DynamicBvhDef def;
    def.margin = 0.5;
    Both both(def);
    Random random(21);
    std::vector<glm::dvec3> velocity;
    for (int i = 0; i < 2000; ++i) {
        velocity.push_back(randomPoint(random, 0.2));
        both.insert(randomBox(random, randomPoint(random, kWorld), kWorld), 8.0 * velocity.back());
    }
    both.tree.update();
    uint64_t refitted = 0;
    for (int frame = 0; frame < 24; ++frame) {
        for (size_t i = 0; i < velocity.size(); ++i) {
            const Box3d box = both.boxes[both.items[i]];
            both.move(i, {box.min + velocity[i], box.max + velocity[i]}, 8.0 * velocity[i]);
        }
        const uint32_t now = both.tree.update().refitted;
        EXPECT_TRUE(now == 0 || frame >= 8) << "the way was in the bounds already";
        refitted += now;
        ASSERT_NO_FATAL_FAILURE(expectSound(both, true));
        ASSERT_NO_FATAL_FAILURE(expectEqualsFlat(both, static_cast<uint64_t>(frame), 1));
    }
    EXPECT_GT(refitted, 0u) << "at last they have left";
    // What stops and shrinks does not keep its large box for ever.
    both.move(0, {glm::dvec3(0.0), glm::dvec3(1.0)});
    EXPECT_LT(both.tree.storedBox(both.items[0]).size().x, 2.01f);
}

TEST(DynamicBvh, SnapshotsStayAsTheyWereWhileTheTreeGoesOn) {
    Both both;
    Random random(31);
    for (int i = 0; i < 3000; ++i) both.insert(randomBox(random, randomPoint(random, kWorld), kWorld));
    both.tree.update();
    const std::shared_ptr<const LivingBvh> held = both.tree.snapshot();
    Random views(1);
    std::vector<Frustum> frusta;
    std::vector<std::vector<uint32_t>> before;
    for (int i = 0; i < 20; ++i) {
        frusta.push_back(makeFrustum(randomView(views, kWorld)));
        before.push_back(keptByTree(frusta.back(), *held));
    }
    std::thread reader([&] {
        for (int round = 0; round < 20; ++round)
            for (size_t i = 0; i < frusta.size(); ++i) EXPECT_EQ(keptByTree(frusta[i], *held), before[i]);
    });
    for (int i = 0; i < 20000; ++i) {
        both.changeAtRandom(random, 3000);
        if (i % 1000 == 0) both.tree.update();
        if (i % 3000 == 0) both.tree.snapshot();
    }
    reader.join();
    for (size_t i = 0; i < frusta.size(); ++i) EXPECT_EQ(keptByTree(frusta[i], *held), before[i]);
    both.tree.build({});
    EXPECT_EQ(keptByTree(frusta[0], *held), before[0]);
}

TEST(DynamicBvh, AFewMovesTouchFewNodes) {
    std::vector<Box3d> boxes;
    Random random(8);
    for (int i = 0; i < 50000; ++i) {
        const glm::dvec3 at = randomPoint(random, kWorld);
        boxes.push_back({at, at + 0.5});
    }
    DynamicBvh tree;
    tree.build(boxes);
    EXPECT_EQ(tree.update().refitted, 0u);
    tree.move(77, {boxes[77].min + 0.01, boxes[77].max + 0.01});
    EXPECT_LE(tree.update().refitted, 12u);
    const std::shared_ptr<const LivingBvh> before = tree.snapshot();
    tree.move(77, boxes[77]);
    tree.update();
    const LivingBvh& after = tree.now();
    uint32_t copied = 0;
    for (uint32_t i = 0; i < after.nodes.size(); i += 32) copied += &after.nodes[i] != &before->nodes[i];
    EXPECT_LE(copied, 12u);
    EXPECT_GE(after.nodes.size(), 32 * 200u);
}

TEST(DynamicBvh, StaysAboutAsGoodAsFreshWhenAllGoAstray) {
    constexpr uint32_t kCount = 4000;
    Both both;
    Random random(17);
    for (uint32_t i = 0; i < kCount; ++i) {
        const glm::dvec3 at = randomPoint(random, kWorld);
        both.insert({at, at + 1.0});
    }
    both.tree.update();
    uint64_t rotations = 0, rebuilt = 0;
    for (int frame = 0; frame < 60; ++frame) {
        for (size_t i = 0; i < kCount; ++i) {
            const glm::dvec3 by = randomPoint(random, 3.0);
            const Box3d box = both.boxes[both.items[i]];
            both.move(i, {box.min + by, box.max + by});
        }
        const DynamicBvhUpdate done = both.tree.update();
        rotations += done.rotations;
        rebuilt += done.rebuilt;
        ASSERT_LE(done.rebuilt, kCount / 8 + 8) << "no update builds more anew than it may";
    }
    const double cost = both.tree.surfaceCost();
    both.tree.rebuild();
    EXPECT_LT(cost, 1.9 * both.tree.surfaceCost());
    EXPECT_GT(rotations, 0u);
    EXPECT_GT(rebuilt, 0u);
}

TEST(DynamicBvh, HoldsManyItemsInOnePlace) {
    Both both;
    for (int i = 0; i < 3000; ++i) both.insert({glm::dvec3(1.0), glm::dvec3(1.0)});
    both.tree.update();
    ASSERT_NO_FATAL_FAILURE(expectSound(both, true));
    ASSERT_NO_FATAL_FAILURE(expectEqualsFlat(both, 2));
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
    EXPECT_TRUE(std::isnan(roundDown(kNan)));
}

}  // namespace
}  // namespace sightline::test
