// Passages: what portals of both ways share, by points of the plane, and the points of short ways, by many others.
// SPDX-License-Identifier: MIT
#include "sightline/cells/passages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "tests/support/random.h"

namespace sightline::test {
namespace {

/// A plane with a place and a direction of its own, in which outlines are drawn.
struct Drawing {
    glm::dvec3 origin, u, v, normal;

    explicit Drawing(Random& random) : origin(randomVector(random, 10)), normal(randomUnit(random)) {
        u = glm::normalize(glm::cross(normal, randomUnit(random)));
        v = glm::cross(normal, u);
    }
    glm::dvec3 at(const glm::dvec2& p) const { return origin + p.x * u + p.y * v; }
    glm::dvec2 of(const glm::dvec3& p) const { return {glm::dot(p - origin, u), glm::dot(p - origin, v)}; }
    glm::dvec4 plane(double side) const { return side * glm::dvec4(normal, -glm::dot(normal, origin)); }
};

/// Corners on an ellipse, counter-clockwise.
std::vector<glm::dvec2> roundOutline(Random& random, size_t corners) {
    const glm::dvec2 middle(random.uniform(-1, 1), random.uniform(-1, 1)),
        radii(random.uniform(0.3, 2), random.uniform(0.3, 2));
    std::vector<double> turns(corners);
    for (size_t i = 0; i < corners; ++i)
        turns[i] = 6.283185307179586 * (double(i) + random.uniform(0.1, 0.9)) / double(corners);
    std::vector<glm::dvec2> out;
    for (const double turn : turns) out.push_back(middle + radii * glm::dvec2(std::cos(turn), std::sin(turn)));
    return out;
}

/// How far inside of an outline a point is; less than 0: outside.
double depthIn(std::span<const glm::dvec2> outline, const glm::dvec2& p) {
    double least = INFINITY;
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec2 edge = outline[(i + 1) % outline.size()] - outline[i], to = p - outline[i];
        least = std::min(least, (edge.x * to.y - edge.y * to.x) / glm::length(edge));
    }
    return least;
}

/// Two cells; a portal that leads from `a` alone, or from both.
struct Graph {
    CellSpace space;

