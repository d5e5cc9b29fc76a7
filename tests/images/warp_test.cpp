// Laws of warping: where samples go, in which order, and that surfaces stay whole.
// SPDX-License-Identifier: MIT
#include "sightline/images/warp.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/images/doorway_room.h"

namespace sightline::test {
namespace {

constexpr uint32_t kSide = 48;

/// A view of a doorway whose samples are as far from each other along rows as along columns.
View squareView(const glm::dvec3& eye) { return *portalView(madeDoorway(), eye, kSide, 2 * kSide); }

TEST(WarpMap, CarriesSamplesToWhereTheirPointsProject) {
    Random random(8);
    for (int i = 0; i < 1000; ++i) {
        const View from = viewFrom(randomVector(random, 9.0), randomUnit(random));
        const View to = viewFrom(eyePosition(from) + randomVector(random, 2.0), randomUnit(random));
        const glm::dvec3 point = eyePosition(from) + randomVector(random, 20.0);
        const glm::dvec3 here = projected(from, point), there = projected(to, point);
        if (!(here.z > 1e-3) || !(there.z > 1e-3)) continue;
        const glm::dvec3 found = WarpMap(from, to).at(here.x, here.y, here.z);
        EXPECT_NEAR(found.x / found.z, there.x, 1e-6 * (1 + std::abs(there.x))) << "case " << i;
        EXPECT_NEAR(found.y / found.z, there.y, 1e-6 * (1 + std::abs(there.y))) << "case " << i;
        EXPECT_NEAR(here.z / found.z, there.z, 1e-9 * there.z) << "case " << i;
    }
}

TEST(WarpMap, CarriesPlanesAndTheirSides) {
    Random random(9);
    for (int i = 0; i < 1000; ++i) {
        const View from = viewFrom(randomVector(random, 9.0), randomUnit(random));
        const View to = viewFrom(eyePosition(from) + randomVector(random, 2.0), randomUnit(random));
        const WarpMap map(from, to);
        const glm::dvec3 place = eyePosition(from) + randomVector(random, 20.0), normal = randomUnit(random);
        const auto side = [&](const View& view) { return glm::dot(normal, eyePosition(view) - place); };
        // The plane from three of its points.
        const glm::dvec3 across = glm::normalize(glm::cross(normal, randomUnit(random)));
        const glm::dvec3 points[3] = {place, place + across, place + glm::cross(normal, across)};
        glm::dmat3 here, there;
        glm::dvec3 near_here, near_there;
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 a = projected(from, points[k]), b = projected(to, points[k]);
            here[k] = glm::dvec3(a.x, a.y, 1), there[k] = glm::dvec3(b.x, b.y, 1);
            near_here[k] = a.z, near_there[k] = b.z;
        }
        const glm::dvec3 plane = near_here * glm::inverse(here), expected = near_there * glm::inverse(there);
        const double size = glm::length(expected) + 1e-3;
        if (std::abs(side(from)) < 0.1 || std::abs(side(to)) < 0.1 || size > 1e3) continue;
        EXPECT_LT(glm::length(map.planeThere(plane) - expected), 1e-5 * size) << "case " << i;
        EXPECT_EQ(map.facing(plane) > 0, side(from) * side(to) > 0) << "case " << i;
    }
}

TEST(WarpOrder, GoesTowardsTheNewEyeOrAwayFromIt) {
    const View from = squareView({0.5, 1, 2});
    const auto rising = [](const std::vector<uint32_t>& order) { return std::is_sorted(order.begin(), order.end()); };
    const auto falling = [](const std::vector<uint32_t>& order) {
        return std::is_sorted(order.rbegin(), order.rend());
    };
    EXPECT_TRUE(rising(warpOrder(from, squareView({0.9, 1, 2})).columns)) << "to the right";
    EXPECT_TRUE(falling(warpOrder(from, squareView({0.1, 1, 2})).columns)) << "to the left";
    EXPECT_TRUE(rising(warpOrder(from, squareView({0.5, 1.5, 2})).rows)) << "up";
    EXPECT_TRUE(falling(warpOrder(from, squareView({0.5, 0.5, 2})).rows)) << "down";
    // Straight on, the epipole is the middle: the sheets meet there.
    const WarpOrder forward = warpOrder(from, squareView({0.5, 1, 1}));
    EXPECT_EQ(forward.columns.front(), 0u);
    EXPECT_EQ(forward.columns.back(), kSide / 2);
    const WarpOrder backward = warpOrder(from, squareView({0.5, 1, 3}));
    EXPECT_EQ(backward.columns.front(), kSide / 2);
    EXPECT_EQ(backward.columns.back(), 0u);
    for (std::vector<uint32_t> all : {forward.rows, backward.rows, forward.columns}) {
        std::sort(all.begin(), all.end());
        for (uint32_t i = 0; i < all.size(); ++i) ASSERT_EQ(all[i], i) << "each once";
    }
}

/// Depths without any order, and a colour for each sample.
DepthImage noise(const View& view, Random& random, uint32_t side) {
    DepthImage image;
    image.view = view;
    image.samples.resize(size_t{view.width} * view.height);
    std::vector<float> depths(size_t{view.width} * view.height);
    for (float& depth : depths) depth = static_cast<float>(random.below(5) == 0 ? 0 : random.uniform(0.02, 0.4));
    for (uint32_t row = 0; row < view.height; ++row)
        for (uint32_t i = 0; i < view.width; ++i) {
            DepthSample& sample = image.samples[size_t{row} * view.width + i];
            sample.nearness = depths[size_t{row / side} * view.width + i / side];
            sample.colour = glm::u8vec3(random.below(256), random.below(256), random.below(256));
        }
    return image;
}

TEST(Warp, InOrderShowsWhatAZBufferShowsForStepsAlongRowsAndColumns) {
    Random random(10);
    size_t differing = 0, shown = 0;
    for (int i = 0; i < 200; ++i) {
        const View from = squareView({0.5, 1, 2});
        const DepthImage image = noise(from, random, 1);
        const double step = random.uniform(-1.5, 1.5);
        const View to = squareView(i % 2 == 0 ? glm::dvec3(0.5 + step, 1, 2) : glm::dvec3(0.5, 1 + step, 2));
        WarpedImage in_order(to), by_depth(to);
        warp(image, to, in_order, {.most_gap = 0});
        warp(image, to, by_depth, {.hidden_by = HiddenBy::kZBuffer, .most_gap = 0});
        for (size_t at = 0; at < in_order.colour.size(); ++at) {
            ASSERT_EQ(in_order.nearness[at] < 0, by_depth.nearness[at] < 0) << "the same samples are drawn";
            if (by_depth.nearness[at] < 0) continue;
            ++shown;
            if (in_order.colour[at] == by_depth.colour[at]) continue;
            // Pieces that meet at the middle of a sample, both: which of two at one depth it is does not matter.
            ++differing;
            EXPECT_LT(by_depth.nearness[at] - in_order.nearness[at], 0.001) << "case " << i;
        }
    }
    EXPECT_GT(shown, 100000u);
    EXPECT_LT(static_cast<double>(differing), 1e-3 * static_cast<double>(shown));
}

TEST(Warp, InOrderShowsWhatAZBufferShowsForAnyStep) {
    Random random(11);
    size_t differing = 0, shown = 0;
    for (int i = 0; i < 200; ++i) {
        // Blocks of eight samples a side: lines to the epipole that lie within a pixel are mostly of one block.
        const View from = squareView({0.5, 1, 2});
        const DepthImage image = noise(from, random, 8);
        const View to = squareView(glm::dvec3(0.5, 1, 2) + randomVector(random, {0.7, 0.7, 0.7}));
        WarpedImage in_order(to), by_depth(to);
        warp(image, to, in_order);
        warp(image, to, by_depth, {.hidden_by = HiddenBy::kZBuffer});
        for (size_t at = 0; at < in_order.colour.size(); ++at) {
            ASSERT_EQ(in_order.nearness[at] < 0, by_depth.nearness[at] < 0);
            if (by_depth.nearness[at] < 0) continue;
            ++shown;
            differing += by_depth.nearness[at] > 1.001f * in_order.nearness[at];
        }
    }
    EXPECT_LT(static_cast<double>(differing), 0.01 * static_cast<double>(shown))
        << differing << " of " << shown << ": only where lines to the epipole lie within a pixel of each other";
    // The other way round it is wrong all over: the order is what does it.
    size_t reversed = 0;
    const View from = squareView({0.5, 1, 2}), to = squareView({1.1, 1, 2});
    DepthImage image = noise(from, random, 8);
    WarpedImage by_depth(to), wrong(to);
    warp(image, to, by_depth, {.hidden_by = HiddenBy::kZBuffer});
    for (uint32_t i = kSide; i-- > 0;) {
        // One column after the other; the others turn their backs.
        DepthImage column = image;
        for (size_t at = 0; at < column.samples.size(); ++at)
            if (at % kSide != i) column.samples[at].from_behind = 1;
        warp(column, to, wrong);
    }
    for (size_t at = 0; at < wrong.nearness.size(); ++at)
        reversed += wrong.nearness[at] >= 0 && by_depth.nearness[at] > 1.001f * wrong.nearness[at];
    EXPECT_GT(reversed, 100u);
}

/// How many samples of a new view stay empty although the reference saw what they show.
size_t cracks(const DepthImage& reference, const DepthImage& truth, const WarpedImage& warped) {
    const WarpMap back(truth.view, reference.view);
    const View& view = reference.view;
    size_t cracks = 0;
    for (uint32_t row = 0; row < truth.view.height; ++row)
        for (uint32_t i = 0; i < truth.view.width; ++i) {
            const size_t at = size_t{row} * truth.view.width + i;
            if (warped.nearness[at] >= 0) continue;
            const float nearness = truth.samples[at].nearness;
            const glm::dvec3 there = back.at(i, row, nearness);
            const glm::dvec2 place = glm::dvec2(there) / there.z;
            if (!(there.z > 0) || place.x < 1 || place.y < 1 || place.x > view.width - 2.0 ||
                place.y > view.height - 2.0)
                continue;
            // All four samples around are of what is at that depth.
            bool seen = true;
            for (const double y : {std::floor(place.y), std::floor(place.y) + 1})
                for (const double x : {std::floor(place.x), std::floor(place.x) + 1}) {
                    const DepthSample& s =
                        reference.samples[static_cast<size_t>(y) * view.width + static_cast<size_t>(x)];
                    const double expected =
                        nearness / there.z + s.per_sample * (x - place.x) + s.per_row * (y - place.y);
                    seen &= std::abs(s.nearness - expected) < 0.02 * expected + 1e-9;
                }
            cracks += seen;
        }
    return cracks;
}

TEST(Warp, LeavesNoCracksInARoom) {
    Random random(12);
    size_t all = 0, holes = 0;
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        const DoorwayRoom room(seed);
        const DepthImage reference = room.take({0.5, 1.2, 1.5}, 60, 120);
        const glm::dvec3 eye = glm::dvec3(0.5, 1.2, 1.5) + randomVector(random, {0.6, 0.3, 0.6});
        const DepthImage truth = room.take(eye, 60, 120);
        WarpedImage warped(truth.view);
        warp(reference, truth.view, warped);
        all += cracks(reference, truth, warped);
        holes += warped.holes();
    }
    EXPECT_EQ(all, 0u);
    EXPECT_GT(holes, 100u) << "there are true holes";
}

