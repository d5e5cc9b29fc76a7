// Explanations are true: objects moved, occluders removed and specks added change the answer as was said.
// SPDX-License-Identifier: MIT
#include "sightline/run/explain.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/run/explain_laws.h"
#include "tests/run/made_world.h"

namespace sightline::test {
namespace {

/// A view of one of several kinds.
View randomView(Random& random, int kind) {
    View view;
    view.width = 320;
    view.height = 180;
    const glm::dvec3 eye(random.uniform(-20, 20), random.uniform(-4, 4), random.uniform(-20, 20));
    const glm::dvec3 direction(random.uniform(-1, 1), random.uniform(-0.5, 0.5), random.uniform(-1, 1));
    view.view = lookAt(eye, eye + direction, {0, 1, 0});
    const double far = kind % 2 ? 25.0 : std::numeric_limits<double>::infinity();
    view.projection = perspective(glm::radians(random.uniform(20, 100)), 16.0 / 9.0, 0.1, far);
    if (kind % 3 == 1) view.projection = orthographic(random.uniform(4, 20), 16.0 / 9.0, 0.1, far);
    if (kind % 3 == 2) {
        view.projection[2][0] = random.uniform(-0.7, 0.7);
        view.projection[2][1] = random.uniform(-0.5, 0.5);
    }
    if (kind % 5 == 3) view.occlusion_size = 128;
    if (kind % 7 == 4) view.jitter = 3;
    return view;
}

void printCount(const LawCount& c) {
    std::printf(
        "verdicts %llu planes %llu off-screen %llu occluded %llu (insufficient %llu, outside too %llu, hiders %llu) "
        "without %llu "
        "(hidden again %llu) open %llu (covered %llu) doubts %llu together %llu\n",
        (unsigned long long)c.verdicts, (unsigned long long)c.planes, (unsigned long long)c.off_screen,
        (unsigned long long)c.occluded, (unsigned long long)c.insufficient, (unsigned long long)c.outside_too,
        (unsigned long long)c.hiders, (unsigned long long)c.without, (unsigned long long)c.hidden_again,
        (unsigned long long)c.open_pixels, (unsigned long long)c.covered, (unsigned long long)c.doubts,
        (unsigned long long)c.with_nodes);
}

void add(LawCount& sum, const LawCount& c) {
    uint64_t* to = &sum.verdicts;
    const uint64_t* from = &c.verdicts;
    for (size_t i = 0; i < sizeof(LawCount) / sizeof(uint64_t); ++i) to[i] += from[i];
}

TEST(Explain, IsTrueInRandomWorlds) {
    LawCount sum;
    for (uint64_t seed = 1; seed <= 24; ++seed) {
        MadeWorld made;
        made.fill(seed, seed % 2 ? 300 : 60, seed % 6 == 5 ? glm::dvec3(0, 40, 0) : glm::dvec3(0));
        const Snapshot now = made.world.commit();
        Random random(seed);
        for (int frame = 0; frame < 4; ++frame) {
            const int kind = static_cast<int>(seed) * 4 + frame;
            Laws laws(now, randomView(random, kind),
                      "seed " + std::to_string(seed) + " frame " + std::to_string(frame));
            for (int i = 0; i < 60; ++i) laws.expectTrue(static_cast<uint32_t>(random.below(now.objectCount())));
            add(sum, laws.count);
            if (testing::Test::HasFailure()) return;
        }
    }
    printCount(sum);
}

}  // namespace
}  // namespace sightline::test
