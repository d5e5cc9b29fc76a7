// Certificates that are damaged on purpose are reported.
// SPDX-License-Identifier: MIT
#include "sightline/frame/validate_proofs.h"

#include <gtest/gtest.h>

#include "tests/support/debug_asserts.h"
#include "tests/support/made_world.h"
#include "tests/support/views.h"

namespace sightline::test {
namespace {

using detail::Pending;
using detail::ProofMemory;

TEST(ValidateProofsDeathTest, ReportsEachKindOfDamage) {
    MadeWorld made;
    const ObjectId wall = made.add({-4, -3, -6}, {4, 3, -5}), behind = made.add({-1, -1, -9}, {1, 1, -8});
    const Snapshot now = made.world.commit();
    detail::Frame frame;
    frame.begin(now, viewAt({0, 0, 0}, {0, 0, -1}, {60.0, 320, 180}), {});
    ProofMemory proofs(defaultMemory());
    proofs.begin(frame);
    const uint32_t place = now.state().placeOf(behind);
    const detail::HidingPart part{wall, 0, {}};
    proofs.propose(frame, Pending::Kind::kObject, place, {&part, 1});
    detail::validateProofs(proofs);
    const auto expectReport = [&](const char* text, const auto& damage) {
        expectDebugAssert(text, [&] {
            damage();
            detail::validateProofs(proofs);
        });
    };
    const detail::PlaceRange places{place, 1, 0};
    detail::Certificate too_long, unknown;
    too_long.count = detail::Certificate::kMost + 1;
    unknown.count = 1;
    unknown.hiders[0] = 77;
    expectReport("kMost", [&] { proofs.culled.push_back({places, too_long}); });
    expectReport("hider < hiders", [&] { proofs.culled.push_back({places, unknown}); });
    expectReport("places.count", [&] { proofs.culled.push_back({{place, 0, 0}, {}}); });
    expectReport("kCluster", [&] { proofs.hidden.push_back({{}, place, Pending::Kind::kCluster, {}}); });
    expectReport("found", [&] { proofs.found = proofs.sought + 1; });
}

}  // namespace
}  // namespace sightline::test
