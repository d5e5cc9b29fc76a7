// The laws of distance and contribution culling in a query: what they may cull, what they must not, and who says so.
// SPDX-License-Identifier: MIT
#include "sightline/frame/size_limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "sightline/query/explain/explain.h"
#include "sightline/query/query.h"
#include "tests/support/made_world.h"

namespace sightline::test {
using namespace studies;
namespace {

constexpr Camera kCamera{.width = 320, .height = 180};
constexpr uint8_t kByDistance = 1 + static_cast<uint8_t>(Stage::kDistance);
constexpr uint8_t kByContribution = 1 + static_cast<uint8_t>(Stage::kContribution);

std::vector<uint8_t> reasonsOf(Query& query, const Snapshot& now, const View& view,
                               const QuerySettings& settings = {}) {
    query.visible(now, view, settings);
    return test::reasonsOf(query, now);
}

/// The pixels that an object alone covers, by an exact z-buffer of many samples.
double pixelsOf(const MadeWorld& made, size_t object, const View& view) {
    constexpr uint32_t kSamples = 4;
    DrawItem item;
    item.mesh = made.mesh.view();
    item.transform = made.transforms[object];
    ZBufferImage& image = made.image;
    renderZBuffer({&item, 1}, view, {.samples = kSamples, .want_generated = false}, image);
    const auto covered =
        image.id.size() - static_cast<size_t>(std::count(image.id.begin(), image.id.end(), ZBufferImage::kNone));
    return static_cast<double>(covered) / (kSamples * kSamples);
}

/// A seeded view of a kind: perspective of several angles, off-centre, or parallel.
View someView(Random& random, int kind) {
    View view = randomView(random, {kind % 2 ? 60.0 : 110.0, 320, 180});
    if (kind % 4 == 2) view.projection[2] += glm::dvec4(random.uniform(-0.8, 0.8), random.uniform(-0.8, 0.8), 0, 0);
    if (kind % 4 == 3) view.projection = orthographic(30, 320.0 / 180.0, 0.1, 100);
    return view;
}

TEST(SizeLimits, DoNothingUnlessAsked) {
    MadeWorld made(1, 300);
    const Snapshot now = made.world.commit();
    Query query;
    View view = viewFrom({0, 0, 0}, {1, 0, 0}, kCamera);
    QuerySettings settings{.proofs = false};
    const auto plain = reasonsOf(query, now, view, settings);
    for (const double off : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        settings.max_distance = settings.contribution = off;
        EXPECT_EQ(reasonsOf(query, now, view, settings), plain) << off;
    }
    settings.max_distance = 0.001;
    settings.contribution = 1e6;
    settings.stages = kDefaultStages & ~kLossyStages;
    EXPECT_EQ(reasonsOf(query, now, view, settings), plain) << "switched off";
    const VisibleSet set = query.visible(now, view, settings);
    EXPECT_EQ(set.stats.stages[static_cast<int>(Stage::kDistance)].tested, 0u);
}

TEST(SizeLimits, OfEyesWithinARadiusDropWhatIsTooFarForAllOfThem) {
    Random random(11);
    uint64_t culled = 0, nearer = 0;
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        MadeWorld made(seed, 300);
        const Snapshot now = made.world.commit();
        Query query;
        for (int kind = 0; kind < 8; ++kind) {
            View view = someView(random, kind);
            const QuerySettings settings{.max_distance = 12, .contribution = 6, .hysteresis = 0};
            view.eye_radius = random.uniform(0.5, 6);
            const auto all = reasonsOf(query, now, view, settings);
            if (isOrthographic(view)) {
                EXPECT_EQ(std::count(all.begin(), all.end(), 0), std::ssize(all)) << "as far as it may turn";
                continue;
            }
            for (int other = 0; other < 10; ++other) {
                glm::dvec3 by(0);
                for (int axis = 0; axis < 3; ++axis) by[axis] = random.uniform(-1, 1);
                by *= random.uniform(0, view.eye_radius) / glm::length(by);
                View one = view;
                one.eye_radius = 0;
                one.view[3] += glm::dvec4(by, 0);
                const auto alone =
                    reasonsOf(query, now, one, {.stages = stageBit(Stage::kDistance), .max_distance = 12});
                for (size_t i = 0; i < all.size(); ++i) {
                    ASSERT_TRUE(all[i] == 0 || all[i] == kByDistance);
                    culled += all[i] != 0;
                    nearer += all[i] == 0 && alone[i] != 0;
                    if (all[i] != 0) { ASSERT_EQ(alone[i], kByDistance) << "seed " << seed << " object " << i; }
                }
            }
        }
    }
    EXPECT_GT(culled, 1000u);
    EXPECT_GT(nearer, 100u);
}

TEST(SizeLimits, WhatContributionCullsCoversNoMoreThanItsDisk) {
    Random random(5);
    int culled = 0;
    for (uint64_t seed = 1; seed <= 2; ++seed) {
        MadeWorld made(seed, 300);
        const Snapshot now = made.world.commit();
        Query query;
        for (int kind = 0; kind < 8; ++kind) {
            View view = someView(random, kind);
            const auto reasons = reasonsOf(query, now, view, {.contribution = 6, .hysteresis = 0});
            for (size_t i = 0; i < reasons.size(); ++i) {
                if (reasons[i] != kByContribution) continue;
                ++culled;
                ASSERT_LE(pixelsOf(made, i, view), M_PI * 36 * 1.03) << "seed " << seed << " object " << i;
            }
        }
    }
    EXPECT_GT(culled, 100);
}

TEST(SizeLimits, EachObjectsFateHangsOnItselfNotOnItsNode) {
    Random random(6);
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        MadeWorld made(seed, 400);
        const Snapshot now = made.world.commit();
        for (int kind = 0; kind < 8; ++kind) {
            View view = someView(random, kind);
            QuerySettings settings{.max_distance = kind % 3 ? 18.0 : 0.0, .contribution = kind % 3 == 1 ? 0.0 : 5.0};
            detail::SizeLimits sizes;
            sizes.begin(now.state(), view, settings, stagesInUse(view, settings), eyePosition(view), {});
            for (const uint32_t stages : {kAllStages, stageBit(Stage::kFrustum) | kLossyStages, kLossyStages}) {
                settings.stages = stages;
                Query query;
                const auto reasons = reasonsOf(query, now, view, settings);
                for (uint32_t place = 0; place < now.state().placed.size(); ++place) {
                    if (now.state().placed[place].layers == 0) continue;  // nothing is there
                    const uint8_t reason = reasons[now.state().itemAt(place)];
                    const bool lossy = reason == kByDistance || reason == kByContribution;
                    if (lossy) { ASSERT_TRUE(sizes.drops(place)) << "seed " << seed << " kind " << kind; }
                    if (reason == 0) { ASSERT_FALSE(sizes.drops(place)) << "seed " << seed << " kind " << kind; }
                }
            }
        }
    }
}

