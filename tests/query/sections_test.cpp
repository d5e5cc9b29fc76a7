// Section planes and windows: what a cut lays open is kept, what lies beyond is culled, and nothing that is cut hides.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

#include "sightline/geom/view_limits.h"
#include "sightline/query/explain/explain.h"
#include "tests/support/made_world.h"
#include "tests/support/targets.h"

namespace sightline::test {
using namespace studies;
namespace {

constexpr size_t kFrustumStage = static_cast<size_t>(Stage::kFrustum);
constexpr size_t kOcclusionStage = static_cast<size_t>(Stage::kOcclusion);

/// Through a place among the objects, of any length.
glm::dvec4 randomPlane(Random& random) {
    const glm::dvec3 n(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const glm::dvec3 p(random.uniform(-12, 12), random.uniform(-4, 4), random.uniform(-12, 12));
    const double length = std::pow(10.0, random.uniform(-3, 3));
    return length * glm::dvec4(n, -glm::dot(n, p));
}

void expectSeenIsKept(const MadeWorld& made, const View& view, const std::vector<uint8_t>& kept,
                      const std::string& what) {
    const std::vector<uint8_t> seen = made.seen(view, 3);
    for (size_t i = 0; i < kept.size(); ++i) ASSERT_TRUE(kept[i] || !seen[i]) << what << ": object " << i;
}

/// A closed room of six walls around the origin, with things in it and a few outside.
struct Room : MadeWorld {
    static constexpr size_t kInside = 6, kEnd = 26;

    explicit Room(bool one_box = false) {
        if (one_box) {
            add({-5, -5, -5}, {5, 5, 5});
            for (size_t i = 1; i < kInside; ++i) add(glm::dvec3(100.0 + i, 0, 0), glm::dvec3(100.5 + i, 1, 1));
        } else {
            for (int axis = 0; axis < 3; ++axis)
                for (const double side : {-5.0, 4.8}) {
                    glm::dvec3 low(-5), high(5);
                    low[axis] = side;
                    high[axis] = side + 0.2;
                    add(low, high);
                }
        }
        for (size_t i = kInside; i < kEnd; ++i) {
            const glm::dvec3 low(-4.0 + 0.4 * double(i % 5), -3.0 + 0.3 * double(i), -2.0 + double(i % 3));
            add(low, low + 0.3, i % 2 == 0);
        }
    }
};

TEST(Sections, AClosedRoomCutOpenShowsWhatIsInside) {
    for (const bool one_box : {false, true}) {
        Room room(one_box);
        const Snapshot now = room.world.commit();
        Query query;
        View view = viewFrom({0, 0, 20}, {0, 0, -1});
        QuerySettings settings;
        const auto inside = [&](const VisibleSet& set) {
            const std::vector<uint8_t> kept = keptOf(set, room.transforms.size());
            return std::count(kept.begin() + Room::kInside, kept.begin() + Room::kEnd, 1);
        };
        EXPECT_EQ(inside(query.visible(now, view, settings)), 0) << one_box;
        view.sections.add({0, 0, -1, 4.0});  // z <= 4: the wall towards the eye is gone
        const VisibleSet open = query.visible(now, view, settings);
        EXPECT_EQ(inside(open), Room::kEnd - Room::kInside) << one_box;
        expectSeenIsKept(room, view, keptOf(open, room.transforms.size()), "open");
        for (const uint32_t bins : {2u, 5u}) {
            settings.bins = bins;
            EXPECT_EQ(inside(query.visible(now, view, settings)), Room::kEnd - Room::kInside) << bins;
        }
        settings.bins = 1;
        View beside = shiftedEye(view, 0.3);
        const StereoSet both = query.visibleStereo(now, view, beside, settings);
        EXPECT_EQ(inside({both.objects, both.left, {}, {}, {}}), Room::kEnd - Room::kInside);
        // A wall that the cut does not reach hides as ever: from behind, the room is closed.
        view = viewFrom({0, 0, -20}, {0, 0, 1});
        view.sections.add({0, 0, -1, 4.0});
        if (!one_box) { EXPECT_EQ(inside(query.visible(now, view, settings)), 0); }
    }
}

TEST(Sections, CullWhatLiesBeyondAndCountItAsFrustum) {
    MadeWorld made;
    made.add({-1, -1, -10}, {1, 1, -9});     // kept
    made.add({3, -1, -10}, {4, 1, -9});      // beyond
    made.add({1.5, -1, -10}, {2.5, 1, -9});  // cut
    made.add({2.0, -1, -10}, {2.2, 1, -9});  // touches
    const Snapshot now = made.world.commit();
    Query query;
    View view = viewFrom({0, 0, 0}, {0, 0, -1});
    QuerySettings settings;
    view.sections.add({-7, 0, 0, 14});  // x <= 2
    const VisibleSet set = query.visible(now, view, settings);
    EXPECT_EQ(keptOf(set, 4), (std::vector<uint8_t>{1, 0, 1, 1}));
    EXPECT_EQ(set.stats.stages[kFrustumStage].culled, 1u);
    EXPECT_EQ(reasonsOf(query, now)[1], 1 + static_cast<uint8_t>(Stage::kFrustum));
    settings.stages &= ~stageBit(Stage::kFrustum);
    EXPECT_EQ(query.visible(now, view, settings).objects.size(), 4u) << "without the stage nothing is culled by planes";
    settings.stages = kAllStages;
    view.sections = {};
    view.sections.add({0, 0, 0, -1});
    EXPECT_EQ(query.visible(now, view, settings).objects.size(), 0u)
        << "nothing is inside of a plane without a direction";
    view.sections = {};
    view.sections.add({0, 0, 0, 1});
    EXPECT_EQ(query.visible(now, view, settings).objects.size(), 4u);
}

TEST(Sections, PlanesThatAreNoNumbersMakeEverythingVisible) {
    Room room;
    const Snapshot now = room.world.commit();
    Query query;
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        for (int place = 0; place < 4; ++place)
            for (const bool section : {false, true}) {
                View view = viewFrom({0, 0, 20}, {0, 0, -1});
                glm::dvec4 plane(0, 0, 1, 0);
                plane[place] = bad;
                (section ? view.sections : view.window).add(plane);
                EXPECT_EQ(query.visible(now, view).objects.size(), room.transforms.size());
            }
    View full = viewFrom({0, 0, 20}, {0, 0, -1});
    for (uint32_t i = 0; i < ViewPlanes::kMost; ++i) EXPECT_TRUE(full.sections.add({0, 0, 1, 100}));
    EXPECT_FALSE(full.sections.add({0, 0, 1, 100}));
    full.sections.count = ViewPlanes::kMost + 1;
    EXPECT_FALSE(isUsable(full));
}

TEST(Sections, KeepWhatIsSeenInWorldsCutAnywhere) {
    uint64_t culled = 0, beyond = 0, opened = 0;
    for (uint64_t seed = 1; seed <= 32; ++seed) {
        MadeWorld made;
        made.shapes = seed % 2;
        made.fill(seed, 300, {0, 0, 0});
        const Snapshot now = made.world.commit();
        Query query;
        Random random(seed);
        for (int frame = 0; frame < 8; ++frame) {
            View view = randomView(random);
            QuerySettings settings;
            if (frame % 4 == 3) view.projection = orthographic(16, 16.0 / 9.0, 0.1, frame % 8 == 3 ? 50 : 1e4);
            const View whole = view;
            for (uint64_t i = 0, planes = 1 + random.below(3); i < planes; ++i) view.sections.add(randomPlane(random));
            if (frame % 3 == 1) settings.stages = kAllStages;
            settings.masked = frame % 5 == 0;
            for (const uint32_t bins : {1u, 4u}) {
                settings.bins = bins;
                const VisibleSet set = query.visible(now, view, settings);
                culled += set.stats.stages[kOcclusionStage].culled;
                beyond += set.stats.stages[kFrustumStage].culled;
                const std::string what = "seed " + std::to_string(seed) + " frame " + std::to_string(frame) + " bins " +
                                         std::to_string(bins);
                expectSeenIsKept(made, view, keptOf(set, made.transforms.size()), what);
                if (HasFatalFailure()) return;
            }
            // What the cut lays open: seen now, and not before.
            const std::vector<uint8_t> now_seen = made.seen(view, 2), before = made.seen(whole, 2);
            for (size_t i = 0; i < before.size(); ++i) opened += now_seen[i] && !before[i];
        }
    }
    EXPECT_GT(culled, 1000u);
    EXPECT_GT(beyond, 2000u);
    EXPECT_GT(opened, 500u) << "the cuts must lay something open for this to mean anything";
}

TEST(Sections, WhatIsLeftWholeHidesAsEver) {
    // Of a wall of many small quadrangles the part beside the cut still hides.
    MadeWorld made;
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    constexpr uint32_t kSide = 64;
    for (uint32_t y = 0; y <= kSide; ++y)
        for (uint32_t x = 0; x <= kSide; ++x)
            positions.push_back({float(x) / kSide, float(y) / kSide, 0.01f * float((x * 7 + y * 3) % 5)});
    for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x < kSide; ++x) {
            const uint32_t a = y * (kSide + 1) + x, b = a + 1, c = a + kSide + 1, d = c + 1;
            for (const uint32_t i : {a, b, d, a, d, c}) indices.push_back(i);
        }
    const Occluder wall = prepareOccluder({positions, indices});
    ASSERT_GT(wall.clusters.size(), 8u);
    ObjectDef def;
    def.bounds = {glm::dvec3(0.0), glm::dvec3(1.0, 1.0, 0.04)};
    def.transform[0][0] = def.transform[1][1] = 20;
    def.transform[3] = glm::dvec4(-10, -10, -10, 1);
    def.key = 0;
    def.occluder = made.world.addOccluder(wall);
    made.world.add(def);
    made.transforms.push_back(def.transform);  // keeps keys in step
    made.hides.push_back(1);
    for (int i = 0; i < 10; ++i) made.add({-8.0 + 1.6 * i, -0.2, -21}, {-7.8 + 1.6 * i, 0.2, -20});
    const Snapshot now = made.world.commit();
    Query query;
    View view = viewFrom({0, 0, 0}, {0, 0, -1}, {90});
    QuerySettings settings;
    EXPECT_EQ(query.visible(now, view, settings).objects.size(), 1u);
    view.sections.add({1, 0, 0, 2});  // x >= -2
    const std::vector<uint8_t> kept = keptOf(query.visible(now, view, settings), 11);
    // Object 1 + i stands at x = -8 + 1.6 i, and the line of sight to it meets the wall at half of that.
    for (size_t i = 0; i < 10; ++i) {
        const double x = -8.0 + 1.6 * double(i);
        if (x < -2.5) {
            EXPECT_FALSE(kept[1 + i]) << i << ": beyond the section";
        } else if (x > 1.0) {
            EXPECT_FALSE(kept[1 + i]) << i << ": behind what is whole";
        }
    }
    EXPECT_TRUE(kept[0]);
    // From an eye to the left, the gap that was cut shows what stands behind the wall.
    view.view = lookAt({-6, 0, 0}, {-1.6, 0, -20.5}, {0, 1, 0});
    EXPECT_TRUE(keptOf(query.visible(now, view, settings), 11)[1 + 4]);
    view.sections = {};
    EXPECT_FALSE(keptOf(query.visible(now, view, settings), 11)[1 + 4]);
}

TEST(Sections, GiveOneAnswerOnEveryTarget) {
    MadeWorld made(5, 300);
    const Snapshot now = made.world.commit();
    Random random(5);
    for (int frame = 0; frame < 6; ++frame) {
        View view = randomView(random);
        for (int i = 0; i < 3; ++i) view.sections.add(randomPlane(random));
        addWindow(view, 30, 20, 140, 80);
        std::vector<uint64_t> first;
        forEachTarget([&](const std::string& target) {
            Query query;
            const std::vector<uint64_t> keys = keysOf(query.visible(now, view));
            if (first.empty()) first = keys;
            EXPECT_EQ(keys, first) << target << " frame " << frame;
        });
    }
}

TEST(Sections, ExplainNamesThePlaneAndWhatIsCut) {
    Room room;
    const Snapshot now = room.world.commit();
    View view = viewFrom({0, 0, 20}, {0, 0, -1});
    view.sections.add({0, 1, 0, 100});
    view.sections.add({0, 0, -1, 4.0});
    Explainer explainer(now, view);
    const Explanation front = explainer.explain(room.ids[5]);  // the wall at z = 4.8 to 5
    EXPECT_EQ(front.verdict, Verdict::kOutsideFrustum);
    EXPECT_STREQ(kPlaneNames[front.frustum.plane], "section 2");
    EXPECT_NEAR(front.frustum.distance(), 0.8, 1e-6);
    EXPECT_TRUE(front.cut);
    const Explanation side = explainer.explain(room.ids[0]);
    EXPECT_EQ(side.verdict, Verdict::kVisible);
    EXPECT_TRUE(side.cut);
    const Explanation back = explainer.explain(room.ids[4]);
    EXPECT_FALSE(back.cut);
    view.sections = {};
    ASSERT_TRUE(addWindow(view, 0, 0, 40, 90));
    const Explanation away = Explainer(now, view).explain(room.ids[1]);  // the wall to the right
    EXPECT_EQ(away.verdict, Verdict::kOutsideFrustum);
    EXPECT_STREQ(kPlaneNames[away.frustum.plane], "window 2");
}

/// Objects of which an image of those that `drawn` says shows a point inside of the window.
std::vector<uint8_t> seenInWindow(const MadeWorld& made, const View& view, const std::vector<uint8_t>& drawn,
                                  uint32_t samples) {
    std::vector<DrawItem> items;
    for (size_t i = 0; i < made.transforms.size(); ++i) {
        if (!drawn[i]) continue;
        DrawItem item;
        item.mesh = made.mesh.view();
        item.transform = made.transforms[i];
        item.id = static_cast<uint32_t>(i);
        items.push_back(item);
    }
    const ZBufferImage image = renderZBuffer(items, view, {.samples = samples});
    const glm::dmat4 to_eye = glm::inverse(view.projection), to_world = glm::inverse(view.view);
    std::vector<uint8_t> seen(made.transforms.size(), 0);
    for (size_t at = 0; at < image.id.size(); ++at) {
        if (image.id[at] == ZBufferImage::kNone || seen[image.id[at]]) continue;
        const double x = 2.0 * (double(at % image.width) + 0.5) / image.width - 1.0;
        const double y = 2.0 * (double(at / image.width) + 0.5) / image.height - 1.0;
        glm::dvec4 eye = to_eye * glm::dvec4(x, y, 0.0, 1.0);
        glm::dvec3 point = glm::dvec3(eye) / eye.w;
        if (isOrthographic(view)) point.z = image.depth[at];
        else point *= -1.0 / image.depth[at] / point.z;
        const glm::dvec3 world(to_world * glm::dvec4(point, 1.0));
        bool inside = true;
        for (const glm::dvec4& plane : view.window.all())
            inside &= glm::dot(glm::dvec3(plane), world) + plane.w >= 1e-9 * glm::length(glm::dvec3(plane));
        if (inside) seen[image.id[at]] = 1;
    }
    return seen;
}

TEST(Windows, KeepWhatIsSeenInsideOfThem) {
    uint64_t beside = 0, occluded = 0;
    for (uint64_t seed = 1; seed <= 10; ++seed) {
        MadeWorld made;
        made.shapes = seed % 2;
        made.fill(seed, 300, {0, 0, 0});
        std::fill(made.hides.begin(), made.hides.end(), 1);
        const Snapshot now = made.world.commit();
        Query query;
        Random random(seed);
        for (int frame = 0; frame < 9; ++frame) {
            View view = randomView(random);
            QuerySettings settings;
            if (frame % 4 == 2) view.projection = orthographic(16, 16.0 / 9.0, 0.1, 1e4);
            settings.stages = frame % 2 ? kAllStages : kDefaultStages;
            if (frame % 3 == 0) {
                ASSERT_TRUE(addWindow(view, random.uniform(0, 160), random.uniform(0, 90), random.uniform(0, 160),
                                      random.uniform(0, 90)));
            } else if (frame % 3 == 1) {
                const glm::dvec3 c(random.uniform(-15, 15), random.uniform(-4, 4), random.uniform(-15, 15));
                const glm::dvec3 window[4] = {c, c + glm::dvec3(4, 0, 0), c + glm::dvec3(4, 3, 2),
                                              c + glm::dvec3(0, 3, 2)};
                ASSERT_TRUE(addWindow(view, volumeOfWindow(eyePosition(view), window, true)));
            } else {  // any volume, which rays enter from outside
                for (int i = 0; i < 4; ++i) view.window.add(randomPlane(random));
            }
            const VisibleSet set = query.visible(now, view, settings);
            beside += set.stats.stages[kFrustumStage].culled;
            occluded += set.stats.stages[kOcclusionStage].culled;
            const std::vector<uint8_t> kept = keptOf(set, made.transforms.size());
            std::vector<uint8_t> reasons(made.transforms.size()), all(made.transforms.size(), 1), drawn = all;
            query.reasons(reasons);
            for (size_t i = 0; i < drawn.size(); ++i) drawn[i] = reasons[i] != 1 + kFrustumStage;
            // Whether what lies beside the window is drawn or not.
            for (const std::vector<uint8_t>& of : {all, drawn}) {
                const std::vector<uint8_t> seen = seenInWindow(made, view, of, 3);
                for (size_t i = 0; i < kept.size(); ++i)
                    ASSERT_TRUE(kept[i] || !seen[i]) << "seed " << seed << " frame " << frame << " object " << i;
            }
        }
    }
    EXPECT_GT(beside, 10000u);
    EXPECT_GT(occluded, 300u);
}

TEST(Windows, DoNotCut) {
    // A wall that reaches into the window hides what stands in it.
    MadeWorld made;
    made.add({-10, -10, -10}, {10, 10, -9});
    made.add({-1, -1, -20}, {1, 1, -19});
    made.add({5, -1, -8}, {6, 1, -7});
    const Snapshot now = made.world.commit();
    View view = viewFrom({0, 0, 0}, {0, 0, -1});
    ASSERT_TRUE(addWindow(view, 60, 30, 100, 60));
    Query query;
    EXPECT_EQ(keysOf(query.visible(now, view)), std::vector<uint64_t>{0});
    view.window = {};
    view.sections.add({0, 1, 0, 5});  // the wall is one cluster, and cut
    EXPECT_EQ(query.visible(now, view).objects.size(), 3u);
}

}  // namespace
}  // namespace sightline::test
