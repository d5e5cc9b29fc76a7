// The closer looks: they only ever cull more, what is seen stays, and every set of instructions gives the same answer.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "tests/support/explain_laws.h"
#include "tests/support/made_world.h"
#include "tests/support/random.h"
#include "tests/support/targets.h"

namespace sightline::test {
using namespace studies;
namespace {

/// Objects whose boxes say little about them: thin bars across their boxes, under any transform, and walls.
struct BarWorld : MadeWorld {
    explicit BarWorld(uint64_t seed) {
        shapes = true;
        // A beam from corner to corner of the unit box.
        other = mesh;
        for (glm::vec3& p : other.positions) p = p.z < 0.5f ? 0.1f * p : glm::vec3(1) - 0.1f * (glm::vec3(1, 1, 2) - p);
        const OccluderId bar = world.addOccluder(prepareOccluder(other.view()));
        Random random(seed);
        for (int i = 0; i < 300; ++i) {
            glm::dmat4 t(1.0);
            const bool wall = i % 5 == 0;
            for (int axis = 0; axis < 3; ++axis) t[axis][axis] = wall ? random.uniform(0.2, 9) : random.uniform(0.3, 5);
            if (wall) t[i % 2 ? 0 : 2] *= 0.05;
            if (!wall) {
                for (int k = 0; k < 3; ++k) t[k][(k + 1) % 3] = random.uniform(-1, 1);
                if (i % 3 == 0) t[0] = -t[0];
            }
            // Braces keep the order, whatever the compiler.
            t[3] = glm::dvec4{random.uniform(-15, 15), random.uniform(-5, 5), random.uniform(-15, 15), 1};
            add(t, i % 4 != 1, 1, wall ? OccluderId() : bar);
        }
    }
};

View strangeView(Random& random, int kind) {
    View view = test::randomView(random, {kind % 2 ? 100.0 : 50.0, 320, 180}, {12, 4, 12});
    if (kind % 3 == 2) view.projection = orthographic(12, 16.0 / 9.0, 0.1, 100);
    return view;
}

std::vector<uint64_t> sortedKeys(const Snapshot& now, const View& view, const QuerySettings& settings = {},
                                 QueryStats* stats = nullptr) {
    Query query;
    const VisibleSet set = query.visible(now, view, settings);
    if (stats) *stats = set.stats;
    std::vector<uint64_t> keys = keysOf(set);
    std::sort(keys.begin(), keys.end());
    return keys;
}

TEST(SecondLook, OnlyCullsMoreAndKeepsWhatIsSeen) {
    uint64_t by_faces = 0, by_triangles = 0, kept = 0, rough_kept = 0, left_in = 0;
    for (uint64_t seed = 1; seed <= 10; ++seed) {
        BarWorld made(seed);
        const Snapshot now = made.world.commit();
        Random random(seed);
        for (int frame = 0; frame < 6; ++frame) {
            const std::string what = "seed " + std::to_string(seed) + " frame " + std::to_string(frame);
            View view = strangeView(random, frame);
            QuerySettings settings;
            QueryStats stats;
            const std::vector<uint64_t> both = sortedKeys(now, view, settings, &stats);
            settings.second_look = false;
            const std::vector<uint64_t> faces = sortedKeys(now, view, settings);
            settings.faces = false;
            const std::vector<uint64_t> rough = sortedKeys(now, view, settings);
            // What a closer look culls is not drawn, and may leave in what it would have hidden: seldom.
            std::vector<uint64_t> more;
            std::set_difference(both.begin(), both.end(), faces.begin(), faces.end(), std::back_inserter(more));
            left_in += more.size();
            EXPECT_TRUE(std::includes(rough.begin(), rough.end(), faces.begin(), faces.end())) << what;
            const std::vector<uint8_t> seen = made.seen(view, 3);
            for (uint64_t key = 0; key < seen.size(); ++key)
                EXPECT_TRUE(!seen[key] || std::binary_search(both.begin(), both.end(), key))
                    << what << " object " << key;
            EXPECT_EQ(stats.visible, both.size());
            by_faces += stats.faces_culled;
            by_triangles += stats.second_look_culled;
            kept += both.size();
            rough_kept += rough.size();
        }
    }
    EXPECT_GT(by_faces, 100u);
    EXPECT_GT(by_triangles, 300u);
    EXPECT_LT(10 * kept, 8 * rough_kept);
    EXPECT_LE(1000 * left_in, kept);
}

TEST(SecondLook, RemembersWhatWasOpen) {
    // A way through a world that changes, with a memory and without: what is seen stays, and less is asked.
    uint64_t kept = 0, kept_alone = 0, asked = 0, asked_alone = 0;
    for (uint64_t seed = 1; seed <= rounds(12, 3); ++seed) {
        BarWorld made(seed);
        Random random(seed);
        Query query;
        glm::dvec3 eye{random.uniform(-12, 12), random.uniform(-4, 4), random.uniform(-12, 12)};
        glm::dvec3 step{random.uniform(-0.1, 0.1), 0, random.uniform(-0.1, 0.1)};
        for (int frame = 0; frame < 24; ++frame) {
            if (frame % 3 == 2)  // some objects move, and with them the places of others
                for (int i = 0; i < 6; ++i) {
                    const size_t object = random.below(made.transforms.size());
                    made.transforms[object][3] += glm::dvec4{random.uniform(-2, 2), 0, random.uniform(-2, 2), 0};
                    made.world.move(made.ids[object], made.transforms[object]);
                }
            eye = frame == 12 ? -eye : eye + step;  // and once it is elsewhere
            View view = viewAt(eye, {3 * step.x, 0, 3 * step.z}, {frame % 8 == 7 ? 100.0 : 50.0, 320, 180});
            const Snapshot now = made.world.commit();
            const std::string what = "seed " + std::to_string(seed) + " frame " + std::to_string(frame);
            const VisibleSet set = expectSound(made, query, now, view, {.unasked_answers = 0}, what);
            QueryStats alone;
            kept_alone += sortedKeys(now, view, {.stateless = true}, &alone).size();
            kept += set.objects.size();
            asked += set.stats.faces_tested + set.stats.second_look_polygons;
            asked_alone += alone.faces_tested + alone.second_look_polygons;
        }
    }
    EXPECT_LE(1000 * kept, 1004 * kept_alone);
    EXPECT_LT(10 * asked, 9 * asked_alone);
    RecordProperty("asked", std::to_string(asked) + " of " + std::to_string(asked_alone));
}

TEST(SecondLook, IsTheSameOnEveryInstructionSet) {
    BarWorld made(3);
    const Snapshot now = made.world.commit();
    std::vector<std::vector<uint64_t>> all;
    forEachTarget([&](const std::string&) {
        std::vector<uint64_t> keys;
        Random random(7);
        for (int frame = 0; frame < 6; ++frame)
            for (const uint64_t key : sortedKeys(now, strangeView(random, frame))) keys.push_back(key);
        all.push_back(keys);
    });
    for (const auto& keys : all) EXPECT_EQ(keys, all[0]);
}

TEST(SecondLook, ASpentBudgetKeepsMoreAndSaysSo) {
    BarWorld made(5);
    const Snapshot now = made.world.commit();
    Random random(5);
    View view = strangeView(random, 0);
    QuerySettings settings;
    QueryStats stats;
    const std::vector<uint64_t> all = sortedKeys(now, view, settings, &stats);
    EXPECT_FALSE(stats.second_look_spent);
    settings.second_look_polygons = static_cast<uint32_t>(stats.second_look_polygons / 2);
    const std::vector<uint64_t> some = sortedKeys(now, view, settings, &stats);
    EXPECT_TRUE(stats.second_look_spent);
    EXPECT_LE(stats.second_look_polygons, settings.second_look_polygons);
    EXPECT_TRUE(std::includes(some.begin(), some.end(), all.begin(), all.end()));
    EXPECT_GT(some.size(), all.size());
}

TEST(SecondLook, WithoutTheFrustumStageKeepsWhatIsOutside) {
    BarWorld made(6);
    const Snapshot now = made.world.commit();
    Random random(6);
    for (int frame = 0; frame < 6; ++frame) {
        View view = strangeView(random, frame);
        QuerySettings settings;
        const std::vector<uint64_t> both = sortedKeys(now, view, settings);
        settings.stages = stageBit(Stage::kOcclusion);
        const std::vector<uint64_t> occlusion = sortedKeys(now, view, settings);
        EXPECT_TRUE(std::includes(occlusion.begin(), occlusion.end(), both.begin(), both.end()));
    }
}

TEST(SecondLook, IsExplainedRightly) {
    LawCount sum;
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        BarWorld made(seed);
        const Snapshot now = made.world.commit();
        Random random(seed);
        for (int frame = 0; frame < 3; ++frame) {
            Laws laws(now, strangeView(random, frame), {},
                      "seed " + std::to_string(seed) + " frame " + std::to_string(frame));
            laws.expectTrueOfSome(random, 12);
            sum.add(laws.count);
            if (HasFailure()) return;
        }
    }
    EXPECT_GT(sum.by_look, 30u);
    EXPECT_GT(sum.occluded, 60u);
    EXPECT_GT(sum.open_pixels, 60u);
    sum.record();
}

}  // namespace
}  // namespace sightline::test
