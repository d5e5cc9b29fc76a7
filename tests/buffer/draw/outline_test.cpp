// Convex bodies: no ray gets past them, and each pixel inside their outline is covered.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/buffer/tiles_fixture.h"
#include "tests/support/targets.h"

namespace sightline::test {
namespace {

/// A prism or a pyramid over a polygon of n corners, its faces outward, as triangles.
Solid makeBody(int n, bool pointed, float radius, float height) {
    Solid body;
    const auto corner = [&](int i, float y, float r) {
        const float angle = 6.2831853f * static_cast<float>(i) / static_cast<float>(n);
        body.positions.emplace_back(r * std::cos(angle), y, r * std::sin(angle));
    };
    for (int i = 0; i < n; ++i) corner(i, -0.5f * height, radius);
    for (int i = 0; i < n; ++i) corner(i, 0.5f * height, pointed ? 0.0f : radius);
    const auto low = [&](int i) { return static_cast<uint32_t>(i % n); };
    const auto high = [&](int i) { return static_cast<uint32_t>(n + i % n); };
    const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
        if (body.positions[a] != body.positions[b] && body.positions[b] != body.positions[c] &&
            body.positions[a] != body.positions[c])
            body.indices.insert(body.indices.end(), {a, b, c});
    };
    for (int i = 0; i < n; ++i) {
        add(low(i), high(i), low(i + 1));
        add(low(i + 1), high(i), high(i + 1));
    }
    for (int i = 1; i + 1 < n; ++i) {
        add(low(0), low(i), low(i + 1));
        add(high(0), high(i + 1), high(i));
    }
    return body;
}

Solid randomBody(Random& random) {
    const int corners = 3 + static_cast<int>(random.below(4));
    const float radius = static_cast<float>(random.uniform(0.3, 2.5)),
                height = static_cast<float>(random.uniform(0.2, 4.0));
    Solid body = makeBody(corners, random.below(3) == 0, radius, height);
    // A corner pushed about makes it something that is not convex.
    if (random.below(3) == 0)
        body.positions[random.below(body.positions.size())] *= static_cast<float>(random.uniform(-0.5, 1.5));
    if (random.below(4) == 0) body.double_sided.assign(body.indices.size() / 3, 1);
    glm::dmat4 place(1.0);
    place = glm::translate(place, {random.uniform(-3, 3), random.uniform(-2, 2), random.uniform(-8, -0.5)});
    place = glm::rotate(place, random.uniform(0, 6.3), glm::normalize(glm::dvec3(random.uniform(-1, 1), 1.0, 0.3)));
    if (random.below(5) == 0) place = glm::scale(place, {-1.0, random.uniform(0.5, 2.0), 1.0});
    body.transform = place;
    return body;
}

TEST(Outlines, HoldNothingThatARayGetsPast) {
    uint64_t covered = 0;
    for (uint64_t seed = 1; seed <= 60; ++seed) {
        Random random(seed);
        View view = smallView();
        if (seed % 6 == 0) view.projection = orthographic(4.0, 1.5, 0.1, 50.0);
        Drawing drawing(view);
        if (seed % 3 == 0) drawing.tiles.clear(drawing.screen.width, drawing.screen.height, OcclusionDetail::kMasked);
        std::vector<Solid> bodies;
        for (int i = 0; i < 4; ++i) bodies.push_back(randomBody(random));
        drawing.drawAndResolve(bodies);
        covered += drawing.coveredPixels();
        ASSERT_EQ(findLeak(drawing, seed, 12), "");
    }
    EXPECT_GT(covered, 60u * 500u);
}

/// Of a box that is seen at a corner: pixels that lie inside it, and how much nearer than it claims one of them is.
struct Fit {
    int inside = 0, covered = 0;
};

Fit fitOf(const Drawing& drawing) {
    Fit fit;
    const RayCaster rays(drawing);
    for (uint32_t y = 0; y < drawing.tiles.height; ++y)
        for (uint32_t x = 0; x < drawing.tiles.width; ++x) {
            double farthest = 1e300;
            for (int i = 0; i < 16; ++i)
                farthest = std::min(farthest, rays.cast(x - 0.02 + 1.04 * (i % 4) / 3, y - 0.02 + 1.04 * (i / 4) / 3));
            if (!(farthest > 0.0)) continue;
            ++fit.inside;
            fit.covered += drawing.covered(x, y);
        }
    return fit;
}

TEST(Outlines, CoverEachPixelInside) {
    for (int corners = 3; corners <= 6; ++corners) {
        Drawing drawing(smallView(192, 128));
        Solid body = makeBody(corners, false, 2.0f, 3.0f);
        body.transform = glm::rotate(glm::translate(glm::dmat4(1.0), {0.1, 0.2, -5.0}), 0.7, {0.5, 1.0, 0.1});
        drawing.draw({body});
        const Fit fit = fitOf(drawing);
        EXPECT_GT(fit.inside, 2000) << corners;
        EXPECT_EQ(fit.covered, fit.inside) << corners;
    }
}

TEST(Outlines, AreTheSameOnEveryInstructionSet) {
    std::vector<float> first;
    forEachTarget([&](const std::string& target) {
        std::vector<float> claims;
        for (uint64_t seed = 1; seed <= 12; ++seed) {
            Random random(seed);
            Drawing drawing(smallView());
            std::vector<Solid> bodies;
            for (int i = 0; i < 4; ++i) bodies.push_back(randomBody(random));
            drawing.draw(bodies);
            for (uint32_t y = 0; y < drawing.tiles.height; ++y)
                for (uint32_t x = 0; x < drawing.tiles.width; ++x) claims.push_back(drawing.depth(x, y));
        }
        if (first.empty()) first = claims;
        EXPECT_TRUE(first == claims) << target;
    });
    EXPECT_FALSE(first.empty());
}

}  // namespace
}  // namespace sightline::test
