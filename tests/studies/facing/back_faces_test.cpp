// The law of back faces: none that is seen from its front is taken for one, on any instruction set; all are found but in a band.
// SPDX-License-Identifier: MIT
#include "sightline/studies/facing/back_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "sightline/studies/facing/triangle_planes.h"
#include "tests/cull/facing_oracle.h"
#include "tests/support/targets.h"

namespace sightline {
using namespace studies;
namespace {

using test::Quad;

constexpr size_t kBatch = 2000, kBytes = (kBatch + 15) / 16 * 2;

FacingEye eyeAt(const glm::dvec3& point, double w, FrontFace front = FrontFace::kCounterClockwise) {
    return {point, w, 0.0, front};
}

/// Writes the answers of each instruction set; they must be the same.
template <class Find>
std::vector<uint8_t> onAllTargets(const Find& find) {
    std::vector<uint8_t> first;
    test::forEachTarget([&](const std::string& target) {
        std::vector<uint8_t> back(kBytes, 0xff);
        const size_t found = find(back);
        size_t bits = 0;
        for (size_t i = 0; i < kBytes * 8; ++i) bits += test::bitOf(back, i);
        EXPECT_EQ(found, bits) << target;
        if (first.empty()) first = back;
        EXPECT_EQ(back, first) << target;
    });
    return first;
}

TEST(BackFaces, NoFrontFaceIsTakenForABackFace) {
    Random random(71);
    const size_t batches = test::casesToMake(1000000) / kBatch;
    size_t fronts = 0, backs = 0, found = 0;
    for (size_t batch = 0; batch < batches && !HasFailure(); ++batch) {
        const glm::dvec3 place = test::randomVector(random, batch % 3 ? 1.0 : 1e4);
        const bool parallel = batch % 4 == 3, clockwise = batch % 5 == 4;
        const glm::dvec3 eye = parallel
                                   ? test::randomUnit(random)
                                   : place + test::randomVector(random, std::ldexp(1.0, int(random.below(14)) - 4));
        const double size = 0.5;
        const test::TestMesh mesh =
            test::randomTriangles(random, kBatch, place, size, parallel ? place + 8.0 * eye : eye);
        const TrianglePlanes planes = makeTrianglePlanes(mesh.view());
        const FacingEye facing =
            eyeAt(eye, parallel ? 0.0 : 1.0, clockwise ? FrontFace::kClockwise : FrontFace::kCounterClockwise);
        const std::vector<uint8_t> back =
            onAllTargets([&](std::vector<uint8_t>& bits) { return findBackFaces(planes, facing, bits); });
        const double band = 0x1p-18 * (parallel ? 1.0 : glm::length(eye - planes.origin) + planes.reach);
        for (size_t i = 0; i < kBatch; ++i) {
            Quad truth = test::trueFacing(mesh.view(), i, eye, facing.w);
            if (clockwise) truth = -truth;
            const bool marked = test::bitOf(back, i);
            if (truth > 0) ++fronts;
            if (truth > 0) { ASSERT_FALSE(marked) << "batch " << batch << " triangle " << i; }
            if (truth >= 0) continue;
            ++backs, found += marked;
            // Outside of the band each one is found, unless it is hardly more than a line.
            const glm::dvec3 a(mesh.positions[3 * i]), b(mesh.positions[3 * i + 1]), c(mesh.positions[3 * i + 2]);
            const double area = glm::length(glm::cross(b - a, c - a));
            if (area < 0x1p-19 * glm::length(b - a) * glm::length(c - a)) continue;
            if (-truth > Quad(band * area)) { ASSERT_TRUE(marked) << "batch " << batch << " triangle " << i; }
        }
    }
    EXPECT_GT(fronts, backs / 2);
    EXPECT_GT(static_cast<double>(found), 0.8 * static_cast<double>(backs));  // the rest was made to be doubtful
}

/// The exact determinant of three rows of floats: each product of three fits into 72 bits, and the sum into 113 if the
/// sizes are alike.
Quad trueDeterminant(const std::vector<float> (&numbers)[3], const uint32_t* v) {
    const auto row = [&](int k) { return test::QuadVector{numbers[0][v[k]], numbers[1][v[k]], numbers[2][v[k]]}; };
    return test::dot(test::cross(row(0), row(1)), row(2));
}

TEST(BackFaces, TheDeterminantHoldsForAnySignOfW) {
    Random random(72);
    const size_t batches = test::casesToMake(1000000) / kBatch;
    size_t fronts = 0, backs = 0, found = 0, doubtful = 0;
    for (size_t batch = 0; batch < batches && !HasFailure(); ++batch) {
        std::vector<float> numbers[3];
        std::vector<uint32_t> indices;
        for (uint32_t i = 0; i < 3 * kBatch; ++i) {
            const glm::dvec3 p = std::ldexp(1.0, int(random.below(20)) - 10) * test::randomVector(random, 4.0);
            for (int k = 0; k < 3; ++k) numbers[k].push_back(static_cast<float>(p[k]));
            indices.push_back(i);
            if (i % 3 == 2 && random.below(3) == 0) {  // the third on the line of the others, or nearly
                const double s = random.uniform(-1, 1), t = random.uniform(-1, 1);
                for (int k = 0; k < 3; ++k)
                    numbers[k][i] = static_cast<float>(s * numbers[k][i - 1] + t * numbers[k][i - 2]);
            }
        }
        const HomogeneousVertices vertices{numbers[0], numbers[1], numbers[2]};
        const bool clockwise = batch % 2, mirrored = batch % 3 == 0;
        const std::vector<uint8_t> back = onAllTargets([&](std::vector<uint8_t>& bits) {
            return findBackFaces(vertices, indices, clockwise ? FrontFace::kClockwise : FrontFace::kCounterClockwise,
                                 mirrored, bits);
        });
        for (size_t i = 0; i < kBatch; ++i) {
            Quad truth = trueDeterminant(numbers, &indices[3 * i]);
            if (clockwise != mirrored) truth = -truth;
            const bool marked = test::bitOf(back, i);
            fronts += truth > 0, backs += truth < 0, found += marked;
            doubtful += truth < 0 && !marked;
            if (truth > 0) { ASSERT_FALSE(marked) << "batch " << batch << " triangle " << i; }
        }
    }
    EXPECT_GT(fronts, found / 2);
    EXPECT_GT(found, backs / 2);
    EXPECT_GT(doubtful, 0u);
}

TEST(BackFaces, TheScreensAreaIsThatOfTheNumbersGiven) {
    Random random(73);
    const size_t batches = test::casesToMake(1000000) / kBatch;
    size_t backs = 0, found = 0;
    for (size_t batch = 0; batch < batches && !HasFailure(); ++batch) {
        std::vector<float> x, y;
        std::vector<uint32_t> indices;
        for (uint32_t i = 0; i < 3 * kBatch; ++i) {
            x.push_back(static_cast<float>(random.uniform(0, 4000)));
            y.push_back(static_cast<float>(random.uniform(0, 4000)));
            indices.push_back(i);
            if (i % 3 == 2 && random.below(3) == 0) {
                const float t = static_cast<float>(random.uniform(-1, 2));
                x[i] = x[i - 1] + t * (x[i - 2] - x[i - 1]), y[i] = y[i - 1] + t * (y[i - 2] - y[i - 1]);
            }
        }
        const bool clockwise = batch % 2, mirrored = batch % 3 == 0;
        const std::vector<uint8_t> back = onAllTargets([&](std::vector<uint8_t>& bits) {
            return findBackFaces(ScreenVertices{x, y}, indices,
                                 clockwise ? FrontFace::kClockwise : FrontFace::kCounterClockwise, mirrored, bits);
        });
        for (size_t i = 0; i < kBatch; ++i) {
            const auto at = [](const std::vector<float>& numbers, size_t k) { return Quad(numbers[k]); };
            Quad truth = (at(x, 3 * i + 1) - at(x, 3 * i)) * (at(y, 3 * i + 2) - at(y, 3 * i)) -
                         (at(x, 3 * i + 2) - at(x, 3 * i)) * (at(y, 3 * i + 1) - at(y, 3 * i));
            if (clockwise != mirrored) truth = -truth;
            backs += truth < 0, found += test::bitOf(back, i);
            if (truth > 0) { ASSERT_FALSE(test::bitOf(back, i)) << "batch " << batch << " triangle " << i; }
        }
    }
    EXPECT_GT(static_cast<double>(found), 0.6 * static_cast<double>(backs));
}

TEST(BackFaces, AnEdgeOnOrBrokenTriangleIsKeptByDoubt) {
    test::TestMesh mesh;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    mesh.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});  // counter-clockwise from +z
    mesh.add({0, 0, 0}, {0, 1, 0}, {1, 0, 0});  // from -z
    mesh.add({0, 0, 0}, {1, 0, 0}, {2, 0, 0});  // a line
    mesh.add({0, 0, 0}, {1, 0, 0}, {1, 0, 1});  // edge-on from the plane y = 0
    const TrianglePlanes planes = makeTrianglePlanes(mesh.view());
    std::vector<uint8_t> back(2);
    EXPECT_EQ(findBackFaces(planes, eyeAt({0.2, 0.0, 5.0}, 1.0), back), 1u);
    EXPECT_EQ(back[0], 0b0010);
    EXPECT_EQ(findBackFaces(planes, eyeAt({0.2, 0.0, -5.0}, 1.0), back), 1u);
    EXPECT_EQ(back[0], 0b0001);
    EXPECT_EQ(findBackFaces(planes, eyeAt({0.2, 0.0, 5.0}, 1.0, FrontFace::kClockwise), back), 1u);
    EXPECT_EQ(back[0], 0b0001);
    EXPECT_EQ(findBackFaces(planes, eyeAt({0, 0, -1}, 0.0), back), 1u);
    EXPECT_EQ(back[0], 0b0001);
    for (const double odd : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e200})
        EXPECT_EQ(findBackFaces(planes, eyeAt({odd, 0.0, 5.0}, 1.0), back), 0u);
    FacingEye unknown = eyeAt({0, 0, 5}, 1.0);
    unknown.error = 6.0;  // it might be on the other side
    EXPECT_EQ(findBackFaces(planes, unknown, back), 0u);
    mesh.positions[0].x = nan;
    EXPECT_EQ(findBackFaces(makeTrianglePlanes(mesh.view()), eyeAt({0, 0, -5}, 1.0), back), 0u);
}

TEST(BackFaces, ADividedCornerBehindTheEyeIsTheDeterminantsAlone) {
    // A front face of which one corner lies behind the eye: the divided corners run the other way round.
    const std::vector<float> x{-1, 1, 0}, y{-1, -1, -2}, w{1, 1, -1};
    std::vector<float> sx, sy;
    for (int i = 0; i < 3; ++i) sx.push_back(x[i] / w[i]), sy.push_back(y[i] / w[i]);
    const std::vector<uint32_t> indices{0, 1, 2};
    std::vector<uint8_t> back(2);
    const size_t exact =
        findBackFaces(HomogeneousVertices{x, y, w}, indices, FrontFace::kCounterClockwise, false, back);
    const size_t divided = findBackFaces(ScreenVertices{sx, sy}, indices, FrontFace::kCounterClockwise, false, back);
    EXPECT_NE(exact, divided);
}

}  // namespace
}  // namespace sightline
