// Laws of a doorway as a window of images.
// SPDX-License-Identifier: MIT
#include "sightline/images/portal_frame.h"

#include <limits>

#include <gtest/gtest.h>

#include "sightline/studies/hidden/render.h"
#include "tests/images/doorway_room.h"

namespace sightline::test {
namespace {

TEST(PortalFrame, IsUprightAndFacesTheViewerWhicheverWayItsOutlineRuns) {
    std::vector<glm::dvec3> corners = {{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0}};
    for (int turned = 0; turned < 2; ++turned, std::reverse(corners.begin(), corners.end()))
        for (const double side : {-1.0, 1.0}) {
            const auto frame = portalFrame(corners, {7, 5, side});
            ASSERT_TRUE(frame);
            EXPECT_EQ(frame->front, glm::dvec3(0, 0, side));
            EXPECT_EQ(frame->up, glm::dvec3(0, 1, 0));
            EXPECT_EQ(frame->right, glm::dvec3(side, 0, 0));
            EXPECT_DOUBLE_EQ(frame->width, 1);
            EXPECT_DOUBLE_EQ(frame->height, 2);
            EXPECT_EQ(frame->corner, glm::dvec3(side > 0 ? 0 : 1, 0, 0));
            EXPECT_TRUE(frame->holds({0.5, 1}));
            EXPECT_TRUE(frame->holds({0, 0})) << "touching counts as inside";
            EXPECT_FALSE(frame->holds({1.01, 1}));
        }
}

TEST(PortalFrame, HoldsItsOutlineInItsRectangle) {
    Random random(1);
    for (int i = 0; i < 300; ++i) {
        const AnyDoorway any(random);
        for (const glm::dvec2& p : any.frame.outline) {
            EXPECT_GE(p.x, -1e-9);
            EXPECT_GE(p.y, -1e-9);
            EXPECT_LE(p.x, any.frame.width + 1e-9);
            EXPECT_LE(p.y, any.frame.height + 1e-9);
        }
        const glm::dvec3 own = randomVector(random, 5.0);
        EXPECT_LT(glm::length(any.frame.toFrame(any.frame.toWorld(own)) - own), 1e-12 * 100);
    }
}

TEST(PortalFrame, RefusesWhatIsNoDoorway) {
    const auto refused = [](const std::vector<glm::dvec3>& corners, const glm::dvec3& seen_from = {0, 0, 1}) {
        return !portalFrame(corners, seen_from).ok();
    };
    EXPECT_TRUE(refused({}));
    EXPECT_TRUE(refused({{0, 0, 0}, {1, 0, 0}}));
    EXPECT_TRUE(refused({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}})) << "no area";
    EXPECT_TRUE(refused({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}));
    EXPECT_TRUE(refused({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}})) << "bent";
    EXPECT_TRUE(refused({{0, 0, 0}, {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}})) << "not convex";
    EXPECT_TRUE(refused({{0, 0, 0}, {1, 0, 0}, {std::numeric_limits<double>::quiet_NaN(), 1, 0}}));
    const std::vector<glm::dvec3> good = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
    EXPECT_FALSE(refused(good));
    EXPECT_TRUE(refused(good, {5, 5, 0})) << "the viewer stands in its plane";
    EXPECT_TRUE(refused(good, {0, 0, std::numeric_limits<double>::infinity()}));
}

TEST(PortalFrame, TakesADoorwayThatLiesFlat) {
    const std::vector<glm::dvec3> hatch = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}};
    const auto frame = portalFrame(hatch, {0, 3, 0});
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->front, glm::dvec3(0, 1, 0));
    EXPECT_NEAR(glm::dot(glm::cross(frame->right, frame->up), frame->front), 1, 1e-12);
}

