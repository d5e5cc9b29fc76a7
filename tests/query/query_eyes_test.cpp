// Queries for two eyes: each eye's answer is that of its view alone, and sound.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/support/made_world.h"

namespace sightline::test {
namespace {

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
        MadeWorld made(seed, 400);
        const Snapshot now = made.world.commit();
        Query query;
        Random random(seed);
        for (int frame = 0; frame < 5; ++frame) {
            const glm::dvec3 eye(random.uniform(-20, 20), random.uniform(-4, 4), random.uniform(-20, 20));
            const View center = viewAt(eye, {random.uniform(-9, 9), 0, random.uniform(-9, 9)}, {70});
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
    MadeWorld made(3, 400);
    const Snapshot now = made.world.commit();
    Query query;
    std::set<Key> before;
    for (int frame = 0; frame < 8; ++frame) {
        const View center = viewAt({-12 + frame, 1, 9}, {0, 0, -2 * frame}, {70});
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

}  // namespace
}  // namespace sightline::test
