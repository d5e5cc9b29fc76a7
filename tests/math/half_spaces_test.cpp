// Half-spaces in a plane: against polygons of whole numbers, cut line by line without rounding.
// SPDX-License-Identifier: MIT
#include "sightline/math/half_spaces.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/random.h"

namespace sightline {
namespace {

/// a x + b y + c > 0, of whole numbers.
struct Line {
    int64_t a = 0, b = 0, c = 0;
};

/// Where two lines meet, times w.
struct Corner {
    int64_t x = 0, y = 0, w = 0;
};

Corner cornerOf(const Line& p, const Line& q) {
    Corner corner{p.b * q.c - q.b * p.c, q.a * p.c - p.a * q.c, p.a * q.b - q.a * p.b};
    if (corner.w < 0) corner = {-corner.x, -corner.y, -corner.w};
    return corner;
}

int sideOf(const Line& line, const Corner& corner) {
    const int64_t value = line.a * corner.x + line.b * corner.y + line.c * corner.w;
    return value > 0 ? 1 : value < 0 ? -1 : 0;
}

/// A polygon is the cyclic list of the lines its edges lie on; cutting keeps it so, and exact. True if area is left.
bool areaIsLeft(const std::vector<Line>& lines) {
    constexpr int64_t kFar = 1000;
    std::vector<Line> edges = {{0, 1, kFar}, {-1, 0, kFar}, {0, -1, kFar}, {1, 0, kFar}};
    for (const Line& line : lines) {
        std::vector<int> side(edges.size());  // of the corner between an edge and the next
        bool front = false, back = false;
        for (size_t i = 0; i < edges.size(); ++i) {
            side[i] = line.a == 0 && line.b == 0 ? (line.c > 0 ? 1 : -1)
                                                 : sideOf(line, cornerOf(edges[i], edges[(i + 1) % edges.size()]));
            front |= side[i] > 0;
            back |= side[i] < 0;
        }
        if (!front) return false;
        if (!back) continue;
        std::vector<Line> kept;
        for (size_t i = 0; i < edges.size(); ++i) {
            const int before = side[(i + edges.size() - 1) % edges.size()];
            if (before > 0 || side[i] > 0) kept.push_back(edges[i]);
            if (before > 0 && side[i] <= 0) kept.push_back(line);
        }
        edges = kept;
    }
    return true;
}

TEST(HalfSpaces, LeaveWhatExactCuttingLeaves) {
    Random random(1);
    const auto whole = [&](int64_t most) { return static_cast<int64_t>(random.below(2 * most + 1)) - most; };
    size_t open = 0, shut = 0;
    for (int i = 0; i < 60000; ++i) {
        // A plane z = p x + q y + r, its axes turned; lines in it lifted to half-spaces by any multiple of the plane.
        const int64_t range = i % 2 ? 2 : 6, p = whole(3), q = whole(3), r = whole(9), scale = random.below(2) ? 1 : -3;
        const size_t turn = random.below(3);
        const auto turned = [&](int64_t x, int64_t y, int64_t z, int64_t w) {
            glm::dvec4 plane(0, 0, 0, double(w));
            plane[static_cast<int>(turn)] = double(x);
            plane[static_cast<int>((turn + 1) % 3)] = double(y);
            plane[static_cast<int>((turn + 2) % 3)] = double(z);
            return plane;
        };
        std::vector<Line> lines;
        std::vector<glm::dvec4> insides;
        for (uint64_t left = 1 + random.below(7); left > 0; --left) {
            const Line line{whole(range), whole(range), whole(range)};
            const int64_t k = whole(2);
            lines.push_back(line);
            insides.push_back(turned(line.a + k * p, line.b + k * q, -k, line.c + k * r));
        }
        const bool expected = areaIsLeft(lines);
        ASSERT_EQ(openInPlane(turned(scale * p, scale * q, -scale, scale * r), insides), expected) << "case " << i;
        (expected ? open : shut)++;
    }
    EXPECT_GT(open, 5000u);
    EXPECT_GT(shut, 5000u);
}

TEST(HalfSpaces, TellAHairFromNothing) {
    const glm::dvec4 plane(0.6, 0, 0.8, -3);
    const double low = 0.1, high = std::nextafter(low, 1.0);
    const glm::dvec4 above(0, 1, 0, -low), below_high(0, -1, 0, high), below_low(0, -1, 0, low);
    const glm::dvec4 both[] = {above, below_high}, neither[] = {above, below_low};
    EXPECT_TRUE(openInPlane(plane, both));
    EXPECT_FALSE(openInPlane(plane, neither));
    // Three lines through a point, and the same with one moved by the smallest step.
    const glm::dvec4 left(1, 0, 0, -1), under(-1, -1, 0, 1), over(0, 1, 0, 0);
    const glm::dvec4 point[] = {left, under, over};
    EXPECT_FALSE(openInPlane(plane, point));
    const glm::dvec4 moved[] = {glm::dvec4(1, 0, 0, -std::nextafter(1.0, 0.0)), under, over};
    EXPECT_TRUE(openInPlane(plane, moved));
    // The plane itself, seen from either side: strictly inside there is nothing of it.
    EXPECT_FALSE(openInPlane(plane, {{plane}}));
    EXPECT_FALSE(openInPlane(plane, {{-2.0 * plane}}));
    EXPECT_TRUE(openInPlane(plane, {}));
}

}  // namespace
}  // namespace sightline