TEST(PortalFrame, WidenedHasTheSameTexelsAndMore) {
    const PortalFrame frame = madeDoorway(), wide = widened(frame, {0.5, 1});
    EXPECT_DOUBLE_EQ(wide.width, 2);
    EXPECT_DOUBLE_EQ(wide.height, 4);
    EXPECT_EQ(wide.corner, glm::dvec3(-0.5, -1, 0));
    EXPECT_TRUE(wide.holds({0.75, 1.5}));
    EXPECT_FALSE(wide.holds({0.25, 1.5})) << "the doorway is no larger";
}

TEST(EyePlace, TellsEyesThatImagesCannotServe) {
    const PortalFrame frame = madeDoorway();
    EXPECT_EQ(eyePlace(frame, {0.5, 1, 2}), EyePlace::kBefore);
    EXPECT_EQ(eyePlace(frame, {0.5, 1, 1e-3}), EyePlace::kBefore) << "right in the opening, but before it";
    EXPECT_EQ(eyePlace(frame, {0.5, 1, 0}), EyePlace::kInPlane);
    EXPECT_EQ(eyePlace(frame, {9, 1, -1e-9}), EyePlace::kInPlane);
    EXPECT_EQ(eyePlace(frame, {0.5, 1, -2}), EyePlace::kBehind);
    EXPECT_EQ(eyePlace(frame, {30.5, 1, 1.4}), EyePlace::kEdgeOn);
    EXPECT_EQ(eyePlace(frame, {30.5, 1, 1.6}), EyePlace::kBefore);
    EXPECT_EQ(eyePlace(frame, {0.5, std::numeric_limits<double>::quiet_NaN(), 1}), EyePlace::kNotFinite);
    for (const glm::dvec3& eye : {glm::dvec3(0.5, 1, 0), glm::dvec3(0.5, 1, -2), glm::dvec3(90, 1, 1)}) {
        const auto view = portalView(frame, eye, 8, 8);
        ASSERT_FALSE(view);
        EXPECT_EQ(view.error().message, wordsOf(eyePlace(frame, eye)));
    }
    EXPECT_FALSE(portalView(frame, {0.5, 1, 2}, 0, 8).ok());
}

TEST(PortalView, ShowsEachPieceOfTheDoorwayAtTheSamePixelToEveryEye) {
    Random random(2);
    for (int i = 0; i < 500; ++i) {
        const AnyDoorway any(random);
        const View view = *portalView(any.frame, any.eye(random), 40, 30);
        ASSERT_EQ(problemOf(view), ViewProblem::kNone);
        const glm::dvec2 share(random.uniform(), random.uniform());
        const glm::dvec3 at =
            projected(view, any.frame.toWorld({share.x * any.frame.width, share.y * any.frame.height, 0}));
        EXPECT_NEAR(at.x, 40 * share.x - 0.5, 1e-8) << "case " << i;
        EXPECT_NEAR(at.y, 30 * share.y - 0.5, 1e-8) << "case " << i;
    }
}

TEST(PortalView, DrawsOnlyWhatLiesBeyond) {
    const PortalFrame frame = madeDoorway();
    TestMesh mesh = boxMesh({0.4f, 0.9f, 0.2f}, {0.6f, 1.1f, 0.4f});  // before the doorway, in the way
    mesh.add({{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0}});           // in its plane
    const uint32_t before = static_cast<uint32_t>(mesh.view().triangles());
    mesh.add({{-5, -5, -1}, {5, -5, -1}, {0, 5, -1}});
    DrawItem item;
    item.mesh = mesh.view();
    Random random(3);
    for (int i = 0; i < 30; ++i) {
        const glm::dvec3 eye(random.uniform(-1, 2), random.uniform(0, 2), random.uniform(0.5, 3));
        const HiddenImage image = render(DrawList({&item, 1}), *portalView(frame, eye, 20, 40), {});
        for (const uint32_t surface : image.surface) EXPECT_TRUE(surface == before || surface == HiddenImage::kNone);
    }
}

}  // namespace
}  // namespace sightline::test