/// A wavy sheet seen from within, in fine facets.
TestMesh waves() {
    TestMesh mesh;
    constexpr uint32_t kSide = 40;
    for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x < kSide; ++x)
            mesh.positions.push_back(
                {-4 + 0.23f * static_cast<float>(x), -3 + 0.2f * static_cast<float>(y),
                 -3 + 0.5f * std::sin(0.6f * static_cast<float>(x)) + 0.4f * std::cos(0.5f * static_cast<float>(y))});
    mesh.addGrid(kSide, kSide);
    return mesh;
}

TEST(Warp, LeavesNoCracksWhereASurfaceBends) {
    const TestMesh mesh = waves();
    const std::vector<uint8_t> both_sides(mesh.view().triangles(), 1);
    DrawItem item;
    item.mesh = mesh.view();
    item.double_sided = both_sides;
    const DrawList list({&item, 1});
    Random random(13);
    for (int i = 0; i < 20; ++i) {
        const View from = squareView({0.5, 1.2, 1.5});
        const View to = squareView(glm::dvec3(0.5, 1.2, 1.5) + randomVector(random, {0.5, 0.3, 0.7}));
        const DepthImage reference = takeImage(list, from, {}), truth = takeImage(list, to, {});
        WarpedImage warped(to);
        warp(reference, to, warped);
        EXPECT_EQ(cracks(reference, truth, warped), 0u) << "case " << i;
    }
}

