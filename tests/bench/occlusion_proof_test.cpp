// The proof of the occlusion scenes: it holds for the buffer, and finds what a buffer with a fault would hide.
// SPDX-License-Identifier: MIT
#include "bench/occlusion_proof.h"

#include <algorithm>
#include <string_view>

#include <gtest/gtest.h>

namespace sightline::bench {
namespace {

ProofSettings quick() {
    ProofSettings settings;
    settings.most_cameras = 1;
    settings.pictures.jitters = 4;
    settings.pictures.threads = settings.rays.threads = 2;
    settings.rays.at_boxes = settings.rays.through_edges = 2;
    settings.rays.places = 20000;
    return settings;
}

class Proofs : public ::testing::TestWithParam<const char*> {};

// At a low resolution a pixel holds more, so that a wrong answer is more likely.
TEST_P(Proofs, HoldOnEveryInstructionSet) {
    const OcclusionScene scene = makeOcclusionScene(GetParam());
    OcclusionFrame frame(scene);
    const OcclusionProof proof = proveOcclusion(scene, frame, BoxWitness(scene), 160, 96, quick());
    for (const FalseBox& box : proof.false_boxes)
        ADD_FAILURE() << GetParam() << ": box " << box.box << " is seen at " << box.pixel.x << ", " << box.pixel.y
                      << " by " << box.witness;
    for (const OcclusionProof::Target& target : proof.targets) {
        EXPECT_EQ(proof.differing(target), 0u) << GetParam() << " on " << target.name;
        EXPECT_EQ(target.hash(), proof.targets.front().hash());
    }
    EXPECT_GT(proof.hidden_full, 10u);
    EXPECT_EQ(proof.samples, 160u * 96u * 16u * 4u);
    EXPECT_GT(proof.rays, proof.hidden_full);
}

INSTANTIATE_TEST_SUITE_P(Occlusion, Proofs,
                         ::testing::Values("city", "indoor", "terrain", "soup-side", "wall-grid-0", "wall-brick-0.01",
                                           "wall-tilted-0", "wall-tilted-0.1"));

// A buffer that takes a wall for whole where it has gaps: a fault as large as a tenth of a pixel.
TEST(OcclusionProof, FindsWhatIsHiddenByAWallWithoutItsGaps) {
    const OcclusionScene whole = makeOcclusionWall(WallBond::kGrid, 0);
    const OcclusionScene with_gaps = makeOcclusionWall(WallBond::kGrid, 0.1);
    OcclusionFrame frame(whole);
    const BoxWitness witness(with_gaps);
    ProofSettings settings = quick();
    settings.every_target = false;
    const auto prove = [&](uint32_t jitters, uint32_t rays) {
        settings.pictures.jitters = jitters;
        settings.rays.at_boxes = settings.rays.through_edges = rays;
        return proveOcclusion(with_gaps, frame, witness, 320, 180, settings);
    };
    const OcclusionProof by_samples = prove(4, 0), by_rays = prove(0, 2);
    EXPECT_GT(by_samples.false_full, 100u);
    EXPECT_GT(by_rays.false_full, 100u);
    EXPECT_EQ(by_samples.rays, 0u);
    EXPECT_EQ(by_rays.samples, 0u);
    EXPECT_TRUE(std::all_of(by_rays.false_boxes.begin(), by_rays.false_boxes.end(),
                            [](const FalseBox& box) { return std::string_view(box.witness) == "rays"; }));
    for (const FalseBox& box : by_samples.false_boxes) {
        ASSERT_STREQ(box.witness, "samples");
        ASSERT_TRUE(box.full || box.masked);
        ASSERT_TRUE(box.pixel.x >= 0 && box.pixel.x <= 320 && box.pixel.y >= 0 && box.pixel.y <= 180);
    }
}

}  // namespace
}  // namespace sightline::bench
