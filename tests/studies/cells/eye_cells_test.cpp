// Eye-to-cell culling: each level holds every sight line, and no more than the level before.
// SPDX-License-Identifier: MIT
#include "sightline/studies/cells/eye_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "sightline/bake/flow/cell_visibility.h"
#include "sightline/bsp/merge_cells.h"
#include "sightline/bsp/open_groups.h"
#include "sightline/tools/import/quake/quake_bsp.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/text_file.h"
#include "tests/bsp/cell_space_fixture.h"
#include "tests/cells/portal_rays.h"
#include "tests/support/shared_scenes.h"

namespace sightline::test {
using namespace bake;
using namespace studies;
using namespace tools;
namespace {

constexpr EyeLevel kLevels[] = {EyeLevel::kRow, EyeLevel::kVolume, EyeLevel::kChain, EyeLevel::kSightLine};

Box3d boundsOf(const CellSpace& space) {
    Box3d box = space.tree.bounds;
    for (const CellRegion& region : space.regions) box.grow(region.bounds);
    return box;
}

/// Anywhere, and where it is unpleasant: in a hole, close to one, in the plane of one.
glm::dvec3 somePlace(Random& random, const CellSpace& space, const Box3d& box) {
    const CellPortal& portal = space.graph.portals[random.below(space.graph.portals.size())];
    const glm::dvec3 in_hole = pointInHole(random, space.graph.outline(portal));
    const glm::dvec3 anywhere = randomIn(random, box), normal(portal.plane);
    switch (random.below(6)) {
        case 0:
            return in_hole;
        case 1:
            return in_hole + std::pow(10.0, random.uniform(-9, -1)) * randomDirection(random);
        case 2:
            return anywhere - (glm::dot(normal, anywhere) + portal.plane.w) * normal;
        default:
            return anywhere;
    }
}

struct Sums {
    uint64_t views = 0, refused = 0, rays = 0, steps = 0, boxes = 0, hidden_boxes = 0;
    uint64_t cells[4] = {0, 0, 0, 0};
    uint64_t exact = 0, by_polygons = 0;  ///< cells, where no chains were joined
};

class Sweep {
public:
    /// @param margin  of rays from the edges of portals
    Sweep(const CellSpace& space, double margin, double size)
        : space_(space), graph_(space), rays_(space.graph, margin), margin_(margin), size_(size) {}

    /// Rows of cells that see one another; else all rows are seen.
    BitMatrix rows;
    uint32_t ways = 0;

    void run(uint64_t seed, int views, int rays_each, Sums& sums) {
        Random random(seed);
        const Box3d box = boundsOf(space_);
        for (int i = 0; i < views; ++i) {
            const KnownView known = randomView(random, somePlace(random, space_, box), size_);
            ways = static_cast<uint32_t>(i % 3);  // 0: exactly; else chains are joined
            ASSERT_NO_FATAL_FAILURE(judge(known, random, rays_each, sums)) << "seed " << seed << ", view " << i;
        }
    }

