// Loads of the GL: one stage has more to do, and the others what they had, by the GL's own counters.
// SPDX-License-Identifier: MIT
#include "apps/gl/loaded_gl.h"

#include <gtest/gtest.h>

#include "apps/gl/renderers.h"
#include "sightline/tools/profile/draw_costs.h"
#include "tests/studies/hidden/made_lists.h"

namespace sightline::test {
using namespace studies;
using namespace tools;
namespace {

class LoadedGlTest : public testing::Test {
protected:
    void SetUp() override {
        if (!context_) GTEST_SKIP() << context_.error().message;
        for (int i = 0; i < 3; ++i) {
            items_.push_back(made_.items()[0]);
            items_.back().transform[3] = glm::dvec4(0.5 * i, 0, -i, 1);
            items_.back().id = static_cast<uint32_t>(10 + i);
        }
    }
    SubmitFrame all() {
        return [this]() -> std::span<const DrawItem> {
            ++submitted_;
            return items_;
        };
    }

    Result<GlContext> context_ = GlContext::create(1);
    MadeList made_ = clutter(1, 300, 0.5);
    View view_ = madeView(320, 180);
    std::vector<DrawItem> items_;
    int submitted_ = 0;
};

TEST_F(LoadedGlTest, EachLoadMovesItsOwnStageAlone) {
    Result<LoadedGl> gl = LoadedGl::create(*context_, items_);
    ASSERT_TRUE(gl.ok()) << gl.error().message;
    struct Frame {
        GlStatistics statistics;
        uint64_t bytes = 0;
        int submitted = 0;
    };
    const auto drawn = [&](const StageLoads& loads) {
        Frame frame;
        submitted_ = 0;
        const FrameTimes times = gl->draw(view_, all(), loads);
        EXPECT_GT(times.wall, 0);
        EXPECT_LE(times.gpu.value_or(-1), times.wall);
        frame.submitted = submitted_;
        frame.bytes = gl->bytes();
        frame.statistics = gl->count(view_, all(), loads);
        EXPECT_TRUE(gl->status().ok()) << gl->status().error().message;
        return frame;
    };
    const Frame plain = drawn({});
    EXPECT_EQ(plain.submitted, 1);
    EXPECT_EQ(plain.bytes, 3 * sizeof(glm::mat4));
    EXPECT_GT(plain.statistics.samples_passed, uint64_t{view_.width} * view_.height / 10);
    const Frame cpu = drawn(StageLoads::of(FrameStage::kCpu, 3));
    EXPECT_EQ(cpu.submitted, 3);
    EXPECT_EQ(cpu.bytes, plain.bytes);
    EXPECT_EQ(cpu.statistics.samples_passed, plain.statistics.samples_passed);
    const Frame bus = drawn(StageLoads::of(FrameStage::kBus, 2));
    EXPECT_EQ(bus.bytes, 2 * plain.bytes);
    EXPECT_EQ(bus.statistics.samples_passed, plain.statistics.samples_passed);
    const Frame transform = drawn(StageLoads::of(FrameStage::kTransform, 2));
    EXPECT_EQ(transform.bytes, plain.bytes);
    EXPECT_EQ(transform.statistics.samples_passed, plain.statistics.samples_passed);
    const Frame fill = drawn(StageLoads::of(FrameStage::kFill, 4));
    EXPECT_EQ(fill.submitted, 1);
    EXPECT_EQ(fill.bytes, plain.bytes);
    EXPECT_NEAR(double(fill.statistics.samples_passed), 4.0 * double(plain.statistics.samples_passed),
                0.05 * double(fill.statistics.samples_passed));
    if (!plain.statistics.vertices) return;  // a driver without these counters
    EXPECT_NEAR(double(*transform.statistics.vertices), 2.0 * double(*plain.statistics.vertices),
                0.01 * double(*plain.statistics.vertices));
    EXPECT_EQ(*fill.statistics.vertices, *plain.statistics.vertices);
    EXPECT_EQ(*bus.statistics.vertices, *plain.statistics.vertices);
    EXPECT_LE(*cpu.statistics.vertices, *plain.statistics.vertices + 2 * 3 * 3);  // a point more a call
    EXPECT_GE(*transform.statistics.triangles, *plain.statistics.triangles);
}

TEST_F(LoadedGlTest, StreamsVertices) {
    Result<LoadedGl> gl = LoadedGl::create(*context_, items_, {.stream = true});
    ASSERT_TRUE(gl.ok()) << gl.error().message;
    gl->draw(view_, all(), StageLoads::of(FrameStage::kBus, 2));
    const uint64_t once = 3 * (sizeof(glm::mat4) + items_[0].mesh.positions.size_bytes());
    EXPECT_EQ(gl->bytes(), 2 * once);
    EXPECT_TRUE(gl->status().ok()) << gl->status().error().message;
}

// It draws what the id-buffer shows: as many samples of it as pass there in the same order.
TEST_F(LoadedGlTest, DrawsTheItemsOfTheListThatItKnows) {
    Result<LoadedGl> gl = LoadedGl::create(*context_, std::span(items_).first(1));
    ASSERT_TRUE(gl.ok()) << gl.error().message;
    const DrawList list(std::span<const DrawItem>(items_).first(1));
    RenderSettings settings;
    settings.depth.hierarchy = false;
    const HiddenImage image = render(list, view_, settings);
    const GlStatistics known = gl->count(view_, all());
    EXPECT_NEAR(double(known.samples_passed), double(image.counters.passed), 0.02 * double(image.counters.passed));
    const GlStatistics nothing = gl->count(view_, [] { return std::span<const DrawItem>(); });
    EXPECT_EQ(nothing.samples_passed, 0u);
    View huge = view_;
    huge.width = 1u << 20;
    gl->draw(huge, all(), {});
    EXPECT_TRUE(gl->status().ok()) << "sides are cut to what an image may have";
}

TEST_F(LoadedGlTest, CostsAreAboveNothing) {
    Result<LoadedGl> gl = LoadedGl::create(*context_, items_);
    ASSERT_TRUE(gl.ok()) << gl.error().message;
    const CostView seen{view_, items_};
    DrawCostSettings settings;
    settings.rounds = 2;
    const DrawCosts costs = measureDrawCosts(*gl, {&seen, 1}, settings);
    EXPECT_GE(costs.samples, 8u);
    EXPECT_GT(costs.object + costs.triangle + costs.vertex + costs.pixel + costs.sample + costs.frame, 0);
}

}  // namespace
}  // namespace sightline::test
