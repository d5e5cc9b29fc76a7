// The laws of a scene's own hierarchy: whatever is placed anew, bounds and answers are those of one made from scratch.
// SPDX-License-Identifier: MIT
#include "sightline/studies/frustum/node_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

#include "sightline/math/round_outward.h"
#include "sightline/tree/bvh_node.h"
#include "tests/support/targets.h"
#include "tests/tree/living_fixture.h"

namespace sightline::test {
using namespace studies;
namespace {

constexpr double kTreeWorld = 100.0;
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN(),
                 kInfinity = std::numeric_limits<double>::infinity();

/// Turned, moved, scaled, now and then mirrored or flattened.
glm::dmat4 randomTransform(Random& random, double way) {
    const glm::dvec3 axis = glm::normalize(randomPoint(random, 1.0) + glm::dvec3(0, 1e-3, 0));
    const double angle = random.uniform(0, 6.3), c = std::cos(angle), s = std::sin(angle);
    const double scale = random.below(4) ? 1.0 : random.uniform(0.5, 1.5);
    glm::dmat4 t(1.0);
    for (int i = 0; i < 3; ++i) {
        glm::dvec3 e(0.0);
        e[i] = 1.0;
        t[i] = glm::dvec4(scale * (c * e + s * glm::cross(axis, e) + (1 - c) * glm::dot(axis, e) * axis), 0.0);
    }
    if (random.below(10) == 0) t[0] = -t[0];
    if (random.below(200) == 0) t[1] *= 0.0;
    t[3] = glm::dvec4(randomPoint(random, way), 1.0);
    return t;
}

/// A tree, and what it was made of.
struct Scene {
    std::vector<SceneTreeNode> nodes;
    std::vector<SceneTreeItem> items;
    NodeTree tree;

    explicit Scene(const glm::dvec3& origin = glm::dvec3(0.0)) : tree(origin) {}

