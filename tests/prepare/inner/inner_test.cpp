// The law of simpler occluders: every point of them lies in the solid, by solid angles; and what is no solid is left alone.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/inner/inner.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sightline/prepare/inner/inner_hull.h"
#include "sightline/prepare/occluder/patchwork.h"
#include "tests/prepare/occluder/patch_laws.h"

namespace sightline {
namespace {

constexpr double kPi = 3.14159265358979323846;

using Face = std::array<glm::dvec3, 3>;

std::vector<Face> facesOf(const Soup& soup) {
    std::vector<Face> faces;
    for (size_t t = 0; t < soup.indices.size(); t += 3) {
        Face& face = faces.emplace_back();
        for (size_t k = 0; k < 3; ++k) face[k] = soup.positions[soup.indices[t + k]];
    }
    return faces;
}

std::vector<Face> facesOf(const Occluder& o) {
    std::vector<Face> faces;
    for (const OccluderCluster& c : o.clusters)
        for (uint32_t p = 0; p < c.polygon_count; ++p) {
            const OccluderPolygon& polygon = o.polygons[c.first_polygon + p];
            for (int k = 2; k < polygon.corners(); ++k)
                faces.push_back({positionOf(o, c, polygon.vertex[0]), positionOf(o, c, polygon.vertex[k - 1]),
                                 positionOf(o, c, polygon.vertex[k])});
        }
    return faces;
}

/// How often a closed surface winds around a point, from the solid angles of its triangles.
///
/// Adriaan van Oosterom, Jan Strackee. The Solid Angle of a Plane Triangle. 1983.
double windingAround(const std::vector<Face>& faces, const glm::dvec3& p) {
    double sum = 0;
    for (const Face& face : faces) {
        const glm::dvec3 a = face[0] - p, b = face[1] - p, c = face[2] - p;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        sum += 2 * std::atan2(glm::dot(a, glm::cross(b, c)),
                              la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return sum / (4 * kPi);
}

double volumeOf(const std::vector<Face>& faces) {
    double sum = 0;
    for (const Face& face : faces) sum += glm::dot(face[0], glm::cross(face[1], face[2]));
    return sum / 6;
}

/// A point of each face, moved a little to its back, is inside the other surface, or no farther from it than that.
void expectWithin(const std::vector<Face>& inner, const std::vector<Face>& outer, uint64_t seed) {
    Random random(seed);
    for (const Face& face : inner) {
        double a = random.uniform(), b = random.uniform();
        if (a + b > 1) a = 1 - a, b = 1 - b;
        const glm::dvec3 n = glm::cross(face[1] - face[0], face[2] - face[0]);
        const glm::dvec3 p = face[0] + a * (face[1] - face[0]) + b * (face[2] - face[0]) - 1e-7 * n / glm::length(n);
        ASSERT_GT(windingAround(outer, p), 0.5) << "seed " << seed;
    }
}

/// A thin bowl: the upper half of a ball folded into the lower one.
Soup makeBowl(uint64_t seed, uint32_t n) {
    Soup soup = makeBall(seed, n);
    for (glm::vec3& p : soup.positions) {
        p = glm::normalize(p);
        if (p.y > 0) p.y *= -0.7f;
    }
    return soup;
}

/// A ring of squares around the y axis, each divided n by n around: a torus with creases.
Soup makeTorus(uint32_t around, uint32_t across) {
    Soup soup;
    const auto at = [&](uint32_t i, uint32_t j) {
        const double u = 2 * kPi * (i % around) / around, v = 2 * kPi * (j % across) / across;
        const double r = 1 + 0.3 * std::cos(v);
        return glm::vec3(r * std::cos(u), 0.3 * std::sin(v), r * std::sin(u));
    };
    for (uint32_t i = 0; i < around; ++i)
        for (uint32_t j = 0; j < across; ++j) soup.add({at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
    return soup;
}

std::vector<SolidTriangle> weldedTriangles(const Soup& soup, Patchwork& patchwork) {
    const OccluderSource source{soup.view(), {}, {}};
    patchwork = weld({&source, 1});
    std::vector<SolidTriangle> triangles;
    for (const PatchPolygon& p : patchwork.polygons) triangles.push_back({{p.vertex[0], p.vertex[1], p.vertex[2]}});
    return triangles;
}

size_t countSolids(const Soup& soup) {
    Patchwork patchwork;
    const std::vector<SolidTriangle> triangles = weldedTriangles(soup, patchwork);
    return findSolids(patchwork.positions, triangles).size();
}

TEST(Solids, AreClosedAndFaceOutward) {
    EXPECT_EQ(countSolids(makeBall(1, 6)), 1u);
    EXPECT_EQ(countSolids(makeBowl(1, 8)), 1u);
    EXPECT_EQ(countSolids(makeTorus(24, 12)), 1u);
    Soup two = makeBall(1, 4);
    two.addBox({5, 0, 0}, {6, 1, 1});
    EXPECT_EQ(countSolids(two), 2u);
    Soup open = makeBall(1, 6);
    open.indices.resize(open.indices.size() - 3);
    EXPECT_EQ(countSolids(open), 0u);
    Soup inside_out = makeBall(1, 6);
    for (size_t t = 0; t < inside_out.indices.size(); t += 3)
        std::swap(inside_out.indices[t], inside_out.indices[t + 1]);
    EXPECT_EQ(countSolids(inside_out), 0u);
}

TEST(Solids, DoNotCrossThemselves) {
    // A bowl whose inner wall is pushed through the outer one.
    Soup crossed = makeBall(1, 8);
    for (glm::vec3& p : crossed.positions)
        if (p.y > 0) p.y *= p.x > 0.3f ? -1.3f : -0.7f;
    EXPECT_EQ(countSolids(crossed), 0u);
}

TEST(InnerHull, OnlyShrinks) {
    for (uint64_t seed = 1; seed <= 4; ++seed)
        for (const Soup& soup : {makeBall(seed, 9), makeBowl(seed, 9), makeTorus(30, 16 + uint32_t(seed))}) {
            Patchwork patchwork;
            const std::vector<SolidTriangle> triangles = weldedTriangles(soup, patchwork);
            const std::vector<Solid> solids = findSolids(patchwork.positions, triangles);
            ASSERT_EQ(solids.size(), 1u);
            InnerHull hull(patchwork.positions, triangles, solids[0]);
            const std::vector<Face> outer = facesOf(soup);
            double last = volumeOf(outer);
            for (const float worst : {0.02f, 0.08f, 0.4f}) {
                hull.simplify(4, worst);
                EXPECT_LE(hull.error(), worst);
                std::vector<Face> inner;
                for (const SolidTriangle& t : hull.triangles())
                    inner.push_back(
                        {hull.positions()[t.vertex[0]], hull.positions()[t.vertex[1]], hull.positions()[t.vertex[2]]});
                EXPECT_LE(volumeOf(inner), last * (1 + 1e-6));
                last = volumeOf(inner);
                expectWithin(inner, outer, seed);
                // Anywhere in space: it winds around nothing that the solid does not wind around, and never backward.
                Random random(seed);
                for (int i = 0; i < 300; ++i) {
                    const glm::dvec3 p(random.uniform(-1.2, 1.2), random.uniform(-1.1, 1.1), random.uniform(-1.2, 1.2));
                    const double within = windingAround(inner, p);
                    EXPECT_GT(within, -0.01);
                    EXPECT_LT(within, windingAround(outer, p) + 0.01);
                }
            }
            EXPECT_LT(hull.triangleCount(), triangles.size() / 2);
        }
}

TEST(Inner, LevelsLieInsideAndAreCheaper) {
    const Soup soup = makeBowl(3, 16);
    const std::vector<InnerOccluder> levels = prepareInner(soup.view());
    ASSERT_GE(levels.size(), 2u);
    const std::vector<Face> outer = facesOf(soup);
    size_t triangles = outer.size();
    float error = 0;
    for (const InnerOccluder& level : levels) {
        EXPECT_LE(level.occluder.triangleCount(), 0.7 * double(triangles));
        EXPECT_GT(level.error, error);
        triangles = level.occluder.triangleCount();
        error = level.error;
        expectWithinLimits(level.occluder);
        expectWithin(facesOf(level.occluder), outer, 1);
        for (const glm::vec3& p : soup.positions) { EXPECT_EQ(glm::clamp(p, level.outside.min, level.outside.max), p); }
    }
    EXPECT_LT(triangles, outer.size() / 2);
}

TEST(Inner, TakesWhatIsDrawnOnBothSidesForASolidEitherWay) {
    Soup soup = makeBall(1, 12);
    for (size_t t = 0; t < soup.indices.size(); t += 3) std::swap(soup.indices[t], soup.indices[t + 1]);
    EXPECT_TRUE(prepareInner(soup.view()).empty());
    const std::vector<uint8_t> both(soup.indices.size() / 3, 1);
    const std::vector<InnerOccluder> levels = prepareInner(soup.view(), {}, both);
    ASSERT_FALSE(levels.empty());
    expectWithin(facesOf(levels.back().occluder), facesOf(makeBall(1, 12)), 1);
}

TEST(Inner, LeavesOpenSurfacesAsTheyAre) {
    Soup soup = makeBall(1, 12);
    EXPECT_FALSE(prepareInner(soup.view()).empty());
    std::vector<uint8_t> hides(soup.indices.size() / 3, 1);
    hides[0] = 0;  // of glass, say
    EXPECT_TRUE(prepareInner(soup.view(), hides).empty());

    // Beside a solid, each of an open surface's triangles is in every level that is fine enough to show it.
    Soup beside = soup;
    beside.add({{3, 0, 0}, {5, 0, 0}, {5, 2, 0.1f}, {3, 2, 0}});
    for (const InnerOccluder& level : prepareInner(beside.view())) {
        double area = 0;
        for (const Face& face : facesOf(level.occluder))
            if (face[0].x > 2) area += 0.5 * glm::length(glm::cross(face[1] - face[0], face[2] - face[0]));
        EXPECT_NEAR(area, 4.0, 0.02);
    }
}

TEST(Inner, IsTheSameEachTime) {
    const Soup soup = makeBowl(5, 12);
    const std::vector<InnerOccluder> a = prepareInner(soup.view()), b = prepareInner(soup.view());
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i) EXPECT_EQ(facesOf(a[i].occluder), facesOf(b[i].occluder));
}

}  // namespace
}  // namespace sightline
