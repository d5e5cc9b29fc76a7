// Laws of clipping meshes: outcodes decide nothing wrongly, shared edges stay shared, and counters add up.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/project/clip_mesh.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/studies/hidden/project/clip.h"
#include "sightline/studies/hidden/project/scan.h"

namespace sightline {
using namespace studies;
namespace {

struct Made {
    std::vector<glm::dvec4> vertices;
    std::vector<uint32_t> indices;
};

glm::dvec4 randomPoint(Random& random) {
    return {random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(-3, 3), random.uniform(-1, 4)};
}

/// A closed surface, so that each edge belongs to two triangles.
Made tetrahedron(Random& random) {
    Made made;
    for (int i = 0; i < 4; ++i) made.vertices.push_back(randomPoint(random));
    made.indices = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    return made;
}

double areaOf(const std::vector<glm::dvec4>& vertices, const uint32_t* corner) {
    const glm::dvec4 &a = vertices[corner[0]], &b = vertices[corner[1]], &c = vertices[corner[2]];
    return 0.5 * ((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y));
}

double areaOf(const std::vector<glm::dvec4>& vertices, const std::vector<uint32_t>& indices) {
    double sum = 0;
    for (size_t i = 0; i < indices.size(); i += 3) sum += areaOf(vertices, indices.data() + i);
    return sum;
}

TEST(ClipMesh, FansHaveTwoTrianglesLessThanCorners) {
    const uint32_t polygon[5] = {7, 3, 9, 4, 1};
    std::vector<uint32_t> indices;
    appendFan(polygon, indices);
    EXPECT_EQ(indices, (std::vector<uint32_t>{7, 3, 9, 7, 9, 4, 7, 4, 1}));
    indices.clear();
    appendFan(std::span(polygon, 2), indices);
    EXPECT_TRUE(indices.empty());
}

TEST(ClipMesh, IsWhatPlaneByPlaneClippingLeaves) {
    Random random(21);
    uint64_t cut = 0;
    for (int i = 0; i < 20000; ++i) {
        const Made made = tetrahedron(random);
        const ClipVolume volume = frustumVolume();
        ClippedMesh out;
        clipMesh(made.vertices, made.indices, {}, volume, out);
        double expected = 0;
        for (size_t t = 0; t < made.indices.size(); t += 3) {
            ClipPolygon polygon;
            polygon.count = 3;
            for (size_t k = 0; k < 3; ++k) polygon.vertices[k] = made.vertices[made.indices[t + k]];
            for (int plane = 0; plane < volume.count; ++plane) {
                ClipPolygon rest;
                clipToPlane(polygon, volume.planes[plane], rest);
                polygon = rest;
            }
            for (int k = 2; k < polygon.count; ++k) {
                const std::vector<glm::dvec4> fan = {polygon.vertices[0], polygon.vertices[k - 1], polygon.vertices[k]};
                expected += areaOf(fan, {0, 1, 2});
            }
        }
        EXPECT_NEAR(areaOf(out.vertices, out.indices), expected, 1e-12) << "case " << i;
        const ClipCounters& counters = out.counters;
        EXPECT_EQ(counters.triangles, 4u);
        EXPECT_EQ(counters.rejected + counters.accepted + counters.clipped, counters.triangles);
        EXPECT_EQ(counters.produced * 3, out.indices.size());
        EXPECT_EQ(out.source.size(), counters.produced);
        cut += counters.clipped;
        for (uint32_t index : out.indices)
            for (int plane = 0; plane < volume.count; ++plane)
                EXPECT_GE(glm::dot(volume.planes[plane], out.vertices[index]), -1e-13) << "case " << i;
    }
    EXPECT_GT(cut, 20000u);
}

/// The surface stays closed but for its borders on planes: each edge of a clipped tetrahedron meets its reverse bit by
/// bit, or lies on a plane.
TEST(ClipMesh, CutsSharedEdgesInTheSamePoints) {
    using Bits = std::array<uint64_t, 4>;
    Random random(22);
    uint64_t met = 0;
    for (int i = 0; i < 20000; ++i) {
        const Made made = tetrahedron(random);
        ClipVolume volume = frustumVolume();
        // Random planes on top, and triangles that differ in the planes that they need.
        volume.add(randomPoint(random) + glm::dvec4(0, 0, 0, 3)).add(randomPoint(random) + glm::dvec4(0, 0, 0, 3));
        ClippedMesh out;
        clipMesh(made.vertices, made.indices, {}, volume, out);
        const auto bitsOf = [&](uint32_t index) {
            Bits bits;
            const glm::dvec4 v = out.vertices[index] + 0.0;  // no negative zeros
            std::memcpy(bits.data(), &v, sizeof(bits));
            return bits;
        };
        std::map<std::pair<Bits, Bits>, int> open;
        for (size_t t = 0; t < out.indices.size(); t += 3)
            for (size_t k = 0; k < 3; ++k) {
                const Bits a = bitsOf(out.indices[t + k]), b = bitsOf(out.indices[t + (k + 1) % 3]);
                if (a == b) continue;
                if (auto reverse = open.find({b, a}); reverse != open.end() && reverse->second > 0) {
                    --reverse->second;
                    ++met;
                } else {
                    ++open[{a, b}];
                }
            }
        for (const auto& [edge, count] : open) {
            if (count == 0) continue;
            glm::dvec4 ends[2];
            std::memcpy(&ends[0], edge.first.data(), sizeof(Bits));
            std::memcpy(&ends[1], edge.second.data(), sizeof(Bits));
            double nearest = std::numeric_limits<double>::infinity();
            for (int plane = 0; plane < volume.count; ++plane)
                nearest = std::min(nearest, std::max(std::abs(glm::dot(volume.planes[plane], ends[0])),
                                                     std::abs(glm::dot(volume.planes[plane], ends[1]))));
            EXPECT_LT(nearest, 1e-12) << "case " << i;
        }
    }
    EXPECT_GT(met, 10000u);
}

TEST(ClipMesh, SparesWhatTheGuardBandHolds) {
    // Beside, partly in view, beyond the band in part, across the near plane, in view.
    const std::vector<glm::dvec4> vertices = {{2, 0, 0, 1},   {3, 0, 0, 1},  {2, 1, 0, 1},  {0, 0, 0, 1},
                                              {0, 0.5, 0, 1}, {30, 0, 0, 1}, {0, 0, -2, 1}, {0.5, 0, 0, 1}};
    const std::vector<uint32_t> indices = {0, 1, 2, 3, 0, 4, 3, 5, 4, 3, 6, 4, 3, 7, 4};
    ClippedMesh out;
    clipMesh(vertices, indices, frustumVolume(), guardBandVolume(8), out);
    EXPECT_EQ(out.counters.rejected, 1u);
    EXPECT_EQ(out.counters.accepted, 2u);
    EXPECT_EQ(out.counters.spared, 1u);
    EXPECT_EQ(out.counters.clipped, 2u);
    EXPECT_EQ(out.source, (std::vector<uint32_t>{1, 2, 2, 3, 3, 4}));
    // At the band's plane, not at the viewport's: E37 of the lecture.
    double farthest = 0;
    for (uint32_t index : out.indices) farthest = std::max(farthest, out.vertices[index].x / out.vertices[index].w);
    EXPECT_EQ(farthest, 8.0);
}

/// Two triangles on either side of an edge that leaves the viewport and stays in the band; one of them reaches beyond.
TEST(ClipMesh, AtTheViewportInsteadOfTheBandWouldCrack) {
    Random random(24);
    const auto onScreen = [](const glm::dvec4& v) { return (glm::dvec2(v) / v.w + 1.0) * 8.0; };
    int cracks_at_band = 0, cracks_at_viewport = 0;
    for (int i = 0; i < 2000; ++i) {
        // Ends on whole eighths: the samples at eighths of the edge lie on it exactly.
        const auto whole = [&](int low, int count) { return (low + int(random.below(uint64_t(count)))) / 8.0; };
        const glm::dvec2 a(whole(-7, 14), whole(-7, 14)), b(whole(10, 12), whole(-7, 14));
        const std::vector<glm::dvec4> vertices = {{a, 0, 1}, {b, 0, 1}, {-0.5, 100, 0, 1}, {0.5, -3, 0, 1}};
        const std::vector<uint32_t> indices = {0, 1, 2, 1, 0, 3};
        ClippedMesh at_band, at_viewport;
        clipMesh(vertices, indices, frustumVolume(), guardBandVolume(4), at_band);
        clipMesh(vertices, std::span(indices).first(3), frustumVolume(), frustumVolume(), at_viewport);
        // The end of the edge that begins in a, in the triangle that was clipped.
        const auto endOf = [&](const ClippedMesh& mesh, uint32_t triangle) {
            for (size_t t = 0; t < mesh.indices.size(); ++t)
                if (mesh.source[t / 3] == triangle && mesh.indices[t] == 0)
                    return onScreen(mesh.vertices[mesh.indices[t % 3 == 2 ? t - 2 : t + 1]]);
            return glm::dvec2(0.0);
        };
        for (int part = 1; part < 8; ++part) {
            const glm::dvec2 sample = onScreen({a + (b - a) * (part / 8.0), 0, 1});
            if (sample.x >= 16) continue;
            const glm::dvec2 start = onScreen(vertices[0]);
            cracks_at_band += orientation(start, endOf(at_band, 0), sample) != 0;
            cracks_at_viewport += orientation(start, endOf(at_viewport, 0), sample) != 0;
        }
    }
    EXPECT_EQ(cracks_at_band, 0);
    EXPECT_GT(cracks_at_viewport, 100);
}

TEST(ClipMesh, InterpolatesAttributesInClipSpace) {
    Random random(23);
    for (int i = 0; i < 2000; ++i) {
        const Made made = tetrahedron(random);
        std::vector<double> values;
        const glm::dvec4 law = randomPoint(random);
        for (const glm::dvec4& v : made.vertices) values.push_back(glm::dot(law, v));
        ClippedMesh out;
        clipMesh(made.vertices, made.indices, {}, frustumVolume(), out);
        out.interpolate(values);
        ASSERT_EQ(values.size(), out.vertices.size());
        for (size_t v = 0; v < values.size(); ++v)
            EXPECT_NEAR(values[v], glm::dot(law, out.vertices[v]), 1e-12) << "case " << i;
    }
}

TEST(ClipMesh, RejectsWhatIsNotFinite) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<glm::dvec4> vertices = {{0, 0, 0, 1}, {nan, 0, 0, 1}, {0, 0.5, 0, 1}};
    ClippedMesh out;
    clipMesh(vertices, std::vector<uint32_t>{0, 1, 2}, {}, frustumVolume(), out);
    EXPECT_EQ(out.counters.rejected, 1u);
    EXPECT_TRUE(out.indices.empty());
}

}  // namespace
}  // namespace sightline
