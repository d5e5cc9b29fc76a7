// Laws of clipping: nothing is lost, nothing is gained, and both sides of an edge agree.
// SPDX-License-Identifier: MIT
#include "sightline/hidden/clip.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "sightline/base/random.h"

namespace sightline {
namespace {

glm::dvec4 randomPoint(Random& random) {
    return {random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-1, 5)};
}

ClipPolygon triangle(const glm::dvec4& a, const glm::dvec4& b, const glm::dvec4& c) {
    ClipPolygon polygon;
    polygon.count = 3;
    polygon.vertices[0] = a;
    polygon.vertices[1] = b;
    polygon.vertices[2] = c;
    return polygon;
}

/// Area of the (x, y) shadow: linear maps keep the law, so one coordinate pair is as good as another.
double area(const ClipPolygon& polygon) {
    double sum = 0;
    for (int i = 0; i < polygon.count; ++i) {
        const glm::dvec4& a = polygon.vertices[i];
        const glm::dvec4& b = polygon.vertices[(i + 1) % polygon.count];
        sum += 0.5 * (a.x * b.y - a.y * b.x);
    }
    return sum;
}

TEST(Clip, ConservesArea) {
    Random random(11);
    for (int i = 0; i < 20000; ++i) {
        const ClipPolygon whole = triangle(randomPoint(random), randomPoint(random), randomPoint(random));
        const glm::dvec4 plane = randomPoint(random);
        ClipPolygon inside, outside;
        clipToPlane(whole, plane, inside);
        clipToPlane(whole, -plane, outside);
        EXPECT_NEAR(area(inside) + area(outside), area(whole), 1e-12) << "case " << i;
        EXPECT_LE(inside.count, 4);
    }
}

TEST(Clip, SharedEdgesGetEqualBits) {
    Random random(12);
    int crossings = 0;
    for (int i = 0; i < 20000; ++i) {
        const glm::dvec4 a = randomPoint(random), b = randomPoint(random);
        const glm::dvec4 plane(0, 0, 1, 1), second = randomPoint(random);
        // The same edge, forward in one triangle and backward in the other.
        ClipPolygon one, two, rest;
        clipToPlane(triangle(a, b, randomPoint(random)), plane, rest);
        clipToPlane(rest, second, one);
        clipToPlane(triangle(b, a, randomPoint(random)), plane, rest);
        clipToPlane(rest, second, two);
        const bool crossed = (a.z + a.w >= 0) != (b.z + b.w >= 0);
        if (!crossed) continue;
        ClipPolygon edge_one, edge_two;
        clipToPlane(triangle(a, b, a), plane, edge_one);
        clipToPlane(triangle(b, a, b), plane, edge_two);
        const auto find = [&](const ClipPolygon& polygon) {
            for (int v = 0; v < polygon.count; ++v)
                if (polygon.vertices[v] != a && polygon.vertices[v] != b) return polygon.vertices[v];
            return glm::dvec4(0);
        };
        const glm::dvec4 met = find(edge_one);
        EXPECT_EQ(met, find(edge_two)) << "case " << i;
        // Where the second plane keeps the meeting point, both triangles hold it bit by bit.
        if (glm::dot(second, met) < 0) continue;
        ++crossings;
        const auto holds = [&](const ClipPolygon& polygon) {
            return std::any_of(polygon.vertices, polygon.vertices + polygon.count,
                               [&](const glm::dvec4& v) { return v == met; });
        };
        EXPECT_TRUE(holds(one)) << "case " << i;
        EXPECT_TRUE(holds(two)) << "case " << i;
    }
    EXPECT_GT(crossings, 500);
}

TEST(Clip, KeepsWhatTouches) {
    const ClipPolygon flat = triangle({0, 0, -1, 1}, {1, 0, -1, 1}, {0, 1, -1, 1});
    ClipPolygon kept;
    clipToPlane(flat, {0, 0, 1, 1}, kept);
    EXPECT_EQ(kept.count, 3);
    ClipPolygon none;
    clipToPlane(triangle({0, 0, -2, 1}, {1, 0, -2, 1}, {0, 1, -2, 1}), {0, 0, 1, 1}, none);
    EXPECT_EQ(none.count, 0);
}

}  // namespace
}  // namespace sightline