TEST(Warp, OntoItselfChangesNothing) {
    const DoorwayRoom room(3);
    const DepthImage image = room.take({0.3, 1.1, 1.2}, 60, 120);
    WarpedImage warped(image.view);
    warp(image, image.view, warped);
    EXPECT_EQ(warped.holes(), 0u);
    EXPECT_EQ(warped.colour, coloursOf(image));
}

TEST(Warp, DrawsNoBacks) {
    // A thin upright sheet: from one side its front is seen, from the other nothing is.
    TestMesh mesh;
    mesh.add({{0.5f, -5, -1}, {0.5f, -5, -3}, {0.5f, 5, -3}, {0.5f, 5, -1}});
    DrawItem item;
    item.mesh = mesh.view();
    const DrawList list({&item, 1});
    const View left = squareView({0.1, 1, 1}), right = squareView({0.9, 1, 1});
    const auto shows = [](const DepthImage& image) {
        return std::any_of(image.samples.begin(), image.samples.end(),
                           [](const DepthSample& s) { return s.nearness > 0; });
    };
    const DepthImage a = takeImage(list, left, {}), b = takeImage(list, right, {});
    ASSERT_NE(shows(a), shows(b));
    const DepthImage& front = shows(a) ? a : b;
    WarpedImage warped(front.view);
    warp(front, shows(a) ? right : left, warped);
    EXPECT_TRUE(std::none_of(warped.nearness.begin(), warped.nearness.end(), [](float n) { return n > 0; }));
}

