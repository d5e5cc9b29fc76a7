// Cells from code: convex regions by their planes, and spaces that take no nonsense.
// SPDX-License-Identifier: MIT
#include "sightline/cells/cell_space_build.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/geom/convex_region.h"
#include "tests/support/random.h"

namespace sightline {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double insideBy(std::span<const glm::dvec4> planes, const glm::dvec3& point) {
    double least = std::numeric_limits<double>::infinity();
    for (const glm::dvec4& plane : planes) least = std::min(least, glm::dot(glm::dvec3(plane), point) + plane.w);
    return least;
}

glm::dvec3 areaOf(const std::vector<glm::dvec3>& outline) {
    glm::dvec3 area(0);
    for (size_t i = 1; i + 1 < outline.size(); ++i)
        area += 0.5 * glm::cross(outline[i] - outline[0], outline[i + 1] - outline[0]);
    return area;
}

TEST(ConvexRegion, ABoxHasSixFacesSeenFromInside) {
    const Box3d box{{100, -2, 3}, {104, 1, 8}};
    const std::vector<glm::dvec4> planes = planesOfBox(box);
    const ConvexRegion region = convexRegion(planes);
    ASSERT_EQ(region.kind, ConvexRegion::Kind::kSolid);
    ASSERT_EQ(region.faces.size(), 6u);
    double surface = 0;
    for (const RegionFace& face : region.faces) {
        surface += glm::dot(areaOf(face.outline), glm::dvec3(planes[face.plane]));
        EXPECT_EQ(face.outline.size(), 4u);
    }
    EXPECT_NEAR(surface, 2 * (4 * 3 + 3 * 5 + 5 * 4), 1e-9);
    EXPECT_NEAR(glm::length(region.bounds.min - box.min), 0, 1e-9);
    EXPECT_NEAR(glm::length(region.bounds.max - box.max), 0, 1e-9);
}

TEST(ConvexRegion, KnowsWhatIsEmptyAndWhatIsOpen) {
    std::vector<glm::dvec4> planes = planesOfBox({{0, 0, 0}, {1, 1, 1}});
    EXPECT_EQ(convexRegion(std::span(planes).first(5)).kind, ConvexRegion::Kind::kUnbounded);
    planes.emplace_back(1, 0, 0, -2);
    EXPECT_EQ(convexRegion(planes).kind, ConvexRegion::Kind::kEmpty);
    planes.back() = {1, 0, 0, -1};
    EXPECT_EQ(convexRegion(planes).kind, ConvexRegion::Kind::kEmpty) << "a face is no region";
    planes.back() = {-1, 0, 0, 1};
    EXPECT_EQ(convexRegion(planes).faces.size(), 6u) << "the same plane twice has one face";
    EXPECT_EQ(convexRegion({}).kind, ConvexRegion::Kind::kUnbounded);
}

// Its faces close: areas sum to nothing, and each corner lies on the region and on its face.
TEST(ConvexRegion, RandomRegionsAreClosed) {
    Random random(1);
    for (int round = 0; round < 500; ++round) {
        const double far = round % 3 == 0 ? 0 : std::pow(10, random.uniform(0, 6));
        const glm::dvec3 center = far * test::randomUnit(random);
        std::vector<glm::dvec4> planes;
        const size_t count = 4 + random.below(20);
        for (size_t i = 0; i < count; ++i) {
            const glm::dvec3 normal = test::randomUnit(random);
            planes.emplace_back(normal, random.uniform(0.5, 2) - glm::dot(normal, center));
        }
        const ConvexRegion region = convexRegion(planes);
        if (region.kind == ConvexRegion::Kind::kUnbounded) continue;
        ASSERT_EQ(region.kind, ConvexRegion::Kind::kSolid) << "round " << round;
        glm::dvec3 sum(0);
        double all = 0;
        for (const RegionFace& face : region.faces) {
            const glm::dvec3 area = areaOf(face.outline);
            sum += area;
            all += glm::length(area);
            EXPECT_GT(glm::dot(area, glm::dvec3(planes[face.plane])), 0) << "round " << round;
            for (const glm::dvec3& point : face.outline)
                EXPECT_GE(insideBy(planes, point), -1e-9 * (1 + far)) << "round " << round;
        }
        EXPECT_LE(glm::length(sum), 1e-8 * all * (1 + far / 100)) << "round " << round;
    }
}

TEST(ConvexRegion, PlanesAroundPointsHoldThem) {
    Random random(2);
    for (int round = 0; round < 200; ++round) {
        std::vector<glm::dvec3> points;
        const glm::dvec3 center = random.uniform(0, 1e5) * test::randomUnit(random);
        for (size_t i = 0, n = 4 + random.below(12); i < n; ++i)
            points.push_back(center + random.uniform(1, 3) * test::randomUnit(random));
        const std::vector<glm::dvec4> planes = planesAround(points);
        ASSERT_GE(planes.size(), 4u) << "round " << round;
        for (const glm::dvec3& point : points) EXPECT_GE(insideBy(planes, point), -1e-9) << "round " << round;
        // And no more than their hull: each plane has three of them.
        for (const glm::dvec4& plane : planes) {
            int on = 0;
            for (const glm::dvec3& point : points) on += std::abs(glm::dot(glm::dvec3(plane), point) + plane.w) < 1e-7;
            EXPECT_GE(on, 3) << "round " << round;
        }
    }
    EXPECT_TRUE(planesAround(std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}).empty());
}

