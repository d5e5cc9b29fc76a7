// The exact predicates against whole numbers, and a step of the last place beside the truth.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/occluder/exact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sightline/base/random.h"

namespace sightline {
namespace {

using Whole = glm::vec<3, int64_t, glm::defaultp>;

Whole cross(const Whole& a, const Whole& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Few different numbers, so that many are collinear or coplanar.
Whole draw(Random& random, int64_t range) {
    const auto one = [&] { return int64_t(random.below(uint64_t(2 * range + 1))) - range; };
    const int64_t x = one(), y = one();
    return {x, y, one()};
}

glm::vec3 placed(const Whole& p, int scale) {
    return {std::ldexp(float(p.x), scale), std::ldexp(float(p.y), scale), std::ldexp(float(p.z), scale)};
}

TEST(Exact, AgreesWithWholeNumbers) {
    Random random(1);
    int collinear = 0, between = 0, coplanar = 0;
    for (int i = 0; i < 200000; ++i) {
        const int64_t range = i % 3 ? 3 : 100000;
        const int scale = int(random.below(60)) - 30;
        const Whole a = draw(random, range), c = draw(random, range);
        Whole b = draw(random, range), d = draw(random, range);
        if (i % 7 == 0) b = c + (c - a);
        if (i % 5 == 0) d = a + (b - a) * int64_t{2} - (c - a);
        const glm::vec3 p = placed(a, scale), q = placed(b, scale), r = placed(c, scale), s = placed(d, scale);
        const Whole n = cross(b - a, c - a);
        const bool on_line = n == Whole(0);
        ASSERT_EQ(areCollinear(p, q, r), on_line) << i;
        bool inside = on_line && c != a && c != b;
        for (int k = 0; k < 3; ++k) inside = inside && std::min(a[k], b[k]) <= c[k] && c[k] <= std::max(a[k], b[k]);
        ASSERT_EQ(liesBetween(r, p, q), inside) << i;
        const Whole w = d - a;
        const bool on_plane = n.x * w.x + n.y * w.y + n.z * w.z == 0;
        ASSERT_EQ(areCoplanar(p, q, r, s), on_plane) << i;
        collinear += on_line;
        between += inside;
        coplanar += on_plane;
    }
    EXPECT_GT(collinear, 1000);
    EXPECT_GT(between, 500);
    EXPECT_GT(coplanar, 10000);
}

TEST(Exact, TellsOneStepOfTheLastPlace) {
    Random random(2);
    for (int i = 0; i < 20000; ++i) {
        // The middle of two points of few bits is exact; one step aside is not on the line, however near.
        const auto coordinate = [&] { return float(int64_t(random.below(1u << 20)) - (1 << 19)) * 0x1p-10f; };
        const float ax = coordinate(), ay = coordinate(), az = coordinate();
        const float bx = coordinate(), by = coordinate(), bz = coordinate();
        const glm::vec3 a(ax, ay, az), b(bx, by, bz);
        const glm::vec3 middle = 0.5f * (a + b);
        if (a.x == b.x || a.y == b.y || a.z == b.z) continue;
        ASSERT_TRUE(liesBetween(middle, a, b));
        for (int k = 0; k < 3; ++k)
            for (float toward : {-1e30f, 1e30f}) {
                glm::vec3 aside = middle;
                aside[k] = std::nextafter(aside[k], toward);
                ASSERT_FALSE(liesBetween(aside, a, b));
                ASSERT_FALSE(areCollinear(a, b, aside));
            }
    }
}

TEST(Exact, SaysNotCoplanarWhereADoubleCannotTell) {
    // A difference of 2^60 and 2^-60 has no double; nothing is claimed then.
    const glm::vec3 a(0x1p60f, 0x1p60f, 0x1p60f), b(0x1p-60f, 0, 1), c(0, 0x1p-60f, 2), d(3, 5, 0x1p-60f);
    EXPECT_FALSE(areCoplanar(a, b, c, d));
    EXPECT_TRUE(areCoplanar({0x1p60f, 1, 2}, {0x1p60f, 0x1p-60f, 3}, {0x1p60f, 5, 5}, {0x1p60f, 7, 1}));
}

}  // namespace
}  // namespace sightline