    void add(uint32_t parent, const glm::dmat4& local) { nodes.push_back({parent, local}); }
    void hang(uint32_t node, Random& random) {
        const glm::dvec3 at = randomPoint(random, 3.0);
        items.push_back({node, randomBox(random, at, 10.0)});
    }
    void build() { tree.build(nodes, items); }
    void setTransform(uint32_t node, const glm::dmat4& local) {
        nodes[node].local = local;
        tree.setTransform(node, local);
    }
    /// A transform as the product of all above, and the item's box by it.
    std::vector<Box3f> boxes() const {
        std::vector<glm::dmat4> world;
        for (const SceneTreeNode& node : nodes)
            world.push_back(node.parent == SceneTreeNode::kNone ? node.local : world[node.parent] * node.local);
        std::vector<Box3f> out;
        for (const SceneTreeItem& item : items) {
            const Box3d box = transformBox(item.box, world[item.node]);
            bool bounded = !item.box.empty() && box.finite();
            for (int axis = 0; axis < 3; ++axis)
                bounded = bounded && std::abs(box.min[axis] - tree.now().origin[axis]) <= NodeTree::kFarthest &&
                          std::abs(box.max[axis] - tree.now().origin[axis]) <= NodeTree::kFarthest;
            out.push_back(bounded ? relativeBox(box, tree.now().origin) : Box3f());
        }
        return out;
    }
};

/// Stored boxes are those of `truth`, and every slot's is the smallest around what is below.
void expectTight(const Scene& scene, const std::vector<Box3f>& truth, const std::string& what) {
    const NodeTreeBounds& tree = scene.tree.now();
    ASSERT_EQ(tree.order.size(), truth.size());
    ASSERT_EQ(tree.branches.empty(), truth.empty());
    const Box3f endless{glm::vec3(-kInfinity), glm::vec3(kInfinity)};
    float reach = 0;
    std::vector<int> met(truth.size(), 0);
    for (uint32_t item = 0; item < truth.size(); ++item) {
        const Box3f stored = scene.tree.storedBox(item), wanted = truth[item].empty() ? endless : truth[item];
        ASSERT_EQ(stored.min, wanted.min) << what << " item " << item;
        ASSERT_EQ(stored.max, wanted.max) << what << " item " << item;
        if (!truth[item].empty()) reach = std::max(reach, reachOf({truth[item]}));
    }
    EXPECT_EQ(tree.reach, reach) << what;
    uint32_t branches = 0;
    for (const NodeTreeBounds::Branch& branch : tree.branches) {
        uint32_t used = 0;
        for (uint32_t i = branch.first_block; i < branch.first_block + branch.block_count; ++i) {
            const BvhNode& block = tree.blocks[i];
            for (int slot = 0; slot < 8; ++slot) {
                if (block.count[slot] == 0) continue;
                ++used;
                Box3f below;
                for (uint32_t k = 0; k < block.count[slot]; ++k) {
                    const uint32_t item = tree.order[block.first[slot] + k];
                    below.grow(scene.tree.storedBox(item));
                    met[item] += &branch == tree.branches.data();
                }
                ASSERT_EQ(slotBox(block, slot).min, below.min) << what;
                ASSERT_EQ(slotBox(block, slot).max, below.max) << what;
                branches += !(block.child[slot] & BvhNode::kLeaf);
            }
        }
        EXPECT_TRUE(used > 1 || (&branch == tree.branches.data() && used == 1)) << "a branch with one child";
    }
    EXPECT_EQ(branches + !truth.empty(), tree.branches.size()) << what;
    for (size_t item = 0; item < met.size(); ++item) ASSERT_EQ(met[item], 1) << "item " << item << " below the root";
}

void expectEqualsFlat(const Scene& scene, const std::vector<Box3f>& truth, const Frustum& frustum,
                      const std::string& what) {
    HierarchyScratch scratch;
    std::vector<uint32_t> kept(truth.size() + 8);
    kept.resize(cullNodeTree(frustum, scene.tree.now(), scratch, kept));
    std::sort(kept.begin(), kept.end());
    EXPECT_EQ(kept, keptByFlat(frustum, truth, scene.tree.now().origin, scene.tree.now().reach)) << what;
}

void expectSound(const Scene& scene, Random& random, const std::string& what) {
    const std::vector<Box3f> truth = scene.boxes();
    expectTight(scene, truth, what);
    if (testing::Test::HasFatalFailure()) return;
    const Frustum frustum = makeFrustum(randomView(random, kTreeWorld, scene.tree.now().origin));
    forEachTarget([&](const std::string& target) { expectEqualsFlat(scene, truth, frustum, what + " " + target); });
}

/// Chains, wide nodes and all between, with items at leaves and on the way.
Scene randomScene(Random& random, uint32_t count, const glm::dvec3& origin = glm::dvec3(0.0)) {
    Scene scene(origin);
    const uint64_t kind = random.below(3);
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t parent = i == 0 ? SceneTreeNode::kNone : static_cast<uint32_t>(random.below(i));
        if (kind == 1 && i > 0 && random.below(8)) parent = i - 1;                          // chains
        if (kind == 2 && i > 0) parent = static_cast<uint32_t>(random.below(1 + i / 100));  // wide
        if (random.below(50) == 0) parent = SceneTreeNode::kNone;
        const bool top = parent == SceneTreeNode::kNone;
        glm::dmat4 local = randomTransform(random, top ? kTreeWorld : kind == 1 ? 2.0 : 20.0);
        if (top) local[3] += glm::dvec4(origin, 0.0);
        scene.add(parent, local);
        if (random.below(3) == 0) scene.hang(i, random);
        if (random.below(10) == 0) scene.hang(i, random);
    }
    scene.build();
    return scene;
}

TEST(NodeTree, IsTightAndEqualsAFlatListOverAnyScene) {
    Random random(41);
    for (int round = 0; round < 60; ++round) {
        const uint32_t count = static_cast<uint32_t>(random.below(round % 6 ? 400 : 6));
        const glm::dvec3 origin = round % 5 ? glm::dvec3(0.0) : glm::dvec3(1e6, -1e6, 1e6);
        expectSound(randomScene(random, count, origin), random, "round " + std::to_string(round));
        if (HasFailure()) return;
    }
}

TEST(NodeTree, FollowsWhatIsPlacedAnew) {
    Random random(42);
    const uint32_t changes = changesToMake(100000);
    uint64_t made = 0, branches = 0, updates = 0;
    for (int round = 0; made < changes; ++round) {
        Scene scene = randomScene(random, 600);
        for (int frame = 0; frame < 60; ++frame) {
            for (uint64_t i = random.below(120); i-- > 0; ++made) {
                const uint32_t node = static_cast<uint32_t>(random.below(scene.nodes.size()));
                const uint64_t kind = random.below(40);
                glm::dmat4 local = randomTransform(random, 20.0);
                if (kind == 0) local[3].x = kNotANumber;
                if (kind == 1) local[1].y = kInfinity;
                if (kind == 2) local[3].z = 1e19;
                if (kind < 36) scene.setTransform(node, local);
                if (kind < 32 || scene.items.empty()) continue;
                const uint32_t item = static_cast<uint32_t>(random.below(scene.items.size()));
                Box3d box = randomBox(random, randomPoint(random, 3.0), 10.0);
                if (kind == 39) box = random.below(2) ? Box3d() : Box3d{glm::dvec3(kNotANumber), glm::dvec3(1.0)};
                scene.items[item].box = box;
                scene.tree.setBox(item, box);
            }
            branches += scene.tree.update().branches;
            ++updates;
            if (frame % 4) continue;
            expectSound(scene, random, "round " + std::to_string(round) + " frame " + std::to_string(frame));
            if (HasFailure()) return;
        }
    }
    EXPECT_GT(branches, updates);
}

TEST(NodeTree, IsWhatOneMadeFromScratchIs) {
    Random random(43);
    Scene scene = randomScene(random, 2000);
    for (int i = 0; i < 300; ++i)
        scene.setTransform(static_cast<uint32_t>(random.below(scene.nodes.size())), randomTransform(random, 20.0));
    scene.tree.update();
    NodeTree fresh;
    fresh.build(scene.nodes, scene.items);
    const NodeTreeBounds &a = scene.tree.now(), &b = fresh.now();
    ASSERT_EQ(a.blocks.size(), b.blocks.size());
    EXPECT_EQ(a.order, b.order);
    EXPECT_EQ(a.reach, b.reach);
    for (size_t i = 0; i < a.blocks.size(); ++i)
        for (int slot = 0; slot < 8; ++slot) {
            ASSERT_EQ(slotBox(a.blocks[i], slot).min, slotBox(b.blocks[i], slot).min);
            ASSERT_EQ(slotBox(a.blocks[i], slot).max, slotBox(b.blocks[i], slot).max);
            ASSERT_EQ(a.blocks[i].child[slot], b.blocks[i].child[slot]);
        }
    for (uint32_t node = 0; node < scene.nodes.size(); ++node) ASSERT_EQ(scene.tree.world(node), fresh.world(node));
}

TEST(NodeTree, ChainsCostNothingAndMayBeDeep) {
    Scene scene;
    Random random(44);
    constexpr uint32_t kDeep = 100000;
    glm::dmat4 step(1.0);
    step[3].x = 0.001;
    for (uint32_t i = 0; i < kDeep; ++i) scene.add(i == 0 ? SceneTreeNode::kNone : i - 1, step);
    scene.items.push_back({kDeep - 1, {glm::dvec3(0.0), glm::dvec3(1.0)}});
    scene.build();
    EXPECT_EQ(scene.tree.now().branches.size(), 1u);
    EXPECT_NEAR(scene.tree.storedBox(0).min.x, 100.0, 1e-3);
    step[3].x = 5.0;
    scene.setTransform(0, step);
    const NodeTreeUpdate done = scene.tree.update();
    EXPECT_EQ(done.nodes, kDeep);
    EXPECT_EQ(done.items, 1u);
    EXPECT_NEAR(scene.tree.storedBox(0).min.x, 104.999, 1e-3);
    expectSound(scene, random, "chain");
}

TEST(NodeTree, TouchesWhatChangedAlone) {
    // Ten branches of ten branches of ten items.
    Scene scene;
    for (int i = 0; i < 10; ++i) {
        glm::dmat4 t(1.0);
        t[3].x = 100.0 * i;
        scene.add(SceneTreeNode::kNone, t);
    }
    for (uint32_t i = 0; i < 100; ++i) {
        glm::dmat4 t(1.0);
        t[3].y = 10.0 * double(i % 10);
        scene.add(i / 10, t);
        for (int k = 0; k < 10; ++k) {
            const glm::dvec3 at(0, 0, 2.0 * k);
            scene.items.push_back({10 + i, {at, at + 1.0}});
        }
    }
    scene.build();
    EXPECT_EQ(scene.tree.now().branches.size(), 111u);
    EXPECT_EQ(scene.tree.update().branches, 0u) << "nothing was placed anew";
    scene.tree.setBox(5, {glm::dvec3(0.0, 0.0, 10.1), glm::dvec3(0.9, 0.9, 10.9)});  // between its neighbours
    NodeTreeUpdate done = scene.tree.update();
    EXPECT_EQ(done.items, 1u);
    EXPECT_EQ(done.branches, 1u) << "bounds above do not change";
    glm::dmat4 t(1.0);
    t[3].y = 1000.0;
    scene.tree.setTransform(42, t);
    scene.tree.setTransform(42, t);
    done = scene.tree.update();
    EXPECT_EQ(done.nodes, 1u);
    EXPECT_EQ(done.items, 10u);
    EXPECT_EQ(done.branches, 3u);
    scene.tree.setTransform(42, t);
    done = scene.tree.update();
    EXPECT_EQ(done.branches, 0u) << "it stands where it stood";
}

TEST(NodeTree, WhatHasNoEndIsAlwaysKept) {
    Scene scene;
    Random random(45);
    scene.add(SceneTreeNode::kNone, glm::dmat4(1.0));
    for (uint32_t i = 0; i < 20; ++i) {
        scene.add(0, glm::dmat4(1.0));
        const glm::dvec3 at(0, 0, 10.0 + i);  // behind the eye
        scene.items.push_back({1 + i, {at, at + 1.0}});
    }
    scene.build();
    View view;
    view.projection = perspective(1.0, 1.0, 0.1);
    const Frustum frustum = makeFrustum(view);
    const auto kept = [&] {
        HierarchyScratch scratch;
        std::vector<uint32_t> out(28);
        out.resize(cullNodeTree(frustum, scene.tree.now(), scratch, out));
        return out;
    };
    EXPECT_TRUE(kept().empty());
    glm::dmat4 bad(1.0);
    bad[3].y = kNotANumber;
    scene.setTransform(7, bad);
    scene.tree.update();
    EXPECT_EQ(kept(), std::vector<uint32_t>{6});
    expectTight(scene, scene.boxes(), "one");
    scene.setTransform(0, bad);
    scene.tree.update();
    EXPECT_EQ(kept().size(), 20u);
    scene.setTransform(0, glm::dmat4(1.0));
    scene.setTransform(7, glm::dmat4(1.0));
    scene.tree.update();
    EXPECT_TRUE(kept().empty());
    expectSound(scene, random, "well again");
}

}  // namespace
}  // namespace sightline::test
