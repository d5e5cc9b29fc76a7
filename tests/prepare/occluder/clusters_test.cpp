// The laws of clusters: what hangs together has each of its sides in one edge record, and every record is right.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/occluder/occluder.h"

#include <gtest/gtest.h>

#include "tests/prepare/occluder/patch_laws.h"

namespace sightline {
namespace {

uint32_t openEdges(const Occluder& o) {
    uint32_t count = 0;
    for (const OccluderEdge& edge : o.edges) count += edge.right == OccluderEdge::kNone;
    return count;
}

TEST(Clusters, ABoxIsOneClusterOfSixQuadsAndTwelveEdges) {
    Soup soup;
    soup.addBox({0, 0, 0}, {1, 2, 3});
    const Occluder o = prepareOccluder(soup.view());
    expectOccluderLaws(o);
    ASSERT_EQ(o.clusters.size(), 1u);
    EXPECT_EQ(o.clusters[0].polygon_count, 6u);
    EXPECT_EQ(o.clusters[0].vertex_count, 8u);
    EXPECT_EQ(o.clusters[0].edge_count, 12u);
    EXPECT_EQ(openEdges(o), 0u);
}

TEST(Clusters, EachSideOfAClosedSurfaceIsInOneRecord) {
    for (uint64_t seed = 1; seed <= 6; ++seed)
        for (uint32_t own : {16u, 64u, 128u}) {
            SCOPED_TRACE(::testing::Message() << "seed " << seed << ", own " << own);
            const Soup soup = makeBall(seed, uint32_t(2 + 3 * seed));
            const Occluder o = prepareOccluder(soup.view(), {}, {}, {.own_polygons = own});
            expectOccluderLaws(o);
            EXPECT_EQ(o.triangleCount(), soup.indices.size() / 3);
            if (o.clusters.size() == 1) { EXPECT_EQ(openEdges(o), 0u); }
            for (const OccluderCluster& c : o.clusters) {
                EXPECT_GT(c.edge_count, 0u);
                EXPECT_LE(c.polygon_count, own);
            }
        }
}

TEST(Clusters, WhatDoesNotHangTogetherIsGatheredWithoutEdges) {
    Random random(5);
    Soup soup;
    for (int i = 0; i < 500; ++i) {
        const glm::vec3 p(random.uniform(0, 100), random.uniform(0, 100), random.uniform(0, 100));
        if (i % 2) soup.add({p, p + glm::vec3(1, 0, 0), p + glm::vec3(0, 1, 0)});
        else soup.add({p, p + glm::vec3(1, 0, 0), p + glm::vec3(1, 1, 0), p + glm::vec3(0, 1, 0)});
    }
    soup.addBox({200, 0, 0}, {201, 1, 1});
    const Occluder o = prepareOccluder(soup.view());
    expectWithinLimits(o);
    uint32_t loose = 0;
    for (const OccluderCluster& c : o.clusters) loose += c.edge_count ? 0 : c.polygon_count;
    EXPECT_EQ(loose, 500u);
    EXPECT_EQ(o.clusters.size(), (500u + OccluderCluster::kMaxLoose - 1) / OccluderCluster::kMaxLoose + 1);
    EXPECT_EQ(o.edges.size(), 12u);
}

TEST(Clusters, AreSmallerWhereTheyDoNotFaceOneWay) {
    Soup ground;
    Random random(4);
    for (int j = 0; j < 40; ++j)
        for (int i = 0; i < 40; ++i) ground.add({{i, 0, j}, {i, 0, j + 1}, {i + 1, 0, j + 1}, {i + 1, 0, j}});
    for (glm::vec3& p : ground.positions) p.y = 0.1f * float(Random(uint64_t(p.x * 100 + p.z)).uniform());
    const Occluder flat = prepareOccluder(ground.view());
    const Occluder ball = prepareOccluder(makeBall(4, 20).view());
    expectWithinLimits(flat);
    expectWithinLimits(ball);
    uint32_t most_flat = 0, polygons = 0;
    for (const OccluderCluster& c : flat.clusters) most_flat = std::max(most_flat, c.polygon_count);
    EXPECT_GT(most_flat, 100u);
    for (const OccluderCluster& c : flat.clusters) polygons += c.polygon_count;
    EXPECT_LE(flat.clusters.size(), polygons / 90);
    for (const Occluder* o : {&flat, &ball})
        for (const OccluderCluster& c : o->clusters) {
            if (c.polygon_count <= OccluderSettings().folded_polygons) continue;
            glm::vec3 sum(0.0f);
            std::vector<glm::vec3> normals;
            for (uint32_t p = 0; p < c.polygon_count; ++p) {
                const uint8_t* v = o->polygons[c.first_polygon + p].vertex;
                const auto at = [&](int k) { return positionOf(*o, c, v[k]); };
                normals.push_back(glm::normalize(glm::cross(at(1) - at(0), at(2) - at(0))));
                sum += normals.back();
            }
            for (const glm::vec3& n : normals) EXPECT_GT(glm::dot(n, sum), 0.29f * glm::length(sum));
        }
}

TEST(Clusters, EdgesOfMoreThanTwoPolygonsHaveSeveralRecords) {
    for (uint64_t seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE(seed);
        // Triangles on few vertices: sides are shared by any number, in both directions.
        Random random(seed);
        Soup soup;
        for (int i = 0; i < 12; ++i) soup.positions.push_back({random.uniform(), random.uniform(), random.uniform()});
        for (int i = 0; i < 3 * 60; ++i) soup.indices.push_back(uint32_t(random.below(12)));
        const Occluder o = prepareOccluder(soup.view());
        expectOccluderLaws(o);
    }
}

TEST(Clusters, FacesBetweenBoxesDoNotBreakTheWall) {
    // Boxes that touch in a grid: each outer face goes on in the next, and the faces between them lie elsewhere.
    Soup soup;
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 4; ++j) soup.addBox({i, j, 0}, {i + 1, j + 1, 1});
    const Occluder o = prepareOccluder(soup.view(), {}, {}, {.folded_polygons = OccluderCluster::kMaxOwn});
    expectOccluderLaws(o);
    uint32_t closed = 0;
    for (const OccluderCluster& c : o.clusters) {
        uint32_t front = 0;
        for (uint32_t p = c.first_polygon; p < c.first_polygon + c.polygon_count; ++p) {
            bool in_front = true;
            for (int k = 0; k < 4; ++k) in_front &= positionOf(o, c, o.polygons[p].vertex[k]).z == 1;
            front += in_front;
        }
        if (!front) continue;
        // All that can be seen from outside is one closed surface.
        EXPECT_EQ(front, 20u);
        EXPECT_EQ(c.polygon_count, 2u * (20 + 5 + 4));
        for (uint32_t e = c.first_edge; e < c.first_edge + c.edge_count; ++e)
            closed += o.edges[e].right != OccluderEdge::kNone;
        EXPECT_EQ(closed, c.edge_count);
    }
    EXPECT_GT(closed, 0u);
}

}  // namespace
}  // namespace sightline
