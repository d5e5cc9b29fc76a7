// Scan conversion without clipping covers what clipping and scan conversion cover.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/project/homogeneous.h"

#include <cmath>
#include <cstdio>
#include <limits>

#include <gtest/gtest.h>

#include "sightline/studies/hidden/project/projector.h"
#include "tests/studies/hidden/made_lists.h"

namespace sightline::test {
using namespace studies;
namespace {

constexpr uint32_t kWidth = 160, kHeight = 120;
/// Samples nearer to an outline than this may belong to either side.
constexpr double kImageBand = 1e-6;

double distanceToOutline(const glm::dvec2& p, std::span<const glm::dvec2> outline) {
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec2 &a = outline[i], &b = outline[(i + 1) % outline.size()], ab = b - a;
        const double length = glm::dot(ab, ab);
        const double t = length > 0 ? std::clamp(glm::dot(p - a, ab) / length, 0.0, 1.0) : 0.0;
        nearest = std::min(nearest, glm::length(p - a - t * ab));
    }
    return nearest;
}

struct Difference {
    uint64_t samples = 0, in_band = 0, wrong = 0;
    double depth = 0;  ///< the largest difference in nearness, relative
};

/// A triangle's nearness where it covers a sample, and NaN elsewhere.
using Layer = std::vector<double>;

/// Adds up how two ways to draw one triangle differ.
void addDifference(const Layer& one, const Layer& other, std::span<const glm::dvec2> outline, Difference& sum) {
    for (size_t at = 0; at < one.size(); ++at) {
        const bool in_one = !std::isnan(one[at]), in_other = !std::isnan(other[at]);
        sum.samples += in_one;
        if (in_one && in_other)
            sum.depth = std::max(sum.depth, std::abs(one[at] - other[at]) / (std::abs(one[at]) + 1e-3));
        if (in_one == in_other) continue;
        const glm::dvec2 place(double(at % kWidth) + 0.5, double(at / kWidth) + 0.5);
        ++(distanceToOutline(place, outline) <= kImageBand ? sum.in_band : sum.wrong);
    }
}

template <class Scan>
Layer layerOf(Scan&& scan, const DepthPlane& depth) {
    Layer layer(kWidth * kHeight, std::numeric_limits<double>::quiet_NaN());
    scan([&](int32_t row, int32_t begin, int32_t end) {
        for (int32_t i = begin; i < end; ++i) layer[size_t(row) * kWidth + size_t(i)] = depth.at(row, i);
    });
    return layer;
}

Layer layerOf(const ScreenPolygon& polygon) {
    return layerOf([&](auto&& fill) { scanPolygon(polygon.outline(), 0, kHeight, kWidth, fill); }, polygon.depth);
}

std::vector<View> views() {
    std::vector<View> views(4, madeView(kWidth, kHeight));
    views[1].projection = perspective(1.2, 4.0 / 3, 0.5, 4.5);
    views[2].projection[2][0] = 0.4;  // off-centre
    views[2].projection[2][1] = -0.3;
    views[3].projection = orthographic(4, 4.0 / 3, 0.5, 5);
    return views;
}

TEST(Homogeneous, CoversWhatClippingLeaves) {
    Difference clipless, frustum;
    uint64_t clipped = 0;
    for (const MadeList& made : madeLists())
        for (const View& view : views()) {
            const std::vector<DrawItem> items = made.items();
            const SampleGrid grid{kWidth, kHeight, 0, 1, {}};
            Projector band(view, grid), sides(view, grid, {.clipping = Clipping::kFrustum}), none(view, grid);
            for (Projector* projector : {&band, &sides, &none}) projector->begin(items[0]);
            const Layer empty(kWidth * kHeight, std::numeric_limits<double>::quiet_NaN());
            for (size_t t = 0; t < items[0].mesh.triangles(); ++t) {
                ScreenPolygon polygon, cut_polygon;
                HomogeneousTriangle triangle;
                const bool drawn = band.project(t, polygon);
                const Layer expected = drawn ? layerOf(polygon) : empty;
                if (!drawn) polygon.count = 0;
                const bool cut_drawn = sides.project(t, cut_polygon);
                addDifference(expected, cut_drawn ? layerOf(cut_polygon) : empty, polygon.outline(), frustum);
                const bool found = none.projectHomogeneous(t, triangle);
                const auto scan = [&](auto&& fill) { scanHomogeneous(triangle, 0, kHeight, kWidth, fill); };
                addDifference(expected, found ? layerOf(scan, triangle.depth) : empty, polygon.outline(), clipless);
                ASSERT_EQ(clipless.wrong, 0u) << made.name << ", triangle " << t;
                ASSERT_EQ(frustum.wrong, 0u) << made.name << ", triangle " << t;
            }
            clipped += band.counters().clipped;
            EXPECT_EQ(none.counters().clipped, 0u);
            EXPECT_GE(sides.counters().clipped, band.counters().clipped);
        }
    std::printf(
        "%zu samples, %zu triangles clipped: without clipping %zu samples differ within %g of an edge, with six "
        "planes %zu\n",
        size_t(clipless.samples), size_t(clipped), size_t(clipless.in_band), kImageBand, size_t(frustum.in_band));
    EXPECT_GT(clipped, 100u);
    EXPECT_LE(clipless.in_band, clipless.samples / 100000);
    EXPECT_LE(frustum.in_band, frustum.samples / 100000);
    EXPECT_LT(clipless.depth, 1e-9);
    EXPECT_LT(frustum.depth, 1e-9);
}

/// Corners on samples: the two rules for what lies on an edge are one.
TEST(Homogeneous, GivesSamplesOnEdgesToTheSameSide) {
    constexpr int kSize = 16;
    // x / w = (2 i + 1) / 16 - 1 at sample i: exact.
    const SamplePlaces places{glm::dvec2(2.0 / kSize), glm::dvec2(1.0 / kSize - 1)};
    const SampleGrid grid{kSize, kSize, 0, 1, {}};
    Random random(51);
    for (int i = 0; i < 20000; ++i) {
        glm::dvec2 points[3];
        glm::dvec4 clip[3];
        for (int k = 0; k < 3; ++k) {
            points[k] = glm::dvec2(random.below(kSize + 8), random.below(kSize + 8)) - 3.5;
            const double w = std::ldexp(1.0, int(random.below(5)) - 2);
            clip[k] = glm::dvec4((points[k] - 0.5) * places.scale + places.start, 0.5, 1) * w;
        }
        int expected[kSize * kSize] = {}, found[kSize * kSize] = {};
        const auto addTo = [](int* counts) {
            return [counts](int32_t row, int32_t begin, int32_t end) {
                for (int32_t s = begin; s < end; ++s) ++counts[row * kSize + s];
            };
        };
        scanPolygon(points, 0, kSize, kSize, addTo(expected));
        HomogeneousTriangle triangle;
        if (makeHomogeneous(clip, places, grid, triangle)) scanHomogeneous(triangle, 0, kSize, kSize, addTo(found));
        for (int s = 0; s < kSize * kSize; ++s)
            ASSERT_EQ(found[s], expected[s]) << "case " << i << " sample " << s % kSize << "," << s / kSize;
    }
}

TEST(Homogeneous, TakesTrianglesAroundTheEye) {
    // The eye lies within the triangle's shadow; half of its plane is seen below the horizon.
    const SamplePlaces places{glm::dvec2(2.0 / 16), glm::dvec2(1.0 / 16 - 1)};
    const SampleGrid grid{16, 16, 0, 1, {}};
    const auto ground = [](double x, double depth) { return glm::dvec4(x, -1, depth - 0.1, depth); };
    HomogeneousTriangle triangle;
    ASSERT_TRUE(makeHomogeneous({ground(-1000, -1000), ground(1000, -1000), ground(0, 2000)}, places, grid, triangle));
    EXPECT_TRUE(triangle.has_near);
    uint64_t above = 0, below = 0;
    scanHomogeneous(triangle, 0, 16, 16, [&](int32_t row, int32_t begin, int32_t end) {
        (row < 8 ? below : above) += uint64_t(end - begin);
    });
    EXPECT_EQ(above, 0u);
    EXPECT_EQ(below, 8u * 16u);
}

TEST(Homogeneous, RefusesWhatHasNoAreaOrIsNotFinite) {
    const SamplePlaces places{glm::dvec2(2.0 / 16), glm::dvec2(1.0 / 16 - 1)};
    const SampleGrid grid{16, 16, 0, 1, {}};
    HomogeneousTriangle triangle;
    const glm::dvec4 a(0, 0, 1, 1), b(1, 0, 1, 1), nan(std::numeric_limits<double>::quiet_NaN(), 0, 1, 1);
    EXPECT_FALSE(makeHomogeneous({a, b, b}, places, grid, triangle));
    EXPECT_FALSE(makeHomogeneous({a, b, 0.5 * (a + b)}, places, grid, triangle));
    EXPECT_FALSE(makeHomogeneous({a, b, nan}, places, grid, triangle));
}

}  // namespace
}  // namespace sightline::test
