// Soups of polygons that share no sides, drawn and held to rays; and panels that close between batches.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <utility>

#include "tests/buffer/tiles_fixture.h"
#include "tests/support/targets.h"

namespace sightline::test {
namespace {

struct Soup {
    int polygons = 300;
    float size = 1.0f;      ///< of a triangle, in metres
    float thinness = 0.0f;  ///< 1: slivers
    float nearest = 2.0f, farthest = 9.0f;
    bool both = false, quads = false;
    glm::vec3 home{0.0f};  ///< of the mesh's vertices
};

Solid makeSoup(Random& random, const Soup& soup) {
    Solid solid;
    const auto any = [&] { return static_cast<float>(random.uniform(-1, 1)); };
    for (int p = 0; p < soup.polygons; ++p) {
        const float z = soup.nearest + (soup.farthest - soup.nearest) * static_cast<float>(random.uniform());
        const glm::vec3 at(0.9f * z * any(), 0.7f * z * any(), -z);
        const glm::vec3 u = soup.size * glm::vec3(any(), any(), 0.5f * any());
        const glm::vec3 side = soup.size * glm::vec3(any(), any(), 0.5f * any());
        const glm::vec3 v = glm::mix(side, u, soup.thinness * (0.9f + 0.1f * any()));
        const uint32_t first = static_cast<uint32_t>(solid.positions.size());
        for (const glm::vec3& corner : {at - u, at + u, at + v}) solid.positions.push_back(soup.home + corner);
        if (soup.quads) solid.positions.push_back(soup.home + at + v - 2.0f * u);
        for (uint32_t k : {0, 1, 2}) solid.indices.push_back(first + k);
        if (soup.quads)
            for (uint32_t k : {0, 2, 3}) solid.indices.push_back(first + k);
    }
    if (soup.both) solid.double_sided.assign(solid.indices.size() / 3, 1);
    return solid;
}

/// Draws a soup and looks for leaks; gives the covered pixels.
uint64_t coveredBy(const Solid& solid, View view, Detail detail, uint64_t seed) {
    Drawing drawing(view);
    drawing.tiles.clear(drawing.screen.width, drawing.screen.height, detail);
    drawing.draw({solid});
    EXPECT_EQ(findLeak(drawing, seed, 8), "");
    drawing.resolveAll();
    EXPECT_EQ(findLeak(drawing, seed + 1000, 8), "") << "resolved";
    return drawing.coveredPixels();
}

TEST(LooseClusters, CoverNothingThatARayGetsPast) {
    uint64_t covered = 0;
    for (uint64_t seed = 1; seed <= 24; ++seed) {
        Random random(seed);
        Soup soup;
        soup.size = 0.1f * static_cast<float>(1 << seed % 6);
        soup.quads = seed % 4 == 3;
        soup.both = seed % 5 == 4;
        soup.thinness = seed % 7 == 6 ? 0.95f : 0.0f;
        soup.polygons = soup.size > 1 ? 60 : 300;
        covered += coveredBy(makeSoup(random, soup), smallView(), seed % 3 ? Detail::kMasked : Detail::kFull, seed);
    }
    EXPECT_GT(covered, 20000u);
}

TEST(LooseClusters, CoverNothingWrongAtTheNearPlane) {
    uint64_t covered = 0;
    for (uint64_t seed = 1; seed <= 8; ++seed) {
        Random random(seed);
        Soup soup;
        soup.nearest = -1.0f;
        soup.farthest = 2.0f;
        soup.polygons = 200;
        soup.both = seed % 2;
        covered += coveredBy(makeSoup(random, soup), smallView(), seed % 3 ? Detail::kMasked : Detail::kFull, seed);
    }
    EXPECT_GT(covered, 2000u);
}

TEST(LooseClusters, TurnFrontFacesAboutInAMirror) {
    for (const bool both : {false, true}) {
        double plain = 0, turned = 0;
        for (uint64_t seed = 31; seed < 39; ++seed) {
            Random random(seed);
            Soup soup;
            soup.size = 0.4f;
            soup.both = both;
            Solid solid = makeSoup(random, soup);
            plain += static_cast<double>(coveredBy(solid, smallView(), Detail::kMasked, seed));
            // The same place in the world, and the same faces to the front, for a mirror turns them about.
            for (glm::vec3& p : solid.positions) p.x = -p.x;
            for (size_t i = 0; i < solid.indices.size(); i += 3) std::swap(solid.indices[i], solid.indices[i + 1]);
            solid.transform[0][0] = -1.0;
            turned += static_cast<double>(coveredBy(solid, smallView(), Detail::kMasked, seed));
        }
        // The mirrored mesh is cut into other clusters. Polygons of one cluster are drawn together, so that coverage differs a little.
        EXPECT_NEAR(turned, plain, 0.03 * plain);
        EXPECT_GT(plain, 4000.0);
    }
}

TEST(LooseClusters, AreDrawnFarFromTheOriginToo) {
    Random random(32);
    Soup soup;
    soup.size = 0.4f;
    const Solid solid = makeSoup(random, soup);
    const double home = static_cast<double>(coveredBy(solid, smallView(), Detail::kFull, 32));
    for (const double distance : {1e3, 1e6, 1e9}) {
        Solid moved = solid;
        View view = smallView();
        const glm::dvec3 there(distance, -distance, 0.5 * distance);
        view.view = lookAt(there, there + glm::dvec3(0, 0, -1), {0, 1, 0});
        moved.transform[3] = glm::dvec4(there, 1.0);
        Drawing drawing(view);
        drawing.drawAndResolve({moved});
        EXPECT_NEAR(static_cast<double>(drawing.coveredPixels()), home, 0.02 * home) << distance;
    }
    // The mesh's own coordinates are large: what floats round is in the vertices, not in the drawing.
    soup.home = glm::vec3(2048.0f, -1024.0f, 512.0f);
    Random again(32);
    Solid far = makeSoup(again, soup);
    far.transform[3] = glm::dvec4(-glm::dvec3(soup.home), 1.0);
    EXPECT_NEAR(static_cast<double>(coveredBy(far, smallView(), Detail::kFull, 33)), home, 0.02 * home);
}

TEST(LooseClusters, HoldInParallelProjection) {
    Random random(34);
    View view = smallView();
    view.projection = orthographic(6.0, 1.5, 0.1, 20.0);
    Soup soup;
    soup.size = 1.0f;
    EXPECT_GT(coveredBy(makeSoup(random, soup), view, Detail::kMasked, 34), 500u);
}

TEST(LooseClusters, CloseTheSeamsBetweenPanelsOfTheirOwn) {
    std::vector<Solid> panels;
    const int columns = 9, rows = 6;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const auto corner = [&](int a, int b) {
                return glm::vec3(-6.0f + 12.0f * static_cast<float>(i + a) / columns,
                                 -4.0f + 8.0f * static_cast<float>(j + b) / rows, -4.0f);
            };
            Solid panel;
            panel.positions = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
            panel.indices = {0, 1, 2, 0, 2, 3};
            panels.push_back(panel);
        }
    Drawing drawing(smallView(), panels);
    EXPECT_EQ(drawing.openPixels(), 0u);
    EXPECT_EQ(findLeak(drawing, 35, 8), "");
}

TEST(LooseClusters, AreTheSameOnEveryInstructionSet) {
    std::vector<float> expected;
    const int targets = forEachTarget([&](const std::string& target) {
        std::vector<float> depths;
        for (uint64_t seed = 1; seed <= 8; ++seed) {
            Random random(seed);
            Soup soup;
            soup.size = 0.1f * static_cast<float>(1 << seed % 6);
            soup.polygons = 400;
            soup.quads = seed % 3 == 2;
            soup.nearest = seed % 4 == 3 ? -1.0f : 2.0f;
            Drawing drawing(smallView(200, 120), {makeSoup(random, soup)});
            for (uint32_t y = 0; y < drawing.tiles.height; ++y)
                for (uint32_t x = 0; x < drawing.tiles.width; ++x) depths.push_back(drawing.depth(x, y));
        }
        if (expected.empty()) expected = depths;
        EXPECT_TRUE(depths == expected) << target;
    });
    EXPECT_GE(targets, 2);
}

}  // namespace
}  // namespace sightline::test
