// Laws of scan conversion: polygons that tile a region cover each of its samples exactly once.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/project/scan.h"

#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/random.h"

namespace sightline {
using namespace studies;
namespace {

constexpr int kSize = 48;

struct Coverage {
    std::vector<int> counts = std::vector<int>(kSize * kSize, 0);
    void add(std::span<const glm::dvec2> points) {
        scanPolygon(points, 0, kSize, kSize, [&](int row, int begin, int end) {
            for (int i = begin; i < end; ++i) ++counts[row * kSize + i];
        });
    }
    void addTriangle(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
        const glm::dvec2 points[3] = {a, b, c};
        add(points);
    }
};

void expectOnce(const Coverage& coverage, uint64_t seed) {
    for (int i = 0; i < kSize * kSize; ++i)
        ASSERT_EQ(coverage.counts[i], 1) << "seed " << seed << " sample " << i % kSize << "," << i / kSize;
}

TEST(Orientation, IsExactWhereDoublesRound) {
    // Points on the line y = x at steps of one unit in the last place around it.
    const glm::dvec2 b(12, 12), c(24, 24);
    for (int i = 0; i < 64; ++i)
        for (int j = 0; j < 64; ++j) {
            const glm::dvec2 a(0.5 + i * 0x1p-53, 0.5 + j * 0x1p-53);
            EXPECT_EQ(orientation(a, b, c), j > i ? 1 : j < i ? -1 : 0) << i << " " << j;
            EXPECT_EQ(orientation(b, c, a), orientation(a, b, c));
            EXPECT_EQ(orientation(c, b, a), -orientation(a, b, c));
        }
}

TEST(ScanPolygon, TopAndLeftEdgesBelong) {
    Coverage coverage;
    const glm::dvec2 square[4] = {{1.5, 1.5}, {4.5, 1.5}, {4.5, 4.5}, {1.5, 4.5}};
    coverage.add(square);
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 6; ++x)
            EXPECT_EQ(coverage.counts[y * kSize + x], x >= 1 && x < 4 && y > 1 && y <= 4) << x << "," << y;
}

TEST(ScanPolygon, WindingDoesNotMatter) {
    Random random(3);
    for (int i = 0; i < 300; ++i) {
        glm::dvec2 p[3];
        for (glm::dvec2& point : p) point = {random.uniform(-9, kSize + 9), random.uniform(-9, kSize + 9)};
        Coverage forward, backward;
        forward.addTriangle(p[0], p[1], p[2]);
        backward.addTriangle(p[2], p[1], p[0]);
        ASSERT_EQ(forward.counts, backward.counts) << "case " << i;
    }
}

/// Fans around samples, half samples and random places: hubs and spokes that run through sample centres.
TEST(ScanPolygon, FansCoverEachSampleOnce) {
    for (uint64_t seed = 0; seed < 400; ++seed) {
        Random random(seed);
        glm::dvec2 hub(random.uniform(10, 38), random.uniform(10, 38));
        if (seed % 3 == 0) hub = glm::floor(hub) + 0.5;
        if (seed % 3 == 1) hub = glm::floor(hub) + 0.5 + glm::dvec2(random.uniform(-1e-15, 1e-15));
        const int spokes = 5 + static_cast<int>(random.below(40));
        std::vector<glm::dvec2> rim;
        for (int i = 0; i < spokes; ++i) {
            const double angle = (i + (seed % 2 ? 0.0 : random.uniform(0, 0.9))) * 6.283185307179586 / spokes;
            rim.push_back(hub + 200.0 * glm::dvec2(std::cos(angle), std::sin(angle)));
        }
        Coverage coverage;
        for (int i = 0; i < spokes; ++i) coverage.addTriangle(hub, rim[i], rim[(i + 1) % spokes]);
        expectOnce(coverage, seed);
    }
}

/// Grids whose inner vertices are shaken, many of them onto sample centres.
TEST(ScanPolygon, MeshesCoverEachSampleOnce) {
    constexpr int kCells = 12;
    for (uint64_t seed = 0; seed < 300; ++seed) {
        Random random(seed);
        std::vector<glm::dvec2> points;
        for (int y = 0; y <= kCells; ++y)
            for (int x = 0; x <= kCells; ++x) {
                glm::dvec2 p(x * double(kSize) / kCells, y * double(kSize) / kCells);
                if (x > 0 && x < kCells) p.x += random.uniform(-0.45, 0.45);
                if (y > 0 && y < kCells) p.y += random.uniform(-0.45, 0.45);
                if (random.below(3) == 0 && x > 0 && x < kCells && y > 0 && y < kCells) p = glm::floor(p) + 0.5;
                points.push_back(p);
            }
        Coverage coverage;
        for (int y = 0; y < kCells; ++y)
            for (int x = 0; x < kCells; ++x) {
                const glm::dvec2 a = points[y * (kCells + 1) + x], b = points[y * (kCells + 1) + x + 1];
                const glm::dvec2 c = points[(y + 1) * (kCells + 1) + x], d = points[(y + 1) * (kCells + 1) + x + 1];
                coverage.addTriangle(a, b, d);
                coverage.addTriangle(a, d, c);
            }
        expectOnce(coverage, seed);
    }
}

}  // namespace
}  // namespace sightline
