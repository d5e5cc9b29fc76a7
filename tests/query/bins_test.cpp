// A view in bins: the same answer whoever walks them and in whatever order, sound, and as tight as in one piece.
// SPDX-License-Identifier: MIT
#include "sightline/query/answer.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/thread_pool.h"
#include "sightline/query/explain/explain.h"
#include "tests/support/made_world.h"
#include "tests/support/memory.h"

namespace sightline::test {
namespace {

/// Does its tasks here, in an order of its own.
class Scrambled final : public Jobs {
public:
    explicit Scrambled(uint64_t seed) : random_(seed) {}
    void run(uint32_t count, Task task, void* context) override {
        std::vector<uint32_t> order(count);
        std::iota(order.begin(), order.end(), 0u);
        for (uint32_t i = count; i > 1; --i) std::swap(order[i - 1], order[random_.below(i)]);
        for (const uint32_t i : order) task(context, i);
    }

private:
    Random random_;
};

/// A view into the middle of a made world.
View randomView(Random& random) {
    const glm::dvec3 eye(random.uniform(-20, 20), random.uniform(-4, 4), random.uniform(-20, 20));
    return viewAt(eye, {random.uniform(-9, 9), 0, random.uniform(-9, 9)}, {70, 320, 180});
}

QuerySettings inBins(uint32_t bins) { return {.bins = bins}; }

/// All that a query tells of its last answer, but the time.
struct Told {
    std::vector<std::pair<uint64_t, uint32_t>> objects;
    std::vector<uint8_t> reasons, covered;
    std::vector<float> depths;
    std::vector<uint64_t> counts;

    Told(Query& query, const Snapshot& now, const View& view, const QuerySettings& settings) {
        const VisibleSet set = query.visible(now, view, settings);
        for (const Visible& v : set.objects) objects.emplace_back(v.key, v.id.index);
        reasons = reasonsOf(query, now);
        const Query::DepthImage image = query.depthImage();
        depths.assign(image.nearness.begin(), image.nearness.end());
        covered.assign(image.covered.begin(), image.covered.end());
        const QueryStats& s = set.stats;
        for (const StageStats& stage : s.stages) counts.insert(counts.end(), {stage.tested, stage.culled, stage.doubt});
        counts.insert(counts.end(), {s.objects, s.visible, s.nodes_visited, s.occluder_triangles, s.seam_pixels,
                                     s.faces_tested, s.faces_culled, s.second_looks, s.second_look_culled,
                                     s.second_look_polygons, uint64_t{s.budget_spent}, uint64_t{s.second_look_spent}});
    }
    bool operator==(const Told&) const = default;
};

MadeWorld madeWorld(uint64_t seed) {
    MadeWorld made;
    made.shapes = seed % 2 == 0;
    made.fill(seed, 400, {0, 0, 0});
    return made;
}

TEST(Bins, GiveTheSameAnswerForAnyWorkersInAnyOrder) {
    ThreadPool two(2), three(3), eight(8);
    Scrambled scrambled(5);
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        MadeWorld made = madeWorld(seed);
        const Snapshot now = made.world.commit();
        Query alone;
        Query shared[] = {Query(defaultMemory(), &two), Query(defaultMemory(), &three), Query(defaultMemory(), &eight),
                          Query(defaultMemory(), &scrambled)};
        Random random(seed);
        for (int frame = 0; frame < 8; ++frame) {
            const View view = randomView(random);
            QuerySettings settings = inBins(2 + static_cast<uint32_t>(frame));
            if (frame == 5) settings.stages = kAllStages;
            if (frame == 6) settings.occluder_triangles = 60;
            const Told expected(alone, now, view, settings);
            for (Query& query : shared)
                EXPECT_EQ(Told(query, now, view, settings), expected) << "seed " << seed << ", frame " << frame;
        }
    }
}

TEST(Bins, AreSoundAndAsTightAsTheWhole) {
    size_t whole_kept = 0, kept = 0, other = 0;
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        MadeWorld made = madeWorld(seed);
        const Snapshot now = made.world.commit();
        Query query, whole;
        Random random(100 + seed);
        for (int frame = 0; frame < 6; ++frame) {
            const View view = randomView(random);
            const VisibleSet set = query.visible(now, view, inBins(static_cast<uint32_t>(2 + frame)));
            whole_kept += whole.visible(now, view).objects.size();
            const std::vector<uint8_t> reasons = reasonsOf(query, now), whole_reasons = reasonsOf(whole, now);
            kept += set.objects.size();
            const std::vector<uint8_t> seen = made.seen(view, 2);
            for (size_t i = 0; i < seen.size(); ++i) {
                EXPECT_FALSE(seen[i] && reasons[i]) << "object " << i << ", seed " << seed << ", frame " << frame;
                other += (reasons[i] == 0) != (whole_reasons[i] == 0);
            }
            std::set<uint32_t> once;
            for (const Visible& v : set.objects)
                EXPECT_TRUE(once.insert(v.id.index).second) << "an object is there twice";
        }
    }
    EXPECT_LE(kept, whole_kept + whole_kept / 100);
    EXPECT_LE(other, whole_kept / 50);
}

