// The law of shadow casters: where a ray to the light is stopped by any object, one of those that were kept stops it.
// SPDX-License-Identifier: MIT
#include "sightline/query/shadow_query.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/made_world.h"

namespace sightline::test {
namespace {

/// Rays against the cubes of a made world, in each cube's own space.
struct Rays {
    explicit Rays(const MadeWorld& made) {
        for (const glm::dmat4& t : made.transforms) inverse.push_back(glm::inverse(t));
    }

    /// Where a ray enters and leaves a cube; false if it misses.
    bool meets(size_t object, const glm::dvec3& from, const glm::dvec3& along, double& enter, double& leave) const {
        const glm::dvec3 o(inverse[object] * glm::dvec4(from, 1)), d(inverse[object] * glm::dvec4(along, 0));
        enter = -std::numeric_limits<double>::infinity();
        leave = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            if (d[axis] == 0) {
                if (o[axis] < 0 || o[axis] > 1) return false;
                continue;
            }
            const double a = -o[axis] / d[axis], b = (1 - o[axis]) / d[axis];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        return enter < leave;
    }

    /// The nearest surface of any cube; infinity if there is none.
    double first(const glm::dvec3& from, const glm::dvec3& along, double least) const {
        double best = std::numeric_limits<double>::infinity(), enter, leave;
        for (size_t i = 0; i < inverse.size(); ++i) {
            if (!meets(i, from, along, enter, leave)) continue;
            if (enter > least) best = std::min(best, enter);
            else if (leave > least) best = std::min(best, leave);
        }
        return best;
    }