TEST(SizeLimits, TheOthersCullOnlyWhatTheAnswerItselfHides) {
    // In the image of the objects that are kept, nothing that was culled otherwise would be seen if it were added: what
    // is left out hides nothing, whichever way it came to be drawn.
    Random random(7);
    uint64_t by_occlusion = 0, left_out = 0;
    for (uint64_t seed = 1; seed <= 8; ++seed) {
        MadeWorld made(seed, 400);
        const Snapshot now = made.world.commit();
        Query query;
        glm::dvec3 eye(random.uniform(-20, 20), 0, random.uniform(-20, 20));
        for (int frame = 0; frame < 6; ++frame) {
            View view = viewFrom(eye, {std::sin(frame), 0.1, std::cos(frame)}, kCamera);
            QuerySettings settings;
            eye += glm::dvec3(0.5, 0.1, -0.3);
            settings.stages = kAllStages;
            settings.bins = frame % 3 == 2 ? 4 : 1;
            settings.contribution = frame % 2 ? 40 : 10;
            settings.max_distance = frame % 3 ? 15 : 0;
            const auto reasons = reasonsOf(query, now, view, settings);
            MadeWorld rest = made.without([&](size_t i) {
                left_out += reasons[i] == kByDistance || reasons[i] == kByContribution;
                return reasons[i] == kByDistance || reasons[i] == kByContribution;
            });
            const std::vector<uint8_t> seen = rest.seen(view, 3);
            for (size_t i = 0, at = 0; i < reasons.size(); ++i) {
                if (reasons[i] == kByDistance || reasons[i] == kByContribution) continue;
                by_occlusion += reasons[i] == 1 + static_cast<int>(Stage::kOcclusion);
                ASSERT_TRUE(reasons[i] == 0 || !seen[at]) << "seed " << seed << " frame " << frame << " object " << i
                                                          << " was culled by stage " << int(reasons[i]);
                ++at;
            }
        }
    }
    EXPECT_GT(by_occlusion, 1000u);
    EXPECT_GT(left_out, 1000u);
}