    void judge(const KnownView& known, Random& random, int count, Sums& sums) {
        std::vector<uint64_t> bits;
        if (rows.rows() > 0) {
            // The cells that the eye may be in are those that it sees where no row is.
            const std::vector<uint64_t> none(rows.wordsPerRow(), 0);
            if (!eyes_[0].run(graph_, known.view, {.level = EyeLevel::kRow}, none)) return (void)++sums.refused;
            bits.assign(rows.wordsPerRow(), 0);
            for (const uint32_t cell : eyes_[0].cells())
                for (size_t word = 0; word < bits.size(); ++word) bits[word] |= rows.row(graph_.rowOf(cell))[word];
        }
        for (int level = 0; level < 4; ++level)
            if (!eyes_[level].run(graph_, known.view, {.level = kLevels[level], .ways = ways}, bits))
                return (void)++sums.refused;
        ++sums.views;
        for (int level = 0; level < 4; ++level) {
            sums.cells[level] += eyes_[level].cells().size();
            for (const uint32_t cell : eyes_[level].cells())
                ASSERT_TRUE(level == 0 || eyes_[level - 1].sees(cell)) << kEyeLevelNames[level];
        }
        sums.exact += ways == 0 ? eyes_[3].cells().size() : 0;
        if (ways == 0 && flood_.run(graph_, known.view, {.windows = PortalWindows::kPolygons}, {}, bits)) {
            std::vector<uint32_t> seen;
            for (const SeenCell& cell : flood_.cells()) seen.push_back(cell.cell);
            std::sort(seen.begin(), seen.end());
            sums.by_polygons += static_cast<uint64_t>(std::unique(seen.begin(), seen.end()) - seen.begin());
        }
        for (int i = 0; i < count; ++i) followLine(known, random, sums);
        for (int i = 0; i < 8; ++i) {  // boxes anywhere: at each level fewer
            const uint32_t cell = eyes_[0].cells()[random.below(eyes_[0].cells().size())];
            const glm::dvec3 p = randomIn(random, boundsOf(space_));
            const Box3d box{p, p + 0.2 * size_ * random.uniform()};
            for (int level = 1; level < 4; ++level)
                ASSERT_LE(eyes_[level].sees(cell, box), eyes_[level - 1].sees(cell, box)) << kEyeLevelNames[level];
            sums.hidden_boxes += eyes_[3].sees(cell) && eyes_[2].sees(cell, box) && !eyes_[3].sees(cell, box);
        }
    }

private:
    void followLine(const KnownView& known, Random& random, Sums& sums) {
        const double wide_x = 1 + 2 * known.view.jitter / known.view.width;
        const double wide_y = 1 + 2 * known.view.jitter / known.view.height;
        glm::dvec2 at(random.uniform(-wide_x, wide_x), random.uniform(-wide_y, wide_y));
        if (random.below(4) != 0) {  // at a hole, or just inside of its edge
            const uint32_t cell = eyes_[2].cells()[random.below(eyes_[2].cells().size())];
            const auto portals = graph_.portalsFrom(cell);
            if (portals.empty()) return;
            const auto outline =
                space_.graph.outline(space_.graph.portals[portals[random.below(portals.size())].portal]);
            glm::dvec3 point = pointInHole(random, outline);
            if (random.below(2) == 0) {
                const glm::dvec3 corner = outline[random.below(outline.size())];
                point = corner + std::pow(10.0, random.uniform(-8, -1)) * (point - corner);
            }
            const auto image = imageOf(known, point);
            if (!image || std::abs(image->x) > wide_x || std::abs(image->y) > wide_y) return;
            at = *image;
        }
        const SightLine line = sightLineAt(known, at.x, at.y);
        bool solid = false;
        const uint32_t first = cellAt(space_, line.from, 4 * margin_, solid);
        ASSERT_FALSE(solid) << "a near plane in a wall has no answer";
        if (first == CellGraph::kNoCell) return;
        ++sums.rays;
        rays_.follow(first, line.from, line.direction, steps_);
        for (size_t s = 0; s < steps_.size(); ++s) {
            const GraphStep& step = steps_[s];
            const glm::dvec3 entered = line.from + step.at * line.direction;
            // What lies beyond the far plane is not seen.
            const glm::dvec4 clip =
                known.view.projection * glm::dvec4(glm::dmat3(known.view.view) * (entered - known.eye), 1.0);
            if (clip.z > clip.w * (1 - 1e-9)) continue;
            ++sums.steps;
            double leaves = step.at + 0.1 * size_;
            for (const GraphStep& next : steps_)
                if (next.before == s) leaves = std::min(leaves, next.at);
            const glm::dvec3 inside =
                line.from + (step.at + random.uniform(0, 0.9) * (leaves - step.at)) * line.direction;
            Box3d box{inside, inside};  // the point is a corner of it, or on an edge or a face
            for (int axis = 0; axis < 3; ++axis) {
                const double reach = random.uniform(0, 0.1) * size_;
                if (random.below(2)) box.min[axis] -= reach;
                else box.max[axis] += reach;
            }
            const glm::dvec4 end =
                known.view.projection * glm::dvec4(glm::dmat3(known.view.view) * (inside - known.eye), 1.0);
            const bool before_far = end.z <= end.w * (1 - 1e-9);
            for (int level = 0; level < 4; ++level) {
                ASSERT_TRUE(eyes_[level].sees(step.cell)) << kEyeLevelNames[level] << ", cell " << step.cell;
                if (before_far) {
                    ASSERT_TRUE(eyes_[level].sees(step.cell, box)) << kEyeLevelNames[level] << ", box in " << step.cell;
                }
            }
            sums.boxes += before_far;
        }
    }

