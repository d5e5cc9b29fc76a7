// The C interface gives the library's own answers: queries, two eyes, changes, reasons, explanations, casters, sight.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <thread>

#include "sightline/geom/clip_space.h"
#include "sightline/query/explain/explain.h"
#include "sightline/query/record/frame_replay.h"
#include "sightline/query/shadow_query.h"
#include "sightline/query/sight_query.h"
#include "tests/c/c_twin.h"

namespace sightline::test {
namespace {

TEST(CQuery, AnswersAsTheLibraryDoes) {
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        MadeWorld made;
        made.shapes = seed % 2 == 0;
        made.fill(seed, 300, glm::dvec3(0));
        const CWorld world(made);
        const CQuery c(world);
        const Snapshot now = made.world.commit();
        Query query;
        Random random(seed);
        for (int i = 0; i < 40; ++i) {
            const View view = i % 4 ? randomView(random) : anyView(random);
            const VisibleSet set = query.visible(now, view);
            const slVisibleSet answer = c.ask(viewOf(view));
            ASSERT_EQ(keysOf(answer), keysOf(set)) << "seed " << seed << ", view " << i;
            EXPECT_EQ(answer.problem, nullptr);
            slQueryStats stats;
            ASSERT_EQ(slQueryGetStats(c.query, &stats), SL_OK);
            EXPECT_EQ(stats.objects, set.stats.objects);
            EXPECT_EQ(stats.occluder_triangles, set.stats.occluder_triangles);
            uint64_t accounted = stats.visible;
            for (const slStageStats& stage : stats.stages) accounted += stage.culled;
            EXPECT_EQ(accounted, stats.objects);

            std::vector<uint8_t> reasons(made.transforms.size());
            size_t count = 0;
            ASSERT_EQ(slQueryReasons(c.query, reasons.data(), reasons.size(), &count), SL_OK);
            EXPECT_EQ(count, reasons.size());
            EXPECT_EQ(reasons, reasonsOf(query, now));

            slChanges changes;
            ASSERT_EQ(slQueryChanges(c.query, &changes), SL_OK);
            const VisibleChanges expected = query.changes();
            EXPECT_EQ(changes.appeared_count, expected.appeared.size());
            EXPECT_EQ(changes.disappeared_count, expected.disappeared.size());
        }
    }
}

TEST(CQuery, TakesProposals) {
    MadeWorld made(11, 300);
    const CWorld world(made);
    const CQuery c(world);
    const Snapshot now = made.world.commit();
    Query query;
    Random random(11);
    uint64_t proved = 0;
    for (int frame = 0; frame < 12; ++frame) {
        const View view = randomView(random);
        const VisibleSet set = query.visible(now, view);
        EXPECT_EQ(keysOf(c.ask(viewOf(view))), keysOf(set)) << frame;
        slQueryStats stats;
        ASSERT_EQ(slQueryGetStats(c.query, &stats), SL_OK);
        EXPECT_EQ(stats.proved, set.stats.proved) << frame;
        proved += stats.proved;
        EXPECT_TRUE(frame > 0 || proved == 0) << "a first answer draws, and nothing was proposed";
        ASSERT_EQ(slQueryPropose(c.query, world.ids.data(), world.ids.size()), SL_OK);
        query.propose(made.ids);
    }
    EXPECT_GT(proved, 0u);
    EXPECT_EQ(slQueryPropose(c.query, nullptr, 0), SL_OK);
}

TEST(CQuery, LearnsFromAnother) {
    MadeWorld made;
    made.add({-6, -6, -10}, {6, 6, -9});
    for (int i = 0; i < 40; ++i) made.add({i % 8 - 4.0, i / 8 - 2.0, -20}, {i % 8 - 3.7, i / 8 - 1.7, -19.5});
    const CWorld world(made);
    const CQuery c(world), c_teacher(world);
    const Snapshot now = made.world.commit();
    Query query, teacher;
    uint64_t proved = 0;
    for (int frame = 0; frame < 12; ++frame) {
        const View view = viewFrom({0.01 * frame, 0, 0}, {0, 0, -1});
        query.learn(teacher);
        ASSERT_EQ(slQueryLearn(c.query, c_teacher.query), SL_OK);
        const VisibleSet set = query.visible(now, view);
        EXPECT_EQ(keysOf(c.ask(viewOf(view))), keysOf(set)) << frame;
        slQueryStats stats;
        ASSERT_EQ(slQueryGetStats(c.query, &stats), SL_OK);
        EXPECT_EQ(stats.proved, set.stats.proved) << frame;
        EXPECT_EQ(stats.occluder_triangles, set.stats.occluder_triangles) << frame;
        proved += stats.proved;
        teacher.visible(now, view);
        c_teacher.ask(viewOf(view));
    }
    EXPECT_GT(proved, 0u);
}

TEST(CQuery, TakesSettings) {
    const MadeWorld made(7, 300);
    const CWorld world(made);
    const CQuery c(world);
    const Snapshot now = const_cast<MadeWorld&>(made).world.commit();
    Query query;
    Random random(7);
    QuerySettings how;
    how.max_distance = 12;
    how.contribution = 3;
    how.second_look = false;
    how.occlusion_size = 128;
    how.bins = 3;
    slQuerySettings settings = slDefaultQuerySettings();
    settings.max_distance = 12;
    settings.contribution = 3;
    settings.second_look = false;
    settings.occlusion_size = 128;
    settings.bins = 3;
    for (int i = 0; i < 20; ++i) {
        const View view = randomView(random);
        EXPECT_EQ(keysOf(c.ask(viewOf(view), &settings)), keysOf(query.visible(now, view, how)));
    }
}

/// Every setting of the table has a field of its own, with the same default: one that is changed changes it alone.
TEST(CQuery, DefaultSettingsAreTheLibrarys) {
    const MadeWorld made(9, 200);
    const CWorld world(made);
    const CQuery asked(world), standard(world);
    const slQuerySettings settings = slDefaultQuerySettings();
    EXPECT_EQ(settings.stages, QuerySettings().stages);
    EXPECT_EQ(settings.second_look_polygons, QuerySettings().second_look_polygons);
    EXPECT_EQ(settings.unasked_answers, QuerySettings().unasked_answers);
    Random random(9);
    for (int i = 0; i < 20; ++i) {
        const slView view = viewOf(randomView(random));
        EXPECT_EQ(keysOf(asked.ask(view, &settings)), keysOf(standard.ask(view)));
    }
}

TEST(CQuery, TakesMatricesOfEveryConvention) {
    const MadeWorld made(3, 200);
    const CWorld world(made);
    const CQuery c(world);
    const Snapshot now = const_cast<MadeWorld&>(made).world.commit();
    Random random(3);
    for (int i = 0; i < 10; ++i) {
        const View view = randomView(random);
        Query query;
        const std::vector<uint64_t> expected = keysOf(query.visible(now, view, {.stateless = true}));
        slQuerySettings settings = slDefaultQuerySettings();
        settings.stateless = true;
        for (size_t k = 0; k < std::size(kClipSpaces); ++k) {
            const ClipSpace space = kClipSpaces[k].space;
            // From OpenGL's matrices to those of the convention: the reverse of what is asked for.
            glm::dmat4 eye(1.0), clip(1.0);
            if (space.left_handed) eye[2][2] = -1;
            if (space.y_down) clip[1][1] = -1;
            if (space.depth == ClipDepth::kZeroToOne) {
                clip[2][2] = space.reversed ? -0.5 : 0.5;
                clip[3][2] = 0.5;
            }
            View other = view;
            other.view = eye * view.view;
            other.projection = clip * view.projection * eye;
            slView from = viewOf(other);
            from.clip_space = static_cast<slClipSpace>(k);
            std::vector<uint64_t> keys = keysOf(c.ask(from, &settings)), same = expected;
            std::sort(keys.begin(), keys.end());
            std::sort(same.begin(), same.end());
            // Matrices that are turned to and fro are rounded: an object at the very edge of the view may differ.
            EXPECT_LE(std::max(keys.size(), same.size()) - std::min(keys.size(), same.size()), 1u)
                << kClipSpaces[k].name;
            EXPECT_EQ(slViewProblem(&from), nullptr) << kClipSpaces[k].name;
        }
    }
}

TEST(CQuery, WritesKeysIntoTheCallersArray) {
    const MadeWorld made(11, 200);
    const CWorld world(made);
    const CQuery c(world);
    const slView view = viewOf(viewAt({0, 0, 40}, {0, 0, 0}));
    const std::vector<uint64_t> all = keysOf(c.ask(view));
    ASSERT_GT(all.size(), 3u);
    std::vector<uint64_t> keys(all.size());
    size_t count = 0;
    EXPECT_EQ(slQueryVisibleKeys(c.query, c.now, &view, nullptr, keys.data(), keys.size(), &count), SL_OK);
    EXPECT_EQ(count, all.size());
    std::vector<uint64_t> few(2, ~0ull), rest(all.size());
    EXPECT_EQ(slQueryVisibleKeys(c.query, c.now, &view, nullptr, few.data(), few.size(), &count), SL_NO_ROOM);
    ASSERT_EQ(count, all.size());
    EXPECT_EQ(slQueryKeys(c.query, rest.data(), rest.size(), &count), SL_OK);
    EXPECT_EQ(few, std::vector<uint64_t>(rest.begin(), rest.begin() + 2));
    EXPECT_EQ(slQueryVisibleKeys(c.query, c.now, &view, nullptr, nullptr, 0, &count), SL_NO_ROOM);
}

TEST(CQuery, AnswersForTwoEyes) {
    MadeWorld made(5, 300);
    const CWorld world(made);
    const CQuery c(world);
    const Snapshot now = made.world.commit();
    Query query;
    Random random(5);
    for (int i = 0; i < 10; ++i) {
        const View left = randomView(random), right = shiftedEye(left, 0.3);
        const StereoSet set = query.visibleStereo(now, left, right);
        const slView eyes[] = {viewOf(left), viewOf(right)};
        slVisibleSet answer;
        const uint8_t* seen_by = nullptr;
        ASSERT_EQ(slQueryStereo(c.query, c.now, &eyes[0], &eyes[1], nullptr, &answer, &seen_by), SL_OK);
        ASSERT_EQ(answer.count, set.objects.size());
        for (uint32_t k = 0; k < answer.count; ++k) {
            EXPECT_EQ(answer.objects[k].key, set.objects[k].key);
            EXPECT_EQ(seen_by[k], set.eyes[k]);
        }
    }
}

TEST(CQuery, ThreadsShareOneQuery) {
    const MadeWorld made(13, 300);
    const CWorld world(made);
    slThreadPool* pool = nullptr;
    ASSERT_EQ(slCreateThreadPool(3, &pool), SL_OK);
    {
        slHooks hooks{};
        hooks.jobs = slJobsOf(pool);
        const CQuery shared(world, hooks), alone(world);
        slQuerySettings settings = slDefaultQuerySettings();
        settings.bins = 4;
        Random random(13);
        for (int i = 0; i < 20; ++i) {
            const slView view = viewOf(randomView(random));
            EXPECT_EQ(keysOf(shared.ask(view, &settings)), keysOf(alone.ask(view, &settings)));
        }
    }
    slDestroyThreadPool(pool);
}

TEST(CQuery, ManyThreadsAskOneSnapshot) {
    const MadeWorld made(17, 300);
    const CWorld world(made);
    slSnapshot* const now = world.commit();
    std::vector<std::vector<uint64_t>> answers(4);
    std::vector<std::thread> threads;
    for (auto& answer : answers)
        threads.emplace_back([&answer, now] {
            slQuery* query = nullptr;
            slCreateQuery(nullptr, &query);
            Random random(17);
            for (int i = 0; i < 10; ++i) {
                const slView view = viewOf(randomView(random));
                slVisibleSet set;
                slQueryVisible(query, now, &view, nullptr, &set);
                const std::vector<uint64_t> keys = keysOf(set);
                answer.insert(answer.end(), keys.begin(), keys.end());
            }
            slDestroyQuery(query);
        });
    for (std::thread& thread : threads) thread.join();
    for (const auto& answer : answers) EXPECT_EQ(answer, answers[0]);
    slReleaseSnapshot(now);
}

TEST(CExplain, SaysWhatTheLibrarySays) {
    MadeWorld made(19, 150);
    const CWorld world(made);
    const CQuery c(world);
    const Snapshot now = made.world.commit();
    Random random(19);
    int occluded = 0, kept = 0, outside = 0;
    for (int i = 0; i < 4; ++i) {
        const View view = randomView(random);
        const slView from = viewOf(view);
        const Query query;
        for (size_t k = 0; k < made.ids.size(); k += 7) {
            const Explanation expected = query.explain(now, view, made.ids[k]);
            slExplanation why;
            ASSERT_EQ(slQueryExplain(c.query, c.now, &from, nullptr, c.now ? world.ids[k] : slObjectId{}, &why), SL_OK);
            EXPECT_EQ(int(why.verdict), int(expected.verdict));
            EXPECT_EQ(why.object.key, k);
            char words[300];
            const size_t takes = slExplanationWords(&why, words, sizeof words);
            EXPECT_EQ(takes, std::strlen(words) + 1) << words;
            const std::string text = words;
            if (why.verdict == SL_OCCLUDED) {
                ++occluded;
                ASSERT_EQ(why.hider_count, expected.occlusion.hiders.size());
                for (uint32_t h = 0; h < std::min<uint32_t>(why.hider_count, SL_MOST_HIDERS); ++h)
                    EXPECT_EQ(why.hiders[h].object.key, expected.occlusion.hiders[h].key);
                EXPECT_NE(text.find("culled by occlusion: it lies behind object"), std::string::npos) << text;
            } else if (why.verdict == SL_VISIBLE) {
                ++kept;
                EXPECT_NE(text.find("kept: "), std::string::npos) << text;
            } else {
                outside += why.verdict == SL_OUTSIDE_FRUSTUM;
                EXPECT_NE(text.find("culled by "), std::string::npos) << text;
            }
        }
    }
    EXPECT_GT(occluded, 3);
    EXPECT_GT(kept, 3);
    EXPECT_GT(outside, 3);
}

TEST(CExplain, WordsAreCutToTheirRoom) {
    slExplanation why{};
    why.verdict = SL_OCCLUDED;
    why.object.key = 12;
    why.hider_count = 20;
    why.sufficient = true;
    for (uint64_t i = 0; i < SL_MOST_HIDERS; ++i) why.hiders[i] = {{i, {}}, 0.05};
    char words[16];
    const size_t takes = slExplanationWords(&why, words, sizeof words);
    EXPECT_GT(takes, sizeof words);
    EXPECT_EQ(std::strlen(words), sizeof words - 1);
    EXPECT_EQ(slExplanationWords(&why, nullptr, 0), takes);
    std::string whole(takes, ' ');
    slExplanationWords(&why, whole.data(), whole.size());
    EXPECT_NE(whole.find("and 4 more"), std::string::npos) << whole;
    EXPECT_EQ(slExplanationWords(nullptr, nullptr, 0), std::strlen("there is no explanation") + 1);
}

TEST(CShadows, FindsTheLibrarysCasters) {
    MadeWorld made(23, 200);
    const CWorld world(made);
    const CQuery c(world);
    const Snapshot now = made.world.commit();
    slShadows* shadows = nullptr;
    ASSERT_EQ(slCreateShadows(nullptr, &shadows), SL_OK);
    Random random(23);
    Query query;
    ShadowQuery expected;
    const double cascades[] = {8, 30};
    for (int i = 0; i < 10; ++i) {
        const View view = randomView(random);
        const VisibleSet seen = query.visible(now, view);
        Light light;
        light.direction = randomUnit(random);
        CasterSettings how;
        how.cascades = cascades;
        const CasterSet set = expected.casters(now, view, seen.objects, light, how);
        const slView from = viewOf(view);
        const slVisibleSet receivers = c.ask(from);
        slLight sun = slDefaultLight();
        for (int axis = 0; axis < 3; ++axis) sun.direction[axis] = light.direction[axis];
        slCasterSettings settings = slDefaultCasterSettings();
        settings.cascades = cascades;
        settings.cascade_count = 2;
        slCasterSet answer;
        ASSERT_EQ(slFindCasters(shadows, c.now, &from, &receivers, &sun, &settings, &answer), SL_OK);
        ASSERT_EQ(answer.count, set.casters.size());
        EXPECT_EQ(answer.in_light, set.stats.in_light);
        for (uint32_t k = 0; k < answer.count; ++k) {
            EXPECT_EQ(answer.casters[k].key, set.casters[k].key);
            EXPECT_EQ(answer.cascades[k], set.cascades[k]);
        }
    }
    slDestroyShadows(shadows);
}

TEST(CSight, LooksAsTheLibraryDoes) {
    MadeWorld made(29, 200);
    const CWorld world(made);
    slSnapshot* const snapshot = world.commit();
    const Snapshot now = made.world.commit();
    slSight* sight = nullptr;
    ASSERT_EQ(slCreateSight(nullptr, &sight), SL_OK);
    SightQuery expected;
    Random random(29);
    int blocked = 0;
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 from = randomVector(random, {20, 4, 20}), to = randomVector(random, {20, 4, 20});
        const SightLine first = expected.look(now, from, to);
        slSightLine line;
        ASSERT_EQ(slSightLook(sight, snapshot, &from.x, &to.x, nullptr, &line), SL_OK);
        EXPECT_EQ(line.blocked, first.blocked);
        if (!line.blocked) continue;
        ++blocked;
        EXPECT_EQ(line.by.key, first.by.key);
        slSightSettings settings = slDefaultSightSettings();
        settings.ignored = &line.by.id;
        settings.ignored_count = 1;
        slSightLine again;
        ASSERT_EQ(slSightLook(sight, snapshot, &from.x, &to.x, &settings, &again), SL_OK);
        EXPECT_TRUE(!again.blocked || again.by.key != line.by.key);
    }
    EXPECT_GT(blocked, 30);
    const slBox region = {{-1, -1, -1}, {1, 1, 1}};
    slRegionSet set;
    ASSERT_EQ(slSightFrom(sight, snapshot, &region, ~0u, &set), SL_OK);
    EXPECT_FALSE(set.known);
    EXPECT_EQ(set.count, made.ids.size());
    slDestroySight(sight);
    slReleaseSnapshot(snapshot);
}