TEST(SizeLimits, CountsAddUpAndAreTheSameForAnyBins) {
    MadeWorld made(3, 500);
    const Snapshot now = made.world.commit();
    Random random(8);
    for (int kind = 0; kind < 12; ++kind) {
        View view = someView(random, kind);
        QuerySettings settings{.max_distance = 20, .contribution = 4, .hysteresis = 0};
        uint64_t far = 0, small = 0;
        for (const uint32_t bins : {1u, 5u}) {
            Query query;
            settings.bins = bins;
            const QueryStats stats = query.visible(now, view, settings).stats;
            EXPECT_EQ(accountedFor(stats), stats.objects);
            if (bins > 1) {
                EXPECT_EQ(culledBy(stats, Stage::kDistance), far);
                EXPECT_EQ(culledBy(stats, Stage::kContribution), small);
            }
            far = culledBy(stats, Stage::kDistance);
            small = culledBy(stats, Stage::kContribution);
        }
    }
}

TEST(SizeLimits, WholeNodesAreCulledAtOnce) {
    MadeWorld made;
    Random random(9);
    for (int i = 0; i < 4000; ++i) {
        const glm::dvec3 p(random.uniform(-50, 50), random.uniform(-2, 2), random.uniform(-3100, -3000));
        made.add(p, p + 0.2);
    }
    const Snapshot now = made.world.commit();
    Query query;
    View view = viewFrom({0, 0, 0}, {0, 0, -1}, kCamera);
    QuerySettings settings{.max_distance = 1000};
    const QueryStats stats = query.visible(now, view, settings).stats;
    EXPECT_EQ(culledBy(stats, Stage::kDistance), 4000u);
    EXPECT_LE(stats.nodes_visited, 1u);
    settings.max_distance = 0;
    settings.contribution = 20;
    const QueryStats small = query.visible(now, view, settings).stats;
    EXPECT_EQ(culledBy(small, Stage::kContribution), 4000u);
    EXPECT_LT(small.nodes_visited, 100u);
}

TEST(SizeLimits, ObjectsHaveLimitsOfTheirOwn) {
    World world;
    const auto add = [&](const ObjectLimits& limits) {
        ObjectDef def;
        def.bounds = {{-1, -1, -101}, {1, 1, -99}};
        def.limits = limits;
        return world.add(def);
    };
    ObjectLimits plain, always, own_far, own_near, large, little, broken;
    always.always = true;
    own_far.max_distance = 200;
    own_near.max_distance = 50;
    large.factor = 10;
    little.factor = 0.1;
    broken.factor = std::numeric_limits<double>::quiet_NaN();
    for (const ObjectLimits& limits : {plain, always, own_far, own_near, large, little, broken}) add(limits);
    const Snapshot now = world.commit();
    Query query;
    View view = viewFrom({0, 0, 0}, {0, 0, -1}, kCamera);
    QuerySettings settings;
    settings.stages &= ~stageBit(Stage::kOcclusion);
    settings.hysteresis = 0;
    constexpr uint8_t d = kByDistance, c = kByContribution;
    settings.max_distance = 80;
    EXPECT_EQ(reasonsOf(query, now, view, settings), (std::vector<uint8_t>{d, 0, 0, d, 0, d, 0}));
    settings.max_distance = std::numeric_limits<double>::infinity();
    EXPECT_EQ(reasonsOf(query, now, view, settings), (std::vector<uint8_t>{0, 0, 0, d, 0, 0, 0}))
        << "only limits of their own";
    settings.max_distance = 0;
    settings.contribution = 2;  // its own radius: 2.7 pixels
    EXPECT_EQ(reasonsOf(query, now, view, settings), (std::vector<uint8_t>{0, 0, 0, 0, 0, c, 0}));
    settings.contribution = 20;
    EXPECT_EQ(reasonsOf(query, now, view, settings), (std::vector<uint8_t>{c, 0, c, c, 0, c, 0}));
}

TEST(SizeLimits, ManyObjectsWithLimitsAreTreatedEachByItsOwn) {
    Random random(10);
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        World world;
        std::vector<Box3d> boxes;
        std::vector<ObjectLimits> limits;
        for (int i = 0; i < 2000; ++i) {
            ObjectDef def;
            const glm::dvec3 p(random.uniform(-50, 50), random.uniform(-20, 20), random.uniform(-200, -10));
            def.bounds = {p, p + random.uniform(0.1, 2)};
            def.limits.always = random.below(10) == 0;
            if (random.below(3) == 0) def.limits.max_distance = random.uniform(10, 200);
            if (random.below(3) == 0) def.limits.factor = random.uniform(0.2, 5);
            boxes.push_back(def.bounds);
            limits.push_back(def.limits);
            world.add(def);
        }
        const Snapshot now = world.commit();
        View view = viewFrom({0, 0, 0}, {0, 0, -1}, {40, 320, 180});
        QuerySettings settings{.max_distance = 90};
        settings.stages = stageBit(Stage::kDistance);
        Query query;
        const auto reasons = reasonsOf(query, now, view, settings);
        for (size_t i = 0; i < boxes.size(); ++i) {
            const double away = glm::length(glm::clamp(glm::dvec3(0.0), boxes[i].min, boxes[i].max));
            const double limit = limits[i].always             ? 1e9
                                 : limits[i].max_distance > 0 ? limits[i].max_distance
                                                              : 90 * limits[i].factor;
            if (std::abs(away - limit) < 0.01) continue;
            ASSERT_EQ(reasons[i] == kByDistance, away > limit) << "seed " << seed << " object " << i;
        }
    }
}

