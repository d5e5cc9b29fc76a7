// The refinement of the query's frustum stage: culls boxes beyond an edge of the view, and never what reaches into it.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "sightline/cull/bounds.h"
#include "sightline/run/explain.h"
#include "tests/run/made_world.h"
#include "tests/support_targets.h"

namespace sightline::test {
namespace {

constexpr Refinement kAll[] = {Refinement::kNone, Refinement::kCorners, Refinement::kSeparatingAxes};

View viewFrom(const glm::dvec3& eye, const glm::dvec3& direction, double degrees = 60) {
    View view;
    view.width = 160;
    view.height = 90;
    view.view = lookAt(eye, eye + direction, {0, 1, 0});
    view.projection = perspective(glm::radians(degrees), 16.0 / 9.0, 0.1);
    return view;
}

std::vector<uint8_t> keptOf(const VisibleSet& set, size_t count) {
    std::vector<uint8_t> kept(count, 0);
    for (const Visible& v : set.objects) kept[v.key] = 1;
    return kept;
}

/// Boxes along the axes, some as large as the view.
MadeWorld largeBoxes(uint64_t seed) {
    MadeWorld made;
    Random random(seed);
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 at(random.uniform(-40, 40), random.uniform(-40, 40), random.uniform(-40, 40));
        const double size = i % 3 ? 2.0 : 25.0;
        made.add(at, at + glm::dvec3(random.uniform(0.1, size), random.uniform(0.1, size), random.uniform(0.1, size)),
                 i % 4 == 0);
    }
    return made;
}

TEST(QueryRefinement, CullsMoreAndNeverWhatTouchesTheView) {
    uint64_t culled[3] = {}, wrong_of_planes = 0;
    for (uint64_t seed = 1; seed <= 12; ++seed) {
        MadeWorld made = largeBoxes(seed);
        const Snapshot now = made.world.commit();
        Random random(seed);
        for (int frame = 0; frame < 8; ++frame) {
            View view =
                viewFrom({random.uniform(-30, 30), random.uniform(-30, 30), random.uniform(-30, 30)},
                         {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}, random.uniform(10, 90));
            if (frame % 4 == 1) view.projection = orthographic(20, 16.0 / 9.0, 0.1, 40);
            if (frame % 4 == 2) view.sections.add({random.uniform(-1, 1), 1, 0, random.uniform(-20, 20)});
            view.stages = stageBit(Stage::kFrustum);
            ViewVolume volume = volumeOf(makeFrustum(view));
            for (const glm::dvec4& plane : view.sections.all()) ASSERT_TRUE(addPlane(volume, plane));
            const RefinedVolume exact = refineVolume(volume);
            std::vector<uint8_t> before;
            for (int how = 0; how < 3; ++how) {
                view.refinement = kAll[how];
                std::vector<uint8_t> first;
                forEachTarget([&](const std::string& target) {
                    Query query;
                    const std::vector<uint8_t> kept = keptOf(query.visible(now, view), made.transforms.size());
                    if (first.empty()) first = kept;
                    EXPECT_EQ(kept, first) << target;
                });
                for (size_t i = 0; i < first.size(); ++i) {
                    const glm::dmat4& t = made.transforms[i];
                    const Box3d box{glm::dvec3(t[3]), glm::dvec3(t[3]) + glm::dvec3(t[0][0], t[1][1], t[2][2])};
                    const bool touches = !testBound(volume, box).outside && !separated(exact, box, kAll[2]);
                    ASSERT_TRUE(first[i] || !touches)
                        << "seed " << seed << " frame " << frame << " how " << how << " box " << i;
                    if (!before.empty()) { ASSERT_LE(first[i], before[i]); }
                    culled[how] += !first[i];
                    wrong_of_planes += how == 0 && first[i] && !touches;
                }
                before = first;
            }
        }
    }
    EXPECT_GT(wrong_of_planes, 60u);
    EXPECT_GT(culled[1], culled[0] + wrong_of_planes / 2);
    // Rounding in float keeps a few.
    EXPECT_GE(culled[2], culled[0] + wrong_of_planes * 99 / 100);
}

TEST(QueryRefinement, KeepsWhatIsSeenWithEveryStage) {
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        MadeWorld made = largeBoxes(seed);
        const Snapshot now = made.world.commit();
        Query query;
        Random random(seed);
        for (int frame = 0; frame < 12; ++frame) {
            View view = viewFrom({random.uniform(-30, 30), random.uniform(-30, 30), random.uniform(-30, 30)},
                                 {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
            view.refinement = kAll[1 + frame % 2];
            view.bins = frame % 3 == 0 ? 4 : 1;
            view.stages = frame % 2 ? kAllStages : kDefaultStages;
            if (frame % 4 == 0) view.sections.add({random.uniform(-1, 1), 0, 1, random.uniform(-20, 20)});
            const std::vector<uint8_t> kept = keptOf(query.visible(now, view), made.transforms.size());
            const std::vector<uint8_t> seen = made.seen(view, 2);
            for (size_t i = 0; i < kept.size(); ++i)
                ASSERT_TRUE(kept[i] || !seen[i]) << "seed " << seed << " frame " << frame << " object " << i;
        }
    }
}

TEST(QueryRefinement, ExplainSaysThatNoPlaneAloneDecided) {
    MadeWorld made;
    // Across the right plane and the far plane, and beyond where they meet, at x = 20.5.
    const ObjectId large = made.add({21, -1, -60}, {60, 1, -17});
    made.add({-1, -1, -15}, {1, 1, -14});
    View view = viewFrom({0, 0, 0}, {0, 0, -1}, 60);
    view.projection = perspective(glm::radians(60.0), 16.0 / 9.0, 0.1, 20.0);
    view.faces = view.second_look = false;
    const Snapshot now = made.world.commit();
    EXPECT_EQ(Explainer(now, view).explain(large).verdict, Verdict::kVisible);
    view.refinement = Refinement::kSeparatingAxes;
    const Explanation why = Explainer(now, view).explain(large);
    EXPECT_EQ(why.verdict, Verdict::kOutsideFrustum);
    EXPECT_TRUE(why.frustum.by_refinement);
    EXPECT_TRUE(why.frustum.outside_any);
    EXPECT_LE(why.frustum.distance(), 0.0);
}

}  // namespace
}  // namespace sightline::test
