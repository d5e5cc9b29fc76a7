// Occlusion queries on a real GL: the image of all items, whatever is asked, at any size of the image.
// SPDX-License-Identifier: MIT
#include "apps/gl/queries.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "apps/gl/renderers.h"
#include "sightline/cull/queries/occlusion_queries.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/report/pictures/render_list.h"
#include "tests/cull/queries/queried_world.h"
#include "tests/support/shared_scenes.h"

namespace sightline::test {
namespace {

constexpr int kMethods = kQueryMethods;

class GlQueries : public testing::Test {
protected:
    void SetUp() override {
        if (!context_) GTEST_SKIP() << context_.error().message;
    }
    Result<GlContext> context_ = GlContext::create(1);
};

/// A device for what is asked and one for all, and the driver's id-buffer by another program.
class GlHeld {
public:
    GlHeld(const GlContext& context, std::span<const DrawItem> items, GlQueryKind kind)
        : list_(items),
          asked_(GlQueryDevice::create(context, items, kind)),
          all_(GlQueryDevice::create(context, items, kind)),
          ids_(GlIdRenderer::create(context, list_)) {}

    bool good() const { return asked_.ok() && all_.ok() && ids_.ok(); }

    void hold(OcclusionQueries& queries, const PlacedBvh& tree, std::span<const uint32_t> here, const View& view,
              const OcclusionQuerySettings& settings, const std::string& what) {
        ASSERT_TRUE(asked_->beginFrame(view).ok()) << what;
        const std::span<const uint32_t> drawn = queries.draw(tree, view, *asked_, settings);
        ASSERT_TRUE(asked_->endFrame().ok()) << what;
        const std::set<uint32_t> kept(drawn.begin(), drawn.end());
        EXPECT_EQ(kept.size(), drawn.size()) << what;
        const Result<std::vector<uint32_t>> shown = asked_->readItems(), depths = asked_->readDepths();

        ASSERT_TRUE(all_->beginFrame(view).ok()) << what;
        all_->draw(here);
        ASSERT_TRUE(all_->endFrame().ok()) << what;
        const Result<std::vector<uint32_t>> all_shown = all_->readItems(), all_depths = all_->readDepths();
        ASSERT_TRUE(shown.ok() && depths.ok() && all_shown.ok() && all_depths.ok());
        EXPECT_EQ(*depths, *all_depths) << what;
        size_t missed = 0;
        for (const uint32_t item : *all_shown) missed += item != GlQueryDevice::kNone && !kept.contains(item);
        EXPECT_EQ(missed, 0u) << what << ": pixels of items that were not drawn";

        if (here.size() == list_.items().size()) {
            ASSERT_TRUE(ids_->draw(view).ok()) << what;
            const Result<HiddenImage> image = ids_->read();
            ASSERT_TRUE(image.ok());
            for (const uint32_t surface : image->surface)
                if (surface != HiddenImage::kNone) missed += !kept.contains(list_.placeOf(surface).item);
            EXPECT_EQ(missed, 0u) << what << ": of the id-buffer";
        }
        drawn_ += drawn.size();
    }
    size_t drawn() const { return drawn_; }

private:
    DrawList list_;
    Result<GlQueryDevice> asked_, all_;
    Result<GlIdRenderer> ids_;
    size_t drawn_ = 0;
};

TEST_F(GlQueries, DrawTheImageOfAllItemsInAWalkWithCutsMoversAndDoors) {
    for (int method = 0; method < kMethods; ++method) {
        QueriedWorld world(11, 400);
        GlHeld held(*context_, world.items(), method % 2 ? GlQueryKind::kAny : GlQueryKind::kSamples);
        ASSERT_TRUE(held.good());
        OcclusionQueries queries;
        OcclusionQuerySettings settings;
        settings.method = static_cast<QueryMethod>(method);
        settings.rounding.depth_step = 0;
        settings.leaf_items = method == 2 ? 4 : 1;
        Random random(12);
        View view = randomView(random, {60, 192, 108, 0.1, {0, 1, 0}});
        for (int frame = 0; frame < 200; ++frame) {
            if (frame % 25 == 24) view = randomView(random, {60, 192, 108, 0.1, {0, 1, 0}});
            else view.view = glm::dmat4(glm::dmat3(lookAt({0, 0, 0}, {0.02, 0, -1}, {0, 1, 0}))) * view.view;
            world.change();
            if (frame % 50 == 49) world.rebuild();
            held.hold(queries, world.tree(), world.here(), view, settings,
                      std::string(kQueryMethodNames[method]) + " frame " + std::to_string(frame));
            if (HasFailure()) return;
        }
    }
}

/// Depth that runs from the far plane to the near one, and parallel views.
TEST_F(GlQueries, HoldForEveryKindOfProjection) {
    const QueriedWorld world(15, 400);
    GlHeld held(*context_, world.items(), GlQueryKind::kSamples);
    ASSERT_TRUE(held.good());
    Random random(16);
    for (const QueryMethod method : {QueryMethod::kStopAndWait, QueryMethod::kChcPlusPlus}) {
        OcclusionQueries queries;
        OcclusionQuerySettings settings;
        settings.method = method;
        settings.rounding.depth_step = 0;
        for (int frame = 0; frame < 60; ++frame) {
            View view = randomView(random, {60, 192, 108, 1.0, {0, 1, 0}});
            if (frame % 3 == 1) view.projection = perspective(1.0, 192.0 / 108, 1.0, 30.0);
            if (frame % 3 == 2) view.projection = orthographic(15, 192.0 / 108, 1.0, 60.0);
            if (frame % 2 == 1)
                for (int column = 0; column < 4; ++column) view.projection[column][2] = -view.projection[column][2];
            held.hold(queries, world.tree(), world.here(), view, settings, "frame " + std::to_string(frame));
        }
    }
}

TEST_F(GlQueries, HoldForMeshesFarFromTheirOrigin) {
    // Coordinates of a whole country, as surveyors give them.
    const QueriedWorld world(17, 300);
    const glm::dvec3 away(1048576.0, 65536.0, -524288.0);
    std::vector<std::vector<glm::vec3>> positions;
    std::vector<DrawItem> items(world.items().begin(), world.items().end());
    for (DrawItem& item : items) {
        positions.emplace_back();
        for (const glm::vec3& position : item.mesh.positions)
            positions.back().push_back(glm::vec3(glm::dvec3(position) + away));
        item.transform[3] -= item.transform * glm::dvec4(away, 0.0);
    }
    for (size_t i = 0; i < items.size(); ++i) items[i].mesh.positions = positions[i];
    GlHeld held(*context_, items, GlQueryKind::kAny);
    ASSERT_TRUE(held.good());
    Random random(18);
    OcclusionQueries queries;
    OcclusionQuerySettings settings;
    settings.rounding.depth_step = 0;
    for (int frame = 0; frame < 30; ++frame)
        held.hold(queries, world.tree(), world.here(), randomView(random, {60, 192, 108, 0.1, {0, 1, 0}}), settings,
                  "frame " + std::to_string(frame));
}

TEST_F(GlQueries, HoldAtAnySizeOfTheImage) {
    const QueriedWorld world(13, 300);
    constexpr uint32_t kSizes[][2] = {{1, 1}, {2, 1}, {1, 7}, {31, 33}, {257, 129}, {641, 479}, {2049, 1151}};
    Random random(14);
    for (const auto& size : kSizes)
        for (const QueryMethod method : {QueryMethod::kChc, QueryMethod::kChcPlusPlus}) {
            GlHeld held(*context_, world.items(), GlQueryKind::kAny);
            ASSERT_TRUE(held.good());
            OcclusionQueries queries;
            OcclusionQuerySettings settings;
            settings.method = method;
            settings.rounding.depth_step = 0;
            for (int frame = 0; frame < (size[0] > 2000 ? 3 : 12); ++frame) {
                const View view = randomView(random, {60, size[0], size[1], 0.1, {0, 1, 0}});
                held.hold(queries, world.tree(), world.here(), view, settings,
                          std::to_string(size[0]) + "x" + std::to_string(size[1]));
            }
        }
}

TEST_F(GlQueries, HoldOnRealScenes) {
    bool any = false;
    for (const char* name : {"bsi-duplex", "gazebo-willowgarage", "2CylinderEngine"}) {
        const std::optional<Scene> scene = sharedScene(name);
        if (!scene) continue;
        any = true;
        const RenderList all(*scene, View());
        std::vector<Box3d> boxes;
        std::vector<uint32_t> numbers;
        for (const DrawItem& item : all.casters()) {
            numbers.push_back(static_cast<uint32_t>(numbers.size()));
            boxes.push_back(transformBox(scene->meshes[scene->objects[item.id].mesh].bounds, item.transform));
        }
        WorldBvh tree;
        tree.build(boxes, numbers);
        const CameraPath path = seededCameras(*scene, 12, 5);
        for (const QueryMethod method : {QueryMethod::kChc, QueryMethod::kChcPlusPlus}) {
            GlHeld held(*context_, all.casters(), GlQueryKind::kSamples);
            ASSERT_TRUE(held.good());
            OcclusionQueries queries;
            OcclusionQuerySettings settings;
            settings.method = method;
            settings.rounding.depth_step = 0;
            for (size_t frame = 0; frame < path.frames.size(); ++frame)
                held.hold(queries, tree.now(), numbers, makeView(path.frames[frame], 320, 180), settings,
                          std::string(name) + " frame " + std::to_string(frame));
            EXPECT_LT(held.drawn(), path.frames.size() * numbers.size());
        }
    }
    if (!any) GTEST_SKIP() << "no scenes beside the repository";
}

}  // namespace
}  // namespace sightline::test
