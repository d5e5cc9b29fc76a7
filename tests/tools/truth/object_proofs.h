// A proof of one object, made anew, and the view that most tests of proofs look through.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/tools/truth/cull_proof.h"
#include "sightline/tools/truth/scene_facts.h"
#include "tests/support/views.h"

namespace sightline::test {
using namespace tools;

using Objects = std::vector<uint32_t>;

inline View usualView() { return viewBy(perspective(1.0, 4.0 / 3, 0.1), 320, 240); }

inline CullProof prove(const Scene& scene, const View& view, uint32_t object) {
    const SceneFacts facts(scene);
    return CullProver(facts, view).prove(object);
}

#define EXPECT_HIDDEN(...) EXPECT_EQ(int(prove(__VA_ARGS__).result), int(ProofResult::kProved))
#define EXPECT_SEEN(...) EXPECT_EQ(int(prove(__VA_ARGS__).result), int(ProofResult::kSeen))

}  // namespace sightline::test
