// The law of lights' bounds: they hold every point that is lit, and nothing smaller does.
// SPDX-License-Identifier: MIT
#include "sightline/cull/light_bounds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <glm/gtc/constants.hpp>

#include "sightline/base/random.h"
#include "tests/support/random.h"

namespace sightline {
namespace {

constexpr double kPi = glm::pi<double>();

Light someLight(Random& random) {
    Light light{.kind = random.below(4) ? LightKind::kSpot : LightKind::kPoint,
                .position = std::pow(10.0, random.uniform(-2, 4)) * test::randomUnit(random)};
    light.direction = std::pow(10.0, random.uniform(-3, 3)) * test::randomUnit(random);
    if (random.below(4) == 0) {  // along an axis, or nearly so
        light.direction = glm::dvec3(0.0);
        light.direction[static_cast<int>(random.below(3))] = random.below(2) ? 2.0 : -2.0;
        if (random.below(2)) light.direction += 1e-8 * test::randomUnit(random);
    }
    constexpr double kAngles[] = {kPi / 4, kPi / 2, 1e-3, kPi / 4 + 1e-9, kPi};
    light.half_angle = random.below(4) ? random.uniform(0.01, random.below(3) ? 1.5 : kPi) : kAngles[random.below(5)];
    light.range = std::pow(10.0, random.uniform(-2, 3));
    return light;
}

/// Directions and places in what a light lights, by angles.
struct Lit {
    const Light& light;
    glm::dvec3 axis, side, other;
    double widest;

    explicit Lit(const Light& of) : light(of), axis(glm::normalize(of.direction)) {
        widest = of.kind == LightKind::kPoint ? kPi : of.half_angle;
        side = glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
        other = glm::cross(axis, side);
    }
    glm::dvec3 direction(double angle, double turn) const {
        return std::cos(angle) * axis + std::sin(angle) * (std::cos(turn) * side + std::sin(turn) * other);
    }
    glm::dvec3 point(double angle, double turn, double share) const {
        return light.position + share * light.range * direction(angle, turn);
    }
    /// The farthest lit point along a direction, by a search that looks closer and closer.
    double farthest(const glm::dvec3& along) const {
        double angle = 0.5 * widest, turn = kPi, reach_angle = 0.5 * widest, reach_turn = kPi;
        double best = 0.0;  // at the light itself
        for (int level = 0; level < 24; ++level) {
            double best_angle = angle, best_turn = turn, found = -2.0;
            for (int i = -8; i <= 8; ++i)
                for (int j = -8; j <= 8; ++j) {
                    const double a = glm::clamp(angle + reach_angle * i / 8, 0.0, widest);
                    const double t = turn + reach_turn * j / 8;
                    const double here = glm::dot(direction(a, t), along);
                    if (here > found) found = here, best_angle = a, best_turn = t;
                }
            angle = best_angle, turn = best_turn;
            reach_angle *= 0.4, reach_turn *= 0.4;
            best = std::max(best, found);
        }
        return best * light.range;
    }
};

}  // namespace

TEST(LightBounds, HoldEveryLitPoint) {
    Random random(1);
    for (int round = 0; round < 2000; ++round) {
        const Light light = someLight(random);
        const Lit lit(light);
        const Box3d box = lightBox(light);
        const Sphere sphere = lightSphere(light);
        // What the sample itself is wrong by.
        const double slack = 1e-14 * (glm::length(light.position) + light.range);
        for (int i = 0; i < 100; ++i) {
            const bool rim = i % 2;
            const glm::dvec3 p = lit.point(rim ? lit.widest : random.uniform(0, lit.widest), random.uniform(0, 2 * kPi),
                                           i % 3 ? 1.0 : random.uniform());
            for (int axis = 0; axis < 3; ++axis) {
                ASSERT_GE(p[axis], box.min[axis] - slack) << "round " << round;
                ASSERT_LE(p[axis], box.max[axis] + slack) << "round " << round;
            }
            ASSERT_LE(glm::length(p - sphere.center), sphere.radius + slack) << "round " << round;
        }
    }
}

TEST(LightBounds, BoxesAreAsTightAsTheFarthestLitPoints) {
    Random random(2);
    for (int round = 0; round < 300; ++round) {
        const Light light = someLight(random);
        const Lit lit(light);
        const Box3d box = lightBox(light);
        const double slack = 1e-14 * (glm::length(light.position) + light.range);
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 along(0.0);
            along[axis] = 1.0;
            const double high = light.position[axis] + lit.farthest(along);
            const double low = light.position[axis] - lit.farthest(-along);
            EXPECT_LE(box.max[axis] - high, 1e-6 * light.range + slack) << "round " << round << ", axis " << axis;
            EXPECT_LE(low - box.min[axis], 1e-6 * light.range + slack) << "round " << round << ", axis " << axis;
            EXPECT_GE(box.max[axis] - high, -slack) << "round " << round << ", axis " << axis;
            EXPECT_GE(low - box.min[axis], -slack) << "round " << round << ", axis " << axis;
        }
    }
}

