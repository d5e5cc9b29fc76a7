// Depth formats: monotonic, as fine as predicted, and as able to tell surfaces apart as was measured before.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/zbuffer/depth_format.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sightline/base/random.h"

namespace sightline::test {
using namespace studies;
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr DepthRange kWide{0.1, 1e4, false};

std::string nameOf(const DepthCodec& codec) {
    return std::string(kDepthFormatNames[static_cast<int>(codec.format)]) +
           (codec.range.orthographic ? ", parallel" : "");
}

std::vector<DepthCodec> allCodecs() {
    std::vector<DepthCodec> codecs;
    for (int format = 0; format < kDepthFormats; ++format)
        for (const DepthRange& range :
             {kWide, DepthRange{0.1, kInfinity, false}, DepthRange{0.1, 1e4, true}, DepthRange{-50, 1000, true}})
            codecs.emplace_back(static_cast<DepthFormat>(format), range);
    return codecs;
}

TEST(DepthFormat, NearerIsNeverFarther) {
    for (const DepthCodec& codec : allCodecs()) {
        Random random(5);
        const bool parallel = codec.range.orthographic;
        for (int i = 0; i < 250000; ++i) {
            // Neighbours in double, near ones, and any two; some beyond both planes.
            const double distance = parallel ? random.uniform(-100, 1.1e4) : std::pow(10.0, random.uniform(-2, 6));
            const double a = codec.nearnessAt(distance);
            const double ulps[3] = {0x1p-52, 0x1p-24, 0x1p-3};
            const double b = a + std::abs(a) * ulps[i % 3];
            const DepthKey far_key = codec.encode(a), near_key = codec.encode(b);
            ASSERT_EQ(codec.convention.nearer(far_key, near_key), near_key)
                << nameOf(codec) << " nearness " << a << " and " << b;
        }
    }
}

TEST(DepthFormat, AllIsDerivedFromTheConvention) {
    for (const DepthCodec& codec : allCodecs()) {
        const DepthConvention& c = codec.convention;
        EXPECT_TRUE(passes(c.comparison, c.near_value, c.far_value)) << nameOf(codec);
        EXPECT_EQ(c.nearer(c.near_value, c.far_value), c.near_value) << nameOf(codec);
        EXPECT_EQ(c.farther(c.near_value, c.far_value), c.far_value) << nameOf(codec);
        EXPECT_EQ(codec.keyOf(codec.pattern(c.near_value)), c.near_value);
        const double inside = codec.range.far_plane == kInfinity ? 1e3 : 0.5 * codec.range.far_plane;
        EXPECT_TRUE(passes(c.comparison, codec.encodeDistance(inside), c.far_value)) << nameOf(codec);
    }
    EXPECT_EQ(DepthCodec(DepthFormat::kReversedFloat, {0.1, kInfinity, false}).pattern(0), 0u);
    EXPECT_EQ(
        DepthCodec(DepthFormat::kUnorm24, kWide).pattern(DepthCodec(DepthFormat::kUnorm24, kWide).convention.far_value),
        0xffffffu);
}

TEST(DepthFormat, KnowsThePlanesOfAProjection) {
    View view;
    view.view = lookAt({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
    for (const double far_plane : {50.0, 1e4, kInfinity}) {
        view.projection = perspective(1.0, 1.5, 0.25, far_plane);
        DepthRange range = depthRange(view);
        EXPECT_FALSE(range.orthographic);
        EXPECT_NEAR(range.near_plane, 0.25, 1e-12);
        if (far_plane == kInfinity) EXPECT_EQ(range.far_plane, kInfinity);
        else EXPECT_NEAR(range.far_plane, far_plane, 1e-6 * far_plane);
        view.projection = orthographic(10, 1.5, -3, far_plane);
        range = depthRange(view);
        EXPECT_TRUE(range.orthographic);
        if (far_plane == kInfinity) {
            EXPECT_EQ(range.far_plane, kInfinity);
        } else {
            EXPECT_NEAR(range.near_plane, -3, 1e-9 * far_plane);
            EXPECT_NEAR(range.far_plane, far_plane, 1e-9 * far_plane);
        }
    }
}

TEST(DepthFormat, StepsAreAsPredicted) {
    for (const DepthCodec& codec : allCodecs()) {
        Random random(7);
        for (int i = 0; i < 300; ++i) {
            const double low = std::max(codec.range.near_plane, 0.2);
            const double distance = low * std::pow(std::min(codec.range.far_plane, 1e4) / low, random.uniform(0, 0.95));
            const double step = codec.stepAt(distance);
            if (step > 0.02 * distance) continue;  // the slope changes within a step
            // The widest run of one depth among some that follow one another, by halving.
            double widest = 0, at = distance;
            for (int run = 0; run < 12; ++run) {
                double same = at, other = at + 8 * step;
                const DepthKey key = codec.encodeDistance(at);
                ASSERT_NE(key, codec.encodeDistance(other)) << nameOf(codec) << " at " << distance;
                while (other - same > 1e-3 * step) {
                    const double middle = 0.5 * (same + other);
                    (codec.encodeDistance(middle) == key ? same : other) = middle;
                }
                if (run > 0) widest = std::max(widest, other - at);
                at = other;
            }
            EXPECT_LE(widest, 2 * step) << nameOf(codec) << " at " << distance;
            EXPECT_GE(widest, 0.5 * step) << nameOf(codec) << " at " << distance;
        }
    }
}

/// Of pairs of surfaces a relative gap apart, at logarithmically uniform distances: how many have the same or the wrong
/// order of depths. [percent]
template <class Encode>
double indistinct(double gap, bool greater, const Encode& encode) {
    constexpr int kPairs = 1000000;
    Random random(11);
    int count = 0;
    for (int i = 0; i < kPairs; ++i) {
        const double distance = kWide.near_plane * std::pow(kWide.far_plane / kWide.near_plane, random.uniform());
        const auto near_depth = encode(distance), far_depth = encode(distance * (1 + gap));
        count += greater ? !(near_depth > far_depth) : !(near_depth < far_depth);
    }
    return 100.0 * count / kPairs;
}

double indistinct(double gap, const DepthCodec& codec) {
    return indistinct(gap, codec.convention.greaterIsNearer(), [&](double z) { return codec.encodeDistance(z); });
}

/// The share of pairs that a step predicts: where it is wider than the gap, a pair falls into one step by chance. [percent]
double predictedIndistinct(double gap, const DepthCodec& codec) {
    constexpr int kPlaces = 20000;
    double sum = 0;
    for (int i = 0; i < kPlaces; ++i) {
        const double distance = kWide.near_plane * std::pow(kWide.far_plane / kWide.near_plane, (i + 0.5) / kPlaces);
        sum += std::max(0.0, 1 - gap * distance / codec.stepAt(distance));
    }
    return 100 * sum / kPlaces;
}

TEST(DepthFormat, TellsApartAsManyPairsAsWasMeasured) {
    struct Row {
        DepthFormat format;
        double percent[3];
    };
    constexpr double kGaps[3] = {1e-3, 1e-4, 1e-5};
    // At 1e-3 the table's 9.6 % for the first two are of a projection in single precision: see below.
    constexpr Row kRows[] = {{DepthFormat::kFloat, {8.2, 26.9, 46.7}},    {DepthFormat::kUnorm24, {8.2, 26.9, 46.7}},
                             {DepthFormat::kUnorm16, {55.0, 75.0, 94.3}}, {DepthFormat::kUnorm32, {0, 0, 2.4}},
                             {DepthFormat::kLinear, {8.3, 27.0, 46.9}},   {DepthFormat::kReversedFloat, {0, 0, 0}},
                             {DepthFormat::kInverse, {0, 0, 0}},          {DepthFormat::kW, {0, 0, 0}},
                             {DepthFormat::kIntegerInverse, {0, 0, 2.4}}, {DepthFormat::kIntegerShifted, {0, 0, 0}}};
    for (const Row& row : kRows)
        for (int i = 0; i < 3; ++i) {
            const DepthCodec codec(row.format, kWide);
            const double measured = indistinct(kGaps[i], codec);
            // What begins within half a step of the far plane ends beyond it; both are stored as the plane: one pair here.
            const double at_far_plane = row.format == DepthFormat::kUnorm32 ? 5e-4 : 0;
            EXPECT_NEAR(measured, row.percent[i], 0.1 * row.percent[i] + at_far_plane)
                << nameOf(codec) << " gap " << kGaps[i];
            EXPECT_NEAR(measured, predictedIndistinct(kGaps[i], codec), 0.05 * measured + 0.01)
                << nameOf(codec) << " gap " << kGaps[i];
        }
}

TEST(DepthFormat, TellsFewerApartWhereTheProjectionIsInSinglePrecision) {
    // As a vertex shader multiplies by the matrix: z and w in single precision, then the division.
    const float n = 0.1f, f = 1e4f;
    const float a = f / (f - n), b = f * n / (f - n);
    const float gl_a = (f + n) / (f - n), gl_b = 2 * f * n / (f - n);
    const auto window = [&](double z) { return (static_cast<float>(z) * a - b) / static_cast<float>(z); };
    const auto gl = [&](double z) {
        return (static_cast<float>(z) * gl_a - gl_b) / static_cast<float>(z) * 0.5f + 0.5f;
    };
    const auto reversed = [&](double z) { return n / static_cast<float>(z); };
    constexpr double kGaps[3] = {1e-3, 1e-4, 1e-5};
    constexpr double kWindow[3] = {9.6, 27.1, 46.6}, kGl[3] = {9.9, 28.1, 47.8};
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(indistinct(kGaps[i], false, window), kWindow[i], 0.1 * kWindow[i]) << kGaps[i];
        EXPECT_NEAR(indistinct(kGaps[i], false, gl), kGl[i], 0.1 * kGl[i]) << kGaps[i];
        EXPECT_EQ(indistinct(kGaps[i], true, reversed), 0) << kGaps[i];
    }
}

TEST(DepthFormat, ShiftedIntegersHaveTheirGreatestAtTheEye) {
    // (2^32 - 1) / (1 - z), z negative in front: the greatest at the eye, 0 infinitely far away; what is greater is nearer.
    const DepthCodec codec(DepthFormat::kIntegerShifted, {1e-9, kInfinity, false});
    EXPECT_EQ(codec.pattern(codec.encode(1e300)), 0xffffffffu);
    EXPECT_EQ(codec.pattern(codec.encode(0)), 0u);
    EXPECT_EQ(codec.pattern(codec.convention.far_value), 0u);
    EXPECT_TRUE(codec.convention.greaterIsNearer());
    EXPECT_EQ(codec.pattern(codec.encodeDistance(1)), 0x7fffffffu);
}

TEST(DepthFormat, ShiftedIntegersAreNotAffineOverTheImage) {
    // Half way between the images of z = -1 and z = -9, 1/z is half way: z = -1.8.
    const DepthCodec shifted(DepthFormat::kIntegerShifted, kWide), inverse(DepthFormat::kIntegerInverse, kWide);
    const double middle = 0.5 * (1.0 + 1.0 / 9);
    const auto depth = [](const DepthCodec& codec, double nearness) {
        return double(codec.pattern(codec.encode(nearness)));
    };
    const double between = 0.5 * (depth(shifted, 1.0) + depth(shifted, 1.0 / 9));
    EXPECT_NEAR(0x1p32 / between - 1, 2.33, 0.01);  // where interpolated depths put it
    EXPECT_NEAR(0x1p32 / depth(shifted, middle) - 1, 1.8, 1e-6);
    EXPECT_NEAR(0.5 * (depth(inverse, 1.0) + depth(inverse, 1.0 / 9)), depth(inverse, middle), 1.5);
    // And it picks the wrong surface: between z = -1 and -9, a wall at z = -2 is behind.
    EXPECT_LT(between, depth(shifted, 1.0 / 2));
    EXPECT_GT(depth(shifted, middle), depth(shifted, 1.0 / 2));
}

TEST(DepthFormat, OffsetsMoveAwayFromTheEye) {
    const DepthPlane plane{0.5, 1e-3, -2e-3, 0.1, 1.0};
    for (const DepthCodec& codec : allCodecs()) {
        if (codec.range.orthographic) continue;
        const DepthConvention& c = codec.convention;
        const double offset = codec.polygonOffset(plane, 1, 1);
        EXPECT_EQ(codec.polygonOffset(plane, 0, 0), 0);
        EXPECT_TRUE(passes(c.comparison, codec.encode(0.4), codec.encode(0.4, offset))) << nameOf(codec);
        EXPECT_TRUE(passes(c.comparison, codec.encode(0.4, -offset), codec.encode(0.4))) << nameOf(codec);
        // One unit alone is enough to be told apart.
        const double unit = codec.polygonOffset(plane, 0, 1);
        EXPECT_TRUE(passes(c.comparison, codec.encode(0.4), codec.encode(0.4, unit))) << nameOf(codec);
        // The slope's part lets a tilted surface pass before itself, seen from one sample further on.
        const double slope = codec.polygonOffset(plane, 1, 0);
        const DepthKey farther = codec.encode(0.4 - 2e-3);
        EXPECT_EQ(c.farther(codec.encode(0.4, slope), farther), codec.encode(0.4, slope)) << nameOf(codec);
    }
}

}  // namespace
}  // namespace sightline::test
