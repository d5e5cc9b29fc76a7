// Shapes cover what they should, with soft edges, and hulls are hulls.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/canvas.h"

#include <gtest/gtest.h>

#include <limits>

#include "sightline/base/random.h"

namespace sightline {
using namespace tools;
namespace {

constexpr Rgb kPaper{255, 255, 255}, kInk{0, 0, 0};

/// How much ink there is, in pixels.
double inkOf(const Image<Rgb>& image) {
    double ink = 0;
    for (const Rgb& pixel : image.pixels) ink += (255 - pixel.x) / 255.0;
    return ink;
}

TEST(Canvas, ShapesHaveTheAreaThatTheyShould) {
    Random random(1);
    for (int i = 0; i < 200; ++i) {
        const auto place = [&] { return glm::dvec2(random.uniform(30, 170), random.uniform(30, 170)); };
        const double radius = random.uniform(2, 25);
        Canvas disc(200, 200, kPaper);
        disc.disc(place(), radius, kInk);
        EXPECT_NEAR(inkOf(disc.image()), 3.14159265 * radius * radius, 2.0 + 0.02 * radius * radius);
        const glm::dvec2 a = place(), b = place(), c = place();
        Canvas line(200, 200, kPaper);
        line.line(a, b, 3, kInk);
        const double wanted = 3 * glm::length(b - a) + 3.14159265 * 1.5 * 1.5;
        EXPECT_NEAR(inkOf(line.image()), wanted, 2.0 + 0.03 * wanted);
        const double area = 0.5 * std::abs((b - a).x * (c - a).y - (b - a).y * (c - a).x);
        const double around = glm::length(b - a) + glm::length(c - b) + glm::length(a - c);
        Canvas triangle(200, 200, kPaper);
        triangle.fill(std::vector<glm::dvec2>{a, b, c}, kInk);
        if (area < around) continue;  // slivers are drawn a pixel wide
        EXPECT_NEAR(inkOf(triangle.image()), area, 3.0 + 0.06 * around) << i;
    }
}

TEST(Canvas, LeavesOutWhatIsOutsideOrNotFinite) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), huge = std::numeric_limits<double>::infinity();
    Canvas canvas(20, 10, kPaper);
    canvas.disc({-50, 4}, 10, kInk);
    canvas.disc({nan, 4}, 10, kInk);
    canvas.line({huge, 0}, {1, 1}, 2, kInk);
    canvas.line({40, -40}, {40, 60}, 5, kInk);
    canvas.fill(std::vector<glm::dvec2>{{1, 1}, {5, 5}}, kInk);
    canvas.fill(std::vector<glm::dvec2>{{1, 1}, {5, 5}, {9, 9}}, kInk);
    canvas.fill(std::vector<glm::dvec2>{{1, 1}, {nan, 5}, {9, 2}}, kInk);
    EXPECT_EQ(inkOf(canvas.image()), 0);
    canvas.fill(std::vector<glm::dvec2>{{-99, -99}, {99, -99}, {99, 99}, {-99, 99}}, kInk);
    EXPECT_EQ(inkOf(canvas.image()), 200);
}

TEST(Canvas, LaysOpacityOverWhatIsThere) {
    Canvas canvas(10, 10, kPaper);
    canvas.fill(std::vector<glm::dvec2>{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, kInk, 0.5);
    canvas.fill(std::vector<glm::dvec2>{{0, 0}, {0, 10}, {10, 10}, {10, 0}}, kInk, 0.5);
    EXPECT_NEAR(canvas.image().at(5, 5).x, 64, 1);
}

TEST(Canvas, CutsOutlinesAtALine) {
    std::vector<glm::dvec2> outline = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
    cutOutline(outline, {1, 0, -1});  // x >= 1
    EXPECT_EQ(outline, (std::vector<glm::dvec2>{{1, 0}, {4, 0}, {4, 4}, {1, 4}}));
    cutOutline(outline, {0, 0, 1});
    EXPECT_EQ(outline.size(), 4u);
    cutOutline(outline, {0, 1, -9});
    EXPECT_TRUE(outline.empty());
}

TEST(ConvexHull, HoldsAllPointsAndTurnsOneWay) {
    Random random(2);
    for (int i = 0; i < 500; ++i) {
        std::vector<glm::dvec2> points;
        for (uint64_t k = 0; k < 3 + random.below(30); ++k)  // on a grid, so that many lie on one line or in one place
            points.emplace_back(double(random.below(6)), double(random.below(6)));
        const std::vector<glm::dvec2> hull = convexHull(points);
        for (size_t k = 0; hull.size() >= 3 && k < hull.size(); ++k) {
            const glm::dvec2 a = hull[k], edge = hull[(k + 1) % hull.size()] - a,
                             next = hull[(k + 2) % hull.size()] - a;
            EXPECT_GT(edge.x * next.y - edge.y * next.x, 0);
            for (const glm::dvec2& p : points) EXPECT_GE(edge.x * (p - a).y - edge.y * (p - a).x, 0);
        }
        for (const glm::dvec2& corner : hull) EXPECT_NE(std::find(points.begin(), points.end(), corner), points.end());
        // All on one line is the only way to have fewer corners than three.
        bool line = true;
        for (const glm::dvec2& p : points)
            for (const glm::dvec2& q : points)
                line &= (p - points[0]).x * (q - points[0]).y == (p - points[0]).y * (q - points[0]).x;
        EXPECT_EQ(hull.size() < 3, line);
    }
    EXPECT_TRUE(convexHull({}).empty());
    EXPECT_EQ(convexHull({{1, 2}}).size(), 1u);
}

}  // namespace
}  // namespace sightline
