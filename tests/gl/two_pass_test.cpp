// Two-pass culling on a real GL: the image of all parts, at any size, after cuts and moves; and most of the rest not drawn.
// SPDX-License-Identifier: MIT
#include "apps/gl/two_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>

#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/report/pictures/render_list.h"
#include "tests/cull/queries/queried_world.h"
#include "tests/support/shared_scenes.h"

namespace sightline::test {
namespace {

class TwoPass : public testing::Test {
protected:
    void SetUp() override {
        if (!context_) GTEST_SKIP() << context_.error().message;
    }
    Result<GlContext> context_ = GlContext::create(1);
};

uint64_t sumOf(const std::vector<uint32_t>& flags) { return std::accumulate(flags.begin(), flags.end(), uint64_t{0}); }

/// Culled, and another of its kind that draws all.
class TwoPassHeld {
public:
    TwoPassHeld(const GlContext& context, std::span<const DrawItem> items, uint32_t most_triangles)
        : parts_(makeCullParts(items, most_triangles)),
          culled_(GlTwoPass::create(context, items, parts_)),
          all_(GlTwoPass::create(context, items, parts_)) {}

    bool good() const { return culled_.ok() && all_.ok(); }
    const std::vector<GlCullPart>& parts() const { return parts_; }
    void moved(std::span<const uint32_t> items) {
        culled_->moved(items);
        all_->moved(items);
    }

    void hold(const View& view, const std::string& what) {
        const Status drawn = culled_->draw(view), all_drawn = all_->drawAll(view);
        ASSERT_TRUE(drawn.ok() && all_drawn.ok()) << what;
        const Result<std::vector<uint32_t>> depths = culled_->readDepths(), all_depths = all_->readDepths(),
                                            items = all_->readItems();
        ASSERT_TRUE(depths.ok() && all_depths.ok() && items.ok()) << what;
        EXPECT_EQ(*depths, *all_depths) << what;
        const Result<GlTwoPass::Drawn> passes = culled_->readDrawn();
        ASSERT_TRUE(passes.ok()) << what;
        std::vector<uint32_t> item_drawn;
        for (size_t i = 0; i < parts_.size(); ++i) {
            // A part of both kinds of faces is drawn by two commands, each in a pass of its own.
            item_drawn.resize(std::max<size_t>(item_drawn.size(), parts_[i].item + 1), 0);
            item_drawn[parts_[i].item] |= passes->early[i] | passes->late[i];
        }
        size_t missed = 0;
        for (const uint32_t item : *items) missed += item != GlTwoPass::kNone && item_drawn[item] == 0;
        EXPECT_EQ(missed, 0u) << what << ": pixels of items that were not drawn";
        early_ += last_early_ = sumOf(passes->early);
        late_ += last_late_ = sumOf(passes->late);
        ++frames_;
    }

