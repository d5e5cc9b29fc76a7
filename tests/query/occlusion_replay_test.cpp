// A recorded frame is replayed with the same answers, on every instruction set; and what differs is noticed.
// SPDX-License-Identifier: MIT
#include "sightline/query/record/occlusion_replay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "tests/query/made_recording.h"
#include "tests/support/targets.h"

namespace sightline::test {
namespace {

OcclusionRecording callsOf(uint64_t seed) {
    MadeWorld made = someWorld(seed);
    return std::move(*recordOcclusion(made.world.commit(), someView(seed), someSettings(seed)));
}

/// With two tests of tiles beside those that the walk made, and the answers that they get.
OcclusionRecording withTiles(OcclusionRecording recording) {
    OcclusionReplay replay(recording);
    replay.run();
    replay.tiles().log = &recording.asked;
    for (uint32_t tile : {replay.tiles().stride + 1, 2 * replay.tiles().stride + 3}) {
        float nearest[64];
        for (int i = 0; i < 64; ++i) nearest[i] = 0.01f * static_cast<float>(i);
        openPixels(replay.tiles(), tile, 0x00ffff0012345678u, nearest);
        uint32_t& noted = recording.asked.tiles.back().tile;
        noted = noted / replay.tiles().stride * replay.tiles().columns + noted % replay.tiles().stride;
    }
    replay.tiles().log = nullptr;
    return recording;
}

TEST(OcclusionReplay, GivesTheSameAnswersOnEveryInstructionSet) {
    size_t draws = 0, instances = 0;
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        const OcclusionRecording recording = callsOf(seed);
        draws += recording.draws.size();
        instances += recording.instances.size();
        EXPECT_LE(recording.occluders.size(), 4u);
        const auto hidden = std::count_if(recording.asked.rects.begin(), recording.asked.rects.end(),
                                          [](const TileLog::RectTest& test) { return test.hidden; });
        EXPECT_GT(hidden, 5);
        OcclusionReplay replay(recording);
        uint64_t triangles = 0;
        forEachTarget([&](const std::string& target) {
            const ReplayAnswer answer = replay.run();
            EXPECT_TRUE(answer.same()) << target << ", seed " << seed << ": "
                                       << describeTest(recording, answer.different);
            EXPECT_EQ(answer.hidden, static_cast<uint64_t>(hidden));
            if (triangles == 0) triangles = answer.triangles;
            EXPECT_EQ(answer.triangles, triangles);
        });
    }
    EXPECT_GT(draws, 150u);
    EXPECT_GT(instances, 100u);
}

TEST(OcclusionReplay, IsOfTheFrameThatAQuerySees) {
    MadeWorld made = someWorld(9);
    const Snapshot now = made.world.commit();
    const View view = someView(9);
    const QuerySettings settings = someSettings(9);
    Query query;
    const VisibleSet set = query.visible(now, view, settings);
    const Result<OcclusionRecording> recording = recordOcclusion(now, view, settings);
    ASSERT_TRUE(recording.ok());
    OcclusionReplay replay(*recording);
    EXPECT_EQ(replay.run().triangles, set.stats.occluder_triangles);
    // What the buffer of the query claims at the end, the replay's claims.
    const Query::DepthImage image = query.depthImage();
    ASSERT_EQ(image.width, replay.tiles().width);
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x) {
            const float claimed = image.nearness[size_t{y} * image.width + x];
            const int32_t px = static_cast<int32_t>(x), py = static_cast<int32_t>(y);
            ASSERT_FALSE(isHidden(replay.tiles(), {px, py, px, py, claimed}, Seams::kLeave)) << x << ", " << y;
        }
}

TEST(OcclusionReplay, NoticesAnAnswerThatIsNotTheSame) {
    OcclusionRecording recording = withTiles(callsOf(2));
    EXPECT_TRUE(OcclusionReplay(recording).run().same());
    recording.asked.tiles.back().open ^= 0x10;
    ReplayAnswer answer = OcclusionReplay(recording).run();
    EXPECT_EQ(answer.differences, 1u);
    EXPECT_EQ(answer.different, recording.asked.calls.size() - 1);
    EXPECT_NE(describeTest(recording, answer.different).find("tile at (24, 16)"), std::string::npos)
        << describeTest(recording, answer.different);
    recording.asked.rects[3].hidden = !recording.asked.rects[3].hidden;
    answer = OcclusionReplay(recording).run();
    EXPECT_EQ(answer.differences, 2u);
    EXPECT_NE(describeTest(recording, answer.different).find("rectangle"), std::string::npos);
}

TEST(OcclusionReplay, IsOfUsableViewsWithAnOcclusionStage) {
    World world;
    EXPECT_TRUE(recordOcclusion(world.commit(), View()).ok());
    EXPECT_FALSE(recordOcclusion(world.commit(), View(), {.stages = stageBit(Stage::kFrustum)}).ok());
    View view;
    view.projection[0][0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(recordOcclusion(world.commit(), view).ok());
}

}  // namespace
}  // namespace sightline::test
