// The law of shapes: what is called occluded has no point that a ray from the eye reaches first; outside, none in view.
// SPDX-License-Identifier: MIT
#include "sightline/cull/shapes.h"

#include <gtest/gtest.h>

#include <functional>

#include "sightline/cull/outline_look.h"
#include "tests/buffer/tiles_fixture.h"

namespace sightline::test {
namespace {

struct Count {
    uint64_t visible = 0, occluded = 0, outside = 0;

    void add(Sight sight) { ++(sight == Sight::kVisible ? visible : sight == Sight::kOccluded ? occluded : outside); }
};

/// A street of walls, with gaps, and some clutter.
void drawWalls(Drawing& drawing, Random& random) {
    std::vector<Solid> walls;
    for (int i = 0; i < 4; ++i) {
        const float x = static_cast<float>(random.uniform(-4, 1)), z = static_cast<float>(random.uniform(-6, -2));
        walls.push_back(
            makeSheet(random, 2, 2, {x, -2, z}, {x + static_cast<float>(random.uniform(1, 5)), 2, z - 1}, 0.0f));
    }
    drawing.draw(std::move(walls));
}

/// Holds an answer to points of the shape.
/// @param point  of the shape's surface, in world space
void expectTrue(const Drawing& drawing, Sight sight, const std::function<glm::dvec3()>& point,
                const std::string& what) {
    if (sight == Sight::kVisible) return;
    const RayCaster rays(drawing);
    for (int i = 0; i < 60; ++i) {
        const glm::dvec4 h(point() - drawing.screen.eye, 1.0);
        if (glm::dot(drawing.screen.near, h) < 0) continue;  // not drawn
        const double w = glm::dot(drawing.screen.w, h);
        const double x = glm::dot(drawing.screen.x, h) / w, y = glm::dot(drawing.screen.y, h) / w;
        if (!(x > 0 && y > 0 && x < drawing.screen.width && y < drawing.screen.height)) continue;
        ASSERT_NE(int(sight), int(Sight::kOutside)) << what << " has a point in view";
        ASSERT_GT(rays.cast(x, y), glm::dot(drawing.screen.d, h) / w) << what << " shows at " << x << ", " << y;
    }
}

glm::dmat4 randomTransform(Random& random) {
    glm::dmat4 t(1.0);
    const double size = std::pow(10.0, random.uniform(-1.5, 0.3));
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) t[column][row] = size * random.uniform(-1, 1);
    t[3] = glm::dvec4(random.uniform(-4, 4), random.uniform(-2, 2), random.uniform(-14, 1), 1);
    return t;
}

View viewOf(int round) {
    View view = smallView();
    if (round % 4 == 3) view.projection = orthographic(6, 1.5, 0.1, 100);
    if (round % 4 == 2) view.projection[2][0] = 0.3;
    return view;
}

TEST(Shapes, AnswerForBoxesHullsAndTrianglesWhatRaysSay) {
    Count boxes, hulls, points, triangles;
    uint64_t tighter = 0;
    const std::vector<glm::vec3> corners = test::boxMesh().positions;
    std::vector<uint32_t> faces;
    for (const auto& face : test::kBoxFaces) faces.insert(faces.end(), face, face + 4);
    const std::vector<uint32_t> sizes(6, 4);
    const Box3d box{glm::dvec3(0), glm::dvec3(1)};
    for (int round = 0; round < 60; ++round) {
        Random random(static_cast<uint64_t>(round));
        Drawing drawing(viewOf(round));
        drawWalls(drawing, random);
        for (int i = 0; i < 40; ++i) {
            const glm::dmat4 t = randomTransform(random);
            const std::string what = "round " + std::to_string(round) + " shape " + std::to_string(i);
            const auto surface = [&] {
                glm::dvec3 p(random.uniform(), random.uniform(), random.uniform());
                p[static_cast<int>(random.below(3))] = static_cast<double>(random.below(2));
                return glm::dvec3(t * glm::dvec4(p, 1));
            };
            const OccludeePlace place = makeOccludeePlace(drawing.screen, t, box);
            const Sight by_box = askBox(drawing.tiles, place, box);
            const Sight by_hull = askHull(drawing.tiles, place, {corners, faces, sizes});
            const Sight by_points = askPoints(drawing.tiles, place, corners);
            for (const Sight sight : {by_box, by_hull, by_points}) expectTrue(drawing, sight, surface, what);
            if (by_box == Sight::kVisible) { EXPECT_EQ(int(by_hull), int(by_box)) << what; }
            tighter += by_points == Sight::kVisible && by_box == Sight::kOccluded;
            boxes.add(by_box);
            hulls.add(by_hull);
            points.add(by_points);

            const glm::vec3 a(random.uniform(), random.uniform(), 0), b(1, 0, random.uniform()),
                c(0, 1, random.uniform());
            const std::vector<glm::vec3> triangle = {a, b, c};
            const std::vector<uint32_t> indices = {0, 1, 2};
            const std::vector<uint8_t> both = {1};
            const Occluder shape = prepareOccluder({triangle, indices}, {}, both);
            LookScratch scratch(defaultMemory());
            OutlineLook look;
            const Sight by_triangle =
                askOutlines(drawing.tiles, makeOccluderInstance(drawing.screen, shape, t), scratch, look);
            EXPECT_EQ(look.polygons, 1u);
            expectTrue(
                drawing, by_triangle,
                [&] {
                    double u = random.uniform(), v = random.uniform();
                    if (u + v > 1) u = 1 - u, v = 1 - v;
                    const glm::dvec3 p = glm::dvec3(a) + u * glm::dvec3(b - a) + v * glm::dvec3(c - a);
                    return glm::dvec3(t * glm::dvec4(p, 1));
                },
                what + " (triangle)");
            triangles.add(by_triangle);
            if (HasFatalFailure()) return;
        }
    }
    for (const Count& count : {boxes, hulls, points, triangles}) {
        EXPECT_GT(count.visible, 200u);
        EXPECT_GT(count.occluded, 50u);
        EXPECT_GT(count.outside, 100u);
    }
    EXPECT_GT(tighter, 0u) << "a depth per pixel tells more than the nearest";
}

TEST(Shapes, AnswerForSpheresWhatRaysSay) {
    Count spheres;
    for (int round = 0; round < 80; ++round) {
        Random random(static_cast<uint64_t>(round) + 500);
        Drawing drawing(viewOf(round));
        drawWalls(drawing, random);
        for (int i = 0; i < 40; ++i) {
            const glm::dvec3 center(random.uniform(-4, 4), random.uniform(-2, 2), random.uniform(-14, 1));
            const double radius = std::pow(10.0, random.uniform(-2, 0.2));
            const Sight sight = askSphere(drawing.tiles, drawing.screen, center, radius);
            spheres.add(sight);
            expectTrue(
                drawing, sight,
                [&] {
                    const glm::dvec3 d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
                    return center + radius * glm::normalize(d);
                },
                "round " + std::to_string(round) + " sphere " + std::to_string(i));
            if (HasFatalFailure()) return;
        }
    }
    EXPECT_GT(spheres.visible, 200u);
    EXPECT_GT(spheres.occluded, 50u);
    EXPECT_GT(spheres.outside, 100u);
}

TEST(Shapes, ARectangleIsHiddenBehindAWallAndNotBeforeIt) {
    Drawing drawing(smallView());
    Random random(1);
    drawing.draw({makeSheet(random, 1, 1, {-9, -9, -5}, {9, 9, -5}, 0.0f)});
    const auto ask = [&](double depth, double left = 10) {
        return askRect(drawing.tiles, drawing.screen, drawing.view, {left, 10, left + 20, 30, depth});
    };
    EXPECT_EQ(ask(5.1), Sight::kOccluded);
    EXPECT_EQ(ask(4.9), Sight::kVisible);
    EXPECT_EQ(ask(5.0), Sight::kVisible) << "equality is visible";
    EXPECT_EQ(ask(5.1, 200), Sight::kOutside);
    EXPECT_EQ(ask(std::numeric_limits<double>::quiet_NaN()), Sight::kVisible);
}

TEST(Shapes, WhatHoldsTheEyeOrMeetsTheNearPlaneIsVisible) {
    Drawing drawing(smallView());
    Random random(1);
    drawing.draw({makeSheet(random, 1, 1, {-9, -9, -1}, {9, 9, -1}, 0.0f)});
    const Box3d around{glm::dvec3(-1), glm::dvec3(1)},
        across{glm::dvec3(-0.01, -0.01, -3), glm::dvec3(0.01, 0.01, -0.05)};
    for (const Box3d& box : {around, across})
        EXPECT_EQ(askBox(drawing.tiles, makeOccludeePlace(drawing.screen, glm::dmat4(1), box), box), Sight::kVisible);
    EXPECT_EQ(askSphere(drawing.tiles, drawing.screen, {0, 0, 0}, 1), Sight::kVisible);
    EXPECT_EQ(askSphere(drawing.tiles, drawing.screen, {0, 0, -3}, -1), Sight::kVisible);
    EXPECT_EQ(askSphere(drawing.tiles, drawing.screen, {0, 0, -3}, 1), Sight::kOccluded);
}

/// Its two triangles meet in the middle of the view, along a line before the near plane or beyond it.
TEST(Shapes, AQuadrangleWhoseSidesAllCrossTheNearPlaneIsCutAsTwoTriangles) {
    for (const float warp : {2e-5f, -2e-5f}) {  // less than what makes two polygons of it
        Drawing drawing(smallView());
        const std::vector<glm::vec3> corners = {
            {-1, -1, -0.1f + warp}, {1, -1, -0.1f - warp}, {1, 1, -0.1f + warp}, {-1, 1, -0.1f - warp}};
        const std::vector<uint32_t> indices = {0, 1, 2, 0, 2, 3};
        const std::vector<uint8_t> both = {1, 1};
        const Occluder shape = prepareOccluder({corners, indices}, {}, both);
        ASSERT_EQ(shape.polygons.size(), 1u);
        LookScratch scratch(defaultMemory());
        OutlineLook look;
        const glm::dmat4 here(1);
        EXPECT_EQ(askOutlines(drawing.tiles, makeOccluderInstance(drawing.screen, shape, here), scratch, look),
                  warp > 0 ? Sight::kOutside : Sight::kVisible);
        EXPECT_FALSE(look.in_doubt);
    }
}

}  // namespace
}  // namespace sightline::test
