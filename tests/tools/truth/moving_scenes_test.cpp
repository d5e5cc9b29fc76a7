// A query that remembers, in worlds whose walls move, vanish and come back: each cull of each answer is proved.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "sightline/query/query.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/truth/cull_proof.h"
#include "test_scenes.h"
#include "tests/support/answers.h"
#include "tests/support/random.h"
#include "tests/support/views.h"

namespace sightline {
using namespace tools;
namespace {

using namespace test;

/// Rooms of slabs and panels, with boxes between them, around the origin.
Scene slabs(Random& random) {
    Scene scene = emptyScene();
    const uint32_t slab = addBox(scene, {3, 2, 0.1f}), panel = addSquare(scene, 2, 1), one_sided = addSquare(scene, 2);
    const uint32_t box = addBox(scene, glm::vec3(0.3f));
    const auto place = [&] { return randomVector(random, {12, 2, 12}); };
    for (int i = 0; i < 40; ++i) {
        const glm::dmat4 turned = glm::rotate(moved(place()), 1.5707963267948966 * double(random.below(4)), {0, 1, 0});
        addObject(scene, i % 3 == 0 ? slab : i % 3 == 1 ? panel : one_sided, turned);
    }
    for (int i = 0; i < 120; ++i)
        addObject(scene, box, glm::rotate(moved(place()), random.uniform(0, 6), randomUnit(random)));
    return scene;
}

struct MovingTotals {
    uint64_t answers = 0, undrawn = 0, culled = 0, by_certificates = 0, proved = 0;
};

/// Walks through the scene, with a leap now and then, and moves what it meets on the way.
/// @param movers  so many of the first objects, which hide, may move
void walkAndProve(Scene scene, uint32_t movers, uint64_t seed, int frames, MovingTotals& totals) {
    Random random(seed);
    LoadedWorld loaded = loadWorld(scene);
    Query query;
    const Box3d bounds = worldBounds(scene);
    const glm::dmat4 gone = moved({1e4, 0, 0});
    glm::dvec3 eye = bounds.center(), ahead = randomUnit(random);
    for (int frame = 0; frame < frames; ++frame) {
        if (random.below(25) == 0) {
            eye = bounds.center() + 0.3 * randomVector(random, bounds.size());
            ahead = glm::normalize(randomVector(random, {1, 0.2, 1}));
        }
        eye += 0.05 * ahead;
        ahead = glm::normalize(ahead + randomVector(random, 0.05));
        for (uint64_t i = random.below(3) ? 0 : random.below(4); i > 0; --i) {
            const auto object = static_cast<uint32_t>(random.below(movers));
            glm::dmat4& transform = scene.objects[object].transform;
            switch (random.below(3)) {
                case 0:
                    transform[3] += glm::dvec4(randomVector(random, 0.4), 0);
                    break;
                case 1:
                    transform = glm::rotate(transform, random.uniform(-0.2, 0.2), {0, 1, 0});
                    break;
                default:
                    transform = gone;
            }
            ASSERT_TRUE(loaded.world.move(loaded.ids[object], transform));
        }
        constexpr double kNear[] = {0.01, 0.1, 1.5};
        View view = viewFrom(eye, ahead, {frame / 50 % 2 ? 40.0 : 90.0, 320, 180, kNear[frame / 40 % 3]});
        QuerySettings settings;
        if (seed % 4 == 3) settings.bins = 3;
        const Snapshot now = loaded.world.commit();
        const QueryStats stats = query.visible(now, view, settings).stats;
        ++totals.answers;
        totals.undrawn += stats.occluder_triangles == 0;
        totals.by_certificates += stats.proved;
        const std::vector<uint8_t> reasons = reasonsOf(query, now);
        const SceneFacts facts(scene);
        CullProver prover(facts, view);
        for (uint32_t object = 0; object < reasons.size(); ++object) {
            if (reasons[object] == 0) continue;
            ++totals.culled;
            const CullProof proof = prover.prove(object);
            totals.proved += proof.result == ProofResult::kProved;
            EXPECT_EQ(int(proof.result), int(ProofResult::kProved))
                << "seed " << seed << ", frame " << frame << ", object " << object << " by stage "
                << reasons[object] - 1 << " at (" << proof.x << ", " << proof.y << "), " << proof.width << " wide";
        }
    }
}

TEST(MovingScenes, CullNothingThatIsNotProved) {
    MovingTotals slabbed, built;
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        Random random(seed);
        walkAndProve(slabs(random), 40, seed, 200, slabbed);
    }
    walkAndProve(makeBuilding(1, 1), 200, 7, 60, built);
    EXPECT_GT(slabbed.by_certificates, 1000u);
    EXPECT_GT(slabbed.undrawn, slabbed.answers / 10);
    for (const MovingTotals* totals : {&slabbed, &built}) {
        EXPECT_EQ(totals->proved, totals->culled);
        EXPECT_GT(totals->culled, 10000u);
    }
    RecordProperty("culled", static_cast<int>(slabbed.culled + built.culled));
    RecordProperty("by_certificates", static_cast<int>(slabbed.by_certificates + built.by_certificates));
}

}  // namespace
}  // namespace sightline
