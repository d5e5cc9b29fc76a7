// The plan shows each object in the colour of what culled it.
// SPDX-License-Identifier: MIT
#include "sightline/report/plan.h"

#include <gtest/gtest.h>

namespace sightline {
namespace {

Box3d boxAt(double x, double z, double half) {
    Box3d box;
    box.grow(glm::dvec3(x - half, 0, z - half));
    box.grow(glm::dvec3(x + half, 2 * half, z + half));
    return box;
}

TEST(Plan, ColoursObjectsByWhatCulledThem) {
    const std::vector<Box3d> bounds = {boxAt(20, 20, 4), boxAt(80, 20, 4), boxAt(20, 80, 4)};
    const std::vector<uint8_t> reasons = {0, 1, 2};
    View view;
    view.view = lookAt({60, 1, 60}, {60, 1, 200}, {0, 1, 0});
    view.projection = perspective(1, 1.5, 0.1);
    const Image<glm::u8vec4> plan = drawPlan(bounds, reasons, view, {0, 0, 100}, 100);
    EXPECT_EQ(plan.at(20, 20), kPlanPalette[0]);
    EXPECT_EQ(plan.at(80, 20), kPlanPalette[1]);
    EXPECT_EQ(plan.at(20, 80), kPlanPalette[2]);
    EXPECT_EQ(plan.at(50, 10).w, 0);
    EXPECT_GT(plan.at(60, 60).w, 0);  // the eye
}

TEST(Plan, SmallObjectsLieOnTopOfLargeOnes) {
    const std::vector<Box3d> bounds = {boxAt(50, 50, 3), boxAt(50, 50, 20)};
    View view;
    view.view = lookAt({5, 1, 5}, {5, 1, -90}, {0, 1, 0});
    view.projection = perspective(1, 1.5, 0.1);
    const Image<glm::u8vec4> plan = drawPlan(bounds, std::vector<uint8_t>{2, 0}, view, {0, 0, 100}, 100);
    EXPECT_EQ(plan.at(50, 50), kPlanPalette[2]);
    EXPECT_EQ(plan.at(40, 40), kPlanPalette[0]);
}

TEST(Plan, TakesBoundsThatAreNotFiniteAndNoObjects) {
    View view;
    view.projection = perspective(1, 1.5, 0.1);
    Box3d endless;
    endless.grow(glm::dvec3(0));
    endless.max.x = std::numeric_limits<double>::infinity();
    EXPECT_EQ(drawPlan(std::vector<Box3d>{endless}, std::vector<uint8_t>{0}, view, {0, 0, 1}, 8).width, 8u);
    EXPECT_GT(planArea({}, {}, {}).side, 0);
    EXPECT_GT(planArea({}, {}, std::vector<View>{view}).side, 0);
}

TEST(Plan, AreaHoldsWhatWasVisible) {
    std::vector<Box3d> bounds;
    std::vector<uint8_t> reasons;
    for (int i = 0; i < 100; ++i) {
        bounds.push_back(boxAt(i * 10, 0, 1));
        reasons.push_back(i >= 10 && i < 20 ? 0 : 1);
    }
    View view;
    view.view = lookAt({150, 1, 0}, {150, 1, -9}, {0, 1, 0});
    const std::span<const uint8_t> frame = reasons;
    const PlanArea area = planArea(bounds, std::span(&frame, 1), std::span(&view, 1));
    EXPECT_LE(area.x, 100);
    EXPECT_GE(area.x + area.side, 190);
    EXPECT_LE(area.side, 300);
}

}  // namespace
}  // namespace sightline