    uint64_t lastEarly() const { return last_early_; }
    uint64_t lastLate() const { return last_late_; }
    uint64_t early() const { return early_; }
    uint64_t late() const { return late_; }
    uint64_t everything() const { return frames_ * parts_.size(); }

private:
    std::vector<GlCullPart> parts_;
    Result<GlTwoPass> culled_, all_;
    uint64_t early_ = 0, late_ = 0, frames_ = 0, last_early_ = 0, last_late_ = 0;
};

TEST_F(TwoPass, DrawsTheImageOfAllInAWalkWithCutsAndMovers) {
    for (const uint32_t most_triangles : {0u, 2u}) {
        QueriedWorld world(21, 600);
        TwoPassHeld held(*context_, world.items(), most_triangles);
        ASSERT_TRUE(held.good());
        EXPECT_GE(held.parts().size(), most_triangles == 0 ? 600u : 2000u);
        Random random(22);
        View view = randomView(random, {60, 191, 107, 0.1, {0, 1, 0}});
        uint64_t early = 0, late = 0;  // where there was no cut
        for (int frame = 0; frame < 200; ++frame) {
            if (frame % 25 == 24) view = randomView(random, {60, 191, 107, 0.1, {0, 1, 0}});
            else view.view = glm::dmat4(glm::dmat3(lookAt({0, 0, 0}, {0.02, 0, -1}, {0, 1, 0}))) * view.view;
            View now = view;
            if (frame % 25 == 20) now.projection = orthographic(12, 191.0 / 107, -2.0, 80.0);
            held.moved(world.moveSome());
            held.hold(now, std::to_string(most_triangles) + " triangles, frame " + std::to_string(frame));
            if (HasFailure()) return;
            if (frame % 25 < 2 || frame % 25 > 19) continue;
            early += held.lastEarly();
            late += held.lastLate();
        }
        EXPECT_GT(early, 5 * late);
        EXPECT_LT(held.early() + held.late(), held.everything() / 4);
    }
}

TEST_F(TwoPass, HoldsForEveryKindOfProjection) {
    const QueriedWorld world(28, 500);
    TwoPassHeld held(*context_, world.items(), 0);
    ASSERT_TRUE(held.good());
    Random random(29);
    for (int frame = 0; frame < 90; ++frame) {
        View view = randomView(random, {60, 191, 107, 1.0, {0, 1, 0}});
        if (frame % 3 == 1) view.projection = perspective(1.0, 191.0 / 107, 1.0, 30.0);
        if (frame % 3 == 2) view.projection = orthographic(15, 191.0 / 107, 1.0, 60.0);
        if (frame % 2 == 1)
            for (int column = 0; column < 4; ++column) view.projection[column][2] = -view.projection[column][2];
        held.hold(view, "frame " + std::to_string(frame));
        held.hold(view, "frame " + std::to_string(frame) + " again");
    }
}

TEST_F(TwoPass, HoldsAtAnySizeOfTheImage) {
    const QueriedWorld world(23, 500);
    TwoPassHeld held(*context_, world.items(), 0);
    ASSERT_TRUE(held.good());
    constexpr uint32_t kSizes[][2] = {{1, 1},  {2, 1},     {1, 7},     {3, 5},     {31, 33},   {64, 64},
                                      {65, 1}, {257, 129}, {511, 300}, {512, 301}, {641, 479}, {2049, 1151}};
    Random random(24);
    for (const auto& size : kSizes)
        for (int frame = 0; frame < (size[0] > 2000 ? 3 : 20); ++frame)
            held.hold(randomView(random, {60, size[0], size[1], 0.1, {0, 1, 0}}),
                      std::to_string(size[0]) + "x" + std::to_string(size[1]));
}

TEST_F(TwoPass, HoldsFarFromTheOrigin) {
    // Places in two floats each: a metre is a metre a million of them away.
    QueriedWorld world(25, 300);
    std::vector<DrawItem> items(world.items().begin(), world.items().end());
    const glm::dvec3 away(1.0e6 + 0.3, -2.0e5, 3.0e6);
    for (DrawItem& item : items) item.transform[3] += glm::dvec4(away, 0);
    TwoPassHeld near(*context_, world.items(), 0), far(*context_, items, 0);
    ASSERT_TRUE(near.good() && far.good());
    Random random(26);
    for (int frame = 0; frame < 40; ++frame) {
        View view = randomView(random, {60, 128, 72, 0.1, {0, 1, 0}});
        near.hold(view, "near");
        view.view[3] -= glm::dvec4(glm::dmat3(view.view) * away, 0.0);
        far.hold(view, "far");
    }
    EXPECT_NEAR(double(near.early() + near.late()), double(far.early() + far.late()), 0.01 * double(near.everything()));
}

TEST_F(TwoPass, RefusesPartsThatThereAreNot) {
    const QueriedWorld world(27, 10);
    const GlCullPart beyond[] = {{3, 0, 4000}}, nobody[] = {{10, 0, 1}};
    EXPECT_FALSE(GlTwoPass::create(*context_, world.items(), beyond).ok());
    EXPECT_FALSE(GlTwoPass::create(*context_, world.items(), nobody).ok());
    TwoPassHeld nothing(*context_, {}, 0);
    ASSERT_TRUE(nothing.good());
    nothing.hold(viewFrom({0, 0, 0}, {1, 0, 0}), "nothing");
}

TEST_F(TwoPass, HoldsOnRealScenes) {
    bool any = false;
    for (const char* name : {"bsi-duplex", "gazebo-willowgarage", "sauer-pandora"}) {
        const std::optional<Scene> scene = sharedScene(name);
        if (!scene) continue;
        any = true;
        const RenderList all(*scene, View());
        const CameraPath path = seededCameras(*scene, 10, 6);
        for (const uint32_t most_triangles : {0u, 128u}) {
            TwoPassHeld held(*context_, all.casters(), most_triangles);
            ASSERT_TRUE(held.good());
            for (const CameraFrame& frame : path.frames) {
                const View view = makeView(frame, 321, 181);
                held.hold(view, name);
                held.hold(view, name);
            }
            EXPECT_LT(held.early() + held.late(), held.everything()) << name;
        }
    }
    if (!any) GTEST_SKIP() << "no scenes beside the repository";
}

}  // namespace
}  // namespace sightline::test
