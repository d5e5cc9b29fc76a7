// The law of boxes in float, eight at a time: none that shares a point with the volume is culled, and few others are kept.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "sightline/cull/frustum.h"
#include "tests/cull/long_tests.h"
#include "tests/studies/frustum/clip_oracle.h"
#include "tests/support/targets.h"

namespace sightline {
namespace {

using test::Touch;
using test::TruthVolume;

constexpr int kNodesPerVolume = 12, kVolumes = 20;  // between two instruction sets

/// The planes of a volume as a frustum, where there are few enough.
Frustum frustumOf(const ViewVolume& volume) {
    Frustum frustum;
    frustum.eye = volume.eye;
    frustum.count = volume.count;
    for (uint32_t i = 0; i < volume.count; ++i) frustum.planes[i] = volume.planes[i];
    return frustum;
}

struct Node {
    Box3d boxes[8];
    EyeBoxes seen;
};

struct Case {
    TruthVolume truth;
    RefinedVolume refined;
    Node nodes[kNodesPerVolume];
    double band = 0;  ///< what hangs on less is not decided  [world units]
};

Case randomCase(Random& random, double far) {
    Case made;
    made.truth = test::randomVolume(random, far);
    made.refined = refineVolume(made.truth.volume);
    made.band = 1e-10 * (100.0 + far);
    for (Node& node : made.nodes) {
        const glm::dvec3 origin = made.truth.volume.eye + random.uniform(0, 300) * test::randomUnit(random);
        BvhNode bounds{};
        for (int slot = 0; slot < 8; ++slot) {
            node.boxes[slot] = test::randomBox(random, made.truth);
            const Box3f box = roundOutward(node.boxes[slot], origin);
            for (int axis = 0; axis < 3; ++axis) {
                bounds.min[axis][slot] = box.min[axis];
                bounds.max[axis][slot] = box.max[axis];
            }
            bounds.count[slot] = 1;
        }
        node.seen = eyeBoxes(bounds, origin - made.truth.volume.eye);
    }
    return made;
}

/// A bit per box that is surely outside: of the planes, and of what refines them.
struct Answer {
    uint32_t planes = 0, refined = 0;
    bool operator==(const Answer&) const = default;
};

Answer ask(const Case& asked, const Node& node) {
    const ViewVolume& volume = asked.truth.volume;
    const FrustumAnswer answer = testViewVolume(volume, node.seen, volume.allPlanes());
    EXPECT_EQ(outsideAny({volume.planes, volume.count}, node.seen), answer.outside);
    if (volume.count <= 6) { EXPECT_EQ(testFrustum(frustumOf(volume), node.seen, 63).outside, answer.outside); }
    const uint32_t axes = outsideAny({asked.refined.axes, asked.refined.axis_count}, node.seen);
    return {answer.outside,
            answer.outside | axes | outsideAny({asked.refined.crossed, asked.refined.crossed_count}, node.seen)};
}

TEST(FrustumPairs, NoBoxThatTouchesIsCulledAndFewOthersAreKept) {
    const int pairs = test::pairsToMake(100000);
    Random random(41);
    uint64_t made = 0, together = 0, apart = 0, kept = 0, kept_refined = 0;
    for (int round = 0; made < static_cast<uint64_t>(pairs) && !HasFailure(); ++round) {
        std::vector<Case> cases;
        for (int i = 0; i < kVolumes; ++i) cases.push_back(randomCase(random, i % 4 == 3 ? 1e6 : 1.0));
        std::vector<Answer> expected;
        test::forEachTarget([&](const std::string& target) {
            std::vector<Answer> answers;
            for (const Case& asked : cases)
                for (const Node& node : asked.nodes) answers.push_back(ask(asked, node));
            if (expected.empty()) expected = answers;
            ASSERT_EQ(answers, expected) << target << " round " << round;
        });
        size_t at = 0;
        for (const Case& asked : cases)
            for (const Node& node : asked.nodes) {
                const Answer& answer = expected[at++];
                for (int slot = 0; slot < 8; ++slot, ++made) {
                    const test::Body body = test::bodyOf(node.boxes[slot]);
                    const Touch touch = test::touch(body, asked.truth, asked.band + 1e-11 * body.size);
                    const bool by_planes = !(answer.planes >> slot & 1), by_all = !(answer.refined >> slot & 1);
                    if (touch == Touch::kTogether) {
                        ASSERT_TRUE(by_planes) << "round " << round;
                        ASSERT_TRUE(by_all) << "round " << round;
                    }
                    together += touch == Touch::kTogether;
                    apart += touch == Touch::kApart;
                    kept += touch == Touch::kApart && by_planes;
                    kept_refined += touch == Touch::kApart && by_all;
                }
            }
    }
    RecordProperty("pairs", static_cast<int>(made));
    RecordProperty("together", static_cast<int>(together));
    RecordProperty("apart", static_cast<int>(apart));
    RecordProperty("kept_apart", static_cast<int>(kept));
    RecordProperty("kept_apart_refined", static_cast<int>(kept_refined));
    EXPECT_GT(together, apart / 10);
    EXPECT_GT(kept, apart / 100);        // there is something to refine
    EXPECT_LT(kept_refined, kept / 20);  // what float cannot tell is left
}

}  // namespace
}  // namespace sightline
