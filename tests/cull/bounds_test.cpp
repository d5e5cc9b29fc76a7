// The law of bounds: what shares a point with the volume is kept, and exact tests keep nothing else.
// SPDX-License-Identifier: MIT
#include "sightline/cull/bounds.h"

#include <gtest/gtest.h>

#include "tests/cull/long_tests.h"
#include "tests/studies/frustum/clip_oracle.h"

namespace sightline {
namespace {

using test::Touch;
using test::TruthVolume;

constexpr int kBoundsPerVolume = 100;

struct Counts {
    size_t together = 0, apart = 0, kept_apart = 0, left_apart = 0;
};

/// Near to the origin and far from it; what rounding may decide grows with that.
template <class Try>
Counts forEachPair(uint64_t seed, int shorter, Try attempt) {
    Counts counts;
    Random random(seed);
    const int pairs = test::pairsToMake(shorter);
    ::testing::Test::RecordProperty("pairs", pairs);
    for (int round = 0; round < pairs / kBoundsPerVolume; ++round) {
        const double far = round % 4 == 3 ? 1e6 : 1.0;
        const TruthVolume truth = test::randomVolume(random, far);
        for (int i = 0; i < kBoundsPerVolume && !::testing::Test::HasFatalFailure(); ++i)
            attempt(random, truth, 1e-10 * (100.0 + far), round, counts);
    }
    ::testing::Test::RecordProperty("together", static_cast<int>(counts.together));
    ::testing::Test::RecordProperty("apart", static_cast<int>(counts.apart));
    ::testing::Test::RecordProperty("kept_apart", static_cast<int>(counts.kept_apart));
    return counts;
}

/// What holds of every kind of bound that has a body.
template <class Bound>
void judge(const Bound& bound, const TruthVolume& truth, double band, int round, Counts& counts, bool exactly_outside) {
    const test::Body body = test::bodyOf(bound);
    const Touch touch = test::touch(body, truth, band + 1e-11 * body.size);
    const BoundAnswer answer = testBound(truth.volume, bound);
    if (touch == Touch::kTogether) {
        ++counts.together;
        ASSERT_FALSE(answer.outside) << "round " << round;
        ASSERT_FALSE(exactly_outside) << "round " << round;
    }
    if (touch == Touch::kApart) {
        ++counts.apart;
        counts.kept_apart += !answer.outside;
        counts.left_apart += !answer.outside && !exactly_outside;
        ASSERT_NE(answer.planes, 0u) << "inside, round " << round;
    }
    for (uint32_t k = 0; k < truth.volume.count; ++k) {
        const glm::dvec4& plane = truth.volume.planes[k];
        double least = INFINITY;
        for (const test::Polygon& face : body.faces)
            for (const glm::dvec3& corner : face)
                least = std::min(least, glm::dot(glm::dvec3(plane), corner - truth.volume.eye) + plane.w);
        const double doubt = band + 1e-11 * body.size;
        if (least < -doubt) { ASSERT_TRUE(answer.planes >> k & 1) << "round " << round; }
        if (least > doubt) { ASSERT_FALSE(answer.planes >> k & 1) << "round " << round; }
    }
}

TEST(Bounds, BoxesAreKeptIfTheyTouchAndTheSeparatingAxesKeepNoOthers) {
    RefinedVolume refined;
    int of_round = -1;
    size_t by_corners = 0;
    const Counts counts =
        forEachPair(21, 200000, [&](Random& random, const TruthVolume& truth, double band, int round, Counts& c) {
            if (round != of_round) refined = refineVolume(truth.volume), of_round = round;
            const Box3d box = test::randomBox(random, truth);
            const bool corners = separated(refined, box, Refinement::kCorners);
            const bool axes = separated(refined, box, Refinement::kSeparatingAxes);
            ASSERT_TRUE(axes || !corners);
            by_corners += corners && !testBound(truth.volume, box).outside;
            judge(box, truth, band, round, c, axes);
        });
    EXPECT_GT(counts.together, counts.apart / 10);
    EXPECT_GT(counts.kept_apart, counts.apart / 100);  // there is something to refine
    EXPECT_EQ(counts.left_apart, 0u) << "of " << counts.kept_apart;
    EXPECT_GT(by_corners, counts.kept_apart / 4);
}

TEST(Bounds, OrientedBoxesAreKeptIfTheyTouchAndTheSeparatingAxesKeepNoOthers) {
    const Counts counts =
        forEachPair(22, 200000, [&](Random& random, const TruthVolume& truth, double band, int round, Counts& c) {
            const OrientedBox box = test::randomOriented(random, truth);
            const bool kept = !testBound(truth.volume, box).outside;  // it is dear: asked where it matters
            const bool axes = kept && separated(truth.volume, box, Refinement::kSeparatingAxes);
            if (kept && separated(truth.volume, box, Refinement::kCorners)) { ASSERT_TRUE(axes); }
            judge(box, truth, band, round, c, axes);
        });
    EXPECT_GT(counts.kept_apart, counts.apart / 100);
    EXPECT_EQ(counts.left_apart, 0u) << "of " << counts.kept_apart;
}

TEST(Bounds, DopsAreKeptIfTheyTouchAndAreNeverLooserThanTheirBoxes) {
    size_t looser = 0;
    const Counts counts =
        forEachPair(23, 25000, [&](Random& random, const TruthVolume& truth, double band, int round, Counts& c) {
            const Dop dop = test::randomDop(random, truth);
            const Box3d box{{dop.min[0], dop.min[1], dop.min[2]}, {dop.max[0], dop.max[1], dop.max[2]}};
            judge(dop, truth, band, round, c, false);
            const BoundAnswer of_box = testBound(truth.volume, box), of_dop = testBound(truth.volume, dop);
            looser += !of_dop.outside && of_box.outside;
        });
    EXPECT_GT(counts.together, counts.apart / 20);
    EXPECT_LE(looser, counts.apart / 10000);  // where rounding decides
}

TEST(Bounds, SpheresAreKeptIfTheyTouchAndTheDistanceIsExact) {
    size_t beyond_edges = 0;
    const Counts counts =
        forEachPair(24, 10000, [&](Random& random, const TruthVolume& truth, double band, int round, Counts& c) {
            const Sphere sphere = test::randomSphere(random, truth);
            const double size = glm::length(sphere.center - truth.volume.eye) + sphere.radius;
            const double expected = test::distanceByFaces(truth.volume, sphere.center, 1e4);
            const double doubt = band + 1e-9 * size;
            ASSERT_NEAR(distanceTo(truth.volume, sphere.center), expected, doubt) << "round " << round;
            const BoundAnswer answer = testBound(truth.volume, sphere);
            const bool exact = surelyOutside(truth.volume, sphere);
            if (expected < sphere.radius - doubt) { ASSERT_FALSE(answer.outside || exact) << "round " << round; }
            if (expected > sphere.radius + doubt) { ASSERT_TRUE(exact) << "round " << round; }
            const bool is_apart = expected > sphere.radius + doubt;
            c.together += expected < sphere.radius - doubt;
            c.apart += is_apart;
            c.kept_apart += is_apart && !answer.outside;
            beyond_edges += exact && !answer.outside;
        });
    EXPECT_GT(counts.together, 0u);
    EXPECT_GT(beyond_edges, 0u);
}

TEST(Bounds, PlanesThatHoldTheParentNeedNotBeAsked) {
    const Counts counts =
        forEachPair(25, 200000, [&](Random& random, const TruthVolume& truth, double, int round, Counts& c) {
            const Box3d parent = test::randomBox(random, truth);
            glm::dvec3 p[2];
            for (glm::dvec3& q : p)
                for (int axis = 0; axis < 3; ++axis) q[axis] = random.uniform(parent.min[axis], parent.max[axis]);
            const Box3d child{glm::min(p[0], p[1]), glm::max(p[0], p[1])};
            const BoundAnswer above = testBound(truth.volume, parent), all = testBound(truth.volume, child);
            const BoundAnswer masked = testBound(truth.volume, child, above.planes);
            ASSERT_EQ(masked.outside, all.outside) << "round " << round;
            ASSERT_EQ(masked.planes, all.planes) << "round " << round;
            c.together += above.planes != truth.volume.allPlanes();
        });
    EXPECT_GT(counts.together, 0u);
}

TEST(Bounds, WhatIsNotFiniteIsKept) {
    View view;
    view.projection = perspective(1.0, 1.0, 0.1, 100.0);
    const ViewVolume volume = volumeOf(makeFrustum(view));
    const RefinedVolume refined = refineVolume(volume);
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        for (int place = 0; place < 6; ++place) {
            Box3d box{{50, 50, 50}, {51, 51, 51}};  // behind
            (place < 3 ? box.min[place] : box.max[place - 3]) = place < 3 ? -bad : bad;
            EXPECT_FALSE(testBound(volume, box).outside) << place;
            EXPECT_FALSE(testBound(volume, box).inside()) << place;
            EXPECT_FALSE(separated(refined, box, Refinement::kSeparatingAxes)) << place;
            OrientedBox oriented{{50, 50, 50}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
            (place < 3 ? oriented.center[place] : oriented.half[place - 3][1]) = bad;
            EXPECT_FALSE(testBound(volume, oriented).outside) << place;
            EXPECT_FALSE(separated(volume, oriented, Refinement::kSeparatingAxes)) << place;
            Dop dop;
            dop.grow({50, 50, 50});
            (place % 2 ? dop.max : dop.min)[place] = bad;
            EXPECT_FALSE(testBound(volume, dop).outside) << place;
            Sphere sphere{{50, 50, 50}, 1};
            (place < 3 ? sphere.center[place] : sphere.radius) = bad;
            EXPECT_FALSE(testBound(volume, sphere).outside) << place;
            EXPECT_FALSE(surelyOutside(volume, sphere)) << place;
        }
    EXPECT_FALSE(testBound(volume, Dop()).outside);  // an empty bound says nothing about what it is of
    EXPECT_FALSE(testBound(volume, Box3d()).outside);
}

TEST(Bounds, TheRefinementCullsTheBoxBeyondACornerThatThePlanesKeep) {
    View view;
    view.width = view.height = 100;
    view.jitter = 0;
    view.projection = perspective(glm::radians(90.0), 1.0, 1.0, 100.0);
    const ViewVolume volume = volumeOf(makeFrustum(view));
    const Box3d box{{105, -1, -120}, {300, 1, -95}};
    EXPECT_FALSE(testBound(volume, box).outside);
    EXPECT_TRUE(separated(refineVolume(volume), box, Refinement::kCorners));
    // Under the left plane's edge with the floor, seen along the edge: only a plane along two edges tells.
    EXPECT_TRUE(surelyOutside(volume, {{110, 0, -110}, 13}));
    EXPECT_FALSE(testBound(volume, Sphere{{110, 0, -110}, 13}).outside);
    EXPECT_FALSE(surelyOutside(volume, {{110, 0, -110}, 15}));
}

TEST(Bounds, AnOrientedBoxHoldsTheCornersOfWhatItWasMadeOf) {
    Random random(26);
    for (int round = 0; round < 1000; ++round) {
        glm::dmat4 transform(1.0);
        for (int column = 0; column < 4; ++column)
            transform[column] = glm::dvec4(3.0 * test::randomUnit(random), column == 3);
        const Box3d box{100.0 * test::randomUnit(random), glm::dvec3(110.0)};
        const test::Body body = test::bodyOf(orientedBox(box, transform));
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 p = glm::dvec3(transform * glm::dvec4(corner & 1 ? box.max.x : box.min.x,
                                                                   corner & 2 ? box.max.y : box.min.y,
                                                                   corner & 4 ? box.max.z : box.min.z, 1.0));
            for (const glm::dvec4& plane : body.planes) ASSERT_GE(glm::dot(glm::dvec3(plane), p) + plane.w, -1e-9);
        }
    }
}

}  // namespace
}  // namespace sightline
