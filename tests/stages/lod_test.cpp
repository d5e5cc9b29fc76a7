// The stage of levels of detail: what it chooses, what may hide while it does, and that an answer stays one.
// SPDX-License-Identifier: MIT
#include "sightline/lod/lod_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "sightline/base/thread_pool.h"
#include "sightline/math/stretch.h"
#include "sightline/prepare/facing/draw_clusters.h"
#include "sightline/query/explain/explain.h"
#include "sightline/studies/hidden/zbuffer/zbuffer.h"
#include "tests/support/answers.h"
#include "tests/support/made_world.h"
#include "tests/support/meshes.h"
#include "tests/support/random.h"
#include "tests/support/views.h"

namespace sightline::test {
namespace {

/// A cube, and two levels of it that are smaller ones inside.
constexpr float kShrunk[] = {0.0f, 0.2f, 0.4f};
const std::vector<LodLevel> kLevels = {
    {0, 12000, 6000}, {std::sqrt(3.0) * 0.2 + 1e-6, 3000, 1500}, {std::sqrt(3.0) * 0.4 + 1e-6, 12, 8}};

struct LodWorld {
    TestMesh levels[3];
    std::vector<glm::dmat4> transforms;
    std::vector<ObjectId> ids;
    std::vector<uint8_t> has_levels;
    World world = World::create({.volumes = true});

    /// @param hides  ObjectDef::hides_in_lods: a lie here
    explicit LodWorld(uint64_t seed, int count, bool hides = false, uint32_t one_without = 5) {
        for (int i = 0; i < 3; ++i) levels[i] = boxMesh(glm::vec3(kShrunk[i]), glm::vec3(1 - kShrunk[i]));
        const OccluderId cube = world.addOccluder(prepareOccluder(levels[0].view()));
        const LodsId lods = world.addLods(kLevels);
        Random random(seed);
        for (int i = 0; i < count; ++i) {
            glm::dmat4 t(1.0);
            for (int axis = 0; axis < 3; ++axis) {
                t[axis][axis] = random.uniform(0.2, i % 4 ? 2.0 : 8.0);
                if (i % 3 == 0) t[axis][(axis + 1) % 3] = random.uniform(-0.4, 0.4);
            }
            t[3] = glm::dvec4(randomVector(random, {20, 5, 20}), 1.0);
            ObjectDef def;
            def.bounds = {glm::dvec3(0.0), glm::dvec3(1.0)};
            def.transform = t;
            def.key = transforms.size();
            def.occluder = def.shape = cube;
            def.hides_in_lods = hides;
            has_levels.push_back(static_cast<uint32_t>(i) % one_without != 0);
            if (has_levels.back()) def.lods = lods;
            transforms.push_back(t);
            ids.push_back(world.add(def));
        }
    }