// A ball is the smallest if, whichever way its centre is moved, it comes no nearer to some point that it touches.
TEST(LightBounds, NoSmallerSphereHoldsWhatIsLit) {
    Random random(3);
    for (int round = 0; round < 300; ++round) {
        const Light light = someLight(random);
        const Lit lit(light);
        const Sphere sphere = lightSphere(light);
        const double nearly = sphere.radius - 1e-6 * light.range - 1e-13 * glm::length(light.position);
        std::vector<glm::dvec3> touched;
        const auto look = [&](const glm::dvec3& p) {
            if (glm::length(p - sphere.center) >= nearly) touched.push_back(p - sphere.center);
        };
        look(light.position);
        for (int i = 0; i < 64; ++i)
            for (const double angle : {0.0, 0.25 * lit.widest, 0.5 * lit.widest, 0.75 * lit.widest, lit.widest})
                look(lit.point(angle, 2 * kPi * i / 64, 1.0));
        if (lit.widest > kPi / 2)
            for (int i = 0; i < 64; ++i) look(lit.point(kPi / 2, 2 * kPi * i / 64, 1.0));
        ASSERT_FALSE(touched.empty()) << "round " << round;
        for (int i = 0; i < 50; ++i) {
            const glm::dvec3 way = test::randomUnit(random);
            double least = std::numeric_limits<double>::infinity();
            for (const glm::dvec3& t : touched) least = std::min(least, glm::dot(t, way));
            EXPECT_LE(least, 0.01 * sphere.radius) << "round " << round;
        }
    }
}

TEST(LightBounds, OfASpotAlongAnAxisAreKnown) {
    Light spot{.kind = LightKind::kSpot, .position = {1, 2, 3}};
    spot.direction = {0, -5, 0};
    spot.half_angle = kPi / 6;
    spot.range = 10;
    const Box3d box = lightBox(spot);
    EXPECT_NEAR(box.min.x, 1 - 5, 1e-9);
    EXPECT_NEAR(box.max.x, 1 + 5, 1e-9);
    EXPECT_NEAR(box.min.y, 2 - 10, 1e-9);
    EXPECT_NEAR(box.max.y, 2, 1e-9);
    EXPECT_NEAR(box.min.z, 3 - 5, 1e-9);
    const Sphere slim = lightSphere(spot);  // around the apex and the rim
    EXPECT_NEAR(slim.radius, 10 / std::sqrt(3.0), 1e-9);
    EXPECT_NEAR(slim.center.y, 2 - 10 / std::sqrt(3.0), 1e-9);
    spot.half_angle = kPi / 3;
    const Sphere wide = lightSphere(spot);  // around the rim
    EXPECT_NEAR(wide.radius, 10 * std::sin(kPi / 3), 1e-9);
    EXPECT_NEAR(wide.center.y, 2 - 5, 1e-9);
}

TEST(LightBounds, OfSunsAndOfWhatIsNoNumberAreInfinite) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                     kInfinity = std::numeric_limits<double>::infinity();
    const auto isUnbounded = [](const Light& light) {
        const Box3d box = lightBox(light);
        return box.min == glm::dvec3(-kInfinity) && box.max == glm::dvec3(kInfinity) &&
               lightSphere(light).radius == kInfinity;
    };
    EXPECT_TRUE(isUnbounded(Light{}));
    Light good{.kind = LightKind::kSpot};
    EXPECT_FALSE(isUnbounded(good));
    good.direction = {1e-300, 2e-300, 0};
    EXPECT_FALSE(isUnbounded(good));
    good.direction = {1e300, 2e300, 0};
    EXPECT_FALSE(isUnbounded(good));
    const auto broken = [&](const auto& change) {
        Light light = good;
        change(light);
        return isUnbounded(light);
    };
    EXPECT_TRUE(broken([&](Light& l) { l.direction = glm::dvec3(0.0); }));
    EXPECT_TRUE(broken([&](Light& l) { l.direction.y = kNan; }));
    EXPECT_TRUE(broken([&](Light& l) { l.direction.y = kInfinity; }));
    EXPECT_TRUE(broken([&](Light& l) { l.position.x = kNan; }));
    EXPECT_TRUE(broken([&](Light& l) { l.position.z = -kInfinity; }));
    EXPECT_TRUE(broken([&](Light& l) { l.range = kInfinity; }));
    EXPECT_TRUE(broken([&](Light& l) { l.range = kNan; }));
    EXPECT_TRUE(broken([&](Light& l) { l.range = -1; }));
    EXPECT_TRUE(broken([&](Light& l) { l.half_angle = kNan; }));
    good.kind = LightKind::kPoint;  // has no direction
    EXPECT_FALSE(broken([&](Light& l) { l.direction = glm::dvec3(kNan); }));
}

}  // namespace sightline