TEST(WarpedImage, HolesAreCountedAndFilledFromTheFartherSide) {
    View view;
    view.width = 4;
    view.height = 2;
    WarpedImage image(view);
    EXPECT_EQ(image.holes(), 8u);
    EXPECT_EQ(fillHoles(image), 8u) << "an image without anything stays as it is";
    image.nearness[0] = 0.5f;
    image.colour[0] = {1, 1, 1};
    image.nearness[3] = 0.1f;
    image.colour[3] = {2, 2, 2};
    EXPECT_EQ(fillHoles(image), 6u);
    EXPECT_EQ(image.holes(), 0u);
    EXPECT_EQ(image.colour[1], glm::u8vec3(2));
    EXPECT_EQ(image.colour[2], glm::u8vec3(2));
    EXPECT_EQ(image.colour[4], glm::u8vec3(1)) << "the row above is empty: from below";
}

TEST(WarpedImage, MergingFillsHolesAndPutsTheNearerBefore) {
    View view;
    view.width = 4;
    view.height = 1;
    WarpedImage image(view), other(view);
    image.nearness = {-1, 0.5f, 0.5f, 0.5f};
    other.nearness = {0.2f, 0.6f, 0.505f, -1};
    other.colour.assign(4, glm::u8vec3(9));
    mergeInto(image, other, 0.02);
    EXPECT_EQ(image.colour[0], glm::u8vec3(9));
    EXPECT_EQ(image.colour[1], glm::u8vec3(9));
    EXPECT_EQ(image.colour[2], glm::u8vec3(0)) << "within the tolerance the first stays";
    EXPECT_EQ(image.colour[3], glm::u8vec3(0));
}

}  // namespace
}  // namespace sightline::test
