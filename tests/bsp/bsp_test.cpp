// The laws of BSP trees: no area is lost, orders are right from everywhere, edges are cut alike, later polygons fit in.
// SPDX-License-Identifier: MIT
#include "sightline/bsp/bsp.h"

#include <cstdio>
#include <cstring>
#include <set>
#include <tuple>

#include "tests/bsp/bsp_fixture.h"

namespace sightline::test {
namespace {

template <class Walked>
std::vector<Seen> seenFrom(const Walked& tree, const BspTree& arrays, const BspOverlay* overlay,
                           const glm::dvec4& eye) {
    std::vector<Seen> seen;
    BspStack stack;
    const auto add = [&](const BspArrays& of, std::span<const BspPiece> pieces) {
        for (const BspPiece& piece : pieces) seen.push_back({of.outline(piece), static_cast<uint32_t>(seen.size())});
    };
    walkBackToFront(
        tree, eye, stack, [](uint32_t) { return true; },
        [&](uint32_t node) {
            if (node < arrays.nodes.size()) add(arrays, arrays.piecesOf(arrays.nodes[node]));
            else add(*overlay, overlay->piecesOf(tree.node(node)));
            if (!overlay || node >= arrays.nodes.size()) return;
            if (const BspOverlay::Entry* entry = overlay->entryOf(node)) add(*overlay, overlay->piecesOf(*entry));
        });
    return seen;
}

/// From a few points in and around the unit cube, and along a few directions.
template <class Walked>
uint64_t expectOrders(const Walked& tree, const BspTree& arrays, const BspOverlay* overlay, uint64_t seed, int eyes,
                      int rays) {
    Random random(seed);
    uint64_t pairs = 0;
    for (int i = 0; i < eyes; ++i) {
        const std::string what = "seed " + std::to_string(seed) + ", eye " + std::to_string(i);
        const glm::dvec3 place = randomVector(random, 1.5);
        pairs += expectBackToFront(
            seenFrom(tree, arrays, overlay, bspEye(place)), rays,
            [&](int) { return std::pair(place, glm::normalize(randomVector(random, 1) - place)); }, what);
        const glm::dvec3 direction = glm::normalize(place);
        pairs += expectBackToFront(
            seenFrom(tree, arrays, overlay, bspParallelEye(direction)), rays,
            [&](int) { return std::pair(randomVector(random, 1) - 5.0 * direction, direction); }, what + ", parallel");
    }
    return pairs;
}

TEST(Bsp, KeepsEveryPolygonsAreaInSoundNodes) {
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        const BspPolygons polygons = randomTriangles(seed, 300, seed % 2 ? 0.1 : 0.6);
        const BspTree tree = buildBsp(polygons, {.axis_planes = seed % 3 != 0, .seed = seed});
        expectSound(tree, polygons);
        const BspStatistics statistics = statisticsOf(tree);
        EXPECT_EQ(statistics.polygons, 300u);
        EXPECT_EQ(statistics.pieces, statistics.polygons + statistics.splits);
        EXPECT_EQ(statistics.leaves, statistics.nodes + 1);
        EXPECT_EQ(tree.below[tree.root], statistics.pieces);
    }
}

TEST(Bsp, OrdersWhatItHoldsFromEveryEye) {
    uint64_t pairs = 0;
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        const BspTree tree = buildBsp(randomTriangles(seed, 150, seed % 2 ? 0.2 : 0.7));
        pairs += expectOrders(BspStatic{tree}, tree, nullptr, seed, 6, 60);
    }
    EXPECT_GT(pairs, 5000u);
}

