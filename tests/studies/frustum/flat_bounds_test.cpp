// The law of flat lists: in float, on every instruction set, what shares a point with the volume is kept, and little else.
// SPDX-License-Identifier: MIT
#include "sightline/studies/frustum/flat_bounds.h"

#include <gtest/gtest.h>

#include "tests/cull/long_tests.h"
#include "tests/studies/frustum/clip_oracle.h"
#include "tests/support/targets.h"

namespace sightline {
using namespace studies;
namespace {

using test::TruthVolume;

constexpr size_t kCount = 1000, kPadded = 1008;

/// Bounds per kind and instruction set, in thousands.
int rounds() { return std::max(static_cast<int>(test::pairsToMake(40000) / kCount), 8); }

/// The same bounds in double and, in float around an origin, as arrays.
struct Lists {
    std::vector<Sphere> spheres;
    std::vector<Box3d> boxes;
    std::vector<OrientedBox> oriented;
    std::vector<Dop> dops;
    std::vector<float> numbers[4 + 6 + 12 + 14];
    SphereArrays sphere_arrays;
    BoxArrays box_arrays;
    OrientedBoxArrays oriented_arrays;
    DopArrays dop_arrays;

    Lists(Random& random, const TruthVolume& truth) {
        const glm::dvec3 origin = truth.volume.eye + 30.0 * test::randomUnit(random);
        for (auto& n : numbers) n.assign(kPadded, 0.0f);
        for (size_t i = 0; i < kCount; ++i) {
            // What is in float is the truth here: the lists promise nothing about how numbers came to be rounded.
            const Sphere s = test::randomSphere(random, truth);
            for (int axis = 0; axis < 3; ++axis) numbers[axis][i] = float(s.center[axis] - origin[axis]);
            numbers[3][i] = float(s.radius);
            const Box3f b = roundOutward(test::randomBox(random, truth), origin);
            for (int axis = 0; axis < 3; ++axis) numbers[4 + axis][i] = b.min[axis], numbers[7 + axis][i] = b.max[axis];
            const OrientedBox o = test::randomOriented(random, truth);
            for (int axis = 0; axis < 3; ++axis) {
                numbers[10 + axis][i] = float(o.center[axis] - origin[axis]);
                for (int k = 0; k < 3; ++k) numbers[13 + 3 * k + axis][i] = float(o.half[k][axis]);
            }
            Dop d;
            const glm::dvec3 p = test::randomPlace(random, truth, 1.0) - origin;
            const double size = test::randomSize(random);
            for (int k = 0; k < 6; ++k) d.grow(p + size * test::randomUnit(random));
            for (int k = 0; k < Dop::kSlabs; ++k)
                numbers[22 + k][i] = float(d.min[k]), numbers[29 + k][i] = float(d.max[k]);
        }
        for (size_t i = 0; i < kCount; ++i) readBack(i, origin);
        for (int axis = 0; axis < 3; ++axis) {
            sphere_arrays.center[axis] = numbers[axis].data();
            box_arrays.min[axis] = numbers[4 + axis].data();
            box_arrays.max[axis] = numbers[7 + axis].data();
            oriented_arrays.center[axis] = numbers[10 + axis].data();
            for (int k = 0; k < 3; ++k) oriented_arrays.half[k][axis] = numbers[13 + 3 * k + axis].data();
        }
        sphere_arrays.radius = numbers[3].data();
        for (int k = 0; k < Dop::kSlabs; ++k) {
            dop_arrays.min[k] = numbers[22 + k].data();
            dop_arrays.max[k] = numbers[29 + k].data();
        }
        const auto place = [&](auto& arrays) {
            arrays.count = kCount;
            arrays.origin = origin;
            arrays.reach = 1000.0f;
        };
        place(sphere_arrays), place(box_arrays), place(oriented_arrays), place(dop_arrays);
    }