TEST(CDebugDraw, DrawsWhatWasKeptAndCulled) {
    const MadeWorld made(31, 100);
    const CWorld world(made);
    const CQuery c(world);
    Random random(31);
    struct Lines {
        std::map<uint32_t, int> by_color;
    } lines;
    const slDebugDraw draw = {
        [](void* user, const double*, const double*, uint32_t color) { ++static_cast<Lines*>(user)->by_color[color]; },
        &lines};
    const slView view = viewOf(randomView(random));
    const slVisibleSet set = c.ask(view);
    ASSERT_EQ(slDrawAnswer(c.query, c.now, &view, SL_DRAW_FRUSTUM | SL_DRAW_VISIBLE | SL_DRAW_CULLED, &draw), SL_OK);
    EXPECT_EQ(lines.by_color[0xffffff], 12);
    EXPECT_EQ(lines.by_color[0x40c040], 12 * int(set.count));
    int all = 0;
    for (const auto& [color, count] : lines.by_color) all += count;
    EXPECT_EQ(all, 12 * int(made.ids.size() + 1));
    slExplanation why;
    ASSERT_EQ(slQueryExplain(c.query, c.now, &view, nullptr, world.ids[0], &why), SL_OK);
    lines.by_color.clear();
    ASSERT_EQ(slDrawExplanation(c.now, &why, &draw), SL_OK);
    EXPECT_EQ(lines.by_color[0xd040d0], 12);
    slDepthImage image;
    ASSERT_EQ(slQueryDepthImage(c.query, &image), SL_OK);
    EXPECT_GT(image.width, 0u);

    const void* bytes = nullptr;
    size_t count = 0;
    ASSERT_EQ(slQueryRecord(c.query, &bytes, &count), SL_OK);
    const Result<FrameRecording> recording = parseRecording({static_cast<const char*>(bytes), count}, "frame");
    ASSERT_TRUE(recording.ok()) << recording.error().message;
    EXPECT_EQ(std::count(recording->reasons.begin(), recording->reasons.end(), 0), int(set.count));
    EXPECT_TRUE(FrameReplay(*recording).run().same());
}

}  // namespace
}  // namespace sightline::test