    std::vector<glm::dmat4> inverse;
};

glm::dvec3 someDirection(Random& random) {
    return glm::normalize(glm::dvec3(random.uniform(-1, 1), random.uniform(-0.6, 0.6), random.uniform(-1, 1)));
}

struct Judged {
    uint64_t points = 0, shadowed = 0, dropped = 0;
};

/// Holds a set of casters to rays from points that the view shows.
/// @param every  each object on a ray must be kept, not one of them
void expectShadows(const MadeWorld& made, const Rays& rays, const View& view, const Light& light, const CasterSet& set,
                   bool every, Random& random, const std::string& what, Judged& judged) {
    std::vector<uint8_t> kept(made.transforms.size(), 0);
    for (const Visible& caster : set.casters) kept[caster.key] = 1;
    judged.dropped += kept.size() - set.casters.size();
    const glm::dmat4 back = glm::inverse(view.projection * view.view);
    const bool sun = light.kind == LightKind::kDirectional;
    for (int ray = 0; ray < 500; ++ray) {
        const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
        const glm::dvec4 a = back * glm::dvec4(x, y, -1, 1), b = back * glm::dvec4(x, y, 0.999, 1);
        const glm::dvec3 from = glm::dvec3(a) / a.w, through = glm::dvec3(b) / b.w - from;
        const glm::dvec3 along = glm::normalize(through);
        const double t = rays.first(from, along, 1e-9);
        if (!(t < glm::length(through))) continue;  // what lies beyond the far plane is not shown
        const glm::dvec3 point = from + t * along;
        const glm::dvec3 to = sun ? -glm::normalize(light.direction) : light.position - point;
        const double far = sun ? 1e9 : glm::length(to);
        const glm::dvec3 unit = to / (sun ? 1.0 : far);
        if (!sun && far > light.range * 0.999) continue;
        if (light.kind == LightKind::kSpot &&
            glm::dot(-unit, glm::normalize(light.direction)) < std::cos(light.half_angle) + 1e-9)
            continue;
        ++judged.points;
        bool stopped = false, by_kept = false;
        for (size_t i = 0; i < kept.size(); ++i) {
            double enter, leave;
            if (!rays.meets(i, point, unit, enter, leave)) continue;
            // What lies on the point itself, or nearer to the light than its near planes, does not count. The depth along
            // a face's axis is 0.577 of the distance at least, along a spot's the cosine of its angle.
            const double end = sun ? far : far - light.near / std::min(0.577, std::cos(light.half_angle)) * 1.001;
            if (std::max(enter, 1e-6) >= std::min(leave, end)) continue;
            stopped = true;
            by_kept |= kept[i] != 0;
            if (every) { ASSERT_TRUE(kept[i]) << what << ": object " << i; }
        }
        judged.shadowed += stopped;
        ASSERT_EQ(stopped, by_kept) << what << ": ray " << ray;
    }
}

Light someLight(Random& random, LightKind kind) {
    Light light;
    light.kind = kind;
    light.direction = glm::dvec3(random.uniform(-1, 1), random.uniform(-0.7, -0.05), random.uniform(-1, 1));
    light.position = glm::dvec3(random.uniform(-15, 15), random.uniform(3, 9), random.uniform(-15, 15));
    light.half_angle = random.uniform(0.3, 1.2);
    light.near = 0.02;
    light.range = 60;
    if (kind == LightKind::kSpot) light.direction.y -= 1;
    return light;
}

/// Things on the ground.
struct GroundedWorld : MadeWorld {
    explicit GroundedWorld(uint64_t seed) {
        add({-40, -7, -40}, {40, -6, 40});
        fill(seed, 350, {0, 0, 0});
    }
};

bool casts(const CasterSet& set, ObjectId id) {
    return std::any_of(set.casters.begin(), set.casters.end(), [&](const Visible& v) { return v.id == id; });
}

void judge(LightKind kind, bool occlusion, double least_dropped) {
    Random random(17 + static_cast<uint64_t>(kind));
    Judged judged;
    for (uint64_t seed = 1; seed <= casesToMake(6, 400); ++seed) {
        GroundedWorld made(seed);
        const Rays rays(made);
        const Snapshot now = made.world.commit();
        Query query;
        ShadowQuery shadows;
        for (int frame = 0; frame < 4; ++frame) {
            const glm::dvec3 eye(random.uniform(-20, 20), random.uniform(-4, 4), random.uniform(-20, 20));
            View view = viewFrom(eye, someDirection(random), {frame % 2 ? 60.0 : 25.0});
            if (frame == 3) view.projection = orthographic(12, 16.0 / 9.0, 0.1, 30);
            const Light light = someLight(random, kind);
            CasterSettings settings;
            settings.mask_size = 128;
            settings.occlusion = occlusion;
            const VisibleSet set = query.visible(now, view);
            const CasterSet casters = shadows.casters(now, view, set.objects, light, settings);
            const std::string what = "seed " + std::to_string(seed) + " frame " + std::to_string(frame);
            expectShadows(made, rays, view, light, casters, !occlusion, random, what, judged);
            if (testing::Test::HasFailure()) return;
            const CasterStats& stats = casters.stats;
            EXPECT_EQ(stats.in_light, casters.casters.size() + stats.beside + stats.behind + stats.in_shadow) << what;
            EXPECT_EQ(stats.receivers, set.objects.size());
        }
    }
    EXPECT_GT(judged.shadowed, 500u);
    EXPECT_GT(judged.points, judged.shadowed + 100);
    EXPECT_GT(static_cast<double>(judged.dropped), least_dropped * 24 * 351);
}

TEST(ShadowQuery, KeepsWhatDarkensAPointUnderASun) { judge(LightKind::kDirectional, true, 0.4); }
TEST(ShadowQuery, KeepsAllOnTheRaysOfASunWithoutOcclusion) { judge(LightKind::kDirectional, false, 0.2); }
TEST(ShadowQuery, KeepsWhatDarkensAPointInASpotsCone) { judge(LightKind::kSpot, true, 0.4); }
TEST(ShadowQuery, KeepsAllOnTheRaysOfASpotWithoutOcclusion) { judge(LightKind::kSpot, false, 0.2); }
TEST(ShadowQuery, KeepsWhatDarkensAPointAroundAPointLight) { judge(LightKind::kPoint, true, 0.3); }
TEST(ShadowQuery, KeepsAllOnTheRaysOfAPointLightWithoutOcclusion) { judge(LightKind::kPoint, false, 0.1); }

TEST(ShadowQuery, KeepsACasterOutsideTheViewAndDropsOneThatIsInItAndDarkensNothing) {
    MadeWorld made;
    made.add({-50, -2, -50}, {50, -1, -1});                         // the ground before the eye
    const ObjectId outside = made.add({-2, 20, -12}, {2, 21, -8});  // above the view; its shadow falls into it
    const ObjectId behind = made.add({-2, 20, 30}, {2, 21, 34});    // its shadow falls behind the eye
    const ObjectId below = made.add({-2, -9, -12}, {2, -8, -8});    // under the ground
    const Snapshot now = made.world.commit();
    const View view = viewFrom({0, 0, 0}, {0, 0, -1});
    Query query;
    ShadowQuery shadows;
    Light sun{.direction = {0.1, -1, 0.05}};
    for (const bool occlusion : {true, false}) {
        CasterSettings settings;
        settings.occlusion = occlusion;
        const CasterSet set = shadows.casters(now, view, query.visible(now, view).objects, sun, settings);
        EXPECT_TRUE(casts(set, outside));
        EXPECT_FALSE(casts(set, behind));
        EXPECT_FALSE(casts(set, below));
    }
}

TEST(ShadowQuery, WhatASectionCutsShadowsNoCaster) {
    MadeWorld made;
    made.add({-50, -2, -50}, {50, -1, 50});
    made.add({-4, 20, -12}, {4, 21, -4});                        // in the sun's way
    const ObjectId under = made.add({-1, 10, -9}, {1, 11, -7});  // in the shadow of that
    const Snapshot now = made.world.commit();
    View view = viewFrom({0, 5, 10}, {0, -0.4, -1});
    Query query;
    ShadowQuery shadows;
    Light sun;
    const auto castersNow = [&] { return shadows.casters(now, view, query.visible(now, view).objects, sun); };
    EXPECT_FALSE(casts(castersNow(), under));
    view.sections.add({0, -1, 0, 15});
    EXPECT_TRUE(casts(castersNow(), under));
}

TEST(ShadowQuery, CascadesTogetherKeepWhatOneMapKeeps) {
    Random random(23);
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        GroundedWorld made(seed);
        const Rays rays(made);
        const Snapshot now = made.world.commit();
        Query query;
        ShadowQuery shadows;
        Judged judged;
        const View view = viewFrom({random.uniform(-20, 20), 1, random.uniform(-20, 20)}, someDirection(random));
        const Light light = someLight(random, LightKind::kDirectional);
        const double ends[] = {4, 12, 200};
        const auto receivers = query.visible(now, view).objects;
        const CasterSet set = shadows.casters(now, view, receivers, light, {.cascades = ends});
        expectShadows(made, rays, view, light, set, false, random, "seed " + std::to_string(seed), judged);
        uint32_t any = 0;
        for (const uint32_t bits : set.cascades) {
            EXPECT_NE(bits, 0u);
            any |= bits;
        }
        EXPECT_LE(any, 7u);
    }
}

TEST(ShadowQuery, InDoubtEverythingCasts) {
    MadeWorld made(1, 50);
    ObjectDef odd;
    odd.bounds = {glm::dvec3(0.0), glm::dvec3(std::numeric_limits<double>::quiet_NaN())};
    odd.key = 1000;
    made.world.add(odd);
    const Snapshot now = made.world.commit();
    View view = viewFrom({0, 0, 30}, {0, 0, -1});
    Query query;
    ShadowQuery shadows;
    const auto receivers = query.visible(now, view).objects;
    Light light;
    const CasterSet set = shadows.casters(now, view, receivers, light);
    EXPECT_TRUE(std::any_of(set.casters.begin(), set.casters.end(), [](const Visible& v) { return v.key == 1000; }));
    light.direction = glm::dvec3(0.0);
    EXPECT_EQ(shadows.casters(now, view, receivers, light).casters.size(), 51u);
    light.direction.x = std::numeric_limits<double>::infinity();
    EXPECT_EQ(shadows.casters(now, view, receivers, light).casters.size(), 51u);
    light.direction = {0, -1, 0};
    view.projection[0][0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(shadows.casters(now, view, receivers, light).casters.size(), 51u);
    EXPECT_EQ(shadows.casters(Snapshot(), view, {}, light).casters.size(), 0u);
    EXPECT_EQ(shadows.casters(World().commit(), viewFrom({0, 0, 0}, {0, 0, 1}), {}, light).casters.size(), 0u);
}

}  // namespace
}  // namespace sightline::test
