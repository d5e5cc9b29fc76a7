// Light from regions: no line gets where none of the flow's ways leads, in made rooms and among any triangles.
// SPDX-License-Identifier: MIT
#include "sightline/bake/flow/region_flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "sightline/bake/soup/soup_cells.h"
#include "sightline/base/random.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/building/building.h"
#include "tests/bake/aimed_points.h"
#include "tests/bake/any_triangles.h"
#include "tests/bake/marked/random_rooms.h"
#include "tests/bake/opaque_triangles.h"
#include "tests/support/random.h"

namespace sightline {
using namespace bake;
using namespace tools;
namespace {

using namespace test;

TEST(Penumbra, HoldsWhatSegmentsThroughTheWindowReach) {
    Random random(3);
    uint64_t reached = 0, beside = 0, left_out = 0;
    for (int round = 0; round < 4000; ++round) {
        // A polygon on a circle in a plane anywhere, and a box on the side from which light comes.
        const glm::dvec3 normal = randomUnit(random), middle = randomVector(random, 10);
        const glm::dvec3 u =
            glm::normalize(glm::cross(normal, std::abs(normal.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
        const glm::dvec3 v = glm::cross(normal, u);
        const double size = std::pow(10, random.uniform(-3, 1)), thin = std::pow(10, random.uniform(-4, 0));
        std::vector<double> angles(3 + random.below(6));
        for (double& angle : angles) angle = random.uniform(0, 6.28);
        std::sort(angles.begin(), angles.end());
        std::vector<glm::dvec3> window;
        for (const double angle : angles)
            window.push_back(middle + size * (std::cos(angle) * u + thin * std::sin(angle) * v));
        const glm::dvec4 beyond(normal, -glm::dot(normal, middle));
        const glm::dvec3 corner = middle - std::pow(10, random.uniform(-2, 1)) * normal + randomVector(random, 3);
        const Box3d box{corner, corner + glm::abs(randomVector(random, 2))};
        const double slack = 1e-6;
        const Penumbra penumbra(box, window, beyond, slack);
        for (int k = 0; k < 50; ++k) {
            const glm::dvec3 from = pointIn(box, random);
            const glm::dvec3 a = window[random.below(window.size())], b = window[random.below(window.size())];
            const glm::dvec3 c = window[random.below(window.size())];
            const double s = random.uniform(), t = random.below(3) ? random.uniform() : 0;
            const glm::dvec3 through = glm::mix(glm::mix(a, b, s), c, t) + slack * randomUnit(random);
            if (glm::dot(normal, from - middle) >= -slack) continue;
            const glm::dvec3 to = through + std::pow(10, random.uniform(-3, 3)) * (through - from);
            ++reached;
            ASSERT_TRUE(penumbra.touches({to, to})) << "round " << round;
            // A polygon that the segment meets there keeps what is near.
            std::vector<glm::dvec3> polygon, scratch;
            for (int i = 0; i < 3; ++i) polygon.push_back(to + randomVector(random, 2));
            polygon[2] = 3.0 * to - polygon[0] - polygon[1];
            penumbra.clip(polygon, scratch);
            ASSERT_GE(polygon.size(), 3u) << "round " << round;
        }
        for (int k = 0; k < 20; ++k) {
            const glm::dvec3 any = middle + randomVector(random, 20);
            if (glm::dot(normal, any - middle) < 0.1) continue;
            ++beside;
            left_out += !penumbra.touches({any, any});
        }
    }
    EXPECT_GT(reached, 100000u);
    EXPECT_GT(left_out, beside / 2) << "of " << beside;
}

// What has come through two windows is behind the planes of both; the second one's do not know the first.
TEST(Penumbra, HoldsWhatSegmentsThroughTwoWindowsReach) {
    Random random(4);
    uint64_t reached = 0, left_out = 0, crossed = 0;
    const double slack = 1e-6;
    for (int round = 0; round < 20000; ++round) {
        const Box3d box{{-6, -1, -1}, {-random.uniform(3, 5), 1, 1}};
        const auto corner = [&] { return glm::dvec3(0, random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2)); };
        const std::vector<glm::dvec3> window = {corner(), corner(), corner()};
        const glm::dvec3 away = glm::normalize(glm::dvec3(1, random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4)));
        const glm::dvec4 second_plane(away, -random.uniform(0.3, 2));
        glm::dvec3 from[3], through[3];
        std::vector<glm::dvec3> second;
        for (int i = 0; i < 3; ++i) {
            from[i] = pointIn(box, random);
            const double s = random.uniform(), t = random.uniform();
            through[i] = glm::mix(glm::mix(window[0], window[1], s), window[2], t) + 0.5 * slack * randomUnit(random);
            const glm::dvec3 along = through[i] - from[i];
            const double rises = glm::dot(away, along);
            const double at = -(glm::dot(away, through[i]) + second_plane.w) / rises;
            if (rises > 0.1 && at > 0) second.push_back(through[i] + at * along);
        }
        if (second.size() < 3) continue;
        const Penumbra first(box, window, {1, 0, 0, 0}, slack);
        const Penumbra plain(box, second, second_plane, slack);
        const Penumbra both(box, second, second_plane, slack, first.edges());
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 to = second[size_t(i)] + std::pow(10, random.uniform(-3, 2)) * (through[i] - from[i]);
            ASSERT_TRUE(both.touches({to, to})) << "round " << round;
        }
        const glm::dvec3 any(10, random.uniform(-6, 6), random.uniform(-6, 6));
        if (plain.touches({any, any})) {
            ++reached;
            left_out += !both.touches({any, any});
        }
        for (const glm::dvec4& plane : first.edges()) {
            if (!Penumbra::divides(plane, second, slack)) continue;
            ++crossed;
            for (int i = 0; i < 3; ++i) {
                const glm::dvec3 to =
                    second[size_t(i)] + std::pow(10, random.uniform(-3, 2)) * (second[size_t(i)] - from[i]);
                ASSERT_GE(glm::dot(plane, glm::dvec4(to, 1)), 0) << "round " << round;
            }
        }
    }
    EXPECT_GT(reached, 1000u);
    EXPECT_GT(crossed, 1000u);
    EXPECT_GT(left_out, reached / 10) << "of " << reached;
}

// Close to the window's plane a plane is found, too: all of the region is less than a millionth before it.
TEST(Penumbra, OfAGrazingRegionIsNarrow) {
    const std::vector<glm::dvec3> window = {{0, 5, 0}, {0, 6, 0}, {0, 6, 1}, {0, 5, 1}};
    const Penumbra penumbra({{-1e-6, 0, 0}, {1e-6, 1, 1}}, window, {1, 0, 0, 0}, 1e-9);
    EXPECT_FALSE(penumbra.touches({{2, 6, 0.4}, {2, 1e5, 0.6}}));
    EXPECT_TRUE(penumbra.touches({{2, 1e7, 0.5}, {2, 1e7, 0.5}}));
}

uint32_t cellAt(const CellSpace& space, const glm::dvec3& point) {
    return space.graph.cell_of_leaf[leafOf(space.tree, point)];
}

double nearestPlane(const LeafTree& tree, const glm::dvec3& point) {
    double nearest = INFINITY;
    for (const LeafTreeNode& node : tree.nodes)
        nearest = std::min(nearest, std::abs(glm::dot(glm::dvec3(node.plane), point) + node.plane.w));
    return nearest;
}

struct FlowCounts {
    uint64_t points = 0, beyond = 0, left_out = 0;
};

/// Looks from anywhere in regions to anywhere, half the time by the edges of portals.
void lookFrom(const Scene& scene, const SoupCells& cells, int regions, Random& random, FlowCounts& counts) {
    const CellSpace& space = cells.space;
    const OpaqueTriangles truth(scene);
    const double hole = cells.report.smallest_hole;
    RegionFlow flow(space, {.turns = 1 + static_cast<uint32_t>(random.below(6))});
    for (int i = 0; i < regions; ++i) {
        const glm::dvec3 low = pointIn(space.tree.bounds, random);
        const glm::dvec3 size = std::pow(10, random.uniform(-4, 0)) * glm::abs(randomVector(random, 2));
        const Box3d region{low, glm::min(low + size, space.tree.bounds.max)};
        std::vector<uint8_t> anywhere(space.graph.cells, 0);
        std::vector<std::vector<Penumbra>> within(space.graph.cells);
        const RegionFlow::End end = flow.from(region, [&](uint32_t cell, const Penumbra* through) {
            if (through) within[cell].push_back(*through);
            else anywhere[cell] = 1;
            return true;
        });
        ASSERT_EQ(end, RegionFlow::End::kDone);
        const auto isReached = [&](const glm::dvec3& point) {
            const uint32_t cell = cellAt(space, point);
            return anywhere[cell] ||
                   std::any_of(within[cell].begin(), within[cell].end(), [&](const Penumbra& through) {
                       return through.touches({point, point});
                   });
        };
        for (int line = 0; line < 60; ++line) {
            const glm::dvec3 from = pointIn(region, random);
            glm::dvec3 target = pointIn(space.tree.bounds, random);
            if (line % 2 && !space.graph.portals.empty())
                target = from + 2.0 * (pointAtPortal(space.graph, random) - from);
            const double length = glm::distance(from, target);
            if (!(length > 1e-6) || !std::isfinite(length)) continue;
            const glm::dvec3 along = (target - from) / length;
            for (double at = 0.02 * length; at < length; at *= 1.3) {
                const glm::dvec3 point = from + at * along;
                if (!contains(space.tree.bounds, point)) break;  // beyond them nothing is drawn
                if (truth.meets(from, along, 0, at + 2 * hole, 2 * hole)) break;
                // What is near a plane may belong to its other side, and lines along a wall are in it.
                if (nearestPlane(space.tree, point) < 8 * hole || nearestPlane(space.tree, from) < 8 * hole) continue;
                ++counts.points;
                counts.beyond += cellAt(space, point) != cellAt(space, from);
                ASSERT_TRUE(isReached(point)) << "from (" << from.x << ", " << from.y << ", " << from.z << ") to ("
                                              << point.x << ", " << point.y << ", " << point.z << ")";
            }
        }
        for (int k = 0; k < 20; ++k) counts.left_out += !isReached(pointIn(space.tree.bounds, random));
    }
}

TEST(RegionFlow, NoLineGetsWhereNoWayLeads) {
    Random random(1);
    FlowCounts counts;
    const int made = static_cast<int>(rounds(24, 6));
    for (int round = 0; round < made; ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        const MarkedRooms rooms = randomRooms(random, round);
        const SoupCells cells = cellsOfSoup(rooms.scene);
        lookFrom(rooms.scene, cells, 12, random, counts);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(counts.points, rounds(20000, 4000));
    EXPECT_GT(counts.beyond, counts.points / 20);
    EXPECT_GT(counts.left_out, rounds(50, 5));
}

TEST(RegionFlow, HoldsAmongAnyTriangles) {
    Random random(2);
    FlowCounts counts;
    const int made = static_cast<int>(rounds(30, 6));
    for (int round = 0; round < made; ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        const MarkedRooms any = anyTriangles(random);
        SoupCellSettings settings;
        settings.smallest_occluder = std::pow(10, random.uniform(-2, 0.5));
        const SoupCells cells = cellsOfSoup(any.scene, settings);
        if (cells.space.graph.cells == 0) continue;
        lookFrom(any.scene, cells, 6, random, counts);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(counts.points, rounds(20000, 4000));
    EXPECT_GT(counts.beyond, counts.points / 6);
}

TEST(RegionFlow, LeavesOutMostOfABuilding) {
    const Scene scene = makeBuilding(1, 1);
    const SoupCells cells = cellsOfSoup(scene);
    RegionFlow flow(cells.space);
    uint64_t reached = 0, all = 0;
    for (const CameraFrame& camera : seededCameras(scene, 12, 3).frames) {
        std::vector<uint8_t> cell_is(cells.space.graph.cells, 0);
        const Box3d region{camera.eye - 0.1, camera.eye + 0.1};
        const RegionFlow::End end = flow.from(region, [&](uint32_t cell, const Penumbra*) {
            cell_is[cell] = 1;
            return true;
        });
        if (end != RegionFlow::End::kDone) continue;
        reached += static_cast<uint64_t>(std::count(cell_is.begin(), cell_is.end(), 1));
        all += cell_is.size();
    }
    EXPECT_GT(all, 4 * cells.space.graph.cells);
    EXPECT_LT(reached, all / 3);
}

TEST(RegionFlow, SaysWhenItsWorkLimitIsMet) {
    Random random(5);
    const MarkedRooms rooms = randomRooms(random, 0);
    const SoupCells cells = cellsOfSoup(rooms.scene);
    const Box3d bounds = cells.space.tree.bounds;
    const auto nothing = [](uint32_t, const Penumbra*) { return true; };
    RegionFlow little(cells.space, {.budget = 3});
    EXPECT_EQ(little.from(bounds, nothing), RegionFlow::End::kOverBudget);
    EXPECT_LE(little.clipped(), 64u);
    RegionFlow enough(cells.space);
    EXPECT_EQ(enough.from(bounds, nothing), RegionFlow::End::kDone);
    EXPECT_EQ(enough.from({bounds.min - 0.1, bounds.max}, nothing), RegionFlow::End::kOutOfBounds);
    EXPECT_EQ(enough.from(bounds, [](uint32_t, const Penumbra*) { return false; }), RegionFlow::End::kStopped);
    // What one region leaves behind does not touch the next.
    const uint64_t before = enough.clipped();
    EXPECT_EQ(enough.from(bounds, nothing), RegionFlow::End::kDone);
    RegionFlow fresh(cells.space);
    EXPECT_EQ(fresh.from(bounds, nothing), RegionFlow::End::kDone);
    EXPECT_EQ(enough.clipped() - before, fresh.clipped());
}

}  // namespace
}  // namespace sightline