TEST(Bsp, GoesFrontToBackInTheReverseOrder) {
    const BspTree tree = buildBsp(randomTriangles(3, 200, 0.4));
    BspStack stack;
    Random random(5);
    for (int i = 0; i < 20; ++i) {
        // The middle of a node's polygon too: an eye in a plane.
        const glm::dvec3 place = i % 2 ? randomVector(random, 2) : tree.points[random.below(tree.points.size())];
        std::vector<uint32_t> there, back;
        const auto all = [](uint32_t) { return true; };
        walkBackToFront(BspStatic{tree}, bspEye(place), stack, all, [&](uint32_t node) { there.push_back(node); });
        walkFrontToBack(BspStatic{tree}, bspEye(place), stack, all, [&](uint32_t node) { back.push_back(node); });
        std::reverse(back.begin(), back.end());
        EXPECT_EQ(there.size(), tree.nodes.size());
        EXPECT_EQ(there, back);
    }
}

TEST(Bsp, AnEyeInAPlaneOrdersWhatItSees) {
    const BspTree tree = buildBsp(randomTriangles(8, 120, 0.5));
    Random random(2);
    uint64_t pairs = 0;
    for (int i = 0; i < 20; ++i) {
        const glm::dvec3 place = tree.points[random.below(tree.points.size())];
        pairs += expectBackToFront(
            seenFrom(BspStatic{tree}, tree, nullptr, bspEye(place)), 60,
            [&](int) { return std::pair(place, glm::normalize(randomVector(random, 1) - place)); },
            "eye " + std::to_string(i));
    }
    EXPECT_GT(pairs, 1000u);
}

TEST(Bsp, SkipsASubtreeThatIsNotEntered) {
    const BspTree tree = buildBsp(randomTriangles(4, 200, 0.3));
    BspStack stack;
    for (uint32_t left_out = 0; left_out < tree.nodes.size(); left_out += 7) {
        uint64_t pieces = 0;
        walkFrontToBack(
            BspStatic{tree}, bspEye(glm::dvec3(3, 2, 1)), stack, [&](uint32_t node) { return node != left_out; },
            [&](uint32_t node) { pieces += tree.nodes[node].count; });
        EXPECT_EQ(pieces, tree.below[tree.root] - tree.below[left_out]);
    }
}

TEST(Bsp, CutsASharedEdgeInOnePoint) {
    Random random(11);
    for (int i = 0; i < 100000; ++i) {
        const glm::dvec3 a = randomVector(random, 10), b = randomVector(random, 10);
        const glm::dvec3 left[3] = {a, b, randomVector(random, 10)}, right[3] = {b, a, randomVector(random, 10)};
        const glm::dvec3 n = glm::normalize(randomVector(random, 1));
        const glm::dvec4 plane(n, -glm::dot(n, a + random.uniform() * (b - a)));
        BspOutline parts[4];
        splitPolygon(left, plane, 1e-12, 1e-14, parts[0], parts[1]);
        splitPolygon(right, plane, 1e-12, 1e-14, parts[2], parts[3]);
        // Both have the point on the edge; the other crossing of each lies elsewhere.
        int common = 0;
        for (const glm::dvec3& p : parts[1].points)
            for (const glm::dvec3& q : parts[3].points) common += p == q && p != a && p != b;
        ASSERT_EQ(common, 1) << "case " << i;
    }
}

