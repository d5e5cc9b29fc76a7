// The laws of the grid: it equals the flat list whatever happens, and looks at no cell that is out of reach.
// SPDX-License-Identifier: MIT
#include "sightline/studies/frustum/grid.h"

#include <gtest/gtest.h>

#include <set>

#include "sightline/geom/frustum_bounds.h"
#include "sightline/math/round_outward.h"
#include "tests/tree/living_fixture.h"

namespace sightline::test {
using namespace studies;
namespace {

constexpr double kWorld = 100.0;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();

/// A grid and a plain list of what should be in it.
struct GridAndList {
    Grid grid;
    glm::dvec3 middle;
    std::vector<Box3d> boxes;  ///< per item
    std::vector<uint32_t> items;

    explicit GridAndList(double cell, const glm::dvec3& origin = glm::dvec3(0.0))
        : grid(cell, origin), middle(origin) {}

    void insert(const Box3d& box) {
        const uint32_t item = grid.insert(box);
        if (item >= boxes.size()) boxes.resize(item + 1);
        boxes[item] = box;
        items.push_back(item);
    }
    void move(size_t which, const Box3d& box) {
        boxes[items[which]] = box;
        ASSERT_TRUE(grid.move(items[which], box));
    }
    void remove(size_t which) {
        ASSERT_TRUE(grid.remove(items[which]));
        ASSERT_FALSE(grid.remove(items[which]));
        items[which] = items.back();
        items.pop_back();
    }
    void changeAtRandom(Random& random, size_t wanted) {
        const uint64_t kind = random.below(8);
        const glm::dvec3 at = middle + randomPoint(random, kWorld);
        if (items.empty() || (kind == 0 && items.size() < 2 * wanted) || items.size() < wanted / 2)
            return insert(randomBox(random, at, kWorld));
        const size_t which = random.below(items.size());
        if (kind == 1) return remove(which);
        const Box3d box = boxes[items[which]];
        if (kind == 2 || !box.finite()) return move(which, randomBox(random, at, kWorld));
        const glm::dvec3 by = randomPoint(random, kind == 3 ? 10.0 : 0.5);
        move(which, {box.min + by, box.max + by});
    }
};

bool overlap(const Box3f& a, const Box3f& b) {
    for (int axis = 0; axis < 3; ++axis)
        if (a.max[axis] < b.min[axis] || a.min[axis] > b.max[axis]) return false;
    return true;
}

/// What the flat list keeps, less what lies beside the query's bounds; every box with a point in the frustum is in it.
void expectEqualsFlat(const GridAndList& both, uint64_t seed, int views = 4) {
    SCOPED_TRACE(seed);
    Random random(seed);
    std::vector<Box3f> stored;
    for (uint32_t item : both.items) stored.push_back(both.grid.storedBox(item));
    ASSERT_EQ(both.grid.size(), both.items.size());
    for (int i = 0; i < views; ++i) {
        const Frustum frustum = makeFrustum(randomView(random, kWorld, both.middle));
        std::vector<uint32_t> kept(both.grid.size() + 8);
        kept.resize(cullGrid(frustum, both.grid, kept));
        std::sort(kept.begin(), kept.end());
        const Box3f bounds = relativeBox(gridQueryBounds(frustum, both.grid), both.grid.origin());
        std::vector<uint32_t> flat;
        for (uint32_t which : keptByFlat(frustum, stored, both.grid.origin(), both.grid.reach()))
            if (stored[which].empty() || overlap(stored[which], bounds)) flat.push_back(both.items[which]);
        std::sort(flat.begin(), flat.end());
        ASSERT_EQ(kept, flat);
        for (uint32_t item : both.items) {
            const Box3d& box = both.boxes[item];
            if (!box.finite()) continue;
            const glm::dvec3 inside(random.uniform(), random.uniform(), random.uniform());
            const glm::dvec3 point = box.min + inside * box.size();
            if (!touches(frustum, {point, point})) continue;
            ASSERT_TRUE(std::binary_search(kept.begin(), kept.end(), item)) << "item " << item;
        }
    }
}

TEST(Grid, EqualsAFlatListUnderRandomChanges) {
    for (const double cell : {0.5, 5.0, 400.0}) {
        GridAndList both(cell, {1000.0, -50.0, 7.0});
        Random random(static_cast<uint64_t>(cell * 2));
        const uint32_t changes = 1000000;
        for (uint32_t i = 0; i < changes; ++i) {
            ASSERT_NO_FATAL_FAILURE(both.changeAtRandom(random, 3000));
            if (i % (changes / 20) != 0) continue;
            ASSERT_NO_FATAL_FAILURE(expectEqualsFlat(both, i));
        }
        for (size_t i = 0; i < both.items.size(); ++i) {
            const Box3f expected = relativeBox(both.boxes[both.items[i]], both.grid.origin());
            const Box3f stored = both.grid.storedBox(both.items[i]);
            ASSERT_TRUE(expected.min == stored.min && expected.max == stored.max);
        }
        while (!both.items.empty()) both.remove(random.below(both.items.size()));
        for (uint32_t level = 0; level < Grid::kLevels; ++level)
            EXPECT_TRUE(both.grid.level(level).blocks.empty()) << "empty space is nothing";
    }
}

TEST(Grid, HoldsItemsInTheLooseBoundsOfTheirCells) {
    Grid grid(3.0);
    Random random(12);
    for (int i = 0; i < 20000; ++i) {
        const double far = random.below(3) ? 100.0 : 90000.0;
        const glm::dvec3 at = randomPoint(random, far);
        grid.insert(randomBox(random, at, 200.0));
    }
    for (uint32_t number = 0; number < Grid::kLevels; ++number) {
        const double width = grid.cellWidth(number);
        for (const Grid::Level::Listed& listed : grid.level(number).blocks) {
            int32_t first[3];
            Grid::cellOfKey(listed.key, first);
            const GridBlock& block = grid.block(listed.block);
            ASSERT_NE(block.used, 0u);
            for (int cell = 0; cell < 64; ++cell) {
                if (!(block.used >> cell & 1)) continue;
                const int32_t at[3] = {first[0] + (cell & 3), first[1] + (cell >> 2 & 3), first[2] + (cell >> 4)};
                for (uint32_t c = block.first[cell]; c != Grid::kNone; c = grid.chunk(c).next) {
                    ASSERT_GT(grid.chunk(c).count, 0u);
                    for (uint32_t lane = 0; lane < grid.chunk(c).count; ++lane)
                        for (int axis = 0; axis < 3; ++axis) {
                            const GridItem& item = grid.item(grid.chunk(c).item[lane]);
                            ASSERT_GE(item.min[axis], float((at[axis] - Grid::kLoose) * width));
                            ASSERT_LE(item.max[axis], float((at[axis] + 1 + Grid::kLoose) * width));
                        }
                }
            }
        }
    }
}

TEST(Grid, LooksAtNoCellOutOfReach) {
    Grid grid(10.0);
    Random random(4);
    constexpr uint32_t kCount = 40000;
    for (uint32_t i = 0; i < kCount; ++i) {
        const glm::dvec3 at(random.uniform(-5000, 5000), random.uniform(0, 20), random.uniform(-5000, 5000));
        grid.insert({at, at + random.uniform(1, 9)});
    }
    View view;
    view.view = lookAt({0, 10, 0}, {100, 10, 30}, {0, 1, 0});
    view.projection = perspective(1.0, 1.6, 0.1, 200.0);
    const Frustum frustum = makeFrustum(view);
    std::vector<uint32_t> kept(kCount + 8);
    GridStats stats;
    kept.resize(cullGrid(frustum, grid, kept, &stats));
    EXPECT_GT(kept.size(), 10u);
    // The view is 200 wide and deep: about 25 by 25 cells on the ground, 2 or 3 high, of a million.
    EXPECT_LT(stats.cells, 25u * 25u * 3u);
    const GridStats before = stats;
    // What comes far away does not change what is done here.
    for (uint32_t i = 0; i < 10000; ++i) {
        const glm::dvec3 at(random.uniform(-5000, -500), random.uniform(0, 20), random.uniform(-5000, 5000));
        grid.insert({at, at + 5.0});
    }
    kept.resize(grid.size() + 8);
    cullGrid(frustum, grid, kept, &stats);
    EXPECT_EQ(stats.cells, before.cells);
    EXPECT_EQ(stats.blocks, before.blocks);
    EXPECT_EQ(stats.items, before.items);
    view.view = lookAt({0, 10, 0}, {0, 1000, 0}, {1, 0, 0});
    view.projection = perspective(1.0, 1.6, 100.0, 200.0);
    cullGrid(makeFrustum(view), grid, kept, &stats);
    EXPECT_EQ(stats.blocks, 0u) << "nothing is up there";
}

TEST(Grid, KeepsApartWhatHasNoBounds) {
    GridAndList both(4.0);
    Random random(9);
    for (int i = 0; i < 300; ++i) both.insert(randomBox(random, randomPoint(random, kWorld), kWorld));
    const Box3d plain{glm::dvec3(1.0), glm::dvec3(2.0)};
    std::vector<Box3d> bad(7, plain);
    bad[0].min.x = kNan;
    bad[1].max.z = kInf;
    bad[2].min.y = -kInf;
    bad[3] = {glm::dvec3(kNan), glm::dvec3(kNan)};
    bad[4] = Box3d();
    bad[5] = {plain.max, plain.min};
    bad[6] = {glm::dvec3(-1e300), glm::dvec3(1e300)};
    for (const Box3d& box : bad) {
        both.move(7, box);
        both.insert(box);
        EXPECT_EQ(both.grid.unbounded().size(), 2u);
        ASSERT_NO_FATAL_FAILURE(expectEqualsFlat(both, 5));
        both.remove(both.items.size() - 1);
        both.move(7, plain);
        EXPECT_TRUE(both.grid.unbounded().empty());
    }
}

TEST(FrustumBounds, HoldEveryPointAndAreTightWithAFarPlane) {
    Random random(6);
    for (int i = 0; i < 400; ++i) {
        const View view = randomView(random, kWorld);
        const Frustum frustum = makeFrustum(view);
        const Box3d region{glm::dvec3(-3 * kWorld), glm::dvec3(3 * kWorld)};
        const Box3d bounds = frustumBounds(frustum, region);
        for (int k = 0; k < 300; ++k) {
            const glm::dvec3 point = randomPoint(random, 3 * kWorld);
            if (!touches(frustum, {point, point})) continue;
            for (int axis = 0; axis < 3; ++axis) {
                ASSERT_GE(point[axis], bounds.min[axis]);
                ASSERT_LE(point[axis], bounds.max[axis]);
            }
        }
        if (frustum.count < 6) continue;
        View plain = view;
        plain.jitter = 0.0;
        Box3d corners;
        const glm::dmat4 back = glm::inverse(plain.projection * plain.view);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec4 p = back * glm::dvec4(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1, 1.0);
            corners.grow(glm::dvec3(p) / p.w);
        }
        const Box3d tight = frustumBounds(makeFrustum(plain), {glm::dvec3(-1e6), glm::dvec3(1e6)});
        for (int axis = 0; axis < 3; ++axis) {
            ASSERT_NEAR(tight.min[axis], corners.min[axis], 1e-4);
            ASSERT_NEAR(tight.max[axis], corners.max[axis], 1e-4);
        }
    }
    EXPECT_TRUE(frustumBounds(Frustum(), Box3d()).empty());
}

}  // namespace
}  // namespace sightline::test
