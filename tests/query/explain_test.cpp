// Explanations are true: objects moved, occluders removed and specks added change the answer as was said.
// SPDX-License-Identifier: MIT
#include "sightline/query/explain/explain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/explain_laws.h"
#include "tests/support/made_world.h"
#include "tests/support/random.h"

namespace sightline::test {
namespace {

/// A view of one of several kinds.
View randomView(Random& random, int kind) {
    View view = test::randomView(random, {.width = 320, .height = 180});
    const double far = kind % 2 ? 25.0 : std::numeric_limits<double>::infinity();
    view.projection = perspective(glm::radians(random.uniform(20, 100)), 16.0 / 9.0, 0.1, far);
    if (kind % 3 == 1) view.projection = orthographic(random.uniform(4, 20), 16.0 / 9.0, 0.1, far);
    if (kind % 3 == 2) {
        view.projection[2][0] = random.uniform(-0.7, 0.7);
        view.projection[2][1] = random.uniform(-0.5, 0.5);
    }
    if (kind % 7 == 4) view.jitter = 3;
    return view;
}

QuerySettings settingsOf(int kind) {
    QuerySettings settings;
    if (kind % 5 == 3) settings.occlusion_size = 128;
    return settings;
}

/// Rooms: walls in both directions with gaps between them, and clutter in each room.
void fillRooms(MadeWorld& made, uint64_t seed) {
    Random random(seed);
    for (int x = -4; x <= 4; ++x)
        for (int z = -4; z <= 4; ++z) {
            const glm::dvec3 corner(5.0 * x, -3, 5.0 * z);
            const double door = random.below(3) ? 0.0 : random.uniform(0.2, 1.0);
            made.add(corner, corner + glm::dvec3(5.05 - door, 6, 0.2));
            if (random.below(4)) made.add(corner, corner + glm::dvec3(0.2, 6, 5.05 - door));
            for (int i = 0; i < 4; ++i) {
                glm::dmat4 t(1.0);
                for (int axis = 0; axis < 3; ++axis) t[axis][axis] = random.uniform(0.1, 0.8);
                if (i == 1) t[0] = -t[0];
                if (i == 2) t[1][0] = random.uniform(-0.5, 0.5);
                t[3] = glm::dvec4(
                    corner + glm::dvec3(random.uniform(0.5, 4), random.uniform(0, 3), random.uniform(1, 4)), 1);
                made.add(t, i != 3, 1 + static_cast<uint32_t>(random.below(2)));
            }
        }
    made.add({-25, -3.2, -25}, {25, -3, 25});
}

TEST(Explain, IsTrueInRandomWorlds) {
    LawCount sum;
    const uint64_t worlds = rounds(32, 8);
    for (uint64_t seed = 1; seed <= worlds; ++seed) {
        MadeWorld made;
        made.fill(seed, seed % 2 ? 300 : 60, seed % 6 == 5 ? glm::dvec3(0, 40, 0) : glm::dvec3(0));
        const Snapshot now = made.world.commit();
        Random random(seed);
        for (int frame = 0; frame < 4; ++frame) {
            const int kind = static_cast<int>(seed) * 4 + frame;
            Laws laws(now, randomView(random, kind), settingsOf(kind),
                      "seed " + std::to_string(seed) + " frame " + std::to_string(frame));
            laws.expectTrueOfSome(random, 10);
            sum.add(laws.count);
            if (HasFailure()) return;
        }
    }
    EXPECT_GT(sum.planes, 31 * worlds);
    EXPECT_GT(sum.occluded, 7 * worlds);
    EXPECT_GT(sum.open_pixels, 12 * worlds);
    EXPECT_GT(2 * sum.doubts, worlds);
    sum.record();
}

TEST(Explain, IsTrueAmongWalls) {
    LawCount sum;
    const uint64_t worlds = rounds(20, 4);
    for (uint64_t seed = 1; seed <= worlds; ++seed) {
        MadeWorld made;
        fillRooms(made, seed);
        for (int i = 0; i < 20; ++i) EXPECT_TRUE(made.world.remove(made.ids[static_cast<size_t>(i) * 9]));
        const Snapshot now = made.world.commit();
        Random random(seed);
        for (int frame = 0; frame < 5; ++frame) {
            const int kind = static_cast<int>(seed) * 5 + frame;
            View view = randomView(random, kind);
            QuerySettings settings = settingsOf(kind);
            if (frame == 1) view.layers = 1;
            if (frame == 2) settings.occluder_triangles = 200;
            if (frame == 3) settings.stages = stageBit(Stage::kOcclusion);
            Laws laws(now, view, settings, "seed " + std::to_string(seed) + " frame " + std::to_string(frame));
            laws.expectTrueOfSome(random, 10);
            sum.add(laws.count);
            if (HasFailure()) return;
        }
    }
    EXPECT_GT(sum.occluded, 35 * worlds);
    EXPECT_GT(sum.hiders, sum.occluded + 2 * worlds) << "some need more than one";
    EXPECT_GT(sum.hidden_again, 10 * worlds);
    sum.record();
}

TEST(Explain, IsTrueOfBoxesThatAlmostTouchAPlane) {
    LawCount sum;
    for (uint64_t seed = 1; seed <= 24; ++seed) {
        Random random(seed);
        const View view = randomView(random, static_cast<int>(seed));
        const QuerySettings settings = settingsOf(static_cast<int>(seed));
        const Frustum frustum = makeFrustum(view);
        MadeWorld made;
        for (int i = 0; i < 60; ++i) {
            const glm::dvec4& plane = frustum.planes[random.below(4)];
            glm::dvec3 low =
                frustum.eye + glm::dvec3(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
            const glm::dvec3 size(std::pow(10.0, random.uniform(-4, 0.5)));
            double inside = plane.w;
            for (int axis = 0; axis < 3; ++axis)
                inside += plane[axis] * (low[axis] - frustum.eye[axis]) + std::max(0.0, plane[axis] * size[axis]);
            low -= glm::dvec3(plane) * (inside + std::pow(10.0, random.uniform(-9, -4)));
            made.add(low, low + size);
        }
        const Snapshot now = made.world.commit();
        Laws laws(now, view, settings, "seed " + std::to_string(seed));
        for (uint32_t item = 0; item < now.objectCount(); ++item) laws.expectTrue(item);
        sum.add(laws.count);
        if (HasFailure()) return;
    }
    EXPECT_GT(sum.planes, 100u);
    EXPECT_GT(sum.by_rectangle, 0u);
    sum.record();
}

TEST(Explain, SaysOfEveryObjectWhatTheQuerySays) {
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        MadeWorld made(seed, 150);
        ObjectDef odd;
        odd.bounds = {glm::dvec3(0.0), glm::dvec3(std::numeric_limits<double>::quiet_NaN())};
        made.world.add(odd);
        const Snapshot now = made.world.commit();
        Random random(seed);
        for (int kind = 0; kind < 12; ++kind) {
            View view = randomView(random, kind);
            QuerySettings settings = settingsOf(kind);
            settings.stages = 0;
            const Stage conservative[] = {Stage::kFrustum, Stage::kVolumes, Stage::kOcclusion};
            for (int i = 0; i < 3; ++i)
                if (kind >> i & 1) settings.stages |= stageBit(conservative[i]);
            if (kind == 7) view.layers = 2;
            if (kind == 11) view.projection[1][1] = 0;
            Laws laws(now, view, settings, "seed " + std::to_string(seed) + " kind " + std::to_string(kind));
            for (uint32_t item = 0; item < now.objectCount(); ++item) laws.expectVerdict(item);
        }
    }
}

View plainView() {
    View view = viewFrom({0, 0, 0}, {0, 0, -1}, {.width = 320, .height = 180});
    view.projection = perspective(glm::radians(60.0), 16.0 / 9.0, 0.1, 1000);
    return view;
}

TEST(Explain, NamesEachPlane) {
    const glm::dvec3 places[6] = {{-100, 0, -20}, {100, 0, -20}, {0, -100, -20},
                                  {0, 100, -20},  {0, 0, 50},    {0, 0, -1050}};
    MadeWorld made;
    std::vector<ObjectId> ids;
    for (const glm::dvec3& place : places) ids.push_back(made.add(place - glm::dvec3(1), place + glm::dvec3(1)));
    const Snapshot now = made.world.commit();
    Query query;
    for (uint32_t plane = 0; plane < 6; ++plane) {
        const Explanation why = query.explain(now, plainView(), ids[plane]);
        ASSERT_EQ(why.verdict, Verdict::kOutsideFrustum);
        EXPECT_EQ(why.frustum.plane, plane) << kPlaneNames[plane];
        EXPECT_EQ(why.key, plane);
    }
    EXPECT_NEAR(query.explain(now, plainView(), ids[4]).frustum.distance(), 49.1, 1e-9);
    EXPECT_NEAR(query.explain(now, plainView(), ids[5]).frustum.distance(), 49, 1e-9);
}

TEST(Explain, NamesTwoWallsAndWhatStandsBehindThem) {
    MadeWorld made;
    const ObjectId left = made.add({-60, -60, -10}, {0.05, 60, -9}), right = made.add({0, -60, -10}, {60, 60, -9});
    const ObjectId spare = made.add({-200, -200, -30}, {200, 200, -29});
    const ObjectId hidden = made.add({-3, -1, -50}, {1, 1, -49});
    made.add({20, 20, -8}, {21, 21, -7.5});
    const Snapshot now = made.world.commit();
    Query query;
    const Explanation why = query.explain(now, plainView(), hidden);
    ASSERT_EQ(why.verdict, Verdict::kOccluded);
    ASSERT_EQ(why.occlusion.hiders.size(), 2u);
    EXPECT_TRUE(why.occlusion.sufficient);
    EXPECT_EQ(why.occlusion.hiders[0].id, left);
    EXPECT_EQ(why.occlusion.hiders[1].id, right);
    EXPECT_NEAR(why.occlusion.hiders[0].share, 0.75, 0.06);
    EXPECT_EQ(why.occlusion.without, Without::kOccluded);
    ASSERT_EQ(why.occlusion.others.size(), 1u);
    EXPECT_EQ(why.occlusion.others[0].id, spare);
    EXPECT_NEAR(why.depth, 49, 1e-3);
    EXPECT_LT(why.rect.left, why.rect.right);
    made.world.remove(spare);
    EXPECT_EQ(query.explain(made.world.commit(), plainView(), hidden).occlusion.without, Without::kVisible);
}

TEST(Explain, NamesEachDoubt) {
    MadeWorld made;
    const ObjectId around = made.add({-1, -1, -1}, {1, 1, 1}), across = made.add({2, -1, -3}, {2.5, 1, 3});
    const ObjectId wall = made.add({-50, -50, -10}, {50, 50, -9}), behind = made.add({-1, -1, -20}, {1, 1, -19});
    ObjectDef empty;
    const ObjectId odd = made.world.add(empty);
    const Snapshot now = made.world.commit();
    Query query;
    View view = plainView();
    QuerySettings settings;
    const auto because = [&](ObjectId id) {
        const Explanation why = query.explain(now, view, id, settings);
        EXPECT_EQ(why.verdict, Verdict::kVisible);
        return why.visible.because;
    };
    view.projection = perspective(glm::radians(120.0), 16.0 / 9.0, 0.1, 1000);
    EXPECT_EQ(because(around), KeptBecause::kHoldsEye);
    EXPECT_EQ(because(across), KeptBecause::kNearPlane);
    EXPECT_EQ(because(odd), KeptBecause::kBoundsNotUsable);
    EXPECT_EQ(because(wall), KeptBecause::kOpenPixel);
    EXPECT_EQ(query.explain(now, view, behind, settings).verdict, Verdict::kOccluded);
    settings.occluder_triangles = 1;
    EXPECT_EQ(because(behind), KeptBecause::kBudgetSpent);
    settings.occluder_triangles = QuerySettings().occluder_triangles;
    settings.stages = stageBit(Stage::kFrustum);
    EXPECT_EQ(because(behind), KeptBecause::kStageOff);
    EXPECT_EQ(query.explain(now, view, behind, settings).visible.stage, Stage::kOcclusion);
    settings.stages = 0;
    const ObjectId aside = made.add({500, 0, -2}, {501, 1, -1});
    const Explanation why = query.explain(made.world.commit(), view, aside, settings);
    EXPECT_EQ(why.visible.because, KeptBecause::kStageOff);
    EXPECT_EQ(why.visible.stage, Stage::kFrustum);
    view.width = 0;
    EXPECT_EQ(because(behind), KeptBecause::kViewNotUsable);
}

TEST(Explain, KnowsWhatIsNotThere) {
    MadeWorld made;
    const ObjectId wall = made.add({-5, -5, -10}, {5, 5, -9}, true, 2);
    Query query;
    View view = plainView();
    EXPECT_EQ(query.explain(Snapshot(), view, wall).verdict, Verdict::kNoSuchObject);
    const Snapshot now = made.world.commit();
    EXPECT_EQ(query.explain(now, view, ObjectId()).verdict, Verdict::kNoSuchObject);
    EXPECT_EQ(query.explain(now, view, {wall.index, wall.generation + 1}).verdict, Verdict::kNoSuchObject);
    EXPECT_EQ(query.explain(now, view, {wall.index + 7, 1}).verdict, Verdict::kNoSuchObject);
    view.layers = 1;
    EXPECT_EQ(query.explain(now, view, wall).verdict, Verdict::kOutsideLayers);
    EXPECT_TRUE(made.world.remove(wall));
    EXPECT_EQ(query.explain(made.world.commit(), view, wall).verdict, Verdict::kNoSuchObject);
}

TEST(Explain, LeavesTheLastAnswerAsItIs) {
    MadeWorld made(4, 200);
    const Snapshot now = made.world.commit();
    Query query;
    const std::vector<uint64_t> before = keysOf(query.visible(now, plainView()));
    const std::vector<uint8_t> reasons = reasonsOf(query, now);
    for (const ObjectId id : made.ids) query.explain(now, plainView(), id);
    EXPECT_EQ(reasons, reasonsOf(query, now));
    EXPECT_EQ(query.changes().appeared.size(), before.size());
}

}  // namespace
}  // namespace sightline::test