TEST(Bsp, LeavesNoTwoPointsNextToEachOtherOnAnEdge) {
    // A bumpy surface whose triangles share edges, among triangles that cut it.
    BspPolygons polygons = randomTriangles(6, 200, 0.5);
    Random random(9);
    constexpr int kSide = 12;
    std::vector<glm::dvec3> grid;
    for (int i = 0; i < kSide * kSide; ++i)
        grid.emplace_back((i % kSide) / 5.5 - 1, random.uniform(-0.2, 0.2), (i / kSide) / 5.5 - 1);
    std::map<std::pair<int, int>, std::vector<uint32_t>> edges;
    const auto add = [&](int a, int b, int c) {
        const uint32_t number = static_cast<uint32_t>(polygons.size());
        const glm::dvec3 p[3] = {grid[a], grid[b], grid[c]};
        polygons.add(p, number);
        for (const auto& [u, v] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
            edges[{std::min(u, v), std::max(u, v)}].push_back(number);
    };
    for (int y = 0; y + 1 < kSide; ++y)
        for (int x = 0; x + 1 < kSide; ++x) {
            const int at = y * kSide + x;
            add(at, at + 1, at + kSide);
            add(at + 1, at + kSide + 1, at + kSide);
        }
    const BspTree tree = buildBsp(polygons);
    std::map<uint32_t, std::vector<glm::dvec3>> corners;
    for (const BspNode& node : tree.nodes)
        for (const BspPiece& piece : tree.piecesOf(node))
            for (const glm::dvec3& p : tree.outline(piece)) corners[piece.number].push_back(p);
    uint64_t shared = 0;
    for (const auto& [ends, owners] : edges) {
        if (owners.size() != 2) continue;
        const glm::dvec3 a = grid[ends.first], ab = grid[ends.second] - a;
        for (const glm::dvec3& p : corners[owners[0]]) {
            const double t = glm::dot(p - a, ab) / glm::dot(ab, ab);
            if (t <= 0 || t >= 1 || glm::length(a + t * ab - p) > 1e-12) continue;
            for (const glm::dvec3& q : corners[owners[1]]) {
                if (glm::length(q - p) > 1e-10) continue;
                ++shared;
                ASSERT_EQ(p, q) << "edge " << ends.first << ", " << ends.second;
            }
        }
    }
    EXPECT_GT(shared, 100u);
}

TEST(Bsp, ListsWhatLiesInAPlaneWithItsFacing) {
    BspPolygons polygons;
    const glm::dvec3 up[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, down[3] = {{5, 5, 0}, {5, 6, 0}, {6, 5, 0}};
    polygons.add(up, 7);
    polygons.add(down, 3);
    polygons.add(up, 5);
    const BspTree tree = buildBsp(polygons);
    ASSERT_EQ(tree.nodes.size(), 1u);
    const std::span<const BspPiece> pieces = tree.piecesOf(tree.nodes[0]);
    ASSERT_EQ(pieces.size(), 3u);
    EXPECT_EQ(pieces[0].number, 3u);
    EXPECT_EQ(pieces[1].number, 5u);
    EXPECT_EQ(pieces[2].number, 7u);
    EXPECT_EQ(pieces[1].opposite, pieces[2].opposite);
    EXPECT_NE(pieces[0].opposite, pieces[1].opposite);
}

TEST(Bsp, IsTheSameForASeed) {
    const BspPolygons polygons = randomTriangles(2, 400, 0.3);
    const auto same = [](const BspTree& a, const BspTree& b) {
        return a.nodes.size() == b.nodes.size() && a.points == b.points &&
               std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(BspNode)) == 0;
    };
    BspSettings settings;
    const BspTree tree = buildBsp(polygons, settings);
    EXPECT_TRUE(same(tree, buildBsp(polygons, settings)));
    settings.seed = 2;
    EXPECT_FALSE(same(tree, buildBsp(polygons, settings)));
}

TEST(Bsp, ChoosesSplittersThatSplitLess) {
    BspSettings random, chosen;
    random.candidates = 1;
    random.axis_planes = chosen.axis_planes = false;
    uint64_t random_splits = 0, chosen_splits = 0;
    for (uint64_t seed = 1; seed <= 3; ++seed) {
        random.seed = chosen.seed = seed;
        const BspPolygons polygons = randomTriangles(seed, 800, 0.15);
        random_splits += buildBsp(polygons, random).splits;
        chosen_splits += buildBsp(polygons, chosen).splits;
    }
    std::printf("splits: random choice %zu, chosen %zu\n", size_t(random_splits), size_t(chosen_splits));
    EXPECT_LE(chosen_splits, random_splits * 0.6);
}

TEST(Bsp, AListForATreeOverflowsNothing) {
    const BspPolygons polygons = convexFaces(45);
    const BspTree list = buildBsp(polygons, {.axis_planes = false});
    const BspStatistics of_list = statisticsOf(list);
    EXPECT_EQ(of_list.depth, of_list.nodes);
    EXPECT_EQ(of_list.splits, 0u);
    EXPECT_GT(of_list.depth, 4000u);
    BspStack stack;
    size_t visited = 0;
    walkFrontToBack(
        BspStatic{list}, bspEye(glm::dvec3(0.0)), stack, [](uint32_t) { return true; }, [&](uint32_t) { ++visited; });
    EXPECT_EQ(visited, list.nodes.size());
    const BspTree tree = buildBsp(polygons);
    expectSound(tree, polygons);
    std::printf("convex: autopartition %u deep, with axis planes %u deep and %zu splits\n", of_list.depth,
                statisticsOf(tree).depth, size_t(tree.splits));
    EXPECT_LT(statisticsOf(tree).depth, 200u);
}

TEST(Bsp, StandsAnyInput) {
    for (uint64_t seed = 1; seed <= 40; ++seed) {
        const BspPolygons polygons = degenerateMix(seed, 120);
        BspSettings settings{.axis_planes = seed % 2 != 0};
        settings.candidates = 1 + static_cast<uint32_t>(seed % 5);
        BspTree tree = buildBsp(polygons, settings);
        SCOPED_TRACE("seed " + std::to_string(seed));
        expectSound(tree, polygons);
        if (testing::Test::HasFatalFailure()) return;
        EXPECT_EQ(tree.degenerate + tree.polygons, polygons.size());
        expectOrders(BspStatic{tree}, tree, nullptr, seed, 2, 20);
    }
    EXPECT_EQ(buildBsp({}).root, BspNode::kLeaf);
    EXPECT_EQ(buildBsp({}).leaf.size(), 1u);
}

TEST(Bsp, TakesPolygonsLater) {
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        BspPolygons all = seed == 4 ? degenerateMix(seed, 200) : randomTriangles(seed, 200, 0.5), parts[4];
        for (uint32_t i = 0; i < all.size(); ++i) parts[i % 4].add(all.outline(i), all.number[i]);
        BspTree tree = seed == 1 ? buildBsp({}) : buildBsp(parts[0]);
        for (int i = seed == 1 ? 0 : 1; i < 4; ++i) insertPolygons(tree, parts[i]);
        expectSound(tree, all);
        if (testing::Test::HasFatalFailure()) return;
        EXPECT_EQ(tree.degenerate + tree.polygons, all.size());
        EXPECT_GT(expectOrders(BspStatic{tree}, tree, nullptr, seed, 4, 60), 300u);
    }
}

