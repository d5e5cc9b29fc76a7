// Clipped windows and separating planes: exact heights of all corners, and the same bits on every instruction set.
// SPDX-License-Identifier: MIT
#include "sightline/bake/flow/window.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/math/expansion.h"
#include "tests/bake/flow/cell_worlds.h"
#include "tests/support/targets.h"

#define HWY_COMPILE_ALL_ATTAINABLE
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/bake/flow/window_test.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/bake/flow/window-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline::test::HWY_NAMESPACE {
using namespace sightline::bake::HWY_NAMESPACE;
using namespace bake;

Clipped clipped(Window& window, const glm::dvec4& plane, double lowest, double touching) {
    return clip(window, plane, lowest, touching);
}
Clipped clippedByAll(Window& window, const Separators& planes, double lowest, double touching) {
    return clip(window, planes, lowest, touching);
}
void separated(const Window& first, const glm::dvec4& first_plane, const Window& second, const glm::dvec4& second_plane,
               double turning, double points, double rounding, Separators& out) {
    separate(first, first_plane, second, second_plane, turning, Precision{points, rounding, 0x1p50 * rounding}, out);
}

}  // namespace sightline::test::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::test {
using namespace bake;
HWY_EXPORT(clipped);
HWY_EXPORT(clippedByAll);
HWY_EXPORT(separated);
namespace test {
namespace {

double exactHeight(const Separators& planes, uint32_t i, const glm::dvec3& point) {
    Expansion sum;
    sum.addProduct(planes.x[i], point.x);
    sum.addProduct(planes.y[i], point.y);
    sum.addProduct(planes.z[i], point.z);
    sum.add(planes.w[i]);
    double height = 0;
    for (int k = 0; k < sum.count; ++k) height += sum.parts[k];
    return height;
}

struct Pair {
    Window first, second;
    glm::dvec4 first_plane{0.0}, second_plane{0.0};
    double points = 0, rounding = 0;
    bool shared = false;
};

glm::dvec4 planeOf(const std::vector<glm::dvec3>& outline) {
    glm::dvec3 area(0), sum(0);
    for (size_t i = 1; i + 1 < outline.size(); ++i)
        area += glm::cross(outline[i] - outline[0], outline[i + 1] - outline[0]);
    for (const glm::dvec3& point : outline) sum += point;
    const glm::dvec3 normal = glm::normalize(area);
    return glm::dvec4(normal, -glm::dot(normal, sum / static_cast<double>(outline.size())));
}

/// Two polygons, each in front of the other; slivers, tiny ones, far away ones.
Pair randomPair(Random& random) {
    Pair pair;
    const double scale = random.below(4) == 0 ? 1e6 : random.below(4) == 0 ? 1e-3 : 1;
    const auto unit = [&] {
        const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
        return glm::dvec3(x, y, random.uniform(-1, 1));
    };
    const glm::dvec3 way = glm::normalize(glm::dvec3(1, 0, 0) + 0.5 * unit()), at = 3.0 * unit();
    std::vector<glm::dvec3> outlines[2];
    double extent = 0;
    for (int i = 0; i < 2; ++i) {
        const glm::dvec3 normal = glm::normalize(way + 0.4 * unit());
        const glm::dvec3 center = at + (i ? random.uniform(0.8, 4) * way + 0.5 * unit() : glm::dvec3(0));
        outlines[i] =
            disc(random, center, normal, random.uniform(0.1, 0.5), 3 + static_cast<uint32_t>(random.below(8)));
        if (random.below(4) == 0) {  // a sliver
            const glm::dvec3 axis = glm::normalize(outlines[i][1] - outlines[i][0]);
            for (glm::dvec3& point : outlines[i]) {
                const glm::dvec3 off = point - center;
                point = center + 1e-6 * off + (1 - 1e-6) * glm::dot(off, axis) * axis;
            }
        }
        for (glm::dvec3& point : outlines[i]) {
            point *= scale;
            for (int k = 0; k < 3; ++k) extent = std::max(extent, std::abs(point[k]));
        }
    }
    pair.points = extent * 0x1p-38;
    pair.rounding = extent * 0x1p-48;
    pair.first_plane = planeOf(outlines[0]);
    pair.second_plane = planeOf(outlines[1]);
    pair.first.assign(outlines[0]);
    pair.second.assign(outlines[1]);
    return pair;
}

/// Whether all of the second is in front of the first's plane, and all of the first behind the second's.
bool isBefore(const Pair& pair, double room) {
    for (uint32_t k = 0; k < pair.second.count; ++k)
        if (glm::dot(pair.first_plane, glm::dvec4(pair.second.corner(k), 1)) < room) return false;
    for (uint32_t k = 0; k < pair.first.count; ++k)
        if (glm::dot(pair.second_plane, glm::dvec4(pair.first.corner(k), 1)) > -room) return false;
    return true;
}

Separators planesOf(const Pair& pair) {
    Separators planes;
    HWY_DYNAMIC_DISPATCH(separated)
    (pair.first, pair.first_plane, pair.second, pair.second_plane, 1, pair.points, pair.rounding, planes);
    return planes;
}

TEST(Windows, AreOnEitherSideOfTheirSeparators) {
    uint64_t planes_in_all = 0;
    for (uint64_t seed = 1; seed <= 20000; ++seed) {
        Random random(seed);
        const Pair pair = randomPair(random);
        const Separators planes = planesOf(pair);
        ASSERT_LE(planes.count, pair.first.count + pair.second.count);
        for (uint32_t i = 0; i < planes.count; ++i) {
            // No point of the first is above, none of the second below; not even by rounding.
            double first = -1e300, second = 1e300;
            for (uint32_t k = 0; k < pair.first.count; ++k)
                first = std::max(first, exactHeight(planes, i, pair.first.corner(k)));
            for (uint32_t k = 0; k < pair.second.count; ++k)
                second = std::min(second, exactHeight(planes, i, pair.second.corner(k)));
            ASSERT_LE(first, second) << "seed " << seed << ", plane " << i;
            ASSERT_GE(second, 0) << "seed " << seed << ", plane " << i;
            ASSERT_LE(second, 0x1p-20 * (1 + std::abs(planes.w[i]))) << "it touches: seed " << seed << ", plane " << i;
        }
        planes_in_all += planes.count;
    }
    EXPECT_GT(planes_in_all, 100000u);
}

TEST(Windows, AreSeparatedByEachPlaneThatDoes) {
    // Each plane through an edge of one and a corner of the other that separates the two with room to spare is found.
    uint64_t found = 0;
    for (uint64_t seed = 1; seed <= 2000; ++seed) {
        Random random(seed);
        const Pair pair = randomPair(random);
        const Separators planes = planesOf(pair);
        const double extent = pair.points * 0x1p38;
        if (!isBefore(pair, 1e-4 * extent)) continue;
        for (const bool turned : {false, true}) {
            const Window &own = turned ? pair.second : pair.first, &other = turned ? pair.first : pair.second;
            for (uint32_t e = 0; e < own.count; ++e)
                for (uint32_t v = 0; v < other.count; ++v) {
                    const glm::dvec3 a = own.corner(e), b = own.corner((e + 1) % own.count), c = other.corner(v);
                    glm::dvec3 normal = glm::cross(b - a, c - a);
                    if (glm::length(b - a) < 1e-2 * extent || glm::length(normal) < 1e-3 * extent * extent) continue;
                    normal = glm::normalize(normal);
                    double own_low = 1e300, own_high = -1e300, low = 1e300, high = -1e300;
                    for (uint32_t k = 0; k < own.count; ++k) {
                        if (k == e || k == (e + 1) % own.count) continue;
                        own_low = std::min(own_low, glm::dot(normal, own.corner(k) - a));
                        own_high = std::max(own_high, glm::dot(normal, own.corner(k) - a));
                    }
                    for (uint32_t k = 0; k < other.count; ++k) {
                        if (k == v) continue;
                        low = std::min(low, glm::dot(normal, other.corner(k) - a));
                        high = std::max(high, glm::dot(normal, other.corner(k) - a));
                    }
                    const double room = 1e-4 * extent;
                    if (own_low > room && high < -room) normal = -normal;
                    else if (!(own_high < -room && low > room)) continue;
                    if (turned) normal = -normal;
                    double nearest = 1e300;
                    for (uint32_t i = 0; i < planes.count; ++i)
                        nearest =
                            std::min(nearest, glm::length(glm::dvec3(planes.x[i], planes.y[i], planes.z[i]) - normal));
                    ASSERT_LT(nearest, 1e-5) << "seed " << seed << ", edge " << e << ", corner " << v;
                    ++found;
                }
        }
    }
    EXPECT_GT(found, 1000u);
}

TEST(Windows, LoseNothingAboveAPlane) {
    uint64_t cuts = 0;
    for (uint64_t seed = 1; seed <= 20000; ++seed) {
        Random random(seed);
        const Pair pair = randomPair(random);
        Window window;
        window.assign(pair.first);
        glm::dvec3 normal = glm::normalize(glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), 0.3));
        const glm::dvec3 through = glm::mix(pair.first.corner(0), pair.first.corner(1 + pair.first.count / 2 % 2), 0.5);
        const glm::dvec4 plane(normal, -glm::dot(normal, through));
        const Clipped answer = HWY_DYNAMIC_DISPATCH(clipped)(window, plane, 0, 0);
        const double rounding = 64 * pair.rounding;
        if (answer == Clipped::kWhole) {
            ASSERT_EQ(window.count, pair.first.count);
            continue;
        }
        ++cuts;
        // A corner that was above is still one; each new one is on the plane, and on an edge.
        for (uint32_t k = 0; k < pair.first.count; ++k) {
            const glm::dvec3 point = pair.first.corner(k);
            if (!(glm::dot(normal, point) + plane.w > rounding)) continue;
            bool there = false;
            for (uint32_t i = 0; i < window.count && answer == Clipped::kCut; ++i) there |= window.corner(i) == point;
            ASSERT_TRUE(there) << "seed " << seed;
        }
        if (answer == Clipped::kGone) continue;
        for (uint32_t i = 0; i < window.count; ++i)
            ASSERT_GE(glm::dot(normal, window.corner(i)) + plane.w, -rounding) << "seed " << seed;
        // Points of edges that are above lie on edges of what is left.
        for (uint32_t k = 0; k < pair.first.count; ++k)
            for (const double share : {0.1, 0.37, 0.5, 0.93}) {
                const glm::dvec3 point =
                    glm::mix(pair.first.corner(k), pair.first.corner((k + 1) % pair.first.count), share);
                if (!(glm::dot(normal, point) + plane.w > rounding)) continue;
                double nearest = 1e300;
                for (uint32_t i = 0; i < window.count; ++i) {
                    const glm::dvec3 a = window.corner(i), along = window.corner((i + 1) % window.count) - a;
                    const double squared = glm::dot(along, along);
                    const double at = squared > 0 ? glm::clamp(glm::dot(point - a, along) / squared, 0.0, 1.0) : 0;
                    nearest = std::min(nearest, glm::length(point - a - at * along));
                }
                ASSERT_LE(nearest, 64 * rounding) << "seed " << seed;
            }
    }
    EXPECT_GT(cuts, 5000u);
}

