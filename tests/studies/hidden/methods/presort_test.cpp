// Sorting by depth: the same as std::stable_sort, and in the order that is said.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/methods/presort.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/studies/hidden/made_lists.h"

namespace sightline::test {
using namespace studies;
namespace {

TEST(Presort, KeysRiseAsNumbersDo) {
    const double infinity = std::numeric_limits<double>::infinity();
    const double numbers[] = {-infinity, -1e300, -2.5, -1e-310, 0.0, 1e-310, 1.0, 1.0 + 0x1p-52, 7e200, infinity};
    for (size_t i = 1; i < std::size(numbers); ++i) EXPECT_LT(sortKey(numbers[i - 1]), sortKey(numbers[i])) << i;
    EXPECT_EQ(sortKey(-0.0), sortKey(0.0));
}

TEST(Presort, SortsAsTheStableSortDoes) {
    for (uint64_t seed = 1; seed <= 120; ++seed) {
        Random random(seed);
        const size_t count = seed < 10 ? seed - 1 : random.below(9000);
        const int shift = static_cast<int>(random.below(64));
        // Keys that differ in few bits, high or low, as well as those that differ in all.
        const uint64_t bits = seed % 3 == 0 ? random.next() & random.next() & random.next() : ~0ull;
        std::vector<SortEntry> entries(count), scratch;
        for (uint32_t i = 0; i < count; ++i) entries[i] = {(random.next() >> shift) & bits, i};
        std::vector<SortEntry> expected = entries;
        std::stable_sort(expected.begin(), expected.end(),
                         [](const SortEntry& a, const SortEntry& b) { return a.key < b.key; });
        radixSort(entries, scratch);
        for (size_t i = 0; i < count; ++i) {
            ASSERT_EQ(entries[i].key, expected[i].key) << "seed " << seed;
            ASSERT_EQ(entries[i].value, expected[i].value) << "seed " << seed;
        }
    }
}

TEST(Presort, PutsPolygonsNearToFarOrFarToNear) {
    const MadeList made = clutter(3, 400);
    Projector projector(madeView(), {160, 120, 0, 1, {}});
    std::vector<ScreenPolygon> polygons = projectAll(made.list(), projector);
    polygons.push_back(polygons[5]);
    const std::vector<uint32_t> near = orderPolygons(polygons, DepthOrder::kNearToFar),
                                far = orderPolygons(polygons, DepthOrder::kFarToNear);
    ASSERT_EQ(near.size(), polygons.size());
    ASSERT_EQ(far.size(), polygons.size());
    const auto place = [](const std::vector<uint32_t>& order, uint32_t what) {
        return std::find(order.begin(), order.end(), what) - order.begin();
    };
    for (size_t i = 1; i < near.size(); ++i) {
        EXPECT_GE(polygons[near[i - 1]].depth.high, polygons[near[i]].depth.high);
        EXPECT_LE(polygons[far[i - 1]].depth.low, polygons[far[i]].depth.low);
    }
    const uint32_t twin = static_cast<uint32_t>(polygons.size()) - 1;
    EXPECT_LT(place(near, 5), place(near, twin));
    EXPECT_GT(place(far, 5), place(far, twin));
}

/// How often a z-buffer is written when polygons come in an order.
uint64_t writes(const std::vector<ScreenPolygon>& polygons, const std::vector<uint32_t>& order) {
    std::vector<double> nearest(160 * 120, -std::numeric_limits<double>::infinity());
    uint64_t count = 0;
    for (const uint32_t place : order)
        scanPolygon(polygons[place].outline(), 0, 120, 160, [&](int32_t row, int32_t begin, int32_t end) {
            for (int32_t i = begin; i < end; ++i) {
                const double nearness = polygons[place].depth.at(row, i);
                double& here = nearest[size_t(row * 160 + i)];
                count += nearness > here;
                here = std::max(here, nearness);
            }
        });
    return count;
}

TEST(Presort, NearToFarSparesAZBufferWritesAndFarToNearDoesNot) {
    for (uint64_t seed = 1; seed <= 5; ++seed) {
        const MadeList made = clutter(seed, 3000);
        Projector projector(madeView(), {160, 120, 0, 1, {}});
        const std::vector<ScreenPolygon> polygons = projectAll(made.list(), projector);
        std::vector<uint32_t> given(polygons.size());
        for (uint32_t i = 0; i < given.size(); ++i) given[i] = i;
        const uint64_t near = writes(polygons, orderPolygons(polygons, DepthOrder::kNearToFar)),
                       far = writes(polygons, orderPolygons(polygons, DepthOrder::kFarToNear)),
                       none = writes(polygons, given);
        EXPECT_LT(near, none) << seed;
        EXPECT_GT(far, none) << seed;
    }
}

TEST(Presort, PutsItemsInOrder) {
    Random random(8);
    std::vector<MadeList> lists(30);
    std::vector<DrawItem> items;
    for (MadeList& made : lists) {
        const float z = static_cast<float>(random.uniform(-30, -1));
        made.add({0, 0, z}, {1, 0, z - 0.5f}, {0, 1, z - 1});
        items.push_back(made.items()[0]);
    }
    const std::vector<uint32_t> near = orderItems(DrawList(items), madeView(), DepthOrder::kNearToFar),
                                far = orderItems(DrawList(items), madeView(), DepthOrder::kFarToNear);
    for (size_t i = 1; i < near.size(); ++i) {
        EXPECT_GE(lists[near[i - 1]].positions[0].z, lists[near[i]].positions[0].z);
        EXPECT_LE(lists[far[i - 1]].positions[2].z, lists[far[i]].positions[2].z);
    }
}

}  // namespace
}  // namespace sightline::test
