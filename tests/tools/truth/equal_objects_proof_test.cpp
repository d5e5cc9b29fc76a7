// Exact proofs of objects that are equal, coincide, or lie in one plane.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/cull_proof.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/tools/truth/scene_facts.h"
#include "test_scenes.h"
#include "tests/support/random.h"
#include "tests/tools/truth/object_proofs.h"

namespace sightline {
using namespace tools;
namespace {

using namespace test;

TEST(CullProofs, EqualDepthIsVisible) {
    Scene scene = emptyScene();
    const uint32_t small = addSquare(scene, 1), large = addSquare(scene, 3);
    addObject(scene, large, moved({0, 0, -5}));
    addObject(scene, small, moved({0, 0, -5}));
    EXPECT_NE(int(prove(scene, usualView(), 1).result), int(ProofResult::kProved));
    scene.objects[1].transform = moved({0, 0, std::nextafter(-5.0, -6.0)});  // behind by what a double can tell
    EXPECT_HIDDEN(scene, usualView(), 1);
}

/// How often proofs of all objects ask whether to stop: what they cost.
uint64_t workOf(const Scene& scene) {
    uint64_t asked = 0;
    const SceneFacts facts(scene);
    CullProver prover(facts, usualView(), 1000000, [&] {
        ++asked;
        return false;
    });
    for (uint32_t object = 0; object < scene.objects.size(); ++object) prover.prove(object);
    return asked;
}

TEST(CullProofs, OfEqualObjectsCostWhatOneCosts) {
    const auto pileOf = [](int copies) {
        Scene scene = emptyScene();
        const uint32_t box = addBox(scene, glm::vec3(0.4f)), again = addBox(scene, glm::vec3(0.4f));
        for (int i = 0; i < copies; ++i) addObject(scene, i % 3 ? box : again, moved({0.2, 0.1, -4}));
        return scene;
    };
    const uint64_t of_two = workOf(pileOf(2));
    EXPECT_GT(of_two, 0u);
    EXPECT_EQ(workOf(pileOf(400)), of_two);
}

/// Squares in one plane, each larger than the one before: all are seen, and none hides another.
TEST(CullProofs, DoNotHoldThePartsOfAPlaneAgainstOneAnother) {
    for (const bool as_boxes : {false, true}) {
        Scene scene = emptyScene();
        constexpr uint32_t kSheets = 60;
        for (uint32_t i = 0; i < kSheets; ++i) {
            const float half = 0.3f + 0.01f * static_cast<float>(i);
            addObject(scene, as_boxes ? addBox(scene, {half, half, 0.5f}) : addSquare(scene, half), moved({0, 0, -4}));
        }
        const SceneFacts facts(scene);
        CullProver prover(facts, usualView());
        for (uint32_t i = 0; i < kSheets; ++i) {
            const CullProof proof = prover.prove(i);
            EXPECT_EQ(int(proof.result), int(ProofResult::kSeen)) << i;
            EXPECT_LT(proof.cuts, 8u) << i;
        }
    }
}

/// What is proved with copies of some objects in the scene is what is proved without.
TEST(CullProofs, AreTheSameBesideCopies) {
    Random random(11);
    uint64_t hidden = 0, seen = 0;
    for (uint64_t seed = 1; seed <= 40; ++seed) {
        Scene plain = emptyScene();
        for (int i = 0; i < 12; ++i) {
            std::vector<glm::vec3> positions;
            for (int k = 0; k < 9; ++k) positions.push_back(randomVector(random, 1.5f));
            const uint32_t mesh = addMesh(plain, positions, {0, 1, 2, 3, 4, 5, 6, 7, 8}, uint32_t(random.below(4)));
            addObject(plain, mesh, moved(randomVector(random, 3.0) - glm::dvec3(0, 0, 6)));
        }
        addObject(plain, addSquare(plain, 2.5f), moved({0, 0, -4}));
        Scene copied = plain;
        std::vector<uint32_t> original(plain.objects.size());
        for (uint32_t i = 0; i < original.size(); ++i) original[i] = i;
        for (int i = 0; i < 30; ++i) {
            const auto from = uint32_t(random.below(plain.objects.size()));
            SceneObject copy = plain.objects[from];
            if (random.below(2)) {  // the same triangles in a mesh of its own
                copied.meshes.push_back(copied.meshes[copy.mesh]);
                copy.mesh = static_cast<uint32_t>(copied.meshes.size() - 1);
            }
            copied.objects.push_back(copy);
            original.push_back(from);
        }
        const SceneFacts facts(plain), with_copies(copied);
        CullProver prover(facts, usualView()), of_copies(with_copies, usualView());
        const std::vector<uint8_t> together = of_copies.hiddenTogether();
        for (uint32_t i = 0; i < original.size(); ++i) {
            EXPECT_EQ(with_copies.firstEqual(i), original[i]);
            const CullProof expected = prover.prove(original[i]), proof = of_copies.prove(i);
            EXPECT_EQ(int(proof.result), int(expected.result)) << "seed " << seed << " object " << i;
            EXPECT_FALSE(together[i] && proof.result != ProofResult::kProved) << "seed " << seed << " object " << i;
            hidden += proof.result == ProofResult::kProved;
            seen += proof.result == ProofResult::kSeen;
            if (proof.result != ProofResult::kProved) continue;
            // A copy hides as well as its original.
            Objects hiders;
            for (uint32_t k = 0; k < original.size(); ++k)
                if (std::binary_search(proof.hiders.begin(), proof.hiders.end(), original[k]) &&
                    (k >= plain.objects.size() || !with_copies.hasEqual(k)))
                    hiders.push_back(k);
            EXPECT_EQ(int(of_copies.proveBy(i, hiders).result), int(ProofResult::kProved)) << "seed " << seed;
        }
    }
    EXPECT_GT(hidden, 200u);
    EXPECT_GT(seen, 200u);
}

TEST(CullProofs, TellEqualObjectsFromThoseThatHideOtherwise) {
    // A pane stands where the wall does, before it in the file: the wall hides nevertheless.
    for (const uint32_t pane : {2u, 3u, 4u}) {
        for (const bool wall_too : {true, false}) {
            Scene scene = emptyScene();
            addObject(scene, addSquare(scene, 2, pane), moved({0, 0, -5}));
            if (wall_too) addObject(scene, addSquare(scene, 2), moved({0, 0, -5}));
            const uint32_t behind = addObject(scene, addBox(scene, glm::vec3(0.3f)), moved({0, 0, -8}));
            EXPECT_EQ(int(prove(scene, usualView(), behind).result),
                      int(wall_too ? ProofResult::kProved : ProofResult::kSeen));
        }
    }
}

}  // namespace
}  // namespace sightline
