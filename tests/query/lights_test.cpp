// Lights as objects of a world: one that is culled lights no point that is seen.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "sightline/cull/light_bounds.h"
#include "tests/support/made_world.h"

namespace sightline::test {
namespace {

constexpr uint32_t kThings = 1, kLights = 2;  // layers
constexpr uint64_t kFirstLight = 1u << 20;    // keys

/// The nearest cube on a ray, as a share of the ray; 1 if there is none before its end.
double firstHit(const std::vector<glm::dmat4>& inverse, const glm::dvec3& from, const glm::dvec3& to) {
    double best = 1.0;
    for (const glm::dmat4& back : inverse) {
        const glm::dvec3 o(back * glm::dvec4(from, 1)), d(back * glm::dvec4(to - from, 0));
        double enter = -1e300, leave = 1e300;
        for (int axis = 0; axis < 3; ++axis) {
            const double a = -o[axis] / d[axis], b = (1 - o[axis]) / d[axis];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        if (enter < leave && enter > 0.0) best = std::min(best, enter);
    }
    return best;
}

Light someLight(Random& random) {
    Light light{.kind = random.below(2) ? LightKind::kSpot : LightKind::kPoint,
                .position = {random.uniform(-25, 25), random.uniform(-4, 6), random.uniform(-25, 25)}};
    light.direction = {random.uniform(-1, 1), random.uniform(-1, 0), random.uniform(-1, 1)};
    light.half_angle = random.uniform(0.2, 1.2);
    light.range = random.uniform(0.5, 6);
    return light;
}

/// A point that a light lights; not all of them are equally likely.
glm::dvec3 litPoint(Random& random, const Light& light) {
    for (;;) {
        const glm::dvec3 p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        const double length = glm::length(p);
        if (length > 1 || length == 0) continue;
        if (light.kind == LightKind::kSpot &&
            glm::dot(p / length, glm::normalize(light.direction)) < std::cos(light.half_angle))
            continue;
        return light.position + light.range * p;
    }
}

}  // namespace

TEST(Lights, OneThatIsCulledLightsNothingThatIsSeen) {
    Random random(1);
    uint64_t beside = 0, hidden = 0, kept = 0;
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        MadeWorld made;
        made.add({-40, -7, -40}, {40, -6, 40});
        made.fill(seed, 300, {0, 0, 0});
        std::vector<glm::dmat4> inverse;
        for (const glm::dmat4& t : made.transforms) inverse.push_back(glm::inverse(t));
        std::vector<Light> lights;
        for (int i = 0; i < 200; ++i) {
            lights.push_back(someLight(random));
            ObjectDef def;
            def.bounds = lightBox(lights.back());
            def.key = kFirstLight + static_cast<uint64_t>(i);
            def.layers = kLights;
            made.world.add(def);
        }
        lights.push_back(Light{});  // a sun has no bounds, and is never culled
        ObjectDef sun;
        sun.bounds = lightBox(lights.back());
        sun.key = kFirstLight + 200;
        sun.layers = kLights;
        made.world.add(sun);
        const Snapshot now = made.world.commit();
        Query query;
        for (int frame = 0; frame < 4; ++frame) {
            View view = randomView(random, {57, 320, 180, 0.05});
            const glm::dvec3 eye = eyePosition(view);
            view.layers = kThings | kLights;
            std::vector<uint8_t> is_kept(lights.size(), 0);
            for (const Visible& object : query.visible(now, view).objects)
                if (object.key >= kFirstLight) is_kept[object.key - kFirstLight] = 1;
            EXPECT_TRUE(is_kept.back());
            const glm::dmat4 clip = view.projection * view.view;
            for (size_t i = 0; i + 1 < lights.size(); ++i) {
                if (is_kept[i]) {
                    ++kept;
                    continue;
                }
                bool all_beside = true;
                for (int sample = 0; sample < 40; ++sample) {
                    const glm::dvec3 p = litPoint(random, lights[i]);
                    const glm::dvec4 c = clip * glm::dvec4(p, 1);
                    if (c.w < 0.05 || std::abs(c.x) > c.w || std::abs(c.y) > c.w) continue;
                    all_beside = false;
                    // What is seen is on a cube's surface: none of it may be nearer to the eye than the first one.
                    EXPECT_LT(firstHit(inverse, eye, p), 1.0)
                        << "seed " << seed << ", frame " << frame << ", light " << i;
                }
                ++(all_beside ? beside : hidden);
            }
        }
    }
    EXPECT_GT(beside, 500u);
    EXPECT_GT(hidden, 50u);
    EXPECT_GT(kept, 200u);
}

}  // namespace sightline::test
