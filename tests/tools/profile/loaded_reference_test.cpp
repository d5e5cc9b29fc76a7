// Loads of the reference renderer: one stage has more to do, and the others exactly what they had.
// SPDX-License-Identifier: MIT
#include "sightline/tools/profile/loaded_reference.h"

#include <gtest/gtest.h>

#include "tests/studies/hidden/made_lists.h"

namespace sightline::test {
using namespace studies;
using namespace tools;
namespace {

struct Drawn {
    int submitted = 0;
    uint64_t bytes = 0;
    HiddenCounters counters;
};

bool sameWork(const HiddenCounters& a, const HiddenCounters& b) {
    return a.geometry.triangles == b.geometry.triangles && a.geometry.produced == b.geometry.produced &&
           a.tested == b.tested && a.passed == b.passed;
}

class LoadedReferenceTest : public testing::Test {
protected:
    Drawn drawn(const StageLoads& loads, bool stream = false) {
        Drawn out;
        LoadedReference renderer({.threads = 1, .stream = stream});
        const std::vector<DrawItem> items = made_.items();
        const auto submit = [&]() -> std::span<const DrawItem> {
            ++out.submitted;
            return items;
        };
        const FrameTimes times = renderer.draw(view_, submit, loads);
        EXPECT_GT(times.wall, 0);
        EXPECT_EQ(times.gpu, 0.0);  // there is none
        out.bytes = renderer.bytes();
        out.counters = renderer.counters();
        return out;
    }

    MadeList made_ = clutter(1, 500, 0.5);
    View view_ = madeView(320, 180);
};

TEST_F(LoadedReferenceTest, EachLoadMovesItsOwnStageAlone) {
    const Drawn plain = drawn({});
    EXPECT_EQ(plain.submitted, 1);
    EXPECT_EQ(plain.bytes, sizeof(glm::mat4));
    const Drawn cpu = drawn(StageLoads::of(FrameStage::kCpu, 3));
    EXPECT_EQ(cpu.submitted, 3);
    EXPECT_EQ(cpu.bytes, plain.bytes);
    EXPECT_TRUE(sameWork(cpu.counters, plain.counters));
    const Drawn bus = drawn(StageLoads::of(FrameStage::kBus, 2.5));
    EXPECT_EQ(bus.submitted, 1);
    EXPECT_EQ(bus.bytes, 5 * plain.bytes / 2);
    EXPECT_TRUE(sameWork(bus.counters, plain.counters));
    const Drawn transform = drawn(StageLoads::of(FrameStage::kTransform, 2));
    EXPECT_EQ(transform.submitted, 1);
    EXPECT_EQ(transform.bytes, plain.bytes);
    EXPECT_TRUE(sameWork(transform.counters, plain.counters));
    const Drawn fill = drawn(StageLoads::of(FrameStage::kFill, 4));
    EXPECT_EQ(fill.submitted, 1);
    EXPECT_EQ(fill.bytes, plain.bytes);
    EXPECT_EQ(fill.counters.geometry.triangles, plain.counters.geometry.triangles);
    EXPECT_NEAR(double(fill.counters.passed), 4.0 * double(plain.counters.passed), 0.05 * double(fill.counters.passed));
}

TEST_F(LoadedReferenceTest, StreamsMeshes) {
    const DrawItem item = made_.items()[0];
    const uint64_t mesh = item.mesh.positions.size_bytes() + item.mesh.indices.size_bytes();
    EXPECT_EQ(drawn({}, true).bytes, sizeof(glm::mat4) + mesh);
    EXPECT_EQ(drawn(StageLoads::of(FrameStage::kBus, 2), true).bytes, 2 * (sizeof(glm::mat4) + mesh));
}

TEST_F(LoadedReferenceTest, PixelsGrowInTheSameShape) {
    const View twice = withPixels(view_, 2), hardly = withPixels(view_, 1e-9);
    EXPECT_NEAR(double(twice.width) * twice.height, 2.0 * view_.width * view_.height,
                0.01 * view_.width * view_.height);
    EXPECT_NEAR(double(twice.width) / twice.height, double(view_.width) / view_.height, 0.01);
    EXPECT_EQ(hardly.width, 1u);
    EXPECT_EQ(hardly.height, 1u);
}

TEST_F(LoadedReferenceTest, CountsFragmentsHiddenOrNot) {
    const std::vector<DrawItem> once = made_.items();
    std::vector<DrawItem> twice = once;
    twice.push_back(once[0]);
    EXPECT_EQ(countFragments(twice, view_, 1), 2 * countFragments(once, view_, 1));
    EXPECT_EQ(countFragments({}, view_, 1), 0u);
}

TEST_F(LoadedReferenceTest, DrawsAnEmptyList) {
    LoadedReference renderer;
    const auto nothing = [] { return std::span<const DrawItem>(); };
    for (int stage = 0; stage < kFrameStages; ++stage) {
        renderer.draw(view_, nothing, StageLoads::of(static_cast<FrameStage>(stage), 2));
        EXPECT_EQ(renderer.bytes(), 0u);
    }
}

}  // namespace
}  // namespace sightline::test