    void readBack(size_t i, const glm::dvec3& origin) {
        const auto vec = [&](int first) {
            return glm::dvec3(numbers[first][i], numbers[first + 1][i], numbers[first + 2][i]);
        };
        spheres.push_back({origin + vec(0), numbers[3][i]});
        boxes.push_back({origin + vec(4), origin + vec(7)});
        oriented.push_back({origin + vec(10), {vec(13), vec(16), vec(19)}});
        Dop d;
        for (int k = 0; k < Dop::kSlabs; ++k) {
            const double shift = glm::dot(Dop::kDirections[k], origin);
            d.min[k] = numbers[22 + k][i] + shift;
            d.max[k] = numbers[29 + k][i] + shift;
        }
        dops.push_back(d);
    }
};

/// Exactly what the test in double says, but for a band that float cannot tell; and that, for boxes and spheres, is what
/// the other tests hold against clipping.
template <class Bound, class Arrays>
void judge(const TruthVolume& truth, const std::vector<Bound>& bounds, const Arrays& arrays, const std::string& target,
           size_t& culled, bool exact = true) {
    std::vector<uint32_t> masks(kPadded), kept(kPadded), expected;
    testBounds(truth.volume, arrays, masks);
    kept.resize(cullBounds(truth.volume, arrays, kept));
    for (uint32_t i = 0; i < kCount; ++i)
        if (masks[i] != kOutsideMask) expected.push_back(i);
    ASSERT_EQ(kept, expected) << target;
    const double band = 0.1;  // a few of the margins
    ViewVolume wider = truth.volume, narrower = truth.volume;
    for (uint32_t k = 0; k < wider.count; ++k) wider.planes[k].w += band, narrower.planes[k].w -= band;
    for (size_t i = 0; i < kCount; ++i) {
        const BoundAnswer answer = testBound(truth.volume, bounds[i]);
        const BoundAnswer wide = testBound(wider, bounds[i]), narrow = testBound(narrower, bounds[i]);
        if (!answer.outside) { ASSERT_NE(masks[i], kOutsideMask) << target << " bound " << i; }
        if (exact && wide.outside) { ASSERT_EQ(masks[i], kOutsideMask) << target << " bound " << i; }
        if (masks[i] == kOutsideMask) {
            ++culled;
            continue;
        }
        ASSERT_EQ(answer.planes & ~masks[i], 0u) << target << " bound " << i;  // never "inside" by mistake
        if (exact) { ASSERT_EQ(masks[i] & ~narrow.planes, 0u) << target << " bound " << i; }
    }
}

TEST(FlatBounds, AgreeWithTheTestsInDoubleOnEveryInstructionSet) {
    std::vector<std::vector<uint32_t>> first;
    test::forEachTarget([&](const std::string& target) {
        Random random(31);
        size_t culled[4] = {};
        for (int round = 0; round < rounds() && !::testing::Test::HasFatalFailure(); ++round) {
            const TruthVolume truth = test::randomVolume(random, round % 2 ? 1e6 : 0.0);
            const Lists lists(random, truth);
            judge(truth, lists.spheres, lists.sphere_arrays, target, culled[0]);
            judge(truth, lists.boxes, lists.box_arrays, target, culled[1]);
            judge(truth, lists.oriented, lists.oriented_arrays, target, culled[2]);
            judge(truth, lists.dops, lists.dop_arrays, target, culled[3], false);
        }
        for (const size_t count : culled) EXPECT_GT(count, 100u) << target;
    });
}

TEST(FlatBounds, GiveTheSameBitsOnEveryInstructionSet) {
    std::vector<uint32_t> expected;
    test::forEachTarget([&](const std::string& target) {
        Random random(32);
        std::vector<uint32_t> all, masks(kPadded);
        for (int round = 0; round < 20; ++round) {
            const TruthVolume truth = test::randomVolume(random, 10.0);
            const Lists lists(random, truth);
            const auto append = [&] { all.insert(all.end(), masks.begin(), masks.begin() + kCount); };
            testBounds(truth.volume, lists.sphere_arrays, masks), append();
            testBounds(truth.volume, lists.box_arrays, masks), append();
            testBounds(truth.volume, lists.oriented_arrays, masks), append();
            testBounds(truth.volume, lists.dop_arrays, masks), append();
            const size_t kept =
                cullBounds(refineVolume(truth.volume), lists.box_arrays, Refinement::kSeparatingAxes, 1.0f, masks);
            all.insert(all.end(), masks.begin(), masks.begin() + static_cast<std::ptrdiff_t>(kept));
        }
        if (expected.empty()) expected = all;
        ASSERT_EQ(all, expected) << target;
    });
}

TEST(FlatBounds, TheRefinementKeepsASubsetThatHoldsTheExactSet) {
    test::forEachTarget([&](const std::string& target) {
        Random random(33);
        size_t by_planes = 0, by_corners = 0, by_axes = 0, exact = 0;
        for (int round = 0; round < std::max(rounds() / 10, 8); ++round) {
            const TruthVolume truth = test::randomVolume(random, round % 2 ? 1e6 : 0.0);
            const Lists lists(random, truth);
            const RefinedVolume refined = refineVolume(truth.volume);
            std::vector<uint32_t> all(kPadded), none(kPadded), corners(kPadded), axes(kPadded), large(kPadded);
            const auto cull = [&](Refinement how, float least, std::vector<uint32_t>& kept) {
                kept.resize(cullBounds(refined, lists.box_arrays, how, least, kept));
            };
            all.resize(cullBounds(truth.volume, lists.box_arrays, all));
            cull(Refinement::kNone, 0.0f, none);
            cull(Refinement::kCorners, 0.0f, corners);
            cull(Refinement::kSeparatingAxes, 0.0f, axes);
            cull(Refinement::kSeparatingAxes, 8.0f, large);
            ASSERT_EQ(none, all) << target;
            const auto holds = [](const std::vector<uint32_t>& a, const std::vector<uint32_t>& b) {
                return std::includes(a.begin(), a.end(), b.begin(), b.end());
            };
            ASSERT_TRUE(holds(all, corners) && holds(corners, axes) && holds(all, large) && holds(large, axes))
                << target;
            for (const uint32_t i : all) {
                const test::Touch touch = test::touch(test::bodyOf(lists.boxes[i]), truth, round % 2 ? 1e-4 : 1e-8);
                const bool kept = std::binary_search(axes.begin(), axes.end(), i);
                if (touch == test::Touch::kTogether) {
                    ASSERT_TRUE(kept) << target << " round " << round << " box " << i;
                }
                exact += touch != test::Touch::kApart;
            }
            by_planes += all.size(), by_corners += corners.size(), by_axes += axes.size();
        }
        EXPECT_GT(by_planes - by_corners, (by_planes - exact) / 4) << target;
        EXPECT_LE(by_axes - exact, (by_planes - exact) / 8) << target;  // what float cannot tell
    });
}

TEST(FlatBounds, ManyVolumesInOnePassGiveABitEach) {
    test::forEachTarget([&](const std::string& target) {
        Random random(34);
        for (int round = 0; round < 10; ++round) {
            const TruthVolume truth = test::randomVolume(random, 0.0);
            const Lists lists(random, truth);
            std::vector<ViewVolume> volumes{truth.volume};
            while (volumes.size() < 1 + static_cast<size_t>(round) * 3)
                volumes.push_back(test::randomVolume(random, 5.0).volume);
            if (round == 5) volumes[3].empty = true;
            if (round == 6) intersect(volumes[0], volumes[1]), intersect(volumes[0], volumes[2]);
            std::vector<uint32_t> masks(kPadded), kept(kPadded);
            testVolumes(volumes, lists.box_arrays, masks);
            for (size_t v = 0; v < volumes.size(); ++v) {
                const size_t count = cullBounds(volumes[v], lists.box_arrays, kept);
                std::vector<uint32_t> expected;
                for (uint32_t i = 0; i < kCount; ++i)
                    if (masks[i] >> v & 1) expected.push_back(i);
                ASSERT_EQ(std::vector<uint32_t>(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(count)),
                          expected)
                    << target << " volume " << v;
            }
        }
    });
}

TEST(FlatBounds, KeepWhatIsNotANumberAndNothingOfAnEmptyVolume) {
    test::forEachTarget([&](const std::string& target) {
        Random random(35);
        TruthVolume truth = test::randomVolume(random, 0.0);
        Lists lists(random, truth);
        for (auto& n : lists.numbers) n.assign(kPadded, std::numeric_limits<float>::quiet_NaN());
        std::vector<uint32_t> kept(kPadded);
        EXPECT_EQ(cullBounds(truth.volume, lists.sphere_arrays, kept), kCount) << target;
        EXPECT_EQ(cullBounds(truth.volume, lists.box_arrays, kept), kCount) << target;
        EXPECT_EQ(cullBounds(truth.volume, lists.oriented_arrays, kept), kCount) << target;
        EXPECT_EQ(cullBounds(truth.volume, lists.dop_arrays, kept), kCount) << target;
        EXPECT_EQ(cullBounds(refineVolume(truth.volume), lists.box_arrays, Refinement::kSeparatingAxes, 0.0f, kept),
                  kCount);
        truth.volume.empty = true;
        EXPECT_EQ(cullBounds(truth.volume, lists.sphere_arrays, kept), 0u);
        testBounds(truth.volume, lists.dop_arrays, kept);
        EXPECT_EQ(kept[kCount - 1], kOutsideMask);
    });
}

}  // namespace
}  // namespace sightline
