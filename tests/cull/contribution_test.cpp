// The measures of distance and contribution culling: held to the image itself, and to what a node promises of its boxes.
// SPDX-License-Identifier: MIT
#include "sightline/cull/contribution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/cull/distance.h"
#include "tests/support/targets.h"
#include "tests/support/views.h"

namespace sightline {
namespace {

glm::dvec3 directionOf(const View& view) { return -glm::transpose(glm::dmat3(view.view))[2]; }

EyeBoxes boxesOf(const std::vector<Box3d>& boxes) {
    EyeBoxes out;
    for (int axis = 0; axis < 3; ++axis)
        for (size_t i = 0; i < 8; ++i) {
            out.min[axis][i] = static_cast<float>(boxes[i].min[axis]);
            out.max[axis][i] = static_cast<float>(boxes[i].max[axis]);
        }
    return out;
}

/// The projected radius of a sphere, by the area of the polygon of many points of its outline.
double radiusOfOutline(const View& view, const glm::dvec3& center, double r) {
    constexpr int kPoints = 240;
    const glm::dmat4 m = view.projection * glm::dmat4(glm::dmat3(view.view));
    const bool parallel = isOrthographic(view);
    const double d = glm::length(center);
    const glm::dvec3 line = parallel ? directionOf(view) : center / d;
    // From the eye the outline is nearer than the centre, and narrower than the sphere.
    const glm::dvec3 middle = parallel ? center : center - line * (r * r / d);
    const double reach = parallel ? r : r * std::sqrt(d * d - r * r) / d;
    const glm::dvec3 a =
        glm::normalize(glm::cross(line, std::abs(line.x) < 0.8 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3 b = glm::cross(line, a);
    std::vector<glm::dvec2> outline;
    for (int i = 0; i < kPoints; ++i) {
        const double angle = 2.0 * M_PI * i / kPoints;
        const glm::dvec4 p = m * glm::dvec4(middle + reach * (std::cos(angle) * a + std::sin(angle) * b), 1.0);
        outline.push_back(0.5 * glm::dvec2(view.width, view.height) * glm::dvec2(p) / p.w);
    }
    double area = 0;
    for (int i = 0; i < kPoints; ++i) {
        const glm::dvec2 p = outline[i] - outline[0], q = outline[(i + 1) % kPoints] - outline[0];
        area += 0.5 * (p.x * q.y - p.y * q.x);
    }
    return std::sqrt(std::abs(area) / M_PI);
}

TEST(Contribution, IsTheAreaOfTheSpheresImageInEveryKindOfView) {
    test::forEachTarget([](const std::string& target) {
        Random random(1);
        int measured = 0;
        for (int round = 0; round < 400; ++round) {
            const View view = test::anyView(random, (random.below(2) ? 1e5 : 0.0) * glm::dvec3(1, -1, 0.5));
            const glm::dvec3 toward = directionOf(view);
            std::vector<Box3d> boxes(8);
            for (Box3d& box : boxes) {
                const glm::dvec3 side(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
                const glm::dvec3 center = side + toward * random.uniform(1, 60);
                const glm::dvec3 half(random.uniform(0.01, 1), random.uniform(0.01, 1), random.uniform(0.01, 1));
                box = {center - half, center + half};
            }
            float squares[8];
            squaredRadii(makeContributionMeasure(view), boxesOf(boxes), 255, squares);
            for (int i = 0; i < 8; ++i) {
                const glm::dvec3 center = 0.5 * (boxes[i].min + boxes[i].max);
                const double r = 0.5 * glm::length(boxes[i].max - boxes[i].min), depth = glm::dot(center, toward);
                if (!isOrthographic(view) && depth * depth < 2.001 * r * r) continue;
                if (!isOrthographic(view) && depth < 0) continue;
                const double outline = radiusOfOutline(view, center, r);
                ASSERT_NEAR(std::sqrt(squares[i]), outline, 1e-3 * outline) << target << " round " << round;
                ++measured;
            }
        }
        EXPECT_GT(measured, 1500) << target;
    });
}

TEST(Contribution, GrowsWithTheZoomAndTheViewport) {
    std::vector<Box3d> boxes(8, Box3d{{-1, -1, -101}, {1, 1, -99}});
    View view;
    const auto radius = [&](double degrees, uint32_t height) {
        view.width = 2 * height;
        view.height = height;
        view.projection = perspective(glm::radians(degrees), 2.0, 0.1);
        float squares[8];
        squaredRadii(makeContributionMeasure(view), boxesOf(boxes), 255, squares);
        return std::sqrt(static_cast<double>(squares[0]));
    };
    const double r = std::sqrt(3.0);
    EXPECT_NEAR(radius(60, 720), r / std::sqrt(1e4 - 3) * 360 / std::tan(glm::radians(30.0)), 1e-3);
    EXPECT_NEAR(radius(60, 1440), 2 * radius(60, 720), 1e-3);
    EXPECT_NEAR(radius(6, 720), radius(60, 720) * std::tan(glm::radians(30.0)) / std::tan(glm::radians(3.0)), 1e-2);
}

TEST(Contribution, NeverCallsSmallWhatReachesTheEyesPlaneOrIsNoNumber) {
    View view;
    view.projection = perspective(1.0, 1.0, 0.1);
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    std::vector<Box3d> boxes(8, Box3d{{-1, -1, -1}, {1, 1, 1}});  // holds the eye
    boxes[1] = {{5, 5, -0.1}, {6, 6, 0.1}};                       // beside it, across its plane
    boxes[2] = {{5, 5, 10}, {6, 6, 11}};                          // behind it
    boxes[3] = {{nan, 0, -9}, {1, 1, -8}};
    boxes[4] = {{-1, -1, -8}, {1, nan, -7}};
    boxes[5] = {{-infinity, -1, -8}, {1, 1, -7}};
    boxes[6] = {{-1e19, -1e19, -4e20}, {1e19, 1e19, -3e20}};  // whose squares float does not hold
    boxes[7] = {{-1e-20, -1e-20, -2e-20}, {1e-20, 1e-20, -1e-20}};
    test::forEachTarget([&](const std::string& target) {
        for (const uint32_t leaves : {255u, 0u}) {
            float squares[8];
            squaredRadii(makeContributionMeasure(view), boxesOf(boxes), leaves, squares);
            for (int i = 0; i < 8; ++i) EXPECT_EQ(squares[i], infinity) << target << " box " << i;
        }
    });
}

TEST(Contribution, ANodePromisesForAllBoxesInsideAndForTheirDistances) {
    test::forEachTarget([](const std::string& target) {
        Random random(2);
        int bounded = 0;
        for (int round = 0; round < 4000; ++round) {
            const View view = test::anyView(random, (random.below(2) ? 1e5 : 0.0) * glm::dvec3(1, -1, 0.5));
            const ContributionMeasure size = makeContributionMeasure(view);
            const DistanceMeasure distance = makeDistanceMeasure(view);
            const glm::dvec3 center = directionOf(view) * random.uniform(-5, 90) +
                                      glm::dvec3(random.uniform(-30, 30), random.uniform(-30, 30), 0);
            const glm::dvec3 half(random.uniform(0.01, 8), random.uniform(0.01, 8), random.uniform(0.01, 8));
            const Box3d node{center - half, center + half};
            std::vector<Box3d> inside(8);
            for (Box3d& box : inside) {
                for (int axis = 0; axis < 3; ++axis) {
                    // Often at the node's own faces, where the bound is nearest to being broken.
                    const auto place = [&] { return std::clamp(random.uniform(-0.5, 1.5), 0.0, 1.0); };
                    const double a = node.min[axis] + 2 * half[axis] * place();
                    const double b = node.min[axis] + 2 * half[axis] * place();
                    box.min[axis] = std::min({a, b, node.max[axis]});
                    box.max[axis] = std::min(std::max(a, b), node.max[axis]);
                }
            }
            const EyeBoxes nodes = boxesOf(std::vector<Box3d>(8, node)), leaves = boxesOf(inside);
            float bound[8], nested[8], exact[8], near_node[8], near_leaf[8];
            squaredRadii(size, nodes, 0, bound);
            squaredRadii(size, leaves, 0, nested);
            squaredRadii(size, leaves, 255, exact);
            squaredDistances(distance, nodes, near_node);
            squaredDistances(distance, leaves, near_leaf);
            for (int i = 0; i < 8; ++i) {
                ASSERT_GE(bound[i], exact[i]) << target << " round " << round;
                ASSERT_GE(nested[i], exact[i]) << target << " round " << round;
                ASSERT_LE(near_node[i], near_leaf[i]) << target << " round " << round;
                bounded += std::isfinite(bound[i]);
            }
        }
        EXPECT_GT(bounded, 10000) << target;
    });
}

TEST(Distance, IsToTheNearestPointAndInParallelViewsTheDepth) {
    test::forEachTarget([](const std::string& target) {
        Random random(3);
        for (int round = 0; round < 2000; ++round) {
            const View view = test::anyView(random, (random.below(2) ? 1e5 : 0.0) * glm::dvec3(1, -1, 0.5));
            std::vector<Box3d> boxes(8);
            for (Box3d& box : boxes)
                for (int axis = 0; axis < 3; ++axis) {
                    const double a = random.uniform(-50, 50), b = random.uniform(-50, 50);
                    box.min[axis] = std::min(a, b);
                    box.max[axis] = std::max(a, b);
                }
            float squares[8];
            squaredDistances(makeDistanceMeasure(view), boxesOf(boxes), squares);
            for (int i = 0; i < 8; ++i) {
                double expected = 0;
                if (isOrthographic(view)) {
                    expected = std::numeric_limits<double>::infinity();
                    for (int corner = 0; corner < 8; ++corner) {
                        const glm::dvec3 p(corner & 1 ? boxes[i].max.x : boxes[i].min.x,
                                           corner & 2 ? boxes[i].max.y : boxes[i].min.y,
                                           corner & 4 ? boxes[i].max.z : boxes[i].min.z);
                        expected = std::min(expected, glm::dot(p, directionOf(view)));
                    }
                    expected = std::max(expected, 0.0);
                } else {
                    const glm::dvec3 p = glm::clamp(glm::dvec3(0.0), boxes[i].min, boxes[i].max);
                    expected = glm::length(p);
                }
                ASSERT_NEAR(std::sqrt(squares[i]), expected, 1e-4 * (1 + expected)) << target << " round " << round;
            }
        }
    });
}

TEST(Distance, ReachesFartherWhereTheViewEnlarges) {
    View view;
    view.projection = perspective(glm::radians(60.0), 16.0 / 9.0, 0.1);
    EXPECT_EQ(distanceZoom(view, 0), 1.0);
    const double fov = glm::radians(60.0);
    EXPECT_NEAR(distanceZoom(view, fov), 1.0, 1e-12);
    view.projection = perspective(glm::radians(6.0), 4.0, 0.1);
    EXPECT_NEAR(distanceZoom(view, fov), std::tan(glm::radians(30.0)) / std::tan(glm::radians(3.0)), 1e-9);
    view.projection[2] += glm::dvec4(0.7, -1.3, 0, 0);  // off-centre
    EXPECT_NEAR(distanceZoom(view, fov), std::tan(glm::radians(30.0)) / std::tan(glm::radians(3.0)), 1e-9);
    view.projection = orthographic(2, 1, 0.1, 10);
    EXPECT_EQ(distanceZoom(view, fov), 1.0);
}

}  // namespace
}  // namespace sightline
