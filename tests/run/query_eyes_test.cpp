// Queries for two eyes, and queries that draw first what was visible last: sound, and the same for the same calls.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/run/made_world.h"

namespace sightline::test {
namespace {

View viewFrom(const glm::dvec3& eye, const glm::dvec3& target) {
    View view;
    view.width = 160;
    view.height = 90;
    view.view = lookAt(eye, target, {0, 1, 0});
    view.projection = perspective(glm::radians(70.0), 16.0 / 9.0, 0.1);
    return view;
}

/// The view from so far to the right.
View shifted(View view, double by) {
    view.view[3].x -= by;
    return view;
}

using Key = std::pair<uint64_t, uint32_t>;  // key and id

std::vector<Key> namesOf(std::span<const Visible> objects) {
    std::vector<Key> names;
    for (const Visible& v : objects) names.emplace_back(v.key, v.id.index);
    return names;
}

std::vector<Key> namesOf(const StereoSet& set, uint8_t eye) {
    std::vector<Key> names;
    for (size_t i = 0; i < set.objects.size(); ++i)
        if (set.eyes[i] & eye) names.emplace_back(set.objects[i].key, set.objects[i].id.index);
    return names;
}

void expectBothEyes(const MadeWorld& made, Query& query, const Snapshot& now, const View& left, const View& right) {
    Query one, other;
    const VisibleSet by_left = one.visible(now, left), by_right = other.visible(now, right);
    const StereoSet set = query.visibleStereo(now, left, right);
    ASSERT_EQ(set.objects.size(), set.eyes.size());
    EXPECT_EQ(namesOf(set, kLeftEye), namesOf(by_left.objects));
    std::vector<Key> right_here = namesOf(set, kRightEye), right_alone = namesOf(by_right.objects);
    std::sort(right_here.begin(), right_here.end());
    std::sort(right_alone.begin(), right_alone.end());
    EXPECT_EQ(right_here, right_alone);
    const std::vector<Key> all = namesOf(set.objects);
    EXPECT_EQ(std::set<Key>(all.begin(), all.end()).size(), all.size()) << "an object is there twice";
    EXPECT_EQ(set.left.occluder_triangles, by_left.stats.occluder_triangles);
    EXPECT_EQ(set.right.visible, by_right.stats.visible);

    std::vector<uint8_t> both(now.objectCount()), a = both, b = both, alone = both;
    query.reasons(both);
    query.reasons(a, kLeftEye);
    query.reasons(b, kRightEye);
    one.reasons(alone);
    EXPECT_EQ(a, alone);
    other.reasons(alone);
    EXPECT_EQ(b, alone);
    const std::vector<uint8_t> seen_left = made.seen(left, 2), seen_right = made.seen(right, 2);
    for (size_t i = 0; i < both.size(); ++i) {
        EXPECT_EQ(both[i] == 0, a[i] == 0 || b[i] == 0);
        EXPECT_TRUE(both[i] == 0 || both[i] == std::max(a[i], b[i]));
        EXPECT_FALSE(seen_left[i] && a[i]) << "object " << i;
        EXPECT_FALSE(seen_right[i] && b[i]) << "object " << i;
    }
}

TEST(Stereo, IsWhatEachEyeSeesBitForBit) {
    size_t one_eye = 0;
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        MadeWorld made;
        made.fill(seed, 400, {0, 0, 0});
        const Snapshot now = made.world.commit();
        Query query;
        Random random(seed);
        for (int frame = 0; frame < 5; ++frame) {
            const glm::dvec3 eye(random.uniform(-20, 20), random.uniform(-4, 4), random.uniform(-20, 20));
            const View center = viewFrom(eye, {random.uniform(-9, 9), 0, random.uniform(-9, 9)});
            const double half = frame < 3 ? 0.032 : random.uniform(0.5, 3);
            expectBothEyes(made, query, now, shifted(center, -half), shifted(center, half));
            const StereoSet set = query.visibleStereo(now, shifted(center, -half), shifted(center, half));
            one_eye += static_cast<size_t>(
                std::count_if(set.eyes.begin(), set.eyes.end(), [](uint8_t eyes) { return eyes != 3; }));
        }
    }
    EXPECT_GT(one_eye, 50u);
}

TEST(Stereo, ChangesAreThoseOfBothEyes) {
    MadeWorld made;
    made.fill(3, 400, {0, 0, 0});
    const Snapshot now = made.world.commit();
    Query query;
    std::set<Key> before;
    for (int frame = 0; frame < 8; ++frame) {
        const View center = viewFrom({-12 + frame, 1, 9}, {0, 0, -2 * frame});
        std::vector<Key> names;
        if (frame % 3 == 2) names = namesOf(query.visible(now, center).objects);
        else names = namesOf(query.visibleStereo(now, shifted(center, -0.5), shifted(center, 0.5)).objects);
        const VisibleChanges changes = query.changes();
        for (const Key& name : namesOf(changes.disappeared)) EXPECT_EQ(before.erase(name), 1u);
        for (const Key& name : namesOf(changes.appeared)) EXPECT_TRUE(before.insert(name).second);
        EXPECT_EQ(before, std::set<Key>(names.begin(), names.end())) << frame;
    }
}

TEST(Stereo, OfNothingIsNothing) {
    Query query;
    const StereoSet set = query.visibleStereo(Snapshot(), View(), View());
    EXPECT_TRUE(set.objects.empty() && set.eyes.empty());
}

TEST(LastVisibleFirst, StaysSoundWhileAllChanges) {
    uint64_t culled = 0, culled_without = 0;
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        MadeWorld made;
        made.fill(seed, 400, {0, 0, 0});
        Random random(seed);
        Query query, twin, without;
        for (int frame = 0; frame < 12; ++frame) {
            // Objects come and go in some frames, so that the hierarchy is built anew; in all frames some move.
            if (frame % 4 == 3) made.fill(seed * 100 + static_cast<uint64_t>(frame), 20, {0, 0, 0});
            for (int i = 0; i < 10; ++i) {
                const size_t object = random.below(made.ids.size());
                made.transforms[object][3] += glm::dvec4(random.uniform(-1, 1), 0, random.uniform(-1, 1), 0);
                made.world.move(made.ids[object], made.transforms[object]);
            }
            const Snapshot now = made.world.commit();
            const bool leap = frame % 5 == 4;  // now and then the camera leaps: the memory is of no use, and no harm
            const double angle = leap ? random.uniform(0, 6) : 0.1 * frame;
            View view = viewFrom({8 * std::cos(angle), 1, 8 * std::sin(angle)}, {0, 0, 0});
            without.visible(now, view);
            view.last_visible_first = true;
            const VisibleSet set = query.visible(now, view);
            EXPECT_EQ(namesOf(twin.visible(now, view).objects), namesOf(set.objects));
            std::vector<uint8_t> reasons(now.objectCount()), plain = reasons;
            query.reasons(reasons);
            without.reasons(plain);
            const std::vector<uint8_t> seen = made.seen(view, 2);
            for (size_t i = 0; i < reasons.size(); ++i) {
                EXPECT_FALSE(seen[i] && reasons[i]) << "seed " << seed << " frame " << frame << " object " << i;
                culled += reasons[i] != 0;
                culled_without += plain[i] != 0;
            }
            uint64_t sum = set.stats.visible;
            for (const StageStats& stage : set.stats.stages) sum += stage.culled;
            EXPECT_EQ(sum, set.stats.objects);
        }
    }
    EXPECT_GT(culled * 100, culled_without * 97);
}

TEST(LastVisibleFirst, AFirstAnswerIsThatOfAnyQuery) {
    MadeWorld made;
    made.fill(5, 300, {0, 0, 0});
    const Snapshot now = made.world.commit();
    View view = viewFrom({9, 1, 3}, {0, 0, 0});
    Query plain, eager;
    const std::vector<Key> names = namesOf(plain.visible(now, view).objects);
    view.last_visible_first = true;
    EXPECT_EQ(namesOf(eager.visible(now, view).objects), names);
    // What was removed is not drawn any more, nor is what the next view's layers leave out.
    eager.visible(now, view);
    for (const ObjectId id : made.ids) made.world.remove(id);
    EXPECT_TRUE(eager.visible(made.world.commit(), view).objects.empty());
    EXPECT_TRUE(eager.visible(Snapshot(), view).objects.empty());
    EXPECT_EQ(namesOf(eager.visible(now, view).objects), names);
    view.layers = 2;
    EXPECT_EQ(eager.visible(now, view).stats.occluder_triangles, 0u);
}

}  // namespace
}  // namespace sightline::test
