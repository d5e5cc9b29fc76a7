// The law of clusters: culled ones hold no front face, for any test, tree and mask, on any instruction set.
// SPDX-License-Identifier: MIT
#include "sightline/cull/facing_clusters.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sightline/prepare/facing/culling_volume.h"
#include "sightline/prepare/facing/facing_clusters.h"
#include "sightline/prepare/facing/merge_facing.h"
#include "tests/cull/facing_oracle.h"
#include "tests/support/targets.h"

namespace sightline {
namespace {

/// Clusters of 1 to 40 triangles, about a place and about a direction each, from flat to turned all ways.
struct World {
    test::TestMesh mesh;
    std::vector<uint32_t> triangles, sizes;

    World(Random& random, size_t clusters, const glm::dvec3& middle) {
        for (size_t c = 0; c < clusters; ++c) {
            const uint32_t count = 1 + static_cast<uint32_t>(random.below(40));
            const glm::dvec3 place = middle + test::randomVector(random, 5.0), ahead = test::randomUnit(random);
            const double size = random.uniform(0.05, 1.0);
            const double spread = random.below(4) == 0 ? 0.0 : random.below(8) == 0 ? 3.0 : random.uniform(0.0, 0.8);
            for (uint32_t i = 0; i < count; ++i) {
                const glm::dvec3 n = glm::normalize(ahead + spread * test::randomVector(random, 1.0));
                const glm::dvec3 u =
                    glm::normalize(glm::cross(n, glm::abs(n.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
                const glm::dvec3 v = glm::cross(n, u),
                                 a = place + test::randomVector(random, spread == 0.0 ? 0.0 : size);
                mesh.add(glm::vec3(a), glm::vec3(a + size * u), glm::vec3(a + size * v));
                triangles.push_back(static_cast<uint32_t>(triangles.size()));
            }
            sizes.push_back(count);
        }
    }
};

/// +1, -1 or 0, of what is exact: the sign in double where that is sure, and in 113 bits.
int sideOf(const MeshView& mesh, size_t triangle, const FacingEye& eye) {
    const glm::dvec3 a(mesh.positions[mesh.indices[3 * triangle]]), b(mesh.positions[mesh.indices[3 * triangle + 1]]);
    const glm::dvec3 c(mesh.positions[mesh.indices[3 * triangle + 2]]), q = eye.point - eye.w * a;
    const double quick = glm::dot(glm::cross(b - a, c - a), q);
    if (std::abs(quick) > 1e-13 * glm::length(b - a) * glm::length(c - a) * glm::length(q) &&
        eye.w * glm::length(a) < 1e5)
        return quick > 0 ? 1 : -1;
    const test::Quad exact = test::trueFacing(mesh, triangle, eye.point, eye.w);
    return exact > 0 ? 1 : exact < 0 ? -1 : 0;
}

FacingEye randomEye(Random& random, const glm::dvec3& middle) {
    if (random.below(5) == 0) return {test::randomUnit(random), 0.0, 0.0, FrontFace::kCounterClockwise};
    const double far_away = std::ldexp(1.0, static_cast<int>(random.below(12)) - 1);
    return {middle + test::randomVector(random, far_away), 1.0, 0.0, FrontFace::kCounterClockwise};
}

/// The answers of each instruction set, which must be the same.
template <class Find>
std::vector<uint8_t> onAllTargets(size_t bytes, const Find& find) {
    std::vector<uint8_t> first;
    test::forEachTarget([&](const std::string& target) {
        std::vector<uint8_t> bits(bytes, 0xff);
        find(bits);
        if (first.empty()) first = bits;
        EXPECT_EQ(bits, first) << target;
    });
    return first;
}

TEST(FacingClusters, NoFrontFaceIsInACulledClusterAndNoBackFaceInAFrontOne) {
    Random random(101);
    const size_t clusters = 400, eyes = 50, worlds = test::casesToMake(1000000) / (clusters * eyes);
    size_t culled[3] = {}, fronts = 0, all_back = 0;
    for (size_t w = 0; w < worlds && !HasFailure(); ++w) {
        const glm::dvec3 middle = test::randomVector(random, w % 2 ? 10.0 : 1e4);
        const World world(random, clusters, middle);
        const FacingClusters made = describeClusters(world.mesh.view(), world.triangles, world.sizes);
        const size_t bytes = (clusters + 15) / 16 * 2;
        for (size_t e = 0; e < eyes; ++e) {
            const FacingEye eye = randomEye(random, middle);
            std::vector<int8_t> sides(world.triangles.size());
            for (size_t i = 0; i < sides.size(); ++i) sides[i] = static_cast<int8_t>(sideOf(world.mesh.view(), i, eye));
            const auto judge = [&](const std::vector<uint8_t>& bits, int wrong, size_t& count) {
                for (size_t c = 0; c < clusters; ++c) {
                    if (!test::bitOf(bits, c)) continue;
                    ++count;
                    for (uint32_t i = made.first[c]; i < made.first[c + 1]; ++i)
                        ASSERT_NE(sides[made.triangles[i]], wrong) << "world " << w << " eye " << e << " cluster " << c;
                }
            };
            for (int test = 0; test < 3; ++test)
                judge(onAllTargets(bytes,
                                   [&](std::vector<uint8_t>& bits) { findBackClusters(made, eye, 1u << test, bits); }),
                      1, culled[test]);
            judge(onAllTargets(bytes, [&](std::vector<uint8_t>& bits) { findFrontClusters(made, eye, bits); }), -1,
                  fronts);
            for (size_t c = 0; c < clusters; ++c)
                all_back += std::all_of(sides.begin() + made.first[c], sides.begin() + made.first[c + 1],
                                        [](int8_t side) { return side <= 0; });
        }
    }
    // No test may be so careful that it is of no use.
    for (const size_t count : culled) EXPECT_GT(count, all_back / 2);
    EXPECT_GT(fronts, all_back / 3);
}

TEST(FacingClusters, TheTestsTogetherFindTheUnionAndClockwiseFrontsTheOpposite) {
    Random random(102);
    const World world(random, 300, {1, 2, 3});
    const FacingClusters made = describeClusters(world.mesh.view(), world.triangles, world.sizes);
    const size_t bytes = (300 + 15) / 16 * 2;
    for (int e = 0; e < 100; ++e) {
        FacingEye eye = randomEye(random, {1, 2, 3});
        std::vector<uint8_t> all(bytes), one(bytes), sum(bytes, 0), front(bytes), turned(bytes);
        for (uint32_t test = 1; test <= 4; test *= 2) {
            findBackClusters(made, eye, test, one);
            for (size_t i = 0; i < bytes; ++i) sum[i] |= one[i];
        }
        findBackClusters(made, eye, kAllFacingTests, all);
        EXPECT_EQ(all, sum);
        findFrontClusters(made, eye, front);
        eye.front = FrontFace::kClockwise;
        findBackClusters(made, eye, kAllFacingTests, turned);
        EXPECT_EQ(front, turned);
    }
}

TEST(FacingClusters, TheSelectionAsOftenPrintedCullsAFrontFace) {
    // Normals (1, 0, 0) and (-1, 0, 0) at the origin, eye at (10, 0, 0): taking the largest normal for a negative eye and the
    // least for a positive one, as lecture notes have it, gives -10, "all back"; yet one faces the eye.
    test::TestMesh mesh;
    mesh.add({0, 0, 0}, {0, 1, 0}, {0, 0, 1});
    mesh.add({0, 0, 0}, {0, 0, 1}, {0, 1, 0});
    const std::vector<uint32_t> triangles{0, 1}, sizes{2};
    const FacingClusters made = describeClusters(mesh.view(), triangles, sizes);
    const CullingVolume volume = made.volume(0);
    EXPECT_LT(volume.least.x, -0.99f);
    EXPECT_GT(volume.most.x, 0.99f);
    std::vector<uint8_t> back(2);
    EXPECT_EQ(findBackClusters(made, {{10, 0, 0}, 1.0, 0.0, FrontFace::kCounterClockwise}, kAllFacingTests, back), 0u);
}

TEST(FacingClusters, AFlatClusterCullsItsHalfSpaceWithoutEnd) {
    test::TestMesh mesh;
    mesh.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    mesh.add({1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    const std::vector<uint32_t> triangles{0, 1}, sizes{2};
    const FacingClusters made = describeClusters(mesh.view(), triangles, sizes);
    Random random(103);
    std::vector<uint8_t> back(2);
    for (int i = 0; i < 1000; ++i) {
        glm::dvec3 eye = test::randomVector(random, 1e6);
        eye.z = -std::abs(eye.z) - 100.0;
        for (uint32_t test = 1; test <= 4; test *= 2)
            EXPECT_EQ(findBackClusters(made, {eye, 1.0, 0.0, FrontFace::kCounterClockwise}, test, back), 1u) << test;
    }
}

TEST(FacingTree, SettlesWhatItsClustersSayAndNothingElse) {
    Random random(104);
    const size_t rounds = test::casesToMake(1000000) / 100000;
    size_t asked = 0, found = 0, nodes = 0, clusters_asked = 0;
    for (size_t round = 0; round < rounds && !HasFailure(); ++round) {
        // A merged sheet with waves: neighbours face alike.
        test::TestMesh mesh;
        const int side = 40;
        const double wave = random.uniform(0.0, 0.3);
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                const auto at = [&](int x, int y) {
                    return glm::vec3(x * 0.1, wave * std::sin(x * 0.3) * std::cos(y * 0.2), y * 0.1);
                };
                mesh.add(at(i, j), at(i, j + 1), at(i + 1, j));
                mesh.add(at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
            }
        FacingCost cost{.test = 1.0};
        const FacingPartition part = mergeFacing(mesh.view(), cost, {8, 4});
        const FacingClusters made = describeClusters(mesh.view(), part.triangles, part.sizes);
        const FacingTree tree = makeFacingTree(made, mesh.view());
        nodes += tree.nodes.size();
        for (size_t i = 0; i < tree.nodes.size(); ++i) {
            const FacingNode& node = tree.nodes[i];
            ASSERT_GT(node.next, i);
            ASSERT_LE(node.next, tree.nodes.size());
            for (size_t k = i + 1; k < node.next; ++k)
                ASSERT_LE(tree.nodes[k].first + tree.nodes[k].count, node.first + node.count);
            if (node.next < tree.nodes.size()) { ASSERT_GE(tree.nodes[node.next].first, node.first); }
        }
        const size_t bytes = (made.count() + 15) / 16 * 2;
        for (int e = 0; e < 100; ++e) {
            const FacingEye eye = randomEye(random, {2, 0, 2});
            std::vector<uint8_t> by_tree(bytes, 0xff), flat(bytes);
            asked += walkFacingTree(tree, made, eye, by_tree);
            clusters_asked += made.count();
            findBackClusters(made, eye, kVolumeTest, flat);
            for (size_t c = 0; c < made.count(); ++c) {
                found += test::bitOf(by_tree, c);
                // What a node culls may be more than what its clusters cull, by their origins; it is never a front face.
                if (!test::bitOf(by_tree, c)) {
                    // A node that says "front" is right, too: then no cluster of it says "back".
                    ASSERT_FALSE(test::bitOf(flat, c)) << "round " << round << " eye " << e;
                    continue;
                }
                for (uint32_t i = made.first[c]; i < made.first[c + 1]; ++i)
                    ASSERT_LE(sideOf(mesh.view(), made.triangles[i], eye), 0) << "round " << round << " eye " << e;
            }
        }
    }
    EXPECT_GT(nodes, 10u);
    EXPECT_GT(found, 1000u);
    EXPECT_LT(asked, clusters_asked);
}

TEST(TriangleMasks, ABitIsABackFaceForEveryEyeOfTheSector) {
    Random random(105);
    const size_t clusters = 100, eyes = 100;
    size_t worlds = test::casesToMake(1000000) / (20 * clusters * eyes), bits = 0, backs = 0, inside = 0;
    for (size_t w = 0; w < worlds && !HasFailure(); ++w) {
        const glm::dvec3 middle = test::randomVector(random, w % 2 ? 10.0 : 1e3);
        World world(random, clusters, middle);
        if (w % 3 == 1) {  // a flat world has flat boxes
            for (glm::vec3& p : world.mesh.positions)
                p = glm::vec3(middle + glm::dvec3(1.0, 0.01, 0.2) * (glm::dvec3(p) - middle));
        }
        const FacingClusters made =
            describeClusters(world.mesh.view(), world.triangles, world.sizes,
                             {.mask_steps = 1 + static_cast<uint32_t>(w % TriangleMasks::kMaxSteps)});
        for (size_t e = 0; e < eyes; ++e) {
            FacingEye eye = randomEye(random, middle);
            if (e % 4 == 0 && eye.w > 0) {  // on a border between sectors of some cluster
                const glm::dvec3 c = made.origin + glm::dvec3(made.masks[e].center);
                eye.point =
                    c + random.uniform(0.5, 8.0) * glm::dvec3(1.0, random.below(2) ? 1.0 : 0.5, random.uniform(-1, 1));
            }
            for (size_t c = 0; c < clusters; ++c) {
                const uint64_t* const masks = backTriangles(made, c, eye);
                inside += !masks;
                for (uint32_t i = 0; masks && i < made.size(c); ++i) {
                    const int side = sideOf(world.mesh.view(), made.triangles[made.first[c] + i], eye);
                    backs += side < 0;
                    if (!(masks[i / 64] >> (i % 64) & 1)) continue;
                    ++bits;
                    ASSERT_LE(side, 0) << "world " << w << " eye " << e << " cluster " << c << " triangle " << i;
                }
            }
        }
    }
    EXPECT_GT(bits, backs / 3);
    EXPECT_GT(inside, 0u);
}

TEST(FacingClusters, RemainingRangesAreAllThatIsNotCulled) {
    Random random(106);
    const World world(random, 100, {0, 0, 0});
    const FacingClusters made = describeClusters(world.mesh.view(), world.triangles, world.sizes);
    for (int round = 0; round < 100; ++round) {
        std::vector<uint8_t> back(14);
        for (uint8_t& byte : back) byte = static_cast<uint8_t>(random.next() & random.next());
        const uint32_t gap = static_cast<uint32_t>(random.below(3) * 20);
        std::vector<TriangleRange> ranges(51);
        ranges.resize(remainingRanges(made, back, gap, ranges));
        std::vector<int> drawn(made.triangles.size());
        for (const TriangleRange& range : ranges)
            for (uint32_t i = range.first; i < range.first + range.count; ++i) ++drawn[i];
        for (size_t i = 1; i < ranges.size(); ++i)
            EXPECT_GT(ranges[i].first - ranges[i - 1].first - ranges[i - 1].count, gap);
        for (size_t c = 0; c < 100; ++c)
            for (uint32_t i = made.first[c]; i < made.first[c + 1]; ++i) {
                EXPECT_LE(drawn[i], 1);
                if (!test::bitOf(back, c)) {
                    EXPECT_EQ(drawn[i], 1);
                } else if (gap == 0) {
                    EXPECT_EQ(drawn[i], 0);
                }
            }
    }
}

TEST(FacingClusters, WhatHasNoNormalIsNeverCulledAndAnUnknownEyeCullsNothing) {
    test::TestMesh mesh;
    mesh.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    mesh.add({0, 0, 0}, {1, 0, 0}, {2, 0, 0});  // a line
    mesh.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    mesh.add({0, 0, 0}, {0, 0, 0}, {0, 1, 0});  // faces nobody, whatever the rounding
    const std::vector<uint32_t> triangles{0, 1, 2, 3}, sizes{2, 2, 0};
    const FacingClusters made = describeClusters(mesh.view(), triangles, sizes);
    std::vector<uint8_t> back(2);
    EXPECT_EQ(findBackClusters(made, {{0, 0, -3}, 1.0, 0.0, FrontFace::kCounterClockwise}, kAllFacingTests, back), 1u);
    EXPECT_EQ(back[0], 0b10);
    for (const FacingEye& eye : {FacingEye{{0, 0, -3}, 1.0, 4.0, FrontFace::kCounterClockwise},
                                 FacingEye{{NAN, 0, -3}, 1.0, 0.0, FrontFace::kCounterClockwise},
                                 FacingEye{{0, 0, -1e200}, 1.0, 0.0, FrontFace::kCounterClockwise},
                                 FacingEye{{0, 0, -3}, 1.0, INFINITY, FrontFace::kCounterClockwise}})
        EXPECT_EQ(findBackClusters(made, eye, kAllFacingTests, back), 0u);
    const FacingClusters none = describeClusters(mesh.view(), {}, {});
    EXPECT_EQ(none.count(), 0u);
    EXPECT_EQ(findBackClusters(none, {}, kAllFacingTests, back), 0u);
}

}  // namespace
}  // namespace sightline