    Graph() {
        space.graph.cells = 2;
        space.tree.contents = {LeafContents::kEmpty, LeafContents::kEmpty};
        space.tree.nodes.push_back({});
        space.tree.nodes[0].child[0] = LeafTreeNode::kLeaf;
        space.tree.nodes[0].child[1] = LeafTreeNode::kLeaf | 1;
        space.graph.cell_of_leaf = {0, 1};
    }
    void add(const Drawing& drawing, uint32_t a, const std::vector<glm::dvec2>& outline, bool one_way) {
        std::vector<glm::dvec3> corners;
        for (const glm::dvec2& p : outline) corners.push_back(drawing.at(p));
        // The normal points into cell 0.
        if (a == 1) std::reverse(corners.begin(), corners.end());
        space.graph.addPortal(a, 1 - a, corners, drawing.plane(a == 0 ? 1 : -1));
        space.graph.portals.back().one_way = one_way;
    }
    Passages passages() const { return Passages(PortalGraph(space), defaultMemory()); }
};

TEST(Passages, AreWhatBothWaysShare) {
    Random random(1);
    size_t shared = 0, inside = 0, outside = 0;
    for (int round = 0; round < 400; ++round) {
        const Drawing drawing(random);
        Graph graph;
        const std::vector<glm::dvec2> there = roundOutline(random, 3 + random.below(6)),
                                      back = roundOutline(random, 3 + random.below(6));
        // Whichever of the cells sees which.
        const uint32_t first = uint32_t(random.below(2));
        graph.add(drawing, first, there, true);
        EXPECT_EQ(graph.passages().size(), 0u) << "one way alone";
        graph.add(drawing, 1 - first, back, true);
        const Passages passages = graph.passages();
        ASSERT_LE(passages.size(), 1u);
        shared += passages.size();
        for (int i = 0; i < 100; ++i) {
            const glm::dvec2 p(random.uniform(-3, 3), random.uniform(-3, 3));
            const double depth = std::min(depthIn(there, p), depthIn(back, p));
            if (std::abs(depth) < 1e-9) continue;
            (depth > 0 ? inside : outside) += 1;
            if (passages.size() == 0) {
                EXPECT_LT(depth, 0);
                continue;
            }
            const double height = random.uniform(0.1, 3);
            const glm::dvec3 a = drawing.at(p) + height * drawing.normal,
                             b = drawing.at(p) - random.uniform(0.1, 3.0) * drawing.normal;
            glm::dvec3 at;
            EXPECT_EQ(passages.passes(0, a, b, at), depth > 0);
            if (depth > 0) { EXPECT_LT(glm::distance(at, drawing.at(p)), 1e-9); }
            EXPECT_FALSE(passages.passes(0, a, a + drawing.normal, at)) << "it does not come to the plane";
        }
    }
    EXPECT_GT(shared, 200u);
    EXPECT_GT(inside, 600u);
    EXPECT_GT(outside, 20000u);
}

TEST(Passages, OfBothWaysAreWhatTheyWere) {
    Random random(2);
    for (int round = 0; round < 50; ++round) {
        const Drawing drawing(random);
        Graph graph;
        graph.add(drawing, uint32_t(random.below(2)), {{0, 0}, {2, 0}, {2, 0.5}, {0, 0.5}}, false);
        // In another plane, the way back is another hole.
        Drawing beside = drawing;
        beside.origin += 0.01 * drawing.normal;
        graph.add(drawing, 0, roundOutline(random, 5), true);
        graph.add(beside, 1, roundOutline(random, 5), true);
        const Passages passages = graph.passages();
        ASSERT_EQ(passages.size(), 1u);
        EXPECT_NEAR(passages[0].width, 0.5, 1e-9);
        EXPECT_EQ(passages[0].count, 4u);
        ASSERT_EQ(passages.of(0).size(), 1u);
        ASSERT_EQ(passages.of(1).size(), 1u);
        EXPECT_EQ(passages[0].beyond(0), 1u);
        EXPECT_EQ(passages[0].beyond(1), 0u);
    }
}

// What has too many corners to be cut is too large, and never too small.
TEST(Passages, OfManyCornersHoldWhatBothWaysShare) {
    Random random(3);
    for (const auto& [a, b] : {std::pair(5, 40), std::pair(40, 5), std::pair(40, 40), std::pair(16, 16)}) {
        const Drawing drawing(random);
        Graph graph;
        const std::vector<glm::dvec2> there = roundOutline(random, size_t(a)), back = roundOutline(random, size_t(b));
        graph.add(drawing, 0, there, true);
        graph.add(drawing, 1, back, true);
        const Passages passages = graph.passages();
        for (int i = 0; i < 2000; ++i) {
            const glm::dvec2 p(random.uniform(-3, 3), random.uniform(-3, 3));
            if (std::min(depthIn(there, p), depthIn(back, p)) < 1e-9) continue;
            ASSERT_EQ(passages.size(), 1u);
            glm::dvec3 at;
            EXPECT_TRUE(passages.passes(0, drawing.at(p) + drawing.normal, drawing.at(p) - drawing.normal, at));
        }
    }
}

TEST(Passages, HaveTheNearestPointsAndTheShortestWaysRound) {
    Random random(4);
    double longest = 0;
    for (int round = 0; round < 300; ++round) {
        const Drawing drawing(random);
        Graph graph;
        const std::vector<glm::dvec2> outline = roundOutline(random, 3 + random.below(5));
        graph.add(drawing, 0, outline, false);
        const Passages passages = graph.passages();
        ASSERT_EQ(passages.size(), 1u);
        // On one side, on both, or in the plane.
        const auto place = [&] {
            const double height = round % 3 == 0 ? 0 : random.uniform(-2, 2);
            const glm::dvec2 p(random.uniform(-4, 4), random.uniform(-4, 4));
            return drawing.at(p) + height * drawing.normal;
        };
        const glm::dvec3 from = place(), to = place();
        const glm::dvec3 nearest = passages.nearestTo(0, from), between = passages.between(0, from, to);
        for (const glm::dvec3& point : {nearest, between}) {
            EXPECT_GT(depthIn(outline, drawing.of(point)), -1e-9);
            EXPECT_LT(std::abs(glm::dot(point - drawing.origin, drawing.normal)), 1e-9);
        }
        const double way = glm::distance(from, between) + glm::distance(between, to);
        double least = INFINITY;
        for (int i = 0; i < 2000; ++i) {
            // Everywhere, and then around the best.
            const double size = i < 1000 ? 3 : std::pow(10, random.uniform(-6, -1));
            const glm::dvec2 p = (i < 1000 ? glm::dvec2(0) : drawing.of(between)) +
                                 size * glm::dvec2(random.uniform(-1, 1), random.uniform(-1, 1));
            if (depthIn(outline, p) < 0) continue;
            const glm::dvec3 other = drawing.at(p);
            EXPECT_GE(glm::distance(from, other), glm::distance(from, nearest) - 1e-9);
            least = std::min(least, glm::distance(from, other) + glm::distance(other, to));
        }
        EXPECT_GE(least, way - 1e-9) << round;
        if (std::isfinite(least)) longest = std::max(longest, least / way);
    }
    EXPECT_LT(longest, 2) << "the samples come near to it";
}

}  // namespace
}  // namespace sightline::test