TEST(Windows, AreTheSameOnEveryInstructionSet) {
    for (uint64_t seed = 1; seed <= 500; ++seed) {
        Random random(seed);
        const Pair pair = randomPair(random);
        const std::vector<glm::dvec3> target = [&] {
            const glm::dvec3 way = pair.second.center() - pair.first.center();
            return disc(random, pair.second.center() + way, glm::normalize(way), glm::length(way), 6);
        }();
        const Separators expected = planesOf(pair);
        Window clipped_first;
        clipped_first.assign(target);
        const Clipped answer = HWY_DYNAMIC_DISPATCH(clippedByAll)(clipped_first, expected, -1e-9, -1e-9);
        ASSERT_GE(forEachTarget([&](const std::string& name) {
                      const Separators planes = planesOf(pair);
                      ASSERT_EQ(planes.count, expected.count) << name;
                      const size_t bytes = planes.count * sizeof(double);
                      EXPECT_EQ(std::memcmp(planes.x, expected.x, bytes), 0) << name;
                      EXPECT_EQ(std::memcmp(planes.y, expected.y, bytes), 0) << name;
                      EXPECT_EQ(std::memcmp(planes.z, expected.z, bytes), 0) << name;
                      EXPECT_EQ(std::memcmp(planes.w, expected.w, bytes), 0) << name;
                      Window window;
                      window.assign(target);
                      EXPECT_EQ(HWY_DYNAMIC_DISPATCH(clippedByAll)(window, planes, -1e-9, -1e-9), answer) << name;
                      ASSERT_EQ(window.count, clipped_first.count) << name;
                      for (uint32_t i = 0; i < window.count; ++i)
                          EXPECT_EQ(window.corner(i), clipped_first.corner(i)) << name;
                  }),
                  2);
    }
}

}  // namespace
}  // namespace test
}  // namespace sightline::test
#endif  // HWY_ONCE
