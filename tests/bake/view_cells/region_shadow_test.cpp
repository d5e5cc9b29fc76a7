// Shadows from regions: what they hide lies behind the hider on every segment, and little else is kept.
// SPDX-License-Identifier: MIT
#include "sightline/bake/view_cells/region_shadow.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "tests/support/random.h"

namespace sightline {
using namespace bake;
namespace {

/// A convex polygon with a frame of its own, anywhere and turned anyhow.
struct MadeHider {
    FlatHider hider;
    glm::dvec3 middle{0.0}, across{0.0}, up{0.0}, normal{0.0};
    double size = 1;

    MadeHider(Random& random, double far) {
        const auto direction = [&] {
            return glm::normalize(glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)) +
                                  glm::dvec3(1e-3));
        };
        normal = direction();
        across = glm::normalize(glm::cross(normal, direction()));
        up = glm::cross(normal, across);
        middle = far * direction();
        size = std::pow(10, random.uniform(-1, 1));
        const size_t corners = 3 + random.below(10);
        const double turn = random.uniform(0, 6);
        for (size_t i = 0; i < corners; ++i) {
            const double angle = turn + 6.283185307179586 * double(i) / double(corners);
            hider.corners.push_back(middle + size * (std::cos(angle) * across + std::sin(angle) * up));
            hider.bounds.grow(hider.corners.back());
        }
        hider.plane = glm::dvec4(normal, -glm::dot(normal, middle));
    }

    Box3d boxAt(Random& random, double height, double reach) const {
        Box3d box;
        const glm::dvec3 center =
            middle + height * normal + reach * random.uniform(-1, 1) * across + reach * random.uniform(-1, 1) * up;
        const double half = size * std::pow(10, random.uniform(-3, 0));
        box.min = center - half * glm::dvec3(random.uniform(), random.uniform(), random.uniform());
        box.max = center + half * glm::dvec3(random.uniform(), random.uniform(), random.uniform());
        return box;
    }

    /// How far inside of the polygon a segment passes the plane at a height; less than 0: outside, or it does not.
    double inside(const glm::dvec3& from, const glm::dvec3& to, double height) const {
        const double above = glm::dot(normal, from - hider.corners[0]) - height,
                     below = glm::dot(normal, to - hider.corners[0]) - height;
        if (!(above > 0 && below < 0)) return -INFINITY;
        const glm::dvec3 point = from + above / (above - below) * (to - from);
        double least = INFINITY;
        for (size_t i = 0; i < hider.corners.size(); ++i) {
            const glm::dvec3& a = hider.corners[i];
            const glm::dvec3 edge = hider.corners[(i + 1) % hider.corners.size()] - a;
            least = std::min(least, glm::dot(glm::cross(normal, edge), point - a) / glm::length(edge));
        }
        return least;
    }
};

std::vector<glm::dvec3> cornersOf(const Box3d& box) {
    std::vector<glm::dvec3> corners;
    for (int i = 0; i < 8; ++i)
        corners.emplace_back(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                             i & 4 ? box.max.z : box.min.z);
    return corners;
}

/// The least of inside() over segments from corner to corner, which bound all others.
double leastInside(const MadeHider& made, const Box3d& region, const Box3d& box, double bend) {
    double least = INFINITY;
    for (const glm::dvec3& from : cornersOf(region))
        for (const glm::dvec3& to : cornersOf(box))
            for (const double height : {-bend / 2, 0.0, bend / 2})
                least = std::min(least, made.inside(from, to, height));
    return least;
}

TEST(RegionShadow, HidesWhatEverySegmentPassesTheHiderTo) {
    Random random(1);
    uint64_t hidden = 0, passed = 0, kept = 0;
    for (int round = 0; round < 20'000; ++round) {
        const double far = round % 3 == 0 ? 0 : std::pow(10, random.uniform(0, 4));
        MadeHider made(random, far);
        const double bend = made.size * std::pow(10, random.uniform(-7, -2)) + far * 0x1p-40;
        made.hider.bend = bend;
        const double reach = 2 * (far + 40 * made.size);
        const Box3d region = made.boxAt(random, made.size * std::pow(10, random.uniform(-2, 1)), 2 * made.size);
        const RegionShadow shadow(made.hider, cornersOf(region), reach);
        for (int k = 0; k < 8; ++k) {
            const Box3d box = made.boxAt(random, -made.size * std::pow(10, random.uniform(-2, 1)), 2 * made.size);
            const double least = leastInside(made, region, box, bend);
            const bool hides = shadow.hides(box);
            hidden += hides;
            ASSERT_TRUE(!hides || least >= 0) << "round " << round << ": a segment passes " << -least << " beside it";
            if (least <= 20 * bend + made.size / 100) continue;
            ++passed;
            kept += !hides;
        }
    }
    EXPECT_GT(hidden, 3'000u);
    EXPECT_GT(passed, 3'000u);
    EXPECT_LT(static_cast<double>(kept), 0.01 * static_cast<double>(passed));
}

TEST(RegionShadow, IsNoneWhereTheRegionIsNotInFront) {
    Random random(2);
    for (int round = 0; round < 1000; ++round) {
        MadeHider made(random, 0);
        const double bend = 1e-6 * made.size;
        made.hider.bend = bend;
        Box3d region = made.boxAt(random, -made.size, made.size);
        region.grow(made.middle + bend / 2 * made.normal);
        EXPECT_FALSE(RegionShadow(made.hider, cornersOf(region), 100).any());
        region.grow(made.middle + made.size * made.normal);
        EXPECT_FALSE(RegionShadow(made.hider, cornersOf(region), 100).any()) << "it stands in the plane";
    }
}

}  // namespace
}  // namespace sightline
