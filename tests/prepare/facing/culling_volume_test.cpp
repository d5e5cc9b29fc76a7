// How much of space a volume culls, beside random eyes; and what joining volumes may and may not do.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/facing/culling_volume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sightline/base/random.h"
#include "tests/prepare/facing/volume_polyhedron.h"
#include "tests/support/random.h"

namespace sightline {
namespace {

double highest(const CullingVolume& volume, const glm::dvec3& q) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis)
        sum += std::max(double(volume.most[axis]) * q[axis], double(volume.least[axis]) * q[axis]);
    return sum;
}

bool culls(const CullingVolume& volume, const glm::dvec3& eye) {
    return highest(volume, eye - glm::dvec3(volume.origin)) <= volume.back;
}

std::vector<Facet> randomFacets(Random& random, int count, double spread) {
    const glm::dvec3 ahead = glm::normalize(test::randomVector(random, 1.0) + glm::dvec3(0.01)),
                     place = test::randomVector(random, 2.0);
    std::vector<Facet> facets;
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 p = place + test::randomVector(random, 0.5);
        facets.push_back({glm::normalize(ahead + spread * test::randomVector(random, 1.0)), {p, p, p}});
    }
    return facets;
}

TEST(CullingProbability, IsTheShareOfRandomEyes) {
    Random random(111);
    double worst = 0, largest = 0;
    for (int round = 0; round < 60; ++round) {
        const std::vector<Facet> facets =
            randomFacets(random, 1 + static_cast<int>(random.below(20)), random.uniform(0.0, 0.9));
        Box3d eyes;
        eyes.grow(test::randomVector(random, 6.0));
        eyes.grow(test::randomVector(random, 6.0));
        CullingVolume volume = makeCullingVolume(facets, eyes);
        // Weights that are nothing or next to nothing: walls along the axes.
        if (round % 4 == 0) volume.most.x = volume.least.x = 0.0f;
        if (round % 8 == 0) volume.most.y = volume.least.y = 1e-6f;
        const double share = cullingProbability(volume, eyes);
        const int samples = 100000;
        int inside = 0;
        for (int i = 0; i < samples; ++i) {
            const double x = random.uniform(eyes.min.x, eyes.max.x), y = random.uniform(eyes.min.y, eyes.max.y);
            inside += culls(volume, {x, y, random.uniform(eyes.min.z, eyes.max.z)});
        }
        const double counted = static_cast<double>(inside) / samples;
        worst = std::max(worst, std::abs(share - counted));
        largest = std::max(largest, share);
    }
    EXPECT_LT(worst, 0.008);  // five standard deviations
    EXPECT_GT(largest, 0.3);
}

TEST(CullingProbability, OfABoxAndAHalfSpaceIsWhatGeometrySays) {
    const glm::dvec3 one(1.0);
    EXPECT_NEAR(volumeBelow(one, {1, 1, 1}, 1.0), 1.0 / 6.0, 1e-12);  // a corner
    EXPECT_NEAR(volumeBelow(one, {1, 1, 1}, 1.5), 0.5, 1e-12);
    EXPECT_NEAR(volumeBelow(one, {1, 1, 1}, 2.0), 5.0 / 6.0, 1e-12);
    EXPECT_NEAR(volumeBelow(one, {-1, -1, -1}, -2.0), 1.0 / 6.0, 1e-12);
    EXPECT_NEAR(volumeBelow({2, 3, 4}, {1, 0, 0}, 0.5), 6.0, 1e-12);
    EXPECT_NEAR(volumeBelow({2, 3, 4}, {0, 1, 1e-9}, 1.5), 12.0, 1e-6);
    EXPECT_EQ(volumeBelow(one, {0, 0, 0}, 0.0), 1.0);
    EXPECT_EQ(volumeBelow(one, {0, 0, 0}, -0.1), 0.0);
    EXPECT_EQ(volumeBelow(one, {1, 1, 1}, 4.0), 1.0);
    EXPECT_EQ(volumeBelow(one, {1, 1, 1}, -0.1), 0.0);
}

