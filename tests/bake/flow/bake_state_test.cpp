// States of bakes as bytes: the same bake goes on, and nothing else is taken for one.
// SPDX-License-Identifier: MIT
#include "sightline/bake/flow/bake_state.h"

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "tests/bake/flow/cell_worlds.h"

namespace sightline {
using namespace bake;
namespace {

using namespace test;

/// The bytes at one of the checkpoints.
std::string bytesOf(const CellGraph& graph, uint64_t budget, uint64_t checkpoint) {
    std::string bytes;
    CellVisibilitySettings settings;
    settings.budget = budget;
    settings.checkpoint = [&](const CellVisibilityState& state) {
        if (checkpoint-- == 0) bytes = bakeStateBytes(state, hashOf(graph), budget);
    };
    bakeCellVisibility(graph, settings);
    return bytes;
}

TEST(BakeState, GoesOnToTheSameAnswer) {
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        const CellGraph graph = gridOfRooms(seed, {});
        const CellVisibility whole = bakeCellVisibility(graph);
        for (const uint64_t checkpoint : {0, 1, 2}) {
            const std::string bytes = bytesOf(graph, 0, checkpoint);
            if (bytes.empty()) continue;
            Result<CellVisibilityState> state = readBakeState(bytes, "x.state", graph, 0);
            ASSERT_TRUE(state.ok()) << state.error().message;
            CellVisibilitySettings settings;
            settings.resume = &*state;
            const CellVisibility rest = bakeCellVisibility(graph, settings);
            EXPECT_EQ(rest.visible, whole.visible);
            EXPECT_EQ(rest.witnessed, whole.witnessed);
            EXPECT_EQ(rest.steps, whole.steps);
            EXPECT_EQ(rest.empty_chains, whole.empty_chains);
        }
    }
}

TEST(BakeState, RefusesWhatIsNotItsOwn) {
    const CellGraph graph = gridOfRooms(1, {}), other = gridOfRooms(2, {});
    const std::string bytes = bytesOf(graph, 5, 0);
    ASSERT_FALSE(bytes.empty());
    const auto said = [&](std::span<const char> read, const CellGraph& of, uint64_t budget) {
        const Result<CellVisibilityState> state = readBakeState(read, "x.state", of, budget);
        return state ? std::string() : state.error().message;
    };
    EXPECT_EQ(said(bytes, graph, 5), "");
    EXPECT_EQ(said(bytes, other, 5), "x.state: the state of another bake");
    EXPECT_FALSE(readBakeState(bytes, "x.state", graph, 5, 100.0).ok());
    EXPECT_EQ(said(bytes, graph, 6), "x.state: the state of a bake with another budget");
    EXPECT_EQ(said({}, graph, 5), "x.state: no state of a bake");
    for (size_t length = 0; length < bytes.size(); length += 1 + length / 16)
        EXPECT_NE(said(std::span<const char>(bytes).first(length), graph, 5), "") << length;
    Random random(1);
    for (int i = 0; i < 2000; ++i) {
        std::string changed = bytes;
        changed[random.below(changed.size())] ^= static_cast<char>(1 + random.below(255));
        EXPECT_NE(said(changed, graph, 5), "") << i;
    }
}

}  // namespace
}  // namespace sightline
