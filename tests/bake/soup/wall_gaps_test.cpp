// Walls that nearly touch are listed with their gaps: all that were made are found, with place and width, and no others.
// SPDX-License-Identifier: MIT
#include "sightline/bake/soup/wall_gaps.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/bake/soup/soup_cells.h"
#include "sightline/base/random.h"
#include "tests/bake/marked/made_rooms.h"
#include "tests/bake/opaque_triangles.h"
#include "tests/bake/soup/slit_room.h"
#include "tests/support/shared_scenes.h"

namespace sightline {
using namespace bake;
using namespace tools;
namespace {

using namespace test;

/// How far a point is from the line of a gap.
double besideLine(const WallGap& gap, const glm::dvec3& point) {
    const glm::dvec3 along = (gap.to - gap.from) / gap.length();
    return glm::length(glm::cross(along, point - gap.from));
}

/// Two halls, and between them a wall, drawn from both sides, that ends a little below the ceiling.
MarkedRooms lowWall(const glm::dmat4& place, double gap, double thick) {
    MarkedRooms made;
    made.place = place;
    made.room({{0, 0, 0}, {12, 3, 9}}, 2);
    made.room({{12, 0, 0}, {20, 3, 9}}, 1);
    const FlatRect rect{{0, 0}, {3 - gap, 9}};
    made.wall(0, 12 - thick / 2, rect, -1);
    made.wall(0, 12 + thick / 2, rect, 1);
    if (thick > 0) made.wall(1, 3 - gap, {{0, 12 - thick / 2}, {9, 12 + thick / 2}}, 1);
    return made;
}

TEST(WallGaps, AWallThatDoesNotReachTheCeilingIsToldWithItsPlace) {
    Random random(1);
    for (int round = 0; round < 24; ++round) {
        const double gap = std::pow(10, random.uniform(-3.5, -2.2)), thick = round % 2 ? 0.2 : 0;
        SCOPED_TRACE("round " + std::to_string(round) + ", " + std::to_string(gap) + " wide");
        const glm::dmat4 place = round % 4 < 2 ? glm::dmat4(1.0) : randomPlace(random, 10);
        const MarkedRooms made = lowWall(place, gap, thick);
        SoupCellSettings settings;
        settings.widest_gap = 0.01;
        const SoupCellReport report = cellsOfSoup(made.scene, settings).report;
        // One at each face of a thick wall.
        ASSERT_EQ(report.gaps.size(), thick > 0 ? 2u : 1u);
        std::vector<double> sides;
        for (const WallGap& found : report.gaps) {
            EXPECT_NEAR(found.width, gap, 0.02 * gap + 4 * report.smallest_hole);
            EXPECT_NEAR(found.length(), 9, 0.01);
            const bool left = besideLine(found, made.placed({12 - thick / 2, 3 - gap / 2, 0})) < gap / 4;
            const bool right = besideLine(found, made.placed({12 + thick / 2, 3 - gap / 2, 0})) < gap / 4;
            EXPECT_TRUE(left || right);
            sides.push_back(left ? -1 : 1);
            // A ceiling, which is the fourth wall of each room, and the wall.
            EXPECT_TRUE(found.objects[0] == 2 || found.objects[0] == 7) << found.objects[0];
            EXPECT_GE(found.objects[1], 10u);
        }
        if (thick > 0) { EXPECT_NE(sides[0], sides[1]); }
    }
}

TEST(WallGaps, SlitsAtAnyPlaceAndAngleAreFound) {
    Random random(2);
    for (const double width : {1e-2, 1e-3, 1e-4})
        for (int round = 0; round < 12; ++round) {
            SCOPED_TRACE("slit of " + std::to_string(width) + ", round " + std::to_string(round));
            const MarkedRooms made = slitRoom(random, width, round % 2 ? random.uniform(0, 3.1) : 0);
            SoupCellSettings settings;
            settings.widest_gap = 0.02;
            const SoupCellReport report = cellsOfSoup(made.scene, settings).report;
            ASSERT_EQ(report.gaps.size(), 1u);
            const WallGap& gap = report.gaps[0];
            // Corners are floats, up to 60 units from the origin.
            EXPECT_NEAR(gap.width, width, 0.01 * width + 2e-5);
            EXPECT_GT(gap.length(), 3);
            const std::vector<Mesh>& meshes = made.scene.meshes;
            const Mesh &half = meshes[meshes.size() - 1], &other = meshes[meshes.size() - 3];
            for (const int corner : {0, 1})
                EXPECT_LT(
                    besideLine(gap, 0.5 * (glm::dvec3(half.positions[corner]) + glm::dvec3(other.positions[corner]))),
                    width / 2 + 2e-5);
            EXPECT_GE(gap.objects[0], made.scene.objects.size() - 4);
        }
}

TEST(WallGaps, WiderOnesAreDoorways) {
    SoupCellSettings settings;
    settings.widest_gap = 0.01;
    EXPECT_TRUE(cellsOfSoup(lowWall(glm::dmat4(1.0), 0.02, 0.2).scene, settings).report.gaps.empty());
    settings.widest_gap = 0;
    EXPECT_TRUE(cellsOfSoup(lowWall(glm::dmat4(1.0), 0.005, 0.2).scene, settings).report.gaps.empty());
    const SoupCellReport report = cellsOfSoup(lowWall(glm::dmat4(1.0), 0.005, 0.2).scene).report;
    EXPECT_NEAR(report.widest_gap, std::ldexp(glm::length(glm::dvec3(20, 3, 9)), -12), 1e-9);
    EXPECT_EQ(report.gaps.size(), 2u) << "by default, too";
}

TEST(WallGaps, ClosedRoomsWithDoorsHaveNone) {
    Random random(3);
    for (int round = 0; round < 12; ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        MarkedRooms made;
        made.place = round % 2 ? randomPlace(random, 100) : glm::dmat4(1.0);
        const double thick = round % 3 ? 0.2 : 0;
        const FlatRect section{{0, 0}, {3, 4}}, door{{0, 1}, {2, 1.9}};
        for (int i = 0; i < 3; ++i) {
            const double x = i * (5 + thick);
            made.room({{x, 0, 0}, {x + 5, 3, 4}}, 3);
            made.wall(0, x, section, 1, i ? std::vector<FlatRect>{door} : std::vector<FlatRect>{});
            made.wall(0, x + 5, section, -1, i < 2 ? std::vector<FlatRect>{door} : std::vector<FlatRect>{});
            if (i < 2 && thick > 0) made.room({{x + 5, 0, 1}, {x + 5 + thick, 2, 1.9}}, 3);
        }
        SoupCellSettings settings;
        settings.widest_gap = 0.05;
        EXPECT_TRUE(cellsOfSoup(made.scene, settings).report.gaps.empty());
    }
}

// A leaf of 5 mm at which a wall ends: the wall's plane goes on through the leaf, and what it cuts there is no gap.
TEST(WallGaps, TheInsideOfALeafIsNone) {
    for (const bool both : {false, true}) {
        SCOPED_TRACE(both);
        MarkedRooms made;
        if (both) {
            made.scene.materials.emplace_back();
            made.scene.materials.back().double_sided = true;
        }
        made.room({{0, 0, 0}, {12, 3, 9}});
        Mesh leaf;
        for (int corner = 0; corner < 8; ++corner)
            leaf.positions.emplace_back(corner & 1 ? 6.005 : 6, corner & 2 ? 3 : 0, corner & 4 ? 9 : 0);
        leaf.indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                        2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
        made.add(leaf, both ? 1 : 0);
        // Across it, drawn from both sides, to the left of it and to the right.
        for (const int front : {1, -1}) {
            made.wall(2, 4, {{0, 0}, {6, 3}}, front);
            made.wall(2, 4, {{6.005, 0}, {12, 3}}, front);
        }
        SoupCellSettings settings;
        settings.widest_gap = 0.01;
        const SoupCells cells = cellsOfSoup(made.scene, settings);
        EXPECT_GT(cells.space.graph.cells, 4u);
        EXPECT_TRUE(cells.report.gaps.empty());
    }
}

// What is listed is open: some short segment through its middle meets no front.
TEST(WallGaps, OfRealScenesAreSeenThrough) {
    for (const char* name : {"bsi-duplex", "aws-small-house"}) {
        SCOPED_TRACE(name);
        const auto scene = sharedScene(name);
        if (!scene) GTEST_SKIP() << "no scenes beside the repository";
        const SoupCellReport report = cellsOfSoup(*scene).report;
        EXPECT_GE(report.gaps.size(), 10u);
        const OpaqueTriangles truth(*scene);
        Random random(5);
        for (size_t i = 0; i < std::min<size_t>(report.gaps.size(), 20); ++i) {
            const WallGap& gap = report.gaps[i];
            EXPECT_LE(gap.width, report.widest_gap);
            const glm::dvec3 middle = 0.5 * (gap.from + gap.to), line = (gap.to - gap.from) / gap.length();
            bool open = false;
            for (int k = 0; k < 200 && !open; ++k) {
                const double turn = random.uniform(0, 3.15);
                const glm::dvec3 side = glm::normalize(
                    glm::cross(line, std::abs(line.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0)));
                const glm::dvec3 along = std::cos(turn) * side + std::sin(turn) * glm::cross(line, side);
                const double half = gap.width / 2;
                open = !truth.meets(middle - half * along, along, 0, 2 * half, 0);
            }
            EXPECT_TRUE(open) << i << ": at (" << middle.x << ", " << middle.y << ", " << middle.z << ")";
        }
    }
}

}  // namespace
}  // namespace sightline