TEST(CullingVolume, AChosenOriginIsNoWorseThanTheCentre) {
    Random random(112);
    int better = 0;
    for (int round = 0; round < 500; ++round) {
        const std::vector<Facet> facets = randomFacets(random, 8, random.uniform(0.0, 1.0));
        const Box3d eyes{glm::dvec3(-6.0), glm::dvec3(6.0)};
        Box3d box;
        for (const Facet& facet : facets)
            for (const glm::dvec3& p : facet.corner) box.grow(p);
        const double at_center = cullingProbability(cullingVolumeAt(facets, glm::vec3(box.center())), eyes);
        const double chosen = cullingProbability(makeCullingVolume(facets, eyes), eyes);
        EXPECT_GE(chosen, at_center);
        better += chosen > at_center;
    }
    EXPECT_GT(better, 100);
}

TEST(CullingVolume, AJoinedOneCullsOnlyWhatBothCull) {
    Random random(113);
    size_t culled = 0;
    for (int round = 0; round < 2000; ++round) {
        std::vector<Facet> one = randomFacets(random, 5, 0.2);
        const std::vector<Facet> more = randomFacets(random, 5, 0.2);
        const CullingVolume a = cullingVolumeAt(one, glm::vec3(test::randomVector(random, 2.0)));
        const CullingVolume b = cullingVolumeAt(more, glm::vec3(test::randomVector(random, 2.0)));
        const CullingVolume joined = joinVolumes(a, b, glm::vec3(test::randomVector(random, 2.0)));
        one.insert(one.end(), more.begin(), more.end());
        const CullingVolume exact = cullingVolumeAt(one, joined.origin);
        EXPECT_LE(joined.back, exact.back);
        EXPECT_GE(joined.front, exact.front);
        for (int i = 0; i < 100; ++i) {
            const glm::dvec3 eye = test::randomVector(random, 20.0);
            if (!culls(joined, eye)) continue;
            ++culled;
            for (const Facet& facet : one)
                ASSERT_LE(glm::dot(facet.normal, eye - facet.corner[0]), 1e-6) << "round " << round;
        }
    }
    EXPECT_GT(culled, 1000u);
}

TEST(VolumePolyhedron, HoldsTheVolumeThatTheClosedFormSays) {
    Random random(114);
    int solids = 0, empty = 0;
    for (int round = 0; round < 2000; ++round) {
        const std::vector<Facet> facets =
            randomFacets(random, 1 + static_cast<int>(random.below(10)), random.uniform(0.0, 0.9));
        Box3d box;
        box.grow(test::randomVector(random, 6.0));
        box.grow(test::randomVector(random, 6.0));
        const CullingVolume volume = makeCullingVolume(facets, box);
        const Polyhedron solid = volumePolyhedron(volume, box);
        double six_times = 0;
        const std::vector<uint32_t> triangles = trianglesOf(solid);
        for (size_t i = 0; i < triangles.size(); i += 3) {
            const auto at = [&](size_t k) { return solid.positions[triangles[i + k]] - box.min; };
            six_times += glm::dot(at(0), glm::cross(at(1), at(2)));
        }
        const glm::dvec3 size = box.max - box.min;
        const double whole = size.x * size.y * size.z;
        EXPECT_NEAR(six_times / 6.0 / whole, cullingProbability(volume, box), 2e-5) << "round " << round;
        for (const glm::dvec3& p : solid.positions)
            EXPECT_LE(highest(volume, p - glm::dvec3(volume.origin)) - volume.back, 1e-7) << "round " << round;
        (solid.faces.empty() ? empty : solids) += 1;
    }
    EXPECT_GT(solids, 500);
    EXPECT_GT(empty, 50);
}

}  // namespace
}  // namespace sightline
