// The plan shows each object in the colour of what culled it.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/plan.h"

#include <gtest/gtest.h>

namespace sightline {
using namespace tools;
namespace {

Box3d boxAt(double x, double z, double half) {
    Box3d box;
    box.grow(glm::dvec3(x - half, 0, z - half));
    box.grow(glm::dvec3(x + half, 2 * half, z + half));
    return box;
}

PlanArea square(double side) {
    PlanArea area;
    area.width = area.height = side;
    return area;
}

TEST(Plan, ColoursObjectsByWhatCulledThem) {
    const std::vector<Box3d> bounds = {boxAt(20, 20, 4), boxAt(80, 20, 4), boxAt(20, 80, 4)};
    const std::vector<uint8_t> reasons = {0, 1, 2};
    View view;
    view.view = lookAt({60, 1, 60}, {60, 1, 200}, {0, 1, 0});
    view.projection = perspective(1, 1.5, 0.1);
    const Image<glm::u8vec4> plan = drawPlan(bounds, reasons, view, square(100), {}, 100);
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
    const Image<glm::u8vec4> plan = drawPlan(bounds, std::vector<uint8_t>{2, 0}, view, square(100), {}, 100);
    EXPECT_EQ(plan.at(50, 50), kPlanPalette[2]);
    EXPECT_EQ(plan.at(40, 40), kPlanPalette[0]);
}

TEST(Plan, TakesBoundsThatAreNotFiniteAndNoObjects) {
    View view;
    view.projection = perspective(1, 1.5, 0.1);
    Box3d endless;
    endless.grow(glm::dvec3(0));
    endless.max.x = std::numeric_limits<double>::infinity();
    EXPECT_EQ(drawPlan(std::vector<Box3d>{endless}, std::vector<uint8_t>{0}, view, square(1), {}, 8).width, 8u);
    EXPECT_GT(planArea({}, {}, {}).width, 0);
    EXPECT_GT(planArea({}, {}, std::vector<View>{view}).width, 0);
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
    EXPECT_LE(area.left, 100);
    EXPECT_GE(area.left + area.width, 190);
    EXPECT_LE(area.width, 300);
}

TEST(Plan, AreaShowsTheWorldRatherThanEmptinessBesideIt) {
    std::vector<Box3d> bounds;
    std::vector<uint8_t> reasons;
    for (int i = 0; i < 100; ++i) {
        bounds.push_back(boxAt(i * 10, 0, 1));
        reasons.push_back(i < 60 ? 0 : 1);  // the middle of what is seen lies left of the world's
    }
    View view;
    view.view = lookAt({5, 1, 0}, {5, 1, -9}, {0, 1, 0});
    const std::span<const uint8_t> frame = reasons;
    const PlanArea area = planArea(bounds, std::span(&frame, 1), std::span(&view, 1));
    EXPECT_GE(area.left, -1 - 0.05 * area.width);
    EXPECT_GE(area.left + area.width, 590);
}

/// Slabs at 0, 3 and 6, and a desk on each floor.
std::vector<Box3d> twoFloors() {
    std::vector<Box3d> bounds;
    for (const double y : {0.0, 3.0, 6.0}) {
        Box3d slab;
        slab.grow(glm::dvec3(0, y, 0));
        slab.grow(glm::dvec3(20, y + 0.2, 20));
        bounds.push_back(slab);
    }
    for (const double y : {0.2, 3.2}) {
        Box3d desk;
        desk.grow(glm::dvec3(5, y, y + 5));
        desk.grow(glm::dvec3(7, y + 1, y + 7));
        bounds.push_back(desk);
    }
    return bounds;
}

TEST(Plan, FindsTheStoreyOfTheEye) {
    const auto bounds = twoFloors();
    const PlanBand low = storeyOf(bounds, {10, 1.7, 10}), high = storeyOf(bounds, {10, 4.7, 10});
    EXPECT_EQ(low.low, 0.2);
    EXPECT_EQ(low.high, 3);
    EXPECT_EQ(high.low, 3.2);
    EXPECT_EQ(high.high, 6);
    EXPECT_EQ(storeyOf(bounds, {10, 9, 10}).high, std::numeric_limits<double>::infinity());
    EXPECT_TRUE(storeyOf(bounds, {100, 1, 100}).whole());
    EXPECT_TRUE(storeyOf({}, {0, 0, 0}).whole());
}

TEST(Plan, ShowsWhatLiesOffTheStoreyPale) {
    const auto bounds = twoFloors();
    View view;
    view.view = lookAt({15, 1.7, 15}, {15, 1.7, 30}, {0, 1, 0});
    view.projection = perspective(1, 1.5, 0.1);
    const auto plan =
        drawPlan(bounds, std::vector<uint8_t>(5, 0), view, square(20), storeyOf(bounds, {15, 1.7, 15}), 200);
    EXPECT_EQ(plan.at(60, 58), kPlanPalette[0]);      // the desk on this floor
    EXPECT_LT(plan.at(60, 98).w, kPlanPalette[0].w);  // the one above
    EXPECT_GT(plan.at(60, 98).w, 0);
}

TEST(Plan, SectionShowsHeightsAlongTheView) {
    const auto bounds = twoFloors();
    View view;
    view.view = lookAt({1, 1.7, 6}, {9, 1.7, 6.5}, {0, 1, 0});
    view.projection = perspective(1, 1.5, 0.1);
    const std::vector<uint8_t> reasons(5, 0);
    const std::span<const uint8_t> frame = reasons;
    const PlanArea plan = planArea(bounds, std::span(&frame, 1), std::span(&view, 1));
    const PlanArea section = sectionArea(bounds, reasons, view, plan);
    EXPECT_EQ(section.across, 0);
    EXPECT_EQ(section.through(), 2);
    EXPECT_GE(section.top, 6.2);
    EXPECT_LE(section.top - section.height, 0);
    EXPECT_GE(sectionStretch(section), 1);
    const auto picture = drawPlan(bounds, reasons, view, section, sliceOf(section, {1, 1.7, 6}), 240);
    EXPECT_EQ(picture.width, 240u);
    EXPECT_EQ(picture.height, 100u);
    View along_z = view;
    along_z.view = lookAt({1, 1.7, 6}, {1, 1.7, 9}, {0, 1, 0});
    EXPECT_EQ(sectionArea(bounds, reasons, along_z, plan).across, 2);
}

}  // namespace
}  // namespace sightline