    /// What is seen where the answer's objects are drawn by the levels that it says, and the others by their finest. An
    /// object that is faded has holes: it hides nothing.
    std::vector<uint8_t> seen(const VisibleSet& set, const View& view) const {
        std::vector<DrawItem> items(transforms.size());
        const std::vector<uint8_t> no(12, 0);
        std::vector<VisibleLod> lods(transforms.size());
        for (size_t i = 0; i < set.lods.size(); ++i) lods[set.objects[i].key] = set.lods[i];
        for (size_t i = 0; i < items.size(); ++i) {
            items[i].mesh = levels[lods[i].level].view();
            if (lods[i].from != lods[i].level) items[i].writes_depth = no;
            items[i].transform = transforms[i];
            items[i].id = static_cast<uint32_t>(i);
        }
        std::vector<uint8_t> seen = renderZBuffer(items, view, {.samples = 3, .want_generated = false}).seen;
        seen.resize(transforms.size(), 0);
        return seen;
    }
};

View nearView(Random& random) { return randomView(random, {.degrees = 70}, {18, 4, 18}); }

View movedBy(const View& view, const glm::dvec3& step) {
    View moved = view;
    moved.view[3] -= view.view * glm::dvec4(step, 0.0);
    return moved;
}

const uint64_t kLodWorlds = rounds(6, 2);

int countUnsound(bool lie, const QuerySettings& settings, uint64_t& coarse) {
    int unsound = 0;
    for (uint64_t seed = 1; seed <= kLodWorlds; ++seed) {
        LodWorld made(seed, 120, lie);
        const Snapshot now = made.world.commit();
        Query query;
        Random random(seed);
        for (int shot = 0; shot < 6; ++shot) {
            View view = nearView(random);
            for (int frame = 0; frame < 5; ++frame, view = movedBy(view, randomVector(random, glm::dvec3(0.4)))) {
                const VisibleSet set = query.visible(now, view, settings);
                const std::vector<uint8_t> kept = keptOf(set, made.transforms.size()), seen = made.seen(set, view);
                for (size_t i = 0; i < kept.size(); ++i) unsound += seen[i] && !kept[i];
                for (const VisibleLod& lod : set.lods) coarse += lod.level > 0;
            }
        }
    }
    return unsound;
}

TEST(LodStage, WhatIsDrawnCoarselyHidesNothingThatItsFinestLevelAloneHides) {
    for (const bool volumes : {false, true})
        for (const double error : {4.0, 16.0, 60.0})
            for (const uint32_t fade : {0u, 4u}) {
                QuerySettings settings;
                settings.lod_error = error;
                settings.lod_fade = fade;
                if (volumes) settings.stages = kAllStages;
                uint64_t coarse = 0;
                EXPECT_EQ(countUnsound(false, settings, coarse), 0) << error << " pixels, fade " << fade;
                EXPECT_GT(coarse, 160 * kLodWorlds);
            }
    // The same world with a promise that it does not keep shows that this can be seen at all.
    QuerySettings settings;
    settings.lod_error = 60;
    uint64_t coarse = 0;
    EXPECT_GT(countUnsound(true, settings, coarse), 0);
}

TEST(LodStage, UnderABudgetNothingHidesThatMayBeCoarse) {
    QuerySettings settings;
    settings.budget = 0.02;
    settings.cost_triangle = 1;
    uint64_t coarse = 0;
    EXPECT_EQ(countUnsound(false, settings, coarse), 0);
    EXPECT_GT(coarse, 160 * kLodWorlds);
}

TEST(LodStage, ChoosesTheLevelThatErrorsAndMemorySay) {
    LodWorld made(7, 150);
    const Snapshot now = made.world.commit();
    Query query;
    QuerySettings settings;
    settings.lod_error = 12;
    settings.lod_fade = 3;
    LodRule rule{12, settings.hysteresis, 3};
    Random random(7);
    View view = nearView(random);
    std::map<uint64_t, LodState> last;
    for (int frame = 0; frame < 60; ++frame) {
        view = frame % 20 == 19 ? nearView(random) : movedBy(view, randomVector(random, glm::dvec3(0.3)));
        const VisibleSet set = query.visible(now, view, settings);
        ASSERT_EQ(set.lods.size(), set.objects.size());
        std::map<uint64_t, LodState> next;
        uint64_t finest = 0, drawn = 0, fading = 0;
        const LodMeasure measure = makeLodMeasure(view);
        for (size_t i = 0; i < set.objects.size(); ++i) {
            const uint64_t key = set.objects[i].key;
            if (!made.has_levels[key]) {
                ASSERT_EQ(set.lods[i].level, 0);
                continue;
            }
            Box3d box;
            for (int corner = 0; corner < 8; ++corner) {
                const glm::dvec3 p(made.transforms[key] * glm::dvec4(corner & 1, corner >> 1 & 1, corner >> 2, 1.0));
                box.min = glm::min(box.min, p);
                box.max = glm::max(box.max, p);
            }
            const double unit = largestStretch(made.transforms[key]) * pixelsOfUnit(measure, box);
            const auto at = last.find(key);
            const LodRange range = lodRange(kLevels, unit, rule, at != last.end());
            LodState state{range.coarsest, range.coarsest, 0};
            if (at != last.end()) state = nextState(at->second, levelIn(range, at->second.level), kLevels, unit, rule);
            const VisibleLod expected = visibleLod(state, kLevels, unit, rule);
            ASSERT_EQ(set.lods[i].level, expected.level) << "frame " << frame << " object " << key;
            ASSERT_EQ(set.lods[i].from, expected.from);
            ASSERT_EQ(set.lods[i].fade, expected.fade);
            ASSERT_NEAR(set.lods[i].morph, expected.morph, 1e-4);
            next[key] = state;
            finest += kLevels[0].triangles;
            drawn += kLevels[state.level].triangles + (state.left > 0 ? kLevels[state.from].triangles : 0);
            fading += state.left > 0;
        }
        EXPECT_EQ(set.stats.lod_finest, finest);
        EXPECT_EQ(set.stats.lod_triangles, drawn);
        EXPECT_EQ(set.stats.lod_fading, fading);
        last = next;
    }
}

TEST(LodStage, IsOffUnlessAsked) {
    LodWorld made(3, 60);
    const Snapshot now = made.world.commit();
    const View view = viewAt({0, 2, 30}, {0, 0, 0});
    Query query;
    EXPECT_TRUE(query.visible(now, view).lods.empty());
    QuerySettings settings;
    settings.lod_error = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(query.visible(now, view, settings).lods.empty());
    settings.lod_error = 1;
    EXPECT_FALSE(query.visible(now, view, settings).lods.empty());
    settings.stages &= ~stageBit(Stage::kLod);
    EXPECT_TRUE(query.visible(now, view, settings).lods.empty());
    settings.stages = kDefaultStages;
    MadeWorld plain(3, 60);
    EXPECT_TRUE(query.visible(plain.world.commit(), view, settings).lods.empty());
    View broken = view;
    broken.view[0][0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(query.visible(now, broken, settings).lods.empty());
}

TEST(LodStage, AMillimetreOfNoiseChangesNothingTwice) {
    LodWorld made(9, 200);
    const Snapshot now = made.world.commit();
    QuerySettings settings;
    settings.lod_error = 8;
    Random random(9);
    for (int shot = 0; shot < 10; ++shot) {
        const View view = nearView(random);
        Query query;
        std::map<uint64_t, uint8_t> last;
        std::map<uint64_t, int> changes;
        for (int frame = 0; frame < 60; ++frame) {
            const VisibleSet set = query.visible(now, movedBy(view, randomVector(random, glm::dvec3(1e-3))), settings);
            for (size_t i = 0; i < set.objects.size(); ++i) {
                const auto [at, is_new] = last.try_emplace(set.objects[i].key, set.lods[i].level);
                if (!is_new && at->second != set.lods[i].level) ++changes[set.objects[i].key];
                at->second = set.lods[i].level;
            }
        }
        for (const auto& [key, count] : changes) EXPECT_LE(count, 1) << key;
    }
}

/// The cost of an answer, counted apart.
double costOf(const LodWorld& made, const VisibleSet& set, const View& view, const DrawCost& cost) {
    double sum = 0;
    const LodMeasure measure = makeLodMeasure(view);
    for (size_t i = 0; i < set.objects.size(); ++i) {
        const uint64_t key = set.objects[i].key;
        if (!made.has_levels[key]) {
            sum += cost.object;
            continue;
        }
        Box3d box;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 p(made.transforms[key] * glm::dvec4(corner & 1, corner >> 1 & 1, corner >> 2, 1.0));
            box.min = glm::min(box.min, p);
            box.max = glm::max(box.max, p);
        }
        // While it fades, a level is drawn beside the one that was chosen: the choice is what is held to the budget.
        sum += cost.of(kLevels[set.lods[i].level], pixelsOfBox(measure, box));
    }
    return sum;
}

TEST(LodStage, AHardBudgetIsKeptAndWhatItLeavesOutIsCounted) {
    LodWorld made(11, 200, false, 1000);
    const Snapshot now = made.world.commit();
    QuerySettings settings;
    settings.hard_budget = true;
    settings.lod_fade = 0;
    settings.cost_object = 500;
    settings.cost_triangle = 2;
    settings.cost_pixel = 0.5;
    Random random(11);
    Query query;
    uint64_t left_out = 0, explained = 0;
    for (int frame = 0; frame < 60; ++frame) {
        SCOPED_TRACE(frame);
        const View view = nearView(random);
        QuerySettings off;
        const size_t all = query.visible(now, view, off).objects.size();
        settings.budget = std::exp(random.uniform(-7, 1));
        settings.lod_error = frame % 2 ? 1.0 : 0.0;
        const VisibleSet set = query.visible(now, view, settings);
        const double cost = costOf(made, set, view, drawCost(settings));
        const double all_always = settings.cost_object;  // object 0 has no levels: it is always drawn
        EXPECT_LE(cost, std::max(1e6 * settings.budget, all_always) * (1 + 1e-4) + 1);
        EXPECT_NEAR(cost, static_cast<double>(set.stats.lod_cost), 1e-3 * cost + 1);
        const StageStats& stage = set.stats.of(Stage::kLod);
        EXPECT_GE(set.objects.size() + stage.culled, all);  // what may be coarse hides nothing
        EXPECT_EQ(accountedFor(set.stats), now.objectCount());
        EXPECT_EQ(stage.tested, set.objects.size() + stage.culled);
        const std::vector<uint8_t> reasons = reasonsOf(query, now);
        EXPECT_EQ(static_cast<uint64_t>(std::count(reasons.begin(), reasons.end(), 1 + int(Stage::kLod))),
                  stage.culled);
        left_out += stage.culled;
        // What is explained does not remember levels; without them the same is left out.
        settings.stateless = true;
        query.visible(now, view, settings);
        const std::vector<uint8_t> alone = reasonsOf(query, now);
        Explainer explainer(now, view, settings);
        for (size_t i = 0; i < made.ids.size() && frame % 6 == 0; ++i) {
            const Explanation why = explainer.explain(made.ids[i], {.hiders = false, .without = false});
            EXPECT_EQ(why.verdict == Verdict::kNoTime, alone[i] == 1 + int(Stage::kLod)) << i;
            explained += why.verdict == Verdict::kNoTime;
            const bool shown = why.verdict == Verdict::kVisible && made.has_levels[i];
            EXPECT_EQ(why.lod.levels, shown ? 3u : 0u);
        }
        settings.stateless = false;
    }
    EXPECT_GT(left_out, 500u);
    EXPECT_GT(explained, 50u);
}

TEST(LodStage, ASoftBudgetLeavesNothingOutAndSaysIfItIsExceeded) {
    LodWorld made(13, 200);
    const Snapshot now = made.world.commit();
    QuerySettings settings;
    settings.cost_object = 10;
    settings.cost_triangle = 2;
    Random random(13);
    Query query;
    for (int frame = 0; frame < 20; ++frame) {
        const View view = viewAt(randomVector(random, {20, 4, 20}), {0, 0, 0});
        settings.budget = 1e-6;
        const VisibleSet tight = query.visible(now, view, settings);
        ASSERT_FALSE(tight.objects.empty());
        EXPECT_EQ(tight.stats.of(Stage::kLod).culled, 0u);
        EXPECT_TRUE(tight.stats.lod_exceeded);
        settings.budget = 1e3;
        Query another;
        const VisibleSet ample = another.visible(now, view, settings);
        EXPECT_FALSE(ample.stats.lod_exceeded);
        for (const VisibleLod& lod : ample.lods) EXPECT_EQ(lod.level, 0);
    }
}

TEST(LodStage, ClustersAreOfTheFinestLevel) {
    const MeshPart kWhole[] = {{0, 12, false}};
    LodWorld made(17, 0);
    const ClustersId clusters = made.world.addClusters(prepareDrawClusters(made.levels[0].view(), kWhole));
    const LodsId lods = made.world.addLods(kLevels);
    for (int i = 0; i < 40; ++i) {
        ObjectDef def;
        def.bounds = {glm::dvec3(0.0), glm::dvec3(1.0)};
        def.transform[3] = glm::dvec4(3.0 * (i % 5) - 6, 0, -2.0 - 6 * (i / 5), 1);
        def.key = static_cast<uint64_t>(i);
        def.lods = lods;
        def.clusters = clusters;
        made.world.add(def);
    }
    QuerySettings settings;
    settings.lod_error = 5;
    settings.lod_fade = 0;
    Query query;
    const VisibleSet set = query.visible(made.world.commit(), viewAt({0, 0.5, 0}, {0, 0.5, -1}), settings);
    ASSERT_EQ(set.lods.size(), set.objects.size());
    std::vector<uint8_t> has(set.objects.size(), 0);
    for (const DrawRange& range : set.ranges) has[range.object] = 1;
    size_t fine = 0;
    for (size_t i = 0; i < has.size(); ++i) {
        EXPECT_EQ(has[i] == 1, set.lods[i].level == 0) << i;
        fine += has[i];
    }
    EXPECT_GT(fine, 0u);
    EXPECT_LT(fine, has.size());
}

TEST(LodStage, BothEyesSeeTheSameLevelAndItIsGoodEnoughForEither) {
    LodWorld made(19, 150);
    const Snapshot now = made.world.commit();
    QuerySettings settings;
    settings.lod_error = 10;
    settings.lod_fade = 0;
    Random random(19);
    for (int frame = 0; frame < 20; ++frame) {
        const View left = nearView(random), right = shiftedEye(left, 0.5);
        Query pair, alone;
        const StereoSet set = pair.visibleStereo(now, left, right, settings);
        ASSERT_EQ(set.lods.size(), set.objects.size());
        std::map<uint64_t, uint8_t> by_eye[2];
        for (const View* view : {&left, &right}) {
            alone = Query();
            const VisibleSet one = alone.visible(now, *view, settings);
            for (size_t i = 0; i < one.objects.size(); ++i)
                by_eye[view == &right][one.objects[i].key] = one.lods[i].level;
        }
        for (size_t i = 0; i < set.objects.size(); ++i)
            for (const auto& levels : by_eye) {
                const auto at = levels.find(set.objects[i].key);
                if (at == levels.end()) continue;
                EXPECT_LE(set.lods[i].level, at->second);
            }
    }
}

TEST(LodStage, ThreadsAndStripsAnswerAlike) {
    LodWorld made(23, 200);
    const Snapshot now = made.world.commit();
    ThreadPool pool(3);
    Query alone, threaded(defaultMemory(), &pool), strips;
    QuerySettings settings;
    settings.lod_error = 10;
    settings.budget = 0.05;
    settings.cost_triangle = 1;
    settings.bins = 4;
    Random random(23);
    View view = nearView(random);
    for (int frame = 0; frame < 20; ++frame, view = movedBy(view, randomVector(random, glm::dvec3(0.3)))) {
        const VisibleSet a = alone.visible(now, view, settings), b = threaded.visible(now, view, settings);
        ASSERT_EQ(keysOf(a), keysOf(b));
        for (size_t i = 0; i < a.lods.size(); ++i) {
            ASSERT_EQ(a.lods[i].level, b.lods[i].level);
            ASSERT_EQ(a.lods[i].fade, b.lods[i].fade);
        }
        ASSERT_EQ(a.stats.lod_cost, b.stats.lod_cost);
    }
}

TEST(LodStage, AnObjectThatComesBackBeginsAnew) {
    LodWorld made(29, 0);
    const LodsId lods = made.world.addLods(kLevels);
    ObjectDef def;
    def.bounds = {glm::dvec3(0.0), glm::dvec3(1.0)};
    def.transform[3] = glm::dvec4(-0.5, -0.5, -20, 1);
    def.lods = lods;
    made.world.add(def);
    QuerySettings settings;
    settings.lod_fade = 8;
    Query query;
    const View toward = viewAt({0, 0, 0}, {0, 0, -1}), away = viewAt({0, 0, 0}, {0, 0, 1});
    settings.lod_error = 0.5;
    EXPECT_EQ(query.visible(made.world.commit(), toward, settings).lods[0].level, 0);
    settings.lod_error = 2;
    VisibleLod lod = query.visible(made.world.commit(), toward, settings).lods[0];
    EXPECT_EQ(lod.level, 1);
    EXPECT_EQ(lod.from, 0);
    EXPECT_LT(lod.fade, 0.2f);
    query.visible(made.world.commit(), away, settings);
    lod = query.visible(made.world.commit(), toward, settings).lods[0];
    EXPECT_EQ(lod.level, 1);
    EXPECT_EQ(lod.from, 1);
    EXPECT_EQ(lod.fade, 1.0f);
}

}  // namespace
}  // namespace sightline::test
