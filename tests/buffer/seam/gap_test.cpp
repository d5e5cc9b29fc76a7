// Gaps that the caller has closed: those narrower than asked for, each counted, and nothing else.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "tests/buffer/tiles_fixture.h"

namespace sightline::test {
namespace {

constexpr double kGap = 1.0 / 1024.0;

/// A quadrangle in the plane z, turned about the view's axis.
Solid panel(double x0, double y0, double x1, double y1, double z, double turn) {
    Solid out;
    for (const glm::dvec2& p : {glm::dvec2(x0, y0), glm::dvec2(x1, y0), glm::dvec2(x1, y1), glm::dvec2(x0, y1)})
        out.positions.emplace_back(std::cos(turn) * p.x - std::sin(turn) * p.y,
                                   std::sin(turn) * p.x + std::cos(turn) * p.y, z);
    out.indices = {0, 1, 2, 0, 2, 3};
    return out;
}

/// A pixel's side in the plane z.
double pixelAt(const Drawing& drawing, double z) {
    const double wide = 1.0 + 2.0 * drawing.view.jitter / drawing.view.height;
    return 2.0 * wide * -z / (drawing.view.projection[1][1] * drawing.screen.height);
}

/// Bricks all over the view, each a solid of its own.
/// @param gap  between neighbours  [pixels]
std::vector<Solid> brickWall(const Drawing& drawing, double gap, double turn) {
    constexpr double kZ = -4.0, kWide = 1.3, kTall = 0.7;
    const double half = 0.5 * gap * pixelAt(drawing, kZ);
    std::vector<Solid> wall;
    for (int row = -8; row < 8; ++row)
        for (int column = -6; column < 6; ++column) {
            const double x = (column + (row & 1 ? 0.5 : 0.0)) * kWide + 0.013, y = row * kTall + 0.017;
            wall.push_back(panel(x + half, y + half, x + kWide - half, y + kTall - half, kZ, turn));
        }
    return wall;
}

TEST(Gaps, NarrowerThanAskedForAreClosedAndCounted) {
    for (double turn : {0.0, 0.1875, 0.7})
        for (double width : {0.0, 0.1, 0.6}) {
            Drawing drawing(smallView()), without(smallView());
            without.drawAndResolve(brickWall(without, width * kGap, turn));
            drawing.tiles.gap = kGap;
            drawing.drawAndResolve(brickWall(drawing, width * kGap, turn));
            EXPECT_EQ(drawing.openPixels(), 0u) << turn << " " << width;
            EXPECT_EQ(without.tiles.closed_gaps, 0u);
            if (width > 0) {
                EXPECT_GT(without.openPixels(), 100u) << turn << " " << width;
                EXPECT_GE(drawing.tiles.closed_gaps, without.openPixels()) << turn << " " << width;
            }
        }
}

TEST(Gaps, WiderThanAskedForStayOpen) {
    for (double turn : {0.0, 0.1875, 0.7})
        for (double width : {1.05, 3.0, 40.0}) {
            Drawing drawing(smallView()), without(smallView());
            without.drawAndResolve(brickWall(without, width * kGap, turn));
            drawing.tiles.gap = kGap;
            drawing.drawAndResolve(brickWall(drawing, width * kGap, turn));
            EXPECT_EQ(drawing.openPixels(), without.openPixels()) << turn << " " << width;
            EXPECT_EQ(drawing.tiles.closed_gaps, 0u) << turn << " " << width;
        }
}

TEST(Gaps, TheFartherSideSaysHowFar) {
    Drawing drawing(smallView());
    drawing.tiles.gap = kGap;
    const double near = pixelAt(drawing, -4), far = pixelAt(drawing, -6), gap = 0.4 * kGap;
    drawing.drawAndResolve({panel(-6, -4, 10.3 * near, 4, -4, 0), panel((10.3 + gap) * far, -6, 9, 6, -6, 0)});
    EXPECT_EQ(drawing.openPixels(), 0u);
    EXPECT_GE(drawing.tiles.closed_gaps, drawing.tiles.height);
    const uint32_t at = drawing.tiles.width / 2 + 10;
    for (uint32_t y = 0; y < drawing.tiles.height; ++y) {
        EXPECT_LE(drawing.depth(at, y), 1.0f / 6.0f);
        EXPECT_GT(drawing.depth(at, y), 1.0f / 6.01f);
    }
}

/// Whether two occluder points at least as near lie on opposite sides of a point, no farther from each other than that.
bool liesInGap(const RayCaster& rays, double x, double y, double gap, double nearness) {
    constexpr int kTurns = 24, kSteps = 24;
    for (int turn = 0; turn < kTurns; ++turn) {
        const double angle = 3.14159265 * turn / kTurns, dx = std::cos(angle), dy = std::sin(angle);
        double least[2] = {gap, gap};
        for (int side = 0; side < 2; ++side)
            for (int step = 1; step <= kSteps; ++step) {
                const double t = gap * step / kSteps, way = side ? -t : t;
                if (rays.cast(x + way * dx, y + way * dy) < nearness) continue;
                least[side] = t;
                break;
            }
        if (least[0] + least[1] <= gap * 1.1) return true;
    }
    return false;
}

TEST(Gaps, NothingElseIsClosed) {
    constexpr double kWide = 1.0 / 16.0;
    uint64_t closed = 0, through = 0;
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        Random random(seed);
        Drawing drawing(smallView(48, 32));
        drawing.tiles.gap = kWide;
        // Strips side by side, some a little apart, some crossing each other, some at another depth; and triangles.
        std::vector<Solid> solids;
        const double turn = random.uniform(-0.6, 0.6), pixel = pixelAt(drawing, -4);
        for (double x = -4; x < 4;) {
            const double wide = random.uniform(0.1, 1.0), apart = pixel * random.uniform(0.0, 2.5 * kWide);
            solids.push_back(panel(x, -5, x + wide, 5, -4, turn + random.uniform(-0.001, 0.001)));
            x += wide + apart;
        }
        for (int i = 0; i < 4; ++i) {
            const double x = random.uniform(-2, 2), y = random.uniform(-1, 1);
            solids.push_back(panel(x, y, x + 0.6, y + 0.4, random.uniform(-5, -3.5), random.uniform(-3, 3)));
        }
        drawing.drawAndResolve(solids);
        closed += drawing.tiles.closed_gaps;
        const RayCaster rays(drawing);
        for (uint32_t y = 0; y < drawing.tiles.height; ++y)
            for (uint32_t x = 0; x < drawing.tiles.width; ++x) {
                if (!drawing.covered(x, y)) continue;
                for (int i = 0; i < 24; ++i) {
                    const double px = x + random.uniform(), py = y + random.uniform(), claim = drawing.depth(x, y);
                    if (rays.cast(px, py) >= claim) continue;
                    ++through;
                    ASSERT_TRUE(liesInGap(rays, px, py, kWide, claim))
                        << "seed " << seed << ": the ray through (" << px << ", " << py << ")";
                }
            }
    }
    EXPECT_GT(closed, 100u);
    EXPECT_GT(through, 50u);
}

TEST(Gaps, ASilhouetteStaysWhereItIs) {
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        Random random(seed), same(seed);
        Drawing drawing(smallView()), without(smallView());
        drawing.tiles.gap = 1.0 / 16.0;
        const auto solids = [](Random& from) {
            return std::vector<Solid>{makeSheet(from, 6, 4, {-2, -1.5f, -4}, {1.5f, 1, -5}, 0.1f),
                                      panel(0.5, -1, 2, 1.2, -7, from.uniform(-1, 1))};
        };
        drawing.draw(solids(random));
        without.draw(solids(same));
        drawing.resolveAll();
        without.resolveAll();
        EXPECT_EQ(drawing.tiles.closed_gaps, 0u);
        for (uint32_t y = 0; y < drawing.tiles.height; ++y)
            for (uint32_t x = 0; x < drawing.tiles.width; ++x)
                ASSERT_EQ(drawing.covered(x, y), without.covered(x, y)) << seed << ": " << x << ", " << y;
    }
}

}  // namespace
}  // namespace sightline::test