const std::vector<glm::dvec3> kDoor{{6, 0, 1}, {6, 0, 2}, {6, 2, 2}, {6, 2, 1}};

TEST(CellSpaceBuilder, BuildsTwoRooms) {
    CellSpaceBuilder rooms;
    const Result<uint32_t> hall = rooms.addCell("hall", Box3d{{0, 0, 0}, {6, 3, 4}});
    const Result<uint32_t> kitchen = rooms.addHull(
        "kitchen", std::vector<glm::dvec3>{
                       {6, 0, 0}, {10, 0, 0}, {10, 0, 4}, {6, 0, 4}, {6, 3, 0}, {10, 3, 0}, {10, 3, 4}, {6, 3, 4}});
    ASSERT_TRUE(hall && kitchen);
    const Result<uint32_t> door = rooms.addDoor("door", 7, {0, 0, 1});
    ASSERT_TRUE(door);
    EXPECT_TRUE(rooms.addPortal("way", *kitchen, *hall, kDoor, *door).ok());
    const CellSpace space = rooms.take();
    EXPECT_EQ(space.graph.cells, 2u);
    ASSERT_EQ(space.regions.size(), 2u);
    EXPECT_EQ(space.names, (std::vector<std::string>{"hall", "kitchen"}));
    EXPECT_NEAR(insideBy(space.planesOf(space.regions[1]), {8, 1.5, 2}), 1.5, 1e-12);
    ASSERT_EQ(space.graph.portals.size(), 1u);
    EXPECT_EQ(space.graph.portals[0].door, 0u);
    EXPECT_EQ(space.doors[0].key, 7u);
    EXPECT_GT(space.tolerance, 0);
    EXPECT_EQ(space.outside, CellGraph::kNoCell);
    EXPECT_EQ(rooms.space().graph.cells, 0u) << "it begins a new one";
}

TEST(CellSpaceBuilder, TakesOutlinesEitherWayRound) {
    CellSpaceBuilder rooms;
    const uint32_t hall = *rooms.addCell("hall", Box3d{{0, 0, 0}, {6, 3, 4}}),
                   kitchen = *rooms.addCell("kitchen", Box3d{{6, 0, 0}, {10, 3, 4}}), outside = rooms.outside();
    std::vector<glm::dvec3> turned(kDoor.rbegin(), kDoor.rend()), window = kDoor;
    for (glm::dvec3& point : window) point.x = 10;
    for (const auto& outline : {kDoor, turned}) {
        ASSERT_TRUE(rooms.addPortal("way", hall, kitchen, outline).ok());
        ASSERT_TRUE(rooms.addPortal("back", kitchen, hall, outline).ok());
    }
    ASSERT_TRUE(rooms.addPortal("window", kitchen, outside, window).ok());
    ASSERT_TRUE(rooms.addPortal("window", outside, kitchen, window).ok());
    for (const CellPortal& portal : rooms.space().graph.portals) {
        // The normal points into cells[0].
        const bool to_hall = portal.plane.x < 0;
        const bool is_window = portal.cells[0] == outside || portal.cells[1] == outside;
        EXPECT_EQ(portal.cells[0], is_window ? (to_hall ? kitchen : outside) : (to_hall ? hall : kitchen));
    }
}