TEST(Bsp, PlacesMovingThingsAmongTheStaticOnesWithoutAChange) {
    const BspPolygons still = randomTriangles(1, 150, 0.5);
    const BspTree tree = buildBsp(still), copy = tree;
    BspOverlay overlay;
    Random random(3);
    uint64_t pairs = 0;
    for (int frame = 0; frame < 5; ++frame) {
        const BspPolygons moving = convexFaces(6, randomVector(random, 0.7), 0.4, 1000);
        locatePolygons(tree, moving, overlay);
        std::map<uint32_t, double> areas;
        for (const BspOverlay::Entry& entry : overlay.entries) addAreas(overlay, overlay.piecesOf(entry), areas);
        for (const BspNode& node : overlay.nodes) addAreas(overlay, overlay.piecesOf(node), areas);
        expectSameAreas(areasOf(moving), areas);
        pairs += expectOrders(BspOverlaid{tree, overlay}, tree, &overlay, uint64_t(frame), 4, 80);
    }
    EXPECT_GT(pairs, 3000u);
    EXPECT_TRUE(tree.points == copy.points && tree.leaf == copy.leaf && tree.below == copy.below);
    EXPECT_EQ(0, std::memcmp(tree.nodes.data(), copy.nodes.data(), copy.nodes.size() * sizeof(BspNode)));
}

}  // namespace
}  // namespace sightline::test
