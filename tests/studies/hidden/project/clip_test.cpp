// Laws of clipping: nothing is lost, nothing is gained, and both sides of an edge agree.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/project/clip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/random.h"

namespace sightline {
using namespace studies;
namespace {

glm::dvec4 randomCorner(Random& random) {
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
        const ClipPolygon whole = triangle(randomCorner(random), randomCorner(random), randomCorner(random));
        const glm::dvec4 plane = randomCorner(random);
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
        const glm::dvec4 a = randomCorner(random), b = randomCorner(random);
        const glm::dvec4 plane(0, 0, 1, 1), second = randomCorner(random);
        // The same edge, forward in one triangle and backward in the other.
        ClipPolygon one, two, rest;
        clipToPlane(triangle(a, b, randomCorner(random)), plane, rest);
        clipToPlane(rest, second, one);
        clipToPlane(triangle(b, a, randomCorner(random)), plane, rest);
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

/// A convex polygon around the origin of a random plane of clip space, with w > 0.
std::vector<glm::dvec4> randomConvex(Random& random, int corners) {
    const glm::dvec4 center(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(3, 5));
    const glm::dvec4 u = 0.3 * randomCorner(random), v = 0.3 * randomCorner(random);
    std::vector<glm::dvec4> points;
    for (int i = 0; i < corners; ++i) {
        const double angle = (i + random.uniform(0.1, 0.9)) * 6.283185307179586 / corners;
        points.push_back(center + std::cos(angle) * u + std::sin(angle) * v);
    }
    return points;
}

double area(std::span<const glm::dvec4> points) {
    double sum = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        const glm::dvec4 &a = points[i], &b = points[(i + 1) % points.size()];
        sum += 0.5 * (a.x * b.y - a.y * b.x);
    }
    return sum;
}

std::vector<glm::dvec4> clipped(const std::vector<glm::dvec4>& in, const glm::dvec4& plane) {
    std::vector<glm::dvec4> out(in.size() + 1);
    out.resize(static_cast<size_t>(clipToPlane(in, plane, out)));
    return out;
}

TEST(Clip, ConservesTheAreaOfConvexPolygons) {
    Random random(13);
    int cut = 0;
    for (int i = 0; i < 20000; ++i) {
        const std::vector<glm::dvec4> whole = randomConvex(random, 3 + int(random.below(30)));
        const glm::dvec4 plane = randomCorner(random) * glm::dvec4(1, 1, 1, 0.3);
        const std::vector<glm::dvec4> inside = clipped(whole, plane), outside = clipped(whole, -plane);
        EXPECT_NEAR(area(inside) + area(outside), area(whole), 1e-9 * std::abs(area(whole))) << "case " << i;
        EXPECT_LE(inside.size(), whole.size() + 1) << "case " << i;
        cut += !inside.empty() && !outside.empty();
    }
    EXPECT_GT(cut, 5000);
}

TEST(Clip, AgainChangesNothingButRounding) {
    Random random(14);
    for (int i = 0; i < 20000; ++i) {
        const std::vector<glm::dvec4> whole = randomConvex(random, 3 + int(random.below(8)));
        const glm::dvec4 plane = randomCorner(random) * glm::dvec4(1, 1, 1, 0.3);
        const std::vector<glm::dvec4> once = clipped(whole, plane), twice = clipped(once, plane);
        EXPECT_NEAR(area(once), area(twice), 1e-13 * (1 + std::abs(area(whole)))) << "case " << i;
        // A crossing lies on the plane up to the rounding of its terms.
        for (const glm::dvec4& v : once) {
            const glm::dvec4 terms = glm::abs(plane * v);
            EXPECT_GE(glm::dot(plane, v), -1e-14 * (1 + terms.x + terms.y + terms.z + terms.w)) << "case " << i;
        }
    }
}

TEST(Clip, KeepsInsideVerticesBitByBitAndInOrder) {
    Random random(15);
    for (int i = 0; i < 20000; ++i) {
        const std::vector<glm::dvec4> whole = randomConvex(random, 3 + int(random.below(8)));
        const glm::dvec4 plane = randomCorner(random) * glm::dvec4(1, 1, 1, 0.3);
        const std::vector<glm::dvec4> kept = clipped(whole, plane);
        auto at = kept.begin();
        for (const glm::dvec4& v : whole) {
            if (kept.empty() || glm::dot(plane, v) < 0) continue;
            at = std::find(at, kept.end(), v);
            ASSERT_NE(at, kept.end()) << "case " << i;
            ++at;
        }
    }
}

TEST(Clip, TouchingInAPointOrAnEdgeIsNothing) {
    const glm::dvec4 plane(1, 0, 0, 0);
    EXPECT_TRUE(clipped({{0, 0, 0, 1}, {-1, 1, 0, 1}, {-1, -1, 0, 1}}, plane).empty());
    EXPECT_TRUE(clipped({{0, -1, 0, 1}, {0, 1, 0, 1}, {-1, 0, 0, 1}}, plane).empty());
    // On the inside they are kept as they are, without a second vertex in the same place.
    EXPECT_EQ(clipped({{0, 0, 0, 1}, {1, 1, 0, 1}, {1, -1, 0, 1}}, plane).size(), 3u);
    EXPECT_EQ(clipped({{0, -1, 0, 1}, {0, 1, 0, 1}, {1, 0, 0, 1}}, plane).size(), 3u);
    // An edge that leaves through a vertex on the plane.
    EXPECT_EQ(clipped({{0, 1, 0, 1}, {-1, 0, 0, 1}, {1, 0, 0, 1}}, plane).size(), 3u);
}

TEST(Clip, TakesPointsLinesAndWhatLiesInThePlane) {
    const glm::dvec4 plane(0, 0, 1, 1);
    const glm::dvec4 in(0.5, 0, 0, 1), out(0, 0.5, -2, 1), on(0, 0, -1, 1);
    EXPECT_EQ(clipped({in, in, in}, plane).size(), 3u);
    EXPECT_TRUE(clipped({out, out, out}, plane).empty());
    EXPECT_EQ(clipped({on, on, on}, plane).size(), 3u);
    const std::vector<glm::dvec4> line = clipped({in, out, in}, plane);
    for (const glm::dvec4& v : line) EXPECT_GE(glm::dot(plane, v), -1e-15);
    EXPECT_EQ(area(line), 0.0);
    const std::vector<glm::dvec4> flat = {{0, 0, -1, 1}, {1, 0, -1, 1}, {0, 1, -1, 1}};
    EXPECT_EQ(clipped(flat, plane), flat);
    EXPECT_EQ(clipped(flat, -plane), flat);
    EXPECT_TRUE(clipped({in, out}, plane).empty());
    EXPECT_TRUE(clipped({}, plane).empty());
}

TEST(Clip, LeavesNothingOfWhatIsNotFinite) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {nan, infinity, -infinity})
        for (int component = 0; component < 4; ++component)
            for (int corner = 0; corner < 3; ++corner) {
                std::vector<glm::dvec4> points = {{0, 0, 0, 1}, {1, 0, -2, 1}, {0, 1, 0, 1}};
                points[static_cast<size_t>(corner)][component] = bad;
                EXPECT_TRUE(clipped(points, {0, 0, 1, 1}).empty()) << bad << " " << component << " " << corner;
            }
}

}  // namespace
}  // namespace sightline