    const CellSpace& space_;
    PortalGraph graph_;
    GraphRays rays_;
    double margin_, size_;
    EyeCells eyes_[4];
    PortalFlood flood_;
    std::vector<GraphStep> steps_;
};

/// What a sweep has to have met to say anything, and that sight lines are told as exactly as by clipping.
void expectTold(const Sums& sums) {
    EXPECT_GT(sums.views, 100u);
    EXPECT_GT(sums.steps, sums.rays);
    EXPECT_GT(sums.boxes, sums.steps / 2);
    EXPECT_GT(sums.hidden_boxes, 0u);
    EXPECT_LT(sums.cells[3], sums.cells[2]);
    EXPECT_LT(sums.cells[2], sums.cells[1]);
    EXPECT_LT(sums.cells[1], sums.cells[0]);
    EXPECT_LE(static_cast<double>(sums.exact), 1.05 * static_cast<double>(sums.by_polygons));
}

TEST(EyeCells, HoldEachSightLineOfGrids) {
    Sums sums;
    for (uint64_t seed = 1; seed <= 12; ++seed) {
        RoomSettings settings{.rooms = {6, 5, 3}};
        if (seed % 4 == 1) settings.origin = {3e4, -2e4, 5e4};
        if (seed % 4 == 2) settings.size = 1e-3;
        if (seed % 4 == 3) settings.size = 1e5;
        const CellSpace space = gridSpace(seed, settings);
        Sweep sweep(space, 1e-8 * settings.size + 1e-12 * largestCoordinate(space.graph), settings.size);
        sweep.run(seed, 300, 300, sums);
        if (HasFatalFailure()) return;
    }
    expectTold(sums);
}

TEST(EyeCells, HoldEachSightLineOfTrees) {
    Sums sums;
    for (uint64_t seed = 1; seed <= 24; ++seed) {
        const glm::dvec3 center = seed % 3 == 0 ? glm::dvec3(1e4, -3e4, 2e4) : glm::dvec3(0.0);
        const CellSpace space = treeSpace(randomLeafTree(seed, 9, center, seed % 2 == 0));
        Sweep sweep(space, space.tolerance / 32, 1);
        sweep.run(seed, 300, 300, sums);
        if (HasFatalFailure()) return;
    }
    expectTold(sums);
}

TEST(EyeCells, HoldEachSightLineOfABuildingWithItsRows) {
    Sums sums;
    const CellSpace rooms = sceneSpace(makeBuilding(1, 3));
    CellSpace space = rooms;
    space.row_of_cell.resize(space.graph.cells);
    for (uint32_t cell = 0; cell < space.graph.cells; ++cell) space.row_of_cell[cell] = cell;
    Sweep sweep(space, 1e-8, 1);
    sweep.rows = bakeCellVisibility(space.graph).visible;
    sweep.run(1, 3000, 200, sums);
    expectTold(sums);
}

TEST(EyeCells, HoldEachSightLineOfAMap) {
    const auto map = test::sharedMap("lq_e2m2");
    if (!map) GTEST_SKIP() << "no maps beside the repository";
    CellSpace space = treeSpace(map->tree);
    const OpenGroups groups = groupOpenCells(space.tree, space.graph);
    space.row_of_cell = groups.group_of_cell;
    Sweep sweep(space, space.tolerance, 16);
    sweep.rows = bakeCellVisibility(joinPortals(mergeCells(space.graph, groups.group_of_cell, groups.groups))).visible;
    Sums sums;
    sweep.run(1, 400, 100, sums);
    expectTold(sums);
}

TEST(EyeCells, WithoutWorkTheAnswerIsWhatChainsSee) {
    const CellSpace space = gridSpace(3, {.rooms = {4, 4, 2}});
    const PortalGraph graph(space);
    EyeCells lines, chains;
    Random random(1);
    int spent = 0;
    for (int i = 0; i < 200; ++i) {
        const KnownView known = randomView(random, randomIn(random, boundsOf(space)), 1);
        if (!lines.run(graph, known.view, {.work = static_cast<uint32_t>(random.below(8))})) continue;
        ASSERT_TRUE(chains.run(graph, known.view, {.level = EyeLevel::kChain}));
        if (!lines.stats().work_spent) continue;
        ++spent;
        for (uint32_t cell = 0; cell < graph.cells(); ++cell) ASSERT_EQ(lines.sees(cell), chains.sees(cell));
    }
    EXPECT_GT(spent, 20);
}

TEST(EyeCells, OutsideAllCellsEverythingIsSeen) {
    const CellSpace space = gridSpace(3, {.rooms = {4, 4, 2}});
    const PortalGraph graph(space);
    EyeCells eye;
    const KnownView known = makeView({-5, 0.5, 0.5}, {1, 0, 0}, perspective(1, 1, 0.01));
    EXPECT_FALSE(eye.run(graph, known.view));
    EXPECT_TRUE(eye.sees(0) && eye.sees(31) && eye.sees(7, {{90, 90, 90}, {91, 91, 91}}));
    EXPECT_TRUE(eye.cells().empty());
}

}  // namespace
}  // namespace sightline::test
