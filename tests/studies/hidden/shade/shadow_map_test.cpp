// A shadow lies where a ray to the sun is stopped, and nowhere else.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/shade/shadow_map.h"

#include <gtest/gtest.h>

#include "tests/studies/hidden/made_lists.h"
#include "tests/studies/hidden/shade/shadow_rays.h"

namespace sightline::test {
using namespace studies;
namespace {

struct Lit {
    Lit(MadeList m, const glm::dvec3& sun_direction, uint32_t size, const View& v = madeView())
        : made(std::move(m)),
          items(made.items()),
          list(items),
          view(v),
          image(nearestSurfaces(list, view)),
          points(list, view) {
        settings.sun = glm::normalize(sun_direction);
        settings.size = size;
        map.emplace(items, points, image, settings);
    }
    template <class Visit>
    void forEachPoint(Visit&& visit) const {
        for (uint32_t row = 0; row < view.height; ++row)
            for (uint32_t i = 0; i < view.width; ++i) {
                const uint32_t surface = image.surface[size_t{row} * view.width + i];
                if (surface != HiddenImage::kNone) visit(points.at(row, i, surface));
            }
    }

    MadeList made;
    std::vector<DrawItem> items;
    DrawList list;
    View view;
    HiddenImage image;
    SurfacePoints points;
    ShadowSettings settings;
    std::optional<ShadowMap> map;
};

MadeList floorAndPlate() {
    MadeList made;
    made.name = "floor and plate";
    made.add({-9, -1, -1}, {9, -1, -1}, {9, -1, -30});
    made.add({-9, -1, -1}, {9, -1, -30}, {-9, -1, -30});
    made.add({-1, 1.5f, -4}, {1, 1.5f, -4}, {1, 1.5f, -6});
    made.add({-1, 1.5f, -4}, {1, 1.5f, -6}, {-1, 1.5f, -6});
    return made;
}

TEST(ShadowMap, LiesUnderAPlateAndNowhereElse) {
    const Lit lit(floorAndPlate(), {0.2, 1, 0}, 1024);
    ASSERT_GT(lit.map->maps(), 1u);
    size_t dark = 0;
    lit.forEachPoint([&](const SurfacePoint& point) {
        if (point.position.y > -0.9) return;
        const glm::dvec3 shadow = point.position + glm::dvec3(0.5, 0, 0);  // 2.5 up is 0.5 across
        const double inside = std::min(1 - std::abs(shadow.x), 1 - std::abs(shadow.z + 5));
        const double reach = lit.map->reach(point);
        if (inside > 0.1) {
            EXPECT_EQ(reach, 0) << point.position.x << " " << point.position.z;
            ++dark;
        }
        if (inside < -0.1) { EXPECT_EQ(reach, 1) << point.position.x << " " << point.position.z; }
    });
    EXPECT_GT(dark, 100u);
}

TEST(ShadowMap, BothSidesOfATriangleCast) {
    MadeList made = floorAndPlate();
    made.double_sided = {1, 1, 0, 0};
    Lit lit(made, {0, 1, 0}, 512);
    std::swap(made.indices[7], made.indices[8]);
    std::swap(made.indices[10], made.indices[11]);
    Lit turned(made, {0, 1, 0}, 512);
    for (const Lit* one : {&lit, &turned}) {
        double least = 1;
        one->forEachPoint([&](const SurfacePoint& point) { least = std::min(least, one->map->reach(point)); });
        EXPECT_EQ(least, 0);
    }
}

TEST(ShadowMap, WhatWritesNoDepthCastsNothing) {
    const MadeList made = floorAndPlate();
    std::vector<DrawItem> items = made.items();
    const std::vector<uint8_t> writes = {1, 1, 0, 0};
    items[0].writes_depth = writes;
    const DrawList list(items);
    const View view = madeView();
    const HiddenImage image = nearestSurfaces(list, view);
    const SurfacePoints points(list, view);
    ShadowSettings settings;
    const ShadowMap map(items, points, image, settings);
    for (uint32_t i = 0; i < view.width; ++i)
        if (image.surface[i] != HiddenImage::kNone) { EXPECT_EQ(map.reach(points.at(0, i, image.surface[i])), 1); }
}

/// What a map says may differ from the ray through the point only where the shadow's edge is near, or where what casts
/// is nearer than the bias.
TEST(ShadowMap, AgreesWithRaysButForEdgesAndContacts) {
    Random random(11);
    for (const MadeList& made :
         {clutter(1, 200), clutter(2, 60, 1.5), interpenetration(3), slivers(4), floorAndPlate()})
        for (int turn = 0; turn < 2; ++turn) {
            const glm::dvec3 sun(random.uniform(-1, 1), random.uniform(0.3, 1), random.uniform(0, 1));
            const Lit lit(made, sun, 1024, madeView(80, 60));
            const SunRays rays(lit.items, lit.points.eye(), lit.settings.sun);
            size_t asked = 0, verdicts[4] = {};
            lit.forEachPoint([&](const SurfacePoint& point) {
                const double facing = glm::dot(point.normal, lit.settings.sun);
                if (facing < 0.1) return;
                ++asked;
                ++verdicts[static_cast<int>(judgeShadow(*lit.map, rays, point, facing))];
            });
            EXPECT_GT(asked, 100u) << made.name;
            EXPECT_EQ(verdicts[static_cast<int>(ShadowVerdict::kDarkInTheLight)], 0u) << made.name;
            EXPECT_EQ(verdicts[static_cast<int>(ShadowVerdict::kLightInTheShadow)], 0u) << made.name;
            EXPECT_LT(verdicts[static_cast<int>(ShadowVerdict::kExplained)], asked / 4) << made.name;
        }
}

TEST(ShadowMap, IsTheSameForAnySharingOfTheWork) {
    const Lit one(clutter(6, 300), {0.3, 1, 0.2}, 256);
    ShadowSettings backwards = one.settings;
    backwards.share = [](size_t count, const std::function<void(size_t)>& work) {
        for (size_t i = count; i-- > 0;) work(i);
    };
    const ShadowMap other(one.items, one.points, one.image, backwards);
    one.forEachPoint([&](const SurfacePoint& point) { ASSERT_EQ(one.map->reach(point), other.reach(point)); });
}

TEST(ShadowMap, OfNothingLetsTheSunThrough) {
    const Lit lit(MadeList{}, {0, 1, 0}, 64);
    EXPECT_EQ(lit.map->maps(), 0u);
    EXPECT_EQ(lit.map->reach(SurfacePoint{}), 1);
}

}  // namespace
}  // namespace sightline::test
