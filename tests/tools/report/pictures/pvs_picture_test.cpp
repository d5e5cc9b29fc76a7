// Cells lie where their portals are, in the colour of what is known of them.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/pvs_picture.h"

#include <gtest/gtest.h>

namespace sightline {
using namespace tools;
namespace {

/// Rooms of 10 x 10 in a row along x, at z from 0 to 10, with an upright portal across each whole wall between two.
CellGraph rowOfRooms(uint32_t rooms) {
    CellGraph graph;
    graph.cells = rooms;
    for (uint32_t i = 0; i + 1 < rooms; ++i) {
        const double x = 10 * (i + 1);
        const glm::dvec3 outline[] = {{x, 0, 0}, {x, 0, 10}, {x, 3, 10}, {x, 3, 0}};
        EXPECT_TRUE(graph.addPortal(i, i + 1, outline));
    }
    return graph;
}

PlanArea areaOf(double width, double height) { return {.width = width, .height = height}; }

bool near(Rgb a, Rgb b, int off) {
    return std::abs(a.x - b.x) <= off && std::abs(a.y - b.y) <= off && std::abs(a.z - b.z) <= off;
}

/// Over the paper or over the pale colour of cells.
bool isMostly(Rgb pixel, Rgb colour) { return near(pixel, colour, 70); }

TEST(PvsPicture, AreaHoldsAllPortalsWithAir) {
    const CellGraph graph = rowOfRooms(40);
    const PlanArea area = cellPlanArea(graph);
    EXPECT_LT(area.left, 10);
    EXPECT_GT(area.left + area.width, 390);
    EXPECT_LT(area.top, 0);
    EXPECT_GT(area.top + area.height, 10);
    EXPECT_LE(area.width, 4.5 * area.height);
    EXPECT_GT(cellPlanArea(CellGraph()).width, 0);
}

TEST(PvsPicture, CellsAreColouredByWhatIsKnown) {
    const CellGraph graph = rowOfRooms(6);  // the first and the last have one portal, and so no area
    const CellPlan plan(graph, areaOf(60, 10), 600);
    BitMatrix visible(6, 6), witnessed(6, 6);
    for (const size_t seen : {1, 2, 3}) visible.set(1, seen);
    witnessed.set(1, 1);
    witnessed.set(1, 2);
    const Image<Rgb> image = plan.seenFrom(1, visible, witnessed);
    ASSERT_EQ(image.width, 600u);
    ASSERT_EQ(image.height, 100u);
    EXPECT_EQ(image.at(120, 20), kAskedCellColour);
    EXPECT_TRUE(isMostly(image.at(250, 20), kWitnessedColour));
    EXPECT_TRUE(isMostly(image.at(350, 20), kUnresolvedColour));
    EXPECT_TRUE(near(image.at(450, 20), kHiddenColour, 20));
    EXPECT_EQ(image.at(50, 20), kPaperColour);
    EXPECT_EQ(image.at(550, 20), kPaperColour);
}

TEST(PvsPicture, GraphShowsPortalsAndTheWayBetweenThem) {
    const CellGraph graph = rowOfRooms(4);
    const Image<Rgb> image = CellPlan(graph, areaOf(40, 10), 400).graph();
    EXPECT_TRUE(isMostly(image.at(200, 20), kPortalColour));  // on the wall between two rooms
    EXPECT_TRUE(near(image.at(180, 20), kHiddenColour, 20));  // in the room
    EXPECT_EQ(image.at(150, 50), kWitnessedColour);           // its middle
    EXPECT_NE(image.at(175, 50), image.at(175, 30));          // from there to the portal's middle
}

TEST(PvsPicture, SightlinePassesThroughItsPortals) {
    const CellGraph graph = rowOfRooms(5);
    const std::vector<glm::dvec3> points = {{5, 1, 2}, {45, 1, 8}};
    const Image<Rgb> image = CellPlan(graph, areaOf(50, 10), 500).sightline(points, std::vector<uint32_t>{0, 1, 2, 3});
    for (const double part : {0.01, 0.2, 0.45, 0.7, 0.99}) {
        const glm::dvec3 p = points[0] + part * (points[1] - points[0]);
        EXPECT_TRUE(near(image.at(uint32_t(p.x * 10), uint32_t(p.z * 10)), kSightlineColour, 40)) << part;
    }
    EXPECT_EQ(image.at(100, 90), kAskedCellColour);  // a portal of the chain, beside the line
    EXPECT_TRUE(CellPlan(graph, areaOf(50, 10), 500).sightline({}, {}).width == 500);
}

TEST(PvsPicture, MatrixHasThreeColoursInAnyOrder) {
    BitMatrix visible(3, 3), witnessed(3, 3);
    for (size_t i = 0; i < 3; ++i) visible.set(i, i), witnessed.set(i, i);
    visible.set(0, 2), visible.set(2, 0);
    const Image<Rgb> plain = pvsMatrixPicture(visible, witnessed);
    ASSERT_EQ(plain.width, 3u);
    EXPECT_EQ(plain.at(0, 0), kWitnessedColour);
    EXPECT_EQ(plain.at(2, 0), kUnresolvedColour);
    EXPECT_EQ(plain.at(0, 1), kHiddenColour);
    const Image<Rgb> turned = pvsMatrixPicture(visible, witnessed, std::vector<uint32_t>{0, 2, 1});
    EXPECT_EQ(turned.at(1, 0), kUnresolvedColour);
    EXPECT_EQ(turned.at(2, 0), kHiddenColour);
}

TEST(PvsPicture, LargeMatrixIsTheMeanOfItsPairs) {
    BitMatrix visible(1000, 1000), witnessed(1000, 1000);
    for (size_t i = 0; i < 500; ++i)
        for (size_t k = 0; k < 1000; ++k) visible.set(i, k), witnessed.set(i, k);
    const Image<Rgb> image = pvsMatrixPicture(visible, witnessed, {}, 3);
    ASSERT_EQ(image.width, 3u);
    EXPECT_EQ(image.at(1, 0), kWitnessedColour);
    EXPECT_EQ(image.at(1, 2), kHiddenColour);
    const glm::dvec3 half = 0.5 * (glm::dvec3(kWitnessedColour) + glm::dvec3(kHiddenColour));
    EXPECT_TRUE(near(image.at(1, 1), Rgb(half), 3));
    EXPECT_EQ(pvsMatrixPicture({}, {}).width, 0u);
}

}  // namespace
}  // namespace sightline
