// The laws of rings: the neighbours at a vertex, all of them, so that no side of a cluster's own polygons stays open.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/occluder/occluder.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/prepare/occluder/patch_laws.h"

namespace sightline {
namespace {

/// Of one occluder or of several that share an object space.
void expectRings(std::span<const Occluder> occluders) {
    std::map<Point, std::set<Corners>> around;
    for (const Occluder& o : occluders)
        for (const OccluderCluster& c : o.clusters)
            for (uint32_t p = 0; p < c.polygon_count; ++p) {
                const Corners corners = cornersOf(o, c, p);
                for (const Point& point : corners) EXPECT_TRUE(around[point].insert(corners).second);
            }
    for (const Occluder& o : occluders)
        for (const OccluderCluster& c : o.clusters) {
            std::set<Corners> expected, ring;
            for (uint32_t p = 0; p < c.polygon_count; ++p)
                for (const Point& point : cornersOf(o, c, p))
                    expected.insert(around[point].begin(), around[point].end());
            for (uint32_t p = 0; p < c.polygon_count; ++p) expected.erase(cornersOf(o, c, p));
            for (uint32_t p = 0; p < c.ring_count; ++p) ring.insert(cornersOf(o, c, c.polygon_count + p));
            EXPECT_EQ(ring.size(), c.ring_count);
            EXPECT_EQ(ring, expected);
        }
}

/// Deals the triangles of a mesh to several.
std::vector<Soup> deal(const Soup& soup, uint64_t seed, size_t meshes) {
    Random random(seed);
    std::vector<Soup> out(meshes);
    for (size_t t = 0; t < soup.indices.size(); t += 3)
        out[random.below(meshes)].add({soup.positions[soup.indices[t]], soup.positions[soup.indices[t + 1]],
                                       soup.positions[soup.indices[t + 2]]});
    return out;
}

TEST(Rings, HoldAllNeighboursAtAVertexAndNoOthers) {
    for (uint64_t seed = 1; seed <= 5; ++seed)
        for (uint32_t own : {8u, 40u, 64u}) {
            SCOPED_TRACE(::testing::Message() << "seed " << seed << ", own " << own);
            const Soup soup = makeBall(seed, uint32_t(4 + 3 * seed));
            const Occluder o = prepareOccluder(soup.view(), {}, {}, {.own_polygons = own, .rings = true});
            expectOccluderLaws(o);
            expectRings({&o, 1});
            EXPECT_EQ(ownOpenEdges(o), 0u);
            EXPECT_EQ(o.triangleCount(), soup.indices.size() / 3);
        }
}

TEST(Rings, ChangeNothingOfTheClustersOwnPolygons) {
    const Soup soup = makeBall(3, 20);
    const Occluder with = prepareOccluder(soup.view(), {}, {}, {.rings = true}), without = prepareOccluder(soup.view());
    ASSERT_EQ(with.clusters.size(), without.clusters.size());
    for (size_t i = 0; i < with.clusters.size(); ++i) {
        ASSERT_EQ(with.clusters[i].polygon_count, without.clusters[i].polygon_count);
        EXPECT_EQ(with.clusters[i].bounds.min, without.clusters[i].bounds.min);
        EXPECT_EQ(with.clusters[i].bounds.max, without.clusters[i].bounds.max);
        EXPECT_GT(with.clusters[i].ring_count, 0u);
        EXPECT_EQ(without.clusters[i].ring_count, 0u);
        for (uint32_t p = 0; p < with.clusters[i].polygon_count; ++p)
            EXPECT_EQ(cornersOf(with, with.clusters[i], p), cornersOf(without, without.clusters[i], p));
    }
}

TEST(Rings, ReachAcrossMeshes) {
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE(seed);
        const Soup soup = makeBall(seed, 12);
        const std::vector<Soup> meshes = deal(soup, seed, 3);
        const std::vector<Occluder> occluders =
            prepareOccluders(sourcesOf(meshes), {.own_polygons = 32, .rings = true});
        ASSERT_EQ(occluders.size(), 3u);
        for (size_t m = 0; m < 3; ++m) {
            expectOccluderLaws(occluders[m]);
            EXPECT_EQ(ownOpenEdges(occluders[m]), 0u);
            EXPECT_EQ(occluders[m].triangleCount(), meshes[m].indices.size() / 3);
        }
        expectRings(occluders);
    }
}

TEST(Rings, ClustersAcrossMeshesAreThoseOfOneMesh) {
    const Soup soup = makeBall(7, 12);
    std::vector<Soup> slices(4);  // in order, so that the triangles come as they do in the whole
    for (size_t t = 0; t < soup.indices.size(); t += 3)
        slices[4 * t / soup.indices.size()].add({soup.positions[soup.indices[t]], soup.positions[soup.indices[t + 1]],
                                                 soup.positions[soup.indices[t + 2]]});
    const Occluder joined = prepareJoined(sourcesOf(slices), {.rings = true});
    expectOccluderLaws(joined);
    EXPECT_EQ(ownOpenEdges(joined), 0u);
    EXPECT_EQ(joined.triangleCount(), soup.indices.size() / 3);
    EXPECT_EQ(joined.clusters.size(), prepareOccluder(soup.view(), {}, {}, {.rings = true}).clusters.size());
}

TEST(Rings, LeaveOutWhatDoesNotFit) {
    // Two fans of 2000 around an axis: the middle vertices have more neighbours than any cluster can hold.
    Soup soup;
    constexpr int kSlices = 2000;
    const auto rim = [](int i) {
        const double angle = 6.283185307179586 * (i % kSlices) / kSlices;
        return glm::vec3(std::cos(angle), 0, std::sin(angle));
    };
    for (int i = 0; i < kSlices; ++i) {
        soup.add({{0, 1, 0}, rim(i + 1), rim(i)});
        soup.add({{0, -1, 0}, rim(i), rim(i + 1)});
    }
    for (uint32_t own : {20u, 128u}) {
        const Occluder o = prepareOccluder(soup.view(), {}, {}, {.own_polygons = own, .rings = true});
        expectOccluderLaws(o);
        for (const OccluderCluster& c : o.clusters) EXPECT_GT(c.ring_count, 0u);
        if (own == 20) {
            EXPECT_EQ(ownOpenEdges(o), 0u);  // the neighbours across a side are found at its other end
        }
    }
}

}  // namespace
}  // namespace sightline
