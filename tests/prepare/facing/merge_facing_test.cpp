// Merged clusters: every triangle once, never dearer than what they were made of, and as dear as random eyes say.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/facing/merge_facing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sightline/base/random.h"
#include "sightline/prepare/facing/facing_clusters.h"
#include "tests/support/meshes.h"

namespace sightline {
namespace {

/// A ball with bumps, of shared vertices.
test::TestMesh ball(int rings, double bumps) {
    test::TestMesh mesh;
    const int columns = 2 * rings;
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j < columns; ++j) {
            const double a = glm::radians(180.0) * i / rings, b = glm::radians(360.0) * j / columns;
            const double r = 1.0 + bumps * std::sin(7 * a) * std::cos(5 * b);
            mesh.positions.push_back(
                glm::vec3(r * std::sin(a) * std::cos(b), r * std::cos(a), r * std::sin(a) * std::sin(b)));
        }
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < columns; ++j) {
            const auto at = [&](int x, int y) { return static_cast<uint32_t>(x * columns + y % columns); };
            for (const uint32_t v :
                 {at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)})
                mesh.indices.push_back(v);
        }
    return mesh;
}

double costOf(const test::TestMesh& mesh, const std::vector<uint32_t>& order, uint32_t size, const FacingCost& cost) {
    std::vector<uint32_t> sizes;
    for (size_t i = 0; i < order.size(); i += size)
        sizes.push_back(static_cast<uint32_t>(std::min<size_t>(size, order.size() - i)));
    return modelledCost(describeClusters(mesh.view(), order, sizes), mesh.view(), cost);
}

TEST(MergeFacing, HoldsEveryTriangleOnceAndCostsLessThanPlainRuns) {
    for (const double bumps : {0.0, 0.05, 0.3}) {
        const test::TestMesh mesh = ball(24, bumps);
        for (const double test : {1.0, 4.0, 16.0}) {
            FacingCost cost{.test = test};
            const FacingPartition part = mergeFacing(mesh.view(), cost);
            std::vector<uint32_t> sorted = part.triangles, all(mesh.view().triangles());
            std::sort(sorted.begin(), sorted.end());
            std::iota(all.begin(), all.end(), 0u);
            ASSERT_EQ(sorted, all);
            ASSERT_EQ(std::accumulate(part.sizes.begin(), part.sizes.end(), size_t{0}), all.size());
            EXPECT_LE(*std::max_element(part.sizes.begin(), part.sizes.end()), MergeLimits{}.triangles);
            const double merged =
                modelledCost(describeClusters(mesh.view(), part.triangles, part.sizes), mesh.view(), cost);
            // The records have better origins than the merging had.
            EXPECT_LE(merged, part.cost * 1.001);
            for (const uint32_t size : {1u, 4u, 16u, 64u}) EXPECT_LT(merged, costOf(mesh, all, size, cost)) << size;
        }
    }
}

TEST(MergeFacing, TheModelledCostIsThatOfRandomEyes) {
    const test::TestMesh mesh = ball(20, 0.1);
    const FacingCost cost;
    const FacingPartition part = mergeFacing(mesh.view(), cost);
    const FacingClusters clusters = describeClusters(mesh.view(), part.triangles, part.sizes);
    const double modelled = modelledCost(clusters, mesh.view(), cost);
    Box3d box;
    for (const glm::vec3& p : mesh.positions) box.grow(glm::dvec3(p));
    const Box3d eyes = eyeSpace(box, cost.eye_space);
    Random random(121);
    double sum = 0;
    const int samples = 4000;
    for (int i = 0; i < samples; ++i) {
        const double x = random.uniform(eyes.min.x, eyes.max.x), y = random.uniform(eyes.min.y, eyes.max.y);
        const glm::dvec3 eye = glm::dvec3(x, y, random.uniform(eyes.min.z, eyes.max.z)) - clusters.origin;
        for (size_t c = 0; c < clusters.count(); ++c) {
            const CullingVolume v = clusters.volume(c);
            double most = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const double q = eye[axis] - v.origin[axis];
                most += std::max(v.most[axis] * q, v.least[axis] * q);
            }
            sum += cost.test + (most <= v.back ? 0 : clusters.size(c));
        }
    }
    EXPECT_NEAR(sum / samples / modelled, 1.0, 0.02);
}

TEST(MergeFacing, PutsWhatFacesNobodyAside) {
    test::TestMesh mesh = ball(6, 0.0);  // with triangles at its poles that have collapsed, nearly or wholly
    mesh.indices.insert(mesh.indices.end(), {0, 0, 5});
    const FacingPartition part = mergeFacing(mesh.view());
    EXPECT_EQ(part.triangles.size(), mesh.view().triangles());
    const FacingPartition none = mergeFacing({});
    EXPECT_TRUE(none.triangles.empty() && none.sizes.empty());
}

}  // namespace
}  // namespace sightline