TEST(Bins, CountEveryObjectOnce) {
    for (uint64_t seed = 1; seed <= 3; ++seed) {
        MadeWorld made = madeWorld(seed);
        made.add({-3, -3, -3}, {3, 3, 3}, false, 2);  // in another layer
        const Snapshot now = made.world.commit();
        Query query;
        Random random(seed);
        for (uint32_t bins = 1; bins <= 16; bins += 3) {
            View view = randomView(random);
            QuerySettings settings = inBins(bins);
            if (bins % 2) settings.stages = kAllStages;
            view.layers = 1;
            const QueryStats stats = query.visible(now, view, settings).stats;
            uint64_t by[1 + kStageCount] = {};
            for (const uint8_t reason : reasonsOf(query, now))
                if (reason != 255) ++by[reason];
            EXPECT_EQ(stats.objects, now.objectCount() - 1);
            EXPECT_EQ(stats.visible, by[0]);
            EXPECT_EQ(accountedFor(stats), stats.objects);
        }
    }
}

TEST(Bins, ShareBothEyes) {
    MadeWorld made = madeWorld(2);
    const Snapshot now = made.world.commit();
    ThreadPool pool(3);
    Query alone, shared(defaultMemory(), &pool);
    Random random(9);
    for (uint32_t bins = 1; bins <= 4; ++bins) {
        const View view = randomView(random);
        const QuerySettings settings = inBins(bins);
        const View left = shiftedEye(view, -0.05), right = shiftedEye(view, 0.05);
        const StereoSet expected = alone.visibleStereo(now, left, right, settings),
                        set = shared.visibleStereo(now, left, right, settings);
        ASSERT_EQ(set.objects.size(), expected.objects.size());
        for (size_t i = 0; i < set.objects.size(); ++i) {
            EXPECT_EQ(set.objects[i].id, expected.objects[i].id);
            EXPECT_EQ(set.eyes[i], expected.eyes[i]);
        }
        EXPECT_EQ(set.left.occluder_triangles, expected.left.occluder_triangles);
        EXPECT_EQ(set.right.visible, expected.right.visible);
    }
}

TEST(Bins, AreExplainedAsTheyAnswer) {
    for (uint64_t seed = 1; seed <= 2; ++seed) {
        MadeWorld made = madeWorld(seed);
        const Snapshot now = made.world.commit();
        Random random(seed);
        const View view = randomView(random);
        const QuerySettings settings = inBins(3);
        Query query;
        query.visible(now, view, settings);
        const std::vector<uint8_t> reasons = reasonsOf(query, now);
        Explainer explainer(now, view, settings);
        for (size_t i = 0; i < reasons.size(); ++i) {
            const Explanation why = explainer.explain(made.ids[i], {.hiders = false, .without = false});
            EXPECT_EQ(why.verdict == Verdict::kVisible, reasons[i] == 0) << "object " << i << ", seed " << seed;
            if (why.verdict == Verdict::kVisible && why.visible.because == KeptBecause::kOpenPixel) {
                EXPECT_GT(why.visible.open_pixels, 0u) << "object " << i << ", seed " << seed;
            }
        }
    }
}

TEST(Bins, TakeWhatOthersCannot) {
    MadeWorld made = madeWorld(3);
    Box3d endless;
    endless.min = glm::dvec3(-std::numeric_limits<double>::infinity());
    endless.max = glm::dvec3(std::numeric_limits<double>::infinity());
    ObjectDef def;
    def.bounds = endless;
    const ObjectId always = made.world.add(def);
    const Snapshot now = made.world.commit();
    ThreadPool pool(2);
    Query query(defaultMemory(), &pool);
    View view = viewAt({0, 0, 12}, {0, 0, 0}, {70, 320, 180});
    QuerySettings settings = inBins(4);
    const auto keeps = [&](const VisibleSet& set) {
        return std::count_if(set.objects.begin(), set.objects.end(), [&](const Visible& v) { return v.id == always; });
    };
    VisibleSet set = query.visible(now, view, settings);
    EXPECT_EQ(keeps(set), 1);
    EXPECT_LT(set.objects.size(), now.objectCount());
    settings.bins = 1000;  // more than there are columns of tiles
    view.width = 17;
    EXPECT_EQ(keeps(query.visible(now, view, settings)), 1);
    settings.bins = 4;
    view.projection[0][0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(query.visible(now, view, settings).objects.size(), now.objectCount());
    EXPECT_TRUE(query.visible(Snapshot(), view, settings).objects.empty());
    EXPECT_EQ(query.changes().disappeared.size(), now.objectCount());
}

TEST(Bins, AllocateNothingOnceWarm) {
    MadeWorld made = madeWorld(4);
    const Snapshot now = made.world.commit();
    CountingMemory memory;
    ThreadPool pool(2);
    Query query(&memory, &pool);
    Random random(4);
    std::vector<View> views;
    for (int i = 0; i < 6; ++i) views.push_back(randomView(random));
    // What is remembered of certificates grows from answer to answer.
    QuerySettings settings = inBins(4);
    settings.proofs = false;
    for (int round = 0; round < 3; ++round)
        for (const View& view : views) query.visible(now, view, settings);
    const uint64_t before = memory.allocations;
    EXPECT_GT(before, 0u);
    for (const View& view : views) query.visible(now, view, settings);
    EXPECT_EQ(memory.allocations, before);
}

}  // namespace
}  // namespace sightline::test