TEST(CellSpaceBuilder, HasOneOutside) {
    CellSpaceBuilder rooms;
    ASSERT_TRUE(rooms.addCell("a", Box3d{{0, 0, 0}, {1, 1, 1}}));
    EXPECT_EQ(rooms.outside(), 1u);
    EXPECT_EQ(rooms.outside(), 1u);
    EXPECT_EQ(rooms.take().outside, 1u);
}

template <class R>
std::string errorOf(const R& result) {
    return result.ok() ? "" : result.error().message;
}

TEST(CellSpaceBuilder, RefusesNonsense) {
    CellSpaceBuilder rooms;
    const uint32_t a = *rooms.addCell("a", Box3d{{0, 0, 0}, {1, 1, 1}});
    const uint32_t b = *rooms.addCell("b", Box3d{{1, 0, 0}, {2, 1, 1}});
    EXPECT_EQ(errorOf(rooms.addCell("c", Box3d{{0, 0, 0}, {1, kNaN, 1}})), "cell 'c': its box is not finite");
    EXPECT_EQ(errorOf(rooms.addCell("c", Box3d{{0, 0, 0}, {1, 0, 1}})), "cell 'c': its box is flat or inside out");
    const std::vector<glm::dvec4> zero{{0, 0, 0, 1}, {1, 0, 0, 1}}, open{{1, 0, 0, 1}, {-1, 0, 0, 1}};
    EXPECT_EQ(errorOf(rooms.addCell("c\n", zero)), "cell 'c?': a plane is not finite or has no normal");
    EXPECT_EQ(errorOf(rooms.addCell("c", open)), "cell 'c': its planes do not close it");
    std::vector<glm::dvec4> nothing = planesOfBox({{0, 0, 0}, {1, 1, 1}});
    nothing.emplace_back(0, 1, 0, -5);
    EXPECT_EQ(errorOf(rooms.addCell("c", nothing)), "cell 'c': its planes leave nothing");
    EXPECT_EQ(errorOf(rooms.addHull("c", std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})),
              "cell 'c': needs 4 to 64 points");
    EXPECT_EQ(errorOf(rooms.addHull("c", std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}})),
              "cell 'c': its points lie in one plane");
    EXPECT_EQ(errorOf(rooms.addHull("c", std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, kNaN}})),
              "cell 'c': a point is not finite");
    EXPECT_EQ(errorOf(rooms.addDoor("d", 1, {kNaN, 0, 0})), "door 'd': its slide is not finite");
    EXPECT_EQ(errorOf(rooms.addPortal("p", a, 9, kDoor)), "portal 'p': there is no such cell");
    EXPECT_EQ(errorOf(rooms.addPortal("p", a, a, kDoor)), "portal 'p': leads from a cell into the same");
    EXPECT_EQ(errorOf(rooms.addPortal("p", a, b, kDoor, 3)), "portal 'p': there is no such door");
    EXPECT_EQ(errorOf(rooms.addPortal("p", a, b, std::span(kDoor).first(2))), "portal 'p': has fewer than 3 points");
    EXPECT_EQ(errorOf(rooms.addPortal("p", a, b, std::vector<glm::dvec3>{{1, 0, 0}, {1, 1, 0}, {1, 2, 0}})),
              "portal 'p': has no area");
    EXPECT_EQ(errorOf(rooms.addPortal("p", a, b, std::vector<glm::dvec3>{{1, 0, 0}, {1, kNaN, 0}, {1, 2, 0}})),
              "portal 'p': a point is not finite");
    const CellSpace space = rooms.take();
    EXPECT_EQ(space.graph.cells, 2u);
    EXPECT_EQ(space.regions.size(), 2u);
    EXPECT_EQ(space.planes.size(), 12u);
    EXPECT_TRUE(space.graph.portals.empty());
    EXPECT_TRUE(space.doors.empty());
}

}  // namespace
}  // namespace sightline