TEST(SizeLimits, WhatWasShownStaysUntilItIsClearlySmaller) {
    World world;
    ObjectDef def;
    def.bounds = {{-1, -1, -1}, {1, 1, 1}};
    world.add(def);
    const Snapshot now = world.commit();
    Query query;
    const double r = std::sqrt(3.0), scale = 90 / std::tan(glm::radians(30.0));
    const auto shows = [&](double radius) {  // how large it is to look
        const double away = std::sqrt(r * r + r * r * scale * scale / (radius * radius));
        View view = viewFrom({0, 0, away}, {0, 0, -1}, kCamera);
        return !query.visible(now, view, {.contribution = 2}).objects.empty();
    };
    EXPECT_FALSE(shows(1.95)) << "nothing was shown before";
    EXPECT_TRUE(shows(2.05));
    EXPECT_TRUE(shows(1.95)) << "it was shown";
    EXPECT_TRUE(shows(1.85));
    EXPECT_TRUE(shows(1.85)) << "and still is";
    EXPECT_FALSE(shows(1.75)) << "clearly smaller";
    EXPECT_FALSE(shows(1.95)) << "not shown before";
    EXPECT_TRUE(shows(2.05));
    const auto away = [&](double distance) {
        const View view = viewFrom({0, 0, distance + 1}, {0, 0, -1}, kCamera);
        return !query.visible(now, view, {.max_distance = 10}).objects.empty();
    };
    EXPECT_TRUE(away(10.5));
    EXPECT_FALSE(away(11.5));
    EXPECT_FALSE(away(10.5));
    EXPECT_TRUE(away(9.5));
    EXPECT_TRUE(away(10.5));
}

TEST(SizeLimits, AnotherObjectWithTheIndexOfOneThatWasShownWasNot) {
    World world;
    ObjectDef def;
    def.bounds = {{-1, -1, -1}, {1, 1, 1}};
    const ObjectId first = world.add(def);
    Query query;
    View view = viewFrom({0, 0, 11.5}, {0, 0, -1}, kCamera);
    QuerySettings settings{.max_distance = 11};
    EXPECT_EQ(query.visible(world.commit(), view, settings).objects.size(), 1u);
    world.remove(first);
    const ObjectId second = world.add(def);
    ASSERT_EQ(first.index, second.index);
    settings.max_distance = 10;
    EXPECT_EQ(query.visible(world.commit(), view, settings).objects.size(), 0u);
}

TEST(SizeLimits, TheAnswerIsExplained) {
    MadeWorld made(4, 400);
    const Snapshot now = made.world.commit();
    Query query;
    Random random(11);
    int far = 0, small = 0;
    for (int frame = 0; frame < 6; ++frame) {
        View view = someView(random, 1);
        QuerySettings settings{.max_distance = 16, .contribution = 16, .bins = frame % 2 ? 3u : 1u};
        const auto reasons = reasonsOf(query, now, view, settings);
        for (size_t i = 0; i < reasons.size(); ++i) {
            if (reasons[i] != kByDistance && reasons[i] != kByContribution && i % 16) continue;
            const Explanation why = query.explain(now, view, made.ids[i], settings);
            switch (reasons[i]) {
                case 0:
                    EXPECT_EQ(why.verdict, Verdict::kVisible);
                    break;
                case kByDistance:
                    ASSERT_EQ(why.verdict, Verdict::kTooFar);
                    EXPECT_GT(why.size.distance, why.size.distance_limit);
                    ++far;
                    break;
                case kByContribution:
                    ASSERT_EQ(why.verdict, Verdict::kTooSmall);
                    EXPECT_LT(why.size.radius, why.size.radius_limit);
                    ++small;
                    break;
                case 1 + static_cast<uint8_t>(Stage::kFrustum):
                    EXPECT_EQ(why.verdict, Verdict::kOutsideFrustum);
                    break;
                default:
                    // In strips it may be hidden with its node, and be too far or too small by itself.
                    if (settings.bins == 1) EXPECT_EQ(why.verdict, Verdict::kOccluded);
                    else EXPECT_NE(why.verdict, Verdict::kVisible);
            }
        }
    }
    EXPECT_GT(far, 20);
    EXPECT_GT(small, 20);
}

}  // namespace
}  // namespace sightline::test
